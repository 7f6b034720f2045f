/* This header places sprites in the picture and computes how their texture coordinates change from
 * pixel to pixel, as corner.glsl of shaders/draw does in GL. */
#ifndef KILN_DRAW_SPRITES_SPRITE_PLACE_H
#define KILN_DRAW_SPRITES_SPRITE_PLACE_H

#include "draw/sprites/sprite_subjects.h"

/* A sprite with more texels a pixel is too thin to be visible, and its coordinates would not fit 32
 * bits. */
#define MOST_TEXELS_A_PIXEL 4096.0f

struct vf2 {
    vf x, y;
};

static_assert(WORD_OF(x_from) == WORD_OF(y_from) && WORD_OF(x_to) == WORD_OF(y_to),
              "ranges of pixels are two to a word");

/* Returns the pixels whose centres are from low to high, within 0 to size. */
SIMD void limit_range(vf low, vf high, float size, vi *from, vi *to)
{
    *from = vi_of(vf_clamp(low + 0.5f, 0.0f, size));
    *to = vi_of(vf_clamp(high + 0.5f, 0.0f, size));
}

SIMD void limit_box(struct subjects *p, struct vf2 low, struct vf2 high)
{
    const float4 frustum = p->pass->view->frustum;
    vi x_from, y_from, x_to, y_to;
    limit_range(low.x, high.x, frustum.z, &x_from, &x_to);
    limit_range(low.y, high.y, frustum.w, &y_from, &y_to);
    p->seen &= (x_from < x_to) & (y_from < y_to);
    p->w[WORD_OF(x_from)] = (vf)((x_from | y_from << 16) & p->seen);
    p->w[WORD_OF(x_to)] = (vf)((x_to | y_to << 16) & p->seen);
}

SIMD struct vf2 to_pixels(const struct kiln_view *view, struct vf3 v)
{
    const float4 f = view->frustum;
    vf near = -1.0f / v.z;
    return (struct vf2){0.5f * f.z + v.x * near * (0.5f * f.z / f.x),
                        0.5f * f.w - v.y * near * (0.5f * f.w / f.y)};
}

/* Places billboards that are parallel to the picture. */
static void place_flat(struct subjects *p)
{
    const float4 f = p->pass->view->frustum;
    vf near = 1.0f / p->depth;
    vf scale_x = near * (0.5f * f.z / f.x), scale_y = near * (0.5f * f.w / f.y);
    vf middle_x = 0.5f * f.z + p->center.x * scale_x;
    vf middle_y = 0.5f * f.w - p->center.y * scale_y;
    /* Half edges in pixels, y down. */
    vf width_x = p->half_size * scale_x, width_y = p->half_size * -scale_y;
    vf length_x = p->half_length * scale_x, length_y = p->half_length * -scale_y;
    vf right_x = p->plane.right.x * width_x, right_y = p->plane.right.y * width_y;
    vf up_x = p->plane.up.x * length_x, up_y = p->plane.up.y * length_y;
    vf det = right_x * up_y - up_x * right_y;
    vf half = 0.5f * p->w[WORD_OF(edge_u)], half_edge = half / det;
    vf u_x = up_y * half_edge, u_y = -up_x * half_edge;
    vf v_x = right_y * half_edge, v_y = -right_x * half_edge; /* v grows downwards */
    p->seen &= vf_abs(det) > 1e-12f;
    p->seen &= vf_abs(u_x) + vf_abs(u_y) + vf_abs(v_x) + vf_abs(v_y) < MOST_TEXELS_A_PIXEL;
    p->w[WORD_OF(x)] = middle_x;
    p->w[WORD_OF(y)] = middle_y;
    p->w[WORD_OF(u)] = p->w[WORD_OF(v)] = half;
    p->w[WORD_OF(u_x)] = u_x;
    p->w[WORD_OF(u_y)] = u_y;
    p->w[WORD_OF(v_x)] = v_x;
    p->w[WORD_OF(v_y)] = v_y;
    p->w[WORD_OF(depth)] = p->depth;
    /* The middle and the half edges of the part that shows. */
    vf width = p->hull_to.c[0] - p->hull_from.c[0], height = p->hull_to.c[1] - p->hull_from.c[1];
    vf across = p->hull_from.c[0] + p->hull_to.c[0] - 1.0f;
    vf along = 1.0f - (p->hull_from.c[1] + p->hull_to.c[1]);
    vf x = middle_x + right_x * across + up_x * along;
    vf y = middle_y + right_y * across + up_y * along;
    vf reach_x = vf_abs(right_x) * width + vf_abs(up_x) * height;
    vf reach_y = vf_abs(right_y) * width + vf_abs(up_y) * height;
    limit_box(p, (struct vf2){x - reach_x, y - reach_y}, (struct vf2){x + reach_x, y + reach_y});
}

/* Writes a linear function of view space as a function of the pixels about the anchor: constant, x
 * and y. */
SIMD void to_plane(struct subjects *p, struct vf3 row, size_t constant, size_t x, size_t y)
{
    const float4 f = p->pass->view->frustum;
    p->w[x] = row.x * (2.0f * f.x / f.z);
    p->w[y] = row.y * (-2.0f * f.y / f.w);
    p->w[constant] = p->w[x] * (p->w[WORD_OF(x)] - 0.5f * f.z) +
                     p->w[y] * (p->w[WORD_OF(y)] - 0.5f * f.w) - row.z;
}

/* Bounds the pixels around the corners of the visible part; a sprite that reaches behind the eye
 * may touch any. */
SIMD void limit_corners(struct subjects *p, struct vf3 right, struct vf3 up)
{
    const struct kiln_view *view = p->pass->view;
    struct vf2 low = {vf_all(view->frustum.z), vf_all(view->frustum.w)};
    struct vf2 high = {vf_all(0.0f), vf_all(0.0f)};
    vi behind = vi_all(0);
    for (int i = 0; i < 4; i++) {
        vf across = i & 1 ? p->hull_to.c[0] : p->hull_from.c[0];
        vf down = i & 2 ? p->hull_to.c[1] : p->hull_from.c[1];
        struct vf3 corner = vf3_along(p->center, right, 2.0f * across - 1.0f);
        corner = vf3_along(corner, up, 1.0f - 2.0f * down);
        behind |= -corner.z < 1e-3f * p->depth;
        struct vf2 at = to_pixels(view, corner);
        low = (struct vf2){vf_min(low.x, at.x), vf_min(low.y, at.y)};
        high = (struct vf2){vf_max(high.x, at.x), vf_max(high.y, at.y)};
    }
    const vf least = vf_all(-1e6f), most = vf_all(1e6f);
    low = (struct vf2){vf_select(behind, least, low.x), vf_select(behind, least, low.y)};
    high = (struct vf2){vf_select(behind, most, high.x), vf_select(behind, most, high.y)};
    limit_box(p, low, high);
}

/* Places billboards in any plane: a point of the picture is a direction d, and with the inverse of
 * the matrix of right, up and centre, (a, b, 1) / depth = inverse * d. */
static void place_deep(struct subjects *p)
{
    struct vf3 right = vf3_scale(p->plane.right, p->half_size);
    struct vf3 up = vf3_scale(p->plane.up, p->half_length);
    struct vf3 normal = vf3_cross(right, up);
    vf det = vf3_dot(normal, p->center);
    p->seen &= vf_abs(det) > 1e-12f;
    struct vf2 middle = to_pixels(p->pass->view, p->center);
    p->w[WORD_OF(x)] = middle.x;
    p->w[WORD_OF(y)] = middle.y;
    vf scale = 1.0f / det, half_edge = 0.5f * p->w[WORD_OF(edge_u)];
    struct vf3 a = vf3_scale(vf3_cross(up, p->center), scale);
    struct vf3 b = vf3_scale(vf3_cross(p->center, right), scale);
    struct vf3 q = vf3_scale(normal, scale);
    /* u = edge (1 + a) / 2, v = edge (1 - b) / 2, all over the depth. */
    struct vf3 u = vf3_scale(vf3_add(q, a), half_edge), v = vf3_scale(vf3_sub(q, b), half_edge);
    to_plane(p, u, WORD_OF(u), WORD_OF(u_x), WORD_OF(u_y));
    to_plane(p, v, WORD_OF(v), WORD_OF(v_x), WORD_OF(v_y));
    to_plane(p, q, WORD_OF(q), WORD_OF(q_x), WORD_OF(q_y));
    p->flags |= KILN_SPRITE_DEEP;
    limit_corners(p, right, up);
}

/* Returns the rear end of a line, cut at the near plane. */
SIMD struct vf3 find_tail(const struct subjects *p)
{
    const struct kiln_view *view = p->pass->view;
    vf back = p->look->form.w != 0 ? vf_all(view->clock.z) : p->shape.c[1];
    struct vf3 head = p->center;
    struct vf3 tail = vf3_along(head, to_view(view, p->record.velocity), -back);
    float near = exact_max(view->eye.w, 1e-3f);
    vf part = (-head.z - near) / (tail.z - head.z);
    return vf3_select(-tail.z < near, vf3_along(head, vf3_sub(tail, head), part), tail);
}

/* Places a quad along the way between two points: u from its middle, v across, px. */
SIMD void place_way(struct subjects *p, struct vf3 head, struct vf3 tail, vf half_width)
{
    const struct kiln_view *view = p->pass->view;
    struct vf2 to = to_pixels(view, head), from = to_pixels(view, tail);
    vf way_x = to.x - from.x, way_y = to.y - from.y;
    vf way = vf_sqrt(way_x * way_x + way_y * way_y);
    vi moves = way > 1e-3f;
    vf shorter = 1.0f / vf_select(moves, way, vf_all(1.0f));
    vf x = vf_select(moves, way_x * shorter, vf_all(1.0f)), y = vf_where(moves, way_y * shorter);
    vf edge_u = 0.5f * vf_where(moves, way) + half_width, reach_u = edge_u + 0.5f;
    p->w[WORD_OF(x)] = 0.5f * (from.x + to.x);
    p->w[WORD_OF(y)] = 0.5f * (from.y + to.y);
    p->w[WORD_OF(edge_u)] = edge_u;
    p->w[WORD_OF(edge_v)] = half_width;
    p->w[WORD_OF(u_x)] = p->w[WORD_OF(v_y)] = x;
    p->w[WORD_OF(u_y)] = y;
    p->w[WORD_OF(v_x)] = -y;
    vf q_head = -1.0f / head.z, q_tail = -1.0f / tail.z;
    /* From end to end of the quad, as the shaders interpolate it. */
    vf along = 0.5f * (q_head - q_tail) / reach_u;
    p->w[WORD_OF(q)] = 0.5f * (q_head + q_tail);
    p->w[WORD_OF(q_x)] = along * x;
    p->w[WORD_OF(q_y)] = along * y;
    p->w[WORD_OF(depth)] = p->depth;
    vf reach_v = half_width + 0.5f;
    vf reach_x = vf_abs(x) * reach_u + vf_abs(y) * reach_v;
    vf reach_y = vf_abs(y) * reach_u + vf_abs(x) * reach_v;
    vf middle_x = p->w[WORD_OF(x)], middle_y = p->w[WORD_OF(y)];
    limit_box(p, (struct vf2){middle_x - reach_x, middle_y - reach_y},
              (struct vf2){middle_x + reach_x, middle_y + reach_y});
}

/* Places lines, or points as lines of length 0: their ends extend by half of their width. A line or
 * point narrower than a pixel is drawn a pixel wide, and fainter. */
static void place_plain(struct subjects *p, vf diameter_px)
{
    bool is_line = p->look->form.x == LOOK_LINE;
    vf scale = p->scale * p->pass->view->clock.w, size = p->turn.c[2];
    vf width = is_line ? p->turn.c[3] * scale : vf_select(size > 0.0f, size * scale, diameter_px);
    vf one = vf_all(1.0f), thin = vf_min(width, one);
    p->w[WORD_OF(opacity)] *= is_line ? thin : thin * thin;
    if (is_line)
        p->flags |= KILN_SPRITE_DEEP;
    else if (p->look->form.z != 0)
        p->flags |= KILN_SPRITE_DISC;
    place_way(p, p->center, is_line ? find_tail(p) : p->center, 0.5f * vf_max(width, one));
}

#endif
