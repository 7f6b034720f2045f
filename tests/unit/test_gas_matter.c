/* Compares what gas carries with closed forms: smoke that is neither lost nor made, fire, decay
 * and colours. If this fails, a fire burns too fast, or smoke vanishes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_rig.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* A domain that stands still: air that nothing moves. Its cells are 1/16 m. */
#define STILL                                                                                      \
    "cell: 0.0625, buoyancy: 0, vorticity: 0, drag: 0, turbulence: {strength: 0}, "                \
    "sides: {bottom: open}"

/* ---- the mass of smoke ----------------------------------------------------------------------- */

/* Ten seconds of stirring in a closed box, by eddies and a whirl. */
static void smoke_is_kept(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 30}\nbackdrop: {floor: none}\n"
        "gas: {a: {box: {size: [1.5, 1.5, 1.5]}, cell: 0.0625, burn: none, decay: 0,\n"
        "  cooling: {glow: 0, even: 0}, turbulence: {strength: 4}, drag: 0.5, substeps: 1,\n"
        "  sides: {left: closed, right: closed, top: closed, back: closed, front: closed},\n"
        "  forces: [{wind: {field: vortex, position: [0, 0, 0], speed: 2, pull: 2 1/s}}],\n"
        "  sources: [{from: {sphere: {origin: [0.2, 0.5, 0], radius: 0.3}}, fuel: 0, smoke: 1,\n"
        "    temperature: 0.5, rate: {keys: {0 s: 20, 0.3 s: 20, 0.31 s: 0}}}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    const struct kiln_gas *gas = &run.pool.gas[0];
    simulation_run(&run, 11);
    const double before = gas_sum(gas, GAS_SMOKE);
    double most = 0.0, fastest = 0.0;
    for (int i = 0; i < 10; i++) {
        simulation_run(&run, 30);
        most = fmax(most, fabs(gas_sum(gas, GAS_SMOKE) / before - 1.0));
        fastest = fmax(fastest, gas_fastest(gas));
    }
    assert_true(before > 50.0 && fastest > 0.5);
    if (!(most < 1e-3)) /* 2.0e-4 */
        fail_msg("the smoke of a closed box changed by %.2g", most);
    simulation_end_text(&run, scene);
}

/* ---- fire ------------------------------------------------------------------------------------ */

struct fire {
    double fuel, temperature, smoke, flame;
};

struct burning {
    double ignition, rate, heat, soot, expand, life, gain, clear, glow, even, decay;
};

/* Returns the change of a cell a second. The flame follows the rate of burning upwards at once. */
static struct fire change_of(const struct burning *b, struct fire q)
{
    const double burns = q.temperature > b->ignition ? b->rate * q.fuel : 0.0;
    const double grows = b->expand * burns;
    return (struct fire){
        .fuel = -burns - grows * q.fuel,
        .temperature = b->heat * burns - b->glow * pow(q.temperature, 4) - b->even,
        .smoke = b->soot * burns - (grows + b->decay + b->clear * q.flame) * q.smoke,
        .flame = -1.0 / b->life,
    };
}

static struct fire moved(const struct burning *b, struct fire q, struct fire d, double t)
{
    struct fire y = {fmax(q.fuel + t * d.fuel, 0.0), fmax(q.temperature + t * d.temperature, 0.0),
                     fmax(q.smoke + t * d.smoke, 0.0), fmax(q.flame + t * d.flame, 0.0)};
    const double burns = y.temperature > b->ignition ? b->rate * y.fuel : 0.0;
    y.flame = fmin(fmax(y.flame, b->gain * burns), 1.0);
    return y;
}

/* Solves the equations of a cell by the midpoint method in steps of 10 us. */
static struct fire burnt_down(const struct burning *b, struct fire q, double time_s)
{
    const double step = 1e-5;
    for (double t = 0.0; t < time_s - 0.5 * step; t += step)
        q = moved(b, q, change_of(b, moved(b, q, change_of(b, q), 0.5 * step)), step);
    return q;
}

/* Burns a domain that is filled evenly, and returns the middle cell after a time. */
static struct fire burn_cell(const struct burning *b, uint32_t rate, double time_s)
{
    char text[1200];
    snprintf(text, sizeof text,
             "kiln: 1\nsimulation: {rate: %u}\nbackdrop: {floor: none}\n"
             "gas: {a: {box: {center: [0, 0, 0], size: [1, 1, 1]}, " STILL ",\n"
             "  burn: {ignition: %g, rate: %g, heat: %g, soot: %g, expand: %g, life: %g,\n"
             "    gain: %g, clear: %g}, cooling: {glow: %g, even: %g}, decay: %g,\n"
             "  sources: [{from: {box: {size: [2, 2, 2]}}, fuel: 0.3, temperature: 0.6,\n"
             "    smoke: 0.2, noise: {amount: 0},\n"
             "    rate: {keys: {0 s: 10000, 0.0001 s: 10000, %.9g s: 10000, %.9g s: 0}}}]}}\n",
             rate, b->ignition, b->rate, b->heat, b->soot, b->expand, b->life, b->gain, b->clear,
             b->glow, b->even, b->decay, 1.0 / rate, 1.0 / rate + 1e-6);
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    simulation_run(&run, 1);
    const float *cell = gas_cell(&run.pool.gas[0], 7, 8, 8);
    assert_true(cell[GAS_FUEL] == 0.3f && cell[GAS_TEMPERATURE] == 0.6f);
    simulation_run(&run, (uint32_t)(time_s * rate + 0.5));
    cell = gas_cell(&run.pool.gas[0], 7, 8, 8);
    const struct fire found = {(double)cell[GAS_FUEL], (double)cell[GAS_TEMPERATURE],
                               (double)cell[GAS_SMOKE], (double)cell[GAS_FLAME]};
    simulation_end_text(&run, scene);
    return found;
}

static double largest_error(struct fire a, struct fire b)
{
    return fmax(fmax(fabs(a.fuel - b.fuel), fabs(a.temperature - b.temperature)),
                fmax(fabs(a.smoke - b.smoke), fabs(a.flame - b.flame)));
}

/* Fuel, heat, soot and flames follow their equations, in first order of the step. */
static void fire_follows_its_equations(void **state)
{
    (void)state;
    static const struct burning cases[] = {
        /* a still cell; one that is thinned as it burns; one that no flame is hot enough for; one
         * whose fire goes out when it is cold */
        {0.25, 2.2, 1.6, 0.5, 0, 0.6, 0.094, 2, 0.6, 0.25, 0.6},
        {0.25, 4, 1.6, 2, 2, 0.3, 0.2, 0, 0.6, 0.25, 0},
        {0.7, 4, 1.6, 2, 2, 0.3, 0.2, 0, 0.6, 0.25, 0.5},
        {0.5, 1, 0.2, 1, 0, 0.2, 1, 0, 2, 0.4, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int k = 0; k < 2; k++) {
            const double time_s = k ? 0.8 : 0.2;
            const struct fire start_values = {0.3, 0.6, 0.2, 0.0};
            const struct fire expected = burnt_down(&cases[i], start_values, time_s);
            const struct fire slow = burn_cell(&cases[i], 60, time_s);
            const struct fire fast = burn_cell(&cases[i], 240, time_s);
            const double coarse = largest_error(slow, expected);
            const double fine = largest_error(fast, expected);
            /* 5e-5 to 1.6e-3 at 240 steps a second; where a fire goes out, its flame is late by a
             * part of a step: 0.013 */
            if (!(fine < (i == 3 ? 0.02 : 0.002)) || !(fine < 0.4 * coarse + 1e-5))
                fail_msg("case %zu: off by %.4f at 60 steps a second, %.4f at 240", i, coarse,
                         fine);
        }
}

/* Smoke fades by exp(-decay t). */
static void smoke_decays(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
        "gas: {a: {box: {center: [0, 0, 0], size: [1, 1, 1]}, burn: none, decay: 0.7, " STILL ",\n"
        "  sources: [{from: {box: {size: [2, 2, 2]}}, fuel: 0, temperature: 0, smoke: 2,\n"
        "    noise: {amount: 0}, rate: {keys: {0 s: 10000, 0.02 s: 10000, 0.021 s: 0}}}]}}\n";
    struct simulation run;
    struct kiln_scene *scene = simulation_start_text(&run, text, 2);
    simulation_run(&run, 1);
    for (int i = 1; i <= 4; i++) {
        simulation_run(&run, 30);
        const double found = (double)gas_at(&run.pool.gas[0], GAS_SMOKE, 3, 9, 12);
        const double expected = 2.0 * exp(-0.35 * i);
        if (!(fabs(found / expected - 1.0) < 1e-5))
            fail_msg("after %.1f s there is smoke of %.6f, expected %.6f", 0.5 * i, found,
                     expected);
    }
    simulation_end_text(&run, scene);
}

/* Smoke of one colour keeps it wherever it flows; that of two sources has mixtures of both. */
static void smoke_keeps_its_colour(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 30}\n"
        "gas: {a: {box: {size: [2, 2, 2]}, cell: 0.0625, burn: none, sources: [\n"
        "  {from: {sphere: {origin: [-0.3, 0.4, 0], radius: 0.2}}, fuel: 0, temperature: 1,\n"
        "    smoke: 1, color: [0.8, 0.2, 0.1]},\n"
        "  {from: {sphere: {origin: [%s, 0.4, 0], radius: 0.2}}, fuel: 0, temperature: 1,\n"
        "    smoke: 2, color: [%s]}]}}\n";
    for (int two = 0; two < 2; two++) {
        char full[700];
        snprintf(full, sizeof full, text, "0.3", two ? "0.1, 0.2, 0.9" : "0.8, 0.2, 0.1");
        struct simulation run;
        struct kiln_scene *scene = simulation_start_text(&run, full, 2);
        const struct kiln_gas *gas = &run.pool.gas[0];
        simulation_run(&run, 45);
        double most = 0.0;
        uint32_t cells = 0, mixed = 0;
        for (int32_t i = 0; i < gas->bricks.x * gas->bricks.y * gas->bricks.z; i++)
            for (int32_t k = 0; gas->brick[i].now && k < GAS_BRICK_CELLS; k++) {
                const float *color = gas->brick[i].extras + k * GAS_CARRIED;
                if (gas->brick[i].now[k * GAS_CARRIED] < 0.01f)
                    continue;
                const double red = (double)(color[0] / color[3]);
                const double blue = (double)(color[2] / color[3]);
                cells++;
                mixed += red > 0.2 && red < 0.7;
                /* red and blue lie on the line between the two colours */
                const double off = two ? fmax(fabs((red - 0.1) + (blue - 0.9) * (0.7 / 0.8)),
                                              fmax(0.1 - red, red - 0.8))
                                       : fmax(fabs(red - 0.8), fabs(blue - 0.1));
                most = fmax(most, fmax(off, fabs((double)(color[1] / color[3]) - 0.2)));
            }
        if (!(cells > 2000 && (mixed > 20) == (two == 1)))
            fail_msg("%u cells have smoke, and %u of them mixtures", cells, mixed);
        if (!(most < 1e-5)) /* 1.3e-6 */
            fail_msg("a colour is off by %.3g", most);
        simulation_end_text(&run, scene);
    }
}

/* Cells remember where their gas came from: nowhere else in still air, and in a wind from as far
 * away as it has blown. */
static void gas_remembers_where_it_came_from(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nsimulation: {rate: 60}\nbackdrop: {floor: none}\n"
        "gas: {a: {box: {center: [0, 0, 0], size: [2, 1, 1]}, burn: none, detail: 2, " STILL ",\n"
        "  forces: [{wind: {velocity: [%s, 0, 0], pull: 100 1/s}}],\n"
        "  sources: [{from: {box: {size: [4, 2, 2]}}, fuel: 0, temperature: 0, smoke: 1}]}}\n";
    for (int blows = 0; blows < 2; blows++) {
        char full[600];
        snprintf(full, sizeof full, text, blows ? "0.6" : "0");
        struct simulation run;
        struct kiln_scene *scene = simulation_start_text(&run, full, 2);
        const struct kiln_gas *gas = &run.pool.gas[0];
        simulation_run(&run, 20);
        const struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(gas, 3, 1, 1)];
        assert_non_null(brick->extras);
        const float *first = brick->extras, *second = first + GAS_BRICK_CELLS * GAS_CARRIED;
        /* 0.01 m times the sum of 1 - (1 + 100 / 60)^-k for k from 0 to 19 */
        const double expected = blows ? 0.184 : 0.0;
        for (int k = 0; k < GAS_BRICK_CELLS * GAS_CARRIED; k += GAS_CARRIED) {
            assert_true(fabs((double)first[k] - expected) < 1e-5 && first[k + 1] == 0.0f);
            assert_true(fabs((double)second[k] - expected) < 1e-5 && second[k + 2] == 0.0f);
        }
        simulation_end_text(&run, scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoke_is_kept),
        cmocka_unit_test(fire_follows_its_equations),
        cmocka_unit_test(smoke_decays),
        cmocka_unit_test(smoke_keeps_its_colour),
        cmocka_unit_test(gas_remembers_where_it_came_from),
    };
    return cmocka_run_group_tests_name("gas_matter", tests, NULL, NULL);
}
