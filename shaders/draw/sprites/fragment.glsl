/* Declares the inputs of the fragments of billboards, and decides whether the particle covers a
 * fragment. particles.frag and particles_list.frag include it. */
#include "draw/sprites/billboard.glsl"
#include "draw/sprites/place.glsl"

layout(binding = KILN_UNIT_SCENE_DEPTH) uniform sampler2D scene_depth;

layout(location = 0) flat in vec4 place_u;
layout(location = 1) flat in billboard flat_quad;
layout(location = 11) flat in vec4 place_v;
#if SHAPES
layout(location = 12) flat in vec4 place_q;
#endif

#include "draw/sprites/shade.glsl"

#ifdef RIBBONS
#include "draw/sprites/ribbon_pixel.glsl"
#endif

billboard quad; /* of the fragment, by is_covered */

/* Returns whether the particle covers the fragment. at: the place on the particle, as of
 * place_covers; depth: the view-space depth of that place, m. */
bool is_covered(out vec2 at, out float depth)
{
    quad = flat_quad;
#ifdef RIBBONS
    if (is_ribbon(quad))
        return ribbon_covers(place_u, place_v, gl_FragCoord.xy, quad, depth, at);
#endif
    place rows = place(place_u, place_v, vec4(0.0), -rim_reach(quad));
    depth = quad.depth.x;
#if SHAPES
    rows.q = place_q;
    if (is_plain(quad))
        rows.edge = quad.cells.xy + 0.5;
#endif
    return place_covers(rows, gl_FragCoord.xy, depth, at);
}
