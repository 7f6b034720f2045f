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
    const char *suite; /* at hand */
};

/* A way to render. */
struct kiln_lane {
    const char *name;       /* in the table */
    const char *techniques; /* "sort=cpu raster=geometry", over those of all; "": none */
    uint32_t work_group_size;
    double x; /* where it stands in the sweep, if the lanes are what is swept; else 0 */
};

enum {
    KILN_MAX_LANES = 16,
    KILN_MEASURE_FRAME = KILN_PASS_COUNT, /* beside those of passes: the whole frame */
    KILN_MEASURE_COUNT
};

/* What a lane took, a value for each turn. */
struct kiln_samples {
    const char *problem; /* why it cannot run here; else NULL */
    uint32_t count;
    double ms[KILN_MEASURE_COUNT][KILN_BENCH_MAX_REPETITIONS];
    double to_device, to_host; /* bytes of the last frame */
    uint64_t alive;            /* particles drawn in it */
};

/* "sort", ..., "frame" */
const char *kiln_measure_name(int measure);

/* The number of frames that warm up: code is made at its first use, and the first frame draws what
 * later ones keep. */
enum { KILN_BENCH_WARM_UP = 2 };

/* Draws frames of all lanes in turn, from `frame` on: some to warm up, then as many turns as there
 * is time for. samples[lane_count] are the caller's. A lane that the device does not allow has a
 * problem. */
bool kiln_contest_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                      uint32_t frame, const struct kiln_lane *lanes, size_t lane_count,
                      struct kiln_samples *samples, struct kiln_error *error);

/* The times of a lane's frames until their files were whole, a value for each turn. */
struct kiln_delivery {
    const char *problem;
    uint32_t count;
    double ms[KILN_BENCH_MAX_REPETITIONS];      /* a frame, until the files are whole */
    double cpu_ms[KILN_BENCH_MAX_REPETITIONS];  /* a frame, of all cores together */
    double slowest[KILN_BENCH_MAX_REPETITIONS]; /* ms a frame of the slowest pass */
};

/* Runs whole jobs of all lanes in turn, which write files of this name into the scratch folder,
 * "f_%04d.png" or "clip.mp4". The files are removed. */
bool kiln_delivery_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                       const char *name, const struct kiln_lane *lanes, size_t lane_count,
                       struct kiln_delivery *deliveries, struct kiln_error *error);

/* The technique flags of a lane, which follow those of the run. */
enum { KILN_MAX_FLAGS = 32 };
struct kiln_lane_flags {
    char text[256]; /* the lane's, cut */
    const char *items[KILN_MAX_FLAGS];
};

/* The parameters of a lane's job, which borrow the flags and the range. */
struct kiln_render_params kiln_lane_params(const struct kiln_bench_run *run,
                                           const struct kiln_lane *lane,
                                           struct kiln_lane_flags *flags,
                                           const struct kiln_frame_range *range);

/* Whether a job could not be made for reasons of the device, which *problem then names. */
bool kiln_lane_is_refused(const struct kiln_bench_run *run, const struct kiln_error *error,
                          const char **problem);

#endif
