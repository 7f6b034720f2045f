/* Finds the outline of a particle in the picture (Heinz 2019, 3.2.3, equation 3.1): four corners,
 * and the rows by which place.glsl finds the place of a pixel on the particle. A point or a line is
 * a rectangle in the picture; a billboard lies in the plane that was chosen for it.
 *
 * corner.glsl includes it, for quads that GL draws, and particles_tiled_make.comp, for sprites of
 * compute shaders. Both first declare the view and the variables center, right, up and particle,
 * which particle.glsl fills in. The rows must be the same for all techniques, so that they cover
 * the same pixels; lib/draw/sprites/sprite_place.h computes them on the host. */
#include "draw/sprites/place.glsl"

struct outline {
    place rows;
    vec2 corners[4]; /* px from the top left; without a meaning unless `before` */
    float least;     /* the smallest of its depths, m */
    bool before;     /* all corners are before the eye */
    bool seen;       /* it has an area */
};

/* Returns corner i of a strip of two triangles, as -1 or 1 to the right and up. */
vec2 outline_corner(int i)
{
    return vec2(i < 2 ? -1.0 : 1.0, (i & 1) == 0 ? 1.0 : -1.0);
}

/* Returns where a point of view space is in the picture, px from the top left. It must be before
 * the eye. */
vec2 to_pixels(vec3 v)
{
    return view.frustum.zw * (0.5 + vec2(v.x, -v.y) / view.frustum.xy * (0.5 / -v.z));
}

#if SHAPES

/* Turns a linear function of the direction in view space into one of the pixels around the anchor:
 * its value at the anchor, and its change per pixel to the right and down. `w` becomes the fourth
 * number. */
vec4 plane_of(vec3 row, vec2 anchor, float w)
{
    vec2 slope = row.xy * 2.0 * view.frustum.xy / view.frustum.zw * vec2(1.0, -1.0);
    return vec4(dot(slope, anchor - 0.5 * view.frustum.zw) - row.z, slope, w);
}

/* Finds the outline of a billboard in any plane. A point of the picture is a direction d from the
 * eye, and the billboard's point there is depth * d = a * right + b * up + center. So (a, b, 1) /
 * depth is the inverse of the matrix of right, up and center, times d: linear in the pixel. */
outline find_outline()
{
    outline s;
    vec2 anchor = to_pixels(center.xyz);
    vec3 normal = cross(right.xyz, up.xyz);
    float det = dot(normal, center.xyz);
    float scale = abs(det) > 1e-12 ? 1.0 / det : 0.0;
    vec3 a = cross(up.xyz, center.xyz) * scale, b = cross(center.xyz, right.xyz) * scale;
    normal *= scale;
    s.rows.u = plane_of(0.5 * (normal + a), anchor, anchor.x);
    s.rows.v = plane_of(0.5 * (normal - b), anchor, anchor.y);
    s.rows.q = plane_of(normal, anchor, 0.0);
    s.rows.edge = vec2(0.0);
    s.least = -center.z;
    s.before = true;
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        vec3 at = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
        s.before = s.before && -at.z >= 1e-3 * -center.z;
        s.corners[i] = to_pixels(at);
        s.least = min(s.least, -at.z);
    }
    s.seen = scale != 0.0;
    return s;
}

/* Finds the outline of a line, or of a point, which is a line of no length. The ends reach out by
 * half of its width, and half a pixel is added all around for soft edges; fragment.glsl adds the
 * same half pixel. It stores the half edges without that in particle.cells.xy, for shade.glsl. */
outline find_plain_outline()
{
    outline s;
    vec3 head = center.xyz, tail = head + up.xyz;
    float near = max(view.eye.w, 1e-3);
    if (-tail.z < near)
        tail = mix(head, tail, (-head.z - near) / (tail.z - head.z));
    vec2 from = to_pixels(tail), to = to_pixels(head), way = to - from;
    float way_px = length(way);
    vec2 along = way_px > 1e-3 ? way / way_px : vec2(1.0, 0.0);
    vec2 extent = vec2(0.5 * way_px, 0.0) + right.w, middle = 0.5 * (from + to);
    vec2 edge = extent + 0.5;
    s.rows.u = vec4(0.0, along, middle.x);
    s.rows.v = vec4(0.0, -along.y, along.x, middle.y);
    /* The reciprocal of the depth changes evenly from one end of the rectangle to the other. */
    float first = 1.0 / -tail.z, last = 1.0 / -head.z;
    s.rows.q = vec4(0.5 * (first + last), along * (0.5 * (last - first) / edge.x), 0.0);
    s.rows.edge = edge;
    particle.cells.xy = extent;
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i) * edge;
        s.corners[i] = middle + along * corner.x + vec2(-along.y, along.x) * corner.y;
    }
    s.least = 1.0 / max(first, last);
    s.before = true;
    s.seen = true;
    return s;
}

#else

/* Finds the outline of a billboard that is parallel to the picture. */
outline find_outline()
{
    outline s;
    float depth = -center.z;
    vec2 middle = to_pixels(center.xyz);
    vec2 scale = 0.5 * view.frustum.zw / (view.frustum.xy * depth) * vec2(1.0, -1.0);
    vec2 r = right.xy * scale, u = up.xy * scale; /* half edges, px */
    float det = r.x * u.y - u.x * r.y;
    float half_edge = abs(det) > 1e-12 ? 0.5 / det : 0.0;
    s.rows.u = vec4(0.5, vec2(u.y, -u.x) * half_edge, middle.x);
    s.rows.v = vec4(0.5, vec2(r.y, -r.x) * half_edge, middle.y);
    s.rows.q = vec4(0.0);
    s.rows.edge = vec2(0.0);
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        s.corners[i] = middle + r * corner.x + u * corner.y;
    }
    s.least = depth;
    s.before = true;
    s.seen = half_edge != 0.0;
    return s;
}

#endif

/* Finds the outline of a particle of any shape. */
outline find_any_outline()
{
#if SHAPES
    if (center.w > 0.0)
        return find_plain_outline();
#endif
    return find_outline();
}
