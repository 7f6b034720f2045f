/* The frame loop: the file to read first.
 *
 * A job steps the simulation from its start to each wanted frame and draws it there. Undrawn frames
 * are stepped as well, so a frame is the same bytes in any chunk of the clip. The stages behind one
 * frame are in stages.c.
 */
#include "frame/frame.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "frame/stages.h"
#include "output/manifest.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct kiln_job {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_render_params *params;
    struct kiln_frame_range whole_clip; /* what an empty list of ranges means */
    const struct kiln_frame_range *ranges;
    size_t range_count;

    struct kiln_techniques techniques;
    struct kiln_threads *threads;
    struct kiln_run run;
    struct kiln_stages stages;
    struct kiln_output *output;     /* NULL when nothing is written */
    struct kiln_manifest *manifest; /* NULL when none is wanted */

    double started_s;
    uint32_t total_frames;
    struct kiln_progress progress; /* of the frame at hand */
    struct kiln_render_stats stats;
};

/* ---- the loop -------------------------------------------------------------------------------- */

/* A callback may have used another device on this thread. */
static bool return_from_caller(const struct kiln_job *job, struct kiln_error *error)
{
    return kiln_device_make_current(job->device, error);
}

/* False with KILN_INTERRUPTED when the caller wants no more. */
static bool may_go_on(void *user, struct kiln_error *error)
{
    const struct kiln_job *job = user;
    if (!job->params->stop)
        return true;
    bool stop = job->params->stop(job->params->user);
    if (!return_from_caller(job, error))
        return false;
    return !stop || kiln_error_set(error, KILN_INTERRUPTED, "stopped after %u of %u frames",
                                   job->progress.done, job->total_frames);
}

static bool step_to(struct kiln_job *job, uint32_t step, struct kiln_error *error)
{
    struct kiln_run *run = &job->run;
    kiln_timer_begin(job->stages.timer, KILN_PASS_simulate);
    bool ok = true;
    while (ok && run->step < step) {
        ok = may_go_on(job, error) &&
             kiln_simulate_step(job->stages.simulate, &run->pool, run->step + 1, error);
        if (ok)
            run->step++;
    }
    kiln_timer_end(job->stages.timer);
    return ok;
}

static struct kiln_output_needs output_needs(const struct kiln_job *job)
{
    if (job->output)
        return kiln_output_needs(job->output);
    return (struct kiln_output_needs){.bits = 8};
}

static bool write_picture(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    const struct kiln_scene *scene = job->scene;
    struct kiln_output_needs needs = output_needs(job);
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    uint32_t layers = needs.layers ? kiln_stages_layers(names, channels) : 0;
    struct kiln_picture *picture = kiln_picture_create(scene->width, scene->height, needs.bits,
                                                       names, channels, layers, error);
    if (!picture)
        return false;
    picture->frame = frame;
    picture->has_alpha = scene->backdrop.transparent;
    if (!kiln_stages_read(&job->stages, picture, error)) {
        kiln_picture_destroy(&picture);
        return false;
    }
    if (!job->output) {
        if (job->params->picture)
            job->params->picture(job->params->user, frame, picture->display);
        kiln_picture_destroy(&picture);
        return return_from_caller(job, error);
    }
    return kiln_output_write(job->output, picture, error);
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
    char path[KILN_PATH_SIZE] = "";
    bool written = job->output && kiln_output_path(job->output, frame, path, sizeof path);
    if (job->manifest && !kiln_manifest_add(job->manifest, p, written ? path : NULL, error))
        return false;
    if (!job->params->progress)
        return true;
    job->params->progress(job->params->user, p);
    return return_from_caller(job, error);
}

/* All moments of a frame while the shutter is open: one, unless the scene asks for more. */
static bool draw_moments(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    for (uint32_t moment = 0; moment < job->scene->camera.shutter_samples; moment++) {
        uint32_t drawn = 0;
        if (!step_to(job, kiln_scene_moment_step(job->scene, frame, moment), error) ||
            !kiln_stages_draw(&job->stages, &job->run.pool, job->run.step, moment, &drawn, error))
            return false;
        if (moment == 0)
            job->progress.alive = drawn;
    }
    return true;
}

bool kiln_job_draw(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    if (!may_go_on(job, error) || !step_to(job, kiln_scene_frame_step(job->scene, frame), error))
        return false;

    struct kiln_pool *pool = &job->run.pool;
    if (job->params->state_hash || job->manifest) {
        uint64_t alive = 0;
        if (!kiln_simulate_hash(job->stages.simulate, pool, &job->progress.state, &alive, error))
            return false;
    }
    if (!draw_moments(job, frame, error) || !kiln_stages_compose(&job->stages, frame, error))
        return false;

    double before_s = kiln_clock_seconds();
    if (!write_picture(job, frame, error))
        return false;
    double output_ms = 1e3 * (kiln_clock_seconds() - before_s);
    kiln_timer_collect(job->stages.timer, job->progress.pass_ms);
    output_ms -= job->progress.pass_ms[KILN_PASS_readback];
    job->progress.pass_ms[KILN_PASS_output] = output_ms > 0.0 ? output_ms : 0.0;
    return report_frame(job, frame, error);
}

/* Frames that are not drawn, where they matter to later ones for more than their steps. */
static bool pass_over_frames(struct kiln_job *job, uint32_t first, uint32_t end,
                             struct kiln_error *error)
{
    if (!kiln_stages_keep_history(&job->stages))
        return true;
    for (uint32_t frame = first; frame < end; frame++)
        for (uint32_t moment = 0; moment < job->scene->camera.shutter_samples; moment++) {
            uint32_t step = kiln_scene_moment_step(job->scene, frame, moment);
            if (!step_to(job, step, error) ||
                !kiln_stages_pass_over(&job->stages, &job->run.pool, job->run.step, error))
                return false;
        }
    return true;
}

bool kiln_job_advance(struct kiln_job *job, uint32_t frame, struct kiln_error *error)
{
    return step_to(job, kiln_scene_frame_step(job->scene, frame), error);
}

const struct kiln_progress *kiln_job_progress(const struct kiln_job *job)
{
    return &job->progress;
}

static bool render_frames(struct kiln_job *job, struct kiln_error *error)
{
    uint32_t next = 0;
    for (size_t i = 0; i < job->range_count; i++) {
        struct kiln_frame_range range = job->ranges[i];
        if (!pass_over_frames(job, next, range.first, error))
            return false;
        next = range.last + 1;
        for (uint32_t frame = range.first; frame <= range.last; frame++) {
            if (!kiln_job_draw(job, frame, error))
                return false;
        }
    }
    return true;
}

/* ---- before and after ------------------------------------------------------------------------ */

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
        job->total_frames += range.last - range.first + 1;
    }
    return true;
}

static bool open_output(struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_render_params *params = job->params;
    const struct kiln_scene *scene = job->scene;
    if (params->output) {
        job->output = kiln_output_open(
            &(struct kiln_output_params){
                .path = params->output,
                .width = scene->width,
                .height = scene->height,
                .fps_num = scene->fps.num,
                .fps_den = scene->fps.den,
                .alpha = scene->backdrop.transparent,
                .ranges = job->ranges,
                .range_count = job->range_count,
                .threads = kiln_threads_count(job->threads),
                .overwrite = params->overwrite,
                .png_bits = params->png_bits,
                .exr_bits = params->exr_bits,
                .quality = params->quality,
                .flipbook = params->flipbook,
                .scene_hash = scene->hash,
                .seed = scene->seed,
                .log = params->log,
                .caller = {may_go_on, job},
            },
            error);
        if (!job->output)
            return false;
    }
    if (params->manifest) {
        job->manifest = kiln_manifest_open(
            &(struct kiln_manifest_params){
                .path = params->manifest,
                .overwrite = params->overwrite,
                .scene = scene,
                .device = &job->device->info,
                .techniques = job->stats.techniques,
                .output = params->output,
            },
            error);
        return job->manifest != NULL;
    }
    return true;
}

static void init_pool(struct kiln_job *job)
{
    uint32_t capacities[KILN_MAX_SYSTEMS] = {0};
    uint64_t spins = 0;
    for (uint32_t i = 0; i < job->scene->system_count; i++) {
        capacities[i] = job->scene->systems[i].capacity;
        spins += kiln_scene_system_spins(job->scene, i) ? capacities[i] : 0;
    }
    kiln_pool_init(&job->run.pool, kiln_device_gl(job->device), capacities,
                   job->scene->system_count);
    job->stats.particle_capacity = job->run.pool.slot_count;
    const uint32_t slots = job->run.pool.slot_count;
    job->stats.particle_bytes =
        (uint64_t)slots * kiln_simulate_slot_bytes(job->techniques.simulate) +
        spins * sizeof(struct kiln_spin) +
        kiln_sort_bytes(job->techniques.sort, job->techniques.sort_spread > 0, slots);
}

/* What the device cannot draw. A software device advertises smaller storage blocks than it takes.
 */
static bool check_limits(const struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_device_info *device = &job->device->info;
    const struct kiln_scene *scene = job->scene;
    int64_t largest = device->max_texture_size;
    if ((int64_t)scene->width > largest || (int64_t)scene->height > largest)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "output.size: %u x %u pixels; %s draws up to %d a side", scene->width,
                              scene->height, device->name, device->max_texture_size);
    uint64_t particles = kiln_scene_info(scene).particle_capacity;
    uint64_t most = (uint64_t)device->max_storage_block_bytes / sizeof(struct kiln_particle);
    return device->software || particles <= most ||
           kiln_error_set(error, KILN_DEVICE_FAILED,
                          "systems: up to %" PRIu64 " particles at once; %s draws up to %" PRIu64,
                          particles, device->name, most);
}

static bool begin(struct kiln_job *job, struct kiln_error *error)
{
    const struct kiln_render_params *params = job->params;
    if (!choose_frames(job, error) || !kiln_device_make_current(job->device, error) ||
        !kiln_techniques_choose(&job->device->info, params->techniques, params->technique_count,
                                &job->techniques, error) ||
        !check_limits(job, error))
        return false;
    kiln_techniques_describe(&job->techniques, job->stats.techniques, sizeof job->stats.techniques);
    job->stats.choice_count = KILN_STAGE_COUNT;
    memcpy(job->stats.choices, job->techniques.choices, sizeof job->techniques.choices);
    job->device->work_group_size = params->work_group_size;
    job->threads = kiln_threads_create(params->threads);
    if (!job->threads)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "can not start %u threads",
                              params->threads);
    if (!open_output(job, error))
        return false;
    init_pool(job);
    return kiln_stages_init(&job->stages, kiln_device_gl(job->device), job->scene, &job->techniques,
                            output_needs(job), job->threads, &job->run.pool, error);
}

bool kiln_job_adopt(struct kiln_job *job, struct kiln_job *from, struct kiln_error *error)
{
    job->run.step = from->run.step;
    return kiln_pool_copy(&job->run.pool, &from->run.pool, error);
}

bool kiln_job_finish(struct kiln_job *job, struct kiln_render_stats *stats,
                     struct kiln_error *error)
{
    struct kiln_render_stats *s = &job->stats;
    if (!kiln_simulate_hash(job->stages.simulate, &job->run.pool, &s->state, &s->alive, error))
        return false;
    s->frames = job->progress.done;
    s->steps = job->run.step;
    if (job->output) {
        s->files = kiln_output_file_count(job->output);
        kiln_output_path(job->output, job->ranges[0].first, s->first_file, sizeof s->first_file);
        if (!kiln_output_finish(job->output, error))
            return false;
    }
    s->total_s = kiln_clock_seconds() - job->started_s;
    if (job->manifest && !kiln_manifest_finish(job->manifest, s, error))
        return false;
    *stats = *s;
    return true;
}

void kiln_job_destroy(struct kiln_job **job)
{
    struct kiln_job *j = *job;
    if (!j)
        return;
    kiln_manifest_close(&j->manifest);
    kiln_output_close(&j->output);
    kiln_stages_finish(&j->stages);
    j->device->work_group_size = 0;
    kiln_pool_finish(&j->run.pool);
    kiln_threads_destroy(&j->threads);
    free(j);
    *job = NULL;
}

struct kiln_job *kiln_job_create(struct kiln_device *device, const struct kiln_scene *scene,
                                 const struct kiln_render_params *params, struct kiln_error *error)
{
    struct kiln_job *job = calloc(1, sizeof *job);
    if (!job) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for a job");
        return NULL;
    }
    job->device = device;
    job->scene = scene;
    job->params = params;
    job->started_s = kiln_clock_seconds();
    if (!begin(job, error))
        kiln_job_destroy(&job);
    else
        job->stats.setup_s = kiln_clock_seconds() - job->started_s;
    return job;
}

bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_render_params *params, struct kiln_render_stats *stats,
                 struct kiln_error *error)
{
    struct kiln_render_stats done = {0};
    struct kiln_job *job = kiln_job_create(device, scene, params, error);
    bool ok = job && render_frames(job, error) && kiln_job_finish(job, &done, error);
    kiln_job_destroy(&job);
    if (stats)
        *stats = done;
    return ok;
}
