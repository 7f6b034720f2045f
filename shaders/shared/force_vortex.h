/* Computes a vortex: air that turns around an axis, rises along it and is drawn to it. */
#ifndef KILN_SHARED_FORCE_VORTEX_H
#define KILN_SHARED_FORCE_VORTEX_H

#include "shared/force.h"

struct vortex {
    float3 center; /* a point of the axis, m */
    float3 axis;   /* of length 1 */
    float radius;  /* of the core, m */
    float speed;   /* of the air around the axis at the core's edge, m/s */
    float inward;  /* speed of the air towards the axis there, m/s */
    float lift;    /* speed of the air along the axis, on the axis, m/s */
    uint profile;  /* VORTEX_* */
};

FN S(vortex) vortex_of(S(force_input) f)
{
    EXACT S(vortex) v;
    v.center = f.at.vector;
    v.axis = float3_normalize(f.at.second, FLOAT3(0.0f, 1.0f, 0.0f));
    v.radius = f.at.scale;
    v.speed = f.at.strength;
    v.inward = f.inward;
    v.lift = f.lift;
    v.profile = f.profile;
    return v;
}

/* The factor a at which the speed of Lamb and Oseen's vortex, (1 - e^(-a s^2)) / s, is greatest at
 * s = 1: e^a = 1 + 2 a. */
#define VORTEX_OSEEN 1.25643121f

/* Returns the speed divided by the distance from the axis, in units of its value at the core's
 * edge. `square` is the square of the distance in core radii. Rankine's core turns like a solid
 * body, and outside of it angular momentum is constant; Lamb and Oseen's vortex has no edge. */
FN float force_vortex_turn(float square, uint profile)
{
    EXACT float beyond = exact_rcp(square);
    EXACT float rankine = square <= 1.0f ? 1.0f : beyond;
    EXACT float spread = square * VORTEX_OSEEN;
    EXACT float oseen = (VORTEX_OSEEN + 0.5f) * forces_damping(spread);
    EXACT float turn = profile == VORTEX_LAMB_OSEEN ? oseen : rankine;
    return turn;
}

/* Computes the force. The inward speed follows the same law as the rotation. The air rises fastest
 * on the axis, half as fast at the core's edge. */
FN S(force_effect) force_vortex(S(force_input) f)
{
    EXACT S(vortex) v = vortex_of(f);
    EXACT float3 from = float3_sub(f.position, v.center);
    EXACT float along = -float3_dot(from, v.axis);
    EXACT float3 apart = float3_add_scaled(from, v.axis, along);
    EXACT float per_core = exact_rcp(v.radius);
    EXACT float square = float3_dot(apart, apart) * per_core * per_core;
    EXACT float turn = per_core * force_vortex_turn(square, v.profile);
    EXACT float swirl = v.speed * turn;
    EXACT float inward = -v.inward * turn;
    EXACT float widened = 1.0f + square;
    EXACT float rise = exact_div(v.lift, widened);
    EXACT float3 around = float3_cross(v.axis, apart);
    EXACT float3 air = float3_scale(around, swirl);
    air = float3_add_scaled(air, apart, inward);
    air = float3_add_scaled(air, v.axis, rise);
    f.at.strength = 1.0f; /* the air has its speed already */
    EXACT S(force_effect) effect = force_air(f, air);
    return effect;
}

#endif
