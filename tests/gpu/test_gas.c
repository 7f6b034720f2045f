/* Steps gas in GL and on the host. If this fails, the gas of a scene is another one on a machine
 * with a GPU, and a clip whose frames several machines render jumps between them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/state.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

#define FILE_NAME "a.kilnstate"

/* Smoke that rises from a disc and leaves the domain at its top, whose window grows with it. */
static const char SMOKE[] = "kiln: 1\nsimulation: {rate: 30}\n"
                            "gas: {smoke: {box: {size: [1.6, 2.4, 1.6]}, cell: 0.1, burn: none, "
                            "turbulence: {strength: 0},\n"
                            "  vorticity: 0,\n"
                            "  sources: [{from: {disc: {radius: 0.3, origin: [0, 0.1, 0]}}, noise: "
                            "{amount: 0}, fuel: 0, temperature: 1,\n"
                            "    smoke: 1}]}}\n";

/* Fire that noise stirs and that has eddies, from two sources of other noise. */
static const char FIRE[] =
    "kiln: 1\nseed: 5\nsimulation: {rate: 30}\n"
    "gas: {fire: {box: {size: [1.6, 2.4, 1.6]}, cell: 0.05, vorticity: 0.5,\n"
    "  turbulence: {strength: 3, size: 0.3},\n"
    "  sources: [{from: {disc: {radius: 0.25, origin: [0, 0.05, 0]}}, velocity: [0, 0.7, 0]},\n"
    "    {from: {sphere: {radius: 0.2, origin: [0.3, 0.8, 0]}}, outward: 1}]}}\n";

/* Coloured smoke with detail, in a wind, around a ball that moves through it. */
static const char SOLID[] =
    "kiln: 1\nseed: 3\nsimulation: {rate: 30}\n"
    "backdrop: {objects: {ball: {sphere: {radius: 0.25,\n"
    "  center: {keys: {0 s: [-0.5, 0.6, 0], 1 s: [0.6, 0.9, 0.1]}}}},\n"
    "  plate: {box: {center: [0.4, 1.2, 0], size: [0.6, 0.02, 0.6]}}}}\n"
    "gas: {fire: {box: {size: [1.6, 2.4, 1.6]}, cell: 0.05, detail: 2, vorticity: 0.5,\n"
    "  forces: [{wind: {velocity: [0.5, 0, 0], pull: 1 1/s}}],\n"
    "  sources: [{from: {disc: {radius: 0.25, origin: [0, 0.05, 0]}}, velocity: [0, 0.7, 0]},\n"
    "    {from: {point: {origin: [0.2, 0.3, 0]}}, fuel: 0, temperature: 0, smoke: 0.5,\n"
    "      color: [0.9, 0.3, 0.1]}]}}\n";

/* Two domains, of which particles are sources, and ride one: its winds are read back. */
static const char WINDS[] =
    "kiln: 1\nseed: 3\nsimulation: {rate: 30}\n"
    "systems: {dots: {emit: {rate: 200, life: 2 s, speed: 1, from: {sphere: {origin: [0, 0.3, "
    "0]}}},\n"
    "  forces: [{wind: {gas: fire, pull: 6 1/s}}]}}\n"
    "gas:\n"
    "  fire: {box: {size: [1.6, 2.4, 1.6]}, cell: 0.1, detail: 2,\n"
    "    sources: [{from: {disc: {radius: 0.25, origin: [0, 0.05, 0]}}, velocity: [0, 0.7, 0]},\n"
    "      {from: {system: dots}, fuel: 0, temperature: 0, smoke: 0.5, reach: 0.15,\n"
    "        inherit: 0.5, color: [0.9, 0.3, 0.1]}]}\n"
    "  mist: {box: {center: [3, 1, 0], size: [1.6, 1.6, 1.6]}, cell: 0.1, burn: none,\n"
    "    sources: [{from: {point: {origin: [3, 1, 0]}}, fuel: 0, temperature: 0.5, smoke: 1,\n"
    "      rate: {keys: {0.2 s: 20, 0.21 s: 0}}}]}\n";

/* A closed room that a node turns, and pressure that is asked to be exact. */
static const char ROOM[] =
    "kiln: 1\nseed: 3\nsimulation: {rate: 30}\n"
    "nodes: {turner: {position: [4, 1, 0], rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 0, 100 "
    "deg]}}}}\n"
    "gas:\n"
    "  room: {attach: turner, box: {center: [0, 0, 0], size: [0.8, 0.8, 0.8]}, cell: 0.05,\n"
    "    burn: none, decay: 0, pressure: {residual: 0.001},\n"
    "    sides: {left: closed, right: closed, top: closed, back: closed, front: closed},\n"
    "    sources: [{from: {point: {}}, fuel: 0, temperature: 1, smoke: 1,\n"
    "      rate: {keys: {0.3 s: 20, 0.31 s: 0}}}]}\n";

/* Returns the bits of a number. */
static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Fails at the first number of two arrays of a window that differs. */
static void compare_faces(const struct kiln_gas *a, const struct kiln_gas *b, uint32_t step)
{
    const struct kiln_gas_place n = a->cells;
    for (int axis = 0; axis < 3; axis++)
        for (int32_t z = 0; z < n.z + (axis == 2); z++)
            for (int32_t y = 0; y < n.y + (axis == 1); y++)
                for (int32_t x = 0; x < n.x + (axis == 0); x++) {
                    const ptrdiff_t at = z * a->plane + y * a->row + x;
                    if (bits_of(a->faces[axis][at]) != bits_of(b->faces[axis][at]))
                        fail_msg(
                            "step %u: the face of cell (%d, %d, %d) across axis %d has %.9g on "
                            "the host, %.9g in GL",
                            step, x, y, z, axis, (double)a->faces[axis][at],
                            (double)b->faces[axis][at]);
                }
}

static void compare_floats(const float *a, const float *b, size_t count, const char *what,
                           size_t brick, uint32_t step)
{
    for (size_t i = 0; i < count; i++)
        if (bits_of(a[i]) != bits_of(b[i]))
            fail_msg("step %u: %s of brick %zu, float %zu, is %.9g on the host, %.9g in GL", step,
                     what, brick, i, (double)a[i], (double)b[i]);
}

/* Fails at the first number in which the gas of the host and that of GL differ. */
static void compare_gas(const struct kiln_gas *a, struct kiln_gas *b, uint32_t step)
{
    struct kiln_error error = {0};
    const size_t groups = kiln_gas_groups(&a->shape);
    if (!kiln_gas_fetch(b, &error))
        fail_msg("%s", error.message);
    assert_memory_equal(&a->at, &b->at, sizeof a->at);
    assert_memory_equal(&a->cells, &b->cells, sizeof a->cells);
    for (size_t i = 0; i < (size_t)a->bricks.x * (size_t)a->bricks.y * (size_t)a->bricks.z; i++) {
        const struct kiln_gas_brick *brick = &a->brick[i], *other = &b->brick[i];
        assert_int_equal(a->has_gas[i], b->has_gas[i]);
        assert_int_equal(brick->now != NULL, other->now != NULL);
        if (!brick->now)
            continue;
        compare_floats(brick->now, other->now, (size_t)GAS_BRICK_CELLS * GAS_CARRIED, "gas", i,
                       step);
        compare_floats(brick->extras, other->extras, groups * GAS_BRICK_CELLS * GAS_CARRIED,
                       "extras", i, step);
    }
    compare_faces(a, b, step);
    assert_true(a->fastest == b->fastest);
    assert_true(a->smoke == b->smoke && a->growth == b->growth && a->due == b->due);
    assert_true(a->kept == b->kept);
}

static void expect_same(struct simulation *a, struct simulation *b)
{
    uint64_t alive[2];
    const struct kiln_state_hash first = simulation_hash(a, &alive[0]);
    const struct kiln_state_hash second = simulation_hash(b, &alive[1]);
    if (memcmp(&first, &second, sizeof first) != 0 || alive[0] != alive[1])
        fail_msg("another state in step %u", b->step);
}

static void compare_runs(const char *text, uint32_t steps)
{
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation host, gl;
    simulation_start(&host, scene, NULL, 2);
    simulation_start_gas(&gl, scene, test_device(), KILN_SIMULATE_CPU, KILN_GAS_GL, 2);
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&host, 1);
        simulation_run(&gl, 1);
        for (uint32_t i = 0; i < host.pool.gas_count; i++)
            compare_gas(&host.pool.gas[i], &gl.pool.gas[i], step);
    }
    simulation_end(&host);
    simulation_end(&gl);
    kiln_scene_destroy(&scene);
}

static void smoke_is_the_same(void **state)
{
    (void)state;
    compare_runs(SMOKE, 24);
}

static void fire_is_the_same(void **state)
{
    (void)state;
    compare_runs(FIRE, 12);
}

static void gas_beside_solids_is_the_same(void **state)
{
    (void)state;
    compare_runs(SOLID, 20);
}

static void rooms_are_the_same(void **state)
{
    (void)state;
    compare_runs(ROOM, 20);
}

/* Particles in GL, too, ride gas that is in GL. */
static void particles_ride_the_same_gas(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(WINDS, NULL);
    struct simulation host, gl;
    compare_runs(WINDS, 12);
    simulation_start(&host, scene, NULL, 2);
    simulation_start_gas(&gl, scene, test_device(), KILN_SIMULATE_INPLACE, KILN_GAS_GL, 1);
    for (uint32_t step = 1; step <= 24; step++) {
        simulation_run(&host, 1);
        simulation_run(&gl, 1);
        if (step % 8 == 0)
            expect_same(&host, &gl);
    }
    simulation_end(&host);
    simulation_end(&gl);
    kiln_scene_destroy(&scene);
}

static void take_up(struct simulation *run)
{
    struct kiln_error error = {0};
    if (!simulation_take_up(run, FILE_NAME, &error))
        fail_msg("%s", error.message);
}

/* A run in GL goes on from a state of the host, also when it had other gas before, and a run of the
 * host from a state of GL. */
static void states_cross(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(SOLID, NULL);
    struct simulation host, gl;
    simulation_start(&host, scene, NULL, 1);
    simulation_start_gas(&gl, scene, test_device(), KILN_SIMULATE_CPU, KILN_GAS_GL, 2);
    simulation_run(&host, 11); /* ways begin anew in the next step */
    simulation_run(&gl, 5);
    simulation_save(&host, FILE_NAME);
    take_up(&gl);
    expect_same(&host, &gl);
    simulation_run(&host, 4);
    simulation_run(&gl, 4);
    expect_same(&host, &gl);
    simulation_run(&gl, 3);
    simulation_save(&gl, FILE_NAME);
    take_up(&host);
    simulation_run(&host, 2);
    simulation_run(&gl, 2);
    expect_same(&host, &gl);
    simulation_end(&host);
    simulation_end(&gl);
    kiln_scene_destroy(&scene);
}

/* A large level that is still the coarsest: a domain that is flat and long. */
static const char FLAT[] =
    "kiln: 1\nsimulation: {rate: 30}\n"
    "gas: {mist: {box: {size: [12.8, 1.6, 12.8]}, cell: 0.1, burn: none,\n"
    "  sources: [{from: {box: {origin: [0, 0.3, 0], size: [11, 0.2, 11]}}, fuel: 0,\n"
    "    temperature: 0.5, smoke: 1}]}}\n";

static void flat_gas_is_the_same(void **state)
{
    (void)state;
    compare_runs(FLAT, 2);
}

/* A technique that a device cannot run is refused. */
static void devices_are_checked(void **state)
{
    (void)state;
    struct kiln_device *device = test_device();
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    struct kiln_error error = {0};
    assert_null(kiln_simulate_create(NULL, scene, KILN_SIMULATE_CPU, KILN_GAS_GL, NULL, &error));
    expect_error(&error, KILN_USAGE, "without a device, only gas=cpu is allowed");
    error = (struct kiln_error){0};
    device->info.exact = false;
    assert_null(kiln_simulate_create(device, scene, KILN_SIMULATE_CPU, KILN_GAS_GL, NULL, &error));
    expect_error(&error, KILN_USAGE, "%s computes inexactly and cannot step gas; use gas=cpu",
                 device->info.name);
    device->info.exact = true;
    kiln_scene_destroy(&scene);
}

/* Steps a run that goes on from a state in which a cell has infinite smoke. */
static void step_wrong(struct simulation *run, struct kiln_error *error)
{
    take_up(run);
    struct kiln_gas *gas = &run->pool.gas[0];
    size_t brick = 0;
    while (!gas->has_gas[brick])
        brick++;
    gas->brick[brick].now[GAS_SMOKE] = INFINITY;
    assert_false(kiln_simulate_step(run->simulate, &run->pool, run->step + 1, error));
}

/* A number that is not finite ends a run, and is found where it is, as on the host. */
static void wrong_numbers_are_found(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(SMOKE, NULL);
    struct simulation host, gl;
    struct kiln_error errors[2] = {{0}, {0}};
    simulation_start(&host, scene, NULL, 1);
    simulation_start_gas(&gl, scene, test_device(), KILN_SIMULATE_CPU, KILN_GAS_GL, 1);
    simulation_run(&host, 4);
    simulation_save(&host, FILE_NAME);
    step_wrong(&host, &errors[0]);
    step_wrong(&gl, &errors[1]);
    for (int i = 0; i < 2; i++)
        expect_error(&errors[i], KILN_DEVICE_FAILED,
                     "gas.smoke: found a number that is not finite in step 5 at (-0.75, 0.05, "
                     "-0.75) m; smaller "
                     "values of its sources and forces, or more substeps, may help");
    simulation_end(&host);
    simulation_end(&gl);
    kiln_scene_destroy(&scene);
}

enum { WIDTH = 48, HEIGHT = 32, PICTURE_BYTES = WIDTH * HEIGHT * 4 };

struct picture {
    uint8_t bytes[PICTURE_BYTES];
    uint32_t count;
};

static void take_picture(void *user, const struct kiln_frame_layer *view)
{
    struct picture *picture = user;
    memcpy(picture->bytes, view->pixels, PICTURE_BYTES);
    picture->count++;
}

/* Draws a frame of a fire beside a floor that it lights. */
static struct kiln_state_hash draw(const struct kiln_scene *scene, const char *technique,
                                   struct picture *picture)
{
    static const struct kiln_frame_range range = {6, 7};
    struct kiln_error error = {0};
    struct kiln_render_stats stats = kiln_render_stats_empty();
    struct kiln_render_params params = kiln_render_defaults();
    *picture = (struct picture){.count = 0};
    params.ranges = &range;
    params.range_count = 1;
    params.techniques = &technique;
    params.technique_count = 1;
    params.picture = take_picture;
    params.user = picture;
    if (!kiln_render(test_device(), scene, &params, &stats, &error))
        fail_msg("%s: %s", technique, error.message);
    assert_int_equal(picture->count, 2);
    return stats.state;
}

/* The stages that draw gas, and what it lights, read it back from GL in each frame. */
static void pictures_are_the_same(void **state)
{
    (void)state;
    static const char *const overrides[] = {"output={size: [48, 32], fps: 30, frames: 8}",
                                            "camera={position: [0, 1.2, 4], target: [0, 1, 0]}",
                                            "gas.smoke.burn={}", "gas.smoke.sources.0.fuel=1",
                                            NULL};
    struct kiln_scene *scene = load_scene(SMOKE, overrides);
    struct picture host, gl;
    const struct kiln_state_hash a = draw(scene, "gas=cpu", &host);
    const struct kiln_state_hash b = draw(scene, "gas=gl", &gl);
    int brightest = 0;
    for (int i = 0; i < PICTURE_BYTES; i += 4)
        brightest = host.bytes[i] > brightest ? host.bytes[i] : brightest;
    assert_true(brightest > 100);
    assert_memory_equal(&a, &b, sizeof a);
    assert_memory_equal(host.bytes, gl.bytes, PICTURE_BYTES);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        test_on_device(smoke_is_the_same),
        test_on_device(fire_is_the_same),
        test_on_device(gas_beside_solids_is_the_same),
        test_on_device(rooms_are_the_same),
        test_on_device(particles_ride_the_same_gas),
        test_in_folder_on_device(states_cross),
        test_on_device(flat_gas_is_the_same),
        test_on_device(pictures_are_the_same),
        test_on_device(devices_are_checked),
        test_in_folder_on_device(wrong_numbers_are_found),
    };
    return cmocka_run_group_tests_name("gas in GL", tests, test_device_open_alone,
                                       test_device_close);
}
