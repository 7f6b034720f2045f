/* Renders the frames of a test and hashes their states and pixels. A test pins its techniques,
 * since stages that run on the processor make the same pixels everywhere. Every stage is `cpu`, and
 * so is the device, unless the test or its techniques ask for another. */
#include "suite/rendering.h"

#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/pattern.h"
#include "frame/technique.h"
#include "scene/work.h"

struct job {
    struct kiln_arena *arena;
    const struct kiln_rendering_params *params;
    struct kiln_rendering *rendering;
    struct kiln_scene *scene;
    struct kiln_device *device;
    char output[KILN_PATH_SIZE];
    struct kiln_error *error;
};

static bool no_memory(const struct job *job)
{
    return kiln_error_no_memory(job->error, "%s", job->params->test->path);
}

static bool load_scene(struct job *job)
{
    const struct kiln_test *test = job->params->test;
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = test->overrides;
    params.override_count = test->override_count;
    params.keep_origins = true;
    job->scene = kiln_scene_load(test->scene, &params, job->error);
    if (!job->scene)
        return false;
    job->rendering->scene = kiln_scene_facts(job->scene);
    job->rendering->seed = job->scene->seed;
    struct kiln_text text = {0};
    if (kiln_print_scene(job->scene, 0, &text))
        job->rendering->scene_text = kiln_arena_text(job->arena, text.data, text.length);
    kiln_text_free(&text);
    if (kiln_print_scene_origins(job->scene, &text))
        job->rendering->scene_origins = kiln_arena_text(job->arena, text.data, text.length);
    kiln_text_free(&text);
    return (job->rendering->scene_text && job->rendering->scene_origins) || no_memory(job);
}

size_t kiln_test_frames(const struct kiln_test *test, uint32_t scene_frames,
                        uint32_t default_frames[2], const uint32_t **numbers)
{
    default_frames[0] = scene_frames / 2;
    default_frames[1] = scene_frames - 1;
    bool own = test->frame_count > 0, single = default_frames[0] == default_frames[1];
    *numbers = own ? test->frames : default_frames + single;
    return own ? test->frame_count : single ? 1 : 2;
}

static bool choose_frames(struct job *job)
{
    const struct kiln_test *test = job->params->test;
    uint32_t default_frames[2], last = job->rendering->scene.frames - 1;
    const uint32_t *numbers = NULL;
    size_t count = kiln_test_frames(test, job->rendering->scene.frames, default_frames, &numbers);
    if (numbers[count - 1] > last)
        return kiln_error_set(job->error, KILN_INVALID_INPUT,
                              "%s: frame %u: the last one of %s is %u", test->path,
                              numbers[count - 1], test->scene, last);
    job->rendering->frames = kiln_arena_alloc(job->arena, count, sizeof *job->rendering->frames);
    if (!job->rendering->frames)
        return no_memory(job);
    job->rendering->frame_count = count;
    for (size_t i = 0; i < count; i++) {
        struct kiln_rendered_frame *frame = &job->rendering->frames[i];
        frame->number = numbers[i];
    }
    return true;
}

static bool name_frames(struct job *job)
{
    struct kiln_path_pattern pattern;
    int length = snprintf(job->output, sizeof job->output, "%s/frame_####%s%s", job->params->folder,
                          job->params->name_tag, kiln_test_suffix(job->params->test));
    bool fits = length >= 0 && (size_t)length < sizeof job->output;
    if (fits && !kiln_path_pattern_parse(&pattern, job->output, KILN_NUMBER_ALWAYS, job->error))
        return false;
    for (size_t i = 0; fits && i < job->rendering->frame_count; i++) {
        struct kiln_rendered_frame *frame = &job->rendering->frames[i];
        fits = kiln_path_pattern_format(&pattern, frame->number, frame->path, sizeof frame->path);
    }
    return fits ||
           kiln_error_set(job->error, KILN_IO, "%s: the path is too long", job->params->folder);
}

static void note_frame(void *user, const struct kiln_progress *progress)
{
    struct job *job = user;
    for (size_t i = 0; i < job->rendering->frame_count; i++) {
        struct kiln_rendered_frame *frame = &job->rendering->frames[i];
        if (frame->number != progress->frame)
            continue;
        snprintf(frame->state, sizeof frame->state, "%08x%08x", progress->state.lane[0],
                 progress->state.lane[1]);
        frame->drawn = true;
    }
}

static bool wants_stop(void *user)
{
    const struct job *job = user;
    return job->params->stop && job->params->stop(job->params->user);
}

/* Returns the list of techniques, of which later ones override earlier ones; NULL when memory is
 * short. */
static const char **list_techniques(const struct job *job, size_t *count)
{
    const struct kiln_test *test = job->params->test;
    size_t capacity = KILN_STAGE_COUNT + test->technique_count + job->params->technique_count;
    const char **list = kiln_arena_alloc(job->arena, capacity, sizeof *list);
    struct kiln_technique_list *pinned = kiln_arena_alloc(job->arena, 1, sizeof *pinned);
    if (!list || !pinned)
        return NULL;
    *count = 0;
    kiln_techniques_combination(0, pinned);
    for (size_t i = 0; i < KILN_STAGE_COUNT; i++)
        list[(*count)++] = pinned->flags[i];
    for (size_t i = 0; i < test->technique_count; i++)
        list[(*count)++] = test->techniques[i];
    for (size_t i = 0; i < job->params->technique_count; i++)
        list[(*count)++] = job->params->techniques[i];
    return list;
}

static bool open_device(struct job *job)
{
    size_t count = 0;
    const char **techniques = list_techniques(job, &count);
    if (!techniques)
        return no_memory(job);
    struct kiln_device_params params =
        kiln_techniques_device(job->params->device, techniques, count);
    params.log = job->params->log;
    job->device = kiln_device_open(&params, job->error);
    job->rendering->no_device = !job->device && job->error->code == KILN_NO_DEVICE;
    if (!job->device)
        return false;
    job->rendering->device = *kiln_device_get_info(job->device);
    kiln_device_name(job->rendering->device.name, job->rendering->device_name);
    return true;
}

static bool render(struct job *job)
{
    const struct kiln_test *test = job->params->test;
    struct kiln_rendering *rendering = job->rendering;
    struct kiln_frame_range *ranges =
        kiln_arena_alloc(job->arena, rendering->frame_count, sizeof *ranges);
    struct kiln_render_params params = kiln_render_defaults();
    params.techniques = list_techniques(job, &params.technique_count);
    if (!ranges || !params.techniques)
        return no_memory(job);
    for (size_t i = 0; i < rendering->frame_count; i++) {
        uint32_t number = rendering->frames[i].number;
        ranges[i] = (struct kiln_frame_range){number, number};
    }
    params.output = job->output;
    params.ranges = ranges;
    params.range_count = rendering->frame_count;
    params.threads = job->params->threads;
    params.overwrite = true;
    params.state_hash = true;
    params.png_bits = test->format == KILN_TEST_PNG16 ? 16 : 8;
    params.progress = note_frame;
    params.stop = wants_stop;
    params.user = job;
    params.log = job->params->log;
    struct kiln_render_stats stats = kiln_render_stats_empty();
    bool ok = kiln_render(job->device, job->scene, &params, &stats, job->error);
    memcpy(rendering->techniques, stats.techniques, sizeof rendering->techniques);
    return ok;
}

static bool hash_frames(struct job *job)
{
    for (size_t i = 0; i < job->rendering->frame_count; i++) {
        struct kiln_rendered_frame *frame = &job->rendering->frames[i];
        if (!frame->drawn || access(frame->path, R_OK) != 0)
            return kiln_error_set(job->error, KILN_FRAME_FAILED, "frame %u was not rendered",
                                  frame->number);
        if (!kiln_pixel_hash(frame->path, frame->pixels, job->error))
            return false;
    }
    return true;
}

bool kiln_rendering_make(struct kiln_arena *arena, const struct kiln_rendering_params *params,
                         struct kiln_rendering *rendering, struct kiln_error *error)
{
    *rendering = (struct kiln_rendering){0};
    struct job job = {.arena = arena, .params = params, .rendering = rendering, .error = error};
    bool ok = load_scene(&job) && choose_frames(&job) && name_frames(&job) && open_device(&job) &&
              render(&job) && hash_frames(&job);
    kiln_device_close(&job.device);
    kiln_scene_destroy(&job.scene);
    return ok;
}
