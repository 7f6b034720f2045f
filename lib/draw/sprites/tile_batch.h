/* This header draws batches of vectors of pixels of one sprite: it samples the sprite's cell,
 * shades the samples and blends them into the tile. tile_draw.h finds the pixels and calls it. */
#ifndef KILN_DRAW_SPRITES_TILE_BATCH_H
#define KILN_DRAW_SPRITES_TILE_BATCH_H

#include "draw/sprites/tile_gas.h"
#include "draw/sprites/tile_shade.h"

/* Adds colour to the pixels at the offsets, and its glow. */
SIMD void blend(float (*planes)[KILN_TILE_PITCH], const int32_t *at, const struct brush *b,
                const float bloom[3], const vf rgb[3])
{
    for (int c = 0; c < 3; c++) {
        float *color = planes[b->layer + c];
        vf_store_units(color, at, vf_load_units(color, at) + rgb[c]);
    }
    for (int c = 0; c < 3 && b->weighted_glow; c++) {
        float *glow = planes[KILN_TILE_GLOW_RED + c];
        vf_store_units(glow, at, vf_load_units(glow, at) + rgb[c] * bloom[c]);
    }
}

/* Adds colour times a weight to the pixels of kiln_tile.added at the offsets. */
SIMD void add_apart(float (*planes)[KILN_TILE_PITCH], const int32_t *at, const vf rgb[3], vf weight)
{
    for (int c = 0; c < 3; c++) {
        float *color = planes[KILN_TILE_RED + c];
        vf_store_units(color, at, vf_load_units(color, at) + rgb[c] * weight);
    }
}

/* ---- vectors of pixels ----------------------------------------------------------------------- */

/* Holds a vector of pixels, whose units may lie anywhere in the tile. */
struct pixels {
    vf u, v, q;
    vi inside; /* mask: the pixel is drawn */
};

enum { BATCH = 16 };

/* Holds vectors of pixels that go through each step of drawing together. So the processor overlaps
 * the work of several vectors while it fetches texels. The first index of texels and places is 0
 * for the cell and, if not mixed, 1 for the next cell. */
struct batch {
    _Alignas(64) int32_t texels[2][BATCH][LANES];
    vi places[2][BATCH], inside[BATCH];
    struct vf4 cells[BATCH];
    vf u[BATCH], v[BATCH], depth[BATCH]; /* u, v: of plain sprites; depth: of deep sprites */
    vf rim[BATCH];                       /* rim_cover; unset unless brush.rim */
    int32_t at[BATCH][UNITS];            /* offsets of the units in kiln_tile.pixels */
};

/* Holds the sprite that is drawn, and its tile. */
struct target {
    struct kiln_tile *tile;
    const struct kiln_sprite *s;
    const struct kiln_sprite_extra *extra; /* set if kiln_sprite_has_extra */
    struct brush brush;
    float (*added)[KILN_TILE_PITCH]; /* the tile's, or NULL if the sprite is not added apart */
    bool behind_gas;                 /* gas may lie before it */
    bool hidden;                     /* true: it is only added apart, since opaque pixels hide it */
};

SIMD void put_texels(struct batch *batch, int cell, int i, vi places, int32_t pitch, int32_t texel)
{
    vi texels = texel_offsets(places, pitch, texel);
    batch->places[cell][i] = places;
    memcpy(batch->texels[cell][i], &texels, sizeof texels);
}

/* u, v: steps from the cell's corner. */
SIMD void put_rim(struct batch *batch, const struct kiln_sprite *s, int i, vf u, vf v)
{
    const float texels = 1.0f / (float)PLACE_STEPS;
    batch->rim[i] = rim_cover(s, u * texels, v * texels);
}

/* Puts all data of vector i of a batch except its offsets. */
SIMD void put_pixels(struct batch *batch, int i, const struct target *d, struct pixels p,
                     bool textured, bool deep, bool mixed)
{
    const struct brush *b = &d->brush;
    vi inside = p.inside;
    if (deep) {
        inside &= p.q > 0.0f;
        batch->depth[i] = 1.0f / p.q;
        if (textured) {
            if (b->rim)
                put_rim(batch, d->s, i, p.u * batch->depth[i], p.v * batch->depth[i]);
            vf limit = vf_all((float)b->edge + 2.0f * PLACE_ONE), depth = batch->depth[i];
            p.u = vf_min(vf_max(p.u * depth + PLACE_MIDDLE, vf_all(0.0f)), limit);
            p.v = vf_min(vf_max(p.v * depth + PLACE_MIDDLE, vf_all(0.0f)), limit);
        }
    }
    if (textured && !deep && b->rim)
        put_rim(batch, d->s, i, p.u - PLACE_MIDDLE, p.v - PLACE_MIDDLE);
    if (textured) {
        vi places = places_of(p.u, p.v);
        if (b->rim) {
            inside &= batch->rim[i] > 0.0f;
            places = places_clamped(places, PLACE_ONE / 2, b->edge + PLACE_ONE / 2);
        } else {
            inside &= places_between(places, PLACE_ONE / 2, b->edge + PLACE_ONE / 2 - 1);
        }
        if (mixed)
            put_texels(batch, 0, i, places & inside, b->pitch, b->texel);
        else
            batch->places[0][i] = places;
    } else {
        batch->u[i] = p.u;
        batch->v[i] = p.v;
    }
    batch->inside[i] = inside;
}

/* Follows the motion of two cells to the time between them. Places are clamped to the centres of
 * the outer texels. */
SIMD void follow(struct batch *batch, int count, const struct brush *b)
{
    const int32_t half = PLACE_ONE / 2, most = b->edge + half;
    const uint32_t halves = (uint32_t)half << 16 | (uint32_t)half;
    for (int i = 0; i < count && b->moves; i++) {
        vi at = (vi)((vu)places_clamped(batch->places[0][i], half, most - 1) - halves);
        at = (vi)((vu)((at >> b->move_shift) & b->move_mask) + halves);
        batch->places[1][i] = at;
        vi texels = texel_offsets(at, KILN_CELL_PAIR * (KILN_ATLAS_MOTION + KILN_CELL_MARGIN),
                                  KILN_CELL_PAIR);
        memcpy(batch->texels[1][i], &texels, sizeof texels);
    }
    for (int i = 0; i < count; i++) {
        vi places = batch->places[0][i], next;
        if (b->moves) {
            vi way = ways_of(sample_pairs(b->moves, batch->texels[1][i], batch->places[1][i], 1));
            next = places_moved(places, way, b->next_move, half, most);
            places = places_moved(places, way, -b->cell_move, half, most);
        } else {
            next = places = places_clamped(places, half, most);
        }
        put_texels(batch, 0, i, places, b->pitch, b->texel);
        put_texels(batch, 1, i, next, b->pitch, b->texel);
    }
}

/* Returns the first channel of a cell that a shade reads. */
SIMD size_t first_channel(enum kiln_sprite_shade kind)
{
    return 4 - kiln_cell_channels(form_of(kind));
}

/* Returns the sampled channels of vector i, from first_channel() on. */
SIMD struct vf4 sample(const struct batch *batch, int i, const struct brush *b,
                       enum kiln_sprite_shade kind, bool mixed)
{
    const int32_t part = mixed ? 1 : PART_ONE - b->part;
    vi places = batch->places[0][i], next = batch->places[1][i];
    const int32_t *texels = batch->texels[0][i], *next_texels = batch->texels[1][i];
    if (kind == KILN_SHADE_ALPHA) {
        vi alphas = sample_alphas(b->cell, texels, places, part);
        if (!mixed)
            alphas += sample_alphas(b->next, next_texels, next, b->part);
        return (struct vf4){{[3] = __builtin_convertvector(alphas, vf)}};
    }
    if (kind == KILN_SHADE_GLOW) {
        struct pairs pairs = sample_pairs(b->cell, texels, places, part);
        return channels_of_pairs(
            mixed ? pairs : pairs_sum(pairs, sample_pairs(b->next, next_texels, next, b->part)));
    }
    struct quads quads = sample_quads(b->cell, texels, places, part);
    return channels_of(mixed ? quads
                             : quads_sum(quads, sample_quads(b->next, next_texels, next, b->part)));
}

/* Blends colour of pixels, and its glow, with the gas before them. alpha: by which they hide what
 * is behind them. */
SIMD void blend_in_gas(const struct target *d, const int32_t *at, const struct gas_before *gas,
                       vf rgb[3], vf alpha)
{
    float(*planes)[KILN_TILE_PITCH] = d->tile->pixels[0];
    for (int c = 0; c < 3 && d->tile->glow == KILN_TILE_GLOW_WEIGHED; c++) {
        float *glow = planes[KILN_TILE_GLOW_RED + c];
        const vf covered = alpha * d->tile->gas->glow;
        const vf added = rgb[c] * gas->clear * d->s->bloom[c] + covered * gas->glow[c];
        vf_store_units(glow, at, vf_load_units(glow, at) + added);
    }
    for (int c = 0; c < 3; c++) {
        float *color = planes[KILN_TILE_RED + c];
        const vf added = rgb[c] * gas->clear + alpha * gas->light[c];
        vf_store_units(color, at, vf_load_units(color, at) + added);
    }
}

/* Returns the part of vector i of a batch that the sprite's opacity and what it fades by leave.
 * alpha: of its colour. */
SIMD vf left_of(const struct batch *batch, int i, const struct target *d, vf alpha, bool deep)
{
    const struct kiln_sprite *s = d->s;
    vf left = vf_where(batch->inside[i], vf_all(s->opacity));
    if (!d->brush.unfaded) {
        const vf depth = deep ? batch->depth[i] : vf_all(s->depth);
        const vf scene = vf_load_units(d->tile->pixels[0][KILN_TILE_DEPTH], batch->at[i]);
        left = fade(s, d->extra, scene, depth, batch->inside[i]);
    }
    if (s->flags & KILN_SPRITE_LITERAL) /* equation 3.3 has no bound: limits alpha to 1 */
        left = vf_min(left, 1.0f / vf_max(alpha, vf_all(1e-6f)));
    return d->brush.rim ? left * batch->rim[i] : left;
}

/* Draws vector i of a batch behind the sprites that were drawn before. */
SIMD void draw_vector(const struct batch *batch, int i, const struct target *d, struct shaded c,
                      bool multiplied, bool deep, bool covers)
{
    float(*planes)[KILN_TILE_PITCH] = d->tile->pixels[0];
    const struct kiln_sprite *s = d->s;
    const bool over = d->tile->over;
    const int32_t *at = batch->at[i];
    vf left = left_of(batch, i, d, c.alpha, deep), before = vf_all(0.0f);
    struct gas_before gas;
    if (d->behind_gas)
        find_gas(d->tile, at, deep ? batch->depth[i] : vf_all(s->depth), &gas);
    if (!covers && d->added) {
        const vf weight = multiplied ? left : c.alpha * left;
        add_apart(d->added, at, c.rgb, d->behind_gas ? weight * gas.clear : weight);
        if (d->hidden)
            return;
    }
    if (over || covers)
        before = vf_load_units(planes[KILN_TILE_ALPHA], at);
    if (over)
        left *= 1.0f - before;
    vf alpha = c.alpha * left;
    for (int k = 0; k < 3; k++)
        c.rgb[k] *= multiplied ? left : alpha;
    if (d->behind_gas)
        blend_in_gas(d, at, &gas, c.rgb, covers ? alpha : vf_all(0.0f));
    else
        blend(planes, at, &d->brush, s->bloom, c.rgb);
    if (covers) {
        before += alpha;
        vf_store_units(planes[KILN_TILE_ALPHA], at, over ? vf_min(before, vf_all(1.0f)) : before);
    }
}

/* Draws the first `count` vectors of a batch. */
typedef void batch_drawing(struct batch *batch, int count, const struct target *d);

SIMD void draw_batch(struct batch *batch, int count, const struct target *d,
                     enum kiln_sprite_shade kind, bool deep, bool covers, bool mixed)
{
    const struct kiln_sprite *s = d->s;
    const struct brush *b = &d->brush;
    const bool textured = kind != KILN_SHADE_PLAIN;
    __asm__("" : "+m"(*batch)); /* keeps it in memory: taking vectors apart costs twice as much */
    if (textured && !mixed)
        follow(batch, count, b);
    for (int i = 0; i < count && textured; i++) {
        const struct vf4 cell = sample(batch, i, b, kind, mixed);
        for (size_t c = first_channel(kind); c < 4; c++)
            batch->cells[i].c[c] = cell.c[c];
    }
    for (int i = 0; i < count; i++) {
        struct shaded c = textured ? shade_cell(s, d->extra, b, kind, batch->cells[i])
                                   : shade_plain(s, batch->u[i], batch->v[i]);
        draw_vector(batch, i, d, c, kind == KILN_SHADE_COLOR, deep, covers);
    }
}

#endif
