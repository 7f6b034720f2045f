/* Writes the farthest depth of the frame's pixels in a coarse pixel; and 1 if one of these pixels
 * does not lie on a plane with its neighbours, else 0. */
#include "draw/sprites/coarse.glsl"

layout(binding = 0) uniform sampler2D depth;

layout(location = 0) out float out_depth;
layout(location = 1) out float out_nonplanar;

float depth_at(ivec2 pixel)
{
    return texelFetch(depth, pixel, 0).r;
}

bool is_nonplanar(ivec2 pixel, ivec2 step_, ivec2 size)
{
    ivec2 before = pixel - step_, after = pixel + step_;
    if (any(lessThan(before, ivec2(0))) || any(greaterThanEqual(after, size)))
        return false;
    return coarse_is_nonplanar(depth_at(before), depth_at(pixel), depth_at(after));
}

void main()
{
    ivec2 size = textureSize(depth, 0);
    ivec2 first = ivec2(gl_FragCoord.xy) * int(coarse_edge_px) - ivec2(floor(margin_px));
    ivec2 from = max(first, ivec2(0)), to = min(first + int(coarse_edge_px), size);
    float farthest = 0.0, nonplanar = 0.0;
    for (int y = from.y; y < to.y; y++) {
        for (int x = from.x; x < to.x; x++) {
            ivec2 pixel = ivec2(x, y);
            farthest = max(farthest, depth_at(pixel));
            if (is_nonplanar(pixel, ivec2(1, 0), size) || is_nonplanar(pixel, ivec2(0, 1), size))
                nonplanar = 1.0;
        }
    }
    out_depth = farthest;
    out_nonplanar = nonplanar;
}
