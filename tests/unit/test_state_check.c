/* lib/job/state_check: a saved state with a value that no step makes is refused when it is read,
 * and the message names the value. Each test writes a state whose checksums and hash are right, as
 * somebody could who wants kiln to draw particles that are nowhere. If this fails, such a state is
 * stepped and drawn. */
#include <glob.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "job/state.h"
#include "job/state_check.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/scenes.h"
#include "support/simulation.h"

#define FILE_NAME "a.kilnstate"
#define MOTION    "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"

/* A run, and a second one that reads the states of the first. */
struct runs {
    struct kiln_scene *scene;
    struct simulation first, second;
};

static void start(struct runs *runs, const char *fixture, const char *override)
{
    runs->scene = load_fixture(fixture, override);
    simulation_start_with(&runs->first, runs->scene, NULL, KILN_SIMULATE_CPU, 1);
    simulation_start_with(&runs->second, runs->scene, NULL, KILN_SIMULATE_CPU, 1);
    simulation_run(&runs->first, 70);
}

static void end(struct runs *runs)
{
    simulation_end(&runs->first);
    simulation_end(&runs->second);
    kiln_scene_destroy(&runs->scene);
}

/* Saves the state of the first run, and has the second read it. */
static bool pass_on(struct runs *runs, struct kiln_error *error)
{
    struct simulation *run = &runs->first;
    struct kiln_state saved = {.pool = &run->pool}, read = {.pool = &runs->second.pool};
    memcpy(saved.info.motion, MOTION, sizeof saved.info.motion);
    saved.info.step = run->step;
    saved.info.hash = simulation_hash(run, &saved.info.alive);
    if (!kiln_state_write(&saved, FILE_NAME, true, run->threads, error))
        fail_msg("%s", error->message);
    return kiln_state_read(&read, FILE_NAME, runs->second.threads, error);
}

/* Checks that a state is refused for one word in it. place: that of the message. */
static void check_word(struct runs *runs, void *word, uint32_t value, const char *place,
                       const char *message)
{
    struct kiln_error error = {0};
    uint32_t before;
    memcpy(&before, word, sizeof before);
    memcpy(word, &value, sizeof value);
    if (pass_on(runs, &error))
        fail_msg("%s: a state with the word %08x is read", message, value);
    expect_error(&error, KILN_INVALID_INPUT, FILE_NAME ": %s: %s", place, message);
    memcpy(word, &before, sizeof before);
    error = (struct kiln_error){0};
    if (!pass_on(runs, &error))
        fail_msg("%s", error.message);
}

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static struct kiln_particle *records_of(struct simulation *run)
{
    struct kiln_error error = {0};
    struct kiln_particle *records = kiln_buffer_host(&run->pool.records, KILN_READ_WRITE, &error);
    assert_non_null(records);
    return records;
}

/* Returns a slot of a system whose particle lives, or is dead. */
static uint32_t find_slot(struct simulation *run, uint32_t system, bool alive)
{
    const struct kiln_pool_system *slots = &run->pool.systems[system];
    uint32_t slot = 0;
    while (slot < slots->capacity &&
           particle_is_alive(records_of(run)[slots->base + slot]) != alive)
        slot++;
    assert_true(slot < slots->capacity);
    return slot;
}

#define RANGE "expected 0 or a size of 2^-100 to 1048576"

static void particles_are_checked(void **state)
{
    (void)state;
    struct runs runs;
    start(&runs, "rest", NULL);
    const struct kiln_pool_system *slots = &runs.first.pool.systems[0];
    const uint32_t slot = find_slot(&runs.first, 0, true);
    struct kiln_particle *p = &records_of(&runs.first)[slots->base + slot];
    char place[64], message[160];
    snprintf(place, sizeof place, "system 0, slot %u", slot);
    const struct {
        uint32_t *word, value;
        const char *message;
    } cases[] = {
        {&p->position_serial.x, 0x7fc00000u, "position, m along x: found nan, " RANGE},
        {&p->position_serial.y, bits_of(INFINITY), "position, m along y: found inf, " RANGE},
        {&p->position_serial.z, bits_of(-1.5e6f), "position, m along z: found -1.5e+06, " RANGE},
        {&p->position_serial.x, bits_of(-0.0f), "position, m along x: found -0, " RANGE},
        {&p->position_serial.y, 1, "position, m along y: found 1.4013e-45, " RANGE},
        {&p->velocity_birth.x, bits_of(-INFINITY), "velocity, m/s along x: found -inf, " RANGE},
        {&p->velocity_birth.z, 0xffffffffu, "velocity, m/s along z: found -nan, " RANGE},
        {&p->velocity_birth.w, 1u, "step of birth: found 0, expected 1 to 70"},
        {&p->velocity_birth.w, 71u << KILN_BIRTH_STEP_SHIFT | 1u,
         "step of birth: found 71, expected 1 to 70"},
        {&p->velocity_birth.w, p->velocity_birth.w & ~1u,
         "found a dead particle that is not empty"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_word(&runs, cases[i].word, cases[i].value, place, cases[i].message);
    const uint32_t serials[] = {p->position_serial.w + 1, p->position_serial.w + slots->capacity,
                                0xffffffffu};
    for (size_t i = 0; i < sizeof serials / sizeof *serials; i++) {
        snprintf(message, sizeof message,
                 "serial: found %u, expected one of this slot below %" PRIu64, serials[i],
                 slots->next_serial);
        check_word(&runs, &p->position_serial.w, serials[i], place, message);
    }
    end(&runs);
}

static void spins_are_checked(void **state)
{
    (void)state;
    struct runs runs;
    struct kiln_error error = {0};
    start(&runs, "rest", NULL);
    const struct kiln_pool_system *slots = &runs.first.pool.systems[1];
    struct kiln_spin *spins = kiln_buffer_host(&runs.first.pool.spins, KILN_READ_WRITE, &error);
    assert_non_null(spins);
    assert_true(slots->spins);
    const uint32_t slot = find_slot(&runs.first, 1, true);
    struct kiln_spin *s = &spins[slots->first_spin + slot];
    char place[64];
    snprintf(place, sizeof place, "system 1, slot %u", slot);
    check_word(&runs, &s->rate.x, 0x7fc00000u, place, "spin, rad/s along x: found nan, " RANGE);
    check_word(&runs, &s->rate.y, bits_of(2e6f), place, "spin, rad/s along y: found 2e+06, " RANGE);
    check_word(&runs, &s->rate.w, 1, place, "the last word of the spin: found 1, expected 0");
    check_word(&runs, &s->pose.w, bits_of(INFINITY), place,
               "pose: found a squared length of inf, expected 1");
    check_word(&runs, &s->pose.x, 0x7fc00000u, place,
               "pose: found a squared length of nan, expected 1");
    end(&runs);
}

static void ways_are_checked(void **state)
{
    (void)state;
    struct runs runs;
    struct kiln_error error = {0};
    start(&runs, "rest", "systems.shards.emit.parent.on={trail: {per_metre: 20}}");
    const struct kiln_pool_system *slots = &runs.first.pool.systems[1];
    struct kiln_spin *ways = kiln_buffer_host(&runs.first.pool.spins, KILN_READ_WRITE, &error);
    assert_non_null(ways);
    assert_true(slots->travels && slots->first_way == slots->first_spin + slots->capacity);
    const uint32_t slot = find_slot(&runs.first, 1, true);
    struct kiln_spin *way = &ways[slots->first_way + slot];
    char place[64];
    assert_true(way->rate.x > 0);
    snprintf(place, sizeof place, "system 1, slot %u", slot);
    check_word(&runs, &way->rate.z, 1001, place, "impacts: found 1001, expected 0 to 1000");
    check_word(&runs, &way->rate.w, 1, place, "way: found words that are not 0");
    check_word(&runs, &way->pose.y, 1, place, "way: found words that are not 0");
    end(&runs);
}

/* A particle that has stopped has its rest in the words of the velocity. */
static void rests_are_checked(void **state)
{
    (void)state;
    struct runs runs;
    start(&runs, "surfaces", "systems.drops.collide.then=stick");
    const struct kiln_pool_system *slots = &runs.first.pool.systems[0];
    struct kiln_particle *p = &records_of(&runs.first)[slots->base];
    uint32_t slot = 0;
    while (!particle_has_stopped(*p)) {
        slot++;
        p++;
    }
    char place[64], message[96];
    snprintf(place, sizeof place, "system 0, slot %u", slot);
    snprintf(message, sizeof message, "step of its rest: found 71, expected %u to 70",
             particle_birth_step(*p));
    check_word(&runs, &p->velocity_birth.x, 71u << KILN_REST_STEP_SHIFT, place, message);
    snprintf(message, sizeof message, "step of its rest: found 0, expected %u to 70",
             particle_birth_step(*p));
    check_word(&runs, &p->velocity_birth.x, 0, place, message);
    check_word(&runs, &p->velocity_birth.y, 258, place,
               "object that it rides: found 258, expected 0 to 257");
    check_word(&runs, &p->velocity_birth.z, 1, place,
               "heading of its rest: found 1, expected 0 or two numbers from 1 to 65535");
    struct kiln_error error = {0};
    p->velocity_birth.y = 6; /* of four objects and the floor */
    assert_false(kiln_state_check_births(&runs.first.pool, runs.scene, 70, FILE_NAME, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FILE_NAME ": systems.drops, slot %u: object that it rides: found 6, expected 0 to "
                           "5",
                 slot);
    for (uint32_t i = 0; i < slots->capacity; i++) { /* as those that stop where they hit */
        struct kiln_particle *drop = &records_of(&runs.first)[slots->base + i];
        drop->velocity_birth.y = particle_has_stopped(*drop) ? 0 : drop->velocity_birth.y;
    }
    runs.scene->systems[0].collide.then = KILN_THEN_STOP;
    assert_true(kiln_state_check_births(&runs.first.pool, runs.scene, 70, FILE_NAME, &error));
    p->velocity_birth.y = 1;
    assert_false(kiln_state_check_births(&runs.first.pool, runs.scene, 70, FILE_NAME, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FILE_NAME ": systems.drops, slot %u: object that it rides: found 1, expected 0 to "
                           "0",
                 slot);
    p->velocity_birth.y = 0;
    runs.scene->systems[0].collide.then = KILN_THEN_BOUNCE;
    assert_false(kiln_state_check_births(&runs.first.pool, runs.scene, 70, FILE_NAME, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FILE_NAME ": systems.drops, slot %u: found a particle that has stopped, which "
                           "nothing stops",
                 slot);
    end(&runs);
}

/* Where children inherit the look of a parent, a dead parent's serial and birth are left. */
static void remains_are_checked(void **state)
{
    (void)state;
    struct runs runs;
    struct kiln_error error = {0};
    start(&runs, "rest", "systems.shards.emit.parent.inherit.color=true");
    const struct kiln_pool_system *slots = &runs.first.pool.systems[1];
    const uint32_t slot = find_slot(&runs.first, 1, false);
    struct kiln_particle *p = &records_of(&runs.first)[slots->base + slot];
    char place[64], message[96];
    assert_true(particle_is_there(*p));
    snprintf(place, sizeof place, "system 1, slot %u", slot);
    check_word(&runs, &p->position_serial.x, bits_of(1.0f), place,
               "found a dead particle that is not empty");
    check_word(&runs, &p->velocity_birth.w, p->velocity_birth.w | KILN_PARTICLE_HIT, place,
               "found a dead particle that is not empty");
    check_word(&runs, &p->velocity_birth.w, 71u << KILN_BIRTH_STEP_SHIFT, place,
               "step of birth: found 71, expected 1 to 70");
    snprintf(message, sizeof message, "serial: found %u, expected one of this slot below %u",
             slot + 1, (uint32_t)slots->next_serial);
    check_word(&runs, &p->position_serial.w, slot + 1, place, message);
    runs.scene->systems[2].emit.parent.look.color = false;
    assert_false(kiln_state_check_births(&runs.first.pool, runs.scene, 70, FILE_NAME, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FILE_NAME ": systems.balls, slot %u: found a dead particle that is not empty",
                 slot);
    end(&runs);
}

static void paint_is_checked(void **state)
{
    (void)state;
    struct runs runs;
    start(&runs, "surfaces", "backdrop.objects.2.mesh.paint.per_step=2");
    struct kiln_canvas *canvas = &runs.first.pool.canvases[0];
    uint32_t i = 0;
    while (i < canvas->slot_count && !(canvas->pending[i].opacity > 0.0f))
        i++;
    assert_true(i < canvas->slot_count);
    struct kiln_splat *splat = &canvas->pending[i];
    char place[64];
    check_word(&runs, &canvas->texels[70][3], 0x7fc00000u, "painted mesh 0, texel 70",
               "channel 3: found nan, expected 0 to 1");
    check_word(&runs, &canvas->texels[0][0], bits_of(-1.0f), "painted mesh 0, texel 0",
               "channel 0: found -1, expected 0 to 1");
    check_word(&runs, &canvas->texels[9][2], bits_of(1.5f), "painted mesh 0, texel 9",
               "channel 2: found 1.5, expected 0 to 1");
    snprintf(place, sizeof place, "painted mesh 0, waiting splat %u", i);
    check_word(&runs, &splat->position[1], bits_of(INFINITY), place,
               "found a splat with a number that is not finite");
    check_word(&runs, &splat->opacity, bits_of(1.5f), place, "opacity: found 1.5, expected 0 to 1");
    check_word(&runs, &splat->color[2], 0x7fc00000u, place, "colour: found nan, expected 0 to 1");
    check_word(&runs, &splat->radius_squared, 0, place, "found a splat without a radius");
    snprintf(place, sizeof place, "painted mesh 0: the next turn");
    char message[64];
    snprintf(message, sizeof message, "found %u, expected less than %u", canvas->slot_count,
             canvas->slot_count);
    check_word(&runs, &canvas->next, canvas->slot_count, place, message);
    end(&runs);
}

/* Checks that the births of a pool are refused. */
static void check_births(struct runs *runs, const char *message)
{
    struct kiln_error error = {0};
    assert_false(
        kiln_state_check_births(&runs->first.pool, runs->scene, runs->first.step, "s", &error));
    expect_error(&error, KILN_INVALID_INPUT, "s: systems.%s", message);
}

static void births_are_counted(void **state)
{
    (void)state;
    struct runs runs;
    struct kiln_error error = {0};
    start(&runs, "rest", NULL);
    struct kiln_pool_system *systems = runs.first.pool.systems;
    if (!kiln_state_check_births(&runs.first.pool, runs.scene, 70, "s", &error))
        fail_msg("%s", error.message);
    char message[160];
    const uint64_t drops = systems[0].next_serial, shards = systems[2].next_serial;
    systems[0].next_serial = UINT64_C(1) << 40;
    snprintf(message, sizeof message,
             "drops: found 1099511627776 births by step 70, expected %" PRIu64, drops);
    check_births(&runs, message);
    systems[0].next_serial = drops;
    systems[2].next_serial++;
    snprintf(message, sizeof message,
             "shards: found %" PRIu64 " births by step 70, expected %" PRIu64, shards + 1, shards);
    check_births(&runs, message);
    systems[2].next_serial = shards;
    const uint64_t wait = systems[1].birth_wait;
    systems[1].birth_wait = UINT64_MAX;
    snprintf(message, sizeof message,
             "balls: the wait for the next birth: found 18446744073709551615, expected %" PRIu64,
             wait);
    check_births(&runs, message);
    systems[1].birth_wait = wait;
    const uint32_t slot = find_slot(&runs.first, 0, true);
    struct kiln_particle *p = &records_of(&runs.first)[systems[0].base + slot];
    p->velocity_birth.w = 1u << KILN_BIRTH_STEP_SHIFT | 1u;
    snprintf(message, sizeof message,
             "drops, slot %u: age: found 1.16667 s, expected less than the life of 1 s", slot);
    check_births(&runs, message);
    end(&runs);
}

/* Bakes a state, and puts a position that is no number into it. Returns its path. */
static const char *spoil_state(struct kiln_device *device, struct kiln_scene *scene, glob_t *found,
                               uint32_t *slot)
{
    const struct kiln_bake_params baking = {
        .size = sizeof baking, .states = "states", .every = 30, .threads = 1};
    struct kiln_error error = {0};
    if (!kiln_bake(device, scene, &baking, NULL, &error))
        fail_msg("%s", error.message);
    assert_int_equal(glob("states/*-00000060.kilnstate", 0, NULL, found), 0);
    const char *path = found->gl_pathv[0];
    struct simulation run;
    simulation_start_with(&run, scene, NULL, KILN_SIMULATE_CPU, 1);
    struct kiln_state held = {.pool = &run.pool};
    if (!kiln_state_read(&held, path, run.threads, &error))
        fail_msg("%s", error.message);
    run.step = held.info.step;
    *slot = find_slot(&run, 0, true);
    records_of(&run)[run.pool.systems[0].base + *slot].position_serial.x = 0x7fc00000u;
    held.info.hash = simulation_hash(&run, &held.info.alive);
    if (!kiln_state_write(&held, path, true, run.threads, &error))
        fail_msg("%s", error.message);
    simulation_end(&run);
    return path;
}

/* A whole job that starts from such a state fails with KILN_INVALID_INPUT, the exit code 3. */
static void jobs_refuse_it(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_fixture("rest", NULL);
    const struct kiln_device_params wanted = {.size = sizeof wanted, .wanted = KILN_DEVICE_CPU};
    struct kiln_error error = {0};
    struct kiln_device *device = kiln_device_open(&wanted, &error);
    assert_non_null(device);
    glob_t found;
    uint32_t slot;
    const char *path = spoil_state(device, scene, &found, &slot);
    const struct kiln_frame_range range = {30, 30};
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = &range;
    params.range_count = 1;
    params.threads = 1;
    params.states = "states";
    assert_false(kiln_render(device, scene, &params, NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: system 0, slot %u: position, m along x: found nan, " RANGE, path, slot);
    globfree(&found);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(particles_are_checked, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(spins_are_checked, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(paint_is_checked, test_enter_folder, test_leave_folder),
        cmocka_unit_test(ways_are_checked),
        cmocka_unit_test(rests_are_checked),
        cmocka_unit_test(remains_are_checked),
        cmocka_unit_test(births_are_counted),
        cmocka_unit_test_setup_teardown(jobs_refuse_it, test_enter_folder, test_leave_folder),
    };
    return cmocka_run_group_tests_name("state_check", tests, NULL, NULL);
}
