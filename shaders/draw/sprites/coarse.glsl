/* Finds the place of a frame's pixel in the coarse picture of particles, which has half or a
 * quarter of the frame's width and height (lib/draw/sprites/coarse_images.h). The shaders
 * coarse_*.frag that need it include it. */
#include "shared/coarse.h"

uniform float coarse_edge_px; /* edge of a coarse pixel, px of the frame */
uniform vec2 margin_px;       /* of the coarse picture at the frame's left and top, px of the frame */

/* Returns the place of a frame's pixel in the coarse picture, in coarse pixels. Whole numbers are
 * the middles of coarse pixels. */
vec2 coarse_place(vec2 pixel)
{
    return (pixel + margin_px) / coarse_edge_px - 0.5;
}

/* Returns how much of a pixel comes from the picture of full resolution: 1 near an edge, falling to
 * 0 over a coarse pixel. */
float fine_weight(sampler2D edges, vec2 place)
{
    ivec2 low = ivec2(floor(place)), last = textureSize(edges, 0) - 1;
    vec2 part = place - vec2(low);
    vec2 sums[2];
    for (int i = 0; i < 2; i++) {
        ivec2 above = clamp(low + ivec2(i, 0), ivec2(0), last);
        ivec2 below = clamp(low + ivec2(i, 1), ivec2(0), last);
        sums[i].x = texelFetch(edges, above, 0).r;
        sums[i].y = texelFetch(edges, below, 0).r;
    }
    vec2 mixed = mix(sums[0], sums[1], part.x);
    return mix(mixed.x, mixed.y, part.y);
}
