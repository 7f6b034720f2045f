/* Runs one test, from its file to its result. Errors go into the result, so that a run of many
 * tests reports every test. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/temporary.h"
#include "base/thread.h"
#include "compare/mask.h"
#include "scene/scene.h"
#include "suite/summary.h"
#include "suite/trial.h"

enum { MAX_SCENE_SIZE = 16 << 20 };

/* ---- Rendering ---------------------------------------------------------------------------- */

static bool render(struct kiln_trial *trial, const char *addition, struct kiln_rendering *rendering,
                   struct kiln_error *error)
{
    const struct kiln_test_params *params = trial->params;
    const struct kiln_rendering_params rendered = {
        .test = trial->test,
        .device = trial->test->device ? trial->test->device : params->device,
        .techniques = params->techniques,
        .technique_count = params->technique_count,
        .threads = params->threads,
        .folder = trial->test->results,
        .addition = addition,
        .stop = params->stop,
        .user = params->user,
        .log = params->log,
    };
    return kiln_rendering_make(trial->arena, &rendered, rendering, error);
}

static void take_rendering(struct kiln_trial *trial)
{
    const struct kiln_rendering *rendering = &trial->rendering;
    struct kiln_result *result = trial->result;
    result->device = rendering->device.name;
    result->device_name = rendering->device_name;
    result->platform = rendering->device.platform;
    if (*rendering->device.name)
        result->driver = kiln_trial_text(trial, "%s, %s", rendering->device.gl_version,
                                         rendering->device.vendor);
    result->techniques = rendering->techniques;
    result->seed = rendering->seed;
    result->width = rendering->scene.width;
    result->height = rendering->scene.height;
    result->scene_hash = rendering->scene.hash;
    const struct kiln_test *test = trial->test;
    result->pins_gl =
        (test->device || kiln_techniques_need_gl(test->techniques, test->technique_count)) &&
        strcmp(rendering->device_name, "cpu") != 0;
}

static bool take_frames(struct kiln_trial *trial)
{
    const struct kiln_rendering *rendering = &trial->rendering;
    size_t count = rendering->frame_count;
    struct kiln_result_frame *frames = kiln_arena_alloc(trial->arena, count, sizeof *frames);
    trial->frames = kiln_arena_alloc(trial->arena, count, sizeof *trial->frames);
    if (!frames || !trial->frames)
        return false;
    for (size_t i = 0; i < count; i++) {
        const char *path = rendering->frames[i].path;
        const char *slash = strrchr(path, '/');
        kiln_result_frame_init(&frames[i], rendering->frames[i].number);
        frames[i].picture = slash ? slash + 1 : path;
        frames[i].state = rendering->frames[i].state;
        frames[i].pixels = rendering->frames[i].pixels;
    }
    trial->result->frames = frames;
    trial->result->frame_count = count;
    return true;
}

/* Compares another render with the first, and removes its pictures where they are the same. */
static void compare_repeat(struct kiln_trial *trial, uint32_t render_number,
                           const struct kiln_rendering *again)
{
    for (size_t i = 0; i < trial->result->frame_count && i < again->frame_count; i++) {
        const struct kiln_rendered_frame *a = &trial->rendering.frames[i], *b = &again->frames[i];
        bool state = strcmp(a->state, b->state) == 0, pixels = strcmp(a->pixels, b->pixels) == 0;
        if (pixels)
            unlink(b->path);
        if ((state && pixels) || trial->frames[i].unsteady)
            continue;
        trial->frames[i].unsteady = kiln_trial_text(
            trial, "render %u of %u differs from the first: frame %u has %s %s, not %s",
            render_number, trial->params->repeat, a->number, state ? "the pixels" : "the state",
            state ? b->pixels : b->state, state ? a->pixels : a->state);
    }
}

static bool repeat(struct kiln_trial *trial, struct kiln_error *error)
{
    for (uint32_t i = 2; i <= trial->params->repeat; i++) {
        char addition[32];
        struct kiln_rendering again;
        snprintf(addition, sizeof addition, "_render%u", i);
        if (!render(trial, addition, &again, error))
            return false;
        compare_repeat(trial, i, &again);
    }
    return true;
}

/* ---- Judging ------------------------------------------------------------------------------ */

static bool judge_frames(struct kiln_trial *trial, struct kiln_error *error)
{
    const struct kiln_test_params *params = trial->params;
    for (size_t i = 0; i < trial->result->frame_count; i++) {
        struct kiln_result_frame *frame = &trial->result->frames[i];
        if (params->stop && params->stop(params->user))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped after %zu frames", i);
        kiln_trial_judge(trial, i);
        if (!trial->frames[i].unsteady || frame->status == KILN_TEST_ERROR)
            continue;
        frame->status = KILN_TEST_FAIL;
        frame->judged_by = KILN_JUDGED_BY_NOTHING;
        frame->message = trial->frames[i].unsteady;
    }
    return true;
}

/* Checks the masks before frames are judged, so that a wrong mask is found even if accepted pixels
 * pass and no mask is used. */
static bool check_masks(struct kiln_trial *trial, struct kiln_error *error)
{
    struct kiln_mask mask = {0};
    const struct kiln_scene_info *scene = &trial->rendering.scene;
    size_t count = (size_t)scene->width * scene->height, masked = 0;
    if (trial->mask_count == 0)
        return true;
    bool ok =
        kiln_mask_make(&mask, trial->masks, trial->mask_count, scene->width, scene->height, error);
    for (size_t i = 0; ok && i < count; i++)
        masked += mask.masked[i];
    if (2 * masked > count)
        kiln_trial_note(trial, "the masks leave only %.2g %% of the picture to judge",
                        100.0 * (double)(count - masked) / (double)count);
    if (!ok && error->code == KILN_USAGE)
        error->code = KILN_INVALID_INPUT; /* the mistake is the test's, not the command line's */
    kiln_mask_finish(&mask);
    return ok;
}

static void sum_up(struct kiln_trial *trial)
{
    struct kiln_result *result = trial->result;
    const struct kiln_result_frame *worst = &result->frames[kiln_result_worst_frame(result)];
    result->status = worst->status;
    result->code = KILN_OK;
    result->message = worst->status > KILN_TEST_PASS ? worst->message : "";
    if (result->status == KILN_TEST_FAIL)
        result->code = KILN_FRAME_FAILED;
    if (result->status == KILN_TEST_NEW)
        result->code = KILN_GOLDEN_MISSING;
    for (size_t i = 0; result->status == KILN_TEST_ERROR && i < result->frame_count; i++)
        result->code = kiln_code_worse(result->code, trial->frames[i].code);
}

/* Prints the accepted scene as this kiln writes it, so that keys which an older kiln did not have
 * are stated with their defaults. Returns the text as it is where this kiln cannot read it. */
static const char *complete_scene(struct kiln_trial *trial, const char *text, const char *name)
{
    const char *scene_path = trial->test->scene, *slash = strrchr(scene_path, '/');
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root =
        slash ? kiln_trial_text(trial, "%.*s", (int)(slash - scene_path) + 1, scene_path) : ".";
    struct kiln_error ignored = {0};
    struct kiln_text printed = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), name, &params, &ignored);
    const char *complete = scene && kiln_print_scene(scene, 0, &printed)
                               ? kiln_arena_text(trial->arena, printed.data, printed.length)
                               : NULL;
    kiln_text_free(&printed);
    kiln_scene_destroy(&scene);
    return complete ? complete : text;
}

/* Lists what changed since the accepted scene. If that scene cannot be read, a note says so, which
 * is enough since nothing is judged by it. */
static void take_changes(struct kiln_trial *trial)
{
    struct kiln_result *result = trial->result;
    struct kiln_error error = {0};
    char path[KILN_PATH_SIZE];
    size_t size;
    if (trial->test->kept == KILN_GOLDEN_HASH) /* such a test keeps no scene */
        return;
    if (!kiln_path_join(path, trial->test->golden, "scene.yaml", &error) || access(path, F_OK) != 0)
        return;
    char *text = kiln_text_file_read(path, "the accepted scene", MAX_SCENE_SIZE, &size, &error);
    if (text && strcmp(text, trial->rendering.scene_text) == 0) {
        free(text);
        return;
    }
    const char *before = text ? complete_scene(trial, text, path) : NULL;
    trial->other_keys = text && strcmp(text, before) != 0;
    if (!text || !kiln_scene_diff(trial->arena, before, path, trial->rendering.scene_text,
                                  &result->changes, &result->change_count, &error))
        kiln_trial_note(trial, "it is not known what changed in the scene: %s", error.message);
    free(text);
}

static const char *join_techniques(struct kiln_trial *trial)
{
    const struct kiln_expect *expect = trial->expect;
    const char *text = "";
    for (size_t i = 0; i < expect->technique_count; i++)
        text = kiln_trial_text(trial, "%s%s%s", text, i ? " " : "", expect->techniques[i]);
    return text;
}

/* ---- The run ------------------------------------------------------------------------------ */

static bool prepare(struct kiln_trial *trial, struct kiln_error *error)
{
    if (trial->test->problem.code != KILN_OK) {
        *error = trial->test->problem;
        return false;
    }
    trial->expect = kiln_expect_read(trial->arena, trial->test->golden, error);
    if (!trial->expect || !kiln_trial_set_limits(trial, error))
        return false;
    trial->result->scene_hash_expected = trial->expect->scene_hash ? trial->expect->scene_hash : "";
    trial->result->techniques_expected = join_techniques(trial);
    trial->result->hdr = trial->test->format == KILN_TEST_EXR;
    return true;
}

static bool run(struct kiln_trial *trial, struct kiln_error *error)
{
    if (!prepare(trial, error))
        return false;
    bool rendered = render(trial, "", &trial->rendering, error);
    take_rendering(trial);
    if (!rendered)
        return false;
    if (!take_frames(trial))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", trial->test->path);
    take_changes(trial);
    if (!check_masks(trial, error) || !repeat(trial, error) || !judge_frames(trial, error))
        return false;
    sum_up(trial);
    kiln_trial_take_notes(trial);
    if (!kiln_trial_update(trial, error))
        return false;
    sum_up(trial);
    return true;
}

static void note_error(struct kiln_trial *trial, const struct kiln_error *error)
{
    bool skip = trial->rendering.no_device && trial->test->may_skip;
    struct kiln_result *result = trial->result;
    result->status = skip ? KILN_TEST_SKIP : KILN_TEST_ERROR;
    result->code = skip ? KILN_OK : error->code != KILN_OK ? error->code : KILN_DEVICE_FAILED;
    result->message = kiln_trial_text(trial, "%s", error->message);
    for (size_t i = 0; i < result->frame_count; i++) {
        struct kiln_result_frame *frame = &result->frames[i];
        if (frame->status != KILN_TEST_PASS || frame->judged_by != KILN_JUDGED_BY_NOTHING)
            continue;
        frame->status = KILN_TEST_ERROR;
        frame->message = "not judged, because the test ended with an error";
    }
}

static uint32_t count_threads(uint32_t wanted)
{
    struct kiln_threads *threads = wanted ? NULL : kiln_threads_create(0);
    uint32_t count = threads ? kiln_threads_count(threads) : wanted;
    kiln_threads_destroy(&threads);
    return count;
}

/* Runs the test and writes its result. Errors go into the result; only a stop and files that cannot
 * be written are returned. */
static bool run_to_result(struct kiln_trial *trial, struct kiln_error *error)
{
    struct kiln_result *result = trial->result;
    struct kiln_error problem = {0};
    char path[KILN_PATH_SIZE];
    if (!kiln_trial_path(trial, "result.json", path, error) ||
        !kiln_make_parent_folders(path, error))
        return false;
    if (trial->params->build)
        result->version = trial->params->build;
    result->threads = count_threads(trial->params->threads);
    result->repeat = trial->params->repeat;
    bool done = run(trial, &problem);
    if (problem.code == KILN_INTERRUPTED) {
        *error = problem;
        return false;
    }
    if (done && trial->no_memory)
        done = kiln_error_set(&problem, KILN_DEVICE_FAILED, "%s: out of memory", trial->test->path);
    if (!done)
        note_error(trial, &problem);
    result->rerun = kiln_trial_rerun_command(trial);
    if (result->frame_count > 0)
        result->approve = kiln_trial_approve_command(trial);
    result->total_s = kiln_clock_seconds() - trial->started_s;
    return kiln_result_write(result, trial->test->results, error);
}

bool kiln_test_run(const struct kiln_suite *suite, size_t index,
                   const struct kiln_test_params *params, struct kiln_test_summary *summary,
                   struct kiln_error *error)
{
    struct kiln_trial trial = {.suite = suite,
                               .test = &suite->tests[index],
                               .params = params,
                               .arena = kiln_arena_create(),
                               .started_s = kiln_clock_seconds()};
    bool ok = false;
    trial.result = trial.arena ? kiln_result_start(trial.arena, trial.test) : NULL;
    if (trial.result) {
        ok = run_to_result(&trial, error);
        kiln_summary_take(summary, trial.result);
    } else {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", trial.test->path);
    }
    kiln_arena_destroy(&trial.arena);
    return ok;
}
