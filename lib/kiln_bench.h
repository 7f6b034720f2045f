/* Declares benchmarks. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_BENCH_H
#define KILN_BENCH_H

#include "kiln_program.h"

/* A benchmark renders the same frames in several ways in turn, A, B, A, B..., and takes ratios of
 * neighbouring turns: whatever slows the machine down for a while slows all of the ways down. A
 * suite is a list of such comparisons. A scene can be measured, too, with each technique of a stage
 * in turn. Each pass of a frame is one row of the result, with its median and quartiles. */
struct kiln_bench_suite {
    const char *name, *help;
    double minutes; /* approximate time of a run on two cores without a GPU */
};

/* Visits the suites. */
void kiln_visit_benches(void (*visit)(void *user, const struct kiln_bench_suite *suite),
                        void *user);

enum {
    KILN_BENCH_MIN_REPETITIONS = 3,
    KILN_BENCH_MAX_REPETITIONS = 101,
    KILN_BENCH_MAX_PARTS = 1000
};

struct kiln_bench_params {
    const char *const *suites; /* names of suites; with no suite and no scene, every suite runs */
    size_t suite_count;
    const char *const *scenes; /* files */
    size_t scene_count;
    struct kiln_scene_params scene; /* how the scenes are read */
    int64_t frame;                  /* first frame of a scene that is drawn; -1: the middle one */
    const char *const *stages; /* stages whose techniques are compared for a scene; none: all */
    size_t stage_count;
    const char *against; /* another program of kiln, with which this one is compared on the scenes;
                            NULL: none */
    uint32_t parts;      /* parts of the clip that the suite `jobs` renders; 0: the clip's own */
    uint32_t cells; /* along an edge of the boxes of the suite `gas`, in multiples of 16; 0: 64, and
                       then 128 */
    const char *device;            /* as kiln_device_params.wanted */
    const char *const *techniques; /* "stage=name", where a suite does not set another technique */
    size_t technique_count;
    uint32_t threads;     /* 0 takes one a core */
    uint32_t repetitions; /* the most turns of a comparison, within the limits above */
    double seconds;       /* a comparison ends after this time and the least number of turns */
    bool quick;           /* make few and small comparisons, to see whether all of them run */
    const char *scratch;  /* a folder for pictures that are written and removed */
    /* Gets a line before each comparison; may be NULL. */
    void (*progress)(void *user, const char *line);
    bool (*stop)(void *user); /* called between frames; true ends with KILN_INTERRUPTED */
    void *user;
    struct kiln_log log;
};
static inline struct kiln_bench_params kiln_bench_defaults(void)
{
    return (struct kiln_bench_params){
        .frame = -1, .repetitions = 9, .seconds = 4, .scratch = "/tmp"};
}

struct kiln_bench;

/* Returns whether a suite is asked for by its name. The suites `jobs`, which takes one scene, and
 * `threads` measure the scenes of the caller, which are then not measured by themselves. */
bool kiln_bench_names(const struct kiln_bench_params *params, const char *suite);

/* Runs benchmarks and returns the measurements, which the caller destroys. A comparison that cannot
 * run on the device is a line of the result and no error; so is a scene that one of two programs
 * cannot render. Returns NULL with KILN_USAGE (an unknown suite or stage, repetitions out of range,
 * `against` is not a program of kiln), the errors of loading scenes and of rendering, or
 * KILN_INTERRUPTED. */
struct kiln_bench *kiln_bench_run(const struct kiln_bench_params *params, struct kiln_error *error);
void kiln_bench_destroy(struct kiln_bench **bench);

/* Returns the number of measured values: 0 where no requested comparison runs on the device. */
size_t kiln_bench_measured(const struct kiln_bench *bench);

/* Formats of tables. Text, JSON and CSV have one row a measurement, for people, programs and
 * spreadsheets. Markdown has medians side by side, for documents. */
enum kiln_bench_format { KILN_BENCH_TEXT, KILN_BENCH_JSON, KILN_BENCH_CSV, KILN_BENCH_MARKDOWN };

/* Writes the tables to a stream. KILN_IO when that fails. */
bool kiln_bench_write(const struct kiln_bench *bench, enum kiln_bench_format format, FILE *out,
                      struct kiln_error *error);

/* Makes a folder for kiln_bench_save, and writes and removes a file there, so that a wrong name is
 * found before the long measurements. KILN_IO when the folder cannot be written. */
bool kiln_bench_prepare(const char *folder, struct kiln_error *error);

/* Writes bench.txt, bench.json, bench.csv and bench.md into a folder, which is made, and for each
 * comparison with a curve NAME.dat, NAME.gp and, by gnuplot, NAME.svg. Each file replaces an older
 * one when it is whole. `unplotted` gets the reason why curves were not drawn, or "". KILN_IO when
 * a file cannot be written. */
bool kiln_bench_save(const struct kiln_bench *bench, const char *folder,
                     char unplotted[KILN_MESSAGE_SIZE], struct kiln_error *error);

#endif
