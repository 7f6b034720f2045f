/* Runs lanes in turn: makes a job for each, brings all jobs to the same first frame, and draws a
 * frame of each job in every turn. All lanes are set up before the first turn, so that turns
 * consist of frames alone. */
#include "bench/contest.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "gpu/device.h"
#include "job/job.h"

struct entrant {
    const struct kiln_lane *lane;
    struct kiln_samples *samples;
    struct kiln_lane_flags flags;
    struct kiln_render_params params;
    struct kiln_job *job; /* NULL: the device does not allow the lane */
};

struct contest {
    const struct kiln_bench_run *run;
    const struct kiln_scene *scene;
    struct kiln_frame_range range;
    struct entrant *entrants;
    size_t count;
};

const char *kiln_measure_name(int measure)
{
    return measure == KILN_MEASURE_FRAME ? "frame" : kiln_pass_name((enum kiln_pass)measure);
}

struct kiln_render_params kiln_lane_params(const struct kiln_bench_run *run,
                                           const struct kiln_lane *lane,
                                           struct kiln_lane_flags *flags,
                                           const struct kiln_frame_range *range)
{
    size_t count = 0;
    for (size_t i = 0; i < run->params->technique_count && count < KILN_MAX_FLAGS; i++)
        flags->items[count++] = run->params->techniques[i];
    snprintf(flags->text, sizeof flags->text, "%s", lane->techniques);
    char *rest = flags->text;
    for (char *word; (word = strsep(&rest, " ")) && count < KILN_MAX_FLAGS;) {
        if (*word)
            flags->items[count++] = word;
    }
    struct kiln_render_params params = kiln_render_defaults();
    params.techniques = flags->items;
    params.technique_count = count;
    params.threads = run->params->threads;
    params.work_group_size = lane->work_group_size;
    params.ranges = range;
    params.range_count = 1;
    params.overwrite = true;
    params.stop = run->params->stop;
    params.user = run->params->user;
    params.log = run->params->log;
    return params;
}

bool kiln_lane_is_refused(const struct kiln_bench_run *run, const struct kiln_error *error,
                          const char **problem)
{
    if (error->code != KILN_NO_DEVICE && error->code != KILN_USAGE)
        return false;
    *problem = kiln_arena_text(run->bench->arena, error->message, strlen(error->message));
    return *problem != NULL;
}

/* ---- Before the turns ------------------------------------------------------------------------ */

static bool create_entrant_job(struct contest *contest, struct entrant *entrant,
                               struct kiln_error *error)
{
    entrant->params =
        kiln_lane_params(contest->run, entrant->lane, &entrant->flags, &contest->range);
    entrant->job = kiln_job_create(contest->run->device, contest->scene, &entrant->params, error);
    return entrant->job || kiln_lane_is_refused(contest->run, error, &entrant->samples->problem);
}

/* Steps one job to the first frame, and copies its particles to the others. */
static bool reach_first_frame(struct contest *contest, struct kiln_error *error)
{
    struct kiln_job *first = NULL;
    for (size_t i = 0; i < contest->count; i++) {
        struct kiln_job *job = contest->entrants[i].job;
        if (!job)
            continue;
        bool ok = first ? kiln_loop_copy_state(kiln_job_loop(job), kiln_job_loop(first), error)
                        : kiln_loop_advance(kiln_job_loop(job), contest->range.first, error);
        if (!ok)
            return false;
        first = first ? first : job;
    }
    return true;
}

/* ---- The turns ------------------------------------------------------------------------------- */

static bool draw(struct contest *contest, struct entrant *entrant, uint32_t frame, bool counts,
                 struct kiln_error *error)
{
    const struct kiln_traffic *traffic = &contest->run->device->traffic;
    struct kiln_traffic before = *traffic;
    double start_s = kiln_clock_seconds();
    if (!kiln_job_draw(entrant->job, frame, error))
        return false;
    double frame_ms = 1e3 * (kiln_clock_seconds() - start_s);
    if (!counts)
        return true;
    struct kiln_samples *samples = entrant->samples;
    const struct kiln_progress *progress = kiln_job_progress(entrant->job);
    for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
        samples->ms[pass][samples->count] = progress->pass_ms[pass];
    samples->ms[KILN_MEASURE_FRAME][samples->count++] = frame_ms;
    samples->alive = progress->alive;
    samples->to_device = (double)(traffic->to_device - before.to_device);
    samples->to_host = (double)(traffic->to_host - before.to_host);
    return true;
}

static bool take_turns(struct contest *contest, struct kiln_error *error)
{
    const struct kiln_frame_range range = contest->range;
    double start_s = 0.0;
    for (uint32_t frame = range.first; frame <= range.last; frame++) {
        uint32_t drawn = frame - range.first;
        if (drawn == KILN_BENCH_WARM_UP)
            start_s = kiln_clock_seconds();
        if (drawn >= KILN_BENCH_WARM_UP + KILN_BENCH_MIN_REPETITIONS &&
            kiln_clock_seconds() - start_s > contest->run->params->seconds)
            return true;
        for (size_t i = 0; i < contest->count; i++) {
            struct entrant *entrant = &contest->entrants[i];
            if (entrant->job && !draw(contest, entrant, frame, drawn >= KILN_BENCH_WARM_UP, error))
                return false;
        }
    }
    return true;
}

bool kiln_contest_run(const struct kiln_bench_run *run, const struct kiln_scene *scene,
                      uint32_t frame, const struct kiln_lane *lanes, size_t lane_count,
                      struct kiln_samples *samples, struct kiln_error *error)
{
    struct contest contest = {
        .run = run,
        .scene = scene,
        .range = {frame, frame + KILN_BENCH_WARM_UP + run->bench->repetitions - 1},
        .entrants = calloc(lane_count, sizeof *contest.entrants),
        .count = lane_count,
    };
    if (!contest.entrants) {
        kiln_error_no_memory(error, "measurements");
        return false;
    }
    bool ok = true;
    for (size_t i = 0; i < lane_count && ok; i++) {
        memset(&samples[i], 0, sizeof samples[i]);
        contest.entrants[i].lane = &lanes[i];
        contest.entrants[i].samples = &samples[i];
        ok = create_entrant_job(&contest, &contest.entrants[i], error);
    }
    ok = ok && reach_first_frame(&contest, error) && take_turns(&contest, error);
    for (size_t i = 0; i < lane_count; i++)
        kiln_job_destroy(&contest.entrants[i].job);
    free(contest.entrants);
    return ok;
}
