/* Measures how well bodies that attract each other keep their energy in long runs. The integrator
 * is leapfrog, which kicks, then drifts; its velocities are half a step behind the positions. So
 * the energy is computed from velocities that are moved on by half a step. */
#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "bench/suite.h"
#include "scene/pool_layout.h"
#include "shared/random.h"
#include "sim/step/simulate.h"

enum {
    STOPS = 3,
    SAMPLES_PER_STOP = 30 /* computations of the energy from one stop to the next */
};

struct energy_run {
    const char *name;
    uint32_t bodies;
    double strength, softening; /* strength in m/s^2 at 1 m; softening in m */
    uint32_t stops[STOPS];      /* steps, ascending; each stop gives a row */
    /* set while the measurement lasts: */
    const struct kiln_bench_run *run;
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_simulate *simulate;
    struct kiln_pool pool;
};

static const struct kiln_particle *records_of(struct energy_run *energy_run,
                                              struct kiln_error *error)
{
    return kiln_buffer_host(&energy_run->pool.records, KILN_READ, error);
}

/* Adds the accelerations of a body by all others to `pull`, and returns half of the potential
 * energy of its pairs. */
static double add_pairs(const struct energy_run *energy_run, const struct kiln_particle *records,
                        uint32_t self, double pull[3])
{
    const float3 at = particle_position(records[self]);
    double potential = 0.0;
    for (uint32_t k = 0; k < energy_run->bodies; k++) {
        const float3 other = particle_position(records[k]);
        const double x = (double)(other.x - at.x), y = (double)(other.y - at.y),
                     z = (double)(other.z - at.z);
        if (k == self)
            continue;
        const double inverse =
            1.0 / sqrt(x * x + y * y + z * z + energy_run->softening * energy_run->softening);
        const double strength = energy_run->strength * inverse;
        potential -= 0.5 * strength;
        pull[0] += x * strength * inverse * inverse;
        pull[1] += y * strength * inverse * inverse;
        pull[2] += z * strength * inverse * inverse;
    }
    return potential;
}

/* Returns the energy of all bodies, each of unit mass. */
static double energy_of(const struct energy_run *energy_run, const struct kiln_particle *records)
{
    const double half_step_s = 0.5 / 60.0;
    double sum = 0.0;
    for (uint32_t i = 0; i < energy_run->bodies; i++) {
        double pull[3] = {0};
        sum += add_pairs(energy_run, records, i, pull);
        const float3 v = particle_velocity(records[i]);
        const double x = (double)v.x + half_step_s * pull[0];
        const double y = (double)v.y + half_step_s * pull[1];
        const double z = (double)v.z + half_step_s * pull[2];
        sum += 0.5 * (x * x + y * y + z * z);
    }
    return sum;
}

/* Places two bodies a metre apart, a tenth too slow for circular orbits, or more bodies in a ball
 * whose motion and gravity are in balance. */
static void place(const struct energy_run *energy_run, struct kiln_particle *records)
{
    for (uint32_t i = 0; i < energy_run->bodies; i++) {
        float3 p = random_in_ball(random_stream(7, i), 0, false);
        float3 v = random_in_ball(random_stream(8, i), 0, false);
        if (energy_run->bodies == 2) {
            const float side = i == 0 ? -1.0f : 1.0f;
            p = FLOAT3(0.5f * side, 0.0f, 0.0f);
            v = FLOAT3(0.0f, 0.0f, 0.636f * side);
        }
        records[i].position_serial =
            UINT4(FLOAT_BITS(p.x), FLOAT_BITS(p.y), FLOAT_BITS(p.z), records[i].position_serial.w);
        records[i].velocity_birth =
            UINT4(FLOAT_BITS(v.x), FLOAT_BITS(v.y), FLOAT_BITS(v.z), records[i].velocity_birth.w);
    }
}

static bool set_up(struct energy_run *energy_run, struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    char text[128];
    snprintf(text, sizeof text, "systems.stars.emit.bursts={0 s: %u}", energy_run->bodies);
    kiln_set(energy_run->run, &settings, text);
    snprintf(text, sizeof text, "systems.stars.interact=[gravity: {strength: %g, softening: %g}]",
             energy_run->strength, energy_run->softening);
    kiln_set(energy_run->run, &settings, text);
    kiln_set(energy_run->run, &settings, "simulation.rate=60");
    energy_run->scene =
        kiln_bench_load_scene(energy_run->run, "bench/stars.yaml", &settings, error);
    energy_run->threads =
        kiln_threads_create(energy_run->bodies == 2 ? 1 : energy_run->run->params->threads);
    if (!energy_run->scene)
        return false;
    if (!energy_run->threads)
        return kiln_error_no_memory(error, "measurements");
    energy_run->simulate = kiln_simulate_create(NULL, energy_run->scene, KILN_SIMULATE_CPU,
                                                KILN_GAS_CPU, energy_run->threads, error);
    if (!energy_run->simulate)
        return false;
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(energy_run->scene);
    if (!kiln_pool_init(&energy_run->pool, NULL, &layout, error) ||
        !kiln_simulate_step(energy_run->simulate, &energy_run->pool, 1, error))
        return false;
    struct kiln_particle *records =
        kiln_buffer_host(&energy_run->pool.records, KILN_READ_WRITE, error);
    if (records)
        place(energy_run, records);
    return records != NULL;
}

static void tear_down(struct energy_run *energy_run)
{
    if (energy_run->simulate)
        kiln_pool_finish(&energy_run->pool);
    kiln_simulate_destroy(&energy_run->simulate);
    kiln_threads_destroy(&energy_run->threads);
    kiln_scene_destroy(&energy_run->scene);
}

/* Adds a row for each stop: the largest error of the energy since the stop before, in millionths of
 * the energy at the start. */
static bool measure_stops(struct energy_run *energy_run, struct kiln_error *error)
{
    const struct kiln_bench_params *params = energy_run->run->params;
    const struct kiln_particle *records = records_of(energy_run, error);
    if (!records)
        return false;
    const double before = energy_of(energy_run, records);
    uint32_t step = 0;
    for (int stop = 0; stop < (params->quick ? 1 : STOPS); stop++) {
        double worst = 0.0;
        const uint32_t stride = energy_run->stops[stop] / SAMPLES_PER_STOP;
        while (step < energy_run->stops[stop]) {
            step++;
            if (!kiln_simulate_step(energy_run->simulate, &energy_run->pool, 1 + step, error))
                return false;
            if (step % stride != 0 && step != energy_run->stops[stop])
                continue;
            if (params->stop && params->stop(params->user))
                return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
            records = records_of(energy_run, error);
            if (!records)
                return false;
            worst = fmax(worst, 1e6 * fabs(energy_of(energy_run, records) / before - 1.0));
        }
        const struct kiln_bench_row row = {.x = energy_run->stops[stop],
                                           .measure = "energy",
                                           .technique = energy_run->name,
                                           .spread = kiln_spread_of(&worst, 1)};
        if (!kiln_bench_add_row(energy_run->run->bench, &row, error))
            return false;
    }
    return true;
}

bool kiln_bench_drift(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const struct energy_run energy_runs[] = {
        {.name = "2 bodies",
         .bodies = 2,
         .strength = 1.0,
         .softening = 0.001,
         .stops = {2050, 20500, 205000}},
        {.name = "1,000 bodies",
         .bodies = 1000,
         .strength = 0.001,
         .softening = 0.05,
         .stops = {300, 3000, 10000}},
    };
    const struct kiln_bench_part part = {
        .name = "gravity_drift",
        .title = "Largest change of the bodies' energy since the row before, in millionths",
        .sweep = "steps",
        .unit = "ppm",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < sizeof energy_runs / sizeof *energy_runs; i++) {
        struct energy_run energy_run = energy_runs[i];
        energy_run.run = run;
        kiln_bench_say(run, "energy of %s", energy_run.name);
        const bool ok = set_up(&energy_run, error) && measure_stops(&energy_run, error);
        tear_down(&energy_run);
        if (!ok)
            return false;
    }
    return kiln_bench_add_note(
        run->bench, error,
        "The two bodies orbit each other in 205 steps: 10, 100 and 1,000 times. A step is 1/60 s.");
}
