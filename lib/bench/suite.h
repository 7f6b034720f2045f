/* Declares the suites of benchmarks and what they share: settings of a scene, the lanes of a stage,
 * comparisons of lanes, and rows of the part that a suite has begun. */
#ifndef KILN_BENCH_SUITE_H
#define KILN_BENCH_SUITE_H

#include "bench/contest.h"
#include "kiln_program.h"

/* A suite: a row of the table in bench.c. */
struct kiln_suite_row {
    struct kiln_bench_suite info;
    bool (*run)(const struct kiln_bench_run *run, struct kiln_error *error);
};

/* bench/papers/papers.h declares the suites of the papers. */
bool kiln_suite_seed(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_curves(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_groups(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_forces(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_colliders(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_balls(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_flock(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_gravity(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_paint(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_states(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_gas(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_jobs(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_threads(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_output(const struct kiln_bench_run *run, struct kiln_error *error);

/* Adds the part of the suite `gravity` that measures how well bodies keep their energy. */
bool kiln_bench_drift(const struct kiln_bench_run *run, struct kiln_error *error);

/* Measures a scene of the caller: whole frames, then the techniques of each stage. */
bool kiln_bench_scene(const struct kiln_bench_run *run, const char *path, struct kiln_error *error);

/* Compares this program with the caller's other one on each of the caller's scenes. KILN_USAGE when
 * the other program is not a kiln. */
bool kiln_bench_against(const struct kiln_bench_run *run, struct kiln_error *error);

/* Overrides of a scene. */
enum { KILN_MAX_SETTINGS = 32 };
struct kiln_settings {
    const char *items[KILN_MAX_SETTINGS];
    size_t count;
    const char *asset_root; /* absolute path of the files that overrides name; NULL: none */
};

/* Add the override "key=value"; its text lives as long as the run. A setting for which there is no
 * room or no memory makes kiln_bench_load_scene fail. */
void kiln_set(const struct kiln_bench_run *run, struct kiln_settings *settings, const char *text);
void kiln_set_number(const struct kiln_bench_run *run, struct kiln_settings *settings,
                     const char *key, double value);

/* Sets the size of the picture, which is smaller in a quick run. */
void kiln_set_picture(const struct kiln_bench_run *run, struct kiln_settings *settings,
                      uint32_t width, uint32_t height);

/* Sets a small picture without bloom and lights, so that a frame takes little more time than
 * simulation and sort. */
void kiln_set_small_picture(const struct kiln_bench_run *run, struct kiln_settings *settings);

/* Loads one of the scenes in the library, such as "fire_beam.yaml". */
struct kiln_scene *kiln_bench_load_scene(const struct kiln_bench_run *run, const char *name,
                                         const struct kiln_settings *settings,
                                         struct kiln_error *error);

/* Loads a scene of the caller with enough frames for all turns from *frame on, which becomes the
 * caller's frame or the middle one. Added frames do not change the frames before them. */
struct kiln_scene *kiln_bench_load_caller_scene(const struct kiln_bench_run *run, const char *path,
                                                const struct kiln_scene_params *wanted,
                                                uint32_t *frame, struct kiln_error *error);

/* Makes a lane of each technique of a stage, first the one that `auto` takes. The names of the
 * lanes live as long as the run. Returns the number of lanes; 0 with an error. */
size_t kiln_lanes_of_stage(const struct kiln_bench_run *run, const char *stage,
                           struct kiln_lane lanes[KILN_MAX_LANES], struct kiln_error *error);

/* Bits of kiln_comparison.measures: a pass, or the whole frame. */
#define KILN_MEASURE(pass) (1u << KILN_PASS_##pass)
#define KILN_MEASURE_WHOLE (1u << KILN_MEASURE_FRAME)

struct kiln_comparison {
    const char *scene; /* as in kiln_bench_load_scene */
    const struct kiln_settings *settings;
    const struct kiln_lane *lanes; /* the others are compared with the first */
    size_t lane_count;
    uint32_t measures; /* bits of KILN_MEASURE and KILN_MEASURE_WHOLE */
    const char *as;    /* the measure's name in the table; NULL: that of the pass */
    double x;
    bool rates; /* rows give frames a second instead of milliseconds */
};

/* Measures a step of the library's cloud with this number of particles, simulated on the processor,
 * and adds a row that is called `as`. Adds overrides to the settings. */
bool kiln_compare_cloud(const struct kiln_bench_run *run, struct kiln_settings *settings,
                        double particles, const char *as, double x, struct kiln_error *error);

/* Runs the comparison, and adds a row for each measure and lane. */
bool kiln_compare_lanes(const struct kiln_bench_run *run, const struct kiln_comparison *comparison,
                        struct kiln_error *error);

/* Adds a row for each measure and lane of a comparison from samples that were taken before;
 * samples[0] belongs to the first lane. */
bool kiln_bench_add_samples(const struct kiln_bench_run *run,
                            const struct kiln_comparison *comparison,
                            const struct kiln_samples *samples, struct kiln_error *error);

/* Starts a part of the current suite. */
bool kiln_bench_begin(const struct kiln_bench_run *run, const struct kiln_bench_part *part,
                      struct kiln_error *error);

/* Adds a row with a published value, to be compared with the measured ones. */
bool kiln_bench_publish(const struct kiln_bench_run *run, double x, const char *measure,
                        const char *technique, double value, const char *source,
                        struct kiln_error *error);

/* Notes how each measure grows with x in the last part, such as "sort by the power 1.02". */
bool kiln_bench_note_growth(const struct kiln_bench_run *run, struct kiln_error *error);

/* Tells the caller's progress callback what the suite does next. */
void kiln_bench_say(const struct kiln_bench_run *run, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
