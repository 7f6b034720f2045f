/* This header draws sprites into a tile. tile_simd.c, which is compiled for each KILN_SIMD_LEVEL,
 * defines the name TILE_DRAW and includes it. The operations of a pixel, some of them in
 * tile_shade.h, are those of shaders/draw/sprites/shade.glsl (Heinz 2019, 3.2.3 to 3.2.6). All
 * lanes do them; lanes outside of the sprite have alpha 0. Sprites are drawn from the nearest to
 * the farthest, and those behind opaque pixels are left out, except where additive sprites are
 * added apart, too. */
#include "draw/sprites/tile_rows.h"
#include "draw/sprites/tile_shade.h"

enum {
    PREFETCH_DISTANCE = 6,     /* sprites that are prefetched */
    COVER_CHECK_INTERVAL = 24, /* covering sprites between two calls of find_transparent */
};

/* A pixel that lets through less than this part of the light from behind counts as opaque. */
#define NEGLIGIBLE 0x1p-16f

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
                     enum kiln_sprite_shade kind, bool deep, bool mixed)
{
    const struct brush *b = &d->brush;
    bool textured = kind != KILN_SHADE_PLAIN;
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

/* Draws vector i of a batch behind the sprites that were drawn before. */
SIMD void draw_vector(const struct batch *batch, int i, const struct target *d, struct shaded c,
                      bool multiplied, bool deep, bool covers)
{
    float(*planes)[KILN_TILE_PITCH] = d->tile->pixels[0];
    const struct kiln_sprite *s = d->s;
    const bool over = d->tile->over;
    const int32_t *at = batch->at[i];
    vf left = vf_where(batch->inside[i], vf_all(s->opacity)), before = vf_all(0.0f);
    if (!d->brush.unfaded) {
        vf depth = deep ? batch->depth[i] : vf_all(s->depth);
        left =
            fade(s, d->extra, vf_load_units(planes[KILN_TILE_DEPTH], at), depth, batch->inside[i]);
    }
    if (s->flags & KILN_SPRITE_LITERAL) /* equation 3.3 has no bound: limits alpha to 1 */
        left = vf_min(left, 1.0f / vf_max(c.alpha, vf_all(1e-6f)));
    if (d->brush.rim)
        left *= batch->rim[i];
    if (!covers && d->added) {
        add_apart(d->added, at, c.rgb, multiplied ? left : c.alpha * left);
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
    blend(planes, at, &d->brush, s->bloom, c.rgb);
    if (covers) {
        before += alpha;
        vf_store_units(planes[KILN_TILE_ALPHA], at, over ? vf_min(before, vf_all(1.0f)) : before);
    }
}

/* Draws the first `count` vectors of a batch. */
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

/* ---- wide sprites: units of their rows ------------------------------------------------------- */

/* Draws the chosen units of some rows. */
SIMD void draw_units(const struct target *d, const struct rows *rows, const struct box *box,
                     const float steps[3], enum units_choice choice, struct batch *batch,
                     enum kiln_sprite_shade kind, bool deep, bool covers, bool mixed)
{
    struct units units;
    int count = list_units(d->tile, rows, box, steps, deep, choice, &units);
    if (UNITS > 1)
        add_padding(&units, count);
    for (int begin = 0; begin < count; begin += BATCH / UNIT_PARTS * UNITS) {
        int end =
            count - begin < BATCH / UNIT_PARTS * UNITS ? count : begin + BATCH / UNIT_PARTS * UNITS;
        int drawn = 0;
        for (int i = begin; i < end; i += UNITS) {
            for (int part = 0; part < UNIT_PARTS; part++) {
                vf lane = vf_units_count(part);
                struct pixels p = {.u = vf_units(units.u + i) + lane * steps[0],
                                   .v = vf_units(units.v + i) + lane * steps[1],
                                   .inside = ~(vi){0}};
                if (deep)
                    p.q = vf_units(units.q + i) + lane * steps[2];
                for (int k = 0; k < UNITS; k++)
                    batch->at[drawn][k] = units.at[i + k] + part * LANES;
                put_pixels(batch, drawn++, d, p, kind, deep, mixed);
            }
        }
        draw_batch(batch, drawn, d, kind, deep, covers, mixed);
    }
}

SIMD void draw_wide(struct target *d, const struct kiln_cell_hull *hull, const struct box *box,
                    struct batch *batch, enum kiln_sprite_shade kind, bool deep, bool covers,
                    bool mixed)
{
    const struct kiln_sprite *s = d->s;
    struct rows rows;
    bool textured = kind != KILN_SHADE_PLAIN;
    find_rows(d->tile, s, deep ? d->extra : NULL, box, !deep && textured ? hull : NULL, &rows);
    float scale = textured ? (float)PLACE_STEPS : 1.0f;
    float margin = textured && !deep ? PLACE_MIDDLE : 0.0f;
    for (int i = 0; i < rows.vectors && textured; i++) {
        rows.u[i] = rows.u[i] * scale + margin;
        rows.v[i] = rows.v[i] * scale + margin;
    }
    const float steps[3] = {s->u_x * scale, s->v_x * scale, deep ? d->extra->q_x : 0.0f};
    enum units_choice choice = d->tile->has_opaque && !d->hidden ? UNITS_SEEN : UNITS_ALL;
    for (;;) {
        draw_units(d, &rows, box, steps, choice, batch, kind, deep, covers, mixed);
        if (covers || choice != UNITS_SEEN || !d->added)
            return;
        choice = UNITS_HIDDEN;
        d->hidden = true;
    }
}

/* ---- sprites no wider than a unit: one a row ------------------------------------------------- */

SIMD void draw_narrow(const struct target *d, const struct box *box, struct batch *batch,
                      enum kiln_sprite_shade kind, bool covers, bool mixed)
{
    const struct kiln_sprite *s = d->s;
    const struct kiln_tile *tile = d->tile;
    bool textured = kind != KILN_SHADE_PLAIN;
    float scale = textured ? (float)PLACE_STEPS : 1.0f;
    float margin = textured ? PLACE_MIDDLE : 0.0f;
    vf u[UNIT_PARTS], v[UNIT_PARTS]; /* in the row of the anchor */
    for (int part = 0; part < UNIT_PARTS; part++) {
        vf x = vf_units_count(part) + ((float)(tile->x + box->x_from) + 0.5f) - s->x;
        u[part] = (s->u + s->u_x * x) * scale + margin;
        v[part] = (s->v + s->v_x * x) * scale + margin;
    }
    float u_row = s->u_y * scale, v_row = s->v_y * scale;
    const float end = (float)(tile->y + box->y_to);
    int32_t at = box->y_from * KILN_TILE_PLANES * KILN_TILE_PITCH + box->x_from;
    int count = 0;
    for (int y = box->y_from; y < box->y_to; y += UNITS) {
        vf row = vf_units_number() + ((float)(tile->y + y) + 0.5f), from_anchor = row - s->y;
        for (int part = 0; part < UNIT_PARTS; part++) {
            struct pixels p = {.u = u[part] + from_anchor * u_row,
                               .v = v[part] + from_anchor * v_row,
                               .inside = row < end};
            for (int k = 0; k < UNITS; k++)
                batch->at[count][k] = at + k * KILN_TILE_PLANES * KILN_TILE_PITCH + part * LANES;
            put_pixels(batch, count++, d, p, kind, false, mixed);
        }
        at += UNITS * KILN_TILE_PLANES * KILN_TILE_PITCH;
        if (count == BATCH) {
            draw_batch(batch, count, d, kind, false, covers, mixed);
            count = 0;
        }
    }
    draw_batch(batch, count, d, kind, false, covers, mixed);
}

/* ---- any sprite ------------------------------------------------------------------------------ */

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
    *d = (struct target){.tile = tile, .s = s, .extra = extra};
    if (!covers && tile->adds_apart)
        d->added = tile->added[0];
    if (!tile->has_opaque)
        return true;
    if (box->x_from >= box->x_to)
        return false;
    d->hidden = box_hidden(tile, box);
    return !d->hidden || d->added;
}

/* Finds the pixels in which sprites behind the drawn ones are still visible; returns false if there
 * are none. */
static bool find_transparent(struct kiln_tile *tile)
{
    const uint64_t whole = ~(uint64_t)0 >> (KILN_TILE_WIDTH - tile->width);
    uint64_t any = 0, every = whole;
    for (int y = 0; y < tile->height; y++) {
        uint64_t transparent = 0;
        for (int x = 0; x < KILN_TILE_WIDTH; x += LANES)
            transparent |=
                (uint64_t)vi_bits(vf_load(&tile->pixels[y][KILN_TILE_ALPHA][x]) < 1.0f - NEGLIGIBLE)
                << x;
        tile->transparent[y] = transparent & whole;
        uint64_t seen = tile->transparent[y] | tile->transparent[y] >> 1;
        seen |= seen >> 2;
        seen |= seen >> 4;
        tile->seen[0][y] = (int32_t)(uint32_t)seen;
        tile->seen[1][y] = (int32_t)(seen >> 32);
        any |= tile->transparent[y];
        every &= tile->transparent[y];
    }
    tile->has_opaque = every != whole;
    return any != 0;
}

SIMD void draw_sprite(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                      const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,
                      enum kiln_sprite_shade kind, bool deep, bool covers, bool mixed)
{
    const struct box box = box_in(tile, s);
    struct target target;
    if (!begin_target(tile, s, extra, &box, covers, &target))
        return;
    make_brush(tile, cells, s, kind, deep, mixed, &target.brush);
    struct batch batch;
    if (!deep && box.x_to - box.x_from <= UNIT)
        draw_narrow(&target, &box, &batch, kind, covers, mixed);
    else
        draw_wide(&target, kiln_cells_hull(cells, s->cell), &box, &batch, kind, deep, covers,
                  mixed);
}

/* ---- small sprites of systems with few slots ------------------------------------------------- */

/* Interpolates down between two rows. Each lane's word has a channel of a row in the signed byte at
 * bit `from`, and that of the row below in the next byte. */
SIMD vf between_rows(vi word, int from, vf down)
{
    const vi above = word << (24 - from) >> 24, below = word << (16 - from) >> 24;
    return vf_of(above) + vf_of(below - above) * down;
}

/* Samples a cell in floats at u, v, texels, for the channels from `first` to 3. A word of 4 bytes
 * has two channels. In a cell of alpha alone it has two columns, and begins at any second byte. */
SIMD struct vf4 sample_floats(const struct brush *b, const uint8_t *cell, size_t first, vf u, vf v)
{
    const vi column = vi_of(u), row = vi_of(v);
    const vf right = u - vf_of(column), down = v - vf_of(row);
    const vi at = row * b->pitch + column * b->texel;
    struct vf4 sampled = {{{0}}};
    if (first == 3) {
        vi word;
        for (int i = 0; i < LANES; i++) {
            int32_t texels;
            memcpy(&texels, cell + at[i], sizeof texels);
            word[i] = texels;
        }
        const vf left_side = between_rows(word, 0, down), right_side = between_rows(word, 16, down);
        sampled.c[3] = left_side + (right_side - left_side) * right;
        return sampled;
    }
    const int32_t *texels = (const int32_t *)(const void *)cell;
    for (size_t c = first; c < 4; c += 2) {
        const vi word = (at >> 2) + (int32_t)((c - first) / 2);
        const vi left = vi_gather(texels, word), next = vi_gather(texels, word + b->texel / 4);
        for (int k = 0; k < 2; k++) {
            const vf left_side = between_rows(left, 16 * k, down);
            const vf right_side = between_rows(next, 16 * k, down);
            sampled.c[c + (size_t)k] = left_side + (right_side - left_side) * right;
        }
    }
    return sampled;
}

/* Draws a unit in each of UNITS rows, or a part of one unit. u, v: texels. */
SIMD void draw_floats(const struct target *d, struct batch *batch, vf u, vf v)
{
    const struct kiln_sprite *s = d->s;
    const struct brush *b = &d->brush;
    const size_t first = first_channel((enum kiln_sprite_shade)s->shade);
    const vf zero = vf_all(0.0f), edge = vf_all(s->edge_u);
    if (b->rim) {
        batch->rim[0] = rim_cover(s, u, v);
        batch->inside[0] &= batch->rim[0] > 0.0f;
    } else {
        batch->rim[0] = vf_all(1.0f);
        batch->inside[0] &= (u >= 0.0f) & (u < edge) & (v >= 0.0f) & (v < edge);
    }
    u = vf_min(vf_max(u, zero), edge) + 0.5f;
    v = vf_min(vf_max(v, zero), edge) + 0.5f;
    struct vf4 cell = sample_floats(b, b->cell, first, u, v);
    if (b->next) {
        const struct vf4 next = sample_floats(b, b->next, first, u, v);
        for (size_t c = first; c < 4; c++)
            cell.c[c] += (next.c[c] - cell.c[c]) * s->part;
    }
    struct shaded c = shade_cell(s, d->extra, b, (enum kiln_sprite_shade)s->shade, cell);
    draw_vector(batch, 0, d, c, s->shade == KILN_SHADE_COLOR, false,
                (s->flags & KILN_SPRITE_COVERS) != 0);
}

static void draw_in_floats(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                           const struct kiln_sprite *s, const struct kiln_sprite_extra *extra)
{
    const struct box box = box_in(tile, s);
    struct target d;
    if (!begin_target(tile, s, extra, &box, (s->flags & KILN_SPRITE_COVERS) != 0, &d))
        return;
    make_brush(tile, cells, s, (enum kiln_sprite_shade)s->shade, false,
               (s->flags & KILN_SPRITE_MIXED) != 0, &d.brush);
    d.brush.sampled = 1.0f / 255.0f;
    struct batch batch;
    for (int y = box.y_from; y < box.y_to; y += UNITS) {
        vf row = vf_units_number() + ((float)(tile->y + y) + 0.5f), below = row - s->y;
        for (int x = box.x_from; x < box.x_to; x += LANES / UNITS) {
            vf right = vf_units_count(0) + ((float)(tile->x + x) + 0.5f) - s->x;
            batch.inside[0] = row < (float)(tile->y + box.y_to);
            for (int k = 0; k < UNITS; k++)
                batch.at[0][k] = (y + k) * KILN_TILE_PLANES * KILN_TILE_PITCH + x;
            draw_floats(&d, &batch, (s->u + s->u_x * right) + s->u_y * below,
                        (s->v + s->v_x * right) + s->v_y * below);
        }
    }
}

typedef void drawing(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                     const struct kiln_sprite *s, const struct kiln_sprite_extra *extra);

#define DRAW(name, kind, deep, covers, mixed)                                                      \
    static void name(struct kiln_tile *tile, const struct kiln_cells_content *cells,               \
                     const struct kiln_sprite *s, const struct kiln_sprite_extra *extra)           \
    {                                                                                              \
        draw_sprite(tile, cells, s, extra, kind, deep, covers, mixed);                             \
    }
#define DRAW_FORMS(name, kind, mixed)                                                              \
    DRAW(name##_flat_adds, kind, false, false, mixed)                                              \
    DRAW(name##_flat_covers, kind, false, true, mixed)                                             \
    DRAW(name##_deep_adds, kind, true, false, mixed)                                               \
    DRAW(name##_deep_covers, kind, true, true, mixed)

DRAW_FORMS(glow, KILN_SHADE_GLOW, false)
DRAW_FORMS(alpha, KILN_SHADE_ALPHA, false)
DRAW_FORMS(lit, KILN_SHADE_LIT, false)
DRAW_FORMS(color, KILN_SHADE_COLOR, false)
DRAW_FORMS(plain, KILN_SHADE_PLAIN, false)
DRAW_FORMS(mixed_glow, KILN_SHADE_GLOW, true)
DRAW_FORMS(mixed_alpha, KILN_SHADE_ALPHA, true)
DRAW_FORMS(mixed_lit, KILN_SHADE_LIT, true)
DRAW_FORMS(mixed_color, KILN_SHADE_COLOR, true)

/* Prefetches a sprite, since neighbours in a list are far apart in memory, and, if `extra`, the
 * sprite's extra. */
SIMD void prefetch(struct kiln_sprites sprites, uint32_t number, bool extra)
{
    const char *sprite = (const char *)&sprites.sprites[number];
    for (size_t line = 0; line < sizeof *sprites.sprites; line += 64)
        __builtin_prefetch(sprite + line);
    if (extra)
        __builtin_prefetch(&sprites.extras[number]);
}

/* Lists functions indexed by the flags KILN_SPRITE_DEEP and KILN_SPRITE_COVERS. */
#define ROW(name)                                                                                  \
    {                                                                                              \
        name##_flat_adds, name##_deep_adds, name##_flat_covers, name##_deep_covers                 \
    }

void TILE_DRAW(struct kiln_tile *tile, struct kiln_sprites sprites, const struct kiln_cells *cells,
               const uint32_t *list, size_t count)
{
    static drawing *const draw[2][KILN_SHADES][4] = {
        {ROW(glow), ROW(alpha), ROW(lit), ROW(color), ROW(plain)},
        {ROW(mixed_glow), ROW(mixed_alpha), ROW(mixed_lit), ROW(mixed_color), ROW(plain)},
    };
    const struct kiln_cells_content content = kiln_cells_content(cells);
    tile->has_opaque = false;
    uint32_t covering = 0;
    for (size_t i = count; i-- > 0;) {
        const struct kiln_sprite *s = &sprites.sprites[list[i]];
        const struct kiln_sprite_extra *extra = &sprites.extras[list[i]];
        if (i >= PREFETCH_DISTANCE)
            prefetch(sprites, list[i - PREFETCH_DISTANCE], kiln_sprite_has_extra(s));
        bool mixed = (s->flags & KILN_SPRITE_MIXED) != 0;
        uint32_t form = s->flags & (KILN_SPRITE_DEEP | KILN_SPRITE_COVERS);
        if (s->flags & KILN_SPRITE_FINE)
            draw_in_floats(tile, &content, s, extra);
        else
            draw[mixed][s->shade][form](tile, &content, s, extra);
        covering += (s->flags & KILN_SPRITE_COVERS) != 0;
        if (covering == COVER_CHECK_INTERVAL && tile->over) {
            covering = 0;
            if (!find_transparent(tile) && !tile->adds_apart)
                return;
        }
    }
}
