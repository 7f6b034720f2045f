/* Runs the suite `balls` of `kiln bench`, which measures the simulation of balls that collide with
 * a floor and with each other: exactly or staggered, with spin or without. Balls that do not
 * collide with each other are measured for comparison. */
#include <stdio.h>

#include "bench/suite.h"

static const struct {
    const char *name, *interact;
} ROWS[] = {
    {"no collisions", "[]"},
    {"exact", "[collide: {radius: 1.5 cm}]"},
    {"exact, with spin", "[collide: {radius: 1.5 cm, spin: true}]"},
    {"staggered", "[collide: {radius: 1.5 cm, mode: staggered}]"},
    {"staggered, with spin", "[collide: {radius: 1.5 cm, mode: staggered, spin: true}]"},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

bool kiln_suite_balls(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const struct kiln_lane lane = {.name = "simulate=cpu", .techniques = "simulate=cpu"};
    const struct kiln_bench_part part = {
        .name = "balls",
        .title = "Simulation of balls that bounce off each other and off a floor",
        .sweep = "balls",
        .unit = "ms",
    };
    const double balls = run->params->quick ? 4000 : 100000;
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        struct kiln_settings settings = {.count = 0};
        char interact[160];
        snprintf(interact, sizeof interact, "systems.*.interact=%s", ROWS[i].interact);
        kiln_set_number(run, &settings, "systems.*.emit.rate", balls / 2);
        kiln_set(run, &settings, "systems.*.forces=[gravity: [0, -4, 0]]");
        kiln_set(run, &settings, "systems.*.collide={restitution: 0.6, friction: 0.3}");
        kiln_set(run, &settings, "backdrop.floor.collide=true");
        kiln_set(run, &settings, interact);
        kiln_set_small_picture(run, &settings);
        const struct kiln_comparison comparison = {.scene = "bench/cloud.yaml",
                                                   .settings = &settings,
                                                   .lanes = &lane,
                                                   .lane_count = 1,
                                                   .measures = KILN_MEASURE(simulate),
                                                   .as = ROWS[i].name,
                                                   .x = balls};
        kiln_bench_say(run, "%s", ROWS[i].name);
        if (!kiln_compare_lanes(run, &comparison, error))
            return false;
    }
    return kiln_bench_add_note(
        run->bench, error, "After the row without collisions is subtracted, 1 ms is 10 ns a ball.");
}
