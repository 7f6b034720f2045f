/* A kiln_sprite is a particle projected to the picture, with the data that its pixels need. The CPU
 * rasteriser draws it (tile_draw.h). Its texture coordinates u and v are linear functions of the
 * pixel's position. For a sprite that is not parallel to the picture, u / depth, v / depth
 * and q = 1 / depth are linear instead, and stored. */
#ifndef KILN_DRAW_SPRITES_SPRITE_H
#define KILN_DRAW_SPRITES_SPRITE_H

#include <assert.h>

#include "base/simd.h"
#include "draw/light/lighting.h"
#include "draw/moment/view.h"
#include "draw/sprites/cells.h"
#include "particles/pool.h"
#include "shared/look_layout.h"

/* Names how a pixel of a sprite gets its colour. */
enum kiln_sprite_shade {
    KILN_SHADE_GLOW,  /* mask: base + slope times the cell's heat */
    KILN_SHADE_ALPHA, /* mask: base, where slope is 0 */
    KILN_SHADE_LIT,   /* mask: the same, plus light by the cell's normal */
    KILN_SHADE_COLOR, /* the cell's colour times base, plus its alpha times slope if veiled */
    KILN_SHADE_PLAIN, /* base in a rectangle or a disc, antialiased over a pixel */
    KILN_SHADES,      /* number of shades of billboards, points and lines */
    KILN_SHADE_RIBBON = KILN_SHADES, /* a part of a ribbon, whose cell is a mask... */
    KILN_SHADE_RIBBON_COLOR,         /* ...or has colours */
};

enum {
    KILN_SPRITE_DEEP = 1,     /* the sprite's depth differs between its pixels */
    KILN_SPRITE_COVERS = 2,   /* its alpha covers sprites behind it */
    KILN_SPRITE_DISC = 4,     /* KILN_SHADE_PLAIN: it is a disc, not a rectangle */
    KILN_SPRITE_LITERAL = 8,  /* it fades by the formula as printed: Heinz 2019, equation 3.3 */
    KILN_SPRITE_MIXED = 16,   /* its cell is mixed beforehand, so that next_cell is not used */
    KILN_SPRITE_EMITS = 32,   /* base or slope is not 0 */
    KILN_SPRITE_FINE = 64,    /* its cells have no motion and are sampled in floats */
    KILN_SPRITE_VEILED = 128, /* KILN_SHADE_COLOR: slope is haze, times the cell's alpha */

    /* those of parts of ribbons, in place of those that they do not have */
    KILN_SPRITE_BEGINS = 4,   /* the ribbon begins here, or is cut */
    KILN_SPRITE_ENDS = 64,    /* it ends here, or is cut */
    KILN_SPRITE_REPEATS = 16, /* its texture repeats along it */
};

/* A sprite takes two lines of the cache. The sprites of a tile are far apart in memory, so that
 * each line costs time. Data that only some sprites need is in struct kiln_sprite_extra. */
struct kiln_sprite {
    _Alignas(64) uint32_t cell; /* number of its cell in the pass's cells; unused if plain */
    uint32_t next_cell;         /* number of the next cell; unused if mixed */
    float part, motion;         /* weight of the next cell; a full move in texels */
    union {
        struct {
            float x, y;                     /* the pixel position where u, v and q are constants */
            float u, u_x, u_y, v, v_x, v_y; /* texels; plain: px from the sprite's middle */
        };
        float joints[2][3]; /* of a part of a ribbon: x, y, at of struct ribbon_line, px */
    };
    float edge_u, edge_v; /* edge of the cell, texels; plain: half the size, px */
    float rim_u, rim_v;   /* pixels a texel; 0: hard edges (struct billboard_rim) */
    float depth;          /* view depth, m; unused if deep */
    float soft;           /* soft fade, 1/m; below 0: minus that of struct billboard_lying */
    float opacity;
    float bulge; /* half the thickness in its middle, m */
    float base[3], slope[3];
    float bloom[3];
    int16_t x_from, y_from, x_to, y_to; /* pixels that it may touch; *_to is one past the last */
    uint16_t pitch;                     /* texels in a row of its cell */
    uint8_t shade, flags;               /* enum kiln_sprite_shade; KILN_SPRITE_* */
};

/* Holds the data of a part of a ribbon between two joints (shared/ribbon.h). Its colour and opacity
 * change evenly from those of the sprite to those of its other end. */
struct kiln_ribbon_extra {
    float middle[3];               /* x, y, at of struct ribbon_line, px */
    float half_px[2];              /* half of its width at the two joints */
    float near[2];                 /* 1 / depth at the joints, 1/m */
    float along[2];                /* place in the texture at the joints, in textures */
    float to_base[3], to_slope[3]; /* at the other end */
    float to_opacity;
};

/* Holds the data of a sprite that only some sprites need: see kiln_sprite_has_extra. */
struct kiln_sprite_extra {
    union {
        struct {
            _Alignas(64) float light[4][3]; /* of KILN_SHADE_LIT: light times albedo: constant;
                                               factors of the normal: right, up, viewer */
            float q, q_x, q_y;              /* if deep: 1/m */
            float distance; /* if literal: from the eye, m; if soft is below 0: `near` */
        };
        struct kiln_ribbon_extra ribbon; /* of a part of a ribbon */
    };
};

static_assert(sizeof(struct kiln_sprite) == 128 && sizeof(struct kiln_sprite_extra) == 64,
              "a sprite is two lines of the cache, an extra is one");

/* Names sprites and their extras, which are two arrays of the same length. */
struct kiln_sprites {
    struct kiln_sprite *sprites;
    struct kiln_sprite_extra *extras; /* set for visible sprites where kiln_sprite_has_extra */
};

/* Holds the data that all sprites of a pass share. */
struct kiln_sprite_pass {
    const struct kiln_scene *scene;
    const struct kiln_draw_look *looks;       /* KILN_MAX_SYSTEMS looks */
    const float4 *table;                      /* the moment's table of looks */
    const struct kiln_look_program *programs; /* of each system: what multiplies its rows */
    const struct kiln_particle *records;      /* the pool's records */
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_lighting *lighting;
    struct kiln_cells *cells;
    struct kiln_cells_content content; /* the data of `cells` */
    bool fire_covers; /* true: additive particles cover, too, or their alpha is summed */
};

/* Makes the sprites of draw entries, and their extras. parts: which part of its segment each entry
 * of a ribbon is, or NULL if there are none. Calls kiln_cells_request for their cells. Invisible
 * sprites touch no pixels (x_from = x_to). */
typedef void kiln_sprites_make(const struct kiln_sprite_pass *pass, const uint32_t *entries,
                               const uint8_t *parts, size_t count, struct kiln_sprites to);

KILN_SIMD_DECLARE(kiln_sprites_make, kiln_sprites_make);

/* Returns whether a sprite has an extra. */
static inline bool kiln_sprite_has_extra(const struct kiln_sprite *s)
{
    return s->shade == KILN_SHADE_LIT || s->shade >= KILN_SHADES ||
           (s->flags & (KILN_SPRITE_DEEP | KILN_SPRITE_LITERAL)) != 0;
}

/* Returns the sprites from number i on. */
static inline struct kiln_sprites kiln_sprites_from(struct kiln_sprites sprites, size_t i)
{
    return (struct kiln_sprites){sprites.sprites + i, sprites.extras + i};
}

#endif
