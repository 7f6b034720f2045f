/* Checks that the sorts on the device order pairs of key and index as qsort does, and that all
 * techniques of stage `sort` list the same particles in the same order. If this fails, particles
 * are lost or blended in a wrong order, and pictures depend on the technique. */
#include <inttypes.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "shared/random.h"
#include "sort/bitonic.h"
#include "sort/pairs.h"
#include "sort/papers/oddeven.h"
#include "sort/radix.h"
#include "sort/sort.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/parts.h"
#include "support/pools.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"
#include "support/sort_keys.h"

static struct scene_fixture fixture; /* too large for a stack */

/* A list to sort. `entries` are its draw entries. `pairs` hold a key and either the entry (for the
 * radix sort) or the entry's index in the list (for the networks). `sorted` receives the entries in
 * order. */
struct list {
    struct kiln_buffer pairs, entries, sorted;
    kiln_sort_pair *expected; /* pairs (key, index), sorted by qsort */
};

enum { MOST = 1 << 18 };

static uint32_t entry_of(uint32_t place)
{
    return place * 7u + 1u;
}

/* Fills a list with keys of a pattern. places: a pair holds its entry's index, not the entry. */
static void fill(struct list *list, enum pattern pattern, uint32_t count, bool places)
{
    struct kiln_error error = {0};
    uint32_t *pairs = kiln_buffer_host(&list->pairs, KILN_OVERWRITE, &error);
    uint32_t *entries = kiln_buffer_host(&list->entries, KILN_OVERWRITE, &error);
    assert_true(pairs && entries);
    for (uint32_t i = 0; i < count; i++) {
        pairs[2 * i] = key_of(pattern, i, count);
        pairs[2 * i + 1] = places ? i : entry_of(i);
        entries[i] = entry_of(i);
        list->expected[i] = (kiln_sort_pair)pairs[2 * i] << 32 | i;
    }
    qsort(list->expected, count, sizeof *list->expected, by_pair);
}

static void expect_sorted(struct list *list, struct kiln_buffer *result, const char *technique,
                          int pattern, uint32_t count, bool reverse)
{
    struct kiln_error error = {0};
    const uint32_t *sorted = kiln_buffer_host(result, KILN_READ, &error);
    assert_non_null(sorted);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t from = reverse ? count - 1 - i : i;
        uint32_t expected = entry_of((uint32_t)list->expected[from]);
        if (sorted[i] != expected)
            fail_msg("%s, pattern %d of %u: %u at %u instead of %u", technique, pattern, count,
                     sorted[i], i, expected);
    }
}

static void list_init(struct list *list, struct kiln_device *device, size_t most)
{
    kiln_buffer_init(&list->pairs, device, most * sizeof(kiln_sort_pair), "pairs");
    kiln_buffer_init(&list->entries, device, most * sizeof(uint32_t), "list");
    kiln_buffer_init(&list->sorted, device, most * sizeof(uint32_t), "sorted");
    list->expected = malloc(most * sizeof *list->expected);
    assert_non_null(list->expected);
}

static void list_finish(struct list *list)
{
    kiln_buffer_finish(&list->pairs);
    kiln_buffer_finish(&list->entries);
    kiln_buffer_finish(&list->sorted);
    free(list->expected);
}

/* Lengths of lists: near the sizes of work groups and of blocks, and long lists. */
static const uint32_t COUNTS[] = {0, 1, 2, 3, 255, 256, 257, 2047, 2048, 2049, 65536, 100003, MOST};
enum { COUNT_COUNT = sizeof COUNTS / sizeof *COUNTS };

/* Returns whether a length is tested with a pattern: long lists have few patterns. */
static bool is_worth_it(uint32_t count, int pattern)
{
    return count < 100000 || pattern == RANDOM || (count < MOST && pattern == FEW);
}

/* Tests the radix sort with the block sizes for software GL (`software`) or for GPUs. */
static void expect_radix_sorts(struct kiln_device *device, bool software)
{
    struct kiln_error error = {0};
    const bool is_software = device->info.software;
    device->info.software = software;
    struct kiln_radix *radix = kiln_radix_create(device, &error);
    device->info.software = is_software;
    if (!radix)
        fail_msg("%s", error.message);
    struct list list;
    list_init(&list, device, MOST);
    for (int c = 0; c < COUNT_COUNT; c++)
        for (int pattern = 0; pattern < PATTERNS; pattern++) {
            if (!is_worth_it(COUNTS[c], pattern))
                continue;
            bool reverse = pattern % 2;
            fill(&list, (enum pattern)pattern, COUNTS[c], false);
            if (!kiln_radix_pairs(radix, &list.pairs, COUNTS[c], reverse, &error))
                fail_msg("%s", error.message);
            expect_sorted(&list, &list.pairs, "radix", pattern, COUNTS[c], reverse);
        }
    list_finish(&list);
    kiln_radix_destroy(&radix);
    assert_null(radix);
}

static void radix_sorts_like_qsort(void **state)
{
    expect_radix_sorts(*state, true);
    expect_radix_sorts(*state, false);
}

static void expect_network_sorts(struct kiln_device *device, struct kiln_network *network,
                                 const char *technique)
{
    struct kiln_error error = {0};
    struct list list;
    list_init(&list, device, MOST);
    for (int c = 0; c < COUNT_COUNT; c++)
        for (int pattern = 0; pattern < PATTERNS; pattern++) {
            if (!is_worth_it(COUNTS[c], pattern))
                continue;
            bool reverse = pattern % 2;
            assert_true(kiln_network_padded(COUNTS[c]) <= MOST);
            fill(&list, (enum pattern)pattern, COUNTS[c], true);
            if (!kiln_network_pairs(network, &list.pairs, &list.entries, COUNTS[c], reverse,
                                    &list.sorted, &error))
                fail_msg("%s", error.message);
            expect_sorted(&list, &list.sorted, technique, pattern, COUNTS[c], reverse);
        }
    list_finish(&list);
}

static void networks_sort_like_qsort(void **state)
{
    struct kiln_error error = {0};
    struct kiln_bitonic *bitonic = kiln_bitonic_create(*state, &error);
    struct kiln_oddeven *oddeven = kiln_oddeven_create(*state, &error);
    if (!bitonic || !oddeven)
        fail_msg("%s", error.message);
    expect_network_sorts(*state, kiln_bitonic_network(bitonic), "bitonic");
    expect_network_sorts(*state, kiln_oddeven_network(oddeven), "oddeven");
    kiln_bitonic_destroy(&bitonic);
    kiln_oddeven_destroy(&oddeven);
    assert_true(!bitonic && !oddeven);
}

static uint32_t large_key(uint32_t place)
{
    return random_mix(place) >> 8;
}

static void fill_large(struct list *list, uint32_t count)
{
    struct kiln_error error = {0};
    uint32_t *pairs = kiln_buffer_host(&list->pairs, KILN_OVERWRITE, &error);
    uint32_t *entries = kiln_buffer_host(&list->entries, KILN_OVERWRITE, &error);
    uint32_t *sorted = kiln_buffer_host(&list->sorted, KILN_OVERWRITE, &error);
    assert_true(pairs && entries && sorted);
    for (uint32_t i = 0; i < count; i++) {
        pairs[2 * i] = large_key(i);
        pairs[2 * i + 1] = i;
        entries[i] = i;
        sorted[i] = UINT32_MAX; /* removes the result of an earlier sort */
    }
}

/* Checks that keys ascend, and indices among equal keys, so that no index occurs twice. */
static void expect_large(struct kiln_buffer *list, uint32_t count)
{
    struct kiln_error error = {0};
    const uint32_t *sorted = kiln_buffer_host(list, KILN_READ, &error);
    assert_non_null(sorted);
    for (uint32_t i = 1; i < count; i++) {
        uint32_t before = large_key(sorted[i - 1]), key = large_key(sorted[i]);
        if (sorted[i] >= count || key < before || (key == before && sorted[i] <= sorted[i - 1]))
            fail_msg("%u at %u, after %u", sorted[i], i, sorted[i - 1]);
    }
}

/* The radix sort orders the longest list that GL takes. */
static void the_most_particles_are_sorted(void **state)
{
    const uint32_t count = KILN_MAX_GL_PARTICLES;
    struct kiln_error error = {0};
    struct kiln_radix *radix = kiln_radix_create(*state, &error);
    assert_non_null(radix);
    struct list list;
    list_init(&list, *state, count);
    fill_large(&list, count);
    if (!kiln_radix_pairs(radix, &list.pairs, count, false, &error))
        fail_msg("%s", error.message);
    expect_large(&list.pairs, count);
    list_finish(&list);
    kiln_radix_destroy(&radix);
}

/* An axis of a dispatch has at most 65535 work groups; longer lists are sorted along two axes. */
static void networks_take_more_groups_than_an_axis(void **state)
{
    enum { GROUP = 4 };
    const uint32_t count = 1u << 19;
    assert_true(count / (2 * GROUP) > 65535);
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    device->work_group_size = GROUP;
    struct kiln_bitonic *bitonic = kiln_bitonic_create(device, &error);
    struct kiln_oddeven *oddeven = kiln_oddeven_create(device, &error);
    device->work_group_size = 0;
    assert_true(bitonic && oddeven);
    struct list list;
    list_init(&list, device, count);
    struct kiln_network *const networks[] = {kiln_bitonic_network(bitonic),
                                             kiln_oddeven_network(oddeven)};
    for (int i = 0; i < 2; i++) {
        fill_large(&list, count);
        if (!kiln_network_pairs(networks[i], &list.pairs, &list.entries, count, false, &list.sorted,
                                &error))
            fail_msg("%s", error.message);
        expect_large(&list.sorted, count);
    }
    list_finish(&list);
    kiln_bitonic_destroy(&bitonic);
    kiln_oddeven_destroy(&oddeven);
}

static void lengths_are_padded_to_powers_of_two(void **state)
{
    (void)state;
    assert_int_equal(kiln_network_padded(0), 1);
    assert_int_equal(kiln_network_padded(1), 1);
    assert_int_equal(kiln_network_padded(3), 4);
    assert_int_equal(kiln_network_padded(4), 4);
    assert_int_equal(kiln_network_padded((1u << 24) - 1), 1u << 24);
}

static const char *const NAMES[] = {
    [KILN_SORT_CPU] = "cpu",
    [KILN_SORT_RADIX] = "radix",
    [KILN_SORT_BITONIC] = "bitonic",
    [KILN_SORT_ODDEVEN] = "oddeven",
};
enum { TECHNIQUES = sizeof NAMES / sizeof *NAMES };

/* Sorts of every technique, and the list that each makes of the same pool. */
struct contest {
    struct kiln_sort *sorts[TECHNIQUES];
    struct kiln_buffer entries[TECHNIQUES];
    struct kiln_threads *threads;
};

static void contest_init(struct contest *contest, struct kiln_device *device, uint32_t slots)
{
    struct kiln_error error = {0};
    contest->threads = kiln_threads_create(2);
    const struct kiln_sort_setup setup = {.device = device, .threads = contest->threads};
    for (int i = 0; i < TECHNIQUES; i++) {
        contest->sorts[i] = kiln_sort_create((enum kiln_sort_technique)i, &setup, &error);
        if (!contest->sorts[i])
            fail_msg("%s", error.message);
        kiln_buffer_init(&contest->entries[i], device, slots * sizeof(uint32_t), "entries");
    }
}

static void contest_finish(struct contest *contest)
{
    for (int i = 0; i < TECHNIQUES; i++) {
        kiln_sort_destroy(&contest->sorts[i]);
        kiln_buffer_finish(&contest->entries[i]);
    }
    kiln_threads_destroy(&contest->threads);
}

/* Checks that all techniques list the same entries in the same order. Returns their number. */
static uint32_t expect_same_lists(struct contest *contest, struct kiln_pool *pool,
                                  const struct kiln_sort_params *params)
{
    struct kiln_error error = {0};
    uint32_t counts[TECHNIQUES] = {0, 1, 2, 3};
    const uint32_t *lists[TECHNIQUES];
    for (int i = 0; i < TECHNIQUES; i++) {
        if (!kiln_sort_run(contest->sorts[i], pool, params, &contest->entries[i], &counts[i],
                           &error))
            fail_msg("%s", error.message);
        lists[i] = kiln_buffer_host(&contest->entries[i], KILN_READ, &error);
        assert_non_null(lists[i]);
        assert_int_equal(counts[i], counts[0]);
        for (uint32_t k = 0; k < counts[0]; k++)
            if (lists[i][k] != lists[0][k])
                fail_msg("%s: %08x at %u of %u instead of %08x; systems %" PRIx64, NAMES[i],
                         lists[i][k], k, counts[0], lists[0][k], params->systems);
    }
    return counts[0];
}

/* Fills a pool with systems that have no or few slots, about as many as a block, or far more. Most
 * have reused their slots several times. Many of the particles have equal depths. */
static void fill_pool(struct kiln_pool *pool, struct kiln_device *device)
{
    static const uint32_t capacities[] = {1, 0, 2048, 20000, 2047, 7, 5000};
    enum { SYSTEMS = sizeof capacities / sizeof *capacities };
    struct kiln_error error = {0};
    pool_init(pool, device, capacities, SYSTEMS);
    struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    for (uint32_t system = 0; system < SYSTEMS; system++) {
        uint32_t capacity = capacities[system];
        pool->systems[system].next_serial = system == 6 ? capacity / 2 : capacity * 3u + 777u;
        for (uint32_t i = 0; i < capacity; i++) {
            struct kiln_particle *p = &records[pool->systems[system].base + i];
            float z = (float)(random_mix(i + system * 1000u) % 64) - 32.0f;
            float bits = z == 0.0f && i % 2 ? -0.0f : z;
            p->position_serial = UINT4(i, FLOAT_BITS(0.25f), FLOAT_BITS(bits), i);
            p->velocity_birth.w = i % 5 != 3 ? KILN_PARTICLE_ALIVE : 0;
        }
    }
}

static void all_techniques_list_alike(void **state)
{
    struct kiln_pool pool;
    fill_pool(&pool, *state);
    struct contest contest;
    contest_init(&contest, *state, pool.slot_count);
    static const uint32_t masks[] = {0, 1, 2, 0x7f, 0x55, 0x2a, 0x08, 0x40, 0xffff};
    for (size_t i = 0; i < sizeof masks / sizeof *masks; i++)
        for (int order = 0; order <= KILN_SORT_FRONT_TO_BACK; order++) {
            const struct kiln_sort_params params = {.eye = {1, 2, 8},
                                                    .forward = {0, 0, -1},
                                                    .systems = masks[i],
                                                    .order = (enum kiln_sort_order)order};
            uint32_t count = expect_same_lists(&contest, &pool, &params);
            assert_true((count > 20000) == (masks[i] == 0x7f || masks[i] == 0xffff));
        }
    contest_finish(&contest);
    kiln_pool_finish(&pool);
}

/* Lists are the same for any size of work groups, even one that is no power of two or too large. */
static void work_groups_of_any_size_sort_alike(void **state)
{
    struct kiln_device *device = *state;
    static const uint32_t sizes[] = {1, 8, 32, 96, 256, 1024, 1u << 20};
    struct kiln_pool pool;
    fill_pool(&pool, device);
    const struct kiln_sort_params params = {
        .eye = {1, 2, 8}, .forward = {0, 0, -1}, .systems = 0x7f, .order = KILN_SORT_BACK_TO_FRONT};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct contest contest;
        device->work_group_size = sizes[i];
        contest_init(&contest, device, pool.slot_count);
        device->work_group_size = 0;
        assert_true(expect_same_lists(&contest, &pool, &params) > 20000);
        contest_finish(&contest);
    }
    kiln_pool_finish(&pool);
}

/* All techniques list a simulated scene alike. In oblique views each rounding of depth counts. */
static void all_techniques_sort_a_scene_alike(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 120);
    struct simulation run;
    simulation_start(&run, &fixture.scene, *state, 1);
    struct contest contest;
    contest_init(&contest, *state, run.pool.slot_count);
    const float3 forwards[] = {{0.36f, 0.48f, -0.8f}, {-0.577350269f, 0.577350269f, 0.577350269f}};
    uint32_t most = 0;
    for (int frame = 0; frame < 12; frame++) {
        simulation_run(&run, 10);
        const struct kiln_sort_params params = {.eye = {0.1f, 1.7f, 3.3f + (float)frame},
                                                .forward = forwards[frame % 2],
                                                .systems = 0xffff,
                                                .order = KILN_SORT_BACK_TO_FRONT};
        uint32_t count = expect_same_lists(&contest, &run.pool, &params);
        most = count > most ? count : most;
    }
    assert_true(run.pool.system_count > 2);
    assert_true(most > 1000);
    contest_finish(&contest);
    simulation_end(&run);
}

static void records_stay_on_the_device(void **state)
{
    struct kiln_error error = {0};
    struct kiln_pool pool;
    fill_pool(&pool, *state);
    assert_true(kiln_buffer_gl(&pool.records, KILN_READ_WRITE, &error));
    const struct kiln_sort_params params = {
        .forward = {0, 0, -1}, .systems = 0x7f, .order = KILN_SORT_FRONT_TO_BACK};
    for (int technique = KILN_SORT_RADIX; technique < TECHNIQUES; technique++) {
        struct kiln_sort *sort =
            kiln_sort_create((enum kiln_sort_technique)technique,
                             &(struct kiln_sort_setup){.device = *state}, &error);
        struct kiln_buffer entries;
        kiln_buffer_init(&entries, *state, pool.slot_count * sizeof(uint32_t), "entries");
        uint32_t count = 0;
        assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
        assert_true(count > 0);
        assert_false(pool.records.host_valid);
        assert_false(entries.host_valid);
        kiln_buffer_finish(&entries);
        kiln_sort_destroy(&sort);
    }
    kiln_pool_finish(&pool);
}

static void device_techniques_need_an_exact_device(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    bool exact = device->info.exact;
    for (int technique = KILN_SORT_RADIX; technique < TECHNIQUES; technique++) {
        device->info.exact = exact;
        struct kiln_sort_setup setup = {.device = NULL};
        assert_null(kiln_sort_create((enum kiln_sort_technique)technique, &setup, &error));
        expect_error(&error, KILN_USAGE, "this sort needs a device; use sort=cpu");
        device->info.exact = false;
        setup.device = device;
        assert_null(kiln_sort_create((enum kiln_sort_technique)technique, &setup, &error));
        expect_error(&error, KILN_USAGE, "%s computes inexactly and cannot sort; use sort=cpu",
                     device->info.name);
    }
    device->info.exact = exact;
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest full[] = {
        test_on_device(the_most_particles_are_sorted),
        test_on_device(networks_take_more_groups_than_an_axis),
        test_on_device(work_groups_of_any_size_sort_alike),
    };
    static const struct CMUnitTest tests[] = {
        test_on_device(radix_sorts_like_qsort),
        test_on_device(networks_sort_like_qsort),
        test_on_device(lengths_are_padded_to_powers_of_two),
        test_on_device(all_techniques_list_alike),
        test_on_device(all_techniques_sort_a_scene_alike),
        test_on_device(records_stay_on_the_device),
        test_on_device(device_techniques_need_an_exact_device),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    test_list_add_full(&list, full, sizeof full / sizeof *full);
    return test_list_run(&list, "sort", argc, argv, simulation_device_open, test_device_close);
}
