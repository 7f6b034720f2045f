/* A particle for the geometry shader. */
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
    particle.light_y.a = float(gl_VertexID);
}
