/* This header begins to draw a sprite in a tile, for tile_draw.h and its neighbours: it finds the
 * sprite's pixels in the tile, and whether any of them can be seen. */
#ifndef KILN_DRAW_SPRITES_TILE_BEGIN_H
#define KILN_DRAW_SPRITES_TILE_BEGIN_H

#include "draw/sprites/tile_batch.h"
#include "draw/sprites/tile_rows.h"

SIMD struct box box_in(const struct kiln_tile *tile, const struct kiln_sprite *s)
{
    return (struct box){
        .x_from = s->x_from > tile->x ? s->x_from - tile->x : 0,
        .x_to = s->x_to < tile->x + tile->width ? s->x_to - tile->x : tile->width,
        .y_from = s->y_from > tile->y ? s->y_from - tile->y : 0,
        .y_to = s->y_to < tile->y + tile->height ? s->y_to - tile->y : tile->height,
    };
}

/* Returns whether all pixels of a box hide the sprites behind them. */
SIMD bool box_hidden(const struct kiln_tile *tile, const struct box *box)
{
    uint64_t transparent = 0;
    for (int y = box->y_from; y < box->y_to; y++)
        transparent |= tile->transparent[y];
    transparent &= ~(uint64_t)0 >> (KILN_TILE_WIDTH - (box->x_to - box->x_from)) << box->x_from;
    return transparent == 0;
}

/* Begins to draw a sprite in a box. Returns false if there is nothing to draw. */
SIMD bool begin_target(struct kiln_tile *tile, const struct kiln_sprite *s,
                       const struct kiln_sprite_extra *extra, const struct box *box, bool covers,
                       struct target *d)
{
    const bool deep = (s->flags & KILN_SPRITE_DEEP) != 0;
    *d = (struct target){.tile = tile,
                         .s = s,
                         .extra = extra,
                         .behind_gas = tile->gas && (deep || s->depth > tile->gas_near_m)};
    if (!covers && tile->adds_apart)
        d->added = tile->added[0];
    if (!tile->has_opaque)
        return true;
    if (box->x_from >= box->x_to)
        return false;
    d->hidden = box_hidden(tile, box);
    return !d->hidden || d->added;
}

#endif
