/* Shades one fragment of a particle's billboard, for raster=geometry and raster=instanced.
 * lib/draw/sprites/particles_geometry.c links it with particles_geometry.geom or with
 * particles_instanced.vert, whose outputs are the inputs that fragment.glsl declares here. It draws
 * all particles of a pass by one call, and GL blends the premultiplied colours that this shader
 * returns. With post.compose: oit, particles_list.frag is linked instead of this file.
 *
 * The quad is a little larger than the particle. is_covered decides which pixels the particle
 * covers, by the same formula as every other technique (place.glsl), and the others are discarded.
 * The depth test, which lib/draw/sprites/occlusion.c sets up, rejects only fragments that are
 * surely hidden. So `shade` compares the depth of the particle with that of the scene at the pixel,
 * and fades soft particles near surfaces by it. */
// variant: SHAPES=0
// variant: SHAPES=1
// variant: SHAPES=0 HAZE=1
// variant: SHAPES=0 GAS=1
// variant: SHAPES=0 GAS=1 GAS_BETWEEN=1
#include "shared/draw_layout.h"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

#include "draw/sprites/fragment.glsl"
#include "draw/sprites/gas_before.glsl"

void main()
{
    vec2 at;
    float depth;
    if (!is_covered(at, depth))
        discard;
    float depth_of_scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    shade(quad, at, depth, depth_of_scene, out_color, out_bloom);
#ifdef GAS
    blend_with_gas(gl_FragCoord.xy, depth, out_color, out_bloom);
#endif
}
