/* Gas beside solids: if this fails, smoke leaks through walls, solids that move do not push the air
 * before them, or make smoke out of nothing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* ---- leaks ----------------------------------------------------------------------------------- */

/* A jet of hot smoke blows at a wall that reaches through the whole domain. `wall` has the place of
 * the wall's middle, along x, at a time: the wall is as thick as two cells, or a tenth of one, and
 * may be turned about z. */
struct wall {
    const char *center;
    double thick, degrees;
    double begin, end; /* m: where the middle is at 0 s and at 1 s */
};

/* Returns the most smoke in cells that lie behind a wall, and fills in the smoke before it. */
static double leaked(const struct wall *wall, double *before)
{
    char text[1200];
    snprintf(text, sizeof text,
             "kiln: 1\nsimulation: {rate: 60}\n"
             "backdrop: {floor: none, objects: {wall: {box: {center: %s, size: [%g, 8, 8],\n"
             "  rotation: [0, 0, %g deg]}}}}\n"
             "gas: {a: {box: {center: [0, 1, 0], size: [2, 2, 2]}, cell: 0.0625, burn: none,\n"
             "  decay: 0, sides: {top: closed, back: closed, front: closed},\n"
             "  sources: [{from: {sphere: {origin: [-0.5, 1, 0], radius: 0.25}}, fuel: 0,\n"
             "    temperature: 1, smoke: 1, velocity: [3, 0, 0]}]}}\n",
             wall->center, wall->thick, wall->degrees);
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    const double c = cos(wall->degrees * M_PI / 180), s = sin(wall->degrees * M_PI / 180);
    double most = 0.0;
    *before = 0.0;
    for (uint32_t k = 1; k <= 30; k++) {
        simulation_run(&run, 1);
        const double middle = wall->begin + (wall->end - wall->begin) * k / 60.0;
        double sum = 0.0;
        for (int32_t z = 0; z < 32; z++)
            for (int32_t y = 0; y < 32; y++)
                for (int32_t x = 0; x < 32; x++) {
                    const double p = (x + 0.5) / 16 - 1 - middle, q = (y + 0.5) / 16 - 1;
                    const double smoke = (double)gas_at(gas, GAS_SMOKE, x, y, z);
                    if (c * p + s * q > 0.5 * wall->thick + 1e-4)
                        most = fmax(most, smoke);
                    else
                        sum += smoke;
                }
        *before = sum;
    }
    simulation_end_text(&run, scene);
    return most;
}

static void nothing_leaks_through_walls(void **state)
{
    (void)state;
    static const struct wall walls[] = {
        {"[0.3, 1, 0]", 0.125, 0, 0.3, 0.3},
        {"[0.3, 1, 0]", 0.00625, 0, 0.3, 0.3},
        {"[0.28125, 1, 0]", 0.00625, 0, 0.28125, 0.28125}, /* through the centres of cells */
        {"[0.3, 1, 0]", 0.125, 25, 0.3, 0.3},
        {"[0.3, 1, 0]", 0.00625, 25, 0.3, 0.3},
        {"{keys: {0 s: [0.1, 1, 0], 1 s: [0.6, 1, 0]}}", 0.125, 0, 0.1, 0.6},
        {"{keys: {0 s: [0.6, 1, 0], 1 s: [0.1, 1, 0]}}", 0.125, 0, 0.6, 0.1},
        {"{keys: {0 s: [0.1, 1, 0], 1 s: [0.6, 1, 0]}}", 0.00625, 0, 0.1, 0.6},
        {"{keys: {0 s: [0.6, 1, 0], 1 s: [0.1, 1, 0]}}", 0.00625, 0, 0.6, 0.1},
        {"{keys: {0 s: [0.6, 1, 0], 1 s: [0.1, 1, 0]}}", 0.125, 25, 0.6, 0.1},
        {"{keys: {0 s: [0.6, 1, 0], 1 s: [0.1, 1, 0]}}", 0.00625, 25, 0.6, 0.1},
        {"{keys: {0 s: [0.7, 1, 0], 1 s: [-0.2, 1, 0]}}", 0.00625, 10, 0.7, -0.2},
    };
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        double before;
        const double most = leaked(&walls[i], &before);
        assert_true(before > 700.0);
        if (!(most == 0.0))
            fail_msg("%s: smoke of %.3g behind the wall", walls[i].center, most);
    }
}

/* ---- solids that move ------------------------------------------------------------------------ */

/* A piston in a channel that is closed but at its end: all air before it has its speed. */
static void a_piston_pushes_the_air(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 60}\n"
        "backdrop: {floor: none, objects: {piston: {box: {size: [0.5, 4, 4],\n"
        "  center: {keys: {0 s: [-0.9, 0.5, 0], 2 s: [0.1, 0.5, 0]}}}}}}\n"
        "gas: {a: {box: {size: [2, 1, 1]}, cell: 0.0625, burn: none, buoyancy: 0, vorticity: 0,\n"
        "  turbulence: {strength: 0}, drag: 0, decay: 0, pressure: {cycles: 4},\n"
        "  sides: {left: closed, top: closed, back: closed, front: closed},\n"
        "  sources: [{from: {box: {origin: [0.5, 0.5, 0], size: [0.3, 0.5, 0.5]}}, fuel: 0,\n"
        "    temperature: 0, smoke: 1}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    for (int turn = 0; turn < 3; turn++) {
        simulation_run(&run, 20);
        const double right = -0.9 + 0.5 * run.step / 60.0 + 0.25;
        double most = 0.0;
        int32_t faces = 0;
        for (int32_t z = 0; z < gas->cells.z; z++)
            for (int32_t y = 0; y < gas->cells.y; y++)
                for (int32_t x = 0; x <= gas->cells.x; x++) {
                    const ptrdiff_t at = z * gas->plane + y * gas->row + x;
                    if ((gas->at.x + x) / 16.0 - 1.0 < right + 0.0625)
                        continue;
                    faces++;
                    most = fmax(most, fabs((double)gas->faces[0][at] - 0.5));
                }
        assert_true(faces > 4000);
        if (!(most < 1e-3)) /* 2.6e-4 at first, then 6e-5 */
            fail_msg("step %u: a velocity differs from that of the piston by %.3g", run.step, most);
    }
    simulation_end_text(&run, scene);
}

/* A ball moves through even smoke in a closed box: there is none in the ball, and around it the
 * smoke stays even. */
static void a_ball_parts_the_smoke(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 60}\n"
        "backdrop: {floor: none, objects: {ball: {sphere: {radius: 0.3,\n"
        "  center: {keys: {0 s: [-0.5, 0.8, 0], 1 s: [0.5, 0.8, 0.1]}}}}}}\n"
        "gas: {a: {box: {size: [2, 2, 2]}, cell: 0.0625, burn: none, buoyancy: 0,\n"
        "  vorticity: 0, turbulence: {strength: 0}, drag: 0, decay: 0,\n"
        "  sides: {left: closed, right: closed, top: closed, back: closed, front: closed},\n"
        "  sources: [{from: {box: {size: [9, 9, 9]}}, fuel: 0, temperature: 0, smoke: 1,\n"
        "    noise: {amount: 0}, rate: {keys: {0 s: 10000, 0.02 s: 10000, 0.021 s: 0}}}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    simulation_run(&run, 1);
    const double first = gas_sum(gas, GAS_SMOKE);
    for (int turn = 0; turn < 4; turn++) {
        simulation_run(&run, 14);
        const double t = run.step / 60.0, at[3] = {-0.5 + t, 0.8, 0.1 * t};
        double inside = 0.0, low = 9.0, high = 0.0, mean = 0.0, cells = 0;
        for (int32_t z = 0; z < gas->cells.z; z++)
            for (int32_t y = 0; y < gas->cells.y; y++)
                for (int32_t x = 0; x < gas->cells.x; x++) {
                    const double dx = (x + 0.5) / 16 - 1 - at[0], dy = (y + 0.5) / 16 - at[1];
                    const double dz = (z + 0.5) / 16 - 1 - at[2];
                    const double r = sqrt(dx * dx + dy * dy + dz * dz);
                    const double smoke = (double)gas_at(gas, GAS_SMOKE, x, y, z);
                    if (r < 0.3 - 1.0 / 60)
                        inside = fmax(inside, smoke);
                    else if (r > 0.3 + 2.0 / 16) {
                        if (dx > 0.0)
                            low = fmin(low, smoke);
                        high = fmax(high, smoke);
                        mean += smoke;
                        cells++;
                    }
                }
        /* cells that the ball has left begin with none, so its wake is thin */
        assert_true(inside == 0.0);
        if (!(low > 0.99 && high < 1.02 && fabs(mean / cells - 1.0) < 0.01))
            fail_msg("smoke of %.3f before the ball, %.3f at most, %.3f in the mean", low, high,
                     mean / cells);
        if (!(fabs(gas_sum(gas, GAS_SMOKE) / first - 1.0) < 1e-3)) /* 3e-4 */
            fail_msg("the smoke became %.5f of what it was", gas_sum(gas, GAS_SMOKE) / first);
    }
    simulation_end_text(&run, scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_leaks_through_walls),
        cmocka_unit_test(a_piston_pushes_the_air),
        cmocka_unit_test(a_ball_parts_the_smoke),
    };
    return cmocka_run_group_tests_name("gas_solids", tests, NULL, NULL);
}
