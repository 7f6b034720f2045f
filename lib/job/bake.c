/* Steps a scene through its clip once and saves states of the simulation at regular frames, from
 * which later runs can start. */
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/budget.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/sized.h"
#include "base/temporary.h"
#include "job/hold.h"
#include "job/states.h"
#include "job/stop.h"

struct bake {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_bake_params *params;
    struct kiln_stop stop;
    struct kiln_loop *loop;
    struct kiln_states *states;
    uint32_t every;
    struct kiln_baked baked; /* the last state of the folder, saved by this run or found there */
    struct kiln_bake_stats stats;
};

/* Returns the first frame before which a state is saved. Without warm-up steps that is not frame 0,
 * since there is nothing to save before the first step. */
static uint32_t first_frame(const struct bake *bake)
{
    return bake->scene->warmup_steps > 0 ? 0 : bake->every;
}

static uint32_t count_states(const struct bake *bake)
{
    const uint32_t first = first_frame(bake), frames = bake->scene->frames;
    return first < frames ? (frames - 1 - first) / bake->every + 1 : 0;
}

/* Checks before the first step that no file has the name of a state, since a run may take hours. */
static bool check_files(const struct bake *bake, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (bake->params->overwrite || bake->params->resume)
        return true;
    for (uint64_t frame = first_frame(bake); frame < bake->scene->frames; frame += bake->every) {
        const uint32_t step = kiln_scene_frame_step(bake->scene, (uint32_t)frame);
        if (!kiln_states_path(bake->states, step, path, error) ||
            !kiln_target_check(path, false, error))
            return false;
    }
    return true;
}

/* Returns whether the state of this step has been saved before and can stay as it is. */
static bool is_saved(const struct bake *bake, uint32_t step)
{
    struct kiln_error reason = {0};
    uint32_t found;
    return bake->params->resume && kiln_states_find(bake->states, step, &found) && found == step &&
           kiln_states_check(bake->states, step, &reason);
}

static bool save(struct bake *bake, uint32_t frame, uint32_t step, struct kiln_error *error)
{
    const bool resume = bake->params->resume;
    uint32_t found;
    if (resume && kiln_states_find(bake->states, step, &found) &&
        !kiln_states_take_up(bake->states, bake->loop, frame, error))
        return false;
    return kiln_loop_advance(bake->loop, frame, error) &&
           kiln_states_save(bake->states, bake->loop, frame, resume || bake->params->overwrite,
                            &bake->baked.alive, error);
}

static bool visit_frame(struct bake *bake, uint32_t frame, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_baked *baked = &bake->baked;
    struct stat status = {0};
    baked->frame = frame;
    baked->step = kiln_scene_frame_step(bake->scene, frame);
    baked->kept = is_saved(bake, baked->step);
    if (!kiln_stop_ask(&bake->stop, error) ||
        (!baked->kept && !save(bake, frame, baked->step, error)) ||
        !kiln_states_path(bake->states, baked->step, path, error))
        return false;
    baked->bytes = stat(path, &status) == 0 ? (uint64_t)status.st_size : 0;
    if (!baked->kept &&
        !kiln_budget_take(bake->scene->budget, KILN_LIMIT_output, baked->bytes, path, error)) {
        unlink(path);
        return false;
    }
    baked->file = path;
    baked->done++;
    bake->stats.states++;
    bake->stats.kept += baked->kept;
    bake->stats.bytes += baked->kept ? 0 : baked->bytes;
    if (bake->params->saved)
        bake->params->saved(bake->params->user, baked);
    baked->file = NULL;
    return kiln_device_make_current(bake->device, error);
}

static bool begin(struct bake *bake, struct kiln_error *error)
{
    const struct kiln_bake_params *params = bake->params;
    const struct kiln_loop_params loop = {.techniques = params->techniques,
                                          .technique_count = params->technique_count,
                                          .threads = params->threads,
                                          .log = params->log,
                                          .caller = kiln_stop_caller(&bake->stop)};
    const struct kiln_output_needs needs = {.bits = 8};
    const struct kiln_scene *scene = bake->scene;
    char inside[KILN_PATH_SIZE];
    bake->every = params->every ? params->every : kiln_part_frames(scene->fps.num, scene->fps.den);
    bake->baked.frames = count_states(bake);
    snprintf(inside, sizeof inside, "%s/", params->states);
    if (!kiln_make_parent_folders(inside, error))
        return false;
    kiln_temporary_sweep(inside);
    bake->loop = kiln_loop_create(bake->device, scene, &loop, error);
    if (!bake->loop)
        return false;
    bake->states = kiln_states_open(params->states, scene, kiln_loop_techniques(bake->loop),
                                    &params->log, error);
    if (!bake->states || !check_files(bake, error))
        return false;
    memcpy(bake->stats.motion, kiln_states_motion(bake->states), sizeof bake->stats.motion);
    return kiln_loop_set_up(bake->loop, needs, error);
}

bool kiln_bake(struct kiln_device *device, const struct kiln_scene *scene,
               const struct kiln_bake_params *given, struct kiln_bake_stats *stats,
               struct kiln_error *error)
{
    const double started_s = kiln_clock_seconds();
    struct kiln_bake_params params = kiln_bake_defaults();
    if (!kiln_sized_take(&params, given, "kiln_bake_params", error) ||
        !kiln_sized_check(stats, "kiln_bake_stats", error) || !kiln_hold_take(device, scene, error))
        return false;
    struct bake bake = {
        .device = device,
        .scene = scene,
        .params = &params,
        .stop = {params.stop, params.user, device, scene->budget, params.cancel},
        .baked.size = sizeof bake.baked,
        .stats = kiln_bake_stats_empty(),
    };
    bool ok = begin(&bake, error);
    for (uint64_t frame = first_frame(&bake); frame < scene->frames && ok; frame += bake.every)
        ok = visit_frame(&bake, (uint32_t)frame, error);
    bake.stats.steps = bake.loop ? kiln_loop_steps(bake.loop) : 0;
    bake.stats.total_s = kiln_clock_seconds() - started_s;
    kiln_states_close(&bake.states);
    kiln_loop_destroy(&bake.loop);
    kiln_hold_release(device, scene);
    kiln_sized_give(stats, &bake.stats);
    return ok;
}
