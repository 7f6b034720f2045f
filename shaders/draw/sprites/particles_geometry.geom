/* Turns a point into the quad around a particle's outline, or into nothing if the particle cannot
 * be seen. It runs between particles_geometry.vert and the fragment shader, for the technique
 * raster=geometry (lib/draw/sprites/particles_geometry.c). corner.glsl places the corners for
 * raster=geometry and for raster=instanced, since both techniques must cover the same pixels.
 * particle.glsl says what SHAPES is. */
// variant: SHAPES=0
// variant: SHAPES=1
#include "shared/draw_layout.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

#include "draw/sprites/billboard.glsl"

layout(location = 0) in vec4 point_center[];
layout(location = 1) in vec4 point_right[];
layout(location = 2) in vec4 point_up[];
layout(location = 3) in billboard point_particle[];

/* corner.glsl reads these variables, which particle.glsl describes. */
vec4 center, right, up;
billboard particle;

#include "draw/sprites/corner.glsl"

void main()
{
    center = point_center[0];
    right = point_right[0];
    up = point_up[0];
    particle = point_particle[0];
    if (!is_seen(center, particle))
        return;
    outline s = find_particle_outline();
    if (!s.has_area)
        return;
    for (int i = 0; i < 4; i++) {
        put_corner(i, s);
        EmitVertex();
    }
    EndPrimitive();
}
