/* Declares the loop over all pairs that sums up gravity between particles on the host. */
#ifndef KILN_SIM_CROWD_GRAVITY_H
#define KILN_SIM_CROWD_GRAVITY_H

#include "base/simd.h"
#include "shared/interact_gravity.h"

/* Slots that are pulled at a time, in multiples of which there is room. */
enum { KILN_GRAVITY_BLOCK = 32 };

struct kiln_gravity {
    const float4 *sources; /* gravity_source of each that may pull */
    size_t count;
    const float4 *places;   /* x, y, z of each slot that is pulled, and w; up to a whole block */
    float softening_square; /* m^2 */
    float3 *accelerations;  /* of each slot, and up to a multiple of a block */
};

/* Fills in the accelerations of slots begin to end, of the kiln_gravity that context points to, for
 * kiln_threads_for; begin is a multiple of a block. */
typedef void kiln_gravity_run(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_gravity_loops {
    kiln_gravity_run *pull;
};
KILN_SIMD_DECLARE(const struct kiln_gravity_loops, kiln_gravity_loops);

#endif
