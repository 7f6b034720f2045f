/* Computes the plane that a particle's billboard lies in, how it is turned in that plane, and how
 * long its edges are (Heinz 2019, 2.1.1). The device `cpu` computes a vector of particles of one
 * system (lib/draw/sprites/sprite_simd.c), GL one particle (shaders/draw/sprites/particle.glsl).
 * All directions are in view space. */
#ifndef KILN_SHARED_BILLBOARD_H
#define KILN_SHARED_BILLBOARD_H

#include "shared/look_layout.h"
#include "shared/real.h"

/* The plane of a billboard: unit vectors. */
struct billboard_plane {
    real3 right, up, normal;
};

REAL_FN S(billboard_plane) billboard_plane_of(real3 right, real3 up, real3 normal)
{
    S(billboard_plane) plane;
    plane.right = right;
    plane.up = up;
    plane.normal = normal;
    return plane;
}

/* Returns whether billboards with this facing (LOOK_*) lie in the picture's own plane. */
FN bool billboard_is_flat(uint facing)
{
    return facing == LOOK_SCREEN || facing == LOOK_VELOCITY;
}

REAL_FN S(billboard_plane) billboard_plane_of_picture(void)
{
    real zero = real_all(0.0f), one = real_all(1.0f);
    return billboard_plane_of(REAL3(one, zero, zero), REAL3(zero, one, zero),
                              REAL3(zero, zero, one));
}

/* Returns the plane of a billboard that is not flat. upward: the axis of an axial billboard, or the
 * world's up direction. Where `upward` points at the eye, the billboard's right is the picture's.
 */
REAL_FN S(billboard_plane) billboard_plane_facing(uint facing, real3 upward, real3 center)
{
    S(billboard_plane) picture = billboard_plane_of_picture();
    real3 normal = picture.normal;
    if (facing == LOOK_VIEWPOINT || facing == LOOK_AXIAL)
        normal = real3_scale(center, -real_rsqrt(real3_dot(center, center)));
    real3 sideways = real3_cross(upward, normal);
    sideways = real3_select(real3_dot(sideways, sideways) < 1e-8f,
                            real3_add_scaled(picture.right, normal, -normal.x), sideways);
    real square = real3_dot(sideways, sideways);
    sideways =
        real3_select(square < 1e-30f, picture.right, real3_scale(sideways, real_rsqrt(square)));
    if (facing == LOOK_AXIAL)
        return billboard_plane_of(sideways, upward, real3_cross(sideways, upward));
    return billboard_plane_of(sideways, real3_cross(normal, sideways), normal);
}

/* Returns whether billboards with this facing lie in a plane of the world: LOOK_NORMAL all of them,
 * LOOK_SURFACE those that rest on a surface. */
FN bool billboard_is_aligned(uint facing)
{
    return facing == LOOK_NORMAL || facing == LOOK_SURFACE;
}

REAL_FN real3 billboard_turned(real3 v, float4 x, float4 y, float4 z)
{
    return REAL3(real3_dot_all(v, x), real3_dot_all(v, y), real3_dot_all(v, z));
}

/* Returns a plane of the world, whose normal is turned to the eye. Up is the world's up as far as
 * it lies in the plane, or -z in a plane within 45 degrees of level, so that a picture on the
 * ground stands upright for a viewer who looks along -z. normal: a unit vector in the world; x, y,
 * z: the rows that turn directions of the world to view space. */
REAL_FN S(billboard_plane) billboard_plane_across(real3 normal, real3 center, float4 x, float4 y,
                                                  float4 z)
{
    real zero = real_all(0.0f), one = real_all(1.0f);
    truth level = real_abs(normal.y) > 0.70710678f;
    real3 upward = real3_select(level, REAL3(zero, zero, -one), REAL3(zero, one, zero));
    upward = real3_add_scaled(upward, normal, -real3_dot(upward, normal));
    upward = real3_scale(upward, real_rsqrt(real3_dot(upward, upward)));
    real3 to_view = billboard_turned(normal, x, y, z);
    real side = real_select(real3_dot(to_view, center) > 0.0f, -one, one);
    return billboard_plane_of(billboard_turned(real3_cross(upward, normal), x, y, z),
                              billboard_turned(upward, x, y, z), real3_scale(to_view, side));
}

/* How a billboard in a plane of the world fades: as billboard_lies_on takes it. */
struct billboard_lying {
    real soft, near;
};

/* An aligned billboard with hard edges still fades, over this part of its size: where it lies in a
 * surface, rounding would decide which of its pixels are seen. */
#define BILLBOARD_LEAST_FADE 0.02f

/* soft: look.soft, 1/m. The result's `soft` is below 0, which marks aligned billboards. */
REAL_FN S(billboard_lying) billboard_lying_of(S(billboard_plane) plane, real3 center, real soft,
                                              real half_size)
{
    real reach = real_max(half_size, real_all(1e-9f));
    real away = real_abs(real3_dot(plane.normal, center));
    real hard = (0.5f / BILLBOARD_LEAST_FADE) / reach;
    S(billboard_lying) lying;
    lying.soft = -real_max(away * real_select(soft > 0.0f, soft, hard), real_all(1e-20f));
    lying.near = 1.0f / reach;
    return lying;
}

/* Returns the factor on the edge of a billboard by which its cells are chosen: the geometric mean
 * of how it is shortened along and across its slant. */
REAL_FN real billboard_slant(S(billboard_plane) plane, real3 center)
{
    real away = real_abs(real3_dot(plane.normal, center));
    return real_sqrt(away * real_rsqrt(real3_dot(center, center)));
}

/* The upward edge of a billboard: its unit direction along the plane's right and up, and half of
 * its length, m. */
struct billboard_edge {
    real x, y, half_length;
};

/* Returns the upward edge of a billboard that moves at a velocity, m/s, along the plane's right and
 * up. `still` is its edge by its angle. A stretched billboard, or one that faces along its
 * velocity, points where it moves and grows longer by `stretch`, s; a slow one keeps its angle. An
 * axial billboard always points along its axis. */
REAL_FN S(billboard_edge) billboard_stretched(uint facing, S(billboard_edge) still, real stretch,
                                              real moving_x, real moving_y)
{
    S(billboard_edge) edge = still;
    if (facing == LOOK_AXIAL) {
        edge.x = real_all(0.0f);
        edge.y = real_all(1.0f);
        edge.half_length = still.half_length + 0.5f * real_abs(moving_y) * stretch;
        return edge;
    }
    truth points = stretch > 0.0f;
    if (facing == LOOK_VELOCITY)
        points = stretch >= 0.0f; /* all of them: a stretch is never negative */
    real speed = real_sqrt(moving_x * moving_x + moving_y * moving_y);
    real scale = 1.0f / real_max(speed, real_all(1e-4f));
    real part = real_smoothstep(0.05f, 0.2f, speed);
    real x = real_mix(still.x, moving_x * scale, part);
    real y = real_mix(still.y, moving_y * scale, part) + 1e-5f;
    real shorter = real_rsqrt(x * x + y * y);
    edge.x = real_select(points, x * shorter, still.x);
    edge.y = real_select(points, y * shorter, still.y);
    edge.half_length = still.half_length + real_where(points, 0.5f * speed * stretch);
    return edge;
}

/* Returns the factor by which a stretched billboard is fainter where the stretch spreads its light:
 * the sum of its light stays that of the billboard at rest. */
REAL_FN real billboard_dimming(real still_half_length, real half_length)
{
    return still_half_length / real_max(half_length, real_all(1e-12f));
}

/* Returns whether a billboard shows the strip of its cell (KILN_ATLAS_STRIP). The level of a cell
 * follows from the width. At one or two texels a streak would be a bar, as bright at its ends as in
 * its middle. width, length: px. */
REAL_FN truth billboard_shows_strip(real width, real length)
{
    return truth_and(width <= 2.0f, length >= 4.0f);
}

/* Returns -1 for a billboard that spins backwards, or 1. Half of the particles spin backwards, and
 * are mirrored as well, unless they are LOOK_UNMIRRORED. unit: random, 0 to 1. */
REAL_FN real billboard_side(real unit)
{
    return real_select(unit < 0.5f, real_all(-1.0f), real_all(1.0f));
}

/* Returns a plane turned so that its up direction is that of the upward edge. side: billboard_side,
 * by which the right edge is mirrored. */
REAL_FN S(billboard_plane) billboard_rotated(S(billboard_plane) plane, S(billboard_edge) edge,
                                             real side)
{
    return billboard_plane_of(
        real3_add_scaled(real3_scale(plane.right, edge.y * side), plane.up, -edge.x * side),
        real3_add_scaled(real3_scale(plane.right, edge.x), plane.up, edge.y), plane.normal);
}

/* Half edges of a billboard, m, and a factor for its opacity. */
struct billboard_size {
    real half_width, half_length, opacity;
};

/* Returns the size of a billboard in a picture smaller than the frame: no edge is shorter than
 * KILN_COARSE_LEAST pixels, and the opacity makes up for the larger area. Without this, small
 * billboards would flicker. */
REAL_FN S(billboard_size) billboard_widened(real half_width, real half_length, real pixels_per_m)
{
    real least = 0.5f * KILN_COARSE_LEAST / pixels_per_m, area = half_width * half_length;
    S(billboard_size) size;
    size.half_width = real_max(half_width, least);
    size.half_length = real_max(half_length, least);
    size.opacity = area / (size.half_width * size.half_length);
    return size;
}

#endif
