/* Runs the suite `output` of `kiln bench`, which measures frames until their files are complete.
 * They are compared with the time that the stages alone would take: the larger of the slowest stage
 * and the CPU time of all cores divided by their number. */
#include <stdlib.h>

#include "base/error.h"
#include "bench/suite.h"

static const struct kiln_lane AUTOMATIC = {.name = "auto", .techniques = ""};

static bool add_row(const struct kiln_bench_run *run, double particles, const char *measure,
                    const char *technique, struct kiln_spread spread, struct kiln_error *error)
{
    const struct kiln_bench_row row = {
        .x = particles, .measure = measure, .technique = technique, .spread = spread};
    return kiln_bench_add_row(run->bench, &row, error);
}

static bool add_delivery(const struct kiln_bench_run *run, double particles, const char *name,
                         const struct kiln_delivery *d, struct kiln_error *error)
{
    double bounds[KILN_BENCH_MAX_REPETITIONS], cpu[KILN_BENCH_MAX_REPETITIONS];
    for (uint32_t i = 0; i < d->count; i++) {
        cpu[i] = d->cpu_ms[i] / run->bench->cores;
        bounds[i] = cpu[i] > d->slowest[i] ? cpu[i] : d->slowest[i];
    }
    struct kiln_spread ratio = kiln_spread_of_ratios(d->ms, bounds, d->count);
    return add_row(run, particles, "frame to the file", name, kiln_spread_of(d->ms, d->count),
                   error) &&
           add_row(run, particles, "slowest stage", name, kiln_spread_of(d->slowest, d->count),
                   error) &&
           add_row(run, particles, "CPU time / cores", name, kiln_spread_of(cpu, d->count),
                   error) &&
           kiln_bench_add_note(run->bench, error,
                               "%s of %.0f particles: %.2f times the larger of the two (%.2f to "
                               "%.2f).",
                               name, particles, ratio.median, ratio.first_quartile,
                               ratio.third_quartile);
}

static bool deliver(const struct kiln_bench_run *run, double particles, const char *name,
                    struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
    kiln_set_picture(run, &settings, 1280, 720);
    kiln_bench_say(run, "%s, %.0f particles", name, particles);
    struct kiln_delivery *delivery = calloc(1, sizeof *delivery);
    struct kiln_scene *scene = kiln_bench_load_scene(run, "bench/cloud.yaml", &settings, error);
    if (scene && !delivery)
        kiln_error_no_memory(error, "measurements");
    bool ok = scene && delivery &&
              kiln_delivery_run(run, scene, name, &AUTOMATIC, 1, delivery, error) &&
              (delivery->problem
                   ? kiln_bench_add_note(run->bench, error, "Not measured: %s.", delivery->problem)
                   : add_delivery(run, particles, name, delivery, error));
    free(delivery);
    kiln_scene_destroy(&scene);
    return ok;
}

bool kiln_suite_output(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const char *const names[] = {"frame_%04d.exr", "frame_%04d.png", "clip.mp4"};
    static const double counts[] = {1600, 160000};
    const struct kiln_bench_part part = {
        .name = "output",
        .title = "End to end at 1280x720: a frame until its file is whole",
        .sweep = "particles",
        .unit = "ms",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < (run->params->quick ? 1 : 2); i++) {
        for (size_t k = run->params->quick; k < sizeof names / sizeof *names; k++) {
            if (!deliver(run, counts[i], names[k], error))
                return false;
        }
    }
    return true;
}
