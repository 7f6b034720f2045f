/* Computes how a particle that is a mesh is oriented in the world (Drone 2007, 7.4.4). The mesh's
 * own z axis is ahead and y is up. Only pictures depend on it, not the state. */
#ifndef KILN_SHARED_INSTANCE_H
#define KILN_SHARED_INSTANCE_H

#include "shared/heading.h"
#include "shared/random.h"
#include "shared/spin.h"

/* enum kiln_orient of the scene. */
#define ORIENT_VELOCITY 0u
#define ORIENT_SPIN     1u

/* The directions of the mesh's axes: unit vectors, right-handed. */
struct instance_axes {
    float3 x, y, z;
};

/* Returns the angle, rad, by which a particle has turned, from its rotation and its mean spin so
 * far (KILN_LOOK_TURN and KILN_LOOK_SPREAD of the look). turned_s: particle_turned_s. */
FN float instance_angle(uint stream, float4 turn, float4 spread, float turned_s)
{
    EXACT float angle = random_between(stream, RANDOM_ROTATION, turn.x, turn.y);
    EXACT float spin = random_between(stream, RANDOM_SPIN, spread.z, spread.w);
    EXACT float side = random_unit(stream, RANDOM_SPIN + 1u);
    EXACT float spun = spin * turned_s;
    angle = side < 0.5f ? angle - spun : angle + spun;
    return angle;
}

/* Returns the axes with z along the velocity. x is level, so that the mesh does not roll. */
FN S(instance_axes) instance_along(float3 velocity)
{
    EXACT float3 ahead = FLOAT3(0.0f, 0.0f, 1.0f);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 right = FLOAT3(1.0f, 0.0f, 0.0f);
    EXACT S(instance_axes) axes;
    axes.z = float3_normalize(velocity, ahead);
    EXACT float3 level = float3_cross(up, axes.z);
    axes.x = float3_normalize(level, right);
    axes.y = float3_cross(axes.z, axes.x);
    return axes;
}

/* Rotates a vector about a unit vector. */
FN float3 instance_turn(float3 v, float3 axis, float cosine, float sine)
{
    EXACT float along = float3_dot(v, axis) * (1.0f - cosine);
    EXACT float3 aside = float3_cross(axis, v);
    EXACT float3 y = float3_scale(v, cosine);
    y = float3_add_scaled(y, aside, sine);
    y = float3_add_scaled(y, axis, along);
    return y;
}

FN S(instance_axes) instance_about(float3 axis, float angle)
{
    EXACT S(exact_angle) turn = exact_sincos(angle);
    EXACT float3 right = FLOAT3(1.0f, 0.0f, 0.0f);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 ahead = FLOAT3(0.0f, 0.0f, 1.0f);
    EXACT S(instance_axes) axes;
    axes.x = instance_turn(right, axis, turn.cosine, turn.sine);
    axes.y = instance_turn(up, axis, turn.cosine, turn.sine);
    axes.z = instance_turn(ahead, axis, turn.cosine, turn.sine);
    return axes;
}

/* Returns the pose of a ball that collisions do not turn. */
FN float4 instance_pose(uint stream, float angle)
{
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 axis = random_direction(stream, RANDOM_AXIS, up, -1.0f);
    return spin_about(axis, angle);
}

/* Returns the axes of a pose of a ball that collisions turn. */
FN S(instance_axes) instance_posed(float4 pose)
{
    EXACT float3 right = FLOAT3(1.0f, 0.0f, 0.0f);
    EXACT float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    EXACT float3 ahead = FLOAT3(0.0f, 0.0f, 1.0f);
    EXACT S(instance_axes) axes;
    axes.x = float3_turn(pose, right);
    axes.y = float3_turn(pose, up);
    axes.z = float3_turn(pose, ahead);
    return axes;
}

FN S(instance_axes) instance_axes_of(uint orient, float3 velocity, float angle, uint stream)
{
    EXACT float3 axis = FLOAT3(0.0f, 1.0f, 0.0f);
    if (orient == ORIENT_VELOCITY)
        return instance_along(velocity);
    if (orient == ORIENT_SPIN)
        axis = random_direction(stream, RANDOM_AXIS, axis, -1.0f);
    return instance_about(axis, angle);
}

#endif
