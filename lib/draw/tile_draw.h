/* Sprites into a tile: included by a file for each level of KILN_SIMD_LEVEL, which says what
 * TILE_DRAW is called. The operations of a pixel are those of shaders/draw/shade.glsl (Heinz
 * 2019, 3.2.3 to 3.2.6); all lanes do them, and those outside of the sprite with alpha 0.
 */
#include "draw/simd.h"
#include "draw/tile.h"

enum { TILE_AHEAD = 6 }; /* sprites that are fetched beforehand */

/* The colour of a vector of pixels, not yet faded. */
struct shaded {
    vf red, green, blue, alpha;
};

struct place {
    vf u, v;
};

/* The texels that a sprite shows. */
struct source {
    const uint8_t *cell, *next, *moves; /* moves is NULL where nothing does */
};

/* Bilinear, clamped to the centres of the outer texels. */
SIMD struct vf4 sample(const uint8_t *texels, uint32_t pitch, struct place at)
{
    vf zero = vf_all(0.0f), last = vf_all((float)(pitch - 2));
    vf u = vf_min(vf_max(at.u - 0.5f, zero), last), v = vf_min(vf_max(at.v - 0.5f, zero), last);
    vi column = __builtin_convertvector(u, vi), row = __builtin_convertvector(v, vi);
    vf right = (u - __builtin_convertvector(column, vf)) * 127.0f + 0.5f;
    vf down = (v - __builtin_convertvector(row, vf)) * 32767.0f;
    return vf_fetch(texels, pitch, row * (int32_t)pitch + column,
                    __builtin_convertvector(right, vi), __builtin_convertvector(down, vi));
}

/* Between two cells, each of which is followed to where it is at that time. */
SIMD struct vf4 sample_between(const struct kiln_sprite *s, const struct source *from,
                               struct place at)
{
    struct place first = at, second = at;
    if (from->moves) {
        float scale = (float)KILN_ATLAS_MOTION / s->edge_u;
        struct vf4 way =
            sample(from->moves, KILN_ATLAS_MOTION + 1, (struct place){at.u * scale, at.v * scale});
        vf x = (way.c[0] * (1.0f / 127.0f) - 128.0f) * (s->motion / 127.0f);
        vf y = (way.c[1] * (1.0f / 127.0f) - 128.0f) * (s->motion / 127.0f);
        first = (struct place){at.u - x * s->part, at.v - y * s->part};
        second = (struct place){at.u + x * (1.0f - s->part), at.v + y * (1.0f - s->part)};
    }
    struct vf4 a = sample(from->cell, s->pitch, first), b = sample(from->next, s->pitch, second);
    for (int c = 0; c < 4; c++)
        a.c[c] += (b.c[c] - a.c[c]) * s->part;
    return a;
}

SIMD struct vf4 sample_cell(const struct kiln_sprite *s, const struct source *from, struct place at,
                            bool mixed)
{
    return mixed ? sample(from->cell, s->pitch, at) : sample_between(s, from, at);
}

SIMD struct shaded shade_glow(const struct kiln_sprite *s, struct vf4 cell)
{
    vf alpha = cell.c[3] * (1.0f / FETCHED_ONE), heat = cell.c[2] * (1.0f / FETCHED_ONE);
    return (struct shaded){.red = (s->base[0] + s->slope[0] * heat) * alpha,
                           .green = (s->base[1] + s->slope[1] * heat) * alpha,
                           .blue = (s->base[2] + s->slope[2] * heat) * alpha,
                           .alpha = alpha};
}

SIMD struct shaded shade_lit(const struct kiln_sprite *s, struct vf4 cell)
{
    vf alpha = cell.c[3] * (1.0f / FETCHED_ONE), heat = cell.c[2] * (1.0f / FETCHED_ONE);
    vf x = cell.c[0] * (2.0f / FETCHED_ONE) - 1.0f, y = cell.c[1] * (2.0f / FETCHED_ONE) - 1.0f;
    vf zero = vf_all(0.0f);
    vf z = vf_sqrt(vf_max(1.0f - (x * x + y * y), zero));
    vf rgb[3];
    for (int c = 0; c < 3; c++) {
        vf light = s->light[0][c] + s->light[1][c] * x + s->light[2][c] * y + s->light[3][c] * z;
        rgb[c] = (s->base[c] + s->slope[c] * heat + vf_max(light, zero)) * alpha;
    }
    return (struct shaded){rgb[0], rgb[1], rgb[2], alpha};
}

/* Colour cells are stored under a square root. */
SIMD struct shaded shade_color(const struct kiln_sprite *s, struct vf4 cell)
{
    for (int c = 0; c < 4; c++) {
        cell.c[c] *= 1.0f / FETCHED_ONE;
        cell.c[c] *= cell.c[c];
    }
    return (struct shaded){cell.c[0] * s->base[0], cell.c[1] * s->base[1], cell.c[2] * s->base[2],
                           cell.c[3]};
}

/* The part of a pixel inside a disc or a rectangle. */
SIMD struct shaded shade_plain(const struct kiln_sprite *s, struct place at)
{
    vf alpha;
    if (s->flags & KILN_SPRITE_DISC)
        alpha = vf_clamp01(s->edge_u + 0.5f - vf_sqrt(at.u * at.u + at.v * at.v));
    else
        alpha = vf_clamp01(s->edge_u + 0.5f - vf_abs(at.u)) *
                vf_clamp01(s->edge_v + 0.5f - vf_abs(at.v));
    return (struct shaded){s->base[0] * alpha, s->base[1] * alpha, s->base[2] * alpha, alpha};
}

SIMD struct shaded shade(const struct kiln_sprite *s, const struct source *from, struct place at,
                         enum kiln_sprite_shade kind, bool mixed)
{
    switch (kind) {
    case KILN_SHADE_LIT:
        return shade_lit(s, sample_cell(s, from, at, mixed));
    case KILN_SHADE_COLOR:
        return shade_color(s, sample_cell(s, from, at, mixed));
    case KILN_SHADE_PLAIN:
        return shade_plain(s, at);
    default:
        return shade_glow(s, sample_cell(s, from, at, mixed));
    }
}

/* What is left of a sprite before the scene: equation 3.3, clamped to a fade, or as printed. */
SIMD vf fade(const struct kiln_sprite *s, vf scene, vf depth, vi inside)
{
    vf one = vf_all(1.0f);
    vi visible = inside & (depth <= scene);
    if (s->soft <= 0.0f)
        return vf_where(visible, one);
    if (s->flags & KILN_SPRITE_LITERAL)
        return vf_where(visible, vf_abs(scene - s->distance) * s->soft);
    return vf_where(inside, vf_clamp01((scene - depth) * s->soft));
}

SIMD void blend(float *to, vf color, vf passed)
{
    vf_store(to, color + vf_load(to) * passed);
}

SIMD void add(float *to, vf color)
{
    vf_store(to, color + vf_load(to));
}

struct row {
    float u, v, q; /* the sprite's planes at the anchor's column */
    float (*pixels)[KILN_TILE_PITCH];
    const struct source *source;
    bool whole; /* all of the tile lies so far behind the sprite that nothing fades it */
};

/* A vector of pixels from column x of the tile. */
SIMD void draw_pixels(const struct kiln_tile *tile, const struct kiln_sprite *s,
                      const struct row *row, int x, enum kiln_sprite_shade kind, bool deep,
                      bool covers, bool mixed)
{
    vf from_anchor = vf_count() + ((float)(tile->x + x) + 0.5f - s->x);
    struct place at = {row->u + s->u_x * from_anchor, row->v + s->v_x * from_anchor};
    vf depth = vf_all(s->depth);
    vi inside = ~(vi){0};
    if (deep) {
        vf q = row->q + s->q_x * from_anchor;
        inside &= q > 0.0f;
        depth = 1.0f / q;
        if (kind != KILN_SHADE_PLAIN) {
            at.u *= depth;
            at.v *= depth;
        }
    }
    if (kind != KILN_SHADE_PLAIN)
        inside &= (at.u >= 0.0f) & (at.u < s->edge_u) & (at.v >= 0.0f) & (at.v < s->edge_v);

    struct shaded c = shade(s, row->source, at, kind, mixed);
    vf part;
    if (row->whole)
        part = vf_where(inside, vf_all(s->opacity));
    else
        part = fade(s, vf_load(row->pixels[KILN_TILE_DEPTH] + x), depth, inside) * s->opacity;
    if (s->flags & KILN_SPRITE_LITERAL) /* has no bound of its own: alpha up to 1 */
        part = vf_min(part, 1.0f / vf_max(c.alpha, vf_all(1e-6f)));
    c.red *= part;
    c.green *= part;
    c.blue *= part;
    float(*pixels)[KILN_TILE_PITCH] = row->pixels;
    if (covers) {
        c.alpha *= part;
        vf passed = 1.0f - c.alpha * tile->over;
        blend(pixels[KILN_TILE_RED] + x, c.red, passed);
        blend(pixels[KILN_TILE_GREEN] + x, c.green, passed);
        blend(pixels[KILN_TILE_BLUE] + x, c.blue, passed);
        blend(pixels[KILN_TILE_ALPHA] + x, c.alpha, passed);
        if (tile->glows) {
            blend(pixels[KILN_TILE_GLOW_RED] + x, c.red * s->bloom[0], passed);
            blend(pixels[KILN_TILE_GLOW_GREEN] + x, c.green * s->bloom[1], passed);
            blend(pixels[KILN_TILE_GLOW_BLUE] + x, c.blue * s->bloom[2], passed);
        }
        return;
    }
    add(pixels[KILN_TILE_RED] + x, c.red);
    add(pixels[KILN_TILE_GREEN] + x, c.green);
    add(pixels[KILN_TILE_BLUE] + x, c.blue);
    if (tile->glows) {
        add(pixels[KILN_TILE_GLOW_RED] + x, c.red * s->bloom[0]);
        add(pixels[KILN_TILE_GLOW_GREEN] + x, c.green * s->bloom[1]);
        add(pixels[KILN_TILE_GLOW_BLUE] + x, c.blue * s->bloom[2]);
    }
}

struct span {
    int from, to;
};

static inline float least(float a, float b)
{
    return a < b ? a : b;
}

static inline float most(float a, float b)
{
    return a > b ? a : b;
}

/* The columns where 0 <= place + step * x < edge, a little more than exactly. */
static inline void narrow(float place, float pixels_a_step, float edge, float offset,
                          struct span *span)
{
    if (pixels_a_step == 0.0f)
        return;
    float one = -place * pixels_a_step + offset, other = (edge - place) * pixels_a_step + offset;
    float from = most(least(one, other), (float)span->from);
    float to = least(most(one, other) + 2.0f, (float)span->to);
    if (!(from < to)) {
        span->to = span->from;
        return;
    }
    span->from = (int)from;
    span->to = (int)to;
}

SIMD void draw_sprite(struct kiln_tile *tile, const struct kiln_sprite *s,
                      const struct source *source, enum kiln_sprite_shade kind, bool deep,
                      bool covers, bool mixed)
{
    const struct span columns = {
        s->x_from > tile->x ? s->x_from - tile->x : 0,
        s->x_to < tile->x + tile->width ? s->x_to - tile->x : tile->width,
    };
    int y = s->y_from > tile->y ? s->y_from - tile->y : 0;
    int y_to = s->y_to < tile->y + tile->height ? s->y_to - tile->y : tile->height;
    float offset = s->x - 0.5f - (float)tile->x;
    struct row row = {.source = source,
                      .whole =
                          !deep && !(s->flags & KILN_SPRITE_LITERAL) && tile->nearest >= s->depth &&
                          (tile->nearest - s->depth) * s->soft >= (s->soft > 0.0f ? 1.0f : 0.0f)};
    for (; y < y_to; y++) {
        float from_anchor = (float)(tile->y + y) + 0.5f - s->y;
        row.u = s->u + s->u_y * from_anchor;
        row.v = s->v + s->v_y * from_anchor;
        row.q = s->q + s->q_y * from_anchor;
        row.pixels = tile->pixels[y];
        struct span span = columns;
        if (!deep && kind != KILN_SHADE_PLAIN) {
            narrow(row.u, s->pixels_a_u, s->edge_u, offset, &span);
            narrow(row.v, s->pixels_a_v, s->edge_v, offset, &span);
        }
        for (int x = span.from; x < span.to; x += LANES)
            draw_pixels(tile, s, &row, x, kind, deep, covers, mixed);
    }
}

typedef void drawing(struct kiln_tile *tile, const struct kiln_sprite *s,
                     const struct source *source);

#define DRAW(name, kind, deep, covers, mixed)                                                      \
    static void name(struct kiln_tile *tile, const struct kiln_sprite *s,                          \
                     const struct source *source)                                                  \
    {                                                                                              \
        draw_sprite(tile, s, source, kind, deep, covers, mixed);                                   \
    }
#define DRAW_FORMS(name, kind, mixed)                                                              \
    DRAW(name##_flat_adds, kind, false, false, mixed)                                              \
    DRAW(name##_flat_covers, kind, false, true, mixed)                                             \
    DRAW(name##_deep_adds, kind, true, false, mixed)                                               \
    DRAW(name##_deep_covers, kind, true, true, mixed)

DRAW_FORMS(glow, KILN_SHADE_GLOW, false)
DRAW_FORMS(lit, KILN_SHADE_LIT, false)
DRAW_FORMS(color, KILN_SHADE_COLOR, false)
DRAW_FORMS(plain, KILN_SHADE_PLAIN, false)
DRAW_FORMS(mixed_glow, KILN_SHADE_GLOW, true)
DRAW_FORMS(mixed_lit, KILN_SHADE_LIT, true)
DRAW_FORMS(mixed_color, KILN_SHADE_COLOR, true)

/* By KILN_SPRITE_DEEP and KILN_SPRITE_COVERS. */
#define ROW(name)                                                                                  \
    {                                                                                              \
        name##_flat_adds, name##_deep_adds, name##_flat_covers, name##_deep_covers                 \
    }

static struct source find_source(const struct kiln_cells *cells, const struct kiln_sprite *s)
{
    const uint8_t *const *texels = kiln_cells_texels(cells);
    if (s->shade == KILN_SHADE_PLAIN)
        return (struct source){NULL, NULL, NULL};
    if (s->flags & KILN_SPRITE_MIXED)
        return (struct source){texels[s->cell], NULL, NULL};
    return (struct source){texels[s->cell], texels[s->next_cell],
                           s->motion > 0.0f ? kiln_cells_moves(cells, s->moves) : NULL};
}

void TILE_DRAW(struct kiln_tile *tile, const struct kiln_sprite *sprites,
               const struct kiln_cells *cells, const uint32_t *list, size_t count)
{
    static drawing *const draw[2][KILN_SHADES][4] = {
        {ROW(glow), ROW(lit), ROW(color), ROW(plain)},
        {ROW(mixed_glow), ROW(mixed_lit), ROW(mixed_color), ROW(plain)},
    };
    for (size_t i = 0; i < count; i++) {
        const struct kiln_sprite *s = &sprites[list[i]];
        if (i + TILE_AHEAD < count) { /* neighbours in a list are far apart in memory */
            const char *next = (const char *)&sprites[list[i + TILE_AHEAD]];
            for (size_t line = 0; line < sizeof *s; line += 64)
                __builtin_prefetch(next + line);
        }
        const struct source source = find_source(cells, s);
        bool mixed = (s->flags & KILN_SPRITE_MIXED) != 0;
        uint32_t form = s->flags & (KILN_SPRITE_DEEP | KILN_SPRITE_COVERS);
        draw[mixed][s->shade][form](tile, s, &source);
    }
}
