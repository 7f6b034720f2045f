/* Declares benchmarks. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_BENCH_H
#define KILN_BENCH_H

#include "kiln_program.h"

/* A benchmark renders the same frames in several ways in turn, A, B, A, B..., so that whatever
 * slows the machine down for a while slows all of them down, and takes ratios of neighbours. A
 * suite is a list of such comparisons; a scene can be compared with itself, a technique at a time.
 * Each pass of a frame is one row of the result, with its median and quartiles. */
struct kiln_bench_suite {
    const char *name, *help;
    double minutes; /* about, on two cores without a GPU */
};
void kiln_visit_benches(void (*visit)(void *user, const struct kiln_bench_suite *suite),
                        void *user);

enum {
    KILN_BENCH_MIN_REPETITIONS = 3,
    KILN_BENCH_MAX_REPETITIONS = 101,
    KILN_BENCH_MAX_PARTS = 1000
};

struct kiln_bench_params {
    const char *const *suites; /* by their names; none of them and no scenes: every suite */
    size_t suite_count;
    const char *const *scenes; /* files */
    size_t scene_count;
    struct kiln_scene_params scene; /* how these are read */
    int64_t frame;                  /* of these, the first that is drawn; -1: the middle one */
    const char *const *stages;      /* of these, whose techniques are compared; none: all */
    size_t stage_count;
    uint32_t parts;     /* of the clip that the suite `jobs` renders; 0: as many as it has itself */
    const char *device; /* as in kiln_device_params */
    const char *const *techniques; /* "stage=name", where a suite does not say another one */
    size_t technique_count;
    uint32_t threads;     /* 0 takes one a core */
    uint32_t repetitions; /* at most so many turns, within the limits above */
    double seconds;       /* a comparison ends after this time, but has the least number of turns */
    bool quick;           /* few and small comparisons, to see that all of it runs */
    const char *scratch;  /* a folder for pictures that are written and removed */
    void (*progress)(void *user, const char *line); /* told before each comparison; may be NULL */
    bool (*stop)(void *user); /* asked between frames; true ends with KILN_INTERRUPTED */
    void *user;
    struct kiln_log log;
};
static inline struct kiln_bench_params kiln_bench_defaults(void)
{
    return (struct kiln_bench_params){
        .frame = -1, .repetitions = 9, .seconds = 4, .scratch = "/tmp"};
}

struct kiln_bench;

/* Whether a suite is asked for that renders a scene of the caller, `jobs`: where a scene is given,
 * it is not measured by itself then. */
bool kiln_bench_renders_scene(const struct kiln_bench_params *params);

/* Measures, and returns what came out, which the caller destroys. What cannot run on the device is
 * a line of the result and no error. NULL with KILN_USAGE (a suite or stage of another name,
 * repetitions out of range), the errors of loading scenes and of rendering, KILN_INTERRUPTED. */
struct kiln_bench *kiln_bench_run(const struct kiln_bench_params *params, struct kiln_error *error);
void kiln_bench_destroy(struct kiln_bench **bench);

/* How many values were measured: 0 where nothing that was asked for runs on the device. */
size_t kiln_bench_measured(const struct kiln_bench *bench);

/* A row a measurement, for people, programs and sheets; or medians side by side, for documents. */
enum kiln_bench_format { KILN_BENCH_TEXT, KILN_BENCH_JSON, KILN_BENCH_CSV, KILN_BENCH_MARKDOWN };

/* Writes the tables. KILN_IO. */
bool kiln_bench_write(const struct kiln_bench *bench, enum kiln_bench_format format, FILE *out,
                      struct kiln_error *error);

/* Makes a folder for kiln_bench_save, and puts a file there and removes it, so that what took long
 * to measure is not lost to a wrong name. KILN_IO. */
bool kiln_bench_prepare(const char *folder, struct kiln_error *error);

/* Writes bench.txt, .json, .csv and .md into a folder, which is made, and for each comparison that
 * has a curve NAME.dat, NAME.gp and, by gnuplot, NAME.svg. Each replaces an older one when it is
 * whole. *unplotted gets why there are no curves, "" if there are. KILN_IO. */
bool kiln_bench_save(const struct kiln_bench *bench, const char *folder,
                     char unplotted[KILN_MESSAGE_SIZE], struct kiln_error *error);

#endif
