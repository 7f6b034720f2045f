/* Plans a clip: measures what a frame and a step cost, and divides the clip into tasks. */
#include <string.h>
#include <sys/resource.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/sized.h"
#include "job/hold.h"
#include "job/shard.h"
#include "job/states.h"
#include "job/stop.h"
#include "scene/instant.h"
#include "scene/motion.h"

struct planning {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_plan_params *params;
    struct kiln_stop stop;
    struct kiln_loop *loop;
    struct kiln_states *states; /* saved states to start from; NULL: none */
    struct kiln_plan *plan;
};

static uint64_t peak_memory(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

/* ---- measuring ------------------------------------------------------------------------------- */

static bool set_up(struct planning *p, struct kiln_error *error)
{
    const struct kiln_plan_params *params = p->params;
    const struct kiln_loop_params loop = {.techniques = params->techniques,
                                          .technique_count = params->technique_count,
                                          .threads = params->threads,
                                          .log = params->log,
                                          .caller = kiln_stop_caller(&p->stop)};
    const double before_s = kiln_clock_cpu_seconds();
    p->loop = kiln_loop_create(p->device, p->scene, &loop, error);
    if (!p->loop)
        return false;
    const struct kiln_techniques *techniques = kiln_loop_techniques(p->loop);
    kiln_techniques_describe(techniques, p->plan->techniques, sizeof p->plan->techniques);
    if (!kiln_scene_part_hash(p->scene, KILN_PART_MOTION, p->plan->motion, error))
        return false;
    if (params->states &&
        !(p->states = kiln_states_open(params->states, p->scene, techniques, &params->log, error)))
        return false;
    const struct kiln_output_needs needs = {.bits = 8};
    if (!kiln_loop_set_up(p->loop, needs, error))
        return false;
    p->plan->setup_cpu_s = kiln_clock_cpu_seconds() - before_s;
    return true;
}

/* Measures one frame and its steps. The frame is drawn twice, since the first drawing fills caches
 * that later frames use. Where no step led to the frame, the step to the next frame is measured. */
static bool measure(struct planning *p, struct kiln_error *error)
{
    struct kiln_plan *plan = p->plan;
    struct kiln_drawn drawn;
    if (p->states && !kiln_states_take_up(p->states, p->loop, plan->frame, error))
        return false;
    const double start_s = kiln_clock_cpu_seconds();
    if (!kiln_loop_advance(p->loop, plan->frame, error))
        return false;
    double stepping_s = kiln_clock_cpu_seconds() - start_s;
    plan->steps = kiln_loop_steps(p->loop);
    for (int turn = 0; turn < 2; turn++) {
        const double before_s = kiln_clock_cpu_seconds();
        if (!kiln_loop_draw(p->loop, plan->frame, false, &drawn, error))
            return false;
        plan->frame_cpu_s = kiln_clock_cpu_seconds() - before_s;
        kiln_picture_destroy(&drawn.picture);
    }
    plan->memory_bytes = peak_memory();
    if (plan->steps == 0) {
        const double again_s = kiln_clock_cpu_seconds();
        if (!kiln_loop_advance(p->loop, plan->frame + 1, error))
            return false;
        stepping_s = kiln_clock_cpu_seconds() - again_s;
        plan->steps = kiln_loop_steps(p->loop);
    }
    plan->step_cpu_s = plan->steps > 0 ? stepping_s / (double)plan->steps : 0.0;
    return true;
}

/* ---- tasks ----------------------------------------------------------------------------------- */

static struct kiln_plan_task task_of(const struct planning *p, uint32_t index)
{
    const struct kiln_scene *scene = p->scene;
    const struct kiln_plan *plan = p->plan;
    const struct kiln_shard shard = {index, p->params->tasks};
    struct kiln_plan_task task = {.size = sizeof task, .index = index, .count = p->params->tasks};
    kiln_shard_parts(shard, plan->parts, &task.first_part, &task.end);
    if (task.first_part == task.end)
        return task;
    task.frames = kiln_parts_frames(task.first_part, task.end, plan->part_frames, scene->frames);
    if (p->states) {
        const uint32_t start = kiln_scene_frame_step(scene, task.frames.first);
        task.has_state = kiln_states_find(p->states, start, &task.state_step);
    }
    task.steps = kiln_scene_last_step(scene, task.frames.last) - task.state_step;
    task.cpu_s = plan->setup_cpu_s + plan->step_cpu_s * (double)task.steps +
                 plan->frame_cpu_s * (task.frames.last - task.frames.first + 1.0);
    return task;
}

bool kiln_plan_tasks(struct kiln_device *device, const struct kiln_scene *scene,
                     const struct kiln_plan_params *given, struct kiln_plan *out,
                     struct kiln_error *error)
{
    struct kiln_plan_params params = kiln_plan_defaults();
    struct kiln_plan plan = kiln_plan_empty();
    if (!kiln_sized_take(&params, given, "kiln_plan_params", error) ||
        !kiln_sized_check(out, "kiln_plan", error) || !kiln_hold_take(device, scene, error))
        return false;
    struct planning planning = {
        .device = device,
        .scene = scene,
        .params = &params,
        .stop = {params.stop, params.user, device, scene->budget, params.cancel},
        .plan = &plan,
    };
    if (params.frame >= (int64_t)scene->frames) {
        kiln_hold_release(device, scene);
        return kiln_error_set(error, KILN_USAGE, "frame %lld: the scene has frames 0-%u",
                              (long long)params.frame, scene->frames - 1);
    }
    plan.frame = params.frame < 0 ? scene->frames / 2 : (uint32_t)params.frame;
    plan.part_frames = kiln_part_frames(scene->fps.num, scene->fps.den);
    plan.parts = (scene->frames - 1) / plan.part_frames + 1;
    const bool ok = set_up(&planning, error) && measure(&planning, error);
    for (uint32_t i = 0; ok && params.task && i < params.tasks; i++) {
        const struct kiln_plan_task task = task_of(&planning, i);
        params.task(params.user, &plan, &task);
    }
    kiln_sized_give(out, &plan);
    kiln_states_close(&planning.states);
    kiln_loop_destroy(&planning.loop);
    kiln_hold_release(device, scene);
    return ok;
}
