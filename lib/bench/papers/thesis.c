/* Repeats the measurements of Heinz 2019, chapter 4, on this machine. The thesis does not give the
 * numbers behind its figures, so the notes of the tables give the statements of its text. */
#include <math.h>

#include "bench/papers/papers.h"

static const char SCENE[] = "fire_beam.yaml";

/* Sets a beam of as many particles as table 4.1 has in all, half of them fire and half smoke, with
 * four seconds of life each and one step a frame. Sprites shrink so that together they cover as
 * much as 1,600 of full size do. The table has the same factors: 1 for 1,600 particles, 0.1 for
 * 160,000. */
static void set_beam(const struct kiln_bench_run *run, struct kiln_settings *settings,
                     double particles)
{
    static const char *const texts[] = {"systems.sparks.enabled=false", "output.fps=60",
                                        "output.frames=1000",           "systems.*.emit.life=4 s",
                                        "simulation.warmup=4 s",        "post.bloom.kind=thesis"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        kiln_set(run, settings, texts[i]);
    kiln_set_number(run, settings, "systems.*.emit.rate", particles / 8.0);
    double scale = sqrt(1600.0 / particles);
    kiln_set_number(run, settings, "systems.*.look.scale.0", scale);
    kiln_set_number(run, settings, "systems.*.look.scale.1", scale);
}

/* Numbers of particles, up to the largest of table 4.1. */
static const double SIZES[] = {500, 1000, 2000, 4000, 8000, 16000, 40000, 80000, 160000};
enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES };

static size_t size_count(const struct kiln_bench_run *run)
{
    return run->params->quick ? 1 : SIZE_COUNT;
}

/* Compares the lanes with beams of all sizes, in a picture so small that drawing takes little
 * time. */
static bool compare_small_picture(const struct kiln_bench_run *run, const struct kiln_lane *lanes,
                                  size_t lane_count, uint32_t measures, struct kiln_error *error)
{
    for (size_t i = 0; i < size_count(run); i++) {
        struct kiln_settings settings = {.count = 0};
        set_beam(run, &settings, SIZES[i]);
        kiln_set_small_picture(run, &settings);
        const struct kiln_comparison comparison = {.scene = SCENE,
                                                   .settings = &settings,
                                                   .lanes = lanes,
                                                   .lane_count = lane_count,
                                                   .measures = measures,
                                                   .x = SIZES[i]};
        kiln_bench_say(run, "%.0f particles", SIZES[i]);
        if (!kiln_compare_lanes(run, &comparison, error))
            return false;
    }
    return true;
}

/* ---- Figure 4.4 ------------------------------------------------------------------------------ */

bool kiln_suite_figure_4_4(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_lane lanes[KILN_MAX_LANES];
    size_t count = kiln_lanes_of_stage(run, "simulate", lanes, error);
    if (count == 0)
        return false;
    const struct kiln_bench_part part = {
        .name = "figure4.4",
        .title = "Heinz 2019, figure 4.4: a step by technique, six boxes, without sorting",
        .sweep = "particles",
        .unit = "ms",
        .reference = lanes[0].name,
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error) ||
        !compare_small_picture(run, lanes, count, KILN_MEASURE(simulate), error))
        return false;
    return kiln_bench_add_note(
        run->bench, error,
        "Published (4.2, GTX 1070 and Ryzen 2600X): the CPU is the fastest technique below about "
        "4,000 particles. Of the other techniques, transform feedback is the slowest and may lose "
        "particles. One buffer in compute is a little faster than two.");
}

/* ---- Figure 4.5 ------------------------------------------------------------------------------ */

/* Parts of a frame, each drawn alone, and the whole frame; the camera is close to the beam. */
static const struct {
    const char *as;
    const char *without; /* settings that leave the other part out, or NULL */
    uint32_t measures;
} FRAME_PARTS[] = {
    {"render fire", "systems.smoke.enabled=false", KILN_MEASURE(particles)},
    {"render smoke", "systems.fire.enabled=false", KILN_MEASURE(particles)},
    {NULL, NULL, KILN_MEASURE(simulate) | KILN_MEASURE_WHOLE},
};

static bool compare_close_camera(const struct kiln_bench_run *run, double particles,
                                 const struct kiln_lane *lanes, size_t count,
                                 struct kiln_error *error)
{
    for (size_t k = 0; k < sizeof FRAME_PARTS / sizeof *FRAME_PARTS; k++) {
        struct kiln_settings settings = {.count = 0};
        set_beam(run, &settings, particles);
        kiln_set_picture(run, &settings, 1280, 720);
        kiln_set(run, &settings, "post.compose=separate");
        kiln_set(run, &settings, "camera.position=[3.4, 1.9, 2.2]");
        kiln_set(run, &settings, "camera.target=[2.4, 1.6, 0]");
        if (FRAME_PARTS[k].without)
            kiln_set(run, &settings, FRAME_PARTS[k].without);
        const struct kiln_comparison comparison = {.scene = SCENE,
                                                   .settings = &settings,
                                                   .lanes = lanes,
                                                   .lane_count = count,
                                                   .measures = FRAME_PARTS[k].measures,
                                                   .as = FRAME_PARTS[k].as,
                                                   .x = particles};
        if (!kiln_compare_lanes(run, &comparison, error))
            return false;
    }
    return true;
}

bool kiln_suite_figure_4_5(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_lane lanes[KILN_MAX_LANES];
    size_t count = kiln_lanes_of_stage(run, "raster", lanes, error);
    if (count == 0)
        return false;
    const struct kiln_bench_part part = {
        .name = "figure4.5",
        .title = "Heinz 2019, figure 4.5: parts of a frame, the camera near before the beam",
        .sweep = "particles",
        .unit = "ms",
        .reference = lanes[0].name,
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < size_count(run); i += 2) {
        kiln_bench_say(run, "%.0f particles", SIZES[i]);
        if (!compare_close_camera(run, SIZES[i], lanes, count, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "Published (4.2): smoke takes longer to render than fire, because "
                               "blending by alpha costs more than adding.");
}

/* ---- Figure 4.6 ------------------------------------------------------------------------------ */

bool kiln_suite_figure_4_6(const struct kiln_bench_run *run, struct kiln_error *error)
{
    struct kiln_lane lanes[KILN_MAX_LANES];
    size_t count = kiln_lanes_of_stage(run, "sort", lanes, error);
    if (count == 0)
        return false;
    if (count < KILN_MAX_LANES) /* the lanes above sort particles that `auto` simulates */
        lanes[count++] = (struct kiln_lane){.name = "sort=bitonic after simulate=feedback",
                                            .techniques = "simulate=feedback sort=bitonic"};
    if (count < KILN_MAX_LANES)
        lanes[count++] = (struct kiln_lane){.name = "sort=bitonic after simulate=inplace",
                                            .techniques = "simulate=inplace sort=bitonic"};
    const struct kiln_bench_part part = {
        .name = "figure4.6",
        .title = "Heinz 2019, figure 4.6: sorting by depth, keys and list included",
        .sweep = "particles",
        .unit = "ms",
        .reference = lanes[0].name,
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error) ||
        !compare_small_picture(run, lanes, count, KILN_MEASURE(sort), error))
        return false;
    return kiln_bench_add_note(run->bench, error,
                               "Published (4.2): sorting on the CPU is much more efficient than "
                               "bitonic sort on the GPU, which was not run on the largest systems. "
                               "It is a little faster where transform feedback is not used.");
}

/* ---- Table 4.1 ------------------------------------------------------------------------------- */

bool kiln_suite_sizes(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const struct {
        double rate, scale;
    } table[] = {{5, 2.2}, {25, 1.7}, {200, 1}, {20000, 0.1}};
    static const struct kiln_lane automatic = {.name = "auto", .techniques = ""};
    const struct kiln_bench_part part = {
        .name = "sizes",
        .title = "The sizes of Heinz 2019, table 4.1: a frame, pass by pass",
        .sweep = "particles",
        .unit = "ms",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 1 : sizeof table / sizeof *table;
    for (size_t i = 0; i < count; i++) {
        struct kiln_settings settings = {.count = 0};
        double particles = 8 * table[i].rate;
        set_beam(run, &settings, particles);
        kiln_set_number(run, &settings, "systems.*.look.scale.0", table[i].scale);
        kiln_set_number(run, &settings, "systems.*.look.scale.1", table[i].scale);
        kiln_set_picture(run, &settings, 1280, 720);
        const struct kiln_comparison comparison = {.scene = SCENE,
                                                   .settings = &settings,
                                                   .lanes = &automatic,
                                                   .lane_count = 1,
                                                   .measures = UINT32_MAX,
                                                   .x = particles};
        kiln_bench_say(run, "%.0f particles", particles);
        if (!kiln_compare_lanes(run, &comparison, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "The camera moves, so the backdrop is drawn anew in each frame.");
}
