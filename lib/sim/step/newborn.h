/* Shows particles of bursts at the moment of their birth. A state has the particles that were born
 * before its time, so those of a burst at exactly that time are not in it: the next step gives
 * birth to them. For drawing they are added to the state, and removed again before the next
 * step. */
#ifndef KILN_SIM_STEP_NEWBORN_H
#define KILN_SIM_STEP_NEWBORN_H

#include "sim/world/params.h"

/* Holds what the shown particles took the place of. All zeros: none is shown. */
struct kiln_newborn {
    bool shown;
    struct kiln_pool_system systems[KILN_MAX_SYSTEMS];
    struct kiln_newborn_slot *slots;
    uint32_t count;
};

/* Adds the particles of all bursts at the end of step `step`, as they are born in the next step.
 * Fills in params for the births of that step. Does nothing if there are none. Afterwards, the pool
 * may be drawn and hashed, but not stepped or saved before kiln_newborn_hide. */
bool kiln_newborn_show(struct kiln_newborn *newborn, struct kiln_sim_params *params,
                       const struct kiln_scene *scene, struct kiln_pool *pool, uint32_t step,
                       struct kiln_error *error);

/* Restores the pool to the bits that it had before kiln_newborn_show. Does nothing if no particles
 * are shown. */
bool kiln_newborn_hide(struct kiln_newborn *newborn, struct kiln_pool *pool,
                       struct kiln_error *error);

void kiln_newborn_finish(struct kiln_newborn *newborn);

#endif
