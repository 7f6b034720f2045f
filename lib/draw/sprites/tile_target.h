/* A kiln_tile_target is the part of the images of a pass that tiles are loaded from and stored to.
 * The first piece of a pass overwrites the pixels of its images, later pieces are blended over
 * them. */
#ifndef KILN_DRAW_SPRITES_TILE_TARGET_H
#define KILN_DRAW_SPRITES_TILE_TARGET_H

#include "draw/sprites/tile.h"

struct kiln_tile_target {
    /* pixels of the images; NULL: there is no bloom, or no image for covering or for additive
     * particles alone */
    float *color, *bloom, *covering, *added;
    const float *depth; /* of the scene, m */
    uint32_t width, height;
    bool first;       /* true: this is the first piece of the pass, before which pixels are empty */
    bool keep_bloom;  /* true: the bloom of an earlier pass stays */
    bool sum;         /* true: alpha is summed, and covers nothing */
    bool by_fragment; /* true: lists of fragments are blended, which need each sprite's alpha */
    enum kiln_tile_glow glow;
    float weights[3]; /* for KILN_TILE_GLOW_APART: bloom weights of all glowing sprites */
};

/* Makes an empty tile of the pixels from x, y on, with the scene's depth. */
void kiln_tile_begin(const struct kiln_tile_target *target, struct kiln_tile *tile, uint32_t x,
                     uint32_t y);

/* Stores the tile. */
void kiln_tile_end(const struct kiln_tile_target *target, const struct kiln_tile *tile);

/* Stores an empty tile of the pixels from x, y on: clears them in the first piece, and does nothing
 * in later ones. */
void kiln_tile_skip(const struct kiln_tile_target *target, uint32_t x, uint32_t y);

#endif
