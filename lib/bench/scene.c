/* Measures a scene of the caller. It draws whole frames first, and measures them pass by pass.
 * Then, for one stage after the other, it compares the techniques of that stage, while all other
 * stages use the techniques that `auto` chooses. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "bench/suite.h"
#include "scene/work.h"

struct subject {
    const struct kiln_bench_run *run;
    const struct kiln_scene *scene;
    const char *path;
    uint32_t frame;
    double particles;
    struct kiln_samples *samples; /* [KILN_MAX_LANES] */
};

/* Measures whole frames pass by pass, and counts the particles. */
static bool measure_frames(struct subject *s, struct kiln_error *error)
{
    static const struct kiln_lane automatic = {.name = "auto", .techniques = ""};
    const struct kiln_bench_part part = {
        .name = s->path, .title = "a frame, pass by pass", .sweep = "particles", .unit = "ms"};
    kiln_bench_say(s->run, "whole frames from frame %u on", s->frame);
    if (!kiln_bench_begin(s->run, &part, error) ||
        !kiln_contest_run(s->run, s->scene, s->frame, &automatic, 1, s->samples, error))
        return false;
    s->particles = (double)s->samples[0].alive;
    struct kiln_scene_info info = kiln_scene_facts(s->scene);
    const struct kiln_comparison comparison = {
        .lanes = &automatic, .lane_count = 1, .measures = UINT32_MAX, .x = s->particles};
    return kiln_bench_add_samples(s->run, &comparison, s->samples, error) &&
           kiln_bench_add_note(s->run->bench, error,
                               "%u x %u pixels, %u steps a frame, from frame %u on.", info.width,
                               info.height, info.steps_per_frame, s->frame);
}

static bool is_fixed(const struct kiln_bench_params *params, const char *stage)
{
    size_t length = strlen(stage);
    for (size_t i = 0; i < params->technique_count; i++) {
        if (strncmp(params->techniques[i], stage, length) == 0 &&
            params->techniques[i][length] == '=')
            return true;
    }
    return false;
}

static bool is_wanted(const struct kiln_bench_params *params, const char *stage)
{
    bool wanted = params->stage_count == 0;
    for (size_t i = 0; i < params->stage_count; i++)
        wanted = wanted || strcmp(params->stages[i], stage) == 0;
    return wanted && !is_fixed(params, stage);
}

static bool measure_stage(struct subject *s, size_t stage, struct kiln_error *error)
{
    struct kiln_lane lanes[KILN_MAX_LANES];
    size_t count = kiln_lanes_of_stage(s->run, kiln_stage_name(stage), lanes, error);
    if (count == 0)
        return false;
    struct kiln_arena *arena = s->run->bench->arena;
    const char *name = kiln_arena_format(arena, "%s, %s", s->path, kiln_stage_name(stage));
    const char *title = kiln_arena_format(arena, "techniques of %s", kiln_stage_name(stage));
    if (!name || !title) {
        kiln_error_no_memory(error, "measurements");
        return false;
    }
    const struct kiln_bench_part part = {.name = name,
                                         .title = title,
                                         .sweep = "particles",
                                         .unit = "ms",
                                         .reference = lanes[0].name};
    const struct kiln_comparison comparison = {.lanes = lanes,
                                               .lane_count = count,
                                               .measures = 1u << kiln_stage_pass(stage) |
                                                           KILN_MEASURE_WHOLE,
                                               .x = s->particles};
    kiln_bench_say(s->run, "techniques of %s", kiln_stage_name(stage));
    return kiln_bench_begin(s->run, &part, error) &&
           kiln_contest_run(s->run, s->scene, s->frame, lanes, count, s->samples, error) &&
           kiln_bench_add_samples(s->run, &comparison, s->samples, error);
}

struct kiln_scene *kiln_bench_load_caller_scene(const struct kiln_bench_run *run, const char *path,
                                                const struct kiln_scene_params *wanted,
                                                uint32_t *frame, struct kiln_error *error)
{
    struct kiln_scene_params params = *wanted;
    struct kiln_scene *scene = kiln_scene_load(path, &params, error);
    if (!scene)
        return NULL;
    uint32_t frames = kiln_scene_facts(scene).frames;
    *frame = run->params->frame < 0 ? frames / 2 : (uint32_t)run->params->frame;
    uint64_t needed = (uint64_t)*frame + KILN_BENCH_WARM_UP + run->bench->repetitions;
    if (needed <= frames)
        return scene;
    kiln_scene_destroy(&scene);
    const char **overrides = calloc(params.override_count + 1, sizeof *overrides);
    char *length =
        kiln_arena_format(run->bench->arena, "output.frames=%llu", (unsigned long long)needed);
    if (overrides && length) {
        for (size_t i = 0; i < params.override_count; i++)
            overrides[i] = params.overrides[i];
        overrides[params.override_count++] = length;
        params.overrides = overrides;
        scene = kiln_scene_load(path, &params, error);
    } else {
        kiln_error_no_memory(error, "measurements");
    }
    free(overrides);
    return scene;
}

/* Returns whether a scene has what a stage works on. */
static bool has_stage(const struct kiln_scene *scene, size_t stage)
{
    return strcmp(kiln_stage_name(stage), "gas") != 0 || scene->gas_count > 0;
}

bool kiln_bench_scene(const struct kiln_bench_run *run, const char *path, struct kiln_error *error)
{
    struct subject subject = {.run = run, .path = path};
    struct kiln_scene *scene =
        kiln_bench_load_caller_scene(run, path, &run->params->scene, &subject.frame, error);
    subject.scene = scene;
    subject.samples = calloc(KILN_MAX_LANES, sizeof *subject.samples);
    if (scene && !subject.samples)
        kiln_error_no_memory(error, "measurements");
    bool ok = scene && subject.samples && measure_frames(&subject, error);
    for (size_t stage = 0; stage < KILN_STAGE_COUNT && ok; stage++) {
        if (is_wanted(run->params, kiln_stage_name(stage)) && has_stage(scene, stage))
            ok = measure_stage(&subject, stage, error);
    }
    free(subject.samples);
    kiln_scene_destroy(&scene);
    return ok;
}
