/* A folder of saved states (job/state.h), where runs of a scene take them up and leave them. */
#ifndef KILN_JOB_STATES_H
#define KILN_JOB_STATES_H

#include "frame/loop.h"

struct kiln_states;

/* Lists the states in a folder that are of the scene's motion, which those of a spread sort are
 * only with the order that it keeps. Folder and scene are borrowed. NULL with KILN_IO when the
 * folder cannot be read, KILN_INVALID_INPUT when a file of the scene cannot, or KILN_DEVICE_FAILED.
 */
struct kiln_states *kiln_states_open(const char *folder, const struct kiln_scene *scene,
                                     const struct kiln_techniques *techniques,
                                     const struct kiln_log *log, struct kiln_error *error);
void kiln_states_close(struct kiln_states **states);

/* The motion hash of the scene. */
const char *kiln_states_motion(const struct kiln_states *states);

/* Puts a loop of the scene into the latest state that lies at or before the start of a frame, if
 * that is ahead of where the loop is. Files that cannot serve are passed over with a warning. False
 * when the loop is worthless now, with KILN_INVALID_INPUT, KILN_IO or KILN_DEVICE_FAILED. */
bool kiln_states_take_up(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                         struct kiln_error *error);

/* Saves the state of a loop that has advanced to a frame, and counts its particles. */
bool kiln_states_save(const struct kiln_states *states, struct kiln_loop *loop, uint32_t frame,
                      bool overwrite, uint64_t *alive, struct kiln_error *error);

/* The file of a step's state. KILN_IO when the path is too long. */
bool kiln_states_path(const struct kiln_states *states, uint32_t step, char path[KILN_PATH_SIZE],
                      struct kiln_error *error);

/* Whether the file of a step's state could be taken up; it is read through. The error says why not.
 */
bool kiln_states_check(const struct kiln_states *states, uint32_t step, struct kiln_error *error);

/* The latest step of which a file was listed, at most `step`; false: there is none. */
bool kiln_states_find(const struct kiln_states *states, uint32_t step, uint32_t *found);

#endif
