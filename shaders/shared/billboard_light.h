/* Sums up the light of the sky, the sun and the lamps on a particle, and expresses it along the
 * axes of the particle's billboard. Smoke scatters light, so the side of a sprite that faces away
 * from a light is dimmer but not black: half of each light counts as ambient, and half depends on
 * the normal. These are spherical harmonics of degrees 0 and 1. */
#ifndef KILN_SHARED_BILLBOARD_LIGHT_H
#define KILN_SHARED_BILLBOARD_LIGHT_H

#include "shared/billboard.h"
#include "shared/lamp.h"
#include "shared/smoke_grid.h"

/* The light of one colour: from all sides, and how it changes along the axes of the world or of a
 * billboard. */
struct light_channel {
    real all;
    real3 along;
};

struct light_sum {
    S(light_channel) red, green, blue;
};

REAL_FN S(light_channel) light_channel_of(real all)
{
    S(light_channel) channel;
    channel.all = all;
    channel.along = REAL3(real_all(0.0f), real_all(0.0f), real_all(0.0f));
    return channel;
}

REAL_FN S(light_channel) light_channel_add(S(light_channel) channel, float radiance, real factor,
                                           real3 towards)
{
    channel.all = channel.all + radiance * factor;
    channel.along = real3_add_scaled(channel.along, towards, real_all(radiance));
    return channel;
}

/* The parts of a light that reach a particle through smoke: from all sides, since smoke scatters
 * it, and straight from the light. */
struct light_parts {
    real all, straight;
};

/* Returns the parts that cross smoke of an optical depth. diffusion: smoke_diffusion; scale: of
 * both parts. */
REAL_FN S(light_parts) light_parts_through(real optical_depth, real diffusion, real scale)
{
    S(light_parts) parts;
    parts.all = scale * smoke_transmittance(diffusion * optical_depth);
    parts.straight = scale * smoke_transmittance(optical_depth);
    return parts;
}

/* Adds a light. all: half of the part of the light that arrives from all sides; towards: the
 * direction to the light, times half of the part that arrives straight. */
REAL_FN S(light_sum) light_sum_add(S(light_sum) sum, float4 radiance, real all, real3 towards)
{
    sum.red = light_channel_add(sum.red, radiance.x, all, towards);
    sum.green = light_channel_add(sum.green, radiance.y, all, towards);
    sum.blue = light_channel_add(sum.blue, radiance.z, all, towards);
    return sum;
}

/* Adds a light that is far away in a direction. */
REAL_FN S(light_sum) light_sum_add_far(S(light_sum) sum, float4 radiance, S(light_parts) parts,
                                       float4 direction)
{
    real straight = 0.5f * parts.straight;
    return light_sum_add(
        sum, radiance, 0.5f * parts.all,
        REAL3(straight * direction.x, straight * direction.y, straight * direction.z));
}

/* Returns the light of the sky. The top's light comes from above. The horizon's comes from all
 * sides, and so crosses half as much smoke at most. lit: the part of the light that the particle
 * reflects; above: optical depth of the smoke above; diffusion: smoke_diffusion. */
REAL_FN S(light_sum) light_sum_of_sky(float4 horizon, float4 top, real lit, real above,
                                      real diffusion)
{
    real around = lit * smoke_transmittance(real_min(diffusion, real_all(0.5f)) * above);
    S(light_sum) sum;
    sum.red = light_channel_of(horizon.x * around);
    sum.green = light_channel_of(horizon.y * around);
    sum.blue = light_channel_of(horizon.z * around);
    return light_sum_add_far(sum, top, light_parts_through(above, diffusion, lit),
                             FLOAT4(0.0f, 1.0f, 0.0f, 0.0f));
}

/* Adds the sun. irradiance: of a surface that faces it; parts: of it, without `lit`. */
REAL_FN S(light_sum) light_sum_add_sun(S(light_sum) sum, float4 irradiance, float4 direction,
                                       real lit, S(light_parts) parts)
{
    real scale = lit * (1.0f / 3.14159265f);
    parts.all = parts.all * scale;
    parts.straight = parts.straight * scale;
    return light_sum_add_far(sum, irradiance, parts, direction);
}

/* Adds a lamp, whose light falls off by the square of the distance, and stays finite inside of the
 * lamp. A rectangle counts as a disc of its area. position: the particle's, m; parts: of the lamp,
 * without `lit`. */
REAL_FN S(light_sum) light_sum_add_lamp(S(light_sum) sum, S(kiln_draw_light) lamp, real lit,
                                        real3 position, S(light_parts) parts)
{
    real3 towards = real3_towards(lamp.position_radius2, position);
    real d2 = real3_dot(towards, towards);
    real factor = 0.5f * lit / (d2 + (lamp.position_radius2.w + 1e-12f));
    if (lamp.facing.w != KILN_LAMP_POINT)
        factor = factor * lamp_share(lamp, towards);
    real straight_a_metre = factor * parts.straight * real_rsqrt(d2 + 1e-9f);
    return light_sum_add(sum, lamp.color, factor * parts.all,
                         real3_scale(towards, straight_a_metre));
}

REAL_FN S(light_channel) light_channel_along_plane(S(light_channel) channel, real base, float4 x,
                                                   float4 y, float4 z, S(billboard_plane) plane)
{
    real3 a = channel.along;
    real3 view = REAL3(real3_dot_all(a, x), real3_dot_all(a, y), real3_dot_all(a, z));
    channel.all = base + channel.all;
    channel.along = REAL3(real3_dot(view, plane.right), real3_dot(view, plane.up),
                          real3_dot(view, plane.normal));
    return channel;
}

/* Turns the changing part of the light from the axes of the world to those of a billboard: right,
 * up and towards the viewer. base: white light from all sides, which is added; x, y, z: the rows
 * that turn directions of the world to view space. */
REAL_FN S(light_sum) light_sum_along_plane(S(light_sum) sum, real base, float4 x, float4 y,
                                           float4 z, S(billboard_plane) plane)
{
    sum.red = light_channel_along_plane(sum.red, base, x, y, z, plane);
    sum.green = light_channel_along_plane(sum.green, base, x, y, z, plane);
    sum.blue = light_channel_along_plane(sum.blue, base, x, y, z, plane);
    return sum;
}

#endif
