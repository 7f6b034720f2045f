/* sort=cpu by depth: against qsort, with depths that fill cells evenly, hardly, or too much; at
 * every level and for any number of threads. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/simd.h"
#include "shared/keys.h"
#include "shared/random.h"
#include "sort/pairs.h"
#include "sort/sort.h"
#include "support/cmocka.h"
#include "support/pools.h"
#include "support/sort_keys.h"

enum { CAPACITY = 40003, SLOTS = 2 * CAPACITY, TURN = 123 }; /* serials from TURN on */

enum depths { CLOUD, AROUND, ONE, FEW_DEPTHS, SLABS, FAR_ONES, TAILS, TINY, DEPTHS };

static float unit(uint32_t seed)
{
    return (float)(random_mix(seed) >> 8) * 0x1p-24f;
}

/* In front of an eye at 0 that looks along +z. */
static float depth_of(enum depths depths, uint32_t i)
{
    const float x = unit(i), signed_x = 2.0f * x - 1.0f;
    switch (depths) {
    case CLOUD:
        return 7.0f + 2.0f * x;
    case AROUND: /* and behind it */
        return 5.0f * signed_x;
    case ONE:
        return 3.25f;
    case FEW_DEPTHS:
        return floorf(8.0f * x) - 4.0f;
    case SLABS: /* more in the near one than one thread may sort */
        return (unit(i + 7) < 0.9f ? 2.0f : 60.0f) + 1e-4f * x;
    case FAR_ONES:
        return i % 500 == 0 ? -1e6f * x : signed_x;
    case TAILS:
        return signed_x * signed_x * signed_x * signed_x * signed_x * 1000.0f;
    default: /* of one size and both signs: less than a cell could hold of */
        return (i % 2 ? 1.0f : -1.0f) * 0x1p-99f * (1.0f + x);
    }
}

static void fill(struct kiln_pool *pool, struct kiln_particle *records, enum depths depths)
{
    memset(records, 0, SLOTS * sizeof *records);
    for (uint32_t system = 0; system < 2; system++) {
        pool->systems[system].next_serial = CAPACITY + TURN;
        for (uint32_t serial = TURN; serial < CAPACITY + TURN; serial++) {
            const uint32_t slot = pool->systems[system].base + serial % CAPACITY;
            const float z = depth_of(depths, slot);
            records[slot].position_serial = UINT4(0, 0, FLOAT_BITS(z), serial);
            records[slot].velocity_birth.w = random_mix(serial) % 7 ? KILN_PARTICLE_ALIVE : 0;
        }
    }
}

/* Pairs of key and place in the order of serials, sorted; entries by place. */
static uint32_t expect(const struct kiln_pool *pool, const struct kiln_particle *records,
                       kiln_sort_pair *pairs, uint32_t *entries)
{
    uint32_t count = 0;
    for (uint32_t system = 0; system < 2; system++) {
        for (uint32_t serial = TURN; serial < CAPACITY + TURN; serial++) {
            const uint32_t slot = pool->systems[system].base + serial % CAPACITY;
            if (!particle_is_alive(records[slot]))
                continue;
            const uint32_t key =
                key_of_particle(records[slot], (float3){0, 0, 0}, (float3){0, 0, 1});
            pairs[count] = (kiln_sort_pair)key << 32 | count;
            entries[count++] = KILN_ENTRY(system, slot);
        }
    }
    qsort(pairs, count, sizeof *pairs, by_pair);
    return count;
}

struct expected {
    kiln_sort_pair pairs[SLOTS];
    uint32_t entries[SLOTS], count;
};

static void expect_order(struct kiln_pool *pool, uint32_t threads, const struct expected *expected,
                         enum depths depths)
{
    struct kiln_error error = {0};
    struct kiln_threads *workers = kiln_threads_create(threads);
    struct kiln_sort *sort =
        kiln_sort_create(KILN_SORT_CPU, &(struct kiln_sort_setup){.threads = workers}, &error);
    assert_non_null(sort);
    struct kiln_buffer list;
    kiln_buffer_init(&list, NULL, SLOTS * sizeof(uint32_t), "entries");
    for (int reverse = 0; reverse < 2; reverse++) {
        const struct kiln_sort_params params = {
            .forward = {0, 0, 1},
            .systems = 3,
            .order = reverse ? KILN_SORT_FRONT_TO_BACK : KILN_SORT_BACK_TO_FRONT,
        };
        uint32_t count = 0;
        assert_true(kiln_sort_run(sort, pool, &params, &list, &count, &error));
        assert_int_equal(count, expected->count);
        const uint32_t *entries = kiln_buffer_host(&list, KILN_READ, &error);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t place = (uint32_t)expected->pairs[reverse ? count - 1 - i : i];
            if (entries[i] != expected->entries[place])
                fail_msg("depths %d, %u threads, reverse %d: entry %u", (int)depths, threads,
                         reverse, i);
        }
    }
    kiln_buffer_finish(&list);
    kiln_sort_destroy(&sort);
    kiln_threads_destroy(&workers);
}

static void any_depths_are_sorted(void **state)
{
    (void)state;
    static struct expected expected;
    struct kiln_error error = {0};
    struct kiln_pool pool;
    pool_init(&pool, NULL, (const uint32_t[]){CAPACITY, CAPACITY}, 2);
    struct kiln_particle *records = kiln_buffer_host(&pool.records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    for (int depths = 0; depths < DEPTHS; depths++) {
        fill(&pool, records, (enum depths)depths);
        expected.count = expect(&pool, records, expected.pairs, expected.entries);
        assert_true(expected.count > SLOTS / 2);
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            setenv("KILN_SIMD", kiln_simd_name(simd), 1);
            expect_order(&pool, 1, &expected, (enum depths)depths);
            expect_order(&pool, 3, &expected, (enum depths)depths);
        }
    }
    unsetenv("KILN_SIMD");
    kiln_pool_finish(&pool);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_depths_are_sorted),
    };
    return cmocka_run_group_tests_name("sort_depth", tests, NULL, NULL);
}
