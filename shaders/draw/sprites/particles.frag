/* Shades one fragment of a particle's billboard, for raster=geometry and raster=instanced.
 * lib/draw/sprites/particles_geometry.c links it with particles_geometry.geom or with
 * particles_instanced.vert, whose outputs are declared in fragment.glsl, and draws all particles of
 * a pass by one call; GL blends the premultiplied colours that this shader returns. Where pixels
 * sort their fragments (post.compose: oit), particles_list.frag takes its place.
 *
 * The quad is a little larger than the particle. is_covered decides which pixels the particle
 * covers, by the rows that every technique uses (place.glsl), and the others are discarded. The
 * depth test (lib/draw/sprites/occlusion.h) rejects only fragments that are surely hidden; shade
 * compares depth with that of the scene at the pixel, so that soft particles fade near surfaces. */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

#include "draw/sprites/fragment.glsl"

void main()
{
    vec2 at;
    float depth;
    if (!is_covered(at, depth))
        discard;
    float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    shade(quad, at, depth, scene, out_color, out_bloom);
}
