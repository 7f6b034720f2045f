/* Computes where a collider carries a particle that sticks to it. It carries it as a rigid body:
 * the place keeps its distance to the collider's centre, also where the collider changes its size.
 * Terrain stands, and volumes, whose surfaces bend, carry nothing: what sticks to them stays in the
 * world.
 *
 * The centre moves, and the arm from the centre is turned by the rotation of the step alone. The
 * host finds each step's rotation between the poses at its ends, so their errors do not add up. */
#ifndef KILN_SHARED_RIDE_H
#define KILN_SHARED_RIDE_H

#include "shared/collide.h"
#include "shared/heading.h"

/* How a collider moves in a step. */
struct ride_motion {
    float3 center, center_end; /* m */
    float3 axis;               /* of the rotation: a unit vector */
    float angle;               /* rad */
};

FN float3 ride_vector(float4 v)
{
    EXACT float3 y = FLOAT3(v.x, v.y, v.z);
    return y;
}

FN float3 ride_middle(float4 low, float4 high)
{
    EXACT float3 y =
        FLOAT3(0.5f * (low.x + high.x), 0.5f * (low.y + high.y), 0.5f * (low.z + high.z));
    return y;
}

FN S(ride_motion) ride_motion_of(SIM_PARAM uint number)
{
    EXACT S(ride_motion) m;
    uint kind = AROUND(colliders[number].kind);
    m.center = FLOAT3(0.0f, 0.0f, 0.0f);
    m.center_end = m.center;
    m.axis = m.center;
    m.angle = 0.0f;
    EXACT float3 none = m.axis;
    if (kind < COLLIDER_TERRAIN) {
        EXACT float3 turn = FLOAT3(AROUND(colliders[number].min.w), AROUND(colliders[number].max.w),
                                   AROUND(colliders[number].min_end.w));
        m.center = ride_vector(AROUND(colliders[number].center));
        m.center_end = ride_vector(AROUND(colliders[number].center_end));
        m.axis = float3_normalize(turn, none);
        m.angle = float3_length(turn);
    }
    if (kind == COLLIDER_BOX) {
        m.center = ride_middle(AROUND(colliders[number].min), AROUND(colliders[number].max));
        m.center_end =
            ride_middle(AROUND(colliders[number].min_end), AROUND(colliders[number].max_end));
    } else if (kind == COLLIDER_SDF || kind == COLLIDER_DEPTH) {
        uint mesh = AROUND(colliders[number].mesh);
        EXACT float3 turn = ride_vector(AROUND(poses[mesh].turn));
        EXACT float rate = float3_length(turn);
        m.center = ride_vector(AROUND(poses[mesh].center));
        m.center_end = ride_vector(AROUND(poses[mesh].center_end));
        m.axis = float3_normalize(turn, none);
        m.angle = rate * STEP(derived.dt_s);
    }
    return m;
}

/* Returns where a place that is fixed to a collider after the part `since` of the step is after the
 * part `until`. If the collider stands, this is the same place, to the bit. */
FN float3 ride(S(ride_motion) m, float since, float until, float3 place)
{
    bool stands = m.center.x == m.center_end.x && m.center.y == m.center_end.y &&
                  m.center.z == m.center_end.z && m.angle == 0.0f;
    if (stands)
        return place;
    EXACT float3 way = float3_sub(m.center_end, m.center);
    EXACT float3 from = float3_add_scaled(m.center, way, since);
    EXACT float3 to = float3_add_scaled(m.center, way, until);
    EXACT float3 arm = float3_sub(place, from);
    EXACT float half_angle = 0.5f * m.angle * (until - since);
    EXACT S(exact_angle) turn = exact_sincos(half_angle);
    EXACT float3 sines = float3_scale(m.axis, turn.sine);
    EXACT float4 pose = FLOAT4(sines.x, sines.y, sines.z, turn.cosine);
    if (m.angle != 0.0f)
        arm = float3_turn(pose, arm);
    EXACT float3 y = float3_add(to, arm);
    return y;
}

/* Returns the word of a heading that is fixed to a collider (heading.h), as for a place. */
FN uint ride_heading(S(ride_motion) m, float since, float until, uint word)
{
    if (m.angle == 0.0f || word == 0u)
        return word;
    EXACT float half_angle = 0.5f * m.angle * (until - since);
    EXACT S(exact_angle) turn = exact_sincos(half_angle);
    EXACT float3 sines = float3_scale(m.axis, turn.sine);
    EXACT float4 pose = FLOAT4(sines.x, sines.y, sines.z, turn.cosine);
    EXACT float3 heading = heading_unpack(word);
    EXACT float3 turned = float3_turn(pose, heading);
    return heading_pack(turned);
}

/* Returns the velocity, m/s, of a place that a collider carries through the whole step. */
FN float3 ride_velocity(SIM_PARAM S(ride_motion) m, float3 place)
{
    EXACT float3 end = ride(m, 0.0f, 1.0f, place);
    EXACT float3 way = float3_sub(end, place);
    EXACT float3 y = float3_scale(way, AROUND(steps_per_s));
    return y;
}

#endif
