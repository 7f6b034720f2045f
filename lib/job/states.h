/* Declares a folder of saved states (job/state.h), which runs of a scene load and save. */
#ifndef KILN_JOB_STATES_H
#define KILN_JOB_STATES_H

#include "frame/loop.h"

struct kiln_states;

/* Lists the states in a folder that are of the scene's motion. Where a stage keeps a history, a
 * state also has to have it. Folder and scene are borrowed. NULL with KILN_IO when the
 * folder cannot be read, KILN_INVALID_INPUT when a file that the scene names cannot be read, or
 * KILN_DEVICE_FAILED. */
struct kiln_states *kiln_states_open(const char *folder, const struct kiln_scene *scene,
                                     const struct kiln_techniques *techniques,
                                     const struct kiln_log *log, struct kiln_error *error);
void kiln_states_close(struct kiln_states **states);

/* Returns the hash of the scene's motion. */
const char *kiln_states_motion(const struct kiln_states *states);

/* Loads the latest state at or before the start of a frame into a loop of the scene, if that is
 * ahead of the loop. A file that cannot be used is skipped with a warning. False with
 * KILN_INVALID_INPUT, KILN_IO or KILN_DEVICE_FAILED: then the loop must not be used. */
bool kiln_states_take_up(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                         struct kiln_error *error);

/* Saves the state of a loop that has advanced to a frame, and counts its particles. */
bool kiln_states_save(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                      bool overwrite, uint64_t *alive, struct kiln_error *error);

/* Makes the path of the state after a step. KILN_IO when it is too long. */
bool kiln_states_path(const struct kiln_states *states, uint32_t step, char path[KILN_PATH_SIZE],
                      struct kiln_error *error);

/* Returns whether the state of a step can be loaded; the whole file is read. If not, the error says
 * why. */
bool kiln_states_check(const struct kiln_states *states, uint32_t step, struct kiln_error *error);

/* Finds the latest listed step that is at most `step`; false: there is none. */
bool kiln_states_find(const struct kiln_states *states, uint32_t step, uint32_t *found);

#endif
