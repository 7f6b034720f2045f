/* A kiln_tile is a part of the picture that stays in the second-level cache while all sprites that
 * touch it are drawn, in order; the first-level cache has the rows of the last sprites. Every width
 * of vectors draws the same bits. */
#ifndef KILN_DRAW_SPRITES_TILE_H
#define KILN_DRAW_SPRITES_TILE_H

#include "base/simd.h"
#include "draw/sprites/sprite.h"
#include "draw/volume/volume_profile.h"

enum {
    KILN_TILE_WIDTH = 64,
    KILN_TILE_HEIGHT = 32,
    KILN_TILE_PITCH = KILN_TILE_WIDTH + 8, /* a unit of 8 pixels may reach beyond the right edge */
};

/* Names the contents of the glow's planes. */
enum kiln_tile_glow {
    KILN_TILE_GLOW_NONE, /* nothing */
    /* the colour of all glowing sprites, which have the same bloom weights; it is in these planes
     * instead of the planes of colour */
    KILN_TILE_GLOW_APART,
    KILN_TILE_GLOW_WEIGHED, /* the colour of each sprite times its bloom weights */
};

/* Names the planes of a tile: premultiplied colour, alpha and glow of the drawn sprites; the depth
 * of the scene, m. */
enum kiln_tile_plane {
    KILN_TILE_RED,
    KILN_TILE_GREEN,
    KILN_TILE_BLUE,
    KILN_TILE_ALPHA,
    KILN_TILE_GLOW_RED,
    KILN_TILE_GLOW_GREEN,
    KILN_TILE_GLOW_BLUE,
    KILN_TILE_DEPTH,
    KILN_TILE_PLANES,
};

/* The gas that sprites of a picture are blended with. */
struct kiln_tile_gas {
    const struct kiln_volume_profiles *profiles;
    uint32_t width, height;   /* of the picture of the gas, px */
    float scale;              /* pixels of that picture along an edge of a pixel */
    float margin_x, margin_y; /* by which the picture of sprites reaches beyond it, px of it */
    float smoke, flame;       /* 1: sprites cover this light of gas; 0: they have none of it */
    float glow;               /* and so the glow of flames */
};

struct kiln_tile {
    /* The last row lies outside of the tile; padding units are drawn into it. */
    _Alignas(64) float pixels[KILN_TILE_HEIGHT + 1][KILN_TILE_PLANES][KILN_TILE_PITCH];
    /* The colour of additive sprites alone, as if no sprite hid them, in the planes of colour; used
     * if adds_apart. Offsets in it are those in `pixels`, so that other drawing needs no more of
     * the cache. */
    _Alignas(64) float added[KILN_TILE_HEIGHT + 1][KILN_TILE_PLANES][KILN_TILE_PITCH];
    int x, y, width, height; /* in the picture, px */
    enum kiln_tile_glow glow;
    float nearest; /* least depth of the scene in the tile, m */
    /* a bit for each pixel in which sprites behind the drawn ones are visible; valid if has_opaque
     */
    uint64_t transparent[KILN_TILE_HEIGHT];
    /* a bit for each pixel: it or one of the seven after it is transparent; the left and the right
     * half of each row; valid if has_opaque; rows beyond the tile are read, but do not matter */
    _Alignas(64) int32_t seen[2][2 * KILN_TILE_HEIGHT];
    bool has_opaque;                 /* true: some pixels hide the sprites behind them */
    bool adds_apart;                 /* true: `added` is drawn, too */
    const struct kiln_tile_gas *gas; /* NULL: there is none */
    float gas_near_m;                /* no gas is nearer */
    bool over; /* true: sprites cover those behind them; false: alpha is summed */
};

/* Draws sprites into the tile. The list has the farthest sprite first. Sprites are drawn from the
 * nearest to the farthest, so that each only adds to the pixels the part that nearer sprites let
 * through. Their cells must exist (kiln_cells_mix). */
typedef void kiln_tile_draw(struct kiln_tile *tile, struct kiln_sprites sprites,
                            const struct kiln_cells *cells, const uint32_t *list, size_t count);

KILN_SIMD_DECLARE(kiln_tile_draw, kiln_tile_draw);

#endif
