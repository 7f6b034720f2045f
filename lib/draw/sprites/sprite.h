/* A kiln_sprite is a particle projected to the picture, with all data that a pixel of it needs; the
 * CPU rasteriser draws it. Its texture coordinates are linear in those of the picture; where the
 * sprite is not parallel to the picture, they are so divided by its depth (q is one over the
 * depth). */
#ifndef KILN_DRAW_SPRITES_SPRITE_H
#define KILN_DRAW_SPRITES_SPRITE_H

#include "base/simd.h"
#include "draw/light/lighting.h"
#include "draw/moment/view.h"
#include "draw/sprites/cells.h"
#include "particles/pool.h"
#include "shared/look_layout.h"

/* Names how a pixel of a sprite gets its colour. */
enum kiln_sprite_shade {
    KILN_SHADE_GLOW,  /* mask: base + slope times the cell's heat */
    KILN_SHADE_LIT,   /* mask: and light by the cell's normal */
    KILN_SHADE_COLOR, /* the cell's colour, times base */
    KILN_SHADE_PLAIN, /* base in a rectangle or a disc with edges as sharp as pixels allow */
    KILN_SHADES,
};

enum {
    KILN_SPRITE_DEEP = 1,    /* its depth changes over the picture */
    KILN_SPRITE_COVERS = 2,  /* its alpha counts */
    KILN_SPRITE_DISC = 4,    /* plain: round */
    KILN_SPRITE_LITERAL = 8, /* soft formula as printed: Heinz 2019, equation 3.3 */
    KILN_SPRITE_MIXED = 16,  /* its cell is mixed beforehand */
    KILN_SPRITE_EMITS = 32,  /* base and slope are not 0 */
    KILN_SPRITE_FINE = 64,   /* its cells do not move, and are sampled by floats */
};

struct kiln_sprite {
    _Alignas(64) uint32_t cell;     /* of the pass's cells; of a plain one, none */
    uint32_t next_cell;             /* unless mixed */
    float part, motion;             /* of the way to the next cell; texels that a full move means */
    float x, y;                     /* where the planes below have their constants, px */
    float u, u_x, u_y, v, v_x, v_y; /* texels; plain: px from its middle */
    float q, q_x, q_y;              /* 1/m */
    float edge_u, edge_v;           /* texels; plain: half the size, px */
    float depth;                    /* view-space, m, of one that is not deep */
    float soft, distance;           /* 1/m; m */
    float opacity;
    float bulge; /* half the thickness in its middle, m */
    float base[3], slope[3];
    float light[4][3]; /* times the albedo: from everywhere, right, up, towards the viewer */
    float bloom[3];
    int16_t x_from, y_from, x_to, y_to; /* pixels that it may touch */
    uint16_t pitch;
    uint8_t shade, flags;
};

/* Holds the data that all sprites of a pass share. */
struct kiln_sprite_pass {
    const struct kiln_scene *scene;
    const struct kiln_draw_look *looks;  /* of KILN_MAX_SYSTEMS */
    const float4 *table;                 /* of kiln_looks_sample */
    const struct kiln_particle *records; /* of the pool */
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_lighting *lighting;
    struct kiln_cells *cells;
    struct kiln_cells_content content; /* of the cells */
    bool fire_covers; /* additive particles cover, too, or have their alpha summed up */
};

/* Makes the sprites of draw entries and wants their cells. Invisible sprites touch no pixels
 * (x_from = x_to). */
typedef void kiln_sprites_make(const struct kiln_sprite_pass *pass, const uint32_t *entries,
                               size_t count, struct kiln_sprite *sprites);

KILN_SIMD_DECLARE(kiln_sprites_make, kiln_sprites_make);

#endif
