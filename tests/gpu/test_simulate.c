/* Checks that each technique of the stage `simulate` computes the same bits as `cpu` after every
 * step, for scenes with every kind of emitter, force, collider and interaction, and with particles
 * born of other particles (families). If this fails, the state of a simulation depends on the
 * technique or the device (docs/determinism.md). */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "shared/papers/step_layout.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/family_fixture.h"
#include "support/parts.h"
#include "support/simulation.h"

static struct scene_fixture fixture; /* too large for a stack */

enum { STEPS = 300 };

static const struct {
    enum kiln_simulate_technique technique;
    uint32_t threads;
    uint32_t steps; /* how many steps are compared; few for `texels`, slow on software GL */
    const char *name;
} WAYS[] = {
    {KILN_SIMULATE_INPLACE, 1, STEPS, "inplace"},   {KILN_SIMULATE_PINGPONG, 1, STEPS, "pingpong"},
    {KILN_SIMULATE_FEEDBACK, 1, STEPS, "feedback"}, {KILN_SIMULATE_TEXELS, 1, 60, "texels"},
    {KILN_SIMULATE_CPU, 1, STEPS, "one thread"},    {KILN_SIMULATE_CPU, 8, STEPS, "eight threads"},
};
enum { WAY_COUNT = sizeof WAYS / sizeof *WAYS, DEVICE_WAYS = WAY_COUNT - 2 };

/* Runs the scene with `cpu` and with the first `ways` rows of WAYS, and compares the state hashes
 * after each step. A test gives WAY_COUNT if it checks what each technique does in its own way:
 * binding buffers, and storing particles that are born, move and die. A test of the step itself,
 * whose source all techniques share, gives 1, since software GL takes long to compile large
 * kernels. */
static void some_agree(struct kiln_device *device, const struct kiln_scene *scene, uint32_t steps,
                       size_t ways)
{
    struct simulation cpu, others[WAY_COUNT];
    simulation_start(&cpu, scene, NULL, 2);
    for (size_t i = 0; i < ways; i++)
        simulation_start_with(&others[i], scene, device, WAYS[i].technique, WAYS[i].threads);
    uint64_t most = 0;
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&cpu, 1);
        uint64_t cpu_alive, alive;
        struct kiln_state_hash a = simulation_hash(&cpu, &cpu_alive);
        for (size_t i = 0; i < ways; i++) {
            if (step > WAYS[i].steps)
                continue;
            simulation_run(&others[i], 1);
            struct kiln_state_hash b = simulation_hash(&others[i], &alive);
            if (cpu_alive != alive || a.lane[0] != b.lane[0] || a.lane[1] != b.lane[1])
                fail_msg("step %u: %08x%08x of %u on cpu, %08x%08x of %u with %s", step, a.lane[0],
                         a.lane[1], (unsigned)cpu_alive, b.lane[0], b.lane[1], (unsigned)alive,
                         WAYS[i].name);
        }
        most = cpu_alive > most ? cpu_alive : most;
    }
    assert_true(most > 1000);
    for (size_t i = 0; i < ways; i++) {
        if (steps <= WAYS[i].steps)
            assert_memory_equal(simulation_records(&cpu), simulation_records(&others[i]),
                                cpu.pool.slot_count * sizeof(struct kiln_particle));
        simulation_end(&others[i]);
    }
    simulation_end(&cpu);
}

/* Compares all rows of WAYS if test_is_full, otherwise only the first row. */
static void all_agree(struct kiln_device *device, const struct kiln_scene *scene, uint32_t steps)
{
    some_agree(device, scene, steps, test_is_full() ? WAY_COUNT : 1);
}

static void velocity_first(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    some_agree(*state, &fixture.scene, STEPS, WAY_COUNT);
}

static void position_first(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_POSITION_FIRST, STEPS);
    some_agree(*state, &fixture.scene, STEPS, 1);
}

static void round_colliders(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, STEPS);
    fixture_add_round(&fixture);
    some_agree(*state, &fixture.scene, STEPS, 1);
}

static void turned_colliders(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 60);
    fixture_add_oriented(&fixture);
    some_agree(*state, &fixture.scene, 60, 1);
}

static void fields_agree(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 120);
    for (uint32_t i = 0; i < fixture.scene.system_count; i += 2)
        fixture_add_field(&fixture.scene.systems[i])->strength =
            fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, 0.5f, 1.0f, 2.0f);
    all_agree(*state, &fixture.scene, 120);
}

static void colliders_out_of_grids_agree(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 90);
    fixture_add_terrain(&fixture, -0.4f, 3.0f, 0.9f, 40);
    fixture_add_moving_mesh(&fixture);
    some_agree(*state, &fixture.scene, 90, 1);
}

static void volumes_agree(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 60);
    fixture_add_moving_volumes(&fixture);
    some_agree(*state, &fixture.scene, 60, 1);
}

static void depth_maps_agree(void **state)
{
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 60);
    struct kiln_object *mesh = fixture_add_moving_mesh(&fixture);
    fixture_map_depths(mesh, 64);
    mesh->depth_directions[1] = fixture_constant3(0.3f, -1.0f, 0.2f);
    some_agree(*state, &fixture.scene, 60, 1);
}

/* Adds a system of particles that collide with each other and attract each other; with
 * KILN_CONTACT_EXACT they flock, too. x: of the emitter's centre, m. Some values of the
 * interactions vary over time, others over the life, so that both clocks are tested. */
static void add_crowd(const char *name, float x, enum kiln_contact_mode mode)
{
    struct kiln_system *s = fixture_add_system(&fixture, name, 400.0f);
    s->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {500, 500}};
    s->emit.burst_count = 1;
    s->emit.shape = KILN_EMITTER_SPHERE;
    s->emit.radius = fixture_constant(0.7f);
    s->emit.origin = fixture_constant3(x, 0.5f, 0.0f);
    s->emit.turn = fixture_constant(2.0f);
    s->emit.angle = fixture_constant(3.0f);
    s->collide.enabled = true;
    s->look.size = fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, 0.1f, 1.0f, 0.3f);
    s->look.scale = fixture_range(0.5f, 1.5f);
    struct kiln_interaction *collide = fixture_add_collisions(s, 0.0f);
    collide->mode = mode;
    collide->as_drawn = mode == KILN_CONTACT_EXACT;
    collide->radius = fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, 0.01f, 1.0f, 0.2f);
    collide->restitution = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 2.0f, 1.0f);
    collide->fastest = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 0.5f, 4.0f);
    collide->spins = true;
    collide->friction = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.0f, 0.5f, 0.8f);
    collide->turning = fixture_range(0.0f, 30.0f);
    collide->rolling = fixture_constant(0.02f);
    s->collide.friction = fixture_constant(0.4f);
    fixture_add_gravity(s, 0.0f)->strength =
        fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0.0f, -0.02f, 1.0f, 0.05f);
    if (mode == KILN_CONTACT_EXACT)
        fixture_add_flock(s, 0.3f)->radius =
            fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.0f, 0.1f, 2.0f, 0.4f);
}

/* Makes the particles of each system collide among themselves, and adds four systems: two of
 * add_crowd, one for each mode of contact, stars that attract each other, and birds that flock. */
static void crowd_the_fixture(void)
{
    for (uint32_t i = 0; i < fixture.scene.system_count; i++) {
        struct kiln_interaction *collide = fixture_add_collisions(&fixture.scene.systems[i], 0.05f);
        collide->spins = i % 2 == 1;
        collide->fastest = fixture_constant(KILN_VALUE_BY_WORD);
    }
    add_crowd("drawn", -1.0f, KILN_CONTACT_EXACT);
    add_crowd("staggered", 1.0f, KILN_CONTACT_STAGGERED);
    fixture_add_gravity(fixture_add_system(&fixture, "stars", 200.0f), 0.02f);
    fixture_add_flock(fixture_add_system(&fixture, "birds", 300.0f), 0.25f);
    fixture_finish(&fixture, 40);
}

static void crowds_agree(void **state)
{
    fixture_init(&fixture);
    fixture.scene.integration = KILN_INTEGRATE_POSITION_FIRST;
    crowd_the_fixture();
    all_agree(*state, &fixture.scene, 24);
}

/* `inplace` agrees with `cpu` in a scene that combines families, wind from a file, terrain, a
 * moving mesh and crowds. Other techniques are not compared, since kernels with families take long
 * to compile. */
static void families_among_all_agree(void **state)
{
    fixture_family(&fixture, KILN_INTEGRATE_POSITION_FIRST);
    fixture_add_field(&fixture.scene.systems[0]);
    fixture_add_terrain(&fixture, -0.4f, 3.0f, 0.9f, 40);
    fixture_add_moving_mesh(&fixture);
    crowd_the_fixture();
    some_agree(*state, &fixture.scene, 40, 1);
}

/* A scene with every kind of force, some with several options, agrees with each integrator; unless
 * test_is_full, only the first and the last integrator are tested. */
static void whirls_agree(void **state)
{
    for (int order = 0; order < 4; order += test_is_full() ? 1 : 3) {
        fixture_zoo(&fixture, (enum kiln_integration)order, 0);
        fixture_add_whirls(&fixture);
        fixture_add_field(&fixture.scene.systems[0])->mode = KILN_WIND_ADD;
        fixture_finish(&fixture, 60);
        some_agree(*state, &fixture.scene, 60, 1);
    }
}

/* Each kind of force agrees in a scene with only this force. Kernels are compiled with only the
 * forces that the scene has, so the code of the force could be missing there. */
static void each_force_alone_agrees(void **state)
{
    enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS];
    const uint32_t count = fixture_force_kinds(kinds);
    for (uint32_t i = 0; i < count; i++) {
        fixture_alone(&fixture, kinds[i], 20);
        some_agree(*state, &fixture.scene, 20, 1);
    }
}

static void families_agree(void **state)
{
    fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
    fixture_finish(&fixture, 90);
    all_agree(*state, &fixture.scene, 90);
}

static void families_by_rk4_agree(void **state)
{
    fixture_family(&fixture, KILN_INTEGRATE_RK4);
    fixture_finish(&fixture, 60);
    some_agree(*state, &fixture.scene, 60, 1);
}

/* No birth is lost or doubled where the technique `feedback` splits the births of a step among
 * invocations of a geometry shader, each with up to SIM_EMITTER_BIRTHS births. One step has 500
 * times this number plus one; others have this number, one less, or none. */
static void births_are_split_among_emitters(void **state)
{
    fixture_init(&fixture);
    struct kiln_system *s = fixture_add_system(&fixture, "burst", 0.0f);
    s->emit.bursts[0] = (struct kiln_burst){
        .time_s = 0.1, .count = {500 * SIM_EMITTER_BIRTHS + 1, 500 * SIM_EMITTER_BIRTHS + 1}};
    s->emit.bursts[1] =
        (struct kiln_burst){.time_s = 0.5, .count = {SIM_EMITTER_BIRTHS, SIM_EMITTER_BIRTHS}};
    s->emit.bursts[2] = (struct kiln_burst){
        .time_s = 0.6, .count = {SIM_EMITTER_BIRTHS - 1, SIM_EMITTER_BIRTHS - 1}};
    s->emit.burst_count = 3;
    fixture_finish(&fixture, 60);
    all_agree(*state, &fixture.scene, 60);
}

static void no_systems_and_no_births(void **state)
{
    for (uint32_t systems = 0; systems <= 1; systems++) {
        fixture_init(&fixture);
        if (systems)
            fixture_add_system(&fixture, "quiet", 0.0f);
        fixture_finish(&fixture, 10);
        for (size_t i = 0; i < DEVICE_WAYS; i++) {
            struct simulation run;
            uint64_t alive = 1;
            simulation_start_with(&run, &fixture.scene, *state, WAYS[i].technique, WAYS[i].threads);
            simulation_run(&run, 10);
            struct kiln_state_hash hash = simulation_hash(&run, &alive);
            assert_int_equal(alive, 0);
            assert_int_equal(hash.lane[0] | hash.lane[1], 0);
            simulation_end(&run);
        }
    }
}

/* All techniques agree in a scene loaded from a file, with 2000 births a second in each system. */
static void a_scene_from_a_file(void **state)
{
    struct kiln_error error = {0};
    const char *const overrides[] = {"systems.*.emit.rate=2000"};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    params.override_count = 1;
    struct kiln_scene *scene =
        kiln_scene_load(KILN_SOURCE_DIR "/scenes/fire_beam.yaml", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    all_agree(*state, scene, 120);
    kiln_scene_destroy(&scene);
}

static struct kiln_state_hash hash_shown(struct simulation *run, uint64_t *alive)
{
    struct kiln_error error = {0};
    if (!kiln_simulate_show_births(run->simulate, &run->pool, run->step, &error))
        fail_msg("%s", error.message);
    const struct kiln_state_hash hash = simulation_hash(run, alive);
    if (!kiln_simulate_hide_births(run->simulate, &run->pool, &error))
        fail_msg("%s", error.message);
    return hash;
}

/* kiln_simulate_show_births adds the bursts at a state's own time to the state, so that a frame
 * shows them (docs/determinism.md, 7). It adds the same particles with each technique, and after
 * kiln_simulate_hide_births the states of this step and of later steps have their usual hashes. */
static void bursts_are_shown_at_their_time(void **state)
{
    static const char text[] =
        "kiln: 1\n"
        "output: {fps: 30, frames: 60}\n"
        "simulation: {rate: 60, warmup: 0.1 s}\n"
        "systems:\n"
        "  sparks: {emit: {bursts: {-0.1 s: 70, 0 s: 300}, rate: 900, speed: [1, 3]}}\n"
        "  balls:\n"
        "    emit: {bursts: {0 s: 50}, from: {box: {size: [2, 1, 1]}}}\n"
        "    interact: [{collide: {radius: 8 cm, spin: true, turning: [1 rad/s, 3 rad/s]}}]\n";
    static const uint32_t at[] = {0, 6}; /* steps at -0.1 s, the start of the run, and at 0 s */
    static const uint64_t born[] = {70, 350};
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    struct kiln_scene *scene = kiln_scene_parse(text, sizeof text - 1, "bursts", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    struct simulation plain, run;
    struct kiln_state_hash shown[2], states[3];
    uint64_t alive, before;
    simulation_start(&plain, scene, NULL, 2); /* the reference, which never shows bursts */
    for (size_t k = 0; k < 3; k++) {
        simulation_run(&plain, k < 2 ? at[k] - plain.step : 5);
        states[k] = simulation_hash(&plain, &alive);
    }
    for (size_t i = WAY_COUNT; i-- > 0;) { /* from the last row, so that `cpu` comes first */
        const bool host = WAYS[i].technique == KILN_SIMULATE_CPU;
        if (!host && i > 0 && !test_is_full())
            continue;
        simulation_start_with(&run, scene, host ? NULL : *state, WAYS[i].technique,
                              WAYS[i].threads);
        for (size_t k = 0; k < 3; k++) {
            simulation_run(&run, k < 2 ? at[k] - run.step : 5);
            struct kiln_state_hash hash = simulation_hash(&run, &before);
            assert_memory_equal(&hash, &states[k], sizeof hash);
            if (k == 2)
                break;
            hash = hash_shown(&run, &alive);
            assert_int_equal(alive, before + born[k]);
            shown[k] = i == WAY_COUNT - 1 ? hash : shown[k];
            assert_memory_equal(&hash, &shown[k], sizeof hash);
        }
        simulation_end(&run);
    }
    simulation_end(&plain);
    kiln_scene_destroy(&scene);
}

/* Continues a run for `steps` steps with another technique. device: NULL for `cpu`. */
static void continue_with(struct simulation *run, struct kiln_device *device,
                          enum kiln_simulate_technique technique, uint32_t steps)
{
    struct kiln_error error = {0};
    struct kiln_simulate *other =
        kiln_simulate_create(device, &fixture.scene, technique, KILN_GAS_CPU, run->threads, &error);
    if (!other)
        fail_msg("%s", error.message);
    for (uint32_t i = 0; i < steps; i++)
        assert_true(kiln_simulate_step(other, &run->pool, ++run->step, &error));
    kiln_simulate_destroy(&other);
}

/* A run that changes its technique between steps ends with the same particles as a run with `cpu`
 * alone. The particles' records are moved to the memory of the next technique. */
static void a_run_can_change_its_technique(void **state)
{
    struct simulation cpu, run;
    fixture_family(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT);
    fixture_finish(&fixture, 200);
    simulation_start(&cpu, &fixture.scene, NULL, 1);
    simulation_run(&cpu, 200);
    simulation_start(&run, &fixture.scene, *state, 1);
    simulation_run(&run, 40);
    for (size_t i = 1; i < DEVICE_WAYS; i++) {
        continue_with(&run, *state, WAYS[i].technique, 21);
        continue_with(&run, NULL, KILN_SIMULATE_CPU, 19);
        continue_with(&run, *state, WAYS[i].technique, 10);
    }
    simulation_run(&run, 200 - run.step);
    assert_memory_equal(simulation_records(&cpu), simulation_records(&run),
                        cpu.pool.slot_count * sizeof(struct kiln_particle));
    simulation_end(&cpu);
    simulation_end(&run);
}

/* The size of work groups, the number of particles that a group of GPU threads computes, changes no
 * bit of the state. A size beyond the device's limit is refused. */
static void work_groups_may_have_any_size(void **state)
{
    struct kiln_device *device = *state;
    static const uint32_t sizes[] = {1, 8, 96, 1024};
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 60);
    struct simulation cpu, run;
    uint64_t alive = 0;
    simulation_start(&cpu, &fixture.scene, NULL, 1);
    simulation_run(&cpu, 60);
    struct kiln_state_hash expected = simulation_hash(&cpu, &alive);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        device->work_group_size = sizes[i];
        enum kiln_simulate_technique technique =
            i % 2 ? KILN_SIMULATE_PINGPONG : KILN_SIMULATE_INPLACE;
        simulation_start_with(&run, &fixture.scene, device, technique, 1);
        device->work_group_size = 0; /* the run keeps the size that it was created with */
        simulation_run(&run, 60);
        struct kiln_state_hash hash = simulation_hash(&run, &alive);
        assert_memory_equal(&hash, &expected, sizeof hash);
        simulation_end(&run);
    }
    struct kiln_error error = {0};
    device->work_group_size = (uint32_t)device->info.max_work_group_invocations + 1;
    assert_null(kiln_simulate_create(device, &fixture.scene, KILN_SIMULATE_INPLACE, KILN_GAS_CPU,
                                     cpu.threads, &error));
    expect_error(&error, KILN_USAGE, "a work group has %u invocations; %s takes at most %d",
                 device->work_group_size, device->info.name,
                 device->info.max_work_group_invocations);
    device->work_group_size = 0;
    simulation_end(&cpu);
}

static void two_buffers_count_twice(void **state)
{
    (void)state;
    assert_int_equal(kiln_simulate_slot_bytes(KILN_SIMULATE_CPU), 32);
    assert_int_equal(kiln_simulate_slot_bytes(KILN_SIMULATE_INPLACE), 32);
    assert_int_equal(kiln_simulate_slot_bytes(KILN_SIMULATE_PINGPONG), 64);
    assert_int_equal(kiln_simulate_slot_bytes(KILN_SIMULATE_FEEDBACK), 64);
    assert_int_equal(kiln_simulate_slot_bytes(KILN_SIMULATE_TEXELS), 96);
}

static void an_exact_device_is_needed(void **state)
{
    struct kiln_device *device = *state;
    fixture_init(&fixture);
    bool exact = device->info.exact;
    for (size_t i = 0; i < DEVICE_WAYS; i++) {
        struct kiln_error error = {0};
        assert_null(kiln_simulate_create(NULL, &fixture.scene, WAYS[i].technique, KILN_GAS_CPU,
                                         NULL, &error));
        expect_error(&error, KILN_USAGE, "without a device, only simulate=cpu is allowed");
        error = (struct kiln_error){0};
        device->info.exact = false;
        assert_null(kiln_simulate_create(device, &fixture.scene, WAYS[i].technique, KILN_GAS_CPU,
                                         NULL, &error));
        expect_error(&error, KILN_USAGE,
                     "%s computes inexactly and cannot simulate; use simulate=cpu",
                     device->info.name);
        device->info.exact = exact;
    }
}

int main(int argc, char **argv)
{
    /* The longest tests come first, so that each falls into another part when tests/times.cmake
     * splits this file into parts that run side by side. */
    static const struct CMUnitTest full[] = {
        test_on_device(families_among_all_agree),       test_on_device(depth_maps_agree),
        test_on_device(a_run_can_change_its_technique), test_on_device(families_by_rk4_agree),
        test_on_device(work_groups_may_have_any_size),
    };
    static const struct CMUnitTest tests[] = {
        test_on_device(families_agree),
        test_on_device(crowds_agree),
        test_on_device(fields_agree),
        test_on_device(velocity_first),
        test_on_device(two_buffers_count_twice),
        test_on_device(births_are_split_among_emitters),
        test_on_device(volumes_agree),
        test_on_device(whirls_agree),
        test_on_device(colliders_out_of_grids_agree),
        test_on_device(each_force_alone_agrees),
        test_on_device(no_systems_and_no_births),
        test_on_device(round_colliders),
        test_on_device(turned_colliders),
        test_on_device(position_first),
        test_on_device(a_scene_from_a_file),
        test_on_device(an_exact_device_is_needed),
        test_on_device(bursts_are_shown_at_their_time),
    };
    struct test_list list = {.count = 0};
    test_list_add_full(&list, full, sizeof full / sizeof *full);
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    return test_list_run(&list, "simulate", argc, argv, simulation_device_open, test_device_close);
}
