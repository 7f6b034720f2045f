/* Runs the suites `curves` and `groups` of `kiln bench`, which measure how cost grows with the
 * number of particles, with the pixels that they cover, and with the size of the work group
 * (Anderdahl and Darner 2014, by Heinz 2019, 2.2.5). */
#include "bench/suite.h"

#define PIXELS_PER_METRE 123.6 /* in a picture of bench/cloud.yaml that is 720 pixels high */

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

/* The sizes of work groups that are tried on one kind of device, a GPU or a software device. */
struct sizes {
    uint32_t least, most;
};

/* A baked wind of 64^3 cells, which takes longer to write than the particles take to move. */
#define BAKED                                                                                      \
    "systems.*.forces=[wind: {baked: {box: {size: [10, 10, 10]}, cells: 64, of: [curl: {octaves: " \
    "3}]}}]"

/* Techniques whose kernels can run with work groups of several sizes, all powers of two. */
static const struct kernel {
    const char *name; /* NULL: the technique */
    const char *technique;
    uint32_t measures;
    struct sizes gpu, software;
    double particles;
    double pixels;      /* edge of a particle; 0: drawing is not measured */
    const char *forces; /* of each system; NULL: those of the scene */
} KERNELS[] = {
    {NULL, "simulate=inplace", KILN_MEASURE(simulate), {8, 1024}, {8, 1024}, 250000, 0, NULL},
    {NULL, "simulate=pingpong", KILN_MEASURE(simulate), {8, 1024}, {8, 1024}, 250000, 0, NULL},
    {"simulate=inplace, baked wind",
     "simulate=inplace",
     KILN_MEASURE(simulate),
     {8, 1024},
     {8, 1024},
     2000,
     0,
     BAKED},
    {NULL, "sort=radix", KILN_MEASURE(sort), {8, 1024}, {8, 1024}, 250000, 0, NULL},
    {NULL, "sort=bitonic", KILN_MEASURE(sort), {8, 512}, {8, 512}, 250000, 0, NULL},
    {NULL, "sort=oddeven", KILN_MEASURE(sort), {8, 512}, {8, 512}, 250000, 0, NULL},
    {NULL, "raster=tiled", KILN_MEASURE(particles), {16, 256}, {8, 64}, 50000, 16, NULL},
};

/* Makes lanes of one technique, the smallest work groups first. */
static size_t add_sizes(const struct kiln_bench_run *run, const struct kernel *kernel,
                        struct kiln_lane lanes[KILN_MAX_LANES])
{
    const struct sizes sizes = run->device->info.software ? kernel->software : kernel->gpu;
    const size_t most = run->params->quick ? 2 : KILN_MAX_LANES;
    size_t count = 0;
    for (uint32_t size = sizes.least; size <= sizes.most && count < most; size *= 2)
        lanes[count++] = (struct kiln_lane){.name = kernel->name ? kernel->name : kernel->technique,
                                            .techniques = kernel->technique,
                                            .work_group_size = size,
                                            .x = size};
    return count;
}

/* Measures one technique with each size of its work groups, in turn. */
static bool sweep_kernel(const struct kiln_bench_run *run, const struct kernel *kernel,
                         struct kiln_error *error)
{
    const double particles =
        run->params->quick && kernel->particles > 2500 ? 2500 : kernel->particles;
    struct kiln_lane lanes[KILN_MAX_LANES];
    size_t count = add_sizes(run, kernel, lanes);
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
    if (kernel->forces)
        kiln_set(run, &settings, kernel->forces);
    if (kernel->pixels > 0) {
        kiln_set_number(run, &settings, "systems.*.look.size", kernel->pixels / PIXELS_PER_METRE);
        kiln_set_picture(run, &settings, 1280, 720);
    } else {
        kiln_set_small_picture(run, &settings);
    }
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = lanes,
                                               .lane_count = count,
                                               .measures = kernel->measures};
    kiln_bench_say(run, "%s", lanes[0].name);
    return kiln_compare_lanes(run, &comparison, error);
}

bool kiln_suite_groups(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "groups",
        .title = "Kernels by the invocations of a work group",
        .sweep = "invocations",
        .unit = "ms",
        .reference = "the smallest groups",
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < sizeof KERNELS / sizeof *KERNELS; i++) {
        if (!sweep_kernel(run, &KERNELS[i], error))
            return false;
    }
    return kiln_bench_add_note(
               run->bench, error,
               "250,000 particles, 2,000 beside a baked wind of 64^3 cells. kiln takes groups of "
               "64 to "
               "simulate and to write the wind. The radix sort cuts the "
               "same tile among more "
               "invocations, with fewer digits where their counters would not fit.") &&
           kiln_bench_add_note(run->bench, error,
                               "Sorting networks take groups of 256. A group sorts eight times as "
                               "many pairs in shared memory, which has no room for more than 512. "
                               "Longer merges go through the buffer.") &&
           kiln_bench_add_note(
               run->bench, error,
               "raster=tiled, here of 50,000 sprites of 16 pixels, takes groups of %s. A tile is "
               "as large "
               "for any: a group of its edge draws it column by column, the largest has an "
               "invocation for each pixel.",
               run->device->info.software ? "16 for tiles of 8 x 8 pixels"
                                          : "256 for tiles of 16 x 16 pixels");
}
