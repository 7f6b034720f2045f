/* Computes one corner of a particle's billboard, for raster=instanced: a particle is an instance of
 * four vertices. This needs no geometry shader, but each corner makes the particle anew (Heinz
 * 2019, 2.2.4; Terpstra 2023, figure 2.2). */
// variant: SHAPES=0
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

vec4 center, right, up;
billboard particle;

#ifdef HAZE
uniform float additive_alpha;
#endif

#include "draw/sprites/particle.glsl"

#include "draw/sprites/corner.glsl"

void main()
{
    make_item(uint(gl_InstanceID));
    particle.light_y.a = float(gl_InstanceID);
    outline s = find_particle_outline();
    if (is_seen(center, particle) && s.has_area)
        put_corner(gl_VertexID, s);
    else
        gl_Position = vec4(0.0, 0.0, 0.0, 1.0); /* the quad has no area */
}
