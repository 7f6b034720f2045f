/* lib/sort: against qsort, and the order that drawing asks for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sort/sort.h"
#include "support/sort_keys.h"

static void pairs_are_sorted_like_qsort(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 3, 1000, 8191, 8192, 50000, 300000};
    static const uint32_t thread_counts[] = {1, 2, 8};
    const size_t most = 300000;
    kiln_sort_pair *expected = malloc(most * sizeof *expected);
    kiln_sort_pair *pairs = malloc(most * sizeof *pairs);
    kiln_sort_pair *scratch = malloc(most * sizeof *scratch);
    for (int t = 0; t < 3; t++) {
        struct kiln_threads *threads = kiln_threads_create(thread_counts[t]);
        assert_non_null(threads);
        uint32_t *words = malloc(kiln_sort_count_words(threads) * sizeof *words);
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (int pattern = 0; pattern < PATTERNS; pattern++) {
                for (uint32_t i = 0; i < counts[c]; i++)
                    pairs[i] =
                        (kiln_sort_pair)key_of((enum pattern)pattern, i, counts[c]) << 32 | i;
                memcpy(expected, pairs, counts[c] * sizeof *pairs);
                qsort(expected, counts[c], sizeof *expected, by_pair);
                kiln_sort_pair *sorted = kiln_sort_pairs(threads, pairs, scratch, counts[c], words);
                if (memcmp(sorted, expected, counts[c] * sizeof *sorted) != 0)
                    fail_msg("%u pairs of pattern %d with %u threads", counts[c], pattern,
                             thread_counts[t]);
            }
        free(words);
        kiln_threads_destroy(&threads);
    }
    free(expected);
    free(pairs);
    free(scratch);
}

/* As many as a draw entry can address: ascending whole pairs that are those which went in. */
static void the_most_particles_are_sorted(void **state)
{
    (void)state;
    const uint32_t count = 1u << 24;
    kiln_sort_pair *pairs = malloc(count * sizeof *pairs);
    kiln_sort_pair *scratch = malloc(count * sizeof *scratch);
    struct kiln_threads *threads = kiln_threads_create(2);
    assert_true(pairs && scratch && threads);
    uint32_t *words = malloc(kiln_sort_count_words(threads) * sizeof *words);
    assert_non_null(words);
    for (uint32_t i = 0; i < count; i++)
        pairs[i] = (kiln_sort_pair)(random_mix(i) >> 4) << 32 | i;
    const kiln_sort_pair *sorted = kiln_sort_pairs(threads, pairs, scratch, count, words);
    bool right = true;
    for (uint32_t i = 0; i < count; i++) {
        right &= random_mix((uint32_t)sorted[i]) >> 4 == sorted[i] >> 32;
        right &= i == 0 || sorted[i] > sorted[i - 1];
    }
    assert_true(right);
    free(words);
    free(pairs);
    free(scratch);
    kiln_threads_destroy(&threads);
}

/* A pool of three systems with particles at given depths along z; serial 3 of each is dead. */
static void fill_pool(struct kiln_pool *pool, uint32_t capacity)
{
    struct kiln_error error = {0};
    kiln_pool_init(pool, NULL, (const uint32_t[]){capacity, capacity, capacity}, 3);
    struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    for (uint32_t system = 0; system < 3; system++) {
        pool->systems[system].next_serial = capacity + 7; /* the oldest serial is in slot 7 */
        for (uint32_t serial = 7; serial < capacity + 7; serial++) {
            struct kiln_particle *p = &records[pool->systems[system].base + serial % capacity];
            /* few distinct depths, so that ties are common; some behind the eye, one is -0 */
            float z = (float)(random_mix(serial + system * 1000u) % 64) - 32.0f;
            p->position_serial =
                UINT4(0, 0, FLOAT_BITS(z == 0.0f && serial % 2 ? -0.0f : z), serial);
            p->velocity_birth.w = serial % 5 != 3 ? KILN_PARTICLE_ALIVE : 0;
        }
    }
}

static void farthest_come_first_and_ties_by_system_and_serial(void **state)
{
    (void)state;
    static const uint32_t thread_counts[] = {1, 2, 8};
    struct kiln_error error = {0};
    const uint32_t capacity = 20000;
    struct kiln_pool pool;
    fill_pool(&pool, capacity);
    const struct kiln_particle *records = kiln_buffer_host(&pool.records, KILN_READ, &error);
    for (int t = 0; t < 3; t++) {
        struct kiln_threads *threads = kiln_threads_create(thread_counts[t]);
        struct kiln_sort *sort = kiln_sort_create(NULL, KILN_SORT_CPU, threads, &error);
        assert_non_null(sort);
        struct kiln_buffer entries;
        kiln_buffer_init(&entries, NULL, pool.slot_count * sizeof(uint32_t), "entries");
        struct kiln_sort_params params = {.eye = {1, 2, 8},
                                          .forward = {0, 0, -1},
                                          .systems = 5,
                                          .order = KILN_SORT_BACK_TO_FRONT};
        uint32_t count = 0;
        assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
        assert_int_equal(count, 2 * (capacity / 5 * 4));
        const uint32_t *list = kiln_buffer_host(&entries, KILN_READ, &error);
        for (uint32_t i = 0; i < count; i++) {
            struct kiln_particle b = records[KILN_ENTRY_SLOT(list[i])];
            uint32_t system = KILN_ENTRY_SYSTEM(list[i]);
            assert_true(system != 1 && particle_is_alive(b));
            if (i == 0)
                continue;
            struct kiln_particle a = records[KILN_ENTRY_SLOT(list[i - 1])];
            uint32_t system_before = KILN_ENTRY_SYSTEM(list[i - 1]);
            float z_before = particle_position(a).z, z = particle_position(b).z;
            bool later = system > system_before ||
                         (system == system_before && b.position_serial.w > a.position_serial.w);
            assert_true(z > z_before || (z == z_before && later));
        }
        params.order = KILN_SORT_BY_SERIAL;
        assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
        list = kiln_buffer_host(&entries, KILN_READ, &error);
        for (uint32_t i = 1; i < count; i++) {
            uint32_t before = records[KILN_ENTRY_SLOT(list[i - 1])].position_serial.w;
            uint32_t serial = records[KILN_ENTRY_SLOT(list[i])].position_serial.w;
            assert_true(serial > before || i == count / 2);
        }
        params.systems = 0;
        assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
        assert_int_equal(count, 0);
        kiln_buffer_finish(&entries);
        kiln_sort_destroy(&sort);
        assert_null(sort);
        kiln_threads_destroy(&threads);
    }
    kiln_pool_finish(&pool);
}

/* Ties included. */
static void front_to_back_is_the_exact_reverse(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_pool pool;
    fill_pool(&pool, 20000);
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_sort *sort = kiln_sort_create(NULL, KILN_SORT_CPU, threads, &error);
    struct kiln_sort_params params = {.forward = {0, 0, -1}, .systems = 7};
    struct kiln_buffer lists[2];
    const uint32_t *entries[2];
    uint32_t counts[2];
    for (int i = 0; i < 2; i++) {
        kiln_buffer_init(&lists[i], NULL, pool.slot_count * sizeof(uint32_t), "entries");
        params.order = i ? KILN_SORT_FRONT_TO_BACK : KILN_SORT_BACK_TO_FRONT;
        assert_true(kiln_sort_run(sort, &pool, &params, &lists[i], &counts[i], &error));
        entries[i] = kiln_buffer_host(&lists[i], KILN_READ, &error);
    }
    assert_true(counts[0] == counts[1] && counts[0] > 40000);
    for (uint32_t i = 0; i < counts[0]; i++)
        assert_int_equal(entries[0][i], entries[1][counts[0] - 1 - i]);
    for (int i = 0; i < 2; i++)
        kiln_buffer_finish(&lists[i]);
    kiln_sort_destroy(&sort);
    kiln_threads_destroy(&threads);
    kiln_pool_finish(&pool);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_sorted_like_qsort),
        cmocka_unit_test(the_most_particles_are_sorted),
        cmocka_unit_test(farthest_come_first_and_ties_by_system_and_serial),
        cmocka_unit_test(front_to_back_is_the_exact_reverse),
    };
    return cmocka_run_group_tests_name("sort", tests, NULL, NULL);
}
