/* Finds the outline of a particle in the picture (Heinz 2019, 3.2.3, equation 3.1): four corners,
 * and the rows by which place.glsl finds the place of a pixel on the particle. A point or a line is
 * a rectangle in the picture; a billboard lies in the plane that particle.glsl chose for it.
 *
 * corner.glsl includes it, for quads that GL draws, and particles_tiled_make.comp, for sprites of
 * compute shaders. Both first declare the view and the variables center, right, up and particle,
 * which particle.glsl fills in. The rows must be the same for all techniques, so that they cover
 * the same pixels (shared/billboard_place.h). */
#include "shared/billboard_place.h"

#include "draw/sprites/place.glsl"

struct outline {
    place rows;
    vec2 corners[4];     /* px from the top left; without a meaning unless `in_front` */
    float nearest_depth; /* the smallest of its depths, m */
    bool in_front;       /* all corners are before the eye */
    bool has_area;       /* it has an area */
};

/* Returns corner i of a strip of two triangles, as -1 or 1 to the right and up. */
vec2 outline_corner(int i)
{
    return vec2(i < 2 ? -1.0 : 1.0, (i & 1) == 0 ? 1.0 : -1.0);
}

/* Returns where a point of view space before the eye is in the picture, px from the top left. */
vec2 to_pixels(vec3 v)
{
    picture_point at = picture_point_of(view.frustum, v);
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

#if SHAPES

/* Finds the outline of a billboard in any plane. */
outline find_outline()
{
    billboard_place p = billboard_place_deep(view.frustum, center.xyz, right.xyz, up.xyz, 1.0);
    outline s;
    s.rows = rows_of(p);
    s.nearest_depth = -center.z;
    s.in_front = true;
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        vec3 at = center.xyz + (right.xyz * corner.x + up.xyz * corner.y);
        s.in_front = s.in_front && -at.z >= 1e-3 * -center.z;
        s.corners[i] = to_pixels(at);
        s.nearest_depth = min(s.nearest_depth, -at.z);
    }
    s.has_area = p.seen;
    return s;
}

/* Finds the outline of a line, or of a point, which is a line of no length. Half a pixel is added all
 * around for soft edges; fragment.glsl adds the same half pixel. It stores the half edges without
 * that in particle.cells.xy, for shade.glsl. */
outline find_plain_outline()
{
    vec3 head = center.xyz;
    vec3 tail = stroke_tail(head, head + up.xyz, max(view.eye.w, 1e-3));
    stroke_place p = stroke_place_of(view.frustum, head, tail, right.w);
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
    billboard_flat p = billboard_place_flat(view.frustum, center.xyz, right.xyz, 1.0, up.xyz, 1.0, 1.0);
    outline s;
    s.rows = rows_of(p.place);
    vec2 middle = vec2(p.place.anchor.x, p.place.anchor.y);
    for (int i = 0; i < 4; i++) {
        vec2 corner = outline_corner(i);
        s.corners[i] = middle + vec2(p.right.x, p.right.y) * corner.x + vec2(p.up.x, p.up.y) * corner.y;
    }
    s.nearest_depth = -center.z;
    s.in_front = true;
    s.has_area = p.place.seen;
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
