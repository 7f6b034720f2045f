/* The air that a window reaches when it grows, against domains whose window is all of them from the
 * start. If this fails, a plume in wind meets air at its window's edge that stands still, and what
 * it does depends on how large its window was. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* A source of nothing that reaches all cells: bricks are active everywhere, and the window is all
 * of the domain. */
#define ALL                                                                                        \
    ", {from: {box: {origin: [0, 2, 0], size: [20, 20, 20]}}, fuel: 0, temperature: 0, smoke: 0, " \
    "rate: 1, noise: {amount: 0}}"

/* Two runs of a scene: with a window that follows the gas, and with one that is all of the domain.
 */
struct pair {
    struct kiln_scene *scene[2];
    struct simulation run[2];
    const struct kiln_gas *small, *whole;
};

/* keys: of the domain; source: its keys. */
static void start(struct pair *pair, const char *keys, const char *source)
{
    for (int k = 0; k < 2; k++) {
        char text[1400];
        snprintf(text, sizeof text,
                 "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
                 "nodes: {cart: {position: {keys: {0 s: [0, 0, 0], 2 s: [4, 0, 0]}}}}\n"
                 "gas: {a: {burn: none, decay: 0, vorticity: 0, turbulence: {strength: 0}, %s,\n"
                 "  sources: [{fuel: 0, smoke: 1, reach: 0.2, noise: {amount: 0}, %s}%s]}}\n",
                 keys, source, k ? ALL : "");
        pair->scene[k] = load_scene(text, NULL);
        simulation_start(&pair->run[k], pair->scene[k], NULL, 2);
    }
    pair->small = &pair->run[0].pool.gas[0];
    pair->whole = &pair->run[1].pool.gas[0];
}

static void run_both(struct pair *pair, uint32_t steps)
{
    simulation_run(&pair->run[0], steps);
    simulation_run(&pair->run[1], steps);
}

static void end(struct pair *pair)
{
    for (int k = 0; k < 2; k++) {
        simulation_end(&pair->run[k]);
        kiln_scene_destroy(&pair->scene[k]);
    }
}

static float speed_at(const struct kiln_gas *gas, int axis, int32_t x, int32_t y, int32_t z)
{
    return gas
        ->faces[axis][(z - gas->at.z) * gas->plane + (y - gas->at.y) * gas->row + x - gas->at.x];
}

/* Returns the root of the mean square, over the faces of the small window, of the difference of the
 * two runs' velocities, m/s, and the largest one. */
static double difference(const struct pair *pair, double *most)
{
    const struct kiln_gas *a = pair->small;
    double sum = 0.0, count = 0.0;
    *most = 0.0;
    for (int c = 0; c < 3; c++)
        for (int32_t z = a->at.z; z < a->at.z + a->cells.z; z++)
            for (int32_t y = a->at.y; y < a->at.y + a->cells.y; y++)
                for (int32_t x = a->at.x; x < a->at.x + a->cells.x; x++) {
                    const double off =
                        (double)speed_at(a, c, x, y, z) - (double)speed_at(pair->whole, c, x, y, z);
                    sum += off * off;
                    count += 1.0;
                    *most = fmax(*most, fabs(off));
                }
    return sqrt(sum / count);
}

static bool is_smaller(const struct pair *pair)
{
    const struct kiln_gas_place a = pair->small->cells, b = pair->whole->cells;
    return a.x < b.x && a.x * a.y * a.z < b.x * b.y * b.z;
}

#define WIND "forces: [{wind: {velocity: [4, 0.4, 0], pull: 2 1/s}}]"

/* Air that a wind has moved from the start moves alike wherever the window reaches it. */
static void wind_blows_in_new_air(void **state)
{
    (void)state;
    struct pair pair;
    double most;
    start(&pair,
          "box: {center: [7, 2, 0], size: [20, 6, 6]}, cell: 0.125, buoyancy: 0, drag: 0, "
          "sides: {bottom: open}, " WIND,
          "from: {sphere: {origin: [0, 2, 0], radius: 0.2}}, temperature: 0, rate: {keys: {0 s: "
          "100, 0.1 s: 100, 0.11 s: 0}}");
    for (int i = 0; i < 3; i++) {
        run_both(&pair, 30);
        assert_true(is_smaller(&pair));
        difference(&pair, &most);
        const double blown = 4.0 * (1.0 - exp(-2.0 * pair.run[0].step / 60.0));
        if (!(most < 1e-3 * blown))
            fail_msg("air differs by %.3g m/s of %.3g m/s", most, blown);
        double small[3], whole[3];
        gas_center(pair.small, GAS_SMOKE, small);
        gas_center(pair.whole, GAS_SMOKE, whole);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(small[c] - whole[c]) < 1e-3);
    }
    end(&pair);
}

/* So does air that a window reaches first when the wind has long blown. */
static void wind_has_blown_before(void **state)
{
    (void)state;
    struct pair pair;
    double most;
    start(&pair,
          "box: {center: [7, 2, 0], size: [20, 6, 6]}, cell: 0.125, buoyancy: 0, drag: 0.3, "
          "sides: {bottom: open}, " WIND,
          "from: {sphere: {origin: [0, 2, 0], radius: 0.2}}, temperature: 0, rate: {keys: {0 s: "
          "0, 0.5 s: 0, 0.51 s: 100}}");
    run_both(&pair, 35);
    assert_true(is_smaller(&pair));
    difference(&pair, &most);
    /* steps are of first order in the drag */
    if (!(most < 0.02))
        fail_msg("air differs by %.3g m/s", most);
    end(&pair);
}

/* A hot plume bends in the wind as it does in a domain whose air is simulated from the start. */
static void plumes_bend_alike(void **state)
{
    (void)state;
    struct pair pair;
    double most, small[3], whole[3];
    start(&pair,
          "box: {center: [6, 3, 0], size: [18, 6, 6]}, cell: 0.125, buoyancy: 6, drag: 0.05, " WIND,
          "from: {sphere: {origin: [0, 0.4, 0], radius: 0.3}}, temperature: 0.8, rate: 20");
    for (int i = 0; i < 3; i++) {
        run_both(&pair, 30);
        assert_true(is_smaller(&pair));
        const double rms = difference(&pair, &most);
        gas_center(pair.small, GAS_SMOKE, small);
        gas_center(pair.whole, GAS_SMOKE, whole);
        /* 0.04 to 0.09 m/s, and 2.5 % behind; where new air is at rest, 0.27 to 0.73 m/s and 6 % */
        if (!(rms < 0.12) || !(fabs(small[0] - whole[0]) < 0.035 * whole[0]) ||
            !(fabs(small[1] - whole[1]) < 0.02 * whole[1]))
            fail_msg("after %u steps air differs by %.3g m/s, and smoke is at (%.4f, %.4f) m "
                     "instead of (%.4f, %.4f) m",
                     pair.run[0].step, rms, small[0], small[1], whole[0], whole[1]);
    }
    end(&pair);
}

enum { EDGE = 32, POINTS = EDGE / GAS_LATTICE + 1 };

/* New air goes on as the nearest air does by how much alike the forces on both are: with the same
 * wind, also one of no speed, it moves alike; with half the wind, half as fast; beyond the region
 * of a force, and where forces are opposite, it is at rest. */
static void new_air_takes_over_as_forces_do(void **state)
{
    (void)state;
    static const struct {
        float4 old, new; /* forces on the air of the old window, and on new air */
        float part;      /* of the velocity */
    } cases[] = {
        {{4, 0, 0, 2}, {4, 0, 0, 2}, 1},  {{4, 0, 0, 2}, {2, 0, 0, 1}, 0.5f},
        {{4, 0, 0, 2}, {0, 0, 0, 0}, 0},  {{0, 0, 0, 2}, {0, 0, 0, 2}, 1},
        {{4, 0, 0, 2}, {9, 0, 0, 5}, 1},  {{0, 3, 0, 0}, {0, 0, 3, 0}, 0},
        {{0, 3, 0, 0}, {0, -3, 0, 0}, 0}, {{0, 0, 0, 0}, {0, 0, 0, 0}, 0},
        {{0, 0, 0, 0}, {4, 0, 0, 2}, 0},  {{0, 6, 0, 0}, {0, 2, 0, 0}, 1.0f / 3.0f},
    };
    const struct kiln_gas_shape shape = {.cells = {96, EDGE, EDGE}, .cell = 0.5f};
    const struct kiln_gas_place cells = {EDGE, EDGE, EDGE};
    const struct gas_rest rest = {{-1, 0.5f, 0}, {0, 0, 0}};
    float4 points[POINTS * POINTS * POINTS];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_gas gas;
        const struct gas_lattice forces = {
            .points = points, .row = POINTS, .plane = POINTS * POINTS};
        kiln_gas_init(&gas, &shape);
        assert_true(kiln_gas_set_window(&gas, (struct kiln_gas_place){32, 0, 0}, cells));
        for (int32_t k = 0; k < EDGE * EDGE * (EDGE + 1);
             k++) /* air at 2 m/s along x in the world */
            gas.faces[0][k / (EDGE + 1) / EDGE * gas.plane + k / (EDGE + 1) % EDGE * gas.row +
                         k % (EDGE + 1)] = 2.0f - 1.0f;
        for (int32_t k = 0; k < POINTS * POINTS * POINTS; k++)
            points[k] = k % POINTS <= 8 ? cases[i].old : cases[i].new;
        /* the window moves by half its length */
        assert_true(kiln_gas_set_window(&gas, (struct kiln_gas_place){48, 0, 0}, cells));
        gas_new_air_rest(&gas, (struct kiln_gas_place){32, 0, 0}, cells, &rest);
        gas_new_air_blown(&gas, (struct kiln_gas_place){32, 0, 0}, cells, &rest, &forces, 9, 0);
        for (int32_t k = 0; k < EDGE * EDGE * EDGE; k++) {
            const int32_t x = k % EDGE, y = k / EDGE % EDGE, z = k / EDGE / EDGE;
            const float found = gas.faces[0][z * gas.plane + y * gas.row + x];
            const float expected = x <= 16 ? 1.0f : 2.0f * cases[i].part - 1.0f;
            const float aside = gas.faces[1][z * gas.plane + y * gas.row + x];
            if (!(fabsf(found - expected) < 1e-5f))
                fail_msg("case %zu: %g m/s at %d, expected %g", i, (double)found, x,
                         (double)expected);
            if (x > 16) /* still air */
                assert_true(fabsf(aside - (0.5f - 0.5f * cases[i].part)) < 1e-5f ||
                            cases[i].old.x == 0.0f);
        }
        kiln_gas_finish(&gas);
    }
}

/* A wind of no speed holds air at rest in the world, also in a domain that moves. */
static void winds_blow_in_the_world(void **state)
{
    (void)state;
    struct pair pair;
    start(&pair,
          "attach: cart, box: {center: [0, 2, 0], size: [16, 6, 6]}, cell: 0.125, buoyancy: 0, "
          "drag: 0, sides: {bottom: open}, forces: [{wind: {velocity: [0, 0.5, 0], pull: 3}}]",
          "from: {sphere: {origin: [0, 2, 0], radius: 0.2}}, temperature: 0, rate: {keys: {0 s: "
          "100, 0.1 s: 100, 0.11 s: 0}}");
    run_both(&pair, 12);
    for (int k = 0; k < 2; k++) {
        const struct kiln_gas *gas = k ? pair.whole : pair.small;
        const double blown = 0.5 * (1.0 - exp(-3.0 * 12 / 60));
        for (int32_t i = 0; i < 16; i++) {
            const struct kiln_gas_place at = {gas->at.x + i, gas->at.y + 4, gas->at.z + 5};
            const double along = (double)speed_at(gas, 0, at.x, at.y, at.z) + 2.0;
            const double upwards = (double)speed_at(gas, 1, at.x, at.y, at.z) - blown;
            if (!(fabs(along) < 1e-5) || !(fabs(upwards) < 6e-3)) /* of first order: 4e-3 */
                fail_msg("air moves by %.3g m/s too fast along, %.3g m/s upwards", along, upwards);
        }
    }
    end(&pair);
}

/* Returns the mean velocity along x of the faces of a window, m/s. */
static double mean_wind(const struct kiln_gas *gas)
{
    double sum = 0.0;
    for (int32_t z = 0; z < gas->cells.z; z++)
        for (int32_t y = 0; y < gas->cells.y; y++)
            for (int32_t x = 0; x < gas->cells.x; x++)
                sum += (double)gas->faces[0][z * gas->plane + y * gas->row + x];
    return sum / ((double)gas->cells.x * (double)gas->cells.y * (double)gas->cells.z);
}

/* A wind blows through a domain, and stops. Air at rest then flows in behind, so that the wind ends
 * when it has gone through the domain, and a bit later for what pressure holds back. If it brought
 * the momentum of the air at the border, it would blow for ever, and the draught of a fire would
 * grow to a storm that blows it out. */
static void winds_end(void **state)
{
    (void)state;
    struct pair pair;
    start(&pair,
          "box: {size: [4, 4, 4]}, cell: 0.25, buoyancy: 0, drag: 0, forces: [{wind: {velocity: "
          "[2, 0, 0], pull: {keys: {1 s: 4, 1.01 s: 0}}}}]",
          "from: {sphere: {origin: [0, 2, 0], radius: 0.5}}, temperature: 0");
    simulation_run(&pair.run[1], 60);
    const double blown = mean_wind(pair.whole);
    assert_true(blown > 1.9 && blown < 2.0);
    simulation_run(&pair.run[1], 240);
    assert_true(mean_wind(pair.whole) < 0.25 * blown);
    end(&pair);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wind_blows_in_new_air),
        cmocka_unit_test(wind_has_blown_before),
        cmocka_unit_test(plumes_bend_alike),
        cmocka_unit_test(new_air_takes_over_as_forces_do),
        cmocka_unit_test(winds_blow_in_the_world),
        cmocka_unit_test(winds_end),
    };
    return cmocka_run_group_tests_name("gas_new_air", tests, NULL, NULL);
}
