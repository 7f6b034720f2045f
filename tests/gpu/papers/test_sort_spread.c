/* Checks the sort that is spread over frames (UberFlow 2004, 4.3): it lists each particle once, and
 * converges to the order of a whole sort. If this fails, particles are lost, drawn twice, or stay
 * in a wrong order. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sort/sort.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/pools.h"
#include "support/scene_fixture.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

static struct kiln_sort *create_spread(struct kiln_device *device, uint32_t frames,
                                       struct kiln_error *error)
{
    const struct kiln_sort_setup setup = {.device = device, .frames = frames};
    return kiln_sort_create(KILN_SORT_SPREAD, &setup, error);
}

/* Runs the next part of a spread sort. */
static void advance(struct kiln_sort *sort, struct kiln_pool *pool,
                    const struct kiln_sort_params *params)
{
    struct kiln_error error = {0};
    const struct kiln_history history = kiln_sort_history(sort);
    if (!history.kind->advance(history.technique, pool, params->eye, params->forward, &error))
        fail_msg("%s", error.message);
}

/* A run of a scene with two sorts: a whole one with `cpu`, and one that is spread over frames. */
struct spread {
    struct simulation run;
    struct kiln_sort *whole, *spread;
    struct kiln_buffer whole_list, spread_list;
    uint32_t *seen; /* by slot: number of the last list that has it */
    uint32_t lists; /* number of lists so far */
};

static void spread_init(struct spread *s, struct kiln_device *device, uint32_t frames)
{
    struct kiln_error error = {0};
    *s = (struct spread){.lists = 0};
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 240);
    simulation_start(&s->run, &fixture.scene, device, 1);
    s->whole = kiln_sort_create(KILN_SORT_CPU, &(struct kiln_sort_setup){.threads = s->run.threads},
                                &error);
    s->spread = create_spread(device, frames, &error);
    if (!s->whole || !s->spread)
        fail_msg("%s", error.message);
    size_t bytes = s->run.pool.slot_count * sizeof(uint32_t);
    kiln_buffer_init(&s->whole_list, NULL, bytes, "whole");
    kiln_buffer_init(&s->spread_list, device, bytes, "spread");
    s->seen = calloc(s->run.pool.slot_count, sizeof *s->seen);
    assert_non_null(s->seen);
}

static void spread_finish(struct spread *s)
{
    kiln_sort_destroy(&s->whole);
    kiln_sort_destroy(&s->spread);
    kiln_buffer_finish(&s->whole_list);
    kiln_buffer_finish(&s->spread_list);
    free(s->seen);
    simulation_end(&s->run);
}

/* Checks that both sorts list the same particles, each once. Returns whether the order is equal. */
static bool spread_agrees(struct spread *s, const struct kiln_sort_params *params)
{
    struct kiln_error error = {0};
    uint32_t counts[2];
    if (!kiln_sort_run(s->whole, &s->run.pool, params, &s->whole_list, &counts[0], &error) ||
        !kiln_sort_run(s->spread, &s->run.pool, params, &s->spread_list, &counts[1], &error))
        fail_msg("%s", error.message);
    const uint32_t *whole = kiln_buffer_host(&s->whole_list, KILN_READ, &error);
    const uint32_t *spread = kiln_buffer_host(&s->spread_list, KILN_READ, &error);
    assert_true(whole && spread);
    assert_int_equal(counts[0], counts[1]);
    s->lists += 2;
    for (uint32_t i = 0; i < counts[0]; i++)
        s->seen[KILN_ENTRY_SLOT(whole[i])] = s->lists - 1;
    for (uint32_t i = 0; i < counts[0]; i++) {
        uint32_t slot = KILN_ENTRY_SLOT(spread[i]);
        assert_true(s->seen[slot] == s->lists - 1); /* in the whole list, and only once here */
        s->seen[slot] = s->lists;
    }
    return memcmp(whole, spread, counts[0] * sizeof *whole) == 0;
}

/* Runs the next part of the spread sort. Returns whether its order is that of the whole sort. */
static bool spread_follows(struct spread *s, struct kiln_sort_params *params)
{
    advance(s->spread, &s->run.pool, params);
    static const uint32_t masks[] = {0xffff, 5, 0};
    bool same = true;
    for (int i = 0; i < 6; i++) {
        params->systems = masks[i % 3];
        params->order = i % 2 ? KILN_SORT_FRONT_TO_BACK : KILN_SORT_BACK_TO_FRONT;
        same = spread_agrees(s, params) && same;
    }
    return same;
}

/* A spread sort lists each particle once. Once particles and camera have stood still for two
 * complete sorts, its order is that of a whole sort. */
static void a_spread_sort_converges(void **state)
{
    static const uint32_t frames[] = {1, 3, 16, 64};
    const float3 forwards[] = {{0.36f, 0.48f, -0.8f}, {-0.577350269f, 0.577350269f, 0.577350269f}};
    for (size_t f = 0; f < sizeof frames / sizeof *frames; f++) {
        struct spread s;
        spread_init(&s, *state, frames[f]);
        struct kiln_sort_params params = {.eye = {0.1f, 1.7f, 3.3f}, .forward = forwards[0]};
        simulation_run(&s.run, 60);
        assert_true(spread_follows(&s, &params)); /* the first sort is whole */
        uint32_t late = 0;
        for (int frame = 0; frame < 45; frame++) {
            simulation_run(&s.run, 4);
            params.forward = forwards[frame / 7 % 2];
            late += !spread_follows(&s, &params);
        }
        assert_true(frames[f] == 1 ? late == 0 : late > 10);
        for (uint32_t frame = 0; frame < 2 * frames[f] - 1; frame++)
            advance(s.spread, &s.run.pool, &params);
        for (int frame = 0; frame < 3; frame++)
            assert_true(spread_follows(&s, &params));
        spread_finish(&s);
    }
}

/* A spread sort lists pools with few slots or none, and systems without slots. A sort can not be
 * spread over 0 frames or more than KILN_SORT_MAX_SPREAD. */
static void small_pools_are_spread(void **state)
{
    static const uint32_t capacities[][3] = {{0, 0, 0}, {0, 1, 0}, {2, 0, 1}};
    struct kiln_error error = {0};
    for (size_t i = 0; i < sizeof capacities / sizeof *capacities; i++) {
        struct kiln_pool pool;
        pool_init(&pool, *state, capacities[i], 3);
        struct kiln_particle *records = kiln_buffer_host(&pool.records, KILN_READ_WRITE, &error);
        for (uint32_t slot = 0; slot < pool.slot_count; slot++)
            records[slot].velocity_birth.w = KILN_PARTICLE_ALIVE;
        for (int system = 0; system < 3; system++)
            pool.systems[system].next_serial = capacities[i][system];
        struct kiln_sort *sort = create_spread(*state, 4, &error);
        struct kiln_buffer entries;
        kiln_buffer_init(&entries, *state, pool.slot_count * sizeof(uint32_t), "entries");
        const struct kiln_sort_params params = {
            .forward = {0, 0, -1}, .systems = 7, .order = KILN_SORT_FRONT_TO_BACK};
        for (int frame = 0; frame < 6; frame++) {
            uint32_t count = 99;
            advance(sort, &pool, &params);
            assert_true(kiln_sort_run(sort, &pool, &params, &entries, &count, &error));
            assert_int_equal(count, pool.slot_count);
        }
        const uint32_t *list = kiln_buffer_host(&entries, KILN_READ, &error);
        for (uint32_t k = 0; i == 2 && k < 3; k++)
            assert_int_equal(list[k], ((const uint32_t[]){KILN_ENTRY(2, 2), 1, 0})[k]);
        kiln_buffer_finish(&entries);
        kiln_sort_destroy(&sort);
        kiln_pool_finish(&pool);
    }
    assert_null(create_spread(*state, 0, &error));
    assert_null(create_spread(*state, KILN_SORT_MAX_SPREAD + 1, &error));
    expect_error(&error, KILN_USAGE, "a sort can be spread over 1 to 64 frames, not 65");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_spread_sort_converges),
        test_on_device(small_pools_are_spread),
    };
    return cmocka_run_group_tests_name("sort_spread", tests, simulation_device_open,
                                       test_device_close);
}
