/* Runs a job: opens the files that it writes, asks the frame loop for each wanted frame, hands the
 * pictures to the output, and keeps the counts for statistics, journal and manifest. */
#include "job/job.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/ranges.h"
#include "job/manifest.h"
#include "job/resume.h"
#include "job/states.h"
#include "job/stop.h"
#include "job/views.h"
#include "output/formats.h"

struct kiln_job {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_render_params *params;
    struct kiln_stop stop;
    struct kiln_frame_range whole_clip; /* the range that stands for an empty list of ranges */
    const struct kiln_frame_range *ranges;
    size_t range_count;

    struct kiln_loop *loop;
    struct kiln_output_params files; /* complete; path NULL when nothing is written */
    struct kiln_output *output;      /* NULL when nothing is to be written */
    struct kiln_manifest *manifest;  /* NULL when none is wanted */
    /* records of the frames; filled if there is a manifest or a journal */
    struct kiln_records records;
    char *scene_json;        /* the scene's text, for manifest and journal */
    char made_by[512];       /* device and techniques, for the journal */
    struct kiln_attempt run; /* description of this run, for manifest and journal */
    bool resumes, is_described;
    struct kiln_resume resume;
    bool draws;                 /* false: no frame is missing, nor the state of one */
    size_t range_at;            /* index of the range that has the next frame */
    uint64_t frame_at;          /* the next frame, or below the range's first one */
    bool follows;               /* true: the next frame comes right after a frame that was drawn */
    struct kiln_states *states; /* NULL: the run starts from no saved state */

    double started_s;
    /* the last drawn frame's picture, until the caller takes it; NULL: none */
    struct kiln_picture *last_picture;
    uint32_t total_frames;
    uint32_t written;              /* the number of files of frames that are whole */
    struct kiln_progress progress; /* progress at the present frame */
    struct kiln_render_stats stats;
};

/* ---- frame by frame -------------------------------------------------------------------------- */

/* Makes the job's device current again, since a callback may have used another device on this
 * thread. */
static bool return_from_caller(const struct kiln_job *job, struct kiln_error *error)
{
    return kiln_device_make_current(job->device, error);
}

/* Hands a picture to the output, which owns it from then on. */
static bool hand_over(struct kiln_job *job, struct kiln_picture *picture, struct kiln_error *error)
{
    kiln_views_show(job->params, picture);
    kiln_picture_destroy(&job->last_picture);
    if (job->params->keep_frames)
        job->last_picture = kiln_picture_share(picture);
    if (!return_from_caller(job, error)) {
        kiln_picture_destroy(&picture);
        return false;
    }
    if (job->output)
        return kiln_output_write(job->output, picture, error);
    kiln_picture_destroy(&picture);
    return true;
}

/* Records what is known of a frame before its picture goes to the output. */
static void record_frame(struct kiln_job *job, uint32_t frame, const struct kiln_drawn *drawn,
                         uint64_t alive)
{
    struct kiln_record *record = kiln_records_of(&job->records, frame);
    if (!record)
        return;
    record->has_state = record->drawn = true;
    record->state = drawn->state;
    record->alive = alive;
    for (int i = 0; i < KILN_PASS_COUNT; i++)
        record->pass_ms[i] = (float)drawn->pass_ms[i];
}

static void tell_written(struct kiln_job *job, const struct kiln_finished_file *finished)
{
    struct kiln_written file = {.size = sizeof file,
                                .file = finished->path,
                                .kind = finished->is_clip   ? KILN_WRITTEN_CLIP
                                        : finished->is_part ? KILN_WRITTEN_PART
                                                            : KILN_WRITTEN_FRAME,
                                .frames = finished->frames,
                                .bytes = finished->bytes};
    memcpy(file.sha256, finished->sha256, sizeof file.sha256);
    const struct kiln_record *record = kiln_records_of(&job->records, finished->frames.first);
    if (file.kind == KILN_WRITTEN_FRAME && record) {
        file.done = ++job->written;
        file.total = job->total_frames;
        file.state = record->state;
        file.alive = record->alive;
        for (int i = 0; i < KILN_PASS_COUNT; i++)
            file.pass_ms[i] = (double)record->pass_ms[i];
    }
    job->params->written(job->params->user, &file);
}

/* Records that a file is whole. It is called on any thread, but never on two at a time. */
static bool take_finished(void *user, const struct kiln_finished_file *finished,
                          struct kiln_error *error)
{
    struct kiln_job *job = user;
    if (job->resumes && !kiln_resume_take(&job->resume, finished, error))
        return false;
    if (!job->resumes)
        kiln_records_take(&job->records, finished);
    if (job->params->written)
        tell_written(job, finished);
    return true;
}

static bool report_frame(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    struct kiln_progress *p = &job->progress;
    p->frame = frame;
    p->done++;
    p->total = job->total_frames;
    p->elapsed_s = kiln_clock_seconds() - job->started_s;
    p->eta_s = p->elapsed_s / p->done * (p->total - p->done);
    for (int i = 0; i < KILN_PASS_COUNT; i++)
        job->stats.pass_ms[i] += p->pass_ms[i];
    if (!job->params->progress)
        return true;
    job->params->progress(job->params->user, p);
    return return_from_caller(job, error);
}

bool kiln_job_draw(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    struct kiln_drawn drawn;
    if (job->params->next) {
        job->params->next(job->params->user, frame);
        if (!return_from_caller(job, error))
            return false;
    }
    const bool hash = job->params->state_hash || job->records.items;
    if (!kiln_loop_draw(job->loop, frame, hash, &drawn, error))
        return false;
    if (job->params->drawn)
        job->params->drawn(job->params->user, frame);
    struct kiln_progress *progress = &job->progress;
    progress->alive = drawn.alive;
    progress->state = drawn.state;
    memcpy(progress->pass_ms, drawn.pass_ms, sizeof drawn.pass_ms);
    record_frame(job, frame, &drawn, drawn.alive);
    double before_s = kiln_clock_seconds();
    if (!hand_over(job, drawn.picture, error))
        return false;
    progress->pass_ms[KILN_PASS_output] = 1e3 * (kiln_clock_seconds() - before_s);
    return report_frame(job, frame, error);
}

const struct kiln_progress *kiln_job_progress(const struct kiln_job *job)
{
    return &job->progress;
}

struct kiln_picture *kiln_job_take_picture(struct kiln_job *job)
{
    struct kiln_picture *picture = job->last_picture;
    job->last_picture = NULL;
    return picture;
}

struct kiln_loop *kiln_job_loop(struct kiln_job *job)
{
    return job->loop;
}

/* Passes over a frame whose file is there already; only its state may still have to be computed. */
static bool skip_frame(struct kiln_job *job, uint32_t frame, struct kiln_record *record,
                       struct kiln_error *error)
{
    if (record->has_state)
        return true;
    if (!kiln_loop_advance(job->loop, frame, error) ||
        !kiln_loop_hash(job->loop, &record->state, &record->alive, error))
        return false;
    record->has_state = true;
    return kiln_resume_note(&job->resume, frame, error);
}

/* Finds the next wanted frame; false: there is none. */
static bool take_frame(struct kiln_job *job, uint32_t *frame)
{
    for (; job->draws && job->range_at < job->range_count; job->range_at++) {
        const struct kiln_frame_range range = job->ranges[job->range_at];
        if (job->frame_at < range.first) {
            job->frame_at = range.first;
            job->follows = false;
        }
        if (job->frame_at <= range.last) {
            *frame = (uint32_t)job->frame_at++;
            return true;
        }
    }
    return false;
}

bool kiln_job_next(struct kiln_job *job, bool *drawn, struct kiln_error *error)
{
    uint32_t frame;
    *drawn = false;
    kiln_picture_destroy(&job->last_picture);
    while (!*drawn && take_frame(job, &frame)) {
        struct kiln_record *record = job->resumes ? kiln_records_of(&job->records, frame) : NULL;
        const bool is_there = record && record->whole && !record->drawn;
        const bool is_others = record && record->is_others;
        if (!is_others && !job->follows && !(is_there && record->has_state) && job->states &&
            !kiln_states_take_up(job->states, job->loop, frame, error))
            return false;
        if (!is_others &&
            !(is_there ? skip_frame(job, frame, record, error) : kiln_job_draw(job, frame, error)))
            return false;
        *drawn = job->follows = !is_there && !is_others;
    }
    return true;
}

/* ---- set-up and end -------------------------------------------------------------------------- */

static bool choose_frames(struct kiln_job *job, struct kiln_error *error)
{
    job->ranges = job->params->ranges;
    job->range_count = job->params->range_count;
    if (job->range_count == 0) {
        job->whole_clip = (struct kiln_frame_range){0, job->scene->frames - 1};
        job->ranges = &job->whole_clip;
        job->range_count = 1;
    }
    uint64_t next = 0;
    for (size_t i = 0; i < job->range_count; i++) {
        struct kiln_frame_range range = job->ranges[i];
        if (range.first > range.last || range.first < next || range.last >= job->scene->frames)
            return kiln_error_set(error, KILN_USAGE,
                                  "frames %u-%u: expected ascending ranges within 0-%u",
                                  range.first, range.last, job->scene->frames - 1);
        next = (uint64_t)range.last + 1;
    }
    job->total_frames = (uint32_t)kiln_ranges_count(job->ranges, job->range_count);
    return true;
}

/* Checks that no file of the job is written twice, or both written and read. */
static bool check_files(const struct kiln_job *job, struct kiln_error *error)
{
    struct kiln_claims *claims = kiln_claims_create();
    bool ok = claims ? kiln_render_claim(job->scene, job->params, claims, error)
                     : kiln_error_no_memory(error, "files of the job");
    kiln_claims_destroy(&claims);
    return ok;
}

static bool writes_stream(const struct kiln_job *job)
{
    return job->params->stream.format != KILN_STREAM_NONE;
}

static struct kiln_output_params output_params(struct kiln_job *job)
{
    const struct kiln_render_params *params = job->params;
    const struct kiln_scene *scene = job->scene;
    struct kiln_output_params output = {
        .path = writes_stream(job) ? "standard output" : params->output,
        .stream = params->stream,
        .width = scene->width,
        .height = scene->height,
        .fps_num = scene->fps.num,
        .fps_den = scene->fps.den,
        .alpha = scene->backdrop.transparent,
        .ranges = job->ranges,
        .range_count = job->range_count,
        .clip = job->ranges,
        .clip_count = job->range_count,
        .parts_alone = params->shards > 0,
        .threads = kiln_threads_count(kiln_loop_threads(job->loop)),
        .overwrite = params->overwrite,
        .png_bits = params->png_bits,
        .exr_bits = params->exr_bits,
        .quality = params->quality,
        .png_effort = params->png_effort,
        .scene_hash = scene->hash,
        .seed = scene->seed,
        .log = params->log,
        .budget = scene->budget,
        .caller = kiln_stop_caller(&job->stop),
    };
    if (params->flipbook)
        output.flipbook = *params->flipbook;
    return output;
}

static bool keep_records(struct kiln_job *job, struct kiln_error *error)
{
    if (!job->params->manifest && !job->params->written && !job->resumes)
        return true;
    if (!writes_stream(job))
        job->files.on_finished = (struct kiln_file_listener){take_finished, job};
    job->scene_json = kiln_manifest_scene(job->scene);
    return (job->scene_json && kiln_records_create(&job->records, job->ranges, job->range_count)) ||
           kiln_error_no_memory(error, "records of %u frames", job->total_frames);
}

/* Finds out which files of the job are there, and leaves only the missing frames to be drawn. */
static bool begin_to_resume(struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_device_info *device = &job->device->info;
    snprintf(job->made_by, sizeof job->made_by, "kiln %s, %s, %s", KILN_VERSION,
             device->gl ? device->name : KILN_DEVICE_CPU, job->stats.techniques);
    job->files.durable = true;
    const struct kiln_output_params files = job->files;
    if (!kiln_resume_begin(&job->resume,
                           &(struct kiln_resume_params){
                               .output = &files,
                               .made_by = job->made_by,
                               .scene = job->scene_json,
                               .shard = {job->params->shard, job->params->shards},
                               .restart = job->params->overwrite,
                           },
                           &job->records, error))
        return false;
    job->files = job->resume.output;
    job->files.overwrite = job->resume.may_replace;
    job->files.ranges = job->resume.missing;
    job->files.range_count = job->resume.missing_count;
    job->stats.kept = job->resume.kept;
    job->stats.first_part = job->resume.first_part;
    job->stats.end_part = job->resume.end_part;
    job->total_frames = (uint32_t)kiln_ranges_count(job->resume.missing, job->resume.missing_count);
    job->draws = job->resume.missing_count > 0;
    for (uint32_t i = 0; i < job->records.count; i++) {
        const struct kiln_record *record = &job->records.items[i];
        job->draws = job->draws || !(record->has_state || record->is_others);
    }
    return true;
}

/* Refuses to resume a stream: its bytes cannot be looked at again. */
static bool check_stream(const struct kiln_job *job, struct kiln_error *error)
{
    return !writes_stream(job) || !(job->resumes || job->params->flipbook) ||
           kiln_error_set(error, KILN_USAGE, "%s: standard output cannot be %s", job->files.path,
                          job->resumes ? "resumed" : "a flipbook");
}

static bool check_shard(const struct kiln_render_params *params, struct kiln_error *error)
{
    if (params->shards == 0 && params->shard == 0)
        return true;
    if (params->shard >= params->shards)
        return kiln_error_set(error, KILN_USAGE, "shard %u of %u: shards count from 0",
                              params->shard, params->shards);
    return params->output ||
           kiln_error_set(error, KILN_USAGE, "shard %u of %u: the job has no output to share",
                          params->shard, params->shards);
}

static bool open_output(struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_render_params *params = job->params;
    if (!check_shard(params, error) || !check_files(job, error))
        return false;
    const struct kiln_output_params files = output_params(job);
    job->draws = true;
    if (files.path) {
        job->files = kiln_output_complete(&files, error);
        job->resumes = params->resume || params->shards > 0;
        if (!job->files.format || !check_stream(job, error))
            return false;
    }
    if (job->files.path && !job->resumes && !writes_stream(job) &&
        !kiln_resume_clear(&job->files, error))
        return false;
    if (!keep_records(job, error) || (job->resumes && !begin_to_resume(job, error)))
        return false;
    if (job->files.path && job->files.range_count > 0 &&
        !(job->output = kiln_output_open(&job->files, error)))
        return false;
    if (!params->manifest)
        return true;
    job->manifest = kiln_manifest_open(
        &(struct kiln_manifest_params){
            .path = params->manifest,
            .overwrite = params->overwrite,
            .again = job->resumes,
            .scene = job->scene_json,
            .output = params->output,
            .files = params->output ? &job->files : NULL,
            .run = &job->run,
        },
        error);
    return job->manifest != NULL;
}

/* Fills the statistics with the techniques that the loop chose, and the attempt with device and
 * techniques. */
static void describe_run(struct kiln_job *job)
{
    const struct kiln_render_params *params = job->params;
    const struct kiln_techniques *techniques = kiln_loop_techniques(job->loop);
    struct kiln_render_stats *stats = &job->stats;
    kiln_techniques_describe(techniques, stats->techniques, sizeof stats->techniques);
    stats->choice_count = KILN_STAGE_COUNT;
    memcpy(stats->choices, techniques->choices, sizeof techniques->choices);
    job->run = (struct kiln_attempt){.command = params->command,
                                     .command_count = params->command_count,
                                     .build = params->build,
                                     .device = &job->device->info,
                                     .techniques = stats->techniques,
                                     .shard = {params->shard, params->shards},
                                     .started = time(NULL)};
}

static bool begin(struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_render_params *params = job->params;
    const struct kiln_loop_params loop = {.techniques = params->techniques,
                                          .technique_count = params->technique_count,
                                          .threads = params->threads,
                                          .work_group_size = params->work_group_size,
                                          .log = params->log,
                                          .caller = kiln_stop_caller(&job->stop)};
    struct kiln_output_needs needs = {.bits = 0};
    if (!choose_frames(job, error) || !kiln_views_need(job->scene, params, &needs, error))
        return false;
    job->loop = kiln_loop_create(job->device, job->scene, &loop, error);
    if (!job->loop)
        return false;
    describe_run(job);
    if (!open_output(job, error))
        return false;
    if (!job->draws)
        return true;
    needs = job->output ? kiln_output_needs(job->output) : (struct kiln_output_needs){.bits = 8};
    if (!kiln_views_need(job->scene, params, &needs, error) ||
        !kiln_loop_set_up(job->loop, needs, error))
        return false;
    if (params->states &&
        !(job->states = kiln_states_open(params->states, job->scene,
                                         kiln_loop_techniques(job->loop), &params->log, error)))
        return false;
    job->stats.particle_capacity = kiln_loop_run(job->loop)->pool.slot_count;
    job->stats.particle_bytes = kiln_loop_particle_bytes(job->loop);
    job->stats.setup_s = kiln_clock_seconds() - job->started_s;
    return true;
}

/* Finds the state at the end of the run. For a run that drew nothing, it is the state of the last
 * frame. A run that drew the frame at 0 s alone counts the particles that this frame shows. */
static bool find_last_state(struct kiln_job *job, struct kiln_error *error)
{
    struct kiln_render_stats *s = &job->stats;
    if (job->draws)
        return kiln_loop_hash(job->loop, &s->state, &s->alive, error) &&
               (kiln_loop_run(job->loop)->step > job->scene->warmup_steps ||
                kiln_loop_count_first(job->loop, &s->alive, error));
    const struct kiln_record *last = &job->records.items[job->records.count - 1];
    s->state = last->state;
    s->alive = last->alive;
    return true;
}

static bool finish_output(struct kiln_job *job, struct kiln_error *error)
{
    struct kiln_render_stats *s = &job->stats;
    if (!job->files.path)
        return true;
    if (writes_stream(job)) {
        snprintf(s->first_file, sizeof s->first_file, "%s", job->files.path);
        return kiln_output_finish(job->output, error);
    }
    s->files = kiln_output_file_count(&job->files);
    return kiln_output_file(&job->files, job->ranges[0].first, s->first_file, error) &&
           (!job->output || kiln_output_finish(job->output, error)) &&
           (!job->resumes || job->params->shards > 0 || !job->files.format->one_file ||
            job->resume.clip_is_whole || kiln_resume_join(&job->resume, error));
}

static void sum_up(struct kiln_job *job)
{
    job->stats.frames = job->progress.done;
    job->stats.steps = kiln_loop_steps(job->loop);
    job->stats.total_s = kiln_clock_seconds() - job->started_s;
    job->run.asked = job->total_frames;
}

/* Writes the manifest and appends the run to the journal. It does so once, even if the job fails
 * afterwards. */
static bool describe(struct kiln_job *job, const struct kiln_error *failure,
                     struct kiln_error *error)
{
    struct kiln_error reason = {0};
    if (job->is_described)
        return true;
    job->is_described = true;
    const bool made = !job->manifest || kiln_manifest_finish(job->manifest, &job->records,
                                                             &job->stats, failure, &reason);
    if (!made && !failure) {
        kiln_error_set(error, reason.code, "%s", reason.message);
        failure = &reason;
    }
    return (!job->resumes || kiln_resume_end_attempt(&job->resume, &job->run, &job->stats, failure,
                                                     made ? error : &reason)) &&
           made;
}

bool kiln_job_finish(struct kiln_job *job, struct kiln_render_stats *stats,
                     struct kiln_error *error)
{
    if (!find_last_state(job, error) || !finish_output(job, error))
        return false;
    sum_up(job);
    if (!describe(job, NULL, error))
        return false;
    *stats = job->stats;
    return true;
}

void kiln_job_fail(struct kiln_job *job, const struct kiln_error *failure)
{
    struct kiln_error ignored = {0};
    /* this waits for the last files, so no file becomes whole later */
    kiln_output_close(&job->output);
    sum_up(job);
    describe(job, failure, &ignored);
}

void kiln_job_destroy(struct kiln_job **job)
{
    struct kiln_job *j = *job;
    if (!j)
        return;
    kiln_picture_destroy(&j->last_picture);
    kiln_states_close(&j->states);
    kiln_manifest_close(&j->manifest);
    kiln_output_close(&j->output);
    kiln_resume_end(&j->resume);
    kiln_records_free(&j->records);
    free(j->scene_json);
    kiln_loop_destroy(&j->loop);
    free(j);
    *job = NULL;
}

struct kiln_job *kiln_job_create(struct kiln_device *device, const struct kiln_scene *scene,
                                 const struct kiln_render_params *params, struct kiln_error *error)
{
    struct kiln_job *job = calloc(1, sizeof *job);
    if (!job) {
        kiln_error_no_memory(error, "a job");
        return NULL;
    }
    job->device = device;
    job->scene = scene;
    job->params = params;
    job->stop =
        (struct kiln_stop){params->stop, params->user, device, scene->budget, params->cancel};
    job->progress.size = sizeof job->progress;
    job->stats.size = sizeof job->stats;
    job->started_s = kiln_clock_seconds();
    if (!begin(job, error)) {
        if (job->manifest)
            kiln_job_fail(job, error);
        kiln_resume_undo(&job->resume);
        kiln_job_destroy(&job);
    }
    return job;
}
