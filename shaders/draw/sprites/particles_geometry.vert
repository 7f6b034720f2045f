/* Computes one particle for the geometry shader, which makes a billboard of it.
 * lib/draw/sprites/particles_geometry.c draws with it for raster=geometry, and for raster=tiled
 * where pixels sort: one point for each entry of the drawing order. particles_instanced.vert does
 * the same without a geometry shader. The outputs must be the inputs of particles_geometry.geom. */
// variant: SHAPES=0
// variant: SHAPES=1
// variant: SHAPES=1 SUN_SHADE=1
#include "shared/draw_layout.h"

#include "draw/moment/record.glsl"

#include "draw/sprites/billboard.glsl"

layout(location = 0) out vec4 center;
layout(location = 1) out vec4 right;
layout(location = 2) out vec4 up;
layout(location = 3) out billboard particle;

#include "draw/sprites/particle.glsl"

void main()
{
    make_particle(entries[gl_VertexID]);
    /* The place in the drawing order. Fragments of equal depth keep this order on the lists of
     * pixels (particles_list.frag). */
    particle.light_y.a = float(gl_VertexID);
}
