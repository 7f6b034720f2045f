/* Counts a fragment of a billboard, or puts it on the list of its pixel, for post.compose: oit.
 * lib/draw/sprites/fragments_gl.c draws all particles with it several times: once without `writes`,
 * to count the fragments of each pixel, and then with `writes`, for each part of the picture whose
 * lists fit into memory. fragments_merge.comp and fragments_resolve.frag sort and blend the lists.
 *
 * One program does both, since two programs may round differently and then keep different
 * fragments. So whether a fragment is kept, and in how many pieces, must not depend on `writes`. */
// variant: SHAPES=0
// variant: SHAPES=1
// variant: SHAPES=0 HAZE=1
// variant: SHAPES=0 GAS=1 GAS_BETWEEN=1
#include "shared/draw_layout.h"

layout(early_fragment_tests) in;

#include "draw/sprites/fragment.glsl"
#include "draw/sprites/fragments.glsl"
#include "draw/sprites/fragments_pixel.glsl"
#include "draw/sprites/gas_before.glsl"

uniform bool writes; /* false: count fragments; true: put them on lists */

/* Puts a fragment on its pixel's list, at the place `number`. front is 1 for the front sheet of
 * two, or 0. bloom: as of struct fragment. A fragment beyond the count is dropped, since it would
 * overwrite the list of the next pixel. */
void put(uint number, float depth, uint front, vec4 color, vec3 bloom)
{
    uint pixel = pixel_number(), next = ranges[pixel].first + number;
    if (number >= counts[pixel])
        return;
    list_keys[next] = uvec4(floatBitsToUint(depth), uint(quad.light_y.a) * 2u + front, next, 0u);
    fragments[next].color = color;
    fragments[next].bloom = vec4(bloom, 0.0);
}

void main()
{
    vec2 at;
    float depth;
    if (!is_covered(at, depth))
        return;
    float bulge = quad.light_x.a;
#if SHAPES
    if (is_plain(quad))
        bulge = 0.0;
#endif
    float depth_of_scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec4 color, bloom;
    shade(quad, at, depth, depth_of_scene, color, bloom);
    if (color == vec4(0.0))
        return;
    /* A round billboard becomes two sheets, one before and one behind its plane, so that an object
     * between them is covered by one sheet only (shared/fragment_layout.h). */
    vec2 from_middle = at * 2.0 - 1.0;
    float half_depth = 0.5 * bulge * sqrt(max(1.0 - dot(from_middle, from_middle), 0.0));
    uint pieces = half_depth > 0.0 ? 2u : 1u;
    if (!writes) {
        atomicAdd(counts[pixel_number()], pieces);
        return;
    }
    uint number = atomicAdd(ranges[pixel_number()].written, pieces);
#ifdef GAS
    blend_with_gas(gl_FragCoord.xy, depth, color, bloom);
    vec3 glow = bloom.rgb;
#else
    vec3 glow = quad.bloom.rgb;
#endif
    if (pieces == 1u) {
        put(number, depth, 0u, color, glow);
        return;
    }
    float alpha = half_alpha(color.a);
    color = vec4(color.rgb * half_color(alpha), alpha);
#ifdef GAS
    glow *= half_color(alpha);
#endif
    put(number, depth + half_depth, 0u, color, glow);
    put(number + 1u, max(depth - half_depth, 0.0), 1u, color, glow);
}
