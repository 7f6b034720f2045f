/* What the others of its system do to a particle (docs/determinism.md, 8): gathered from the
 * state at the start of a step, before any particle moves, and applied within the step to what
 * lived before it. Two words a slot, and only of systems that interact; shaders of scenes without
 * any are spared it.
 */
#ifndef KILN_SHARED_PUSH_H
#define KILN_SHARED_PUSH_H

#include "shared/exact.h"
#include "shared/layout.h"

struct step_push {
    float3 velocity; /* m/s: change of it before the step */
    float3 position; /* m: added to where the step leads, so that no collider is passed */
    float radius;    /* m: how near its centre comes to colliders */
    uint slot;       /* whose it is */
    bool happens;
};

FN S(step_push) push_none(void)
{
    EXACT S(step_push) push;
    push.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
    push.position = FLOAT3(0.0f, 0.0f, 0.0f);
    push.radius = 0.0f;
    push.slot = 0u;
    push.happens = false;
    return push;
}

/* Of a slot in which nothing lived, it is zero. */
FN S(step_push) push_of(SIM_PARAM uint slot)
{
    EXACT S(step_push) push = push_none();
    push.slot = slot;
#if !defined(GL_core_profile) || defined(PUSHES)
    if (STEP(pushed) != 0u) {
        uint at = (STEP(first_push) + slot) * 2u;
        EXACT float4 velocity = PUSH_WORD(at);
        EXACT float4 position = PUSH_WORD(at + 1u);
        push.velocity = FLOAT3(velocity.x, velocity.y, velocity.z);
        push.position = FLOAT3(position.x, position.y, position.z);
        push.radius = velocity.w;
        push.happens = true;
    }
#endif
    return push;
}

FN float3 push_faster(S(step_push) push, float3 velocity)
{
    if (!push.happens)
        return velocity;
    EXACT float3 y = float3_add(velocity, push.velocity);
    return y;
}

FN float3 push_farther(S(step_push) push, float3 position)
{
    if (!push.happens)
        return position;
    EXACT float3 y = float3_add(position, push.position);
    return y;
}

#endif
