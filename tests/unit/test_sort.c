/* lib/sort: against qsort, and the order that drawing asks for. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "shared/random.h"
#include "sort/pairs.h"
#include "sort/sort.h"
#include "support/cmocka.h"
#include "support/pools.h"
#include "support/sort_keys.h"

enum { MOST = 300000 };

/* Sorts by the keys' own span, or by that of all keys and in reverse. */
static void expect_like_qsort(struct kiln_threads *threads, enum pattern pattern, uint32_t count,
                              bool reverse, uint32_t *words)
{
    static kiln_sort_pair expected[MOST], pairs[MOST], list[MOST];
    struct kiln_sort_span span = {UINT32_MAX, 0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t key = key_of(pattern, i, count);
        expected[i] = pairs[i] = (kiln_sort_pair)key << 32 | i;
        span.least = key < span.least ? key : span.least;
        span.greatest = key > span.greatest ? key : span.greatest;
    }
    if (reverse)
        span = (struct kiln_sort_span){0, UINT32_MAX};
    qsort(expected, count, sizeof *expected, by_pair);
    uint32_t *places = (uint32_t *)(void *)list;
    kiln_sort_pairs(threads, pairs, count, span, reverse, places, words);
    for (uint32_t i = 0; i < count; i++)
        if (places[reverse ? count - 1 - i : i] != (uint32_t)expected[i])
            fail_msg("%u pairs of pattern %d with %u threads", count, (int)pattern,
                     kiln_threads_count(threads));
}

static void pairs_are_sorted_like_qsort(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 3, 1000, 8191, 8192, 50000, MOST};
    static const uint32_t thread_counts[] = {1, 2, 8};
    for (int t = 0; t < 3; t++) {
        struct kiln_threads *threads = kiln_threads_create(thread_counts[t]);
        assert_non_null(threads);
        uint32_t *words = malloc(kiln_sort_count_words(threads) * sizeof *words);
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (int pattern = 0; pattern < PATTERNS; pattern++) {
                expect_like_qsort(threads, (enum pattern)pattern, counts[c], false, words);
                expect_like_qsort(threads, (enum pattern)pattern, counts[c], true, words);
            }
        free(words);
        kiln_threads_destroy(&threads);
    }
}

/* Keys of every number of bits, above an offset: digits are cut as they need. */
static void keys_of_any_span_are_sorted(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static kiln_sort_pair pairs[COUNT], list[COUNT];
    struct kiln_threads *threads = kiln_threads_create(2);
    uint32_t *words = malloc(kiln_sort_count_words(threads) * sizeof *words);
    for (unsigned bits = 0; bits <= 32; bits++) {
        const uint32_t most = bits == 32 ? UINT32_MAX : (1u << bits) - 1;
        const uint32_t least = (UINT32_MAX - most) / 3;
        for (uint32_t i = 0; i < COUNT; i++) {
            uint32_t key = least + (i == 7 ? most : random_mix(i) & most);
            pairs[i] = (kiln_sort_pair)key << 32 | i;
        }
        uint32_t *places = (uint32_t *)(void *)list;
        kiln_sort_pairs(threads, pairs, COUNT, (struct kiln_sort_span){least, least + most}, false,
                        places, words);
        for (uint32_t i = 1; i < COUNT; i++) {
            uint32_t a = places[i - 1], b = places[i];
            uint32_t key_a = a == 7 ? most : random_mix(a) & most;
            uint32_t key_b = b == 7 ? most : random_mix(b) & most;
            if (key_b < key_a || (key_a == key_b && b <= a))
                fail_msg("%u bits: %u before %u", bits, a, b);
        }
    }
    free(words);
    kiln_threads_destroy(&threads);
}

/* Sorts as many particles as a scene may have: their keys ascend, and some are equal, so that none
 * can occur twice. */
static void the_most_particles_are_sorted(void **state)
{
    (void)state;
    const uint32_t count = KILN_MAX_PARTICLES;
    kiln_sort_pair *pairs = malloc(count * sizeof *pairs);
    kiln_sort_pair *list = malloc(count * sizeof *list); /* scratch on the way */
    uint32_t *places = (uint32_t *)(void *)list;
    struct kiln_threads *threads = kiln_threads_create(2);
    assert_true(pairs && list && threads);
    uint32_t *words = malloc(kiln_sort_count_words(threads) * sizeof *words);
    assert_non_null(words);
    for (uint32_t i = 0; i < count; i++)
        pairs[i] = (kiln_sort_pair)(random_mix(i) >> 4) << 32 | i;
    kiln_sort_pairs(threads, pairs, count, (struct kiln_sort_span){0, UINT32_MAX >> 4}, false,
                    places, words);
    bool right = places[0] < count;
    for (uint32_t i = 1; i < count && right; i++) {
        uint32_t before = random_mix(places[i - 1]) >> 4, key = random_mix(places[i]) >> 4;
        right = places[i] < count && (key > before || (key == before && places[i] > places[i - 1]));
    }
    assert_true(right);
    free(words);
    free(pairs);
    free(list);
    kiln_threads_destroy(&threads);
}

/* Rings that have come round, with dead among them, and slots that are still empty. */
static void the_living_are_listed_by_system_and_serial(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_pool pool;
    pool_init(&pool, NULL, (const uint32_t[]){4, 0, 7}, 3);
    struct kiln_particle *records = kiln_buffer_host(&pool.records, KILN_READ_WRITE, &error);
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_sort *sort =
        kiln_sort_create(KILN_SORT_CPU, &(struct kiln_sort_setup){.threads = threads}, &error);
    struct kiln_buffer entries;
    kiln_buffer_init(&entries, NULL, pool.slot_count * sizeof(uint32_t), "entries");
    const struct kiln_sort_params params = {.systems = 7};
    uint32_t count = 1;
    assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
    assert_int_equal(count, 0);

    /* system 0 is on its second round: serials 3 .. 6, of which 4 died; system 2 has room left */
    pool.systems[0].next_serial = 7;
    for (uint32_t serial = 3; serial < 7; serial++)
        records[serial % 4].velocity_birth.w = serial != 4 ? KILN_PARTICLE_ALIVE : 0;
    pool.systems[2].next_serial = 3;
    for (uint32_t serial = 0; serial < 3; serial++)
        records[4 + serial].velocity_birth.w = KILN_PARTICLE_ALIVE;
    assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
    const uint32_t *list = kiln_buffer_host(&entries, KILN_READ, &error);
    static const uint32_t expected[] = {KILN_ENTRY(0, 3), KILN_ENTRY(0, 1), KILN_ENTRY(0, 2),
                                        KILN_ENTRY(2, 4), KILN_ENTRY(2, 5), KILN_ENTRY(2, 6)};
    assert_int_equal(count, 6);
    assert_memory_equal(list, expected, sizeof expected);
    kiln_buffer_finish(&entries);
    kiln_sort_destroy(&sort);
    kiln_threads_destroy(&threads);
    kiln_pool_finish(&pool);
}

static void bytes_are_those_that_are_taken(void **state)
{
    (void)state;
    const uint32_t slots = 100000;
    assert_int_equal(kiln_sort_bytes(KILN_SORT_CPU, slots), 8 * slots);
    assert_int_equal(kiln_sort_bytes(KILN_SORT_RADIX, slots), 16 * slots);
    assert_int_equal(kiln_sort_bytes(KILN_SORT_BITONIC, slots), 8 * 131072 + 8 * slots);
    assert_int_equal(kiln_sort_bytes(KILN_SORT_ODDEVEN, slots), 8 * 131072 + 8 * slots);
    assert_int_equal(kiln_sort_bytes(KILN_SORT_SPREAD, slots), 8 * 131072 + 4 * slots);
}

/* A pool of three systems with particles at given depths along z; serial 3 of each is dead. */
static void fill_pool(struct kiln_pool *pool, uint32_t capacity)
{
    struct kiln_error error = {0};
    pool_init(pool, NULL, (const uint32_t[]){capacity, capacity, capacity}, 3);
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
        struct kiln_sort *sort =
            kiln_sort_create(KILN_SORT_CPU, &(struct kiln_sort_setup){.threads = threads}, &error);
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
    struct kiln_sort *sort =
        kiln_sort_create(KILN_SORT_CPU, &(struct kiln_sort_setup){.threads = threads}, &error);
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
        cmocka_unit_test(keys_of_any_span_are_sorted),
        cmocka_unit_test(the_most_particles_are_sorted),
        cmocka_unit_test(the_living_are_listed_by_system_and_serial),
        cmocka_unit_test(bytes_are_those_that_are_taken),
        cmocka_unit_test(farthest_come_first_and_ties_by_system_and_serial),
        cmocka_unit_test(front_to_back_is_the_exact_reverse),
    };
    return cmocka_run_group_tests_name("sort", tests, NULL, NULL);
}
