/* Sums up the light of the sky, the sun and the lamps on a particle, and expresses it along the
 * axes of the particle's billboard. Smoke scatters light, so the side of a sprite that faces away
 * from a light is dimmer but not black: half of each light counts as ambient, and half depends on
 * the normal. These are spherical harmonics of degrees 0 and 1. */
#ifndef KILN_SHARED_BILLBOARD_LIGHT_H
#define KILN_SHARED_BILLBOARD_LIGHT_H

#include "shared/billboard.h"

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

/* Adds a light. factor: half of the part of the light that arrives; towards: the direction to the
 * light, times the factor. */
REAL_FN S(light_sum) light_sum_add(S(light_sum) sum, float4 radiance, real factor, real3 towards)
{
    sum.red = light_channel_add(sum.red, radiance.x, factor, towards);
    sum.green = light_channel_add(sum.green, radiance.y, factor, towards);
    sum.blue = light_channel_add(sum.blue, radiance.z, factor, towards);
    return sum;
}

/* Adds a light that is far away in a direction. part: the part of the light that arrives. */
REAL_FN S(light_sum) light_sum_add_far(S(light_sum) sum, float4 radiance, real part,
                                       float4 direction)
{
    real factor = 0.5f * part;
    return light_sum_add(sum, radiance, factor,
                         REAL3(factor * direction.x, factor * direction.y, factor * direction.z));
}

/* Returns the light of the sky. The horizon's light comes from all sides; the top's light comes
 * from above and crosses more smoke. lit: the part of the light that the particle reflects;
 * through: the part of the light from above that smoke lets through. */
REAL_FN S(light_sum) light_sum_of_sky(float4 horizon, float4 top, real lit, real through)
{
    real around = lit * real_sqrt(through);
    S(light_sum) sum;
    sum.red = light_channel_of(horizon.x * around);
    sum.green = light_channel_of(horizon.y * around);
    sum.blue = light_channel_of(horizon.z * around);
    return light_sum_add_far(sum, top, lit * through, FLOAT4(0.0f, 1.0f, 0.0f, 0.0f));
}

/* Adds the sun. irradiance: of a surface that faces it. */
REAL_FN S(light_sum) light_sum_add_sun(S(light_sum) sum, float4 irradiance, float4 direction,
                                       real lit, real through)
{
    return light_sum_add_far(sum, irradiance, lit * through * (1.0f / 3.14159265f), direction);
}

/* Adds a lamp, whose light falls off by the square of the distance, and stays finite inside of the
 * lamp. position: the particle's, m. */
REAL_FN S(light_sum) light_sum_add_lamp(S(light_sum) sum, S(kiln_draw_light) lamp, real lit,
                                        real3 position)
{
    real3 towards = real3_towards(lamp.position_radius2, position);
    real d2 = real3_dot(towards, towards);
    real factor = 0.5f * lit / (d2 + (lamp.position_radius2.w + 1e-12f));
    real factor_a_metre = factor * real_rsqrt(d2 + 1e-9f);
    return light_sum_add(sum, lamp.color, factor, real3_scale(towards, factor_a_metre));
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
