/* This header shades pixels of sprites for tile_draw.h. It gathers what all pixels of a sprite
 * share (struct brush), and computes their colour from a sampled cell, the part of a pixel that
 * they cover, and their opacity before the scene. The operations are those of
 * shaders/draw/sprites/shade.glsl. */
#ifndef KILN_DRAW_SPRITES_TILE_SHADE_H
#define KILN_DRAW_SPRITES_TILE_SHADE_H

#include "base/real.h"
#include "draw/sprites/sprite.h"
#include "draw/sprites/texels.h"
#include "draw/sprites/tile.h"
#include "shared/billboard_place.h"
#include "shared/exact.h"

/* Holds the data that all pixels of a sprite share. */
struct brush {
    const uint8_t *cell, *next, *moves; /* next: NULL if mixed; moves: NULL without motion */
    int32_t pitch, texel;               /* bytes of a row and of a texel of the cells */
    int32_t edge;                       /* edge of the cells, as a place */
    int32_t part;                       /* weight of the next cell, of PART_ONE */
    int32_t cell_move, next_move;  /* `part` of places_moved, for the cell and for the next cell */
    int32_t move_shift, move_mask; /* turn a place in the cells into a place in the motion */
    float sampled;                 /* the unit of sampled channels, SAMPLED_UNIT or a part of it */
    bool emits;                    /* base or slope is not 0 */
    bool rim;                      /* its edges are filtered */
    bool unfaded;                  /* true: the scene is too far behind it for any pixel to fade */
    int32_t layer;                 /* the first of the three planes that its colour goes to */
    bool weighted_glow;            /* true: colour times bloom weights goes to the glow's planes */
};

static inline float least(float a, float b)
{
    return a < b ? a : b;
}

/* Returns the form of cells that a shade reads. */
SIMD enum kiln_cell_form form_of(enum kiln_sprite_shade kind)
{
    return kind == KILN_SHADE_ALPHA  ? KILN_CELL_ALPHA
           : kind == KILN_SHADE_GLOW ? KILN_CELL_HEAT_ALPHA
                                     : KILN_CELL_RGBA;
}

/* Makes the brush of a sprite. kind, deep, mixed: those of the sprite. */
SIMD void make_brush(const struct kiln_tile *tile, const struct kiln_cells_content *cells,
                     const struct kiln_sprite *s, enum kiln_sprite_shade kind, bool deep,
                     bool mixed, struct brush *b)
{
    bool glows = s->bloom[0] != 0.0f || s->bloom[1] != 0.0f || s->bloom[2] != 0.0f;
    bool apart = glows && tile->glow == KILN_TILE_GLOW_APART;
    *b = (struct brush){
        .layer = apart ? KILN_TILE_GLOW_RED : KILN_TILE_RED,
        .weighted_glow = glows && tile->glow == KILN_TILE_GLOW_WEIGHED,
    };
    b->unfaded = !deep && !(s->flags & KILN_SPRITE_LITERAL) && tile->nearest >= s->depth &&
                 (tile->nearest - s->depth) * s->soft >= (s->soft > 0.0f ? 1.0f : 0.0f);
    if (kind == KILN_SHADE_PLAIN)
        return;
    const enum kiln_cell_form form = form_of(kind);
    b->cell = cells->texels[s->cell].forms[form];
    b->texel = 2 * (int32_t)kiln_cell_channels(form);
    b->pitch = b->texel * s->pitch;
    b->edge = (s->pitch - KILN_CELL_MARGIN) * PLACE_ONE;
    b->sampled = SAMPLED_UNIT;
    b->emits = (s->flags & KILN_SPRITE_EMITS) != 0;
    b->rim = s->rim_u > 0.0f;
    if (mixed)
        return;
    b->sampled = SAMPLED_UNIT / (float)PART_ONE;
    b->next = cells->texels[s->next_cell].forms[form];
    b->part = exact_int(s->part * (float)PART_ONE + 0.5f);
    b->moves = s->motion > 0.0f ? kiln_cells_moves(cells, s->cell) : NULL;
    float full = s->motion * (float)PLACE_ONE * (32768.0f / WAY_ONE);
    b->cell_move = exact_int(least(full * s->part + 0.5f, 32767.0f));
    b->next_move = exact_int(least(full * (1.0f - s->part) + 0.5f, 32767.0f));
    b->move_shift = 0;
    for (int32_t edge = b->edge / PLACE_ONE; edge > KILN_ATLAS_MOTION; edge >>= 1)
        b->move_shift++;
    b->move_mask = (0xffff >> b->move_shift) | (int32_t)(0xffffu >> b->move_shift << 16);
}

/* Holds the shade of a vector of pixels: the colour, not yet multiplied by alpha except for colour
 * cells, which are premultiplied. */
struct shaded {
    vf rgb[3], alpha;
};

SIMD struct shaded shade_glow(const struct kiln_sprite *s, const struct brush *b, struct vf4 cell)
{
    vf heat = cell.c[2] * b->sampled + SAMPLED_ZERO;
    struct shaded shaded = {.alpha = cell.c[3] * b->sampled + SAMPLED_ZERO};
    for (int c = 0; c < 3; c++)
        shaded.rgb[c] = s->base[c] + s->slope[c] * heat;
    return shaded;
}

SIMD struct shaded shade_alpha(const struct kiln_sprite *s, const struct brush *b, struct vf4 cell)
{
    return (struct shaded){{vf_all(s->base[0]), vf_all(s->base[1]), vf_all(s->base[2])},
                           cell.c[3] * b->sampled + SAMPLED_ZERO};
}

SIMD struct shaded shade_lit(const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,
                             const struct brush *b, struct vf4 cell)
{
    struct shaded shaded = {.alpha = cell.c[3] * b->sampled + SAMPLED_ZERO};
    float twice = 2.0f * b->sampled, zeros = 2.0f * SAMPLED_ZERO - 1.0f;
    vf x = cell.c[0] * twice + zeros, y = cell.c[1] * twice + zeros;
    vf zero = vf_all(0.0f);
    vf z = vf_sqrt(vf_max(1.0f - (x * x + y * y), zero));
    for (int c = 0; c < 3; c++) {
        vf light = (extra->light[0][c] + extra->light[1][c] * x) +
                   (extra->light[2][c] * y + extra->light[3][c] * z);
        shaded.rgb[c] = vf_max(light, zero);
    }
    if (b->emits) {
        vf heat = cell.c[2] * b->sampled + SAMPLED_ZERO;
        for (int c = 0; c < 3; c++)
            shaded.rgb[c] += s->base[c] + s->slope[c] * heat;
    }
    return shaded;
}

/* Returns the colour of a colour cell. Channels are squared, since cells hold square roots. */
SIMD struct shaded shade_color(const struct kiln_sprite *s, const struct brush *b, struct vf4 cell)
{
    for (int c = 0; c < 4; c++) {
        cell.c[c] = cell.c[c] * b->sampled + SAMPLED_ZERO;
        cell.c[c] *= cell.c[c];
    }
    struct shaded shaded = {
        {cell.c[0] * s->base[0], cell.c[1] * s->base[1], cell.c[2] * s->base[2]}, cell.c[3]};
    for (int c = 0; c < 3 && (s->flags & KILN_SPRITE_VEILED) != 0; c++)
        shaded.rgb[c] += s->slope[c] * cell.c[3];
    return shaded;
}

/* Shades pixels by their sampled channels, for any shade but plain. */
SIMD struct shaded shade_cell(const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,
                              const struct brush *b, enum kiln_sprite_shade kind, struct vf4 cell)
{
    return kind == KILN_SHADE_LIT     ? shade_lit(s, extra, b, cell)
           : kind == KILN_SHADE_GLOW  ? shade_glow(s, b, cell)
           : kind == KILN_SHADE_ALPHA ? shade_alpha(s, b, cell)
                                      : shade_color(s, b, cell);
}

/* Returns the colour of a disc or a rectangle; alpha is the part of a pixel inside. */
SIMD struct shaded shade_plain(const struct kiln_sprite *s, vf u, vf v)
{
    vf alpha;
    if (s->flags & KILN_SPRITE_DISC)
        alpha = vf_clamp01(s->edge_u + 0.5f - vf_sqrt(u * u + v * v));
    else
        alpha = edge_cover(vf_all(s->edge_u), u, vf_all(1.0f)) *
                edge_cover(vf_all(s->edge_v), v, vf_all(1.0f));
    return (struct shaded){{vf_all(s->base[0]), vf_all(s->base[1]), vf_all(s->base[2])}, alpha};
}

/* Returns the part of each pixel at u, v, texels, that a billboard with filtered edges covers. */
SIMD vf rim_cover(const struct kiln_sprite *s, vf u, vf v)
{
    const vf half = vf_all(0.5f * s->edge_u);
    return edge_cover(half, u - half, vf_all(s->rim_u)) *
           edge_cover(half, v - half, vf_all(s->rim_v));
}

/* Returns the opacity of a sprite before the scene: equation 3.3, clamped or as printed. */
SIMD vf fade(const struct kiln_sprite *s, const struct kiln_sprite_extra *extra, vf scene, vf depth,
             vi inside)
{
    vi visible = inside & (depth <= scene);
    if (s->soft < 0.0f)
        return vf_where(inside, billboard_lies_on(vf_all(-s->soft), vf_all(extra->distance),
                                                  scene - depth, depth) *
                                    s->opacity);
    if (s->soft <= 0.0f)
        return vf_where(visible, vf_all(s->opacity));
    if (s->flags & KILN_SPRITE_LITERAL)
        return vf_where(visible, vf_abs(scene - extra->distance) * s->soft * s->opacity);
    return vf_where(inside, vf_clamp01((scene - depth) * s->soft) * s->opacity);
}

#endif
