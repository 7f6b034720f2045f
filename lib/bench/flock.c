/* Runs the suite `flock` of `kiln bench`, which measures whole frames of a flock by the number of
 * its birds, and by what a bird follows: the birds around it, averages of the flock, or both. */
#include <stdio.h>

#include "bench/suite.h"

#define KEEP_APART "separation: 14, space: 0.55 m, fastest: 12"

static const struct {
    const char *name, *rules;
} ROWS[] = {
    {"those around", KEEP_APART ", avoidance: 10, cohesion: 6, alignment: 3, view: 280 deg"},
    {"to keep apart, and averages",
     KEEP_APART ", cohesion: 0, alignment: 0, global: {cohesion: 1, alignment: 1}"},
    {"averages alone",
     "separation: 0, cohesion: 0, alignment: 0, global: {cohesion: 1, alignment: 1}"},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static bool run_row(const struct kiln_bench_run *run, double birds, size_t row,
                    struct kiln_error *error)
{
    static const struct kiln_lane lane = {.name = "auto", .techniques = ""};
    struct kiln_settings settings = {.count = 0};
    char text[256];
    snprintf(text, sizeof text, "systems.birds.emit.bursts={-2 s: %.0f}", birds);
    kiln_set(run, &settings, text);
    snprintf(text, sizeof text, "systems.birds.interact=[flock: {%s}]", ROWS[row].rules);
    kiln_set(run, &settings, text);
    kiln_set_picture(run, &settings, 1280, 720);
    const struct kiln_comparison comparison = {.scene = "bench/flock.yaml",
                                               .settings = &settings,
                                               .lanes = &lane,
                                               .lane_count = 1,
                                               .measures = KILN_MEASURE_WHOLE,
                                               .as = ROWS[row].name,
                                               .x = birds,
                                               .rates = true};
    kiln_bench_say(run, "%s, %.0f birds", ROWS[row].name, birds);
    return kiln_compare_lanes(run, &comparison, error);
}

bool kiln_suite_flock(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double sizes[] = {4096, 16384};
    const struct kiln_bench_part part = {
        .name = "flock",
        .title = "Flocks at 1280x720, by the particles that each looks at",
        .sweep = "birds",
        .unit = "fps",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    const size_t count = run->params->quick ? 1 : sizeof sizes / sizeof *sizes;
    for (size_t i = 0; i < count; i++) {
        for (size_t row = 0; row < ROW_COUNT; row++) {
            if (!run_row(run, sizes[i], row, error))
                return false;
        }
    }
    return kiln_bench_add_note(run->bench, error,
                               "All flocks start in the same place: a larger flock is denser, and "
                               "each particle sees more others.");
}
