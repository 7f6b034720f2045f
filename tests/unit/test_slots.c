/* lib/sim/step/slots_simd.c: stepping slots in blocks gives the bits of step_slot, and for families
 * those of step_family_slot and their traces, at every width of vectors and for any stretch of
 * slots. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "sim/step/bakes.h"
#include "sim/step/slots.h"
#include "sim/world/params.h"
#include "support/balls.h"
#include "support/cmocka.h"
#include "support/family_fixture.h"

static struct scene_fixture fixture; /* too large for a stack */

enum { STEPS = 150, STRETCH = 300 /* no multiple of a block */ };

/* What the zoo leaves out: a limited speed, and a curve of many keys. */
static void add_limited(struct scene_fixture *f)
{
    float points[20][2];
    for (int i = 0; i < 20; i++) {
        points[i][0] = (float)i / 19.0f;
        points[i][1] = 1.0f + (float)(i % 3);
    }
    struct kiln_system *s = fixture_add_system(f, "limited", 200.0f);
    s->emit.speed = fixture_range(1.0f, 9.0f);
    fixture_add_force(s, KILN_FORCE_LIMIT)->strength = fixture_keys(f, KILN_CLOCK_LIFE, 20, points);
}

static void step_in_blocks(kiln_slots_step *step_slots, struct kiln_slots *slots)
{
    const uint32_t used = slots->sim.step->used;
    for (uint32_t first = 0; first < used; first += STRETCH)
        step_slots(slots, first, used - first < STRETCH ? used : first + STRETCH, 0);
}

static void step_one_by_one(struct kiln_slots *slots)
{
    for (uint32_t slot = 0; slot < slots->sim.step->used; slot++)
        slots->records[slot] = step_slot(&slots->sim, slot, slots->records[slot]);
}

static void step_family_one_by_one(struct kiln_slots *slots)
{
    const struct kiln_family_params *family = &slots->sim.step->family;
    for (uint32_t slot = 0; slot < slots->sim.step->used; slot++) {
        struct kiln_trace parent = trace_nothing();
        if (family->born_of != BORN_OF_CLOCK)
            parent = slots->traces[family_parent_trace(&slots->sim, slot)];
        const struct step_result after =
            step_family_slot(&slots->sim, slot, slots->records[slot], parent);
        slots->records[slot] = after.particle;
        if (family->traced)
            slots->traces[family->traces + slot] = after.trace;
    }
}

/* How particles turn: before a system's step, after it slot by slot (`words`), and after it in
 * blocks. NULL where none does. */
struct spins {
    uint4 *before, *words, *blocks;
    size_t bytes;
};

static uint4 *make_spin_words(size_t bytes)
{
    uint4 *words = aligned_alloc(32, bytes);
    assert_non_null(words);
    memset(words, 0, bytes);
    return words;
}

static struct spins make_spins(uint32_t slots)
{
    struct spins spins = {.bytes = slots * sizeof(struct kiln_spin)};
    if (slots > 0) {
        spins.before = make_spin_words(spins.bytes);
        spins.words = make_spin_words(spins.bytes);
        spins.blocks = make_spin_words(spins.bytes);
    }
    return spins;
}

static void free_spins(struct spins *spins)
{
    free(spins->before);
    free(spins->words);
    free(spins->blocks);
}

/* Traces of all systems: after steps slot by slot, and after steps in blocks at each width of
 * vectors. */
struct traces {
    struct kiln_trace *all, *blocks[KILN_SIMD_COUNT];
    uint32_t count;
};

static struct kiln_trace *make_traces_of_way(uint32_t count)
{
    struct kiln_trace *traces = calloc((size_t)count + 1, sizeof *traces);
    assert_non_null(traces);
    return traces;
}

static struct traces make_traces(uint32_t count)
{
    struct traces traces = {.all = make_traces_of_way(count), .count = count};
    for (int simd = 0; simd < KILN_SIMD_COUNT; simd++)
        traces.blocks[simd] = make_traces_of_way(count);
    return traces;
}

static void free_traces(struct traces *traces)
{
    free(traces->all);
    for (int simd = 0; simd < KILN_SIMD_COUNT; simd++)
        free(traces->blocks[simd]);
}

/* Nothing is left of the step before: each slot of a system that is traced writes its trace. */
static void forget_traces(struct traces *traces)
{
    memset(traces->all, 0xa5, traces->count * sizeof *traces->all);
    for (int simd = 0; simd < KILN_SIMD_COUNT; simd++)
        memset(traces->blocks[simd], 0x5a, traces->count * sizeof *traces->all);
}

/* Holds what all systems are stepped with, and the particles of a system: before its step, and
 * after it in blocks. */
struct run {
    const struct kiln_sim_params *params;
    const float4 *words, *pushes, *planes;
    struct kiln_particle *records, *before, *blocks;
    struct spins spins;
    struct traces traces;
};

/* Steps a system in blocks at a width of vectors, from the state before the step, and compares what
 * comes out with `expected`, which was stepped slot by slot. */
static void compare_blocks(struct run *run, enum kiln_simd simd, const struct kiln_slots *expected)
{
    const struct kiln_step_params *step = expected->sim.step;
    const struct kiln_family_params *family = &step->family;
    const size_t bytes = step->used * sizeof *run->records;
    struct kiln_slots slots = *expected;
    slots.records = run->blocks;
    slots.traces = run->traces.blocks[simd];
    slots.sim.spin_words = run->spins.blocks;
    memcpy(run->blocks, run->before, bytes);
    if (run->spins.words)
        memcpy(run->spins.blocks, run->spins.before, run->spins.bytes);
    step_in_blocks(KILN_SIMD_PICK(kiln_slots_step, simd), &slots);
    assert_memory_equal(run->blocks, expected->records, bytes);
    if (family->traced)
        assert_memory_equal(slots.traces + family->traces, expected->traces + family->traces,
                            step->used * sizeof *slots.traces);
    if (run->spins.words)
        assert_memory_equal(run->spins.words, run->spins.blocks, run->spins.bytes);
}

/* Steps all systems slot by slot, and each from the same state in blocks, at all widths of vectors.
 * Returns the living. */
static uint32_t step_both(struct run *run)
{
    const struct kiln_sim_params *params = run->params;
    uint32_t alive = 0;
    forget_traces(&run->traces);
    for (uint32_t k = 0; k < params->system_count; k++) {
        const struct kiln_step_params *step = &params->systems[params->order[k]];
        struct kiln_slots slots = {
            .sim = {.step = step,
                    .surroundings = &params->surroundings,
                    .value_keys = fixture.scene.keys,
                    .grid_words = run->words,
                    .push_words = run->pushes,
                    .spin_words = run->spins.words,
                    .volume_words = run->planes},
            .records = run->records + step->base,
            .traces = run->traces.all,
        };
        if (run->spins.words)
            memcpy(run->spins.before, run->spins.words, run->spins.bytes);
        memcpy(run->before, slots.records, step->used * sizeof *run->records);
        if (kiln_sim_is_family(step))
            step_family_one_by_one(&slots);
        else
            step_one_by_one(&slots);
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (kiln_simd_has(simd))
                compare_blocks(run, simd, &slots);
        }
        for (uint32_t i = 0; i < step->used; i++)
            alive += particle_is_alive(slots.records[i]);
    }
    return alive;
}

/* Whatever others might do to a particle; some do nothing. */
static float4 *make_pushes(uint32_t slots)
{
    float4 *words = aligned_alloc(16, ((size_t)slots * 2 + 1) * sizeof *words);
    assert_non_null(words);
    uint32_t seed = 3;
    for (size_t i = 0; i < (size_t)slots * 2; i++) {
        const float reach = i % 6 < 2 ? 0.0f : i % 2 ? 0.02f : 0.5f;
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        const float radius = i % 2 ? 0.0f : 0.1f * (1.0f + balls_random(&seed));
        words[i] = FLOAT4(reach * x, reach * y, reach * z, radius);
    }
    return words;
}

/* Steps the fixture's scene at all widths of vectors. */
static void run_levels(void)
{
    struct kiln_error error = {0};
    struct simulation simulation;
    simulation_start(&simulation, &fixture.scene, NULL, 1);
    struct kiln_pool *pool = &simulation.pool;
    struct kiln_sim_params *params = malloc(sizeof *params);
    struct kiln_sim_grids grids;
    assert_non_null(params);
    assert_true(kiln_sim_grids_init(&grids, NULL, &fixture.scene, simulation.threads, &error));
    kiln_sim_params_init(params, &fixture.scene, &grids);
    struct kiln_bakes bakes;
    assert_true(kiln_bakes_init(&bakes, NULL, &fixture.scene, &grids, &error));
    float4 *pushes = make_pushes(params->push_count);
    struct run run = {.params = params,
                      .words = kiln_buffer_host(&grids.words, KILN_READ, &error),
                      .pushes = pushes,
                      .records = kiln_buffer_host(&pool->records, KILN_READ_WRITE, &error),
                      .before = calloc(pool->slot_count, sizeof *run.before),
                      .blocks = calloc(pool->slot_count, sizeof *run.blocks),
                      .spins = make_spins(params->spin_count),
                      .traces = make_traces(params->trace_count)};
    assert_true(run.records && run.before && run.blocks);
    uint32_t most = 0;
    for (uint32_t step = 1; step <= STEPS; step++) {
        assert_true(
            kiln_volumes_step(&grids.volumes, &fixture.scene, step, simulation.threads, &error));
        run.planes = kiln_buffer_host(&grids.volumes.words, KILN_READ, &error);
        assert_true(kiln_sim_params_step(params, &fixture.scene, pool, step, &error));
        assert_true(kiln_bakes_step(&bakes, params, simulation.threads, step, &error));
        const uint32_t alive = step_both(&run);
        most = alive > most ? alive : most;
    }
    assert_true(most > 1000);
    kiln_bakes_finish(&bakes);
    kiln_sim_grids_finish(&grids);
    free(pushes);
    free_spins(&run.spins);
    free_traces(&run.traces);
    free(run.before);
    free(run.blocks);
    free(params);
    simulation_end(&simulation);
}

static void velocity_first(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    add_limited(&fixture);
    fixture_finish(&fixture, STEPS);
    run_levels();
}

static void position_first_among_round_colliders(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_POSITION_FIRST, STEPS);
    fixture_add_round(&fixture);
    fixture_add_field(&fixture.scene.systems[0]);
    run_levels();
}

static void position_first_among_turning_colliders(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_POSITION_FIRST, STEPS);
    fixture_add_oriented(&fixture);
    run_levels();
}

static void above_terrain(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_terrain(&fixture, -0.4f, 3.0f, 0.9f, 40);
    run_levels();
}

static void around_a_moving_mesh(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_moving_mesh(&fixture);
    run_levels();
}

static void around_moving_volumes(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_moving_volumes(&fixture);
    run_levels();
}

static void around_a_moving_mesh_by_its_depths(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_POSITION_FIRST, STEPS);
    fixture_map_depths(fixture_add_moving_mesh(&fixture), 48);
    run_levels();
}

static void pushed_among_colliders(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    for (uint32_t i = 0; i < fixture.scene.system_count; i += 2)
        fixture_add_collisions(&fixture.scene.systems[i], 0.1f);
    struct kiln_interaction *turning = &fixture.scene.systems[0].interactions[0];
    turning->spins = true;
    turning->turning = fixture_range(1.0f, 40.0f);
    fixture.scene.systems[0].collide.friction = fixture_constant(0.4f);
    run_levels();
    fixture_add_terrain(&fixture, -0.4f, 3.0f, 0.9f, 40);
    fixture_add_moving_mesh(&fixture);
    run_levels();
}

/* Larger balls among what lies askew, whose corners are met before its bounds as they are. */
static void clamped_among_turning_colliders(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_oriented(&fixture);
    for (uint32_t i = 0; i < fixture.scene.system_count; i++) {
        fixture_add_collisions(&fixture.scene.systems[i], 0.1f);
        fixture.scene.systems[i].collide.mode = KILN_COLLIDE_CLAMP;
    }
    run_levels();
}

/* Each integrator, with all forces. */
static void whirls(void **state)
{
    (void)state;
    for (int order = 0; order < 4; order++) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 0);
        fixture_add_whirls(&fixture);
        add_limited(&fixture);
        fixture_add_field(&fixture.scene.systems[0])->mode = KILN_WIND_ADD;
        fixture_finish(&fixture, STEPS);
        run_levels();
    }
}

/* Lets forces, regions and demitters lie in a node that moves, turns and grows. */
static void attach_all(struct scene_fixture *f)
{
    const struct kiln_attach attach = {.name = "n", .node = 0};
    struct kiln_scene_node *node = &f->scene.nodes[f->scene.node_count++];
    *node = (struct kiln_scene_node){.name = "n"};
    node->position.value.x = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -0.5f, 2.0f, 0.5f);
    node->rotation.y = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.3f, 2.0f, 3.0f);
    node->scale = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.6f, 2.0f, 1.8f);
    for (uint32_t i = 0; i < f->scene.system_count; i++) {
        struct kiln_system *system = &f->scene.systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            struct kiln_force *force = &system->forces[k];
            force->attach = (i + k) % 3 ? attach : (struct kiln_attach){.name = NULL};
            force->region.enabled = force->region.sphere = k % 2;
            force->region.radius = fixture_constant(1.0f);
            force->region.falloff = fixture_constant(0.5f);
            force->region.attach = i % 2 ? attach : (struct kiln_attach){.name = NULL};
        }
        for (uint32_t k = 0; k < system->demitter_count; k++)
            system->demitters[k].attach = attach;
    }
}

/* Each integrator, with forces in a node. */
static void attached(void **state)
{
    (void)state;
    for (int order = 0; order < 4; order++) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 0);
        fixture_add_whirls(&fixture);
        fixture_add_field(&fixture.scene.systems[0]);
        attach_all(&fixture);
        fixture_finish(&fixture, STEPS);
        run_levels();
    }
}

/* Lets most systems move with a node that flies and turns. */
static void carry_systems(struct scene_fixture *f)
{
    struct kiln_scene_node *node = &f->scene.nodes[f->scene.node_count++];
    *node = (struct kiln_scene_node){.name = "ship", .scale = fixture_constant(1.0f)};
    node->position.value.x = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -1.0f, 2.0f, 3.0f);
    node->rotation.y = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.0f, 4.0f, 20.0f);
    node->rotation.z = fixture_ramp(f, KILN_CLOCK_TIME, 0.5f, 0.0f, 4.0f, 6.0f);
    for (uint32_t i = 0; i < f->scene.system_count; i++) {
        if (i % 4 != 3)
            f->scene.systems[i].space = (struct kiln_attach){.name = "ship"};
    }
}

/* Systems that move with a node, with each integrator and with clamping. */
static void carried_by_a_node(void **state)
{
    (void)state;
    for (int order = 0; order < 4; order++) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 0);
        carry_systems(&fixture);
        fixture_finish(&fixture, STEPS);
        fixture_add_oriented(&fixture);
        run_levels();
        fixture.scene.systems[0].collide.mode = KILN_COLLIDE_CLAMP;
        run_levels();
    }
    fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
    carry_systems(&fixture);
    fixture_finish(&fixture, STEPS);
    run_levels();
}

/* Births, deaths and bounces of parents, with each integrator. */
static void families(void **state)
{
    (void)state;
    for (int order = 0; order < 4; order++) {
        fixture_family(&fixture, (enum kiln_integration)order);
        fixture_finish(&fixture, STEPS);
        run_levels();
    }
}

/* Families whose particles push each other, spin, and bounce off what turns. */
static void pushed_families(void **state)
{
    (void)state;
    fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
    fixture_finish(&fixture, STEPS);
    fixture_add_oriented(&fixture);
    for (uint32_t i = 0; i < fixture.scene.system_count; i++) {
        fixture_add_collisions(&fixture.scene.systems[i], 0.05f);
        struct kiln_interaction *turning = &fixture.scene.systems[i].interactions[0];
        turning->spins = i % 2 == 0;
        turning->turning = fixture_range(1.0f, 40.0f);
    }
    run_levels();
}

static void each_force_alone(void **state)
{
    (void)state;
    enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS];
    const uint32_t count = fixture_force_kinds(kinds);
    for (uint32_t i = 0; i < count; i++) {
        fixture_alone(&fixture, kinds[i], STEPS);
        run_levels();
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(velocity_first),
        cmocka_unit_test(position_first_among_round_colliders),
        cmocka_unit_test(position_first_among_turning_colliders),
        cmocka_unit_test(above_terrain),
        cmocka_unit_test(around_a_moving_mesh),
        cmocka_unit_test(around_moving_volumes),
        cmocka_unit_test(around_a_moving_mesh_by_its_depths),
        cmocka_unit_test(pushed_among_colliders),
        cmocka_unit_test(clamped_among_turning_colliders),
        cmocka_unit_test(whirls),
        cmocka_unit_test(attached),
        cmocka_unit_test(carried_by_a_node),
        cmocka_unit_test(families),
        cmocka_unit_test(pushed_families),
        cmocka_unit_test(each_force_alone),
    };
    return cmocka_run_group_tests_name("slots", tests, NULL, NULL);
}
