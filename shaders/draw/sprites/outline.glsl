/* Finds the quad that a particle covers in the picture (Heinz 2019, 3.2.3, equation 3.1). A result
 * has the quad's corners and, in `rows`, linear functions that map a pixel to coordinates on the
 * particle, which place.glsl evaluates. A point or a line is a rectangle in the picture; a
 * billboard lies in the plane that particle.glsl chose for it.
 *
 * corner.glsl includes this file, for quads that GL draws, and particles_tiled_make.comp, for
 * sprites of compute shaders. Both first declare the view and the variables center, right, up and
 * particle, which particle.glsl describes and fills in. All techniques, that on the CPU included,
 * must compute the same rows, so that they cover the same pixels; shared/billboard_place.h has the
 * formulas. The callers draw only particles whose center lies beyond the near plane. */
#include "shared/billboard_place.h"

#include "draw/sprites/place.glsl"

struct outline {
    place rows;
    vec2 corners[4];     /* px from the top left, with the rim; undefined unless `in_front` */
    float nearest_depth; /* the smallest depth of the corners, m; of a billboard that lies on a
                          * surface, less its size */
    bool in_front;       /* all corners lie in front of the eye */
    bool has_area;       /* false: the billboard is seen edge-on and covers no pixel */
};

/* Returns corner i, in the order of a strip of two triangles. x is 1 at the particle's right edge,
 * y is 1 at its upper edge, and both are -1 at the opposite edges. */
vec2 outline_corner(int i)
{
    return vec2(i < 2 ? -1.0 : 1.0, (i & 1) == 0 ? 1.0 : -1.0);
}

/* Returns where a point in front of the eye, given in view space, is in the picture, px from the
 * top left. */
vec2 to_pixels(vec3 v)
{
    picture_point at = picture_point_of(view.frustum, view.principal, v);
    return vec2(at.x, at.y);
}

/* Packs rows as place.glsl reads them. */
place rows_of(billboard_place p)
{
    place rows;
    rows.u = vec4(p.u.at, p.u.x, p.u.y, p.anchor.x);
    rows.v = vec4(p.v.at, p.v.x, p.v.y, p.anchor.y);
    rows.q = vec4(p.q.at, p.q.x, p.q.y, 0.0);
    rows.edge = vec2(0.0);
    return rows;
}

/* Filters the edges of a small billboard: writes the rim to the particle, where shade.glsl reads
 * it. */
billboard_rim find_rim(billboard_place p, bool is_flat)
{
    billboard_rim rim = billboard_rim_of(p, is_flat, 1.0);
    particle.light_0.a = rim.u;
    particle.light_z.a = rim.v;
    particle.color.a *= rim.opacity;
    return rim;
}

#if SHAPES

/* The farthest that the rim of a billboard in any plane lies from its own edges, px: half of a
 * pixel's diagonal by which it is widened, and as much for the rim. */
const float RIM_MARGIN = 1.42;

/* Puts the corners around a rim: around the four corners of a billboard, which may be a sliver, it
 * lays a rectangle along the longer diagonal, with a margin, px. */
void surround(inout outline s, float margin)
{
    vec2 one = s.corners[3] - s.corners[0], other = s.corners[2] - s.corners[1];
    vec2 longer = dot(one, one) > dot(other, other) ? one : other;
    float size = length(longer);
    vec2 along = size > 1e-3 ? longer / size : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
    vec2 middle = 0.25 * (s.corners[0] + s.corners[1] + s.corners[2] + s.corners[3]);
    vec2 reach = vec2(0.0);
    for (int i = 0; i < 4; i++) {
        vec2 from_middle = s.corners[i] - middle;
        reach = max(reach, abs(vec2(dot(from_middle, along), dot(from_middle, across))));
    }
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i) * (reach + margin);
        s.corners[i] = middle + along * corner.x + across * corner.y;
    }
}

/* Finds the outline of a billboard in any plane. */
outline find_outline()
{
    billboard_place p = billboard_place_deep(view.frustum, view.principal, center.xyz, right.xyz, up.xyz, 1.0);
    outline s;
    billboard_rim rim = find_rim(p, false);
    s.rows = rows_of(rim.place);
    s.rows.edge = -rim_reach(particle);
    s.nearest_depth = -center.z;
    s.in_front = true;
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        vec3 at = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
        /* a corner nearer than a part of the center's depth would lie too far out in the picture */
        s.in_front = s.in_front && -at.z >= 1e-3 * -center.z;
        s.corners[i] = to_pixels(at);
        s.nearest_depth = min(s.nearest_depth, -at.z);
    }
    if (particle.cool.a < 0.0) /* it is seen on what is nearer by up to its size */
        s.nearest_depth = max(s.nearest_depth - 2.0 / particle.depth.w, 0.0);
    if (rim.u > 0.0)
        surround(s, RIM_MARGIN);
    s.has_area = p.seen;
    return s;
}

/* Finds the outline of a line, or of a point, which is a line of no length. The outline is half a
 * pixel wider on all sides, for soft edges; fragment.glsl widens its copy of the half edges in the
 * same way. This function also writes the half edges, without the half pixel, to particle.cells.xy,
 * where shade.glsl reads them; points and lines have no cells. */
outline find_stroke_outline()
{
    vec3 head = center.xyz;
    vec3 tail = stroke_tail(head, head + up.xyz, max(view.eye.w, 1e-3));
    stroke_place p = stroke_place_of(view.frustum, view.principal, head, tail, right.w);
    outline s;
    particle.cells.xy = vec2(p.edge_u, p.edge_v);
    s.rows = rows_of(p.place);
    s.rows.edge = particle.cells.xy + 0.5;
    vec2 middle = vec2(p.place.anchor.x, p.place.anchor.y);
    vec2 along = vec2(p.place.u.x, p.place.u.y);
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i) * s.rows.edge;
        s.corners[i] = middle + along * corner.x + vec2(-along.y, along.x) * corner.y;
    }
    s.nearest_depth = min(-head.z, -tail.z);
    s.in_front = true;
    s.has_area = true;
    return s;
}

#else

/* Finds the outline of a billboard that is parallel to the picture. */
outline find_outline()
{
    billboard_flat p = billboard_place_flat(view.frustum, view.principal, center.xyz, right.xyz, 1.0, up.xyz, 1.0, 1.0);
    outline s;
    billboard_rim rim = find_rim(p.place, true);
    s.rows = rows_of(rim.place);
    s.rows.edge = -rim_reach(particle);
    vec2 middle = vec2(p.place.anchor.x, p.place.anchor.y);
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i) * vec2(rim.reach_u, rim.reach_v);
        s.corners[i] = middle + vec2(p.right.x, p.right.y) * corner.x + vec2(p.up.x, p.up.y) * corner.y;
    }
    s.nearest_depth = -center.z;
    s.in_front = true;
    s.has_area = p.place.seen;
    return s;
}

#endif

#ifdef RIBBONS

/* Returns the place in the picture where a joint crosses the middle line; both are lines, x, y and at
 * of struct ribbon_line. */
vec2 meeting_of(vec3 middle, vec3 joint)
{
    vec2 foot = middle.xy * -middle.z, along = vec2(middle.y, -middle.x);
    float slope = dot(joint.xy, along);
    return foot - along * ((dot(joint.xy, foot) + joint.z) / (abs(slope) > 1e-6 ? slope : 1e-6));
}

/* Finds the outline of a part of a ribbon: a rectangle along its middle line that reaches beyond its
 * joints as far as they may lie aslant. */
outline find_ribbon_outline()
{
    vec3 middle = particle.light_x.xyz;
    vec2 from = meeting_of(middle, right.xyz), to = meeting_of(middle, up.xyz);
    vec2 along = vec2(middle.y, -middle.x), across = middle.xy;
    float half_width = max(right.w, up.w) + 1.5, reach = 2.0 * half_width;
    float begins = dot(from, along) - reach, ends = dot(to, along) + reach;
    outline s;
    s.rows.u = right;
    s.rows.v = up;
    s.rows.q = vec4(1.0, 0.0, 0.0, 0.0);
    s.rows.edge = vec2(-1e6); /* particles_tiled_mark.comp takes any tile */
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        float at = corner.x < 0.0 ? begins : ends;
        s.corners[i] = along * at + across * (corner.y * half_width - middle.z);
    }
    s.nearest_depth = 1.0 / max(particle.light_0.x, particle.light_0.y);
    s.in_front = true;
    s.has_area = true;
    return s;
}

#endif

/* Finds the outline of a particle, whichever shape it has. */
outline find_particle_outline()
{
#ifdef RIBBONS
    if (particle.color.r < 0.0)
        return find_ribbon_outline();
#endif
#if SHAPES
    if (center.w > 0.0)
        return find_stroke_outline();
#endif
    return find_outline();
}
