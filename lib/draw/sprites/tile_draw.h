/* This header draws sprites into a tile. tile_simd.c, which is compiled for each KILN_SIMD_LEVEL,
 * defines the name TILE_DRAW and includes it. The operations of a pixel, some of them in
 * tile_shade.h, are those of shaders/draw/sprites/shade.glsl (Heinz 2019, 3.2.3 to 3.2.6). All
 * lanes do them; lanes outside of the sprite have alpha 0. Sprites are drawn from the nearest to
 * the farthest, and those behind opaque pixels are left out, except where additive sprites are
 * added apart, too. */
#include "draw/sprites/tile_floats.h"
#include "draw/sprites/tile_ribbon.h"

enum {
    PREFETCH_DISTANCE = 6,     /* sprites that are prefetched */
    COVER_CHECK_INTERVAL = 24, /* covering sprites between two calls of find_transparent */
};

/* A pixel that lets through less than this part of the light from behind counts as opaque. */
#define NEGLIGIBLE 0x1p-16f

/* ---- wide sprites: units of their rows ------------------------------------------------------- */

/* Draws the chosen units of some rows. */
SIMD void draw_units(const struct target *d, const struct rows *rows, const struct box *box,
                     const float steps[3], enum units_choice choice, struct batch *batch,
                     batch_drawing *draw, bool textured, bool deep, bool mixed)
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
                put_pixels(batch, drawn++, d, p, textured, deep, mixed);
            }
        }
        draw(batch, drawn, d);
    }
}

SIMD void draw_wide(struct target *d, const struct kiln_cell_hull *hull, const struct box *box,
                    struct batch *batch, batch_drawing *draw, bool textured, bool deep, bool covers,
                    bool mixed)
{
    const struct kiln_sprite *s = d->s;
    struct rows rows;
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
        draw_units(d, &rows, box, steps, choice, batch, draw, textured, deep, mixed);
        if (covers || choice != UNITS_SEEN || !d->added)
            return;
        choice = UNITS_HIDDEN;
        d->hidden = true;
    }
}

/* ---- sprites no wider than a unit: one a row ------------------------------------------------- */

SIMD void draw_narrow(const struct target *d, const struct box *box, struct batch *batch,
                      batch_drawing *draw, bool textured, bool mixed)
{
    const struct kiln_sprite *s = d->s;
    const struct kiln_tile *tile = d->tile;
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
            put_pixels(batch, count++, d, p, textured, false, mixed);
        }
        at += UNITS * KILN_TILE_PLANES * KILN_TILE_PITCH;
        if (count == BATCH) {
            draw(batch, count, d);
            count = 0;
        }
    }
    draw(batch, count, d);
}

/* ---- any sprite ------------------------------------------------------------------------------ */

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

/* Draws a sprite, batch by batch. textured, deep, mixed: as its batches are drawn. */
SIMD void draw_sprite(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                      const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,
                      batch_drawing *draw, bool textured, bool deep, bool mixed)
{
    const struct box box = box_in(tile, s);
    const bool covers = (s->flags & KILN_SPRITE_COVERS) != 0;
    struct target target;
    if (!begin_target(tile, s, extra, &box, covers, &target))
        return;
    make_brush(tile, cells, s, (enum kiln_sprite_shade)s->shade, deep, mixed, &target.brush);
    struct batch batch;
    if (!deep && box.x_to - box.x_from <= UNIT)
        draw_narrow(&target, &box, &batch, draw, textured, mixed);
    else
        draw_wide(&target, textured ? kiln_cells_hull(cells, s->cell) : NULL, &box, &batch, draw,
                  textured, deep, covers, mixed);
}

/* ---- forms of sprites ------------------------------------------------------------------------ */

/* A sprite's pixels are listed by one of these functions, by its shape. */
typedef void drawing(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                     const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,
                     batch_drawing *draw);

#define DRAW(name, textured, deep, mixed)                                                          \
    static void name(struct kiln_tile *tile, const struct kiln_cells_content *cells,               \
                     const struct kiln_sprite *s, const struct kiln_sprite_extra *extra,           \
                     batch_drawing *draw)                                                          \
    {                                                                                              \
        draw_sprite(tile, cells, s, extra, draw, textured, deep, mixed);                           \
    }
DRAW(list_plain, false, false, false)
DRAW(list_plain_deep, false, true, false)
DRAW(list_cells, true, false, false)
DRAW(list_cells_deep, true, true, false)
DRAW(list_mixed, true, false, true)
DRAW(list_mixed_deep, true, true, true)

/* The listed pixels are drawn by one of these functions, by the sprite's shade, too. */
#define DRAW_BATCH(name, kind, deep, covers, mixed)                                                \
    static void name(struct batch *batch, int count, const struct target *d)                       \
    {                                                                                              \
        draw_batch(batch, count, d, kind, deep, covers, mixed);                                    \
    }
#define BATCH_FORMS(name, kind, mixed)                                                             \
    DRAW_BATCH(name##_flat_adds, kind, false, false, mixed)                                        \
    DRAW_BATCH(name##_flat_covers, kind, false, true, mixed)                                       \
    DRAW_BATCH(name##_deep_adds, kind, true, false, mixed)                                         \
    DRAW_BATCH(name##_deep_covers, kind, true, true, mixed)

BATCH_FORMS(glow, KILN_SHADE_GLOW, false)
BATCH_FORMS(alpha, KILN_SHADE_ALPHA, false)
BATCH_FORMS(lit, KILN_SHADE_LIT, false)
BATCH_FORMS(color, KILN_SHADE_COLOR, false)
BATCH_FORMS(plain, KILN_SHADE_PLAIN, false)
BATCH_FORMS(mixed_glow, KILN_SHADE_GLOW, true)
BATCH_FORMS(mixed_alpha, KILN_SHADE_ALPHA, true)
BATCH_FORMS(mixed_lit, KILN_SHADE_LIT, true)
BATCH_FORMS(mixed_color, KILN_SHADE_COLOR, true)

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

static void draw_in_batches(struct kiln_tile *tile, const struct kiln_cells_content *cells,
                            const struct kiln_sprite *s, const struct kiln_sprite_extra *extra)
{
    static drawing *const list[3][2] = {{list_cells, list_cells_deep},
                                        {list_mixed, list_mixed_deep},
                                        {list_plain, list_plain_deep}};
    static batch_drawing *const draw[2][KILN_SHADES][4] = {
        {ROW(glow), ROW(alpha), ROW(lit), ROW(color), ROW(plain)},
        {ROW(mixed_glow), ROW(mixed_alpha), ROW(mixed_lit), ROW(mixed_color), ROW(plain)},
    };
    const bool mixed = (s->flags & KILN_SPRITE_MIXED) != 0;
    const bool deep = (s->flags & KILN_SPRITE_DEEP) != 0;
    const uint32_t form = s->flags & (KILN_SPRITE_DEEP | KILN_SPRITE_COVERS);
    list[s->shade == KILN_SHADE_PLAIN ? 2 : mixed][deep](tile, cells, s, extra,
                                                         draw[mixed][s->shade][form]);
}

void TILE_DRAW(struct kiln_tile *tile, struct kiln_sprites sprites, const struct kiln_cells *cells,
               const uint32_t *list, size_t count)
{
    const struct kiln_cells_content content = kiln_cells_content(cells);
    tile->has_opaque = false;
    uint32_t covering = 0;
    for (size_t i = count; i-- > 0;) {
        const struct kiln_sprite *s = &sprites.sprites[list[i]];
        const struct kiln_sprite_extra *extra = &sprites.extras[list[i]];
        if (i >= PREFETCH_DISTANCE)
            prefetch(sprites, list[i - PREFETCH_DISTANCE], kiln_sprite_has_extra(s));
        if (s->shade >= KILN_SHADES)
            draw_ribbon(tile, &content, s, extra);
        else if (s->flags & KILN_SPRITE_FINE)
            draw_in_floats(tile, &content, s, extra);
        else
            draw_in_batches(tile, &content, s, extra);
        covering += (s->flags & KILN_SPRITE_COVERS) != 0;
        if (covering == COVER_CHECK_INTERVAL && tile->over) {
            covering = 0;
            if (!find_transparent(tile) && !tile->adds_apart)
                return;
        }
    }
}
