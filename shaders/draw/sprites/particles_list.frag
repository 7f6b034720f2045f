/* A fragment of a billboard, counted or put on its pixel's list. One program does both, so that what
 * is kept is decided once: two may round differently.
 */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(early_fragment_tests) in;

#include "draw/sprites/fragment.glsl"
#include "draw/sprites/fragments.glsl"
#include "draw/sprites/fragments_pixel.glsl"

uniform bool fills;

/* number: on the list. None is longer than counted, lest it writes into the next one's place. */
void put(uint number, float depth, uint half_, vec4 color)
{
    uint pixel = pixel_number(), next = places[pixel].first + number;
    if (number >= counts[pixel])
        return;
    list_keys[next] = uvec4(floatBitsToUint(depth), uint(quad.light_y.a) * 2u + half_, next, 0u);
    fragments[next].color = color;
    fragments[next].bloom = vec4(quad.bloom.rgb, 0.0);
}

void main()
{
    vec2 at;
    float depth, bulge = quad.light_x.a;
    if (!is_covered(at, depth))
        return;
#if SHAPES
    if (is_plain(quad))
        bulge = 0.0;
#endif
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec4 color, bloom;
    shade(quad, at, depth, scene, color, bloom);
    if (color == vec4(0.0))
        return;
    vec2 from_middle = at * 2.0 - 1.0;
    float half_depth = 0.5 * bulge * sqrt(max(1.0 - dot(from_middle, from_middle), 0.0));
    uint pieces = half_depth > 0.0 ? 2u : 1u;
    if (!fills) {
        atomicAdd(counts[pixel_number()], pieces);
        return;
    }
    uint number = atomicAdd(places[pixel_number()].filled, pieces);
    if (pieces == 1u) {
        put(number, depth, 0u, color);
        return;
    }
    float alpha = half_alpha(color.a);
    color = vec4(color.rgb * half_color(alpha), alpha);
    put(number, depth + half_depth, 0u, color);
    put(number + 1u, max(depth - half_depth, 0.0), 1u, color);
}
