/* Compares lanes, which are ways to render the same frames. Lanes draw in turn: A, B, A, B... Each
 * lane has a job of its own, with its own particles. All lanes start from one state, and every turn
 * draws a frame of each. */
#ifndef KILN_BENCH_CONTEST_H
#define KILN_BENCH_CONTEST_H

#include "bench/result.h"
#include "frame/technique.h"
#include "kiln_program.h"
#include "scene/scene.h"

/* The state that the functions of one call of kiln_bench_run share. */
struct kiln_bench_run {
    const struct kiln_bench_params *params;
    struct kiln_device *device;
    struct kiln_bench *bench;
    const char *suite; /* name of the current suite */
};

/* A way to render, which is compared with others. */
struct kiln_lane {
    const char *name;       /* name in the table */
    const char *techniques; /* "sort=cpu raster=geometry", added to those of the run; "": none */
    uint32_t work_group_size;
    double x; /* the row's x, if the part's sweep is over lanes; else 0 */
};

enum {
    KILN_MAX_LANES = 16,
    KILN_MEASURE_FRAME = KILN_PASS_COUNT, /* the whole frame; smaller numbers are passes */
    KILN_MEASURE_COUNT
};

/* The times of a lane, one value for each turn. */
struct kiln_samples {
    const char *problem; /* why the lane cannot run here; else NULL */
    uint32_t count;
    double ms[KILN_MEASURE_COUNT][KILN_BENCH_MAX_REPETITIONS];
    double to_device, to_host; /* bytes moved in the last frame */
    uint64_t alive;            /* particles alive in the last frame */
};

/* Returns the name of a measure: that of a pass, such as "sort", or "frame". */
const char *kiln_measure_name(int measure);

/* The number of frames that are drawn before any is timed. Code is compiled at its first use, and
 * the first frame draws pictures that later frames reuse. */
enum { KILN_BENCH_WARM_UP = 2 };

/* Draws frames of all lanes in turn, from `frame` on: first KILN_BENCH_WARM_UP frames, then as many
 * turns as there is time for. Fills samples[lane_count]. A lane that the device does not allow gets
 * a problem instead of times. */
bool kiln_contest_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                      uint32_t frame, const struct kiln_lane *lanes, size_t lane_count,
                      struct kiln_samples *samples, struct kiln_error *error);

/* The times of a lane's frames until their files were complete, one value for each turn. */
struct kiln_delivery {
    const char *problem;
    uint32_t count;
    double ms[KILN_BENCH_MAX_REPETITIONS];      /* time of a frame, until its files are complete */
    double cpu_ms[KILN_BENCH_MAX_REPETITIONS];  /* CPU time of a frame, of all cores together */
    double slowest[KILN_BENCH_MAX_REPETITIONS]; /* the slowest pass of a frame, ms */
};

/* Runs whole jobs of all lanes in turn. The jobs write files called `name`, such as "f_%04d.png" or
 * "clip.mp4", into the scratch folder; the files are removed. */
bool kiln_delivery_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                       const char *name, const struct kiln_lane *lanes, size_t lane_count,
                       struct kiln_delivery *deliveries, struct kiln_error *error);

/* The technique flags of a lane's job: those of the run, then those of the lane. */
enum { KILN_MAX_FLAGS = 32 };
struct kiln_lane_flags {
    char text[256]; /* the lane's flags, cut into words */
    const char *items[KILN_MAX_FLAGS];
};

/* Returns the parameters of a lane's job, which borrow the range and the flags. Fills the flags. */
struct kiln_render_params kiln_lane_params(const struct kiln_bench_run *run,
                                           const struct kiln_lane *lane,
                                           struct kiln_lane_flags *flags,
                                           const struct kiln_frame_range *range);

/* Returns whether a job could not be made because the device does not allow its techniques.
 * *problem is then the error's message, which lives as long as the run. */
bool kiln_lane_is_refused(const struct kiln_bench_run *run, const struct kiln_error *error,
                          const char **problem);

#endif
