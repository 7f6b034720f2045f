/* Limits the speed of particles. The limit may vary over a particle's life. After all forces have
 * acted, a faster particle is slowed in its direction of flight. If a system has several limits,
 * the lowest counts. */
#ifndef KILN_SHARED_FORCE_LIMIT_H
#define KILN_SHARED_FORCE_LIMIT_H

#include "shared/exact.h"
#include "shared/force.h"

FN float3 force_limit_one(float3 velocity, float limit)
{
    EXACT float square = float3_dot(velocity, velocity);
    EXACT float most = limit * limit;
    if (square <= most)
        return velocity;
    EXACT float factor = limit * exact_rsqrt(square);
    EXACT float3 y = float3_scale(velocity, factor);
    return y;
}

FN float3 force_limit_all(SIM_PARAM float3 position, float3 velocity, S(value_clocks) clocks)
{
    EXACT float3 y = velocity;
    if (!USES(USES_FORCES, FORCE_LIMIT))
        return velocity;
    for (uint i = 0u; i < STEP(force_count); i++) {
        EXACT S(value_clocks) here = forces_clocks(SIM position, y, clocks);
        EXACT float limit = VALUE_OF(KEYED_FORCE_STRENGTH, SIM_KEYS STEP(forces[i].strength), here);
        if (STEP(forces[i].kind) == FORCE_LIMIT)
            y = force_limit_one(y, limit);
    }
    return y;
}

#endif
