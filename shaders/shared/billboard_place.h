/* Computes where the pixels of the picture lie on a particle (Heinz 2019, 3.2.3, equation 3.1): on
 * a billboard that is parallel to the picture, on one in any plane, and on a point or a line. Every
 * rasteriser decides by these functions of the pixel which pixels a particle covers. The device
 * `cpu` reads them from lib/draw/sprites/sprite_place.h, GL from shaders/draw/sprites/outline.glsl.
 *
 * frustum, principal: those of struct kiln_view. Positions and directions are in view space, m. */
#ifndef KILN_SHARED_BILLBOARD_PLACE_H
#define KILN_SHARED_BILLBOARD_PLACE_H

#include "shared/real.h"

/* A place in the picture, px from the top left. */
struct picture_point {
    real x, y;
};

/* A linear function of the pixel: its value at the anchor, and its change per pixel to the right
 * and down. */
struct picture_slope {
    real at, x, y;
};

/* The texture coordinates u and v of a pixel. Where the depth changes over the particle, they are
 * divided by the depth, and q is 1 / depth, 1/m. */
struct billboard_place {
    S(picture_point) anchor;
    S(picture_slope) u, v, q;
    truth seen; /* the particle has an area */
};

/* Returns where a position before the eye is in the picture. */
REAL_FN S(picture_point) picture_point_of(float4 frustum, float4 principal, real3 position)
{
    real near = -1.0f / position.z;
    S(picture_point) point;
    point.x = principal.x + position.x * near * (0.5f * frustum.z / frustum.x);
    point.y = principal.y - position.y * near * (0.5f * frustum.w / frustum.y);
    return point;
}

REAL_FN S(picture_slope) picture_slope_of(real at, real x, real y)
{
    S(picture_slope) slope;
    slope.at = at;
    slope.x = x;
    slope.y = y;
    return slope;
}

/* ---- billboards parallel to the picture ------------------------------------------------------ */

/* The place of a flat billboard, and its half edges in the picture, px, y down. */
struct billboard_flat {
    S(billboard_place) place;
    S(picture_point) right, up;
};

/* Places a billboard whose edges are parallel to the picture. right, up: directions of its edges;
 * half_width, half_length: half of their lengths; edge: the texture coordinate at the far edges. q
 * is 0. */
REAL_FN S(billboard_flat) billboard_place_flat(float4 frustum, float4 principal, real3 center,
                                               real3 right, real half_width, real3 up,
                                               real half_length, real edge)
{
    real near = -1.0f / center.z;
    real scale_x = near * (0.5f * frustum.z / frustum.x);
    real scale_y = near * (0.5f * frustum.w / frustum.y);
    real width_x = half_width * scale_x, width_y = half_width * -scale_y;
    real length_x = half_length * scale_x, length_y = half_length * -scale_y;
    S(billboard_flat) placed;
    placed.right.x = right.x * width_x;
    placed.right.y = right.y * width_y;
    placed.up.x = up.x * length_x;
    placed.up.y = up.y * length_y;
    real det = placed.right.x * placed.up.y - placed.up.x * placed.right.y;
    real middle = 0.5f * edge;
    placed.place.seen = real_abs(det) > 1e-12f;
    real half_edge = middle / real_select(placed.place.seen, det, real_all(1.0f));
    placed.place.anchor.x = principal.x + center.x * scale_x;
    placed.place.anchor.y = principal.y - center.y * scale_y;
    placed.place.u = picture_slope_of(middle, placed.up.y * half_edge, -placed.up.x * half_edge);
    placed.place.v = /* grows downwards */
        picture_slope_of(middle, placed.right.y * half_edge, -placed.right.x * half_edge);
    placed.place.q = picture_slope_of(real_all(0.0f), real_all(0.0f), real_all(0.0f));
    return placed;
}

/* ---- billboards in any plane ----------------------------------------------------------------- */

/* Returns a linear function of the direction from the eye, given by a row, as one of the pixels
 * around the anchor. */
REAL_FN S(picture_slope) picture_slope_along(float4 frustum, float4 principal, real3 row,
                                             S(picture_point) anchor)
{
    real x = row.x * (2.0f * frustum.x / frustum.z), y = row.y * (-2.0f * frustum.y / frustum.w);
    real at = x * (anchor.x - principal.x) + y * (anchor.y - principal.y) - row.z;
    return picture_slope_of(at, x, y);
}

/* Places a billboard in any plane. right, up: its half edges; edge: the texture coordinate at the
 * far edges. A point of the picture is a direction d from the eye, and the billboard's point there
 * is depth * d = a * right + b * up + center. So (a, b, 1) / depth is the inverse of the matrix of
 * right, up and center, times d: it is linear in the pixel. Then u = edge (1 + a) / 2 and
 * v = edge (1 - b) / 2. */
REAL_FN S(billboard_place) billboard_place_deep(float4 frustum, float4 principal, real3 center,
                                                real3 right, real3 up, real edge)
{
    real3 normal = real3_cross(right, up);
    real det = real3_dot(normal, center);
    S(billboard_place) place;
    place.seen = real_abs(det) > 1e-12f;
    place.anchor = picture_point_of(frustum, principal, center);
    real scale = 1.0f / real_select(place.seen, det, real_all(1.0f)), half_edge = 0.5f * edge;
    real3 a = real3_scale(real3_cross(up, center), scale);
    real3 b = real3_scale(real3_cross(center, right), scale);
    real3 q = real3_scale(normal, scale);
    place.u = picture_slope_along(frustum, principal, real3_scale(real3_add(q, a), half_edge),
                                  place.anchor);
    place.v = picture_slope_along(frustum, principal, real3_scale(real3_sub(q, b), half_edge),
                                  place.anchor);
    place.q = picture_slope_along(frustum, principal, q, place.anchor);
    return place;
}

/* ---- rims ------------------------------------------------------------------------------------ */

/* A billboard that is narrower or shorter than this, px, has filtered edges. Cells of the atlas
 * that are shown larger have transparent borders, as a rule. */
#define BILLBOARD_RIM_MOST 4.0f

/* The place of a billboard and how its edges are filtered. */
struct billboard_rim {
    S(billboard_place) place;
    real u, v;             /* pixels for a unit of each texture coordinate; 0: hard edges */
    real reach_u, reach_v; /* half edges with the rim, in parts of the billboard's half edges */
    real opacity;          /* a factor for its opacity */
};

/* Narrows a texture coordinate about the billboard's middle. near: 1 / depth, or 1 for a flat
 * billboard. */
REAL_FN S(picture_slope) picture_slope_narrowed(S(picture_slope) slope, S(picture_slope) near,
                                                real middle, real part)
{
    real rest = middle * (1.0f - part);
    return picture_slope_of(slope.at * part + near.at * rest, slope.x * part + near.x * rest,
                            slope.y * part + near.y * rest);
}

/* Returns the pixels over which a texture coordinate changes by 1, at the billboard's middle. Where
 * the coordinate grows slantwise, a pixel is as wide as its square is in that direction, up to the
 * square's diagonal: filtered over this width, billboards have the same sum of light however they
 * are turned. */
REAL_FN real picture_slope_pixels(S(picture_slope) slope, S(picture_slope) near, real middle)
{
    real x = real_abs(slope.x - middle * near.x), y = real_abs(slope.y - middle * near.y);
    return near.at / real_max(x + y, real_all(1e-12f));
}

/* Finds the rim of a billboard that was placed by billboard_place_flat or billboard_place_deep. A
 * billboard that is thinner than a pixel is drawn a pixel wide, and fainter by the same factor, so
 * that the sum of its light stays the same wherever it lies between the pixels. edge: the texture
 * coordinate at the far edges. */
REAL_FN S(billboard_rim) billboard_rim_of(S(billboard_place) place, bool is_flat, real edge)
{
    real one = real_all(1.0f), zero = real_all(0.0f), middle = 0.5f * edge;
    S(picture_slope) near = place.q;
    if (is_flat)
        near = picture_slope_of(one, zero, zero);
    real width = edge * picture_slope_pixels(place.u, near, middle);
    real length = edge * picture_slope_pixels(place.v, near, middle);
    truth small = real_min(width, length) < BILLBOARD_RIM_MOST;
    real part_u = real_min(width, one), part_v = real_min(length, one);
    S(billboard_rim) rim;
    rim.place = place;
    rim.place.u = picture_slope_narrowed(place.u, near, middle, part_u);
    rim.place.v = picture_slope_narrowed(place.v, near, middle, part_v);
    width = real_max(width, one);
    length = real_max(length, one);
    rim.u = real_where(small, width / edge);
    rim.v = real_where(small, length / edge);
    rim.reach_u = real_select(small, (1.0f + 1.0f / width) / part_u, one);
    rim.reach_v = real_select(small, (1.0f + 1.0f / length) / part_v, one);
    rim.opacity = part_u * part_v;
    return rim;
}

/* Returns the part of a pixel, in one direction, that lies within two edges: the mean over the
 * pixel's width. half_edge, from_middle: half of the distance of the edges, and the pixel's
 * distance from their middle; pixels: those for a unit of both. */
REAL_FN real edge_cover(real half_edge, real from_middle, real pixels)
{
    return real_clamp01((half_edge - real_abs(from_middle)) * pixels + 0.5f);
}

/* ---- billboards that lie on surfaces --------------------------------------------------------- */

/* Returns the factor on the opacity of a billboard in a plane of the world where it meets the
 * scene. Others fade towards a surface behind them (Heinz 2019, equation 3.3); so would this one on
 * the very surface that it lies on. Therefore it is a sheet that covers whatever is at its plane or
 * behind it, and fades over 1 / look.soft with the height of the scene above the plane, seen along
 * its normal: neither can its surface cut it, nor does rounding matter where both coincide, and it
 * laps up walls that stand in it. What is before it by more than its size hides it, whatever the
 * height is.
 *
 * soft: look.soft times the distance of the plane from the eye, so that soft / depth is the change
 * per metre of depth at this pixel; near: 1 / half of its edge, 1/m; beyond: by how much the scene
 * is farther away than the billboard, m; depth: of the billboard, m. */
REAL_FN real billboard_lies_on(real soft, real near, real beyond, real depth)
{
    real above = 1.0f + beyond * soft / depth, before = 2.0f + beyond * near;
    return real_clamp01(real_min(above, before));
}

/* ---- points and lines ------------------------------------------------------------------------ */

/* Half the width of a point or a line, px, and a factor for its opacity. */
struct stroke_width {
    real half_width, opacity;
};

/* Returns how a point or a line of a width, px, is drawn: one that is narrower than a pixel is a
 * pixel wide, and fainter by the part of the pixel that it covers. */
REAL_FN S(stroke_width) stroke_width_of(bool is_line, real width)
{
    real one = real_all(1.0f), thin = real_min(width, one);
    S(stroke_width) stroke;
    stroke.half_width = 0.5f * real_max(width, one);
    stroke.opacity = thin;
    if (!is_line)
        stroke.opacity = thin * thin;
    return stroke;
}

/* Returns the rear end of a line, cut at a plane before the eye. near_m: the plane's distance. */
REAL_FN real3 stroke_tail(real3 head, real3 tail, float near_m)
{
    real part = (-head.z - near_m) / (tail.z - head.z);
    return real3_select(-tail.z < near_m, real3_add_scaled(head, real3_sub(tail, head), part),
                        tail);
}

/* A rectangle in the picture along a line. u and v count pixels from its middle, and only the depth
 * changes along it, so they are not divided by it. */
struct stroke_place {
    S(billboard_place) place;
    real edge_u, edge_v; /* half of the rectangle, px, without the half pixel of its soft rim */
};

/* Places a line between two positions before the eye, or a point, whose head and tail are the same.
 * Its ends reach out by half of its width, px. 1 / depth changes evenly from one end of the
 * rectangle and its rim to the other. */
REAL_FN S(stroke_place) stroke_place_of(float4 frustum, float4 principal, real3 head, real3 tail,
                                        real half_width)
{
    S(picture_point) to = picture_point_of(frustum, principal, head);
    S(picture_point) from = picture_point_of(frustum, principal, tail);
    real way_x = to.x - from.x, way_y = to.y - from.y;
    real way = real_sqrt(way_x * way_x + way_y * way_y);
    truth moves = way > 1e-3f;
    real shorter = 1.0f / real_select(moves, way, real_all(1.0f));
    real x = real_select(moves, way_x * shorter, real_all(1.0f));
    real y = real_where(moves, way_y * shorter);
    S(stroke_place) stroke;
    stroke.edge_u = 0.5f * real_where(moves, way) + half_width;
    stroke.edge_v = half_width;
    real q_head = -1.0f / head.z, q_tail = -1.0f / tail.z;
    real along = 0.5f * (q_head - q_tail) / (stroke.edge_u + 0.5f);
    stroke.place.anchor.x = 0.5f * (from.x + to.x);
    stroke.place.anchor.y = 0.5f * (from.y + to.y);
    stroke.place.u = picture_slope_of(real_all(0.0f), x, y);
    stroke.place.v = picture_slope_of(real_all(0.0f), -y, x);
    stroke.place.q = picture_slope_of(0.5f * (q_head + q_tail), along * x, along * y);
    stroke.place.seen = half_width > 0.0f;
    return stroke;
}

#endif
