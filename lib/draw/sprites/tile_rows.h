/* This header finds the pixels of a tile that a wide sprite touches: a span in each row, in units
 * of 8 pixels. tile_draw.h uses it. */
#ifndef KILN_DRAW_SPRITES_TILE_ROWS_H
#define KILN_DRAW_SPRITES_TILE_ROWS_H

#include "base/compress.h"
#include "draw/sprites/tile.h"

enum {
    ROW_VECTORS = KILN_TILE_HEIGHT / LANES,
    /* Units of a whole tile, one for padding, and room for a vector that is written and not kept.
     */
    LISTED_UNITS = KILN_TILE_HEIGHT * KILN_TILE_WIDTH / UNIT + 1 + LANES,
};

/* Holds the units of pixels that a sprite touches. */
struct units {
    int32_t at[LISTED_UNITS];                                /* offset in kiln_tile.pixels */
    float u[LISTED_UNITS], v[LISTED_UNITS], q[LISTED_UNITS]; /* at its first pixel */
};

typedef float four __attribute__((vector_size(16)));
typedef int32_t four_ints __attribute__((vector_size(16)));

/* Holds the limits of u, v, u + v and u - v in a hull. */
struct limits {
    four least, most;   /* texels */
    four pixels_a_step; /* 1 / change a pixel in x, px; 0 if they hardly change with x */
};

SIMD void find_limits(const struct kiln_sprite *s, const struct kiln_cell_hull *hull,
                      struct limits *limits)
{
    const four steps = {s->u_x, s->v_x, s->u_x + s->v_x, s->u_x - s->v_x};
    const four_ints change = (steps > 1e-6f) | (steps < -1e-6f);
    limits->pixels_a_step = (four)((four_ints)(1.0f / steps) & change);
    memcpy(&limits->least, hull->from, sizeof limits->least);
    memcpy(&limits->most, hull->to, sizeof limits->most);
    limits->least *= s->edge_u;
    limits->most *= s->edge_u;
    if (s->rim_u > 0.0f) {
        const float u = 0.5f / s->rim_u, v = 0.5f / s->rim_v;
        const four rim = {u, v, u + v, u + v};
        limits->least -= rim;
        limits->most += rim;
    }
}

/* Narrows each row's columns to those with least <= place + x / pixels_a_step < most, slightly
 * widened. place: the value at the sprite's anchor; offset: the anchor's column in the tile less
 * 0.5. */
SIMD void clip_columns(vf place, float pixels_a_step, float least, float most, float offset,
                       vf *from, vf *to)
{
    if (pixels_a_step == 0.0f)
        return;
    vf one = offset + (least - place) * pixels_a_step;
    vf other = offset + (most - place) * pixels_a_step;
    *from = vf_max(vf_min(one, other), *from);
    *to = vf_min(vf_max(one, other) + 2.0f, *to);
}

/* Holds the span of a sprite in each row of a tile that it may touch. */
struct rows {
    int top, vectors; /* the first row; number of vectors of rows */
    vf u[ROW_VECTORS], v[ROW_VECTORS], q[ROW_VECTORS]; /* at the first column; q if deep */
    vi from[ROW_VECTORS], units[ROW_VECTORS];          /* first column; number of units */
};

/* Holds the range of pixels of a tile that a sprite may touch, px. */
struct box {
    int x_from, x_to, y_from, y_to;
};

/* Finds the spans of a sprite. hull: the visible part of its cell, or NULL. deep: NULL unless the
 * sprite is deep. */
SIMD void find_rows(const struct kiln_tile *tile, const struct kiln_sprite *s,
                    const struct kiln_sprite_extra *deep, const struct box *box,
                    const struct kiln_cell_hull *hull, struct rows *rows)
{
    struct limits limits = {.least = {0}};
    if (hull)
        find_limits(s, hull, &limits);
    float offset = s->x - 0.5f - (float)tile->x;
    rows->top = box->y_from;
    rows->vectors = (box->y_to - box->y_from + LANES - 1) / LANES;
    for (int i = 0; i < rows->vectors; i++) {
        vf row = vf_count() + (float)(rows->top + i * LANES);
        vf y = row + ((float)tile->y + 0.5f) - s->y;
        vf u = s->u + s->u_y * y, v = s->v + s->v_y * y;
        vf from = vf_all((float)box->x_from), to = vf_all((float)box->x_to);
        if (hull) {
            const vf places[4] = {u, v, u + v, u - v};
            for (int k = 0; k < 4; k++)
                clip_columns(places[k], limits.pixels_a_step[k], limits.least[k], limits.most[k],
                             offset, &from, &to);
        }
        vi any = (from < to) & (row < (float)box->y_to);
        vi first = vi_of(vf_where(any, from));
        vi end = vi_of(vf_where(any, to));
        vf x = __builtin_convertvector(first, vf) - offset;
        rows->u[i] = u + s->u_x * x;
        rows->v[i] = v + s->v_x * x;
        if (deep)
            rows->q[i] = (deep->q + deep->q_y * y) + deep->q_x * x;
        rows->from[i] = first;
        rows->units[i] = (end - first + (UNIT - 1)) >> 3;
    }
}

/* Returns a mask of the units at the columns, one in each row from `row` on, of which some pixel is
 * visible. */
SIMD vi units_seen(const struct kiln_tile *tile, int row, vi columns)
{
    vi left, right;
    memcpy(&left, tile->seen[0] + row, sizeof left);
    memcpy(&right, tile->seen[1] + row, sizeof right);
    vi is_right = columns > 31;
    vi bits = (left & ~is_right) | (right & is_right);
    return (bits << (31 - (columns & 31))) < 0;
}

/* Names units: all; those of which some pixel is visible; the others. */
enum units_choice { UNITS_ALL, UNITS_SEEN, UNITS_HIDDEN };

/* Lists the chosen units of all rows and returns their number. It lists the first unit of each row,
 * then the second of each row, and so on, so that there is no branch to predict. */
SIMD int list_units(const struct kiln_tile *tile, const struct rows *rows, const struct box *box,
                    const float steps[3], bool deep, enum units_choice choice, struct units *units)
{
    int count = 0;
    const int most = (box->x_to - box->x_from + UNIT - 1) / UNIT;
    const vi numbers = __builtin_convertvector(vf_count(), vi);
    for (int k = 0; k < most; k++) {
        const float right = (float)(UNIT * k);
        for (int i = 0; i < rows->vectors; i++) {
            const int row = rows->top + i * LANES;
            vi columns = rows->from[i] + UNIT * k, listed = rows->units[i] > k;
            if (choice != UNITS_ALL)
                listed &= units_seen(tile, row, columns) ^ -(choice == UNITS_HIDDEN);
            const struct selection selection = selection_of(listed);
            vi at = columns + (numbers + row) * (KILN_TILE_PLANES * KILN_TILE_PITCH);
            vi_compress(units->at + count, selection, at);
            vf_compress(units->u + count, selection, rows->u[i] + right * steps[0]);
            vf_compress(units->v + count, selection, rows->v[i] + right * steps[1]);
            if (deep)
                vf_compress(units->q + count, selection, rows->q[i] + right * steps[2]);
            count += selection.count;
        }
    }
    return count;
}

/* Appends a padding unit that lies outside of the tile, so that units can be drawn in pairs. */
SIMD void add_padding(struct units *units, int count)
{
    units->at[count] = KILN_TILE_HEIGHT * KILN_TILE_PLANES * KILN_TILE_PITCH;
    units->u[count] = units->v[count] = -1e6f;
    units->q[count] = 0.0f;
}

#endif
