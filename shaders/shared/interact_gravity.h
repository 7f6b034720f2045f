/* Computes gravity among all pairs of particles of a system (Drone 2007, 7.4.3), softened at small
 * distances (Plummer).
 *
 * The sources of a sum are added one by one in the order of their slots, so that it is the same
 * bits however they are cut into tiles; empty slots pull with strength 0. Sources may be the
 * particles of another system. */
#ifndef KILN_SHARED_INTERACT_GRAVITY_H
#define KILN_SHARED_INTERACT_GRAVITY_H

#include "shared/interact_body.h"

/* Returns position, m, and strength: acceleration at 1 m, in m/s^2. */
FN float4 gravity_source(CROWD_PARAM S(kiln_particle) p)
{
    EXACT float3 position = particle_position(p);
    EXACT float strength = value_at(CROWD_KEYS INTERACT(strength), body_clocks(CROWD p));
    EXACT float pull = exact_canon(strength);
    EXACT float4 y = FLOAT4(position.x, position.y, position.z, pull);
    return y;
}

FN float4 gravity_no_source(void)
{
    EXACT float4 y = FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    return y;
}

#define PULL            float
#define PULL_FN         FN
#define PULL_BITS(x)    FLOAT_BITS(x)
#define PULL_OF_BITS(i) BITS_FLOAT(i)
#define PULL_RSQRT      gravity_rsqrt
#define PULL_A_METRE    gravity_a_metre
#include "shared/gravity_pull.h"
#undef PULL
#undef PULL_FN
#undef PULL_BITS
#undef PULL_OF_BITS
#undef PULL_RSQRT
#undef PULL_A_METRE

/* Adds the acceleration at a place by one more source. */
FN float3 gravity_add(float3 sum, float3 at, float4 source, float softening_square)
{
    EXACT float3 to = FLOAT3(source.x - at.x, source.y - at.y, source.z - at.z);
    EXACT float pull = gravity_a_metre(to.x, to.y, to.z, source.w, softening_square);
    EXACT float3 y = FLOAT3(sum.x + to.x * pull, sum.y + to.y * pull, sum.z + to.z * pull);
    return y;
}

/* Returns a push's velocity plus the effect of an acceleration in a step. */
FN float4 gravity_push(float4 velocity, float3 acceleration, float dt_s)
{
    EXACT float3 change = float3_scale(acceleration, dt_s);
    EXACT float3 c = float3_canon(change);
    EXACT float4 y = FLOAT4(velocity.x + c.x, velocity.y + c.y, velocity.z + c.z, velocity.w);
    return y;
}

#endif
