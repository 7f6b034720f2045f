/* Lists, finds, loads and saves the states in a folder. A file is named by the hash of its motion
 * and by its step, "3f9a12bc77d0e1f2-00000620.kilnstate", so that several scenes may share a
 * folder. */
#include "job/states.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/text.h"
#include "job/state.h"
#include "job/state_check.h"
#include "scene/motion.h"
#include "scene/pool_layout.h"

enum { PREFIX_DIGITS = 16 };

struct kiln_states {
    const char *folder;
    const struct kiln_scene *scene;
    struct kiln_log log;
    char motion[65];
    char history[65]; /* hash of what decides the history of a stage; "": none keeps one */
    uint32_t *steps;  /* the steps of the files, ascending */
    size_t count;
    size_t others; /* number of files of other motions */
};

/* ---- listing --------------------------------------------------------------------------------- */

/* Computes the hashes of the motion and of the history that a stage keeps. A history depends on
 * what the camera sees in each frame, and on the technique that keeps it. */
static bool take_hashes(struct kiln_states *states, const struct kiln_techniques *techniques,
                        struct kiln_error *error)
{
    char of_scene[65];
    if (!kiln_scene_part_hash(states->scene, KILN_PART_MOTION, states->motion, error))
        return false;
    const uint32_t technique = kiln_techniques_history(techniques);
    if (technique == 0)
        return true;
    if (!kiln_scene_part_hash(states->scene, KILN_PART_VIEW, of_scene, error))
        return false;
    char text[128];
    const int length = snprintf(text, sizeof text, "%s %u", of_scene, technique);
    kiln_hash_sha256(text, (size_t)length, states->history);
    return true;
}

/* Reads the step out of the name of a file of this motion. *other: the file is of another motion.
 */
static bool parse_name(const struct kiln_states *states, const char *name, uint32_t *step,
                       bool *other)
{
    const size_t length = strlen(name), suffix = strlen(KILN_STATE_SUFFIX);
    char digits[16] = "";
    *other = false;
    if (length <= suffix || strcmp(name + length - suffix, KILN_STATE_SUFFIX) != 0)
        return false;
    const size_t count = length - suffix - PREFIX_DIGITS - 1;
    *other = length < suffix + PREFIX_DIGITS + 2 ||
             memcmp(name, states->motion, PREFIX_DIGITS) != 0 || name[PREFIX_DIGITS] != '-' ||
             count >= sizeof digits;
    if (*other)
        return false;
    memcpy(digits, name + PREFIX_DIGITS + 1, count);
    uint64_t value = 0;
    const bool good = kiln_text_to_uint64(digits, &value) && value <= KILN_MAX_STEPS;
    *step = (uint32_t)value;
    return good;
}

static int compare_steps(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static bool add_step(struct kiln_states *states, uint32_t step, struct kiln_error *error)
{
    /* the array is full when count is a power of two */
    if ((states->count & (states->count - 1)) == 0) {
        const size_t room = states->count ? 2 * states->count : 1;
        uint32_t *steps = realloc(states->steps, room * sizeof *steps);
        if (!steps)
            return kiln_error_no_memory(error, "a list of states");
        states->steps = steps;
    }
    states->steps[states->count++] = step;
    return true;
}

static bool list(struct kiln_states *states, struct kiln_error *error)
{
    struct dirent **entries = NULL;
    const int count = scandir(states->folder, &entries, NULL, NULL);
    if (count < 0)
        return kiln_error_set_errno(error, KILN_IO, errno,
                                    "%s: the folder of states cannot be read", states->folder);
    bool ok = true;
    for (int i = 0; i < count; i++) {
        uint32_t step;
        bool other;
        if (ok && parse_name(states, entries[i]->d_name, &step, &other))
            ok = add_step(states, step, error);
        else if (ok)
            states->others += other;
        free(entries[i]);
    }
    free(entries);
    if (states->count > 0)
        qsort(states->steps, states->count, sizeof *states->steps, compare_steps);
    return ok;
}

struct kiln_states *kiln_states_open(const char *folder, const struct kiln_scene *scene,
                                     const struct kiln_techniques *techniques,
                                     const struct kiln_log *log, struct kiln_error *error)
{
    struct kiln_states *states = calloc(1, sizeof *states);
    if (!states) {
        kiln_error_no_memory(error, "a list of states");
        return NULL;
    }
    states->folder = folder;
    states->scene = scene;
    states->log = *log;
    if (!take_hashes(states, techniques, error) || !list(states, error))
        kiln_states_close(&states);
    return states;
}

void kiln_states_close(struct kiln_states **states)
{
    if (*states)
        free((*states)->steps);
    free(*states);
    *states = NULL;
}

const char *kiln_states_motion(const struct kiln_states *states)
{
    return states->motion;
}

bool kiln_states_path(const struct kiln_states *states, uint32_t step, char path[KILN_PATH_SIZE],
                      struct kiln_error *error)
{
    char name[PREFIX_DIGITS + sizeof KILN_STATE_SUFFIX + 16];
    snprintf(name, sizeof name, "%.*s-%08u" KILN_STATE_SUFFIX, PREFIX_DIGITS, states->motion, step);
    return kiln_path_join(path, states->folder, name, error);
}

bool kiln_states_find(const struct kiln_states *states, uint32_t step, uint32_t *found)
{
    size_t i = states->count;
    while (i > 0 && states->steps[i - 1] > step)
        i--;
    if (i > 0)
        *found = states->steps[i - 1];
    return i > 0;
}

/* ---- loading and saving ---------------------------------------------------------------------- */

/* Checks that the numbers of a state can come from steps of this scene. A hash alone does not prove
 * it, since anybody can write one. */
static bool fits(const struct kiln_scene *scene, const struct kiln_state_info *info)
{
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(scene);
    bool good = info->shape_count == layout.canvas_count;
    for (uint32_t i = 0; i < layout.canvas_count && good; i++) {
        const struct kiln_canvas_shape *found = &info->shapes[i], *shape = &layout.canvases[i];
        good = found->edge == shape->edge && found->slot_count == shape->slot_count &&
               (shape->slot_count == 0 || found->next < shape->slot_count);
    }
    for (uint32_t i = 0; i < scene->system_count; i++)
        good = good && info->spins[i] == layout.spins[i] && info->travels[i] == layout.travels[i];
    return good;
}

static bool check(const struct kiln_states *states, uint32_t step, struct kiln_state_info *info,
                  struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_states_path(states, step, path, error) || !kiln_state_check(path, info, error))
        return false;
    if (strcmp(info->motion, states->motion) != 0)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the state belongs to another motion, %.16s", path, info->motion);
    if (!fits(states->scene, info))
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: not a state of '%s'", path,
                              states->scene->name);
    if (info->step != step)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file holds the state of step %u",
                              path, info->step);
    if (states->history[0] && strcmp(info->history, states->history) != 0)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the state lacks the history that these techniques keep; bake "
                              "with the same --technique, camera and rates",
                              path);
    if (states->history[0] && kiln_scene_frame_step(states->scene, info->frame) != step)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the state is of frame %u, which does not begin at step %u", path,
                              info->frame, step);
    return true;
}

bool kiln_states_check(const struct kiln_states *states, uint32_t step, struct kiln_error *error)
{
    struct kiln_state_info info;
    return check(states, step, &info, error);
}

/* Allocates the words of the history that a loop keeps. They are NULL if it keeps none. */
static bool make_words(const struct kiln_states *states, struct kiln_loop *loop,
                       struct kiln_history_words *words, struct kiln_error *error)
{
    if (!states->history[0])
        return true;
    const uint32_t count = kiln_loop_run(loop)->pool.slot_count;
    words->of_slots = calloc((size_t)count + 1, sizeof *words->of_slots);
    return words->of_slots || kiln_error_no_memory(error, "a saved history");
}

static bool verify_hash(struct kiln_loop *loop, const struct kiln_state_info *info,
                        const char *path, struct kiln_error *error)
{
    struct kiln_state_hash hash;
    uint64_t alive;
    if (!kiln_loop_hash(loop, &hash, &alive, error))
        return false;
    return (memcmp(&hash, &info->hash, sizeof hash) == 0 && alive == info->alive) ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the file holds %" PRIu64
                          " particles of state %08x%08x, not the %" PRIu64
                          " of %08x%08x that it names",
                          path, alive, hash.lane[0], hash.lane[1], info->alive, info->hash.lane[0],
                          info->hash.lane[1]);
}

static bool take_up(const struct kiln_states *states, struct kiln_loop *loop, uint32_t step,
                    struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_run *run = kiln_loop_run(loop);
    const struct kiln_history *history = kiln_loop_history(loop);
    struct kiln_state state = {.pool = &run->pool};
    bool ok = make_words(states, loop, &state.history, error) &&
              kiln_states_path(states, step, path, error) &&
              kiln_state_read(&state, path, kiln_loop_threads(loop), error) &&
              kiln_state_check_births(&run->pool, states->scene, step, path, error);
    if (ok && state.history.of_slots)
        ok = history->kind->restore(history->technique, &run->pool, &state.history, error);
    free(state.history.of_slots);
    if (!ok)
        return false;
    run->step = step;
    kiln_loop_set_frame(loop, state.info.frame);
    return verify_hash(loop, &state.info, path, error);
}

/* Logs that a run starts at the scene's start although a folder of states was given. */
static void tell_of_none(const struct kiln_states *states, uint32_t frame)
{
    char others[80] = "";
    if (states->count == 0 && states->others > 0)
        snprintf(others, sizeof others, " (%zu states belong to other motions: bake again)",
                 states->others);
    kiln_log_write(&states->log, KILN_LOG_WARNING,
                   "%s: there is no state of '%s' at or before frame %u%s; stepping from the start",
                   states->folder, states->scene->name, frame, others);
}

bool kiln_states_take_up(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                         struct kiln_error *error)
{
    const uint32_t now = kiln_loop_run(loop)->step;
    uint32_t step = kiln_scene_frame_step(states->scene, frame);
    while (step > now && kiln_states_find(states, step, &step) && step > now) {
        struct kiln_state_info info;
        struct kiln_error reason = {0};
        if (check(states, step, &info, &reason))
            return take_up(states, loop, step, error);
        kiln_log_write(&states->log, KILN_LOG_WARNING, "%s; the state is not used", reason.message);
        step--;
    }
    if (now == 0 && kiln_scene_frame_step(states->scene, frame) > 0)
        tell_of_none(states, frame);
    return true;
}

bool kiln_states_save(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                      bool overwrite, uint64_t *alive, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_run *run = kiln_loop_run(loop);
    const struct kiln_history *history = kiln_loop_history(loop);
    struct kiln_state state = {.pool = &run->pool};
    memcpy(state.info.motion, states->motion, sizeof state.info.motion);
    memcpy(state.info.history, states->history, sizeof state.info.history);
    state.info.step = run->step;
    state.info.frame = frame;
    bool ok = make_words(states, loop, &state.history, error) &&
              kiln_states_path(states, run->step, path, error) &&
              kiln_loop_hash(loop, &state.info.hash, &state.info.alive, error) &&
              (!state.history.of_slots ||
               history->kind->save(history->technique, &run->pool, &state.history, error)) &&
              kiln_state_write(&state, path, overwrite, kiln_loop_threads(loop), error);
    free(state.history.of_slots);
    *alive = state.info.alive;
    return ok;
}
