/* This header places a vector of sprites in the picture by shared/billboard_place.h, and bounds the
 * pixels that each sprite may touch. */
#ifndef KILN_DRAW_SPRITES_SPRITE_PLACE_H
#define KILN_DRAW_SPRITES_SPRITE_PLACE_H

#include "draw/sprites/sprite_lanes.h"
#include "shared/billboard_place.h"

/* A sprite with more texels a pixel than this is too thin to be visible, and its coordinates would
 * not fit 32 bits. */
#define MOST_TEXELS_A_PIXEL 4096.0f

static_assert(WORD_OF(x_from) == WORD_OF(y_from) && WORD_OF(x_to) == WORD_OF(y_to),
              "ranges of pixels are two to a word");

/* Finds the range of pixels whose centres lie from low to high, clamped to 0 to size. */
SIMD void limit_range(vf low, vf high, float size, vi *from, vi *to)
{
    *from = vi_of(vf_clamp(low + 0.5f, 0.0f, size));
    *to = vi_of(vf_clamp(high + 0.5f, 0.0f, size));
}

SIMD void limit_box(struct sprite_lanes *p, struct picture_point low, struct picture_point high)
{
    const float4 frustum = p->pass->view->frustum;
    vi x_from, y_from, x_to, y_to;
    limit_range(low.x, high.x, frustum.z, &x_from, &x_to);
    limit_range(low.y, high.y, frustum.w, &y_from, &y_to);
    p->visible &= (x_from < x_to) & (y_from < y_to);
    p->words[WORD_OF(x_from)] = (vf)((x_from | y_from << 16) & p->visible);
    p->words[WORD_OF(x_to)] = (vf)((x_to | y_to << 16) & p->visible);
}

/* Stores the rows of a sprite. */
SIMD void put_place(struct sprite_lanes *p, const struct billboard_place *place)
{
    p->visible &= place->seen;
    p->words[WORD_OF(x)] = place->anchor.x;
    p->words[WORD_OF(y)] = place->anchor.y;
    p->words[WORD_OF(u)] = place->u.at;
    p->words[WORD_OF(u_x)] = place->u.x;
    p->words[WORD_OF(u_y)] = place->u.y;
    p->words[WORD_OF(v)] = place->v.at;
    p->words[WORD_OF(v_x)] = place->v.x;
    p->words[WORD_OF(v_y)] = place->v.y;
    p->extra[EXTRA_WORD_OF(q)] = place->q.at;
    p->extra[EXTRA_WORD_OF(q_x)] = place->q.x;
    p->extra[EXTRA_WORD_OF(q_y)] = place->q.y;
}

/* Filters the edges of small billboards, stores the rows, and returns the rims. */
SIMD struct billboard_rim put_billboard(struct sprite_lanes *p, const struct billboard_place *place,
                                        bool is_flat)
{
    const struct billboard_rim rim = billboard_rim_of(*place, is_flat, p->words[WORD_OF(edge_u)]);
    put_place(p, &rim.place);
    p->words[WORD_OF(rim_u)] = rim.u;
    p->words[WORD_OF(rim_v)] = rim.v;
    p->words[WORD_OF(opacity)] *= rim.opacity;
    return rim;
}

/* Places billboards that are parallel to the picture, and bounds the part of them that shows. */
static void place_flat(struct sprite_lanes *p)
{
    const struct billboard_flat flat = billboard_place_flat(
        p->pass->view->frustum, p->pass->view->principal, p->center, p->plane.right, p->half_size,
        p->plane.up, p->half_length, p->words[WORD_OF(edge_u)]);
    const struct billboard_rim rim = put_billboard(p, &flat.place, true);
    const struct billboard_place *place = &rim.place;
    p->visible &=
        vf_abs(place->u.x) + vf_abs(place->u.y) + vf_abs(place->v.x) + vf_abs(place->v.y) <
        MOST_TEXELS_A_PIXEL;
    p->words[WORD_OF(depth)] = p->depth;
    const vi has_rim = rim.u > 0.0f;
    vf width = p->hull_to.c[0] - p->hull_from.c[0], height = p->hull_to.c[1] - p->hull_from.c[1];
    width = vf_select(has_rim, rim.reach_u, width);
    height = vf_select(has_rim, rim.reach_v, height);
    vf across = vf_where(~has_rim, p->hull_from.c[0] + p->hull_to.c[0] - 1.0f);
    vf along = vf_where(~has_rim, 1.0f - (p->hull_from.c[1] + p->hull_to.c[1]));
    vf x = place->anchor.x + flat.right.x * across + flat.up.x * along;
    vf y = place->anchor.y + flat.right.y * across + flat.up.y * along;
    vf reach_x = vf_abs(flat.right.x) * width + vf_abs(flat.up.x) * height;
    vf reach_y = vf_abs(flat.right.y) * width + vf_abs(flat.up.y) * height;
    limit_box(p, (struct picture_point){x - reach_x, y - reach_y},
              (struct picture_point){x + reach_x, y + reach_y});
}

/* Bounds the pixels by the projected corners of the visible part of the cell; a sprite that reaches
 * behind the eye may touch any pixel. has_rim: a mask. Each edge of a rim lies at most a
 * pixel's diagonal outside of the billboard's own, and each corner two pixels. */
SIMD void limit_corners(struct sprite_lanes *p, struct vf3 right, struct vf3 up, vi has_rim)
{
    const vf margin = vf_where(has_rim, vf_all(2.0f));
    const struct kiln_view *view = p->pass->view;
    struct picture_point low = {vf_all(view->frustum.z), vf_all(view->frustum.w)};
    struct picture_point high = {vf_all(0.0f), vf_all(0.0f)};
    vi behind = vi_all(0);
    for (int i = 0; i < 4; i++) {
        vf across = i & 1 ? p->hull_to.c[0] : p->hull_from.c[0];
        vf down = i & 2 ? p->hull_to.c[1] : p->hull_from.c[1];
        struct vf3 corner = vf3_add_scaled(p->center, right, 2.0f * across - 1.0f);
        corner = vf3_add_scaled(corner, up, 1.0f - 2.0f * down);
        behind |= -corner.z < 1e-3f * p->depth;
        struct picture_point at = picture_point_of(view->frustum, view->principal, corner);
        low = (struct picture_point){vf_min(low.x, at.x), vf_min(low.y, at.y)};
        high = (struct picture_point){vf_max(high.x, at.x), vf_max(high.y, at.y)};
    }
    const vf least = vf_all(-1e6f), most = vf_all(1e6f);
    low = (struct picture_point){vf_select(behind, least, low.x - margin),
                                 vf_select(behind, least, low.y - margin)};
    high = (struct picture_point){vf_select(behind, most, high.x + margin),
                                  vf_select(behind, most, high.y + margin)};
    limit_box(p, low, high);
}

/* Places billboards in any plane. */
static void place_deep(struct sprite_lanes *p)
{
    struct vf3 right = vf3_scale(p->plane.right, p->half_size);
    struct vf3 up = vf3_scale(p->plane.up, p->half_length);
    const struct billboard_place place =
        billboard_place_deep(p->pass->view->frustum, p->pass->view->principal, p->center, right, up,
                             p->words[WORD_OF(edge_u)]);
    const struct billboard_rim rim = put_billboard(p, &place, false);
    p->flags |= KILN_SPRITE_DEEP;
    limit_corners(p, right, up, rim.u > 0.0f);
}

/* Returns the rear end of a line. */
SIMD struct vf3 find_tail(const struct sprite_lanes *p)
{
    const struct kiln_view *view = p->pass->view;
    vf back = p->look->form.w != 0 ? vf_all(view->clock.z) : p->shape.c[1];
    struct vf3 tail = vf3_add_scaled(p->center, to_view(view, p->record.velocity), -back);
    return stroke_tail(p->center, tail, exact_max(view->eye.w, 1e-3f));
}

/* Places points and lines, whose texture coordinates count pixels. */
static void place_plain(struct sprite_lanes *p, vf diameter_px)
{
    bool is_line = p->look->form.x == LOOK_LINE;
    vf scale = p->scale * p->pass->view->clock.w, size = p->turn.c[2];
    vf width = is_line ? p->turn.c[3] * scale : vf_select(size > 0.0f, size * scale, diameter_px);
    const struct stroke_width drawn = stroke_width_of(is_line, width);
    p->words[WORD_OF(opacity)] *= drawn.opacity;
    if (is_line)
        p->flags |= KILN_SPRITE_DEEP;
    else if (p->look->form.z != 0)
        p->flags |= KILN_SPRITE_DISC;
    const struct stroke_place stroke =
        stroke_place_of(p->pass->view->frustum, p->pass->view->principal, p->center,
                        is_line ? find_tail(p) : p->center, drawn.half_width);
    put_place(p, &stroke.place);
    p->words[WORD_OF(edge_u)] = stroke.edge_u;
    p->words[WORD_OF(edge_v)] = stroke.edge_v;
    p->words[WORD_OF(depth)] = p->depth;
    const struct picture_point *middle = &stroke.place.anchor;
    vf x = stroke.place.u.x, y = stroke.place.u.y;
    vf reach_u = stroke.edge_u + 0.5f, reach_v = stroke.edge_v + 0.5f;
    vf reach_x = vf_abs(x) * reach_u + vf_abs(y) * reach_v;
    vf reach_y = vf_abs(y) * reach_u + vf_abs(x) * reach_v;
    limit_box(p, (struct picture_point){middle->x - reach_x, middle->y - reach_y},
              (struct picture_point){middle->x + reach_x, middle->y + reach_y});
}

#endif
