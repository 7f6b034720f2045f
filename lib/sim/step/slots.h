/* Declares the loop that simulate=cpu runs over slots. */
#ifndef KILN_SIM_STEP_SLOTS_H
#define KILN_SIM_STEP_SLOTS_H

#include "base/simd.h"
#include "shared/step_family.h"

struct kiln_slots {
    struct kiln_sim sim;
    struct kiln_particle *records; /* records of the system */
    struct kiln_trace *traces;     /* traces of all systems */
};

/* Steps slots begin to end - 1, for kiln_threads_for; context points to a kiln_slots. The slots of
 * a system's parent must have been stepped before. */
typedef void kiln_slots_step(void *context, size_t begin, size_t end, uint32_t worker);
KILN_SIMD_DECLARE(kiln_slots_step, kiln_slots_step);

#endif
