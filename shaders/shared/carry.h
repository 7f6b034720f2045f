/* Carries particles with a node (`space`): in each step, a place moves as the node's frame does,
 * and a velocity turns with it. The velocity in a particle's record is the one within the frame, in
 * the directions of the world. What moves with the frame has none, so drag does not slow it, and a
 * particle at rest in the frame stays at rest to the last bit. At an impact, the velocity of the
 * frame is added to it. */
#ifndef KILN_SHARED_CARRY_H
#define KILN_SHARED_CARRY_H

#include "shared/emit.h"

/* Returns whether the system's particles move with a node. */
#define CARRY_HAPPENS (USES(USES_EMITTERS, EMIT_CARRIED) && STEP(carried) != 0u)

/* Returns where the frame carries a place in the whole step. */
FN float3 carry_whole(S(kiln_carry) carry, float3 at)
{
    EXACT float3 start = FLOAT3(carry.frame.start.x, carry.frame.start.y, carry.frame.start.z);
    EXACT float3 end = FLOAT3(carry.end.x, carry.end.y, carry.end.z);
    EXACT float3 offset = float3_sub(at, start);
    EXACT float3 turned = float3_turn(carry.whole, offset);
    EXACT float3 y = float3_add(end, turned);
    return y;
}

/* Returns the rotation by one quaternion and then by another. */
FN float4 carry_turn_twice(float4 first, float4 second)
{
    EXACT float3 u = FLOAT3(first.x, first.y, first.z);
    EXACT float3 v = FLOAT3(second.x, second.y, second.z);
    EXACT float3 across = float3_cross(v, u);
    EXACT float3 sum = float3_add_scaled(across, v, first.w);
    sum = float3_add_scaled(sum, u, second.w);
    EXACT float cosines = second.w * first.w;
    EXACT float sines = float3_dot(v, u);
    EXACT float w = cosines - sines;
    EXACT float4 y = FLOAT4(sum.x, sum.y, sum.z, w);
    return y;
}

/* Returns how the frame turns from the part `since` of the step to the part `until`. */
FN float4 carry_turn(S(kiln_carry) carry, float since, float until)
{
    if (since == 0.0f && until == 1.0f)
        return carry.whole;
    EXACT float part = until - since;
    EXACT float4 turn = emit_frame_turn(carry.frame, part);
    if (until == 1.0f && carry.end.w != 0.0f)
        turn = carry_turn_twice(turn, carry.jump);
    return turn;
}

/* Returns where the frame carries a place from the part `since` of the step to the part `until`. */
FN float3 carry_place(S(kiln_carry) carry, float3 at, float since, float until)
{
    EXACT float3 y;
    if (since == 0.0f && until == 1.0f) {
        y = carry_whole(carry, at);
        return y;
    }
    EXACT float3 from = emit_frame_place(carry.frame, since);
    EXACT float3 to = emit_frame_place(carry.frame, until);
    if (until == 1.0f)
        to = FLOAT3(carry.end.x, carry.end.y, carry.end.z);
    EXACT float4 turn = carry_turn(carry, since, until);
    EXACT float3 offset = float3_sub(at, from);
    EXACT float3 turned = float3_turn(turn, offset);
    y = float3_add(to, turned);
    return y;
}

/* Returns how far the system's node carries a place, m; nothing if it has none. */
FN float3 carry_way(SIM_PARAM float3 at, float since, float until)
{
    EXACT float3 way = FLOAT3(0.0f, 0.0f, 0.0f);
    if (CARRY_HAPPENS) {
        EXACT float3 to = carry_place(STEP(carry), at, since, until);
        way = float3_sub(to, at);
    }
    return way;
}

/* Returns a velocity that turns with the system's node. */
FN float3 carry_velocity(SIM_PARAM float3 velocity, float since, float until)
{
    if (!CARRY_HAPPENS)
        return velocity;
    EXACT float4 turn = carry_turn(STEP(carry), since, until);
    EXACT float3 y = float3_turn(turn, velocity);
    return y;
}

/* Returns a place, carried for a part of the step; carried: the way of a whole step, m. */
FN float3 carry_on(SIM_PARAM float3 position, float3 carried, float part)
{
    if (!CARRY_HAPPENS)
        return position;
    EXACT float3 y = float3_add_scaled(position, carried, part);
    return y;
}

/* Turns a velocity within the node into one in the world if `sign` is 1, and back if it is -1. */
FN float3 carry_to_world(SIM_PARAM float3 velocity, float3 carried, float sign)
{
    if (!CARRY_HAPPENS)
        return velocity;
    EXACT float times = sign * AROUND(steps_per_s);
    EXACT float3 y = float3_add_scaled(velocity, carried, times);
    return y;
}

#endif
