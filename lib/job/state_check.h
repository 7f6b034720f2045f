/* Checks the values of a saved state. Its checksums and its state hash prove only that the file is
 * as somebody wrote it, and anybody can write one: drawing and stepping must not meet a value that
 * no step makes, such as a position that is no number. */
#ifndef KILN_JOB_STATE_CHECK_H
#define KILN_JOB_STATE_CHECK_H

#include "particles/pool.h"
#include "scene/scene.h"

/* Checks particles, spins and paint that were read from `path` into a pool, as the state after
 * `step`. Fails with KILN_INVALID_INPUT, naming the system, the slot, what was found and what is
 * allowed. */
bool kiln_state_check_pool(struct kiln_pool *pool, uint32_t step, const char *path,
                           struct kiln_error *error);

/* Checks what needs the scene: that each system had as many births as the scene gives it by `step`,
 * and that no particle is older than its life. It counts the births of all steps anew. */
bool kiln_state_check_births(struct kiln_pool *pool, const struct kiln_scene *scene, uint32_t step,
                             const char *path, struct kiln_error *error);

#endif
