/* Accepts pictures of an earlier run, for `kiln test approve`. Nothing is rendered, so everything
 * that the pictures depend on is checked before the first file is written: the scene is loaded
 * again and must be the one that was rendered, and the pictures must be those that were judged. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "option/node.h"
#include "scene/work.h"
#include "suite/golden.h"
#include "suite/rendering.h"
#include "suite/test_file.h"

struct approval {
    const struct kiln_approve_params *params;
    struct kiln_error *error;
    struct kiln_arena *arena;
    char folder[KILN_PATH_SIZE]; /* the result's folder */
    struct kiln_result *result;
    struct kiln_test_file file;
    struct kiln_expect *expect;
    char *scene_text;
    char scene_hash[65];
    size_t frame_count; /* frames to accept */
};

static bool out_of_memory(struct approval *a)
{
    return kiln_error_no_memory(a->error, "approving pictures");
}

/* Sets the error for a reason that another run removes; the message names the command. */
static bool fail_outdated(struct approval *a, const char *what)
{
    return kiln_error_set(a->error, KILN_INVALID_INPUT, "%s: %s; run it again%s%s", a->params->name,
                          what, *a->result->rerun ? ": " : "", a->result->rerun);
}

/* ---- which result --------------------------------------------------------------------------- */

struct names {
    struct kiln_arena *arena;
    const char **items;
    size_t count, capacity;
    bool failed;
};

static void add_name(struct names *names, const char *name)
{
    if (names->count == names->capacity) {
        size_t capacity = names->capacity ? 2 * names->capacity : 64;
        const char **items = kiln_arena_alloc(names->arena, capacity, sizeof *items);
        names->failed |= items == NULL;
        if (!items)
            return;
        if (names->count)
            memcpy(items, names->items, names->count * sizeof *items);
        names->items = items;
        names->capacity = capacity;
    }
    names->items[names->count] = kiln_arena_text(names->arena, name, strlen(name));
    names->failed |= names->items[names->count++] == NULL;
}

/* Adds the names of the folders in `folder` that hold a result.json. `name` is the path of `folder`
 * below the folder of all results. A folder that cannot be read is skipped, since no result in it
 * could be approved. */
static void list_results(struct names *names, const char *folder, const char *name)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, NULL, NULL);
    for (int i = 0; i < count; i++) {
        const char *entry = entries[i]->d_name;
        struct stat status;
        const char *path = kiln_arena_format(names->arena, "%s/%s", folder, entry);
        const char *below =
            kiln_arena_format(names->arena, "%s%s%s", name, *name ? "/" : "", entry);
        names->failed |= !path || !below;
        if (strcmp(entry, "result.json") == 0)
            add_name(names, name);
        else if (*entry != '.' && path && below && lstat(path, &status) == 0 &&
                 S_ISDIR(status.st_mode))
            list_results(names, path, below);
        free(entries[i]);
    }
    free(entries);
}

static bool find_result(struct approval *a)
{
    const struct kiln_approve_params *params = a->params;
    struct names names = {.arena = a->arena};
    list_results(&names, params->results, "");
    if (names.failed)
        return out_of_memory(a);
    for (size_t i = 0; i < names.count; i++) {
        if (strcmp(names.items[i], params->name) == 0)
            return kiln_path_join(a->folder, params->results, params->name, a->error);
    }
    char quoted[64];
    const char *nearest = kiln_text_nearest(params->name, names.items, names.count);
    kiln_node_quote(quoted, params->name);
    return kiln_error_set(a->error, KILN_USAGE, "no result of a test '%s' in %s%s%s%s", quoted,
                          params->results, nearest ? " (did you mean '" : "",
                          nearest ? nearest : "", nearest ? "'?)" : "");
}

/* ---- whether the result is current ----------------------------------------------------------- */

/* Returns whether `golden` is GOLDEN/NAME for the test's name without its device. */
static bool is_golden_of(const char *golden, const char *name)
{
    size_t length = strcspn(name, "@"), folder = strlen(golden);
    return folder > length + 1 && golden[folder - length - 1] == '/' &&
           strncmp(golden + folder - length, name, length) == 0;
}

/* Returns whether the result is left alone: it is of another device than params->device, or the
 * test was skipped and is one of many to approve. */
static bool is_passed_over(const struct approval *a)
{
    const char *wanted = a->params->device;
    if (a->params->one_of_many && a->result->status == KILN_TEST_SKIP)
        return true;
    return wanted && !strcasestr(a->result->device, wanted) &&
           !strcasestr(a->result->device_name, wanted);
}

static bool read_result(struct approval *a)
{
    a->result = kiln_result_read(a->arena, a->folder, a->error);
    if (!a->result)
        return false;
    const struct kiln_result *r = a->result;
    char device[KILN_DEVICE_NAME_SIZE];
    if (strcmp(r->name, a->params->name) != 0 || !is_golden_of(r->golden, r->name))
        return kiln_error_set(
            a->error, KILN_INVALID_INPUT,
            "%s/result.json: the result belongs to another test: it names '%s', with goldens in %s",
            a->folder, r->name, r->golden);
    if (is_passed_over(a))
        return true;
    if (r->status == KILN_TEST_SKIP)
        return fail_outdated(a, "the test was skipped and has no pictures");
    if (r->status == KILN_TEST_ERROR || r->frame_count == 0)
        return kiln_error_set(a->error, KILN_INVALID_INPUT,
                              "%s: the test ended with an error, so nothing can be accepted: %s",
                              a->params->name, r->message);
    kiln_device_name(r->device_name, device);
    if (!*device || strcmp(device, r->device_name) != 0)
        return kiln_error_set(a->error, KILN_INVALID_INPUT,
                              "%s/result.json: '%s' is not a device's name", a->folder,
                              r->device_name);
    return true;
}

static bool read_test(struct approval *a)
{
    struct kiln_test *test = &a->file.test;
    if (!kiln_test_file_read(a->arena, a->result->test, &a->file, a->error))
        return false;
    if (test->problem.code != KILN_OK) {
        *a->error = test->problem;
        return false;
    }
    test->golden = a->result->golden;
    test->results = a->folder;
    return true;
}

static bool print_scene(struct approval *a, const struct kiln_scene *scene)
{
    size_t size = 0;
    FILE *out = open_memstream(&a->scene_text, &size);
    bool ok = out && kiln_scene_print(scene, out);
    if (out)
        ok = fclose(out) == 0 && ok;
    return ok || out_of_memory(a);
}

/* Checks that the test's frames are those of the result. A frame that the test no longer judges
 * would leave a golden that nothing uses; a frame that it judges now would have none. */
static bool check_numbers(struct approval *a, uint32_t scene_frames)
{
    uint32_t default_frames[2];
    const uint32_t *numbers = NULL;
    size_t count = kiln_test_frames(&a->file.test, scene_frames, default_frames, &numbers);
    bool same = count == a->result->frame_count;
    for (size_t i = 0; i < count && same; i++)
        same = a->result->frames[i].number == numbers[i];
    return same || fail_outdated(a, "the test's frames have changed since the run");
}

static bool check_scene(struct approval *a)
{
    const struct kiln_test *test = &a->file.test;
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = test->overrides;
    params.override_count = test->override_count;
    struct kiln_scene *scene = kiln_scene_load(test->scene, &params, a->error);
    if (!scene)
        return false;
    const struct kiln_scene_info info = kiln_scene_facts(scene);
    memcpy(a->scene_hash, info.hash, sizeof a->scene_hash);
    bool same = strcmp(a->scene_hash, a->result->scene_hash) == 0;
    bool ok =
        same ? print_scene(a, scene) : fail_outdated(a, "the scene has changed since the run");
    ok = ok && check_numbers(a, info.frames);
    kiln_scene_destroy(&scene);
    return ok;
}

/* ---- pictures ------------------------------------------------------------------------------- */

static bool is_wanted(const struct kiln_result_frame *frame)
{
    return frame->status == KILN_TEST_WARN || frame->status == KILN_TEST_CHANGE ||
           frame->status == KILN_TEST_NEW || frame->status == KILN_TEST_FAIL;
}

static bool has_suffix(const struct kiln_test *test, const char *picture)
{
    const char *suffix = strrchr(picture, '.');
    return suffix && strcmp(suffix, kiln_test_suffix(test)) == 0;
}

/* Checks that expect.yaml still has the pixel hash that the frame was judged by, or already has the
 * hash of the frame's picture. */
static bool check_hashes(struct approval *a, const struct kiln_result_frame *frame,
                         const char *changed)
{
    const struct kiln_expect_frame *expected = kiln_expect_find(a->expect, frame->number);
    const char *now = "";
    for (size_t i = 0; expected && i < expected->pixel_count; i++) {
        if (strcmp(expected->pixels[i].device, a->result->device_name) == 0)
            now = expected->pixels[i].hash;
    }
    return strcmp(now, frame->pixels_expected) == 0 || strcmp(now, frame->pixels) == 0 ||
           fail_outdated(a, changed);
}

/* Checks that the golden that the picture was judged by has not changed, or that there is still
 * none. A golden with the picture's own pixels is allowed: the picture was approved before. */
static bool check_golden(struct approval *a, const struct kiln_result_frame *frame)
{
    static const char changed[] = "its goldens have changed since the run";
    struct kiln_goldens goldens;
    char path[KILN_PATH_SIZE], golden[65], reference[65];
    if (a->file.test.golden_form == KILN_GOLDEN_HASH)
        return check_hashes(a, frame, changed);
    if (!kiln_goldens_find(&a->file.test, frame->number, a->result->device_name, &goldens,
                           a->error))
        return false;
    bool found = goldens.count == 0 && strcmp(goldens.paths[0], frame->golden) == 0;
    for (size_t i = 0; i < goldens.count; i++)
        found |= strcmp(goldens.paths[i], frame->golden) == 0;
    if (!found)
        return fail_outdated(a, changed);
    if (goldens.count == 0)
        return !*frame->reference || fail_outdated(a, changed);
    if (!kiln_pixel_hash(frame->golden, golden, a->error))
        return false;
    if (strcmp(golden, frame->pixels) == 0)
        return true;
    if (!*frame->reference || strchr(frame->reference, '/'))
        return fail_outdated(a, changed);
    return kiln_path_join(path, a->folder, frame->reference, a->error) &&
           kiln_pixel_hash(path, reference, a->error) &&
           (strcmp(golden, reference) == 0 || fail_outdated(a, changed));
}

static bool check_frame(struct approval *a, const struct kiln_result_frame *frame)
{
    char picture[KILN_PATH_SIZE], pixels[65];
    /* A frame that fails with KILN_JUDGED_BY_NOTHING fails because its renders differ. */
    if (frame->status == KILN_TEST_FAIL && frame->judged_by == KILN_JUDGED_BY_NOTHING)
        return kiln_error_set(a->error, KILN_INVALID_INPUT, "%s: cannot be accepted: %s",
                              a->params->name, frame->message);
    if (!*frame->picture || strchr(frame->picture, '/'))
        return kiln_error_set(a->error, KILN_INVALID_INPUT,
                              "%s/result.json: frame %u has no picture", a->folder, frame->number);
    if (!has_suffix(&a->file.test, frame->picture))
        return fail_outdated(a, "the test's format has changed since the run");
    if (!kiln_path_join(picture, a->folder, frame->picture, a->error) ||
        !kiln_pixel_hash(picture, pixels, a->error))
        return false;
    if (strcmp(pixels, frame->pixels) != 0)
        return kiln_error_set(
            a->error, KILN_INVALID_INPUT,
            "%s: the file is not the picture that was judged: its pixels have changed "
            "since the run",
            picture);
    return check_golden(a, frame);
}

static bool check_frames(struct approval *a)
{
    for (size_t i = 0; i < a->result->frame_count; i++) {
        const struct kiln_result_frame *frame = &a->result->frames[i];
        if (!is_wanted(frame))
            continue;
        if (!check_frame(a, frame))
            return false;
        a->frame_count++;
    }
    return true;
}

/* ---- writing -------------------------------------------------------------------------------- */

static void report_change(const struct approval *a, const char *folder, const char *name)
{
    char line[KILN_PATH_SIZE + 300];
    snprintf(line, sizeof line, "%s %s%s%s", a->params->dry_run ? "would write" : "wrote", folder,
             *name ? "/" : "", name);
    if (a->params->change)
        a->params->change(a->params->user, line);
}

static bool accept_frame(struct approval *a, const struct kiln_result_frame *frame)
{
    char path[KILN_PATH_SIZE], picture[KILN_PATH_SIZE];
    const struct kiln_acceptance acceptance = {.frame = frame->number,
                                               .picture = picture,
                                               .state = frame->state,
                                               .device_name = a->result->device_name,
                                               .as = a->params->as,
                                               .golden = frame->golden,
                                               .build = a->result->version};
    const bool hash = a->file.test.golden_form == KILN_GOLDEN_HASH;
    const bool replace = a->params->as == KILN_APPROVE_REPLACE || hash;
    if (!kiln_path_join(picture, a->folder, frame->picture, a->error))
        return false;
    if (a->params->dry_run && !replace &&
        !kiln_goldens_place(&a->file.test, frame->number, a->result->device_name, a->params->as,
                            path, a->error))
        return false;
    if (!a->params->dry_run &&
        !kiln_goldens_accept(a->arena, &a->file.test, a->expect, &acceptance, path, a->error))
        return false;
    if (!hash)
        report_change(a, a->params->dry_run && replace ? frame->golden : path, "");
    return true;
}

/* Accepts all wanted frames, and with them the scene, since no frame remains that is not accepted.
 */
static bool write_all(struct approval *a)
{
    const struct kiln_test *test = &a->file.test;
    for (size_t i = 0; i < a->result->frame_count; i++) {
        if (is_wanted(&a->result->frames[i]) && !accept_frame(a, &a->result->frames[i]))
            return false;
    }
    a->expect->scene_hash = a->scene_hash;
    a->expect->hashes_only = test->golden_form == KILN_GOLDEN_HASH;
    if (!kiln_expect_set_techniques(a->arena, a->expect, a->result->techniques))
        return out_of_memory(a);
    if (!a->expect->hashes_only) {
        if (!a->params->dry_run && !kiln_goldens_write_scene(test, a->scene_text, a->error))
            return false;
        report_change(a, test->golden, "scene.yaml");
    }
    if (!a->params->dry_run && !kiln_expect_write(a->expect, test->golden, a->error))
        return false;
    report_change(a, test->golden, "expect.yaml");
    return true;
}

/* Checks and writes while the goldens are locked, so that no other process changes them in between.
 */
static bool approve_locked(struct approval *a)
{
    a->expect = kiln_expect_read(a->arena, a->file.test.golden, a->error);
    if (!a->expect || !check_frames(a))
        return false;
    bool scene_known = a->expect->scene_hash && strcmp(a->expect->scene_hash, a->scene_hash) == 0;
    return (a->frame_count == 0 && scene_known) || write_all(a);
}

bool kiln_test_approve(const struct kiln_approve_params *params, struct kiln_error *error)
{
    struct approval a = {.params = params, .error = error, .arena = kiln_arena_create()};
    bool ok = a.arena || out_of_memory(&a);
    ok = ok && find_result(&a) && read_result(&a);
    if (ok && is_passed_over(&a)) {
        kiln_arena_destroy(&a.arena);
        return true;
    }
    ok = ok && read_test(&a) && check_scene(&a);
    if (ok) {
        int lock = params->dry_run ? -1 : kiln_goldens_lock(&a.file.test, error);
        ok = (params->dry_run || lock >= 0) && approve_locked(&a);
        kiln_goldens_unlock(lock);
    }
    free(a.scene_text);
    kiln_arena_destroy(&a.arena);
    return ok;
}
