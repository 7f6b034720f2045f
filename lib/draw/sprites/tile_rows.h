/* This header finds the pixels of a tile that a wide sprite touches: a span in each row, in units
 * of 8 pixels. tile_draw.h uses it. */
#ifndef KILN_DRAW_SPRITES_TILE_ROWS_H
#define KILN_DRAW_SPRITES_TILE_ROWS_H

#include "base/lanes.h"
#include "draw/sprites/tile.h"

/* Holds the units of pixels that a sprite touches. */
struct units {
    int32_t at[KILN_TILE_UNITS]; /* offset in kiln_tile.pixels */
    float u[KILN_TILE_UNITS], v[KILN_TILE_UNITS], q[KILN_TILE_UNITS]; /* at its first pixel */
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

/* Holds the span of a sprite in each row of a tile. */
struct rows {
    _Alignas(64) float u[KILN_TILE_HEIGHT], v[KILN_TILE_HEIGHT], q[KILN_TILE_HEIGHT];
    int32_t from[KILN_TILE_HEIGHT], units[KILN_TILE_HEIGHT]; /* first column; number of units */
};

/* Holds the range of pixels of a tile that a sprite may touch, px. */
struct box {
    int x_from, x_to, y_from, y_to;
};

/* Finds the spans of a sprite. hull: the visible part of its cell, or NULL. */
SIMD void find_rows(const struct kiln_tile *tile, const struct kiln_sprite *s,
                    const struct box *box, const struct kiln_cell_hull *hull, struct rows *rows)
{
    struct limits limits = {.least = {0}};
    if (hull)
        find_limits(s, hull, &limits);
    float offset = s->x - 0.5f - (float)tile->x;
    for (int i = 0; i < KILN_TILE_HEIGHT; i += LANES) {
        vf y = vf_count() + ((float)(tile->y + i) + 0.5f - s->y);
        vf u = s->u + s->u_y * y, v = s->v + s->v_y * y;
        vf from = vf_all((float)box->x_from), to = vf_all((float)box->x_to);
        if (hull) {
            const vf places[4] = {u, v, u + v, u - v};
            for (int k = 0; k < 4; k++)
                clip_columns(places[k], limits.pixels_a_step[k], limits.least[k], limits.most[k],
                             offset, &from, &to);
        }
        vi any = from < to;
        vi first = vi_of(vf_where(any, from));
        vi end = vi_of(vf_where(any, to));
        vf x = __builtin_convertvector(first, vf) - offset;
        vf_store(rows->u + i, u + s->u_x * x);
        vf_store(rows->v + i, v + s->v_x * x);
        vf_store(rows->q + i, (s->q + s->q_y * y) + s->q_x * x);
        vi units = (end - first + (UNIT - 1)) >> 3;
        memcpy(rows->from + i, &first, sizeof first);
        memcpy(rows->units + i, &units, sizeof units);
    }
}

/* Lists the units of all rows and returns their number. For each row it writes as many units as the
 * longest row may have, then advances by the number that the row has, so that there is no branch to
 * predict. */
SIMD int list_units(const struct rows *rows, const struct box *box, const float steps[3], bool deep,
                    struct units *units)
{
    const four numbers = {0.0f, 8.0f, 16.0f, 24.0f};
    const four_ints places = {0, 8, 16, 24};
    int count = 0, most = (box->x_to - box->x_from + UNIT - 1) / UNIT;
    for (int y = box->y_from; y < box->y_to; y++) {
        int32_t at = rows->from[y] + y * KILN_TILE_PLANES * KILN_TILE_PITCH;
        for (int k = 0; k < most; k += 4) {
            four u = rows->u[y] + (numbers + (float)(8 * k)) * steps[0];
            four v = rows->v[y] + (numbers + (float)(8 * k)) * steps[1];
            four_ints to = at + 8 * k + places;
            memcpy(units->at + count + k, &to, sizeof to);
            memcpy(units->u + count + k, &u, sizeof u);
            memcpy(units->v + count + k, &v, sizeof v);
            if (deep) {
                four q = rows->q[y] + (numbers + (float)(8 * k)) * steps[2];
                memcpy(units->q + count + k, &q, sizeof q);
            }
        }
        count += rows->units[y];
    }
    return count;
}

/* Removes units whose pixels are all hidden; returns the number of units that remain. */
SIMD int drop_hidden(const struct kiln_tile *tile, struct units *units, int count)
{
    int remaining = 0;
    for (int i = 0; i < count; i++) {
        uint32_t at = (uint32_t)units->at[i], pixel = at % (KILN_TILE_PLANES * KILN_TILE_PITCH);
        uint64_t row = tile->transparent[at / (KILN_TILE_PLANES * KILN_TILE_PITCH)];
        units->at[remaining] = units->at[i];
        units->u[remaining] = units->u[i];
        units->v[remaining] = units->v[i];
        units->q[remaining] = units->q[i];
        remaining += (row >> pixel & 0xff) != 0;
    }
    return remaining;
}

/* Appends a padding unit that lies outside of the tile, so that units can be drawn in pairs. */
SIMD void add_padding(struct units *units, int count)
{
    units->at[count] = KILN_TILE_HEIGHT * KILN_TILE_PLANES * KILN_TILE_PITCH;
    units->u[count] = units->v[count] = -1e6f;
    units->q[count] = 0.0f;
}

#endif
