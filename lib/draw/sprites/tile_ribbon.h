/* This header draws parts of ribbons (ribbon_pixels.h) in a tile. */
#ifndef KILN_DRAW_SPRITES_TILE_RIBBON_H
#define KILN_DRAW_SPRITES_TILE_RIBBON_H

#include "draw/sprites/ribbon_pixels.h"
#include "draw/sprites/tile_floats.h"

/* Narrows a row's columns, px of the picture, to those where a + b * x is at least 0. */
SIMD void narrow_columns(float a, float b, float *from, float *to)
{
    if (b > 1e-6f)
        *from = *from > -a / b ? *from : -a / b;
    else if (b < -1e-6f)
        *to = least(*to, -a / b);
    else if (a < -1.0f)
        *to = *from;
}

/* Finds the columns of a tile that a part of a ribbon may touch in a row, with a pixel of slack. */
SIMD void ribbon_columns(const struct kiln_sprite *s, const struct kiln_ribbon_extra *r,
                         const struct box *box, const struct kiln_tile *tile, int row, int *from,
                         int *to)
{
    const float y = (float)(tile->y + row) + 0.5f, left = (float)tile->x + 0.5f;
    float low = (float)box->x_from + left, high = (float)box->x_to + left;
    const float *begins = s->joints[0], *ends = s->joints[1], *middle = r->middle;
    const float half = (r->half_px[0] > r->half_px[1] ? r->half_px[0] : r->half_px[1]) + 0.75f;
    const float across = middle[1] * y + middle[2];
    narrow_columns(begins[1] * y + begins[2] + 0.75f, begins[0], &low, &high);
    narrow_columns(0.75f - (ends[1] * y + ends[2]), -ends[0], &low, &high);
    narrow_columns(half + across, middle[0], &low, &high);
    narrow_columns(half - across, -middle[0], &low, &high);
    if (low >= high)
        return;
    const int first = exact_int(low - left), end = exact_int(high - left) + 2;
    *from = first < *from ? first : *from;
    *to = end > *to ? end : *to;
}

/* Shades pixels of a ribbon as shade_glow and shade_color do those of billboards. */
SIMD struct shaded shade_ribbon(const struct kiln_sprite *s, const struct kiln_ribbon_extra *r,
                                const struct brush *b, vf part, struct vf4 cell)
{
    struct shaded shaded;
    const bool colored = s->shade == KILN_SHADE_RIBBON_COLOR;
    for (size_t c = 2 * !colored; c < 4; c++) {
        cell.c[c] = cell.c[c] * b->sampled + SAMPLED_ZERO;
        cell.c[c] *= colored ? cell.c[c] : vf_all(1.0f);
    }
    shaded.alpha = cell.c[3];
    for (int c = 0; c < 3; c++) {
        const vf base = s->base[c] + (r->to_base[c] - s->base[c]) * part;
        const vf slope = s->slope[c] + (r->to_slope[c] - s->slope[c]) * part;
        if (!colored)
            shaded.rgb[c] = base + slope * cell.c[2];
        else
            shaded.rgb[c] = cell.c[c] * base +
                            (s->flags & KILN_SPRITE_VEILED ? slope * cell.c[3] : vf_all(0.0f));
    }
    return shaded;
}

/* Draws a unit of a ribbon in each of UNITS rows, or a part of one unit. s: the sprite; that of
 * `d` has an opacity of 1. */
SIMD void draw_ribbon_pixels(const struct target *d, const struct kiln_sprite *s,
                             struct batch *batch, const struct ribbon_pixels *p)
{
    const struct kiln_ribbon_extra *r = &d->extra->ribbon;
    const struct brush *b = &d->brush;
    const vf zero = vf_all(0.0f), edge = vf_all(s->edge_u);
    const bool colored = s->shade == KILN_SHADE_RIBBON_COLOR;
    batch->inside[0] &= p->inside;
    batch->depth[0] = p->depth;
    batch->rim[0] = p->cover * (s->opacity + (r->to_opacity - s->opacity) * p->part);
    const vf u = vf_min(vf_max(p->along * edge, zero), edge) + 0.5f;
    const vf v = vf_min(vf_max(p->across * edge, zero), edge) + 0.5f;
    const struct vf4 cell = sample_floats(b, b->cell, colored ? 0 : 2, u, v);
    draw_vector(batch, 0, d, shade_ribbon(s, r, b, p->part, cell), colored, true,
                (s->flags & KILN_SPRITE_COVERS) != 0);
}

/* Draws a part of a ribbon (shared/ribbon.h). */
static void draw_ribbon(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                        const struct kiln_sprite *s, const struct kiln_sprite_extra *extra)
{
    const struct box box = box_in(tile, s);
    struct target d;
    if (!begin_target(tile, s, extra, &box, (s->flags & KILN_SPRITE_COVERS) != 0, &d))
        return;
    make_brush(tile, cells, s,
               s->shade == KILN_SHADE_RIBBON_COLOR ? KILN_SHADE_COLOR : KILN_SHADE_GLOW, true, true,
               &d.brush);
    d.brush.sampled = 1.0f / 255.0f;
    d.brush.rim = true;
    struct kiln_sprite plain = *s; /* batch.rim has the opacity, which changes along the ribbon */
    plain.opacity = 1.0f;
    d.s = &plain;
    const struct ribbon_strip strip = ribbon_strip_of(s, &extra->ribbon);
    struct batch batch;
    for (int row = box.y_from; row < box.y_to; row += UNITS) {
        int from = box.x_to, to = box.x_from;
        for (int k = 0; k < UNITS; k++)
            ribbon_columns(s, &extra->ribbon, &box, tile, row + k, &from, &to);
        from = from < box.x_from ? box.x_from : from;
        to = to > box.x_to ? box.x_to : to;
        const vf y = vf_units_number() + ((float)(tile->y + row) + 0.5f);
        for (int column = from; column < to; column += LANES / UNITS) {
            const vf x = vf_units_count(0) + ((float)(tile->x + column) + 0.5f);
            const struct ribbon_pixels p = ribbon_at(&strip, x, y);
            batch.inside[0] = y < (float)(tile->y + box.y_to);
            if (!any(batch.inside[0] & p.inside))
                continue;
            for (int k = 0; k < UNITS; k++)
                batch.at[0][k] = (row + k) * KILN_TILE_PLANES * KILN_TILE_PITCH + column;
            draw_ribbon_pixels(&d, s, &batch, &p);
        }
    }
}

#endif
