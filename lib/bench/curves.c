/* How cost grows: with particles, with the pixels that they cover, and with the work group
 * (Anderdahl and Darner 2014, by Heinz 2019, 2.2.5). */
#include "bench/suite.h"

#define PIXELS_PER_METRE 123.6 /* of bench/cloud.yaml */

static const char SCENE[] = "bench/cloud.yaml";
static const struct kiln_lane AUTOMATIC = {.name = "auto", .techniques = ""};

static bool curve(const struct kiln_bench_run *run, double particles, double pixels, double x,
                  struct kiln_error *error)
{
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
    kiln_set_number(run, &settings, "systems.*.look.size", pixels / PIXELS_PER_METRE);
    kiln_set_picture(run, &settings, 1280, 720);
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = &AUTOMATIC,
                                               .lane_count = 1,
                                               .measures =
                                                   KILN_MEASURE(simulate) | KILN_MEASURE(sort) |
                                                   KILN_MEASURE(particles) | KILN_MEASURE_WHOLE,
                                               .x = x};
    kiln_bench_say(run, "%.0f particles of %.0f pixels", particles, pixels);
    return kiln_compare_lanes(run, &comparison, error);
}

static bool over_particles(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double counts[] = {1000, 4000, 16000, 64000, 250000, 1000000, 2000000, 4000000};
    const struct kiln_bench_part part = {
        .name = "particles",
        .title = "Growth with particles of 4 pixels",
        .sweep = "particles",
        .unit = "ms",
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 2 : sizeof counts / sizeof *counts;
    for (size_t i = 0; i < count; i++) {
        if (!curve(run, counts[i], 4, counts[i], error))
            return false;
    }
    return kiln_bench_note_growth(run, error);
}

static bool over_pixels(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double pixels[] = {4, 8, 16, 32, 64, 128, 256};
    const struct kiln_bench_part part = {
        .name = "pixels",
        .title = "Growth with the area of 2,000 particles, of 4 to 256 pixels",
        .sweep = "square pixels",
        .unit = "ms",
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 2 : sizeof pixels / sizeof *pixels;
    for (size_t i = 0; i < count; i++) {
        if (!curve(run, 2000, pixels[i], pixels[i] * pixels[i], error))
            return false;
    }
    return kiln_bench_note_growth(run, error);
}

bool kiln_suite_curves(const struct kiln_bench_run *run, struct kiln_error *error)
{
    return over_particles(run, error) && over_pixels(run, error);
}

/* ---- Work groups ----------------------------------------------------------------------------- */

/* Techniques whose kernels take another size of the work group. */
static const struct {
    const char *technique;
    uint32_t measures;
} KERNELS[] = {
    {"simulate=inplace", KILN_MEASURE(simulate)},
    {"simulate=pingpong", KILN_MEASURE(simulate)},
    {"sort=radix", KILN_MEASURE(sort)},
};

/* One technique by the size of its work groups, in turn. */
static bool sweep_kernel(const struct kiln_bench_run *run, size_t kernel, double particles,
                         struct kiln_error *error)
{
    static const uint32_t sizes[] = {8, 16, 32, 64, 128, 256, 512, 1024};
    enum { SIZES = sizeof sizes / sizeof *sizes };
    struct kiln_lane lanes[SIZES];
    size_t count = run->params->quick ? 2 : SIZES;
    for (size_t i = 0; i < count; i++)
        lanes[i] = (struct kiln_lane){.name = KERNELS[kernel].technique,
                                      .techniques = KERNELS[kernel].technique,
                                      .work_group_size = sizes[i],
                                      .x = sizes[i]};
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
    kiln_set_unseen(run, &settings);
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = lanes,
                                               .lane_count = count,
                                               .measures = KERNELS[kernel].measures};
    kiln_bench_say(run, "%s", KERNELS[kernel].technique);
    return kiln_compare_lanes(run, &comparison, error);
}

bool kiln_suite_groups(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "groups",
        .title = "Kernels over 250,000 particles by the invocations of a work group",
        .sweep = "invocations",
        .unit = "ms",
        .reference = "groups of 8",
        .plotted = true,
    };
    double particles = run->params->quick ? 2500 : 250000;
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < (run->params->quick ? 1 : sizeof KERNELS / sizeof *KERNELS); i++) {
        if (!sweep_kernel(run, i, particles, error))
            return false;
    }
    return kiln_bench_add_note(
        run->bench, error,
        "kiln takes groups of 64 to simulate. The radix sort cuts the same tile among more "
        "invocations, with fewer digits where their counters would not fit.");
}
