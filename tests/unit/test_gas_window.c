/* Windows of gas, and what must not change it: if this fails, a plume depends on how large its
 * domain is, on the machine that it is computed on or on its substeps, or a domain that most of its
 * gas has left goes on taking memory. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

static struct kiln_state_hash hash_of(const struct kiln_gas *gas)
{
    struct kiln_state_hash hash = {{0, 0}};
    kiln_gas_hash(gas, 0, &hash);
    return hash;
}

static uint32_t active_bricks(const struct kiln_gas *gas)
{
    uint32_t count = 0;
    for (int32_t i = 0; i < gas->bricks.x * gas->bricks.y * gas->bricks.z; i++)
        count += gas->brick[i].now != NULL;
    return count;
}

enum { CHIMNEY_X = 4, CHIMNEY_Y = 32 }; /* bricks of a domain, of the next test */

/* Returns the place of a brick of the window in the domain. */
static int32_t in_domain(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    const int32_t at[3] = {gas->at.x / GAS_BRICK + x, gas->at.y / GAS_BRICK + y,
                           gas->at.z / GAS_BRICK + z};
    return (at[2] * CHIMNEY_Y + at[1]) * CHIMNEY_X + at[0];
}

/* Marks the bricks with gas, and those around them. */
static void mark_near(const struct kiln_gas *gas, bool near[CHIMNEY_X * CHIMNEY_Y * CHIMNEY_X])
{
    const struct kiln_gas_place n = gas->bricks;
    memset(near, 0, CHIMNEY_X * CHIMNEY_Y * CHIMNEY_X);
    for (int32_t i = 0; i < n.x * n.y * n.z; i++)
        for (int32_t k = 0; k < 27 && gas->has_gas[i]; k++) {
            const int32_t x = i % n.x + k % 3 - 1, y = i / n.x % n.y + k / 3 % 3 - 1;
            const int32_t z = i / (n.x * n.y) + k / 9 - 1;
            const int32_t at[3] = {gas->at.x / GAS_BRICK + x, gas->at.y / GAS_BRICK + y,
                                   gas->at.z / GAS_BRICK + z};
            if (at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < CHIMNEY_X && at[1] < CHIMNEY_Y &&
                at[2] < CHIMNEY_X)
                near[in_domain(gas, x, y, z)] = true;
        }
}

/* A puff rises fast through a domain of 256 cells: the window goes with it, and bricks that it has
 * left give their memory to others. In the end all gas is gone, and so is the window. */
static void windows_follow_the_gas(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 30}\n"
        "gas: {a: {box: {size: [4, 32, 4]}, cell: 0.125, burn: none, buoyancy: 20, drag: 0, "
        "substeps: 1,\n"
        "  decay: {keys: {3 s: 2, 3.1 s: 100}}, turbulence: {strength: 0},\n"
        "  cooling: {glow: 0, even: {keys: {3 s: 0.4, 3.1 s: 100}}},\n"
        "  forces: [{wind: {velocity: [0, 8, 0], pull: 3 1/s}}],\n"
        "  sources: [{from: {sphere: {origin: [0, 4, 0], radius: 0.5}}, fuel: 0, temperature: 1,\n"
        "    smoke: 1, rate: {keys: {0 s: 30, 0.1 s: 30, 0.11 s: 0}}}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    uint32_t most = 0;
    int32_t lowest = 0;
    assert_int_equal(gas->shape.cells.y, 256);
    for (int i = 0; i < 75; i++) {
        bool near[CHIMNEY_X * CHIMNEY_Y * CHIMNEY_X];
        mark_near(gas, near);
        simulation_run(&run, 1);
        const struct kiln_gas_place n = gas->bricks;
        const uint32_t active = active_bricks(gas);
        /* after the source, only bricks that gas may have reached take memory */
        for (int32_t k = 0; k < n.x * n.y * n.z && i > 4; k++)
            assert_true(!gas->brick[k].now ||
                        near[in_domain(gas, k % n.x, k / n.x % n.y, k / (n.x * n.y))]);
        most = active > most ? active : most;
        lowest = gas->at.y;
    }
    double center[3];
    gas_center(gas, GAS_SMOKE, center);
    assert_true(center[1] > 10.0);
    assert_true(lowest > 0 && gas->cells.y < 256);
    /* no slab of 4 MiB was taken while a chunk was free */
    const uint32_t a_slab = (uint32_t)(((4u << 20) - 1) / kiln_gas_brick_bytes(&gas->shape));
    assert_int_equal(gas->slab_count, (most + a_slab - 1) / a_slab);
    simulation_run(&run, 45);
    assert_int_equal(active_bricks(gas), 0);
    assert_int_equal(gas->cells.y, 0);
    assert_true(hash_of(gas).lane[0] == 0 && hash_of(gas).lane[1] == 0);
    simulation_end_text(&run, scene);
}

/* ---- large domains --------------------------------------------------------------------------- */

#define PLUME                                                                                      \
    "cell: 0.0625, burn: none, turbulence: {strength: 0}, sources: [{from: {sphere: {origin: "     \
    "[0, 1, 0], radius: 0.3}}, reach: 0.2, noise: {size: 0.2}, fuel: 0, temperature: 1, smoke: "   \
    "1, velocity: [1, 2, 0.5]}]}}\n"

/* Returns whether the windows of two gases have the same gas and velocities, to the bit. */
static bool is_same(const struct kiln_gas *a, const struct kiln_gas *b)
{
    const size_t carried = GAS_BRICK_CELLS * GAS_CARRIED * sizeof(float);
    bool same = memcmp(&a->cells, &b->cells, sizeof a->cells) == 0;
    for (int32_t z = 0; same && z < a->cells.z; z++)
        for (int32_t y = 0; y < a->cells.y; y++)
            for (int axis = 0; axis < 3; axis++) {
                const ptrdiff_t row = z * a->plane + y * a->row;
                same = same && memcmp(a->faces[axis] + row, b->faces[axis] + row,
                                      (size_t)a->cells.x * sizeof(float)) == 0;
            }
    for (int32_t i = 0; same && i < a->bricks.x * a->bricks.y * a->bricks.z; i++)
        same = a->brick[i].now && b->brick[i].now
                   ? memcmp(a->brick[i].now, b->brick[i].now, carried) == 0
                   : a->brick[i].now == b->brick[i].now;
    return same;
}

/* As long as its window touches no side of the domain but the floor, a plume does not know how
 * large its domain is. */
static void plumes_do_not_depend_on_their_domain(void **state)
{
    (void)state;
    struct simulation small, large;
    struct kiln_scene *first = simulation_start_text(
        &small, "kiln: 1\nsimulation: {rate: 30}\ngas: {a: {box: {size: [6, 6, 6]}, " PLUME, 2);
    struct kiln_scene *second = simulation_start_text(
        &large, "kiln: 1\nsimulation: {rate: 30}\ngas: {a: {box: {size: [10, 16, 14]}, " PLUME, 1);
    const struct kiln_gas *a = &small.pool.gas[0], *b = &large.pool.gas[0];
    uint32_t steps = 0, windows = 0;
    int32_t cells = 0;
    for (; steps < 30; steps++) {
        simulation_run(&small, 1);
        simulation_run(&large, 1);
        const int32_t n = a->cells.x * a->cells.y * a->cells.z;
        windows += n != cells;
        cells = n;
        if (a->at.x == 0 || a->at.z == 0 || a->at.x + a->cells.x == 96 ||
            a->at.y + a->cells.y == 96 || a->at.z + a->cells.z == 96)
            break;
        assert_int_equal(b->at.x - a->at.x, 32);
        assert_int_equal(b->at.z - a->at.z, 64);
        if (!is_same(a, b))
            fail_msg("in step %u, a plume is another one in a larger domain", steps + 1);
    }
    assert_true(steps >= 10 && windows >= 2);
    simulation_end_text(&small, first);
    simulation_end_text(&large, second);
}

/* Domains of 1024 cells along an edge, with a source near their end. */
static void the_largest_edges_have_gas(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        double size[3] = {1, 1, 1}, at[3] = {0, 0, 0};
        char text[700];
        size[axis] = 64;
        at[axis] = 31.5;
        snprintf(text, sizeof text,
                 "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
                 "gas: {a: {box: {center: [0, 0, 0], size: [%g, %g, %g]}, cell: 0.0625,\n"
                 "  burn: none, sources: [{from: {point: {origin: [%g, %g, %g]}}, reach: 0.3,\n"
                 "  fuel: 0, temperature: 1, smoke: 1, noise: {amount: 0}}]}}\n",
                 size[0], size[1], size[2], at[0], at[1], at[2]);
        struct simulation run;
        struct kiln_scene *scene = simulation_start_text(&run, text, 2);
        const struct kiln_gas *gas = &run.pool.gas[0];
        simulation_run(&run, 3);
        const int32_t all[3] = {gas->shape.cells.x, gas->shape.cells.y, gas->shape.cells.z};
        const int32_t from[3] = {gas->at.x, gas->at.y, gas->at.z};
        const int32_t cells[3] = {gas->cells.x, gas->cells.y, gas->cells.z};
        double center[3];
        gas_center(gas, GAS_SMOKE, center);
        assert_int_equal(all[axis], KILN_MAX_GAS_EDGE);
        assert_int_equal(from[axis] + cells[axis], KILN_MAX_GAS_EDGE);
        assert_true(cells[axis] <= 64 && fabs(center[axis] - 31.5) < 0.02);
        simulation_end_text(&run, scene);
    }
}

/* ---- one state ------------------------------------------------------------------------------- */

static const char ALL[] =
    "kiln: 1\nseed: 3\nsimulation: {rate: 30}\n"
    "backdrop: {objects: {ball: {sphere: {radius: 0.2,\n"
    "  center: {keys: {0 s: [-0.5, 1, 0], 1 s: [0.5, 1.1, 0]}}}}}}\n"
    "systems: {dots: {emit: {rate: 200, life: 2 s, speed: 1, from: {sphere: {origin: [0, 0.3, "
    "0]}}},\n"
    "  forces: [{wind: {gas: fire, pull: 6 1/s}}]}}\n"
    "gas:\n"
    "  fire: {box: {size: [1.6, 2.4, 1.4]}, cell: 0.05, detail: 2, vorticity: 0.5,\n"
    "    forces: [{wind: {velocity: [0.5, 0, 0], pull: 1 1/s}}],\n"
    "    sources: [{from: {disc: {radius: 0.25, origin: [0, 0.05, 0]}}, velocity: [0, 0.7, 0]},\n"
    "      {from: {system: dots}, fuel: 0, temperature: 0, smoke: 0.5, reach: 0.15,\n"
    "        inherit: 0.5, color: [0.9, 0.3, 0.1]}]}\n"
    "  room: {box: {center: [4, 1, 0], size: [0.8, 0.8, 0.8]}, cell: 0.05, burn: none,\n"
    "    sides: {left: closed, right: closed, top: closed, back: closed, front: closed},\n"
    "    sources: [{from: {point: {origin: [4, 1, 0]}}, fuel: 0, temperature: 1, smoke: 1}]}\n";

/* Fire, sources of particles, winds both ways, a solid that moves, colours, and a closed room: each
 * state has the same bits at every level of vectors and for any number of threads. */
static void all_levels_and_threads_have_one_state(void **state)
{
    (void)state;
    struct kiln_state_hash first = {{0, 0}};
    for (enum kiln_simd level = 0; level < KILN_SIMD_COUNT; level++)
        for (uint32_t threads = 1; threads <= 3 && kiln_simd_has(level); threads++) {
            struct simulation run;
            setenv("KILN_SIMD", kiln_simd_name(level), 1);
            struct kiln_scene *scene = simulation_start_text(&run, ALL, threads);
            const struct kiln_state_hash hash = simulation_run_hashed(&run, 12);
            assert_true(gas_sum(&run.pool.gas[0], GAS_FLAME) > 1.0);
            assert_true(gas_sum(&run.pool.gas[1], GAS_SMOKE) > 1.0);
            if (first.lane[0] == 0)
                first = hash;
            if (memcmp(&hash, &first, sizeof hash) != 0)
                fail_msg("%s with %u threads: %08x%08x, expected %08x%08x", kiln_simd_name(level),
                         threads, hash.lane[0], hash.lane[1], first.lane[0], first.lane[1]);
            simulation_end_text(&run, scene);
        }
    unsetenv("KILN_SIMD");
}

/* ---- substeps -------------------------------------------------------------------------------- */

/* Returns the mean height below which 95 % of a campfire's flames are, of 1 s to 2.2 s. */
static double flame_height(uint32_t substeps)
{
    char text[900];
    snprintf(text, sizeof text,
             "kiln: 1\nsimulation: {rate: 60}\n"
             "gas: {fire: {box: {size: [1.2, 2.4, 1.2]}, cells: 32, substeps: %u,\n"
             "  sources: [{from: {disc: {radius: 0.27, origin: [0, 0.03, 0]}}, fuel: 1,\n"
             "    temperature: 0.65, velocity: [0, 0.7, 0], rate: 24,\n"
             "    noise: {amount: 0.6, size: 0.1, speed: 0.4}}],\n"
             "  turbulence: {strength: 6, size: 0.25, octaves: 2, speed: 0.7}}}\n",
             substeps);
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    simulation_run(&run, 59);
    double height = 0.0, fastest = 0.0;
    uint32_t steps = 0;
    for (; steps < 72; steps++) {
        double row[64] = {0.0}, all = 0.0, sum = 0.0;
        simulation_run(&run, 1);
        for (int32_t y = 0; y < gas->shape.cells.y; y++) {
            for (int32_t z = 0; z < gas->shape.cells.z; z++)
                for (int32_t x = 0; x < gas->shape.cells.x; x++)
                    row[y] += (double)gas_at(gas, GAS_FLAME, x, y, z);
            all += row[y];
        }
        int32_t y = 0;
        for (; sum + row[y] < 0.95 * all; y++)
            sum += row[y];
        height += (y + (0.95 * all - sum) / row[y]) * (double)gas->shape.cell;
        fastest = fmax(fastest, gas_fastest(gas));
    }
    /* gas moves less than two cells in a substep, so none is held back */
    assert_true(fastest / 60.0 / substeps < 2.0 * (double)gas->shape.cell);
    simulation_end_text(&run, scene);
    return height / steps;
}

static void substeps_do_not_change_the_look(void **state)
{
    (void)state;
    const double one = flame_height(1);
    for (uint32_t substeps = 2; substeps <= 4; substeps *= 2) {
        const double height = flame_height(substeps);
        if (!(fabs(height / one - 1.0) < 0.05)) /* 0.8 % with two, 0.3 % with four */
            fail_msg("flames of %.3f m with %u substeps, %.3f m with one", height, substeps, one);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_follow_the_gas),
        cmocka_unit_test(plumes_do_not_depend_on_their_domain),
        cmocka_unit_test(the_largest_edges_have_gas),
        cmocka_unit_test(all_levels_and_threads_have_one_state),
        cmocka_unit_test(substeps_do_not_change_the_look),
    };
    return cmocka_run_group_tests_name("gas_window", tests, NULL, NULL);
}
