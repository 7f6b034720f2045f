/* Plans a clip: measures what frames and steps cost, and divides the clip into tasks. The frames
 * are those with the least and the most work, as the births of the scene tell it. The costs of all
 * other frames lie between, by their work. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/sized.h"
#include "job/hold.h"
#include "job/shard.h"
#include "job/states.h"
#include "job/stop.h"
#include "job/workload.h"
#include "scene/instant.h"
#include "scene/motion.h"

/* To measure a frame, so many frames after it are drawn, unless those before took so long. */
static const double LONG_FRAME_S = 2.0;
enum { LATER_FRAMES = 3 };

/* A sample is the time that was measured for some work of struct kiln_workload. */
struct sample {
    double work, cpu_s;
};

/* Steps that were measured: those after `from`, up to `to`. */
struct span {
    uint32_t from, to;
    double cpu_s;
};

struct planning {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_plan_params *params;
    struct kiln_stop stop;
    struct kiln_loop *loop;
    struct kiln_states *states; /* saved states to start from; NULL: none */
    struct kiln_workload *workload;
    struct sample frames[2]; /* by their work; the last is that of plan->frame */
    uint32_t frame_count;
    struct sample steps; /* all that were measured */
    /* the same by frame, of scenes with gas, whose steps depend on where the gas went */
    struct span *spans;
    uint32_t span_count;
    uint32_t next_frame; /* the first one that was not advanced to */
    double caches_cpu_s; /* what frames that filled caches took more than others */
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
    p->plan->setup_cpu_s = p->scene->loading_cpu_s + kiln_clock_cpu_seconds() - before_s;
    return true;
}

/* Advances to a frame, and measures the steps. */
static bool advance_at_once(struct planning *p, uint32_t frame, struct kiln_error *error)
{
    const uint64_t steps = kiln_loop_steps(p->loop);
    const double before_s = kiln_clock_cpu_seconds();
    if (!kiln_loop_advance(p->loop, frame, error))
        return false;
    const uint32_t end = kiln_scene_frame_step(p->scene, frame);
    const uint32_t count = (uint32_t)(kiln_loop_steps(p->loop) - steps);
    const double cpu_s = kiln_clock_cpu_seconds() - before_s;
    p->steps.cpu_s += cpu_s;
    p->steps.work += kiln_workload_steps(p->workload, end - count, end);
    p->plan->steps += count;
    if (p->spans && count > 0)
        p->spans[p->span_count++] = (struct span){end - count, end, cpu_s};
    return true;
}

static bool advance(struct planning *p, uint32_t frame, struct kiln_error *error)
{
    for (; p->spans && p->next_frame < frame; p->next_frame++) {
        /* a saved state may lie behind some frames */
        const uint32_t end = kiln_scene_frame_step(p->scene, p->next_frame);
        if (end > kiln_loop_run(p->loop)->step && !advance_at_once(p, p->next_frame, error))
            return false;
    }
    p->next_frame = frame + 1;
    return advance_at_once(p, frame, error);
}

/* Draws a frame and measures that. */
static bool draw(struct planning *p, uint32_t frame, struct sample *sample,
                 struct kiln_error *error)
{
    struct kiln_drawn drawn;
    const double before_s = kiln_clock_cpu_seconds();
    if (!kiln_loop_draw(p->loop, frame, false, &drawn, error))
        return false;
    *sample = (struct sample){kiln_workload_frame(p->workload, frame),
                              kiln_clock_cpu_seconds() - before_s};
    kiln_picture_destroy(&drawn.picture);
    return true;
}

static bool takes_less(const struct sample *a, const struct sample *b)
{
    return a->cpu_s * b->work < b->cpu_s * a->work;
}

/* Measures a frame by those after it, before another frame that is given, with about as much work:
 * the middle one of three in its time for its work, and the lesser of two, since one may have
 * waited for memory. The first drawing also fills caches, which later frames use; what it takes
 * more is counted once. The same frame again would take less: shadow maps of what has not moved are
 * kept. */
static bool measure_frame(struct planning *p, uint32_t frame, uint32_t before,
                          struct sample *sample, struct kiln_error *error)
{
    if ((p->states && !kiln_states_take_up(p->states, p->loop, frame, error)) ||
        !advance(p, frame, error) || !draw(p, frame, sample, error))
        return false;
    const struct sample first = *sample;
    struct sample later[LATER_FRAMES];
    uint32_t count = 0;
    double drawn_s = first.cpu_s;
    for (uint32_t i = 1; i <= LATER_FRAMES && frame + i < before; i++) {
        struct sample other;
        if (drawn_s > LONG_FRAME_S)
            break;
        if (!advance(p, frame + i, error) || !draw(p, frame + i, &other, error))
            return false;
        drawn_s += other.cpu_s;
        if (other.work <= 0.5 * first.work)
            continue;
        if (other.work >= 2.0 * first.work)
            other.work = first.work;
        uint32_t at = count++;
        for (; at > 0 && takes_less(&other, &later[at - 1]); at--)
            later[at] = later[at - 1];
        later[at] = other;
    }
    if (count == 0)
        return true;
    *sample = later[(count - 1) / 2];
    const double alike_s = sample->cpu_s * first.work / sample->work;
    if (first.cpu_s > alike_s)
        p->caches_cpu_s += first.cpu_s - alike_s;
    return true;
}

/* Measures the frame that the caller chose, or the lightest and the heaviest one, and the steps to
 * them. */
static bool measure(struct planning *p, struct kiln_error *error)
{
    struct kiln_plan *plan = p->plan;
    uint32_t frames[2] = {plan->frame, plan->frame};
    if (p->params->frame < 0) {
        frames[0] = kiln_workload_lightest(p->workload);
        frames[1] = kiln_workload_heaviest(p->workload);
        plan->frame = frames[1];
    }
    /* The loop only goes forward. */
    const uint32_t least = frames[0] < frames[1] ? frames[0] : frames[1];
    const uint32_t most = frames[0] < frames[1] ? frames[1] : frames[0];
    const uint32_t end = p->scene->frames;
    p->frame_count = most == least ? 1 : 2;
    if (p->frame_count == 1) {
        if (!measure_frame(p, plan->frame, end, &p->frames[0], error))
            return false;
    } else if (!measure_frame(p, least, most, &p->frames[least == plan->frame], error) ||
               !measure_frame(p, most, end, &p->frames[most == plan->frame], error)) {
        return false;
    }
    plan->memory_bytes = peak_memory();
    plan->frame_cpu_s = p->frames[p->frame_count - 1].cpu_s;
    if (plan->steps == 0 && !advance(p, most + 1, error))
        return false;
    plan->step_cpu_s = plan->steps > 0 ? p->steps.cpu_s / (double)plan->steps : 0.0;
    return true;
}

/* ---- estimates ------------------------------------------------------------------------------- */

/* Returns the time of a frame: between those that were measured, or in proportion to the only one.
 * Frames with less work than the lightest one are in proportion to that one, too: a line through
 * both would give them less than no time. */
static double frame_seconds(const struct planning *p, uint32_t frame)
{
    const double work = kiln_workload_frame(p->workload, frame);
    const struct sample *light = &p->frames[0], *heavy = &p->frames[p->frame_count - 1];
    if (heavy->work <= light->work)
        return heavy->cpu_s * work / heavy->work;
    if (work < light->work)
        return light->cpu_s * work / light->work;
    const double part = (work - light->work) / (heavy->work - light->work);
    return light->cpu_s + part * (heavy->cpu_s - light->cpu_s);
}

/* Returns the time of a unit of work in the last quarter of the frames that were measured. */
static double last_rate(const struct planning *p)
{
    double cpu_s = 0.0, work = 0.0;
    for (uint32_t i = 3 * p->span_count / 4; i < p->span_count; i++) {
        cpu_s += p->spans[i].cpu_s;
        work += kiln_workload_steps(p->workload, p->spans[i].from, p->spans[i].to);
    }
    return work > 0.0 ? cpu_s / work : 0.0;
}

/* Returns the time of steps: of those that were measured what they took, of others that of the last
 * ones for their work. */
static double spans_seconds(const struct planning *p, uint32_t from, uint32_t to)
{
    double seconds = 0.0, work = kiln_workload_steps(p->workload, from, to);
    for (uint32_t i = 0; i < p->span_count; i++) {
        const struct span *span = &p->spans[i];
        const uint32_t first = span->from > from ? span->from : from;
        const uint32_t end = span->to < to ? span->to : to;
        if (first >= end)
            continue;
        seconds += span->cpu_s * (end - first) / (span->to - span->from);
        work -= kiln_workload_steps(p->workload, first, end);
    }
    return seconds + fmax(work, 0.0) * last_rate(p);
}

static double steps_seconds(const struct planning *p, uint32_t from, uint32_t to)
{
    if (p->span_count > 0)
        return spans_seconds(p, from, to);
    return p->steps.work > 0.0
               ? p->steps.cpu_s / p->steps.work * kiln_workload_steps(p->workload, from, to)
               : 0.0;
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
    const uint32_t last_step = kiln_scene_last_step(scene, task.frames.last);
    task.steps = last_step - task.state_step;
    task.cpu_s = plan->setup_cpu_s + p->caches_cpu_s + steps_seconds(p, task.state_step, last_step);
    for (uint32_t frame = task.frames.first; frame <= task.frames.last; frame++)
        task.cpu_s += frame_seconds(p, frame);
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
    plan.frame = params.frame < 0 ? 0 : (uint32_t)params.frame;
    plan.part_frames = kiln_part_frames(scene->fps.num, scene->fps.den);
    plan.parts = (scene->frames - 1) / plan.part_frames + 1;
    planning.workload = kiln_workload_create(scene);
    if (scene->gas_count > 0)
        planning.spans = calloc((size_t)scene->frames + 1, sizeof *planning.spans);
    bool ok = (planning.workload && (planning.spans || scene->gas_count == 0)) ||
              kiln_error_no_memory(error, "the plan");
    ok = ok && set_up(&planning, error) && measure(&planning, error);
    for (uint32_t i = 0; ok && params.task && i < params.tasks; i++) {
        const struct kiln_plan_task task = task_of(&planning, i);
        params.task(params.user, &plan, &task);
    }
    kiln_sized_give(out, &plan);
    kiln_workload_destroy(&planning.workload);
    free(planning.spans);
    kiln_states_close(&planning.states);
    kiln_loop_destroy(&planning.loop);
    kiln_hold_release(device, scene);
    return ok;
}
