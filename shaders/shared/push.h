/* Declares pushes, the effect of the other particles of its system on a particle
 * (docs/determinism.md, 8). They are computed from the state at the start of a step, before any
 * particle moves, and applied within the step to particles that lived before it. A slot has two
 * words, but only in systems that interact; shaders of scenes without them are compiled without
 * pushes. */
#ifndef KILN_SHARED_PUSH_H
#define KILN_SHARED_PUSH_H

#include "shared/exact.h"
#include "shared/layout.h"

struct step_push {
    float3 velocity; /* m/s: change of the velocity before the step */
    float3 position; /* m: added to the place where the step leads, so that no collider is passed */
    float radius;    /* m: distance of its centre from colliders that it touches */
    uint slot;       /* slot of the particle */
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

/* Returns the push of a slot; it is zero if the slot had no living particle. */
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
