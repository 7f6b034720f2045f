/* A kiln_tile is a part of the picture that stays in the first cache while all sprites that touch
 * it are drawn, in order. Sprites are drawn by the widest vectors that the machine has, with the
 * same bits. */
#ifndef KILN_DRAW_SPRITES_TILE_H
#define KILN_DRAW_SPRITES_TILE_H

#include "base/simd.h"
#include "draw/sprites/sprite.h"

enum {
    KILN_TILE_WIDTH = 64,
    KILN_TILE_HEIGHT = 16,
    KILN_TILE_PITCH = KILN_TILE_WIDTH + 8, /* a unit of 8 pixels may reach beyond the right edge */
    /* Units in it, and room for those that are written and not kept. */
    KILN_TILE_UNITS = KILN_TILE_HEIGHT * KILN_TILE_WIDTH / 8 + 8,
};

/* Names the contents of the glow's planes. */
enum kiln_tile_glow {
    KILN_TILE_GLOW_NONE,    /* nothing */
    KILN_TILE_GLOW_APART,   /* colour: all that glows does so by the same weights, and is drawn */
                            /* here instead of into the planes of colour */
    KILN_TILE_GLOW_WEIGHED, /* colour times the weights of each sprite */
};

/* Colour, alpha and glow of what was drawn, premultiplied; the depth of the scene, m. */
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

struct kiln_tile {
    /* The last row is of pixels that lie nowhere. */
    _Alignas(64) float pixels[KILN_TILE_HEIGHT + 1][KILN_TILE_PLANES][KILN_TILE_PITCH];
    int x, y, width, height; /* in the picture, px */
    enum kiln_tile_glow glow;
    float nearest;                   /* depth in it, m */
    uint64_t seen[KILN_TILE_HEIGHT]; /* while drawing: pixels behind which more is seen... */
    bool hides;                      /* ...unless that is all of them */
    bool over; /* what covers hides what is behind it: else alpha is summed up */
};

/* Draws sprites into the tile. The list has the farthest first, but sprites are drawn from the
 * nearest on, so that cover changes no colour but a sprite's own; their cells have been mixed. */
typedef void kiln_tile_draw(struct kiln_tile *tile, const struct kiln_sprite *sprites,
                            const struct kiln_cells *cells, const uint32_t *list, size_t count);

KILN_SIMD_DECLARE(kiln_tile_draw, kiln_tile_draw);

#endif
