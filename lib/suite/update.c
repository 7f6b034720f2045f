/* Accepts what a run of a test has rendered, as `kiln test --update` asks for: it writes goldens,
 * expect.yaml and the accepted scene. In a dry run it only notes what it would write. suite/run.c
 * calls kiln_trial_update once for each test, after all frames have been judged.
 *
 * Other processes may accept pictures of the same test for other devices at the same time. So
 * everything is written under the lock of the test's goldens, and expect.yaml is read again under
 * that lock. Of what was read, only the accepted scene and this device's entries of the frames in
 * question change. Nothing here may be written from the expect.yaml that the trial read before. */
#include <string.h>

#include "base/error.h"
#include "suite/trial.h"

/* What an update does with a frame. */
enum action {
    LEAVE,
    ACCEPT_HASHES,  /* only hashes go into expect.yaml */
    ACCEPT_PICTURE, /* the picture becomes a golden */
};

/* Chooses what an update does with a frame. A frame is left alone if two renders of it differed, or
 * if it could not be judged for another reason than a golden that cannot be decoded. */
static enum action choose_action(const struct kiln_trial *trial, size_t index)
{
    const struct kiln_result_frame *frame = &trial->result->frames[index];
    const struct kiln_trial_frame *own = &trial->frames[index];
    enum kiln_update least = KILN_UPDATE_ALL; /* the weakest --update that accepts this frame */
    if (own->unsteady || (frame->status == KILN_TEST_ERROR && !own->broken_golden))
        return LEAVE;
    if (frame->status == KILN_TEST_NEW)
        least = KILN_UPDATE_MISSING;
    else if (frame->status == KILN_TEST_FAIL || own->broken_golden)
        least = KILN_UPDATE_FAILED;
    if (trial->params->update < least)
        return LEAVE;
    /* These pixels are accepted already; only the hash of the state may be missing. */
    if (frame->judged_by == KILN_JUDGED_BY_PIXELS && frame->status == KILN_TEST_PASS)
        return *frame->state_expected || !own->equals_golden ? LEAVE : ACCEPT_HASHES;
    if (trial->test->kept == KILN_GOLDEN_HASH)
        return ACCEPT_HASHES;
    /* A golden with these pixels stays. A golden that is like the picture and only lacks an entry
     * in expect.yaml stays, too, unless --update all is given. */
    bool keeps = own->equals_golden || (own->unlisted && trial->params->update != KILN_UPDATE_ALL);
    return keeps ? ACCEPT_HASHES : ACCEPT_PICTURE;
}

/* Returns whether `--update all` must accept the scene although no picture asks for it: all
 * pictures pass, but the scene or the techniques are not those that were accepted. */
static bool is_scene_new(const struct kiln_trial *trial)
{
    const struct kiln_expect *expect = trial->expect;
    return trial->params->update == KILN_UPDATE_ALL && expect->scene_hash &&
           trial->result->status <= KILN_TEST_CHANGE &&
           (strcmp(expect->scene_hash, trial->rendering.scene.hash) != 0 ||
            strcmp(trial->result->techniques, trial->result->techniques_expected) != 0);
}

/* ---- A dry run ---------------------------------------------------------------------------- */

static bool announce(struct kiln_trial *trial, size_t index, enum action action,
                     struct kiln_error *error)
{
    const struct kiln_result_frame *frame = &trial->result->frames[index];
    uint32_t number = frame->number;
    char path[KILN_PATH_SIZE];
    if (action == ACCEPT_HASHES) {
        kiln_trial_note(trial, "would accept the hashes of frame %u on %s", number,
                        trial->rendering.device_name);
        return true;
    }
    if (trial->frames[index].has_golden) {
        kiln_trial_note(trial, "would write %s", frame->golden);
        return true;
    }
    if (!kiln_goldens_place(trial->test, number, trial->rendering.device_name, KILN_APPROVE_REPLACE,
                            path, error))
        return false;
    kiln_trial_note(trial, "would write %s", path);
    return true;
}

/* ---- An update -------------------------------------------------------------------------- */

static bool accept(struct kiln_trial *trial, size_t index, enum action action,
                   struct kiln_error *error)
{
    struct kiln_result_frame *frame = &trial->result->frames[index];
    const char *device = trial->rendering.device_name;
    char path[KILN_PATH_SIZE], picture[KILN_PATH_SIZE];
    if (action == ACCEPT_HASHES) {
        const bool hash = trial->test->kept == KILN_GOLDEN_HASH;
        const struct kiln_expect_pixels pixels = {
            .device = device,
            .hash = frame->pixels,
            .golden = hash ? NULL : trial->frames[index].golden_hash,
            .kiln = trial->result->version,
        };
        if (!kiln_expect_accept(trial->arena, trial->expect, frame->number, frame->state, &pixels))
            return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory",
                                  trial->test->golden);
        kiln_trial_note(trial, "accepted the hashes of frame %u on %s", frame->number, device);
    } else {
        if (!kiln_trial_path(trial, frame->picture, picture, error))
            return false;
        const struct kiln_acceptance acceptance = {
            .frame = frame->number,
            .picture = picture,
            .state = frame->state,
            .device_name = device,
            .as = KILN_APPROVE_REPLACE,
            .build = trial->result->version,
            .golden = trial->frames[index].has_golden ? frame->golden : NULL};
        if (!kiln_goldens_accept(trial->arena, trial->test, trial->expect, &acceptance, path,
                                 error))
            return false;
        kiln_trial_note(trial, "wrote %s", path);
    }
    frame->status = KILN_TEST_PASS;
    frame->message = "written";
    return true;
}

/* Accepts the scene, which goes with all pictures. While a picture is still new or fails, the scene
 * that was accepted before stays, so that a report can tell what has changed since. If none was
 * accepted before, this one is accepted in any case. */
static bool accept_scene(struct kiln_trial *trial, struct kiln_error *error)
{
    for (size_t i = 0; i < trial->result->frame_count; i++) {
        enum kiln_test_status status = trial->result->frames[i].status;
        if (status >= KILN_TEST_NEW && trial->expect->scene_hash)
            return true;
    }
    trial->expect->scene_hash = trial->rendering.scene.hash;
    trial->expect->bare = trial->test->kept == KILN_GOLDEN_HASH;
    if (trial->expect->bare)
        return true;
    if (!kiln_expect_set_techniques(trial->arena, trial->expect, trial->rendering.techniques))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", trial->test->golden);
    return kiln_goldens_write_scene(trial->test, trial->rendering.scene_text, error);
}

static bool accept_all(struct kiln_trial *trial, const enum action *actions,
                       struct kiln_error *error)
{
    trial->expect = kiln_expect_read(trial->arena, trial->test->golden, error);
    if (!trial->expect)
        return false;
    for (size_t i = 0; i < trial->result->frame_count; i++) {
        if (actions[i] != LEAVE && !accept(trial, i, actions[i], error))
            return false;
    }
    return accept_scene(trial, error) &&
           kiln_expect_write(trial->expect, trial->test->golden, error);
}

bool kiln_trial_update(struct kiln_trial *trial, struct kiln_error *error)
{
    size_t count = trial->result->frame_count, wanted = 0;
    enum action *actions = kiln_arena_alloc(trial->arena, count + 1, sizeof *actions);
    if (!actions)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", trial->test->golden);
    for (size_t i = 0; i < count; i++) {
        actions[i] = choose_action(trial, i);
        wanted += actions[i] != LEAVE;
        if (trial->params->dry_run && actions[i] != LEAVE && !announce(trial, i, actions[i], error))
            return false;
    }
    bool scene = is_scene_new(trial);
    const bool keeps_scene = scene && trial->test->kept == KILN_GOLDEN_PICTURE;
    if (keeps_scene && trial->params->dry_run)
        kiln_trial_note(trial, "would write %s/scene.yaml", trial->test->golden);
    if ((wanted == 0 && !scene) || trial->params->dry_run)
        return true;
    int lock = kiln_goldens_lock(trial->test, error);
    if (lock < 0)
        return false;
    bool ok = accept_all(trial, actions, error);
    kiln_goldens_unlock(lock);
    if (ok && keeps_scene)
        kiln_trial_note(trial, "wrote %s/scene.yaml", trial->test->golden);
    return ok;
}
