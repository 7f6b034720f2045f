/* Computes the data of one particle's billboard; the geometry shader then makes the quad.
 * lib/draw/sprites/particles_geometry.c draws one point with this shader for each entry of the
 * drawing order (draw/moment/record.glsl). It does so for raster=geometry, and for raster=tiled
 * with `post.compose: oit`, where fragments are sorted pixel by pixel. particles_instanced.vert
 * does the same without a geometry shader. The outputs must be the inputs of
 * particles_geometry.geom. */
// variant: SHAPES=0
// variant: SHAPES=0 NO_SMOKE=1 NO_LAMPS=1
// variant: SHAPES=1
// variant: SHAPES=1 SUN_SHADE=1 LAMP_SHADE=1
// variant: SHAPES=1 LOOK_VALUES=1
// variant: SHAPES=1 LOOK_VALUES=1 LOOK_SOURCES=1
// variant: SHAPES=1 LOOK_VALUES=1 LOOK_PARENTS=1
// variant: SHAPES=1 HAZE=1
// variant: SHAPES=1 RIBBONS=4
// variant: SHAPES=1 HAZE=1 LOOK_VALUES=1 RIBBONS=4
#include "shared/draw_layout.h"

#include "draw/moment/record.glsl"

#include "draw/sprites/billboard.glsl"

layout(location = 0) out vec4 center;
layout(location = 1) out vec4 right;
layout(location = 2) out vec4 up;
layout(location = 3) out billboard particle;

#ifdef HAZE
uniform float additive_alpha;
#endif

#include "draw/sprites/particle.glsl"

void main()
{
    make_item(uint(gl_VertexID));
    /* The light does not use this component, so it holds the place in the drawing order, by which
     * particles_list.frag orders fragments of equal depth. A float holds it exactly, since there
     * are at most 2^24 particles. */
    particle.light_y.a = float(gl_VertexID);
}
