/* The frame loop: the file to read first.
 *
 * A job steps the simulation from its start to each wanted frame and draws it there. Undrawn frames
 * are stepped as well, so a frame is the same bytes in any chunk of the clip. The stages behind one
 * frame are in frame/stages.c.
 */
#include "frame/loop.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "frame/stages.h"
#include "output/manifest.h"
#include "sim/step/simulate.h"

struct kiln_loop {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_render_params *params;
    struct kiln_frame_range whole_clip; /* what an empty list of ranges means */
    const struct kiln_frame_range *ranges;
    size_t range_count;

    struct kiln_techniques techniques;
    struct kiln_threads *threads;
    struct kiln_run run;
    struct kiln_timer *timer;
    struct kiln_simulate *simulate;
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
static bool return_from_caller(const struct kiln_loop *loop, struct kiln_error *error)
{
    return kiln_device_make_current(loop->device, error);
}

/* False with KILN_INTERRUPTED when the caller wants no more. */
static bool may_go_on(void *user, struct kiln_error *error)
{
    const struct kiln_loop *loop = user;
    if (!loop->params->stop)
        return true;
    bool stop = loop->params->stop(loop->params->user);
    if (!return_from_caller(loop, error))
        return false;
    return !stop || kiln_error_set(error, KILN_INTERRUPTED, "stopped after %u of %u frames",
                                   loop->progress.done, loop->total_frames);
}

static bool step_to(struct kiln_loop *loop, uint32_t step, struct kiln_error *error)
{
    struct kiln_run *run = &loop->run;
    kiln_timer_begin(loop->timer, KILN_PASS_simulate);
    bool ok = true;
    while (ok && run->step < step) {
        ok = may_go_on(loop, error) &&
             kiln_simulate_step(loop->simulate, &run->pool, run->step + 1, error);
        if (ok)
            run->step++;
        const char *warning = kiln_simulate_warning(loop->simulate);
        if (ok && warning)
            kiln_log_write(&loop->params->log, KILN_LOG_WARNING, "%s: %s", loop->scene->name,
                           warning);
    }
    kiln_timer_end(loop->timer);
    return ok;
}

static struct kiln_output_needs output_needs(const struct kiln_loop *loop)
{
    if (loop->output)
        return kiln_output_needs(loop->output);
    return (struct kiln_output_needs){.bits = 8};
}

static bool write_picture(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    const struct kiln_scene *scene = loop->scene;
    struct kiln_output_needs needs = output_needs(loop);
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    uint32_t layers = needs.layers ? kiln_stages_layers(names, channels) : 0;
    struct kiln_picture *picture = kiln_picture_create(scene->width, scene->height, needs.bits,
                                                       names, channels, layers, error);
    if (!picture)
        return false;
    picture->frame = frame;
    picture->has_alpha = scene->backdrop.transparent;
    if (!kiln_stages_read(&loop->stages, picture, error)) {
        kiln_picture_destroy(&picture);
        return false;
    }
    if (!loop->output) {
        if (loop->params->picture)
            loop->params->picture(loop->params->user, frame, picture->display);
        kiln_picture_destroy(&picture);
        return return_from_caller(loop, error);
    }
    return kiln_output_write(loop->output, picture, error);
}

static bool report_frame(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    struct kiln_progress *p = &loop->progress;
    p->frame = frame;
    p->done++;
    p->total = loop->total_frames;
    p->elapsed_s = kiln_clock_seconds() - loop->started_s;
    p->eta_s = p->elapsed_s / p->done * (p->total - p->done);
    for (int i = 0; i < KILN_PASS_COUNT; i++)
        loop->stats.pass_ms[i] += p->pass_ms[i];
    char path[KILN_PATH_SIZE] = "";
    bool written = loop->output && kiln_output_path(loop->output, frame, path, sizeof path);
    if (loop->manifest && !kiln_manifest_add(loop->manifest, p, written ? path : NULL, error))
        return false;
    if (!loop->params->progress)
        return true;
    loop->params->progress(loop->params->user, p);
    return return_from_caller(loop, error);
}

/* All moments of a frame while the shutter is open: one, unless the scene asks for more. */
static bool draw_moments(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    for (uint32_t sample = 0; sample < loop->scene->camera.shutter_samples; sample++) {
        uint32_t drawn = 0;
        if (!step_to(loop, kiln_scene_moment_step(loop->scene, frame, sample), error) ||
            !kiln_stages_draw(&loop->stages, &loop->run.pool, loop->run.step, sample, &drawn,
                              error))
            return false;
        if (sample == 0)
            loop->progress.alive = drawn;
    }
    return true;
}

bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    if (!may_go_on(loop, error) || !step_to(loop, kiln_scene_frame_step(loop->scene, frame), error))
        return false;

    struct kiln_pool *pool = &loop->run.pool;
    if (loop->params->state_hash || loop->manifest) {
        uint64_t alive = 0;
        if (!kiln_simulate_hash(loop->simulate, pool, &loop->progress.state, &alive, error))
            return false;
    }
    if (!draw_moments(loop, frame, error) || !kiln_stages_compose(&loop->stages, frame, error))
        return false;

    double before_s = kiln_clock_seconds();
    if (!write_picture(loop, frame, error))
        return false;
    double output_ms = 1e3 * (kiln_clock_seconds() - before_s);
    kiln_timer_collect(loop->timer, loop->progress.pass_ms);
    output_ms -= loop->progress.pass_ms[KILN_PASS_readback];
    loop->progress.pass_ms[KILN_PASS_output] = output_ms > 0.0 ? output_ms : 0.0;
    return report_frame(loop, frame, error);
}

/* Frames that are not drawn, where they matter to later ones for more than their steps. */
static bool pass_over_frames(struct kiln_loop *loop, uint32_t first, uint32_t end,
                             struct kiln_error *error)
{
    if (!kiln_stages_keep_history(&loop->stages))
        return true;
    for (uint32_t frame = first; frame < end; frame++)
        for (uint32_t sample = 0; sample < loop->scene->camera.shutter_samples; sample++) {
            uint32_t step = kiln_scene_moment_step(loop->scene, frame, sample);
            if (!step_to(loop, step, error) ||
                !kiln_stages_pass_over(&loop->stages, &loop->run.pool, loop->run.step, error))
                return false;
        }
    return true;
}

bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    return step_to(loop, kiln_scene_frame_step(loop->scene, frame), error);
}

const struct kiln_progress *kiln_loop_progress(const struct kiln_loop *loop)
{
    return &loop->progress;
}

static bool render_frames(struct kiln_loop *loop, struct kiln_error *error)
{
    uint32_t next = 0;
    for (size_t i = 0; i < loop->range_count; i++) {
        struct kiln_frame_range range = loop->ranges[i];
        if (!pass_over_frames(loop, next, range.first, error))
            return false;
        next = range.last + 1;
        for (uint32_t frame = range.first; frame <= range.last; frame++) {
            if (!kiln_loop_draw(loop, frame, error))
                return false;
        }
    }
    return true;
}

/* ---- before and after ------------------------------------------------------------------------ */

static bool choose_frames(struct kiln_loop *loop, struct kiln_error *error)
{
    loop->ranges = loop->params->ranges;
    loop->range_count = loop->params->range_count;
    if (loop->range_count == 0) {
        loop->whole_clip = (struct kiln_frame_range){0, loop->scene->frames - 1};
        loop->ranges = &loop->whole_clip;
        loop->range_count = 1;
    }
    uint64_t next = 0;
    for (size_t i = 0; i < loop->range_count; i++) {
        struct kiln_frame_range range = loop->ranges[i];
        if (range.first > range.last || range.first < next || range.last >= loop->scene->frames)
            return kiln_error_set(error, KILN_USAGE,
                                  "frames %u-%u: expected ascending ranges within 0-%u",
                                  range.first, range.last, loop->scene->frames - 1);
        next = (uint64_t)range.last + 1;
        loop->total_frames += range.last - range.first + 1;
    }
    return true;
}

/* No file of the job is written twice, or written and read. */
static bool check_files(const struct kiln_loop *loop, struct kiln_error *error)
{
    struct kiln_claims *claims = kiln_claims_create();
    bool ok = claims ? kiln_render_claim(loop->scene, loop->params, claims, error)
                     : kiln_error_set(error, KILN_DEVICE_FAILED, "files of the job: out of memory");
    kiln_claims_destroy(&claims);
    return ok;
}

static bool open_output(struct kiln_loop *loop, struct kiln_error *error)
{
    const struct kiln_render_params *params = loop->params;
    const struct kiln_scene *scene = loop->scene;
    if (!check_files(loop, error))
        return false;
    if (params->output) {
        loop->output = kiln_output_open(
            &(struct kiln_output_params){
                .path = params->output,
                .width = scene->width,
                .height = scene->height,
                .fps_num = scene->fps.num,
                .fps_den = scene->fps.den,
                .alpha = scene->backdrop.transparent,
                .ranges = loop->ranges,
                .range_count = loop->range_count,
                .threads = kiln_threads_count(loop->threads),
                .overwrite = params->overwrite,
                .png_bits = params->png_bits,
                .exr_bits = params->exr_bits,
                .quality = params->quality,
                .flipbook = params->flipbook,
                .scene_hash = scene->hash,
                .seed = scene->seed,
                .log = params->log,
                .caller = {may_go_on, loop},
            },
            error);
        if (!loop->output)
            return false;
    }
    if (params->manifest) {
        loop->manifest = kiln_manifest_open(
            &(struct kiln_manifest_params){
                .path = params->manifest,
                .overwrite = params->overwrite,
                .scene = scene,
                .device = &loop->device->info,
                .techniques = loop->stats.techniques,
                .output = params->output,
            },
            error);
        return loop->manifest != NULL;
    }
    return true;
}

static void init_pool(struct kiln_loop *loop)
{
    uint32_t capacities[KILN_MAX_SYSTEMS] = {0};
    uint64_t spins = 0;
    for (uint32_t i = 0; i < loop->scene->system_count; i++) {
        capacities[i] = loop->scene->systems[i].capacity;
        spins += kiln_scene_system_spins(loop->scene, i) ? capacities[i] : 0;
    }
    kiln_pool_init(&loop->run.pool, kiln_device_gl(loop->device), capacities,
                   loop->scene->system_count);
    loop->stats.particle_capacity = loop->run.pool.slot_count;
    const uint32_t slots = loop->run.pool.slot_count;
    loop->stats.particle_bytes =
        (uint64_t)slots * kiln_simulate_slot_bytes(loop->techniques.simulate) +
        spins * sizeof(struct kiln_spin) +
        kiln_sort_bytes(loop->techniques.sort, loop->techniques.sort_spread > 0, slots);
}

/* What the device cannot draw. A software device advertises smaller storage blocks than it takes.
 */
static bool check_limits(const struct kiln_loop *loop, struct kiln_error *error)
{
    const struct kiln_device_info *device = &loop->device->info;
    const struct kiln_scene *scene = loop->scene;
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

static bool begin(struct kiln_loop *loop, struct kiln_error *error)
{
    const struct kiln_render_params *params = loop->params;
    if (!choose_frames(loop, error) || !kiln_device_make_current(loop->device, error) ||
        !kiln_techniques_choose(&loop->device->info, params->techniques, params->technique_count,
                                &loop->techniques, error) ||
        !check_limits(loop, error))
        return false;
    kiln_techniques_describe(&loop->techniques, loop->stats.techniques,
                             sizeof loop->stats.techniques);
    loop->stats.choice_count = KILN_STAGE_COUNT;
    memcpy(loop->stats.choices, loop->techniques.choices, sizeof loop->techniques.choices);
    loop->device->work_group_size = params->work_group_size;
    loop->threads = kiln_threads_create(params->threads);
    if (!loop->threads)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "can not start %u threads",
                              params->threads);
    if (!open_output(loop, error))
        return false;
    init_pool(loop);
    struct kiln_device *device = kiln_device_gl(loop->device);
    loop->timer = kiln_timer_create(device);
    if (!loop->timer)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "timers: out of memory");
    loop->simulate =
        kiln_simulate_create(device, loop->scene, loop->techniques.simulate, loop->threads, error);
    const struct kiln_stages_params stages = {.techniques = loop->techniques,
                                              .needs = output_needs(loop),
                                              .threads = loop->threads,
                                              .timer = loop->timer,
                                              .slot_count = loop->run.pool.slot_count};
    return loop->simulate && kiln_stages_init(&loop->stages, device, loop->scene, &stages, error);
}

bool kiln_loop_adopt(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error)
{
    loop->run.step = from->run.step;
    return kiln_pool_copy(&loop->run.pool, &from->run.pool, error);
}

bool kiln_loop_finish(struct kiln_loop *loop, struct kiln_render_stats *stats,
                      struct kiln_error *error)
{
    struct kiln_render_stats *s = &loop->stats;
    if (!kiln_simulate_hash(loop->simulate, &loop->run.pool, &s->state, &s->alive, error))
        return false;
    s->frames = loop->progress.done;
    s->steps = loop->run.step;
    if (loop->output) {
        s->files = kiln_output_file_count(loop->output);
        kiln_output_path(loop->output, loop->ranges[0].first, s->first_file, sizeof s->first_file);
        if (!kiln_output_finish(loop->output, error))
            return false;
    }
    s->total_s = kiln_clock_seconds() - loop->started_s;
    if (loop->manifest && !kiln_manifest_finish(loop->manifest, s, error))
        return false;
    *stats = *s;
    return true;
}

void kiln_loop_destroy(struct kiln_loop **loop)
{
    struct kiln_loop *j = *loop;
    if (!j)
        return;
    kiln_manifest_close(&j->manifest);
    kiln_output_close(&j->output);
    kiln_stages_finish(&j->stages);
    kiln_simulate_destroy(&j->simulate);
    kiln_timer_destroy(&j->timer);
    j->device->work_group_size = 0;
    kiln_pool_finish(&j->run.pool);
    kiln_threads_destroy(&j->threads);
    free(j);
    *loop = NULL;
}

struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_render_params *params,
                                   struct kiln_error *error)
{
    struct kiln_loop *loop = calloc(1, sizeof *loop);
    if (!loop) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for a job");
        return NULL;
    }
    loop->device = device;
    loop->scene = scene;
    loop->params = params;
    loop->started_s = kiln_clock_seconds();
    if (!begin(loop, error))
        kiln_loop_destroy(&loop);
    else
        loop->stats.setup_s = kiln_clock_seconds() - loop->started_s;
    return loop;
}

bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_render_params *params, struct kiln_render_stats *stats,
                 struct kiln_error *error)
{
    struct kiln_render_stats done = {0};
    struct kiln_loop *loop = kiln_loop_create(device, scene, params, error);
    bool ok = loop && render_frames(loop, error) && kiln_loop_finish(loop, &done, error);
    kiln_loop_destroy(&loop);
    if (stats)
        *stats = done;
    return ok;
}
