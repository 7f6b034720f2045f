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
#include "suite/test_case.h"

enum { MAX_SCENE_SIZE = 16 << 20 };

/* ---- Rendering ---------------------------------------------------------------------------- */

static bool render(struct kiln_test_case *test_case, const char *name_tag,
                   struct kiln_rendering *rendering, struct kiln_error *error)
{
    const struct kiln_test_params *params = test_case->params;
    const struct kiln_rendering_params rendered = {
        .test = test_case->test,
        .device = test_case->test->device ? test_case->test->device : params->device,
        .techniques = params->techniques,
        .technique_count = params->technique_count,
        .threads = params->threads,
        .folder = test_case->test->results,
        .name_tag = name_tag,
        .stop = params->stop,
        .user = params->user,
        .log = params->log,
    };
    return kiln_rendering_make(test_case->arena, &rendered, rendering, error);
}

static void take_rendering(struct kiln_test_case *test_case)
{
    const struct kiln_rendering *rendering = &test_case->rendering;
    struct kiln_result *result = test_case->result;
    result->device = rendering->device.name;
    result->device_name = rendering->device_name;
    result->platform = rendering->device.platform;
    if (*rendering->device.name)
        result->driver = kiln_test_case_text(test_case, "%s, %s", rendering->device.gl_version,
                                             rendering->device.vendor);
    result->techniques = rendering->techniques;
    result->seed = rendering->seed;
    result->width = rendering->scene.width;
    result->height = rendering->scene.height;
    result->scene_hash = rendering->scene.hash;
    const struct kiln_test *test = test_case->test;
    result->pins_gl =
        (test->device || kiln_techniques_need_gl(test->techniques, test->technique_count)) &&
        strcmp(rendering->device_name, "cpu") != 0;
}

static bool take_frames(struct kiln_test_case *test_case)
{
    const struct kiln_rendering *rendering = &test_case->rendering;
    size_t count = rendering->frame_count;
    struct kiln_result_frame *frames = kiln_arena_alloc(test_case->arena, count, sizeof *frames);
    test_case->frames = kiln_arena_alloc(test_case->arena, count, sizeof *test_case->frames);
    if (!frames || !test_case->frames)
        return false;
    for (size_t i = 0; i < count; i++) {
        const char *path = rendering->frames[i].path;
        const char *slash = strrchr(path, '/');
        kiln_result_frame_init(&frames[i], rendering->frames[i].number);
        frames[i].picture = slash ? slash + 1 : path;
        frames[i].state = rendering->frames[i].state;
        frames[i].pixels = rendering->frames[i].pixels;
    }
    test_case->result->frames = frames;
    test_case->result->frame_count = count;
    return true;
}

/* Compares another render with the first, and removes its pictures where they are the same. */
static void compare_repeat(struct kiln_test_case *test_case, uint32_t render_number,
                           const struct kiln_rendering *again)
{
    for (size_t i = 0; i < test_case->result->frame_count && i < again->frame_count; i++) {
        const struct kiln_rendered_frame *a = &test_case->rendering.frames[i],
                                         *b = &again->frames[i];
        bool state = strcmp(a->state, b->state) == 0, pixels = strcmp(a->pixels, b->pixels) == 0;
        if (pixels)
            unlink(b->path);
        if ((state && pixels) || test_case->frames[i].repeat_difference)
            continue;
        test_case->frames[i].repeat_difference = kiln_test_case_text(
            test_case, "render %u of %u differs from the first: frame %u has %s %s, not %s",
            render_number, test_case->params->repeat, a->number, state ? "the pixels" : "the state",
            state ? b->pixels : b->state, state ? a->pixels : a->state);
    }
}

static bool repeat(struct kiln_test_case *test_case, struct kiln_error *error)
{
    for (uint32_t i = 2; i <= test_case->params->repeat; i++) {
        char name_tag[32];
        struct kiln_rendering again;
        snprintf(name_tag, sizeof name_tag, "_render%u", i);
        if (!render(test_case, name_tag, &again, error))
            return false;
        compare_repeat(test_case, i, &again);
    }
    return true;
}

/* ---- Judging ------------------------------------------------------------------------------ */

static bool judge_frames(struct kiln_test_case *test_case, struct kiln_error *error)
{
    const struct kiln_test_params *params = test_case->params;
    for (size_t i = 0; i < test_case->result->frame_count; i++) {
        struct kiln_result_frame *frame = &test_case->result->frames[i];
        if (params->stop && params->stop(params->user))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped after %zu frames", i);
        kiln_test_case_judge(test_case, i);
        if (!test_case->frames[i].repeat_difference || frame->status == KILN_TEST_ERROR)
            continue;
        frame->status = KILN_TEST_FAIL;
        frame->judged_by = KILN_JUDGED_BY_NOTHING;
        frame->message = test_case->frames[i].repeat_difference;
    }
    return true;
}

/* Checks the masks before frames are judged, so that a wrong mask is found even if accepted pixels
 * pass and no mask is used. */
static bool check_masks(struct kiln_test_case *test_case, struct kiln_error *error)
{
    struct kiln_mask mask = {0};
    const struct kiln_scene_info *scene = &test_case->rendering.scene;
    size_t count = (size_t)scene->width * scene->height, masked = 0;
    if (test_case->mask_count == 0)
        return true;
    bool ok = kiln_mask_make(&mask, test_case->masks, test_case->mask_count, scene->width,
                             scene->height, error);
    for (size_t i = 0; ok && i < count; i++)
        masked += mask.masked[i];
    if (2 * masked > count)
        kiln_test_case_note(test_case, "the masks leave only %.2g %% of the picture to judge",
                            100.0 * (double)(count - masked) / (double)count);
    if (!ok && error->code == KILN_USAGE)
        error->code = KILN_INVALID_INPUT; /* the mistake is the test's, not the command line's */
    kiln_mask_finish(&mask);
    return ok;
}

static void sum_up(struct kiln_test_case *test_case)
{
    struct kiln_result *result = test_case->result;
    const struct kiln_result_frame *worst = &result->frames[kiln_result_worst_frame(result)];
    result->status = worst->status;
    result->code = KILN_OK;
    result->message = worst->status > KILN_TEST_PASS ? worst->message : "";
    if (result->status == KILN_TEST_FAIL)
        result->code = KILN_FRAME_FAILED;
    if (result->status == KILN_TEST_NEW)
        result->code = KILN_GOLDEN_MISSING;
    for (size_t i = 0; result->status == KILN_TEST_ERROR && i < result->frame_count; i++)
        result->code = kiln_code_worse(result->code, test_case->frames[i].code);
}

/* Prints the accepted scene as this kiln writes it, so that keys which an older kiln did not have
 * are stated with their defaults. Returns the text as it is where this kiln cannot read it. */
static const char *complete_scene(struct kiln_test_case *test_case, const char *text,
                                  const char *name)
{
    const char *scene_path = test_case->test->scene, *slash = strrchr(scene_path, '/');
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root =
        slash ? kiln_test_case_text(test_case, "%.*s", (int)(slash - scene_path) + 1, scene_path)
              : ".";
    struct kiln_error ignored = {0};
    struct kiln_text printed = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), name, &params, &ignored);
    const char *complete = scene && kiln_print_scene(scene, 0, &printed)
                               ? kiln_arena_text(test_case->arena, printed.data, printed.length)
                               : NULL;
    kiln_text_free(&printed);
    kiln_scene_destroy(&scene);
    return complete ? complete : text;
}

/* Lists what changed since the accepted scene. If that scene cannot be read, a note says so, which
 * is enough since nothing is judged by it. */
static void take_changes(struct kiln_test_case *test_case)
{
    struct kiln_result *result = test_case->result;
    struct kiln_error error = {0};
    char path[KILN_PATH_SIZE];
    size_t size;
    if (test_case->test->golden_form == KILN_GOLDEN_HASH) /* such a test keeps no scene */
        return;
    if (!kiln_path_join(path, test_case->test->golden, "scene.yaml", &error) ||
        access(path, F_OK) != 0)
        return;
    char *text = kiln_text_file_read(path, "the accepted scene", MAX_SCENE_SIZE, &size, &error);
    if (text && strcmp(text, test_case->rendering.scene_text) == 0) {
        free(text);
        return;
    }
    const char *before = text ? complete_scene(test_case, text, path) : NULL;
    test_case->scene_keys_differ = text && strcmp(text, before) != 0;
    if (!text ||
        !kiln_scene_diff(test_case->arena, before, path, test_case->rendering.scene_origins,
                         &result->changes, &result->change_count, &error))
        kiln_test_case_note(test_case, "it is not known what changed in the scene: %s",
                            error.message);
    free(text);
}

static const char *join_techniques(struct kiln_test_case *test_case)
{
    const struct kiln_expect *expect = test_case->expect;
    const char *text = "";
    for (size_t i = 0; i < expect->technique_count; i++)
        text = kiln_test_case_text(test_case, "%s%s%s", text, i ? " " : "", expect->techniques[i]);
    return text;
}

/* ---- The run ------------------------------------------------------------------------------ */

static bool prepare(struct kiln_test_case *test_case, struct kiln_error *error)
{
    if (test_case->test->problem.code != KILN_OK) {
        *error = test_case->test->problem;
        return false;
    }
    test_case->expect = kiln_expect_read(test_case->arena, test_case->test->golden, error);
    if (!test_case->expect || !kiln_test_case_set_limits(test_case, error))
        return false;
    test_case->result->scene_hash_expected =
        test_case->expect->scene_hash ? test_case->expect->scene_hash : "";
    test_case->result->techniques_expected = join_techniques(test_case);
    test_case->result->hdr = test_case->test->format == KILN_TEST_EXR;
    return true;
}

static bool run(struct kiln_test_case *test_case, struct kiln_error *error)
{
    if (!prepare(test_case, error))
        return false;
    bool rendered = render(test_case, "", &test_case->rendering, error);
    take_rendering(test_case);
    if (!rendered)
        return false;
    if (!take_frames(test_case))
        return kiln_error_no_memory(error, "%s", test_case->test->path);
    take_changes(test_case);
    if (!check_masks(test_case, error) || !repeat(test_case, error) ||
        !judge_frames(test_case, error))
        return false;
    sum_up(test_case);
    kiln_test_case_take_notes(test_case);
    if (!kiln_test_case_update(test_case, error))
        return false;
    sum_up(test_case);
    return true;
}

static void note_error(struct kiln_test_case *test_case, const struct kiln_error *error)
{
    bool skip = test_case->rendering.no_device && test_case->test->may_skip;
    struct kiln_result *result = test_case->result;
    result->status = skip ? KILN_TEST_SKIP : KILN_TEST_ERROR;
    result->code = skip ? KILN_OK : error->code != KILN_OK ? error->code : KILN_DEVICE_FAILED;
    result->message = kiln_test_case_text(test_case, "%s", error->message);
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
static bool run_to_result(struct kiln_test_case *test_case, struct kiln_error *error)
{
    struct kiln_result *result = test_case->result;
    struct kiln_error problem = {0};
    char path[KILN_PATH_SIZE];
    if (!kiln_test_case_path(test_case, "result.json", path, error) ||
        !kiln_make_parent_folders(path, error))
        return false;
    if (test_case->params->build)
        result->version = test_case->params->build;
    result->threads = count_threads(test_case->params->threads);
    result->repeat = test_case->params->repeat;
    bool done = run(test_case, &problem);
    if (problem.code == KILN_INTERRUPTED) {
        *error = problem;
        return false;
    }
    if (done && test_case->no_memory)
        done = kiln_error_no_memory(&problem, "%s", test_case->test->path);
    if (!done)
        note_error(test_case, &problem);
    result->rerun = kiln_test_case_rerun_command(test_case);
    if (result->frame_count > 0)
        result->approve = kiln_test_case_approve_command(test_case);
    result->total_s = kiln_clock_seconds() - test_case->started_s;
    return kiln_result_write(result, test_case->test->results, error);
}

bool kiln_test_run(const struct kiln_suite *suite, size_t index,
                   const struct kiln_test_params *params, struct kiln_test_summary *summary,
                   struct kiln_error *error)
{
    struct kiln_test_case test_case = {.suite = suite,
                                       .test = &suite->tests[index],
                                       .params = params,
                                       .arena = kiln_arena_create(),
                                       .started_s = kiln_clock_seconds()};
    bool ok = false;
    test_case.result = test_case.arena ? kiln_result_start(test_case.arena, test_case.test) : NULL;
    if (test_case.result) {
        ok = run_to_result(&test_case, error);
        kiln_summary_take(summary, test_case.result);
    } else {
        kiln_error_no_memory(error, "%s", test_case.test->path);
    }
    kiln_arena_destroy(&test_case.arena);
    return ok;
}
