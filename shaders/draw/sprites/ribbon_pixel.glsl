/* Decides whether a part of a ribbon covers a pixel, and which place of it the pixel shows, as
 * lib/draw/sprites/ribbon_pixels.h does. fragment.glsl and particles_tiled.comp include it where the
 * host defines RIBBONS; ribbon.glsl says what the billboard of such a part holds. */

#include "shared/ribbon_layout.h"

bool is_ribbon(billboard quad)
{
    return quad.color.r < 0.0;
}

float distance_from(vec3 line, vec2 pixel)
{
    return line.x * pixel.x + (line.y * pixel.y + line.z);
}

/* Returns what of a pixel's width a distance of 1 px from a line is. */
float widths_a_pixel(vec2 line)
{
    return 1.0 / (abs(line.x) + abs(line.y));
}

/* Returns whether a pixel lies no farther beyond a joint's middle, along the ribbon, than its corners
 * may. from: its distance from the joint, px; across: that from the middle line. */
bool is_near_joint(vec4 joint, vec2 middle, float from, float across, float sign)
{
    float turn = joint.x * middle.y - joint.y * middle.x;
    return from - sign * dot(joint.xy, middle) * across >= -RIBBON_CORNER * joint.w * turn;
}

/* Returns whether the part covers a pixel, given by its middle, px from the top left. begins, ends:
 * its joints, and half widths there. at: the place in the cell; depth: m. Turns the billboard into
 * one that is alike everywhere, and as it is there. */
bool ribbon_covers(vec4 begins, vec4 ends, vec2 pixel, inout billboard quad, out float depth, out vec2 at)
{
    uint flags = uint(quad.cells.y);
    float from = distance_from(begins.xyz, pixel), to = -distance_from(ends.xyz, pixel);
    float across = distance_from(quad.light_x.xyz, pixel);
    float past = max(from, 0.0), left = max(to, 0.0);
    float seen = past / max(past + left, 1e-6);
    float width = mix(begins.w, ends.w, seen);
    depth = 1.0 / mix(quad.light_0.x, quad.light_0.y, seen);
    float part = seen * quad.light_0.y * depth;
    at = vec2(mix(quad.light_0.z, quad.light_0.w, part), 0.5 + 0.5 * across / width);
    if ((flags & RIBBON_REPEATS) != 0u)
        at.x -= floor(at.x);
    float cover = clamp((width - abs(across)) * widths_a_pixel(quad.light_x.xy) + 0.5, 0.0, 1.0);
    bool inside = (flags & RIBBON_BEGINS) != 0u || from >= 0.0;
    inside = inside && ((flags & RIBBON_ENDS) != 0u || to > 0.0);
    cover *= (flags & RIBBON_BEGINS) != 0u ? clamp(from * widths_a_pixel(begins.xy) + 0.5, 0.0, 1.0) : 1.0;
    cover *= (flags & RIBBON_ENDS) != 0u ? clamp(to * widths_a_pixel(ends.xy) + 0.5, 0.0, 1.0) : 1.0;
    inside = inside && is_near_joint(begins, quad.light_x.xy, from, across, 1.0) &&
             is_near_joint(ends, quad.light_x.xy, to, across, -1.0);
    quad.color = vec4(0.0, 0.0, 0.0, mix(quad.color.g, quad.color.b, part) * cover);
    quad.hot.rgb = mix(quad.hot.rgb, quad.light_y.rgb, part);
    quad.cool.rgb = mix(quad.cool.rgb, quad.light_z.rgb, part);
    quad.cells.yz = vec2(quad.cells.x, 0.0);
    quad.light_0 = quad.light_z = vec4(0.0);
    quad.light_x.rgb = quad.light_y.rgb = vec3(0.0);
    return inside && cover > 0.0;
}
