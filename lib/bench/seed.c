/* Runs the suite `seed` of `kiln bench`, which measures kiln's first techniques, with every stage
 * in GL, against the techniques that `auto` takes now. Both draw the same pictures. */
#include <stdlib.h>

#include "base/error.h"
#include "bench/suite.h"

/* The pixels that a metre covers in the middle of the cloud, in a picture 720 pixels high. */
#define PIXELS_PER_METRE 123.6

static const struct kiln_lane LANES[] = {
    {.name = "seed",
     .techniques =
         "simulate=inplace sort=bitonic backdrop=gl raster=geometry bloom=gl composite=gl"},
    {.name = "auto", .techniques = ""},
};
enum { LANE_COUNT = sizeof LANES / sizeof *LANES };

static const struct {
    double particles, pixels;
} SIZES[] = {{160000, 16}, {1600, 120}, {1000000, 4}};

static bool add_delivery(const struct kiln_bench_run *run, const struct kiln_delivery *deliveries,
                         double particles, struct kiln_error *error)
{
    for (size_t i = 0; i < LANE_COUNT; i++) {
        if (deliveries[i].problem)
            continue;
        struct kiln_bench_row row = {
            .x = particles,
            .measure = "frame to PNG",
            .technique = LANES[i].name,
            .spread = kiln_spread_of(deliveries[i].ms, deliveries[i].count),
        };
        if (i > 0 && !deliveries[0].problem)
            row.faster =
                kiln_spread_of_ratios(deliveries[0].ms, deliveries[i].ms, deliveries[i].count);
        if (!kiln_bench_add_row(run->bench, &row, error))
            return false;
    }
    return true;
}

/* Compares the times of frames until their files are complete, and then the times of passes. */
static bool compare_scene(const struct kiln_bench_run *run, const struct kiln_settings *settings,
                          double particles, struct kiln_error *error)
{
    struct kiln_delivery *deliveries = calloc(LANE_COUNT, sizeof *deliveries);
    struct kiln_scene *scene = kiln_bench_load_scene(run, "bench/cloud.yaml", settings, error);
    bool ok =
        deliveries && scene &&
        kiln_delivery_run(run, scene, "frame_%04d.png", LANES, LANE_COUNT, deliveries, error) &&
        add_delivery(run, deliveries, particles, error);
    if (!deliveries)
        kiln_error_no_memory(error, "measurements");
    free(deliveries);
    kiln_scene_destroy(&scene);
    const struct kiln_comparison comparison = {
        .scene = "bench/cloud.yaml",
        .settings = settings,
        .lanes = LANES,
        .lane_count = LANE_COUNT,
        .measures = KILN_MEASURE(particles) | KILN_MEASURE(sort) | KILN_MEASURE(simulate) |
                    KILN_MEASURE(bloom) | KILN_MEASURE(composite) | KILN_MEASURE_WHOLE,
        .x = particles};
    return ok && kiln_compare_lanes(run, &comparison, error);
}

bool kiln_suite_seed(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "seed",
        .title = "The first techniques against auto: half fire, half smoke, sorted, soft, bloom, "
                 "six boxes, 1280x720",
        .sweep = "particles",
        .unit = "ms",
        .reference = LANES[0].name,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 1 : sizeof SIZES / sizeof *SIZES;
    for (size_t i = 0; i < count; i++) {
        double particles = SIZES[i].particles / (run->params->quick ? 100 : 1);
        struct kiln_settings settings = {.count = 0};
        kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
        kiln_set_number(run, &settings, "systems.*.look.size", SIZES[i].pixels / PIXELS_PER_METRE);
        kiln_set_picture(run, &settings, 1280, 720);
        kiln_bench_say(run, "%.0f particles of %.0f pixels", particles, SIZES[i].pixels);
        if (!compare_scene(run, &settings, particles, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "seed: %s. Sprites: 16 pixels of 160,000, 120 of 1,600, 4 of "
                               "1,000,000.",
                               LANES[0].techniques);
}
