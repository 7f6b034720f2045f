/* This file runs the frame loop: it steps the simulation to each wanted frame and draws the frame.
 * It is a good file to begin with when reading the code.
 *
 * Frames that are not drawn are simulated as well, so a frame has the same bytes in any chunk of
 * the clip. frame/stages.c runs the stages that draw one frame. job/job.c chooses the frames and
 * writes the pictures. */
#include "frame/loop.h"

#include <assert.h>
#include <inttypes.h>
#include <stdlib.h>

#include "asset/loader/loader.h"
#include "base/error.h"
#include "base/log.h"
#include "frame/sizes.h"
#include "frame/stages.h"
#include "scene/family.h"
#include "scene/instant.h"
#include "scene/pool_layout.h"
#include "scene/work.h"
#include "sim/step/simulate.h"

struct kiln_loop {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_loop_params params;

    struct kiln_techniques techniques;
    struct kiln_threads *threads;
    struct kiln_output_needs needs; /* what the output needs of each picture */
    struct kiln_timer *timer;
    struct kiln_simulate *simulate;
    struct kiln_stages stages;
    struct kiln_spare_pictures *spares;

    struct kiln_run run;
    struct kiln_pool before; /* particles after before_step steps, for moments within a step */
    uint32_t before_step;
    uint32_t
        next_frame; /* all frames before this one have updated the state that later frames need */
    uint64_t steps; /* simulation steps that this loop has run */
};

/* ---- the loop -------------------------------------------------------------------------------- */

static bool step_to(struct kiln_loop *loop, uint32_t step, struct kiln_error *error)
{
    struct kiln_run *run = &loop->run;
    kiln_timer_begin(loop->timer, KILN_PASS_simulate);
    bool ok = true;
    while (ok && run->step < step) {
        ok = kiln_may_go_on(&loop->params.caller, error) &&
             kiln_simulate_step(loop->simulate, &run->pool, run->step + 1, error);
        if (ok) {
            run->step++;
            loop->steps++;
        }
        const char *warning = kiln_simulate_warning(loop->simulate);
        if (ok && warning)
            kiln_log_write(&loop->params.log, KILN_LOG_WARNING, "%s: %s", loop->scene->name,
                           warning);
    }
    kiln_timer_end(loop->timer);
    return ok;
}

/* Steps to an instant, and keeps the particles before its last step if it lies within that step. An
 * earlier moment of the frame may have stepped as far and kept them already. */
static bool step_to_instant(struct kiln_loop *loop, struct kiln_instant instant,
                            struct kiln_error *error)
{
    struct kiln_run *run = &loop->run;
    if (instant.back > 0.0f && run->step < instant.step) {
        if (!step_to(loop, instant.step - 1, error) ||
            !kiln_pool_copy_particles(&loop->before, &run->pool, error))
            return false;
        loop->before_step = run->step;
    }
    return step_to(loop, instant.step, error);
}

/* Steps to a moment of a frame. At the clip's first instant it shows the particles of bursts at
 * exactly 0 s, too, which the next step gives birth to. They are not part of the state:
 * leave_moment removes them again. */
static bool enter_moment(struct kiln_loop *loop, struct kiln_instant instant,
                         struct kiln_error *error)
{
    const bool is_first = instant.back == 0.0f && instant.step == loop->scene->warmup_steps;
    return step_to_instant(loop, instant, error) &&
           (!is_first ||
            kiln_simulate_show_births(loop->simulate, &loop->run.pool, loop->run.step, error));
}

static bool leave_moment(struct kiln_loop *loop, struct kiln_error *error)
{
    return kiln_simulate_hide_births(loop->simulate, &loop->run.pool, error);
}

/* Advances to frame `end` without drawing. If a stage keeps a history, the skipped frames advance
 * it. */
static bool skip_frames(struct kiln_loop *loop, uint32_t end, struct kiln_error *error)
{
    const bool keeps_history = loop->stages.history.kind != NULL;
    for (; keeps_history && loop->next_frame < end; loop->next_frame++)
        for (uint32_t moment = 0; moment < kiln_scene_moment_count(loop->scene); moment++) {
            const struct kiln_instant instant =
                kiln_scene_instant(loop->scene, loop->next_frame, moment);
            if (!enter_moment(loop, instant, error) ||
                !kiln_stages_skip_moment(&loop->stages, &loop->before, &loop->run.pool, instant,
                                         error) ||
                !leave_moment(loop, error))
                return false;
        }
    loop->next_frame = end;
    return true;
}

bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error)
{
    return kiln_may_go_on(&loop->params.caller, error) && skip_frames(loop, frame, error) &&
           step_to(loop, kiln_scene_frame_step(loop->scene, frame), error);
}

/* Draws all moments of a frame. hash: also compute the hash of the state at the first one. */
static bool draw_moments(struct kiln_loop *loop, uint32_t frame, bool hash,
                         struct kiln_drawn *drawn, struct kiln_error *error)
{
    for (uint32_t moment = 0; moment < kiln_scene_moment_count(loop->scene); moment++) {
        const struct kiln_instant instant = kiln_scene_instant(loop->scene, frame, moment);
        uint32_t count = 0;
        if (!enter_moment(loop, instant, error) ||
            (hash && moment == 0 && !kiln_loop_hash(loop, &drawn->state, &drawn->alive, error)))
            return false;
        assert(instant.back == 0.0f || loop->before_step + 1 == instant.step);
        if (!kiln_stages_draw(&loop->stages, &loop->before, &loop->run.pool, instant, moment,
                              &count, error) ||
            !leave_moment(loop, error))
            return false;
        if (moment == 0)
            drawn->alive = count;
    }
    loop->next_frame = frame + 1;
    return true;
}

static bool read_picture(struct kiln_loop *loop, uint32_t frame, struct kiln_drawn *drawn,
                         struct kiln_error *error)
{
    const struct kiln_scene *scene = loop->scene;
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    const uint32_t all = kiln_stages_layers(kiln_volume_domains(scene) > 0, names, channels);
    const uint32_t layers[] = {
        [KILN_LAYERS_NONE] = 0, [KILN_LAYERS_BEAUTY] = 1, [KILN_LAYERS_ALL] = all};
    struct kiln_picture *picture = kiln_spare_pictures_take(loop->spares);
    if (!picture) {
        picture = kiln_picture_create(scene->width, scene->height, loop->needs.bits, names,
                                      channels, layers[loop->needs.layers], error);
        if (!picture)
            return false;
        kiln_spare_pictures_add(loop->spares, picture);
    }
    drawn->picture = picture;
    picture->frame = frame;
    picture->has_alpha = scene->backdrop.transparent;
    if (kiln_stages_read(&loop->stages, picture, error))
        return true;
    kiln_picture_destroy(&drawn->picture);
    return false;
}

bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, bool hash, struct kiln_drawn *drawn,
                    struct kiln_error *error)
{
    *drawn = (struct kiln_drawn){.picture = NULL};
    if (!kiln_loop_advance(loop, frame, error) || !draw_moments(loop, frame, hash, drawn, error) ||
        !kiln_stages_compose(&loop->stages, frame, error) ||
        !read_picture(loop, frame, drawn, error))
        return false;
    kiln_timer_collect(loop->timer, drawn->pass_ms);
    return true;
}

/* ---- the state ------------------------------------------------------------------------------- */

struct kiln_run *kiln_loop_run(struct kiln_loop *loop)
{
    return &loop->run;
}

void kiln_loop_set_frame(struct kiln_loop *loop, uint32_t frame)
{
    loop->next_frame = frame;
}

bool kiln_loop_copy_state(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error)
{
    loop->run.step = from->run.step;
    loop->next_frame = from->next_frame;
    return kiln_pool_copy(&loop->run.pool, &from->run.pool, error);
}

bool kiln_loop_count_first(struct kiln_loop *loop, uint64_t *alive, struct kiln_error *error)
{
    struct kiln_state_hash ignored;
    const struct kiln_instant instant = {.step = loop->scene->warmup_steps};
    return enter_moment(loop, instant, error) && kiln_loop_hash(loop, &ignored, alive, error) &&
           leave_moment(loop, error);
}

bool kiln_loop_hash(struct kiln_loop *loop, struct kiln_state_hash *hash, uint64_t *alive,
                    struct kiln_error *error)
{
    return kiln_simulate_hash(loop->simulate, &loop->run.pool, hash, alive, error);
}

/* ---- before and after ------------------------------------------------------------------------ */

/* Returns false with an error if the scene is too large for the device. The storage block size is
 * not checked on a software device, which supports larger blocks than it reports. */
static bool check_limits(const struct kiln_loop *loop, struct kiln_error *error)
{
    const struct kiln_device_info *device = &loop->device->info;
    const struct kiln_scene *scene = loop->scene;
    int64_t largest = device->max_texture_size;
    if ((int64_t)scene->width > largest || (int64_t)scene->height > largest)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "output.size: found %u x %u pixels; %s draws up to %d a side",
                              scene->width, scene->height, device->name, device->max_texture_size);
    uint64_t particles = kiln_work_particles(scene);
    uint64_t most = (uint64_t)device->max_storage_block_bytes / sizeof(struct kiln_particle);
    return device->software || particles <= most ||
           kiln_error_set(error, KILN_DEVICE_FAILED,
                          "systems: found up to %" PRIu64
                          " particles at once; %s draws up to %" PRIu64,
                          particles, device->name, most);
}

struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_loop_params *params, struct kiln_error *error)
{
    struct kiln_loop *loop = calloc(1, sizeof *loop);
    if (!loop) {
        kiln_error_no_memory(error, "a frame loop");
        return NULL;
    }
    loop->device = device;
    loop->scene = scene;
    loop->params = *params;
    bool ok = kiln_device_make_current(device, error) &&
              kiln_techniques_choose(&device->info, params->techniques, params->technique_count,
                                     &loop->techniques, error) &&
              kiln_sizes_check(scene, &loop->techniques, error) && check_limits(loop, error);
    device->work_group_size = params->work_group_size;
    loop->threads = ok ? kiln_threads_create(params->threads) : NULL;
    if (ok && !loop->threads)
        kiln_error_set(error, KILN_DEVICE_FAILED, "no threads can be started");
    if (!loop->threads)
        kiln_loop_destroy(&loop);
    else
        kiln_threads_set_caller(loop->threads, &loop->params.caller);
    return loop;
}

/* The pool of the state before a step keeps neither paint nor gas. */
static bool init_pools(struct kiln_loop *loop, struct kiln_error *error)
{
    struct kiln_device *device = kiln_device_gl(loop->device);
    struct kiln_pool_layout layout = kiln_scene_pool_layout(loop->scene);
    if (!kiln_pool_init(&loop->run.pool, device, &layout, error))
        return false;
    layout.canvas_count = 0;
    layout.gas_count = 0;
    return kiln_pool_init(&loop->before, device, &layout, error);
}

bool kiln_loop_set_up(struct kiln_loop *loop, struct kiln_output_needs needs,
                      struct kiln_error *error)
{
    struct kiln_device *device = kiln_device_gl(loop->device);
    loop->needs = needs;
    if (!init_pools(loop, error))
        return false;
    loop->timer = kiln_timer_create(device);
    if (!loop->timer)
        return kiln_error_no_memory(error, "the timers");
    loop->spares = kiln_spare_pictures_create();
    if (!loop->spares)
        return kiln_error_no_memory(error, "pictures");
    loop->simulate = kiln_simulate_create(device, loop->scene, loop->techniques.simulate,
                                          loop->techniques.gas, loop->threads, error);
    const struct kiln_stages_params stages = {.techniques = loop->techniques,
                                              .needs = needs,
                                              .threads = loop->threads,
                                              .timer = loop->timer,
                                              .caller = &loop->params.caller,
                                              .slot_count = loop->run.pool.slot_count};
    const bool ok =
        loop->simulate && kiln_stages_init(&loop->stages, device, loop->scene, &stages, error);
    kiln_loader_rest(loop->scene->loader); /* no file of the scene is read after this call */
    return ok;
}

void kiln_loop_destroy(struct kiln_loop **loop)
{
    struct kiln_loop *l = *loop;
    if (!l)
        return;
    kiln_stages_finish(&l->stages);
    kiln_simulate_destroy(&l->simulate);
    kiln_timer_destroy(&l->timer);
    kiln_spare_pictures_destroy(&l->spares);
    l->device->work_group_size = 0;
    kiln_pool_finish(&l->run.pool);
    kiln_pool_finish(&l->before);
    kiln_threads_destroy(&l->threads);
    free(l);
    *loop = NULL;
}

const struct kiln_techniques *kiln_loop_techniques(const struct kiln_loop *loop)
{
    return &loop->techniques;
}

struct kiln_threads *kiln_loop_threads(struct kiln_loop *loop)
{
    return loop->threads;
}

struct kiln_timer *kiln_loop_timer(struct kiln_loop *loop)
{
    return loop->timer;
}

const struct kiln_history *kiln_loop_history(const struct kiln_loop *loop)
{
    return &loop->stages.history;
}

uint64_t kiln_loop_steps(const struct kiln_loop *loop)
{
    return loop->steps;
}

uint64_t kiln_loop_particle_bytes(const struct kiln_loop *loop)
{
    const struct kiln_techniques *techniques = &loop->techniques;
    const uint32_t slots = loop->run.pool.slot_count;
    uint64_t spins = 0;
    for (uint32_t i = 0; i < loop->scene->system_count; i++)
        spins += ((uint64_t)kiln_scene_system_spins(loop->scene, i) +
                  kiln_family_travels(loop->scene, i)) *
                 loop->scene->systems[i].capacity;
    const size_t between =
        kiln_scene_has_instants_between(loop->scene) ? 2 * sizeof(struct kiln_particle) : 0;
    return (uint64_t)slots * (kiln_simulate_slot_bytes(techniques->simulate) + between) +
           spins * sizeof(struct kiln_spin) + kiln_sort_bytes(techniques->sort, slots);
}
