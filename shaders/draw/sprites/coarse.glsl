/* Where a pixel of the frame lies among those of its smaller picture: struct kiln_coarse_images. */
#include "shared/coarse.h"

uniform float factor;
uniform vec2 beyond; /* px of the frame */

/* Whole numbers are the middles of coarse pixels. */
vec2 coarse_place(vec2 pixel)
{
    return (pixel + beyond) / factor - 0.5;
}

/* How much of a pixel is drawn finely: 1 near an edge, falling to 0 over a coarse pixel. */
float fine_part(sampler2D edges, vec2 place)
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
