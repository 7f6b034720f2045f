/* Where the sources of gas lie, and what they do there, against closed forms of the distance from
 * their shapes. If this fails, fire burns beside the shape that the scene names, or gas is blown
 * elsewhere. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sim/gas/sources.h"
#include "support/cmocka.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* A domain that stands still: air that nothing moves. Its cells are 1/16 m. */
#define STILL                                                                                      \
    "cell: 0.0625, buoyancy: 0, vorticity: 0, drag: 0, turbulence: {strength: 0}, "                \
    "sides: {bottom: open}"

static double length(double x, double y, double z)
{
    return sqrt(x * x + y * y + z * z);
}

static double to_sphere(double x, double y, double z)
{
    return fmax(length(x, y, z) - 0.4, 0.0);
}

static double to_point(double x, double y, double z)
{
    return length(x, y, z);
}

static double to_box(double x, double y, double z)
{
    return length(fmax(fabs(x) - 0.4, 0.0), fmax(fabs(y) - 0.2, 0.0), fmax(fabs(z) - 0.3, 0.0));
}

static double to_line(double x, double y, double z)
{
    const double at = (x * 1.0 + y * 0.5 + z * 0.2) / (1.0 + 0.25 + 0.04);
    const double part = fmin(fmax(at, -0.5), 0.5);
    return length(x - part, y - 0.5 * part, z - 0.2 * part);
}

/* Splits a place by the axis (3, 4, 0) / 5 into a height over a disc and a distance from its axis.
 */
static double off_axis(double x, double y, double z, double *height)
{
    *height = 0.6 * x + 0.8 * y;
    return length(x - 0.6 * *height, y - 0.8 * *height, z);
}

static double to_disc(double x, double y, double z)
{
    double height;
    const double off = off_axis(x, y, z, &height);
    return length(fmax(off - 0.5, 0.0), height, 0.0);
}

static double to_ring(double x, double y, double z)
{
    double height;
    const double off = off_axis(x, y, z, &height);
    return length(off - 0.5, height, 0.0);
}

static double to_shell(double x, double y, double z)
{
    return fabs(length(x, y, z) - 0.4);
}

static double to_faces(double x, double y, double z)
{
    const double most = fmax(fmax(fabs(x) - 0.4, fabs(y) - 0.2), fabs(z) - 0.3);
    return most < 0.0 ? -most : to_box(x, y, z);
}

/* A source has its values within its shape, and less the farther a cell is, down to none at its
 * reach. After a step of t at a rate r, gas has taken 1 - exp(-r t) of them. */
static void sources_lie_where_their_shapes_do(void **state)
{
    (void)state;
    static const struct {
        const char *from;
        double (*distance)(double x, double y, double z);
    } shapes[] = {
        {"from: {point: {origin: [0.1, 0.05, 0]}}", to_point},
        {"from: {sphere: {origin: [0.1, 0.05, 0], radius: 0.4}}", to_sphere},
        {"from: {box: {origin: [0.1, 0.05, 0], size: [0.8, 0.4, 0.6]}}", to_box},
        {"from: {line: {origin: [0.1, 0.05, 0], span: [1, 0.5, 0.2]}}", to_line},
        {"from: {disc: {origin: [0.1, 0.05, 0], direction: [3, 4, 0], radius: 0.5}}", to_disc},
        {"from: {ring: {origin: [0.1, 0.05, 0], direction: [3, 4, 0], radius: 0.5}}", to_ring},
        {"from: {cone: {origin: [0.1, 0.05, 0], direction: [3, 4, 0], radius: 0.5}}", to_disc},
        {"from: {cone: {origin: [0.1, 0.05, 0], direction: [3, 4, 0], angle: 90 deg}}", to_point},
        /* on the surface or the rim alone */
        {"from: {sphere: {origin: [0.1, 0.05, 0], radius: 0.4, surface: true}}", to_shell},
        {"from: {box: {origin: [0.1, 0.05, 0], size: [0.8, 0.4, 0.6], surface: true}}", to_faces},
        {"from: {disc: {origin: [0.1, 0.05, 0], direction: [3, 4, 0], radius: 0.5, surface: true}}",
         to_ring},
        /* in a node of half the size, which is turned by a quarter about z */
        {"attach: half, from: {box: {size: [0.8, 1.6, 1.2]}}", to_box},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        char text[900];
        snprintf(text, sizeof text,
                 "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
                 "nodes: {half: {position: [0.1, 0.05, 0], rotation: [0, 0, 90 deg], scale: 0.5}}\n"
                 "gas: {a: {box: {center: [0, 0, 0], size: [2, 2, 2]}, burn: none, " STILL ",\n"
                 "  sources: [{%s, reach: 0.25, rate: 20, fuel: 0.5, temperature: 0.8, smoke: 3,\n"
                 "    noise: {amount: 0}}]}}\n",
                 shapes[i].from);
        struct simulation run;
        struct kiln_scene *scene = simulation_start_text(&run, text, 2);
        const struct kiln_gas *gas = &run.pool.gas[0];
        simulation_run(&run, 1);
        const double taken = 1.0 - exp(-20.0 / 60.0);
        double most = 0.0;
        uint32_t reached = 0;
        for (int32_t z = 0; z < 32; z++)
            for (int32_t y = 0; y < 32; y++)
                for (int32_t x = 0; x < 32; x++) {
                    double p[3] = {(x + 0.5) / 16 - 1.1, (y + 0.5) / 16 - 1.05, (z + 0.5) / 16 - 1};
                    const double far = shapes[i].distance(p[0], p[1], p[2]);
                    const double within = taken * fmin(fmax(1.0 - far / 0.25, 0.0), 1.0);
                    reached += within > 0.0;
                    most = fmax(most, fabs((double)gas_at(gas, GAS_SMOKE, x, y, z) - 3 * within));
                    most = fmax(most,
                                fabs((double)gas_at(gas, GAS_TEMPERATURE, x, y, z) - 0.8 * within));
                    most = fmax(most, fabs((double)gas_at(gas, GAS_FUEL, x, y, z) - 0.5 * within));
                }
        assert_true(reached > 200);
        if (!(most < 1e-6)) /* 3.5e-7 */
            fail_msg("%s: a cell is off by %.3g", shapes[i].from, most);
        simulation_end_text(&run, scene);
    }
}

/* Takes what the sources of a domain did to the velocities of its cells, and frees the rest. */
static double off_the_jet(const struct kiln_scene *scene, double narrow, double tip, double speed,
                          uint32_t *blown)
{
    struct kiln_error error = {.code = KILN_OK};
    struct gas_sources sources;
    struct kiln_gas gas;
    enum kiln_simd simd;
    double most = 0.0;
    assert_true(kiln_simd_choose(&simd, &error));
    const struct gas_advect *kernels = KILN_SIMD_PICK(kiln_gas_advect, simd);
    gas_sources_init(&sources, scene, 0);
    kiln_gas_init(&gas, &scene->gas[0].shape);
    assert_true(gas_sources_set(&sources, NULL, 1, &error));
    gas_sources_set_time(&sources, 1.0f);
    assert_true(kiln_gas_set_window(&gas, (struct kiln_gas_place){0, 0, 0}, gas.shape.cells));
    const struct gas_pass pass = {.gas = &gas};
    for (int32_t i = 0; i < 64; i++) {
        struct kiln_gas_brick *brick = &gas.brick[i];
        const gas_brick_place at = {i % 4, i / 4 % 4, i / 16};
        assert_true(kiln_gas_brick_take(&gas, brick));
        memset(brick->change, 0, (size_t)GAS_CHANGE * GAS_BRICK_CELLS * sizeof *brick->change);
        gas_sources_add(&sources, &pass, kernels, at);
        for (int32_t k = 0; k < GAS_BRICK_CELLS; k++) {
            const double place[3] = {at.x * 8 + k % 8, at.y * 8 + k / 8 % 8, at.z * 8 + k / 64};
            const double p[3] = {(place[0] + 0.5) / 16 - 1.1, (place[1] + 0.5) / 16 - 1.05,
                                 (place[2] + 0.5) / 16 - 1};
            double height;
            const double off = off_axis(p[0], p[1], p[2], &height);
            const double far = length(fmax(off - 0.3, 0.0), height, 0.0);
            /* the way from the tip, or along the edge of the jet */
            const double along = (height + tip) / length(height + tip, off, 0.0);
            const double ahead = fmax(along, narrow), aside = sqrt(1.0 - ahead * ahead);
            const double out[3] = {(p[0] - 0.6 * height) / off, (p[1] - 0.8 * height) / off,
                                   p[2] / off};
            const double axis[3] = {0.6, 0.8, 0.0};
            /* the source takes all of the air at its heart */
            const double part = fmax(1.0 - far / 0.25, 0.0);
            *blown += part > 0.0;
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs((double)brick->change[c * GAS_BRICK_CELLS + k] -
                                       speed * part * (ahead * axis[c] + aside * out[c])));
        }
    }
    kiln_gas_finish(&gas);
    gas_sources_finish(&sources);
    return most;
}

/* A cone blows along lines from the tip behind its small end, and nowhere else. One of a right
 * angle or more has its tip in its origin. */
static void cones_blow_along_their_lines(void **state)
{
    (void)state;
    static const double degrees[] = {0, 15, 50, 90, 130};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        char text[700];
        snprintf(text, sizeof text,
                 "kiln: 1\nbackdrop: {floor: none}\n"
                 "nodes: {half: {position: [0.1, 0.05, 0], rotation: [0, 0, 90 deg], scale: 0.5}}\n"
                 "gas: {a: {box: {center: [0, 0, 0], size: [2, 2, 2]}, cells: 32,\n"
                 "  sources: [{attach: half, outward: 2, reach: 0.25, rate: 100,\n"
                 "    noise: {amount: 0}, from: {cone: {direction: [4, -3, 0], radius: 0.6,\n"
                 "      angle: %g deg}}}]}}\n",
                 degrees[i]);
        struct kiln_scene *scene = load_scene(text, NULL);
        const double angle = degrees[i] * 3.14159265358979 / 180;
        const double tip = degrees[i] < 90 ? 0.3 / fmax(tan(angle), 1e-9) : 0.0;
        uint32_t blown = 0;
        const double most = off_the_jet(scene, cos(angle), tip, 2.0, &blown);
        assert_true(blown > 500);
        if (!(most < 4e-6))
            fail_msg("%g degrees: a cell is off by %.3g m/s", degrees[i], most);
        kiln_scene_destroy(&scene);
    }
}

/* A shell of smoke stays one: no source reaches the middle of a ball, a box or a
 * mesh. */
static void shells_are_empty(void **state)
{
    (void)state;
    static const char *const shapes[] = {"sphere: {radius: 0.7, surface: true}",
                                         "box: {size: [1.4, 1.4, 1.4], surface: true}",
                                         "mesh: {file: tests/mutation/tetrahedron.obj, scale: 3}"};
    assert_int_equal(chdir(KILN_SOURCE_DIR), 0); /* where the mesh is */
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        char text[600];
        snprintf(text, sizeof text,
                 "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
                 "gas: {a: {box: {center: [0, 0, 0], size: [2, 2, 2]}, burn: none, " STILL ",\n"
                 "  sources: [{from: {%s}, reach: 0.1, rate: 20, fuel: 0, temperature: 0,\n"
                 "    smoke: 1, noise: {amount: 0}}]}}\n",
                 shapes[i]);
        struct simulation run;
        struct kiln_scene *scene = simulation_start_text(&run, text, 2);
        simulation_run(&run, 10);
        const struct kiln_gas *gas = &run.pool.gas[0];
        assert_true(gas_sum(gas, GAS_SMOKE) > 300.0);
        const int32_t first = i < 2 ? 10 : 20, n = i < 2 ? 12 : 6;
        for (int32_t k = 0; k < n * n * n; k++)
            assert_true(gas_at(gas, GAS_SMOKE, first + k % n, first + k / n % n,
                               first + k / (n * n)) == 0.0f);
        simulation_end_text(&run, scene);
    }
}

/* Particles at rest are sources like points: a cell counts by the sum of (1 - (d / reach)^2)^2 over
 * them, at most 1. A step of the gas sees the particles of the step before. */
static void particles_are_sources(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
        "systems: {dots: {emit: {bursts: {0 s: 40}, life: 9 s, speed: 0,\n"
        "  from: {box: {size: [1.6, 1.2, 1.4]}}}}}\n"
        "gas: {a: {box: {center: [0, 0, 0], size: [2, 2, 2]}, burn: none, decay: 0, " STILL ",\n"
        "  sources: [{from: {system: dots}, reach: 0.3, rate: 20, fuel: 0, temperature: 0,\n"
        "    smoke: 2, noise: {amount: 0}}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    uint64_t alive;
    simulation_run(&run, 1);
    simulation_hash(&run, &alive);
    assert_int_equal(alive, 40);
    assert_true(gas_sum(gas, GAS_SMOKE) == 0.0);
    simulation_run(&run, 1);
    const struct kiln_particle *records = simulation_records(&run);
    const double taken = 1.0 - exp(-20.0 / 60.0);
    double most = 0.0, densest = 0.0;
    for (int32_t z = 0; z < 32; z++)
        for (int32_t y = 0; y < 32; y++)
            for (int32_t x = 0; x < 32; x++) {
                const double p[3] = {(x + 0.5) / 16 - 1, (y + 0.5) / 16 - 1, (z + 0.5) / 16 - 1};
                double sum = 0.0;
                for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
                    const struct kiln_particle dot = records[run.pool.systems[0].base + i];
                    if (!particle_is_alive(dot))
                        continue;
                    const float3 at = particle_position(dot);
                    const double d =
                        length(p[0] - (double)at.x, p[1] - (double)at.y, p[2] - (double)at.z);
                    const double left = fmax(1.0 - d * d / 0.09, 0.0);
                    sum += left * left;
                }
                densest = fmax(densest, sum);
                most = fmax(most, fabs((double)gas_at(gas, GAS_SMOKE, x, y, z) -
                                       2.0 * taken * fmin(sum, 1.0)));
            }
    assert_true(densest > 1.0);
    if (!(most < 2e-6)) /* 4.8e-7 */
        fail_msg("a cell is off by %.3g", most);
    simulation_end_text(&run, scene);
}

/* Fills in the smoke of a source with noise after a step, in blocks of 1/8 m. */
static void fill_noise(const char *cell, int32_t block, float smoke[16][16][16])
{
    char text[700];
    snprintf(text, sizeof text,
             "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
             "gas: {a: {box: {center: [0, 0, 0], size: [2, 2, 2]}, burn: none, buoyancy: 0,\n"
             "  cell: %s, sources: [{from: {box: {size: [3, 3, 3]}}, fuel: 0, temperature: 0,\n"
             "    smoke: 1, rate: 10000, noise: {amount: 0.8, size: 0.9}}]}}\n",
             cell);
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    simulation_run(&run, 1);
    memset(smoke, 0, sizeof(float[16][16][16]));
    for (int32_t z = 0; z < 16 * block; z++)
        for (int32_t y = 0; y < 16 * block; y++)
            for (int32_t x = 0; x < 16 * block; x++)
                smoke[z / block][y / block][x / block] +=
                    gas_at(&run.pool.gas[0], GAS_SMOKE, x, y, z) / (float)(block * block * block);
    simulation_end_text(&run, scene);
}

/* The noise of a source is in metres: cells of half the size have the same pattern. */
static void noise_of_sources_is_in_metres(void **state)
{
    (void)state;
    static float coarse[16][16][16], fine[16][16][16];
    fill_noise("0.125", 1, coarse);
    fill_noise("0.0625", 2, fine);
    double square = 0.0, all = 0.0, mean = 0.0, low = 1.0, high = 0.0;
    for (int i = 0; i < 4096; i++)
        mean += (double)(&coarse[0][0][0])[i] / 4096.0;
    for (int i = 0; i < 4096; i++) {
        const double a = (double)(&coarse[0][0][0])[i], b = (double)(&fine[0][0][0])[i];
        square += (a - b) * (a - b);
        all += (a - mean) * (a - mean);
        low = fmin(low, a);
        high = fmax(high, a);
    }
    assert_true(low < 0.25 && high > 0.95);
    if (!(sqrt(square / all) <
          0.15)) /* 0.107: the mean over a block has less of the small eddies */
        fail_msg("patterns differ by %.3g of what they vary", sqrt(square / all));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_lie_where_their_shapes_do),
        cmocka_unit_test(cones_blow_along_their_lines),
        cmocka_unit_test(shells_are_empty),
        cmocka_unit_test(particles_are_sources),
        cmocka_unit_test(noise_of_sources_is_in_metres),
    };
    return cmocka_run_group_tests_name("gas_sources", tests, NULL, NULL);
}
