/* How much of the sun convex shapes hide from a ball: as shaders/draw/sun_cover.glsl has it for a
 * point, with the ball's radius added to that of the penumbra.
 */
#ifndef KILN_DRAW_SUN_COVER_H
#define KILN_DRAW_SUN_COVER_H

#include "draw/shapes.h"

struct kiln_ball {
    float3 center;
    float radius; /* m */
};

/* 0 to 1. A shape hides the sun from what is behind it and, up to the ball's radius, inside of it.
 */
float kiln_box_sun_cover(float3 center, float3 half_size, struct kiln_ball ball,
                         const struct kiln_sun_frame *sun);
float kiln_sphere_sun_cover(float3 center, float radius, struct kiln_ball ball,
                            const struct kiln_sun_frame *sun);
float kiln_cylinder_sun_cover(float3 center, float radius, float3 axis, float half_height,
                              struct kiln_ball ball, const struct kiln_sun_frame *sun);

#endif
