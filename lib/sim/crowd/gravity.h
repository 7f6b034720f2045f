/* Declares the loop over all pairs that sums up gravity between particles on the host. */
#ifndef KILN_SIM_CROWD_GRAVITY_H
#define KILN_SIM_CROWD_GRAVITY_H

#include "base/simd.h"
#include "shared/interact_gravity.h"

/* Number of slots that are computed at a time. Arrays have room for a multiple of it. */
enum { KILN_GRAVITY_BLOCK = 32 };

struct kiln_gravity {
    const float4 *sources; /* gravity_source of each slot that may attract */
    size_t count;
    /* x, y, z of each slot, and w unused; up to a multiple of KILN_GRAVITY_BLOCK */
    const float4 *places;
    float softening_square; /* m^2 */
    float3 *accelerations;  /* one a slot, up to a multiple of KILN_GRAVITY_BLOCK */
};

/* Computes the accelerations of slots begin to end - 1, for kiln_threads_for; context points to a
 * kiln_gravity, and begin is a multiple of KILN_GRAVITY_BLOCK. */
typedef void kiln_gravity_run(void *context, size_t begin, size_t end, uint32_t worker);

struct kiln_gravity_loops {
    kiln_gravity_run *pull;
};
KILN_SIMD_DECLARE(const struct kiln_gravity_loops, kiln_gravity_loops);

#endif
