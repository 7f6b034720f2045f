/* Accepts what a run of a test has rendered, as `kiln test --update` asks for: it writes goldens,
 * expect.yaml and the accepted scene. In a dry run it only notes what it would write. suite/run.c
 * calls kiln_test_case_update once for each test, after all frames have been judged.
 *
 * Other processes may accept pictures of the same test for other devices at the same time. So
 * everything is written under the lock of the test's goldens, and expect.yaml is read again under
 * that lock. Of what was read, only the accepted scene and this device's entries of the frames in
 * question change. Nothing here may be written from the expect.yaml that the test case read before.
 */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "suite/result_file.h"
#include "suite/test_case.h"

/* The ways in which an update treats a frame. */
enum action {
    LEAVE,
    ACCEPT_HASHES,  /* only hashes go into expect.yaml */
    ACCEPT_PICTURE, /* the picture becomes a golden */
};

/* Chooses what an update does with a frame. A frame is left alone if two renders of it differed, or
 * if it could not be judged for another reason than a golden that cannot be decoded. */
static enum action choose_action(const struct kiln_test_case *test_case, size_t index)
{
    const struct kiln_result_frame *frame = &test_case->result->frames[index];
    const struct kiln_test_case_frame *case_frame = &test_case->frames[index];
    enum kiln_update least = KILN_UPDATE_ALL; /* the weakest --update that accepts this frame */
    if (case_frame->repeat_difference ||
        (frame->status == KILN_TEST_ERROR && !case_frame->broken_golden))
        return LEAVE;
    if (frame->status == KILN_TEST_NEW)
        least = KILN_UPDATE_MISSING;
    else if (frame->status == KILN_TEST_FAIL || case_frame->broken_golden)
        least = KILN_UPDATE_FAILED;
    if (test_case->params->update < least)
        return LEAVE;
    /* These pixels are accepted already; only the hash of the state may be missing. */
    if (frame->judged_by == KILN_JUDGED_BY_PIXELS && frame->status == KILN_TEST_PASS)
        return *frame->state_expected || !case_frame->equals_golden ? LEAVE : ACCEPT_HASHES;
    if (test_case->test->golden_form == KILN_GOLDEN_HASH)
        return ACCEPT_HASHES;
    /* A golden with these pixels stays. A golden that is like the picture and only lacks an entry
     * in expect.yaml stays, too, unless --update all is given. */
    bool keeps = case_frame->equals_golden ||
                 (case_frame->without_expect && test_case->params->update != KILN_UPDATE_ALL);
    return keeps ? ACCEPT_HASHES : ACCEPT_PICTURE;
}

/* Returns whether `--update all` must accept the scene although no picture asks for it: all
 * pictures pass, but the scene or the techniques are not those that were accepted. */
static bool is_scene_new(const struct kiln_test_case *test_case)
{
    const struct kiln_expect *expect = test_case->expect;
    return test_case->params->update == KILN_UPDATE_ALL && expect->scene_hash &&
           test_case->result->status <= KILN_TEST_CHANGE &&
           (strcmp(expect->scene_hash, test_case->rendering.scene.hash) != 0 ||
            strcmp(test_case->result->techniques, test_case->result->techniques_expected) != 0);
}

/* ---- A dry run ---------------------------------------------------------------------------- */

static bool announce(struct kiln_test_case *test_case, size_t index, enum action action,
                     struct kiln_error *error)
{
    const struct kiln_result_frame *frame = &test_case->result->frames[index];
    uint32_t number = frame->number;
    char path[KILN_PATH_SIZE];
    if (action == ACCEPT_HASHES) {
        kiln_test_case_note(test_case, "would accept the hashes of frame %u on %s", number,
                            test_case->rendering.device_name);
        return true;
    }
    if (test_case->frames[index].has_golden) {
        kiln_test_case_note(test_case, "would write %s", frame->golden);
        return true;
    }
    if (!kiln_goldens_place(test_case->test, number, test_case->rendering.device_name,
                            KILN_APPROVE_REPLACE, path, error))
        return false;
    kiln_test_case_note(test_case, "would write %s", path);
    return true;
}

/* ---- An update -------------------------------------------------------------------------- */

static bool accept_picture(struct kiln_test_case *test_case, size_t index,
                           char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    const struct kiln_result_frame *frame = &test_case->result->frames[index];
    const struct kiln_result_place place = {test_case->suite->results_folder,
                                            test_case->test->full_name};
    char pixels[65];
    size_t size = 0;
    unsigned char *bytes = kiln_result_picture_read(&place, frame->picture, &size, error);
    const struct kiln_acceptance acceptance = {
        .frame = frame->number,
        .bytes = bytes,
        .size = size,
        .pixels = pixels,
        .state = frame->state,
        .device_name = test_case->rendering.device_name,
        .as = KILN_APPROVE_REPLACE,
        .build = test_case->result->version,
        .golden = test_case->frames[index].has_golden ? frame->golden : NULL};
    const bool ok = bytes && kiln_pixel_hash_of(bytes, size, frame->picture, pixels, error) &&
                    kiln_goldens_accept(test_case->arena, test_case->test, test_case->expect,
                                        &acceptance, path, error);
    free(bytes);
    return ok;
}

static bool accept(struct kiln_test_case *test_case, size_t index, enum action action,
                   struct kiln_error *error)
{
    struct kiln_result_frame *frame = &test_case->result->frames[index];
    const char *device = test_case->rendering.device_name;
    char path[KILN_PATH_SIZE];
    if (action == ACCEPT_HASHES) {
        const bool hash = test_case->test->golden_form == KILN_GOLDEN_HASH;
        const struct kiln_expect_pixels pixels = {
            .device = device,
            .hash = frame->pixels,
            .golden = hash ? NULL : test_case->frames[index].golden_hash,
            .kiln = test_case->result->version,
        };
        if (!kiln_expect_accept(test_case->arena, test_case->expect, frame->number, frame->state,
                                &pixels))
            return kiln_error_no_memory(error, "%s", test_case->test->golden);
        kiln_test_case_note(test_case, "accepted the hashes of frame %u on %s", frame->number,
                            device);
    } else {
        if (!accept_picture(test_case, index, path, error))
            return false;
        kiln_test_case_note(test_case, "wrote %s", path);
    }
    frame->status = KILN_TEST_PASS;
    frame->message = "written";
    return true;
}

/* Accepts the scene, which goes with all pictures. While a picture is still new or fails, the scene
 * that was accepted before stays, so that a report can tell what has changed since. If none was
 * accepted before, this one is accepted in any case. */
static bool accept_scene(struct kiln_test_case *test_case, struct kiln_error *error)
{
    for (size_t i = 0; i < test_case->result->frame_count; i++) {
        enum kiln_test_status status = test_case->result->frames[i].status;
        if (status >= KILN_TEST_NEW && test_case->expect->scene_hash)
            return true;
    }
    test_case->expect->scene_hash = test_case->rendering.scene.hash;
    test_case->expect->hashes_only = test_case->test->golden_form == KILN_GOLDEN_HASH;
    if (test_case->expect->hashes_only)
        return true;
    if (!kiln_expect_set_techniques(test_case->arena, test_case->expect,
                                    test_case->rendering.techniques))
        return kiln_error_no_memory(error, "%s", test_case->test->golden);
    return kiln_goldens_write_scene(test_case->test, test_case->rendering.scene_text, error);
}

static bool accept_all(struct kiln_test_case *test_case, const enum action *actions,
                       struct kiln_error *error)
{
    test_case->expect = kiln_expect_read(test_case->arena, test_case->test->golden, error);
    if (!test_case->expect)
        return false;
    for (size_t i = 0; i < test_case->result->frame_count; i++) {
        if (actions[i] != LEAVE && !accept(test_case, i, actions[i], error))
            return false;
    }
    return accept_scene(test_case, error) &&
           kiln_expect_write(test_case->expect, test_case->test->golden, error);
}

bool kiln_test_case_update(struct kiln_test_case *test_case, struct kiln_error *error)
{
    size_t count = test_case->result->frame_count, wanted = 0;
    enum action *actions = kiln_arena_alloc(test_case->arena, count + 1, sizeof *actions);
    if (!actions)
        return kiln_error_no_memory(error, "%s", test_case->test->golden);
    for (size_t i = 0; i < count; i++) {
        actions[i] = choose_action(test_case, i);
        wanted += actions[i] != LEAVE;
        if (test_case->params->dry_run && actions[i] != LEAVE &&
            !announce(test_case, i, actions[i], error))
            return false;
    }
    bool scene = is_scene_new(test_case);
    const bool keeps_scene = scene && test_case->test->golden_form == KILN_GOLDEN_PICTURE;
    if (keeps_scene && test_case->params->dry_run)
        kiln_test_case_note(test_case, "would write %s/scene.yaml", test_case->test->golden);
    if ((wanted == 0 && !scene) || test_case->params->dry_run)
        return true;
    int lock = kiln_goldens_lock(test_case->test, error);
    if (lock < 0)
        return false;
    bool ok = accept_all(test_case, actions, error);
    kiln_goldens_unlock(lock);
    if (ok && keeps_scene)
        kiln_test_case_note(test_case, "wrote %s/scene.yaml", test_case->test->golden);
    return ok;
}
