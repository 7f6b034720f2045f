/* Computes the corners of a quad around a particle's outline, for particles_geometry.geom and
 * particles_instanced.vert. The quad is a little larger than the outline, since GL moves corners
 * onto a grid; each fragment decides itself whether the particle covers it
 * (draw/sprites/place.glsl). The including shader declares the view block and the variables that
 * draw/sprites/particle.glsl fills in. */
#include "draw/sprites/occlusion.glsl"
#include "draw/sprites/outline.glsl"

layout(location = 0) flat out vec4 place_u;
layout(location = 1) flat out billboard quad;
layout(location = 11) flat out vec4 place_v;
#if SHAPES
layout(location = 12) flat out vec4 place_q;
#endif

/* px; GL's grid of corners may be as coarse as 1/16 px */
const float MARGIN = 0.125;

bool is_seen(vec4 center, billboard particle)
{
    return -center.z > view.eye.w && particle.color.a > 0.0;
}

/* Returns corner i, moved outwards along both of its edges until each edge has moved by MARGIN. At
 * the sharp ends of a sliver it moves no farther than for an angle of 4 degrees. */
vec2 outer_corner(outline s, int i)
{
    vec2 a = s.corners[i] - s.corners[i ^ 1], b = s.corners[i] - s.corners[i ^ 2];
    a /= max(length(a), 1e-6);
    b /= max(length(b), 1e-6);
    float sine = abs(a.x * b.y - a.y * b.x);
    return s.corners[i] + (a + b) * (MARGIN / max(sine, 0.07));
}

/* Writes corner i of a strip of two triangles. All corners get the depth of the nearest one, so
 * that the depth test rejects no visible fragment; the fragment shader compares exact depths. */
void put_corner(int i, outline s)
{
    quad = particle;
    place_u = s.rows.u;
    place_v = s.rows.v;
#if SHAPES
    place_q = s.rows.q;
#endif
    float at = occlusion_z(s.nearest_depth);
    vec2 scale = vec2(2.0, 2.0) / view.frustum.zw;
    gl_Position = vec4(outer_corner(s, i) * scale - 1.0, at, 1.0);
    if (s.in_front)
        return;
    vec2 corner = outline_corner(i);
    vec3 v = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
    v.xy -= view.principal.zw * v.z;
    gl_Position = vec4(v.x / view.frustum.x, -v.y / view.frustum.y, at * -v.z, -v.z);
}
