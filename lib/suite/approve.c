/* Accepts pictures of an earlier run, for `kiln test approve`. Nothing is rendered, so everything
 * that the pictures depend on is checked before the first file is written: the scene is loaded
 * again and must be the one that was rendered, and the pictures must be those that were judged.
 *
 * The results may come from a stranger. So the test and its goldens are those of the suite, never
 * those that the result names, and each picture's bytes are read once for its hash and its copy. */
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

/* The approval of one result. Only `result` is foreign. */
struct approval {
    const struct kiln_approve_params *params;
    struct kiln_error *error;
    struct kiln_arena *arena;
    struct kiln_result_place place;
    struct kiln_result *result;
    const struct kiln_test *test;
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

/* Adds the names of the folders in RESULTS/NAME, and whether it holds a result.json. A folder that
 * cannot be read is skipped, since no result in it could be approved. */
static bool list_folder(struct names *folders, const char *results, const char *name)
{
    const char *folder = kiln_arena_format(folders->arena, "%s/%s", results, name);
    struct dirent **entries = NULL;
    int count = folder ? scandir(folder, &entries, NULL, NULL) : 0;
    bool has_result = false;
    folders->failed |= !folder;
    for (int i = 0; i < count; i++) {
        const char *entry = entries[i]->d_name;
        struct stat status;
        const char *path = kiln_arena_format(folders->arena, "%s/%s", folder, entry);
        const char *below =
            kiln_arena_format(folders->arena, "%s%s%s", name, *name ? "/" : "", entry);
        folders->failed |= !path || !below;
        has_result |= strcmp(entry, "result.json") == 0;
        if (path && below && kiln_result_name_is_valid(below) && lstat(path, &status) == 0 &&
            S_ISDIR(status.st_mode))
            add_name(folders, below);
        free(entries[i]);
    }
    free(entries);
    return has_result;
}

/* Finds the names of all results: of folders with a result.json. */
static void list_results(struct names *names, const char *results)
{
    struct names folders = {.arena = names->arena};
    add_name(&folders, "");
    for (size_t i = 0; i < folders.count && !folders.failed; i++) {
        if (list_folder(&folders, results, folders.items[i]))
            add_name(names, folders.items[i]);
    }
    names->failed |= folders.failed;
}

static bool find_result(struct approval *a)
{
    const char *results = a->params->suite->results_folder, *name = a->params->name;
    struct names names = {.arena = a->arena};
    a->place = (struct kiln_result_place){results, name};
    list_results(&names, results);
    if (names.failed)
        return out_of_memory(a);
    for (size_t i = 0; i < names.count; i++) {
        if (strcmp(names.items[i], name) == 0)
            return true;
    }
    char quoted[64];
    const char *nearest = kiln_text_nearest(name, names.items, names.count);
    kiln_node_quote(quoted, name);
    return kiln_error_set(a->error, KILN_USAGE, "no result of a test '%s' in %s%s%s%s", quoted,
                          results, nearest ? " (did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'?)" : "");
}

/* Finds the test in the suite, which the user names; NULL when it is not there. */
static const struct kiln_test *find_test(const struct kiln_approve_params *params)
{
    for (size_t i = 0; i < params->suite->count; i++) {
        if (strcmp(params->suite->tests[i].full_name, params->name) == 0)
            return &params->suite->tests[i];
    }
    return NULL;
}

/* ---- whether the result is current ----------------------------------------------------------- */

/* Skips slashes and parts "." of a path. */
static const char *skip_nothing(const char *path)
{
    for (;;) {
        if (*path == '/')
            path++;
        else if (path[0] == '.' && (path[1] == '/' || path[1] == '\0'))
            path++;
        else
            return path;
    }
}

/* Returns whether two texts are the same path but for slashes and parts ".". No file is looked at,
 * since one of them is foreign. */
static bool is_same_path(const char *a, const char *b)
{
    if ((*a == '/') != (*b == '/'))
        return false;
    for (a = skip_nothing(a), b = skip_nothing(b); *a || *b;
         a = skip_nothing(a), b = skip_nothing(b)) {
        const size_t length = strcspn(a, "/");
        if (length != strcspn(b, "/") || strncmp(a, b, length) != 0)
            return false;
        a += length;
        b += length;
    }
    return true;
}

/* Checks that the result is of the same file and goldens as the test. */
static bool check_paths(const struct approval *a)
{
    const struct kiln_result *r = a->result;
    const bool same_file = is_same_path(r->test, a->test->path);
    if (same_file && is_same_path(r->golden, a->test->golden))
        return true;
    return kiln_error_set(
        a->error, KILN_INVALID_INPUT,
        "%s: the result names the %s '%s', but the test has '%s': approve where "
        "the test was run%s",
        a->params->name, same_file ? "goldens" : "file", same_file ? r->golden : r->test,
        same_file ? a->test->golden : a->test->path, same_file ? ", with the same --golden" : "");
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
    a->result = kiln_result_read(a->arena, &a->place, a->error);
    if (!a->result)
        return false;
    const struct kiln_result *r = a->result;
    char device[KILN_DEVICE_NAME_SIZE];
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
                              "%s/%s/result.json: '%s' is not a device's name", a->place.results,
                              a->place.name, r->device_name);
    return true;
}

static bool check_test(struct approval *a)
{
    a->test = find_test(a->params);
    if (!a->test)
        return kiln_error_set(
            a->error, KILN_USAGE,
            "%s: there is a result, but no such test where tests are looked for; give the test's "
            "file or folder, too: kiln test approve %s FILE",
            a->params->name, a->params->name);
    if (a->test->problem.code != KILN_OK) {
        *a->error = a->test->problem;
        return false;
    }
    return check_paths(a);
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
    size_t count = kiln_test_frames(a->test, scene_frames, default_frames, &numbers);
    bool same = count == a->result->frame_count;
    for (size_t i = 0; i < count && same; i++)
        same = a->result->frames[i].number == numbers[i];
    return same || fail_outdated(a, "the test's frames have changed since the run");
}

static bool check_scene(struct approval *a)
{
    const struct kiln_test *test = a->test;
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

/* Computes the hash of a picture of the result; bytes receives those of its file. */
static bool read_picture(const struct approval *a, const char *name, unsigned char **bytes,
                         size_t *size, char pixels[65])
{
    char path[KILN_PATH_SIZE];
    *bytes = kiln_result_picture_read(&a->place, name, size, a->error);
    return *bytes &&
           snprintf(path, sizeof path, "%s/%s/%s", a->place.results, a->place.name, name) > 0 &&
           kiln_pixel_hash_of(*bytes, *size, path, pixels, a->error);
}

/* Reads the picture of a frame, which must be the one that was judged. The caller frees *bytes,
 * also after a failure. */
static bool read_judged(const struct approval *a, const struct kiln_result_frame *frame,
                        unsigned char **bytes, size_t *size, char pixels[65])
{
    if (!read_picture(a, frame->picture, bytes, size, pixels))
        return false;
    return strcmp(pixels, frame->pixels) == 0 ||
           kiln_error_set(
               a->error, KILN_INVALID_INPUT,
               "%s/%s/%s: the file is not the picture that was judged: its pixels have changed "
               "since the run",
               a->place.results, a->place.name, frame->picture);
}

/* Returns the path of the golden that the frame was judged by, or of the one that it would have:
 * that among the test's goldens which the result names; NULL if it names none of them. */
static const char *find_golden(const struct kiln_goldens *goldens,
                               const struct kiln_result_frame *frame)
{
    for (size_t i = 0; i == 0 || i < goldens->count; i++) {
        if (is_same_path(goldens->paths[i], frame->golden))
            return goldens->paths[i];
    }
    return NULL;
}

/* Checks that the golden that the picture was judged by has not changed, or that there is still
 * none. A golden with the picture's own pixels is allowed: the picture was approved before. */
static bool check_golden(struct approval *a, const struct kiln_result_frame *frame)
{
    static const char changed[] = "its goldens have changed since the run";
    struct kiln_goldens goldens;
    char golden[65], reference[65];
    if (a->test->golden_form == KILN_GOLDEN_HASH)
        return check_hashes(a, frame, changed);
    if (!kiln_goldens_find(a->test, frame->number, a->result->device_name, &goldens, a->error))
        return false;
    const char *path = find_golden(&goldens, frame);
    if (!path)
        return fail_outdated(a, changed);
    if (goldens.count == 0)
        return !*frame->reference || fail_outdated(a, changed);
    if (!kiln_pixel_hash(path, golden, a->error))
        return false;
    if (strcmp(golden, frame->pixels) == 0)
        return true;
    if (!*frame->reference)
        return fail_outdated(a, changed);
    unsigned char *bytes = NULL;
    size_t size = 0;
    const bool is_read = read_picture(a, frame->reference, &bytes, &size, reference);
    free(bytes);
    return is_read && (strcmp(golden, reference) == 0 || fail_outdated(a, changed));
}

static bool check_frame(struct approval *a, const struct kiln_result_frame *frame)
{
    /* A frame that fails with KILN_JUDGED_BY_NOTHING fails because its renders differ. */
    if (frame->status == KILN_TEST_FAIL && frame->judged_by == KILN_JUDGED_BY_NOTHING)
        return kiln_error_set(a->error, KILN_INVALID_INPUT, "%s: cannot be accepted: %s",
                              a->params->name, frame->message);
    if (!*frame->picture)
        return kiln_error_set(a->error, KILN_INVALID_INPUT,
                              "%s/%s/result.json: frame %u has no picture", a->place.results,
                              a->place.name, frame->number);
    if (!has_suffix(a->test, frame->picture))
        return fail_outdated(a, "the test's format has changed since the run");
    unsigned char *bytes = NULL;
    size_t size = 0;
    char pixels[65];
    const bool is_judged = read_judged(a, frame, &bytes, &size, pixels);
    free(bytes);
    return is_judged && check_golden(a, frame);
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

/* Writes the picture of a frame, after its bytes are checked once more: they may have changed since
 * the checks of all frames. */
static bool write_frame(struct approval *a, const struct kiln_result_frame *frame,
                        const char *golden, char path[KILN_PATH_SIZE])
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    char pixels[65];
    bool ok = read_judged(a, frame, &bytes, &size, pixels);
    const struct kiln_acceptance acceptance = {.frame = frame->number,
                                               .bytes = bytes,
                                               .size = size,
                                               .pixels = pixels,
                                               .state = frame->state,
                                               .device_name = a->result->device_name,
                                               .as = a->params->as,
                                               .golden = golden,
                                               .build = a->result->version};
    ok = ok && kiln_goldens_accept(a->arena, a->test, a->expect, &acceptance, path, a->error);
    free(bytes);
    return ok;
}

static bool accept_frame(struct approval *a, const struct kiln_result_frame *frame)
{
    char path[KILN_PATH_SIZE];
    struct kiln_goldens goldens;
    const bool hash = a->test->golden_form == KILN_GOLDEN_HASH;
    const bool replace = a->params->as == KILN_APPROVE_REPLACE || hash;
    if (!kiln_goldens_find(a->test, frame->number, a->result->device_name, &goldens, a->error))
        return false;
    const char *golden = find_golden(&goldens, frame);
    if (!golden && !hash)
        return fail_outdated(a, "its goldens have changed since the run");
    if (a->params->dry_run && !replace &&
        !kiln_goldens_place(a->test, frame->number, a->result->device_name, a->params->as, path,
                            a->error))
        return false;
    if (!a->params->dry_run && !write_frame(a, frame, golden, path))
        return false;
    if (!hash)
        report_change(a, a->params->dry_run && replace ? golden : path, "");
    return true;
}

/* Accepts all wanted frames, and with them the scene, since no frame remains that is not accepted.
 */
static bool write_all(struct approval *a)
{
    const struct kiln_test *test = a->test;
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
    a->expect = kiln_expect_read(a->arena, a->test->golden, a->error);
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
    ok = ok && check_test(&a) && check_scene(&a);
    if (ok) {
        int lock = params->dry_run ? -1 : kiln_goldens_lock(a.test, error);
        ok = (params->dry_run || lock >= 0) && approve_locked(&a);
        kiln_goldens_unlock(lock);
    }
    free(a.scene_text);
    kiln_arena_destroy(&a.arena);
    return ok;
}
