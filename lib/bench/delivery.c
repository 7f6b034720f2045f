/* Times whole jobs that write files, until the files are complete. Encoders run beside the drawing.
 * Encoding that goes on after a job's last frame is drawn counts as that job's time, and must end
 * before another job starts. The clock starts after two warm-up frames, of which one may still be
 * encoded. */
#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/contest.h"
#include "job/job.h"

enum { LEAST_FRAMES = 3, MOST_FRAMES = 32 };

struct delivery {
    const struct kiln_bench_run *run;
    const struct kiln_scene *scene;
    const char *name;
    char folder[KILN_PATH_SIZE];
    struct kiln_job *start_job; /* a job at the first frame, which others copy */
    struct kiln_lane_flags flags;
    struct kiln_render_params start_params;
    struct kiln_frame_range range;
    uint32_t frames[KILN_MAX_LANES]; /* frames of each lane's jobs, for about a second */
};

/* Draws the frames that are timed. Returns the time of the slowest pass, ms a frame, or less than 0
 * with an error. */
static double draw_frames(struct kiln_job *job, uint32_t first, uint32_t count,
                          struct kiln_error *error)
{
    double sums[KILN_PASS_COUNT] = {0};
    for (uint32_t frame = first; frame < first + count; frame++) {
        if (!kiln_job_draw(job, frame, error))
            return -1.0;
        for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
            sums[pass] += kiln_job_progress(job)->pass_ms[pass] / count;
    }
    double slowest = 0.0;
    for (int pass = 0; pass < KILN_PASS_output; pass++) /* `output` waits for the encoders */
        slowest = sums[pass] > slowest ? sums[pass] : slowest;
    return slowest;
}

static bool time_job(struct kiln_job *job, uint32_t frames, struct kiln_delivery *delivery,
                     struct kiln_error *error)
{
    double start_s = kiln_clock_seconds(), start_cpu_s = kiln_clock_cpu_seconds();
    struct kiln_render_stats stats;
    double slowest = draw_frames(job, KILN_BENCH_WARM_UP, frames, error);
    if (slowest < 0.0 || !kiln_job_finish(job, &stats, error))
        return false;
    delivery->ms[delivery->count] = 1e3 * (kiln_clock_seconds() - start_s) / frames;
    delivery->cpu_ms[delivery->count] = 1e3 * (kiln_clock_cpu_seconds() - start_cpu_s) / frames;
    delivery->slowest[delivery->count++] = slowest;
    return true;
}

static void remove_files(const struct delivery *d)
{
    struct dirent **entries = NULL;
    int count = scandir(d->folder, &entries, NULL, NULL);
    int folder = count > 0 ? open(d->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    for (int i = 0; i < count; i++) {
        if (folder >= 0)
            unlinkat(folder, entries[i]->d_name, 0); /* does not remove "." and ".." */
        free(entries[i]);
    }
    free(entries);
    if (folder >= 0)
        close(folder);
}

static bool warm_up(struct delivery *d, struct kiln_job *job, double *last_s,
                    struct kiln_error *error)
{
    bool ok = kiln_loop_copy_state(kiln_job_loop(job), kiln_job_loop(d->start_job), error);
    for (uint32_t frame = 0; frame < KILN_BENCH_WARM_UP && ok; frame++) {
        double start_s = kiln_clock_seconds();
        ok = kiln_job_draw(job, frame, error);
        *last_s = kiln_clock_seconds() - start_s;
    }
    return ok;
}

static uint32_t choose_frames(const struct delivery *d, double frame_s)
{
    double target = d->run->params->quick ? 0.0 : 1.2;
    double frames = frame_s > 0.0 ? target / frame_s : MOST_FRAMES;
    return frames < LEAST_FRAMES  ? LEAST_FRAMES
           : frames > MOST_FRAMES ? MOST_FRAMES
                                  : (uint32_t)frames;
}

/* Finds how many frames a lane's jobs are to have, from the speed of a job that writes nothing. */
static bool choose_frame_count(struct delivery *d, size_t index, const struct kiln_lane *lane,
                               struct kiln_delivery *delivery, struct kiln_error *error)
{
    struct kiln_lane_flags flags;
    const struct kiln_render_params params = kiln_lane_params(d->run, lane, &flags, &d->range);
    struct kiln_job *job = kiln_job_create(d->run->device, d->scene, &params, error);
    if (!job)
        return kiln_lane_is_refused(d->run, error, &delivery->problem);
    double frame_s = 0.0;
    bool ok = warm_up(d, job, &frame_s, error);
    d->frames[index] = choose_frames(d, frame_s);
    kiln_job_destroy(&job);
    return ok;
}

static bool run_lane(struct delivery *d, size_t index, const struct kiln_lane *lane,
                     struct kiln_delivery *delivery, struct kiln_error *error)
{
    struct kiln_lane_flags flags;
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, d->folder, d->name, error))
        return false;
    const struct kiln_frame_range range = {0, KILN_BENCH_WARM_UP + d->frames[index] - 1};
    struct kiln_render_params params = kiln_lane_params(d->run, lane, &flags, &range);
    params.output = path;
    struct kiln_job *job = kiln_job_create(d->run->device, d->scene, &params, error);
    double unused = 0.0;
    bool ok =
        job && warm_up(d, job, &unused, error) && time_job(job, d->frames[index], delivery, error);
    kiln_job_destroy(&job);
    remove_files(d);
    return ok;
}

static bool open_donor(struct delivery *d, struct kiln_error *error)
{
    static const struct kiln_lane automatic = {.name = "auto", .techniques = ""};
    d->range = (struct kiln_frame_range){0, KILN_BENCH_WARM_UP};
    d->start_params = kiln_lane_params(d->run, &automatic, &d->flags, &d->range);
    d->start_job = kiln_job_create(d->run->device, d->scene, &d->start_params, error);
    return d->start_job && kiln_loop_advance(kiln_job_loop(d->start_job), 0, error);
}

static bool take_turns(struct delivery *d, const struct kiln_lane *lanes, size_t lane_count,
                       struct kiln_delivery *deliveries, struct kiln_error *error)
{
    for (size_t i = 0; i < lane_count; i++) {
        if (!choose_frame_count(d, i, &lanes[i], &deliveries[i], error))
            return false;
    }
    double start_s = kiln_clock_seconds();
    for (uint32_t turn = 0; turn < d->run->bench->repetitions; turn++) {
        if (turn >= KILN_BENCH_MIN_REPETITIONS &&
            kiln_clock_seconds() - start_s > d->run->params->seconds)
            return true;
        for (size_t i = 0; i < lane_count; i++) {
            if (!deliveries[i].problem && !run_lane(d, i, &lanes[i], &deliveries[i], error))
                return false;
        }
    }
    return true;
}

bool kiln_delivery_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                       const char *name, const struct kiln_lane *lanes, size_t lane_count,
                       struct kiln_delivery *deliveries, struct kiln_error *error)
{
    struct delivery d = {.run = run, .scene = scene, .name = name};
    memset(deliveries, 0, lane_count * sizeof *deliveries);
    if (!kiln_path_join(d.folder, run->params->scratch, "kiln-bench-XXXXXX", error))
        return false;
    if (!mkdtemp(d.folder))
        return kiln_error_set(error, KILN_IO, "%s: no folder for pictures can be made there",
                              run->params->scratch);
    bool ok = open_donor(&d, error) && take_turns(&d, lanes, lane_count, deliveries, error);
    kiln_job_destroy(&d.start_job);
    rmdir(d.folder);
    return ok;
}
