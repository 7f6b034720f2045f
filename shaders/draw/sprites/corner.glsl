/* Corners of a quad around a particle's outline, a little larger than it: GL puts corners onto a grid,
 * and each fragment finds out itself whether the particle covers it (draw/sprites/place.glsl). The
 * view block must be declared, and what draw/sprites/particle.glsl declares.
 */
#include "draw/sprites/occlusion.glsl"
#include "draw/sprites/outline.glsl"

layout(location = 0) flat out vec4 place_u;
layout(location = 1) flat out billboard quad;
layout(location = 11) flat out vec4 place_v;
#if SHAPES
layout(location = 12) flat out vec4 place_q;
#endif

/* px: the coarsest grid that GL may put corners on has four bits. */
const float MARGIN = 0.125;

bool is_seen(vec4 center, billboard particle)
{
    return -center.z > view.eye.w && particle.color.a > 0.0;
}

/* Corner i, moved along both of its edges until these have moved by the margin; near the ends of a
 * sliver not farther than that takes for an angle of 4 degrees. */
vec2 outer_corner(outline s, int i)
{
    vec2 a = s.corners[i] - s.corners[i ^ 1], b = s.corners[i] - s.corners[i ^ 2];
    a /= max(length(a), 1e-6);
    b /= max(length(b), 1e-6);
    float sine = abs(a.x * b.y - a.y * b.x);
    return s.corners[i] + (a + b) * (MARGIN / max(sine, 0.07));
}

/* Corner i of a strip of two triangles. Of all of it the depth is that of the nearest corner: the
 * fragment shader compares exact depths. */
void put_corner(int i, outline s)
{
    quad = particle;
    place_u = s.rows.u;
    place_v = s.rows.v;
#if SHAPES
    place_q = s.rows.q;
#endif
    float at = occlusion_place(s.least);
    vec2 scale = vec2(2.0, 2.0) / view.frustum.zw;
    gl_Position = vec4(outer_corner(s, i) * scale - 1.0, at, 1.0);
    if (s.before)
        return;
    vec2 corner = outline_corner(i);
    vec3 v = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
    gl_Position = vec4(v.x / view.frustum.x, -v.y / view.frustum.y, at * -v.z, -v.z);
}
