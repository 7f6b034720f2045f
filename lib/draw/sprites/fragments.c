/* This file sorts and blends the fragments of each pixel of a tile. It finds the fragments of a
 * sprite by drawing the sprite alone into an empty tile, so that the code that draws sprites needs
 * no lists. A row with too many fragments is drawn again for the nearer ones, so that no fragment
 * is left out. */
#include "draw/sprites/fragments.h"

#include <stdlib.h>
#include <string.h>

#include "shared/fragment_layout.h"

enum { FRAGMENTS_AT_A_TIME = 1 << 19, TILE_PIXELS = KILN_TILE_WIDTH * KILN_TILE_HEIGHT };

struct fragment {
    float rgb[3], alpha; /* premultiplied */
    uint64_t key;        /* grows from far to near; for equal depths, in the order of sprites */
    uint32_t sprite;
    uint32_t pixel; /* number of the pixel in the scratch tile */
};

/* Links a fragment to the list of its pixel. */
struct link {
    uint64_t key;
    uint32_t fragment;
};

struct kiln_fragments {
    struct kiln_tile *scratch;  /* some rows of the tile, with one sprite at a time */
    struct fragment *fragments; /* FRAGMENTS_AT_A_TIME elements, as in links */
    struct link *links;
    size_t count;                /* number of fragments */
    uint64_t first_key, end_key; /* fragments with first_key <= key < end_key are gathered now */
    uint32_t list_ends[TILE_PIXELS]; /* end of each pixel's list in links */
};

struct kiln_fragments *kiln_fragments_create(void)
{
    struct kiln_fragments *f = calloc(1, sizeof *f);
    if (!f)
        return NULL;
    f->scratch = aligned_alloc(64, sizeof *f->scratch);
    f->fragments = malloc(FRAGMENTS_AT_A_TIME * sizeof *f->fragments);
    f->links = malloc(FRAGMENTS_AT_A_TIME * sizeof *f->links);
    if (!f->scratch || !f->fragments || !f->links)
        kiln_fragments_destroy(&f);
    return f;
}

void kiln_fragments_destroy(struct kiln_fragments **fragments)
{
    if (!*fragments)
        return;
    free((*fragments)->scratch);
    free((*fragments)->fragments);
    free((*fragments)->links);
    free(*fragments);
    *fragments = NULL;
}

/* ---- gathering ------------------------------------------------------------------------------- */

/* Holds a range of pixels of the scratch tile. */
struct box {
    int x_from, x_to, y_from, y_to;
};

/* Returns the pixels of a tile that a sprite may touch. */
static struct box find_box(const struct kiln_tile *tile, const struct kiln_sprite *s)
{
    return (struct box){
        .x_from = s->x_from > tile->x ? s->x_from - tile->x : 0,
        .x_to = s->x_to < tile->x + tile->width ? s->x_to - tile->x : tile->width,
        .y_from = s->y_from > tile->y ? s->y_from - tile->y : 0,
        .y_to = s->y_to < tile->y + tile->height ? s->y_to - tile->y : tile->height,
    };
}

/* Makes the scratch tile an empty copy of some rows of a tile, with their depth. */
static void begin_rows(struct kiln_fragments *f, const struct kiln_tile *tile, int y, int rows)
{
    struct kiln_tile *scratch = f->scratch;
    *scratch = *tile;
    scratch->y = tile->y + y;
    scratch->height = rows;
    scratch->glow = KILN_TILE_GLOW_NONE;
    for (int row = 0; row < rows; row++) {
        memset(scratch->pixels[row], 0, KILN_TILE_DEPTH * sizeof *scratch->pixels[row]);
        memcpy(scratch->pixels[row][KILN_TILE_DEPTH], tile->pixels[y + row][KILN_TILE_DEPTH],
               sizeof scratch->pixels[row][KILN_TILE_DEPTH]);
    }
    f->count = 0;
}

static void clear_box(struct kiln_tile *tile, const struct box *box)
{
    size_t bytes = (size_t)(box->x_to - box->x_from) * sizeof(float);
    for (int y = box->y_from; y < box->y_to; y++) {
        for (int plane = 0; plane < KILN_TILE_DEPTH; plane++)
            memset(&tile->pixels[y][plane][box->x_from], 0, bytes);
    }
}

/* Holds the view depth of a sprite's plane at a pixel, m, and half of the sprite's thickness there,
 * m. */
struct sheet_depths {
    float depth, half_depth;
};

static struct sheet_depths find_sheet_depths(const struct kiln_sprite *s, float x, float y)
{
    float dx = x - s->x, dy = y - s->y;
    float u = s->u + s->u_x * dx + s->u_y * dy, v = s->v + s->v_x * dx + s->v_y * dy;
    struct sheet_depths place = {.depth = s->depth};
    if (s->flags & KILN_SPRITE_DEEP) {
        place.depth = 1.0f / (s->q + s->q_x * dx + s->q_y * dy);
        u *= place.depth;
        v *= place.depth;
    }
    if (s->bulge > 0.0f) {
        float across = 2.0f * u / s->edge_u - 1.0f, along = 2.0f * v / s->edge_v - 1.0f;
        float inside = exact_max(1.0f - (across * across + along * along), 0.0f);
        place.half_depth = 0.5f * s->bulge * exact_sqrt(inside);
    }
    return place;
}

/* Adds a fragment, unless its key is not gathered now. place: its number among fragments of equal
 * depth. */
static void add_fragment(struct kiln_fragments *f, const struct fragment *fragment, float depth,
                         uint32_t place)
{
    const uint64_t key = (uint64_t)~FLOAT_BITS(exact_max(depth, 0.0f)) << 32 | place;
    if (key < f->first_key || key >= f->end_key)
        return;
    struct fragment *to = &f->fragments[f->count++];
    *to = *fragment;
    to->key = key;
}

/* Adds the fragment of a sprite in a pixel of the scratch tile; two for a thick sprite. */
static void add_pixel(struct kiln_fragments *f, const struct kiln_sprite *s, int x, int y,
                      uint32_t number, uint32_t order)
{
    const struct kiln_tile *tile = f->scratch;
    const float(*planes)[KILN_TILE_PITCH] = (const float(*)[KILN_TILE_PITCH])tile->pixels[y];
    struct fragment fragment = {
        .rgb = {planes[KILN_TILE_RED][x], planes[KILN_TILE_GREEN][x], planes[KILN_TILE_BLUE][x]},
        .alpha = planes[KILN_TILE_ALPHA][x],
        .sprite = number,
        .pixel = (uint32_t)(y * KILN_TILE_WIDTH + x),
    };
    if (fragment.rgb[0] == 0.0f && fragment.rgb[1] == 0.0f && fragment.rgb[2] == 0.0f &&
        fragment.alpha == 0.0f)
        return;
    struct sheet_depths at =
        find_sheet_depths(s, (float)(tile->x + x) + 0.5f, (float)(tile->y + y) + 0.5f);
    if (!(at.half_depth > 0.0f)) {
        add_fragment(f, &fragment, at.depth, 2 * order);
        return;
    }
    fragment.alpha = half_alpha(fragment.alpha);
    float part = half_color(fragment.alpha);
    for (int c = 0; c < 3; c++)
        fragment.rgb[c] *= part;
    add_fragment(f, &fragment, at.depth + at.half_depth, 2 * order);
    add_fragment(f, &fragment, at.depth - at.half_depth, 2 * order + 1);
}

static size_t count_before(const struct kiln_fragments *f, uint64_t key)
{
    size_t count = 0;
    for (size_t i = 0; i < f->count; i++)
        count += f->fragments[i].key < key;
    return count;
}

/* Drops about the nearer half of the fragments, and gathers only farther ones from now on. A key
 * occurs in a row at most once a pixel, so there is a key that divides the fragments. */
static void drop_nearer(struct kiln_fragments *f)
{
    uint64_t low = f->first_key, high = f->end_key;
    size_t kept_count;
    do {
        f->end_key = low + (high - low) / 2;
        kept_count = count_before(f, f->end_key);
        if (kept_count < f->count / 4)
            low = f->end_key;
        else
            high = f->end_key;
    } while (kept_count < f->count / 4 || kept_count > f->count * 3 / 4);
    kept_count = 0;
    for (size_t i = 0; i < f->count; i++) {
        if (f->fragments[i].key < f->end_key)
            f->fragments[kept_count++] = f->fragments[i];
    }
    f->count = kept_count;
}

/* Gathers the fragments of some rows of a tile. In a single row it gathers as many as there is room
 * for: the farthest of those that have not been blended yet. Returns false if several rows together
 * have too many fragments. */
static bool gather(struct kiln_fragments *f, kiln_tile_draw *draw, const struct kiln_tile *tile,
                   int y, int rows, const struct kiln_sprite *sprites,
                   const struct kiln_cells *cells, const uint32_t *list, size_t count)
{
    begin_rows(f, tile, y, rows);
    for (size_t i = 0; i < count; i++) {
        const struct kiln_sprite *s = &sprites[list[i]];
        const struct box box = find_box(f->scratch, s);
        if (box.y_from >= box.y_to)
            continue;
        size_t most =
            f->count + 2 * (size_t)(box.x_to - box.x_from) * (size_t)(box.y_to - box.y_from);
        if (most > FRAGMENTS_AT_A_TIME && rows > 1)
            return false;
        if (most > FRAGMENTS_AT_A_TIME)
            drop_nearer(f);
        draw(f->scratch, sprites, cells, &list[i], 1);
        for (int row = box.y_from; row < box.y_to; row++) {
            for (int x = box.x_from; x < box.x_to; x++)
                add_pixel(f, s, x, row, list[i], (uint32_t)i);
        }
        clear_box(f->scratch, &box);
    }
    return true;
}

/* ---- blending -------------------------------------------------------------------------------- */

/* Makes the list of each pixel: it counts fragments, turns counts into places by a prefix sum, and
 * writes the links. */
static void make_lists(struct kiln_fragments *f)
{
    memset(f->list_ends, 0, sizeof f->list_ends);
    for (size_t i = 0; i < f->count; i++)
        f->list_ends[f->fragments[i].pixel]++;
    uint32_t place = 0;
    for (size_t pixel = 0; pixel < TILE_PIXELS; pixel++) {
        uint32_t length = f->list_ends[pixel];
        f->list_ends[pixel] = place;
        place += length;
    }
    for (size_t i = 0; i < f->count; i++)
        f->links[f->list_ends[f->fragments[i].pixel]++] =
            (struct link){f->fragments[i].key, (uint32_t)i};
}

/* Sorts a list by Shell's sort, whose code is short and which is quick on lists that are almost
 * sorted. */
static void sort_list(struct link *links, size_t count)
{
    size_t gap = 1;
    while (gap < count / 3)
        gap = gap * 3 + 1;
    for (; gap > 0; gap /= 3) {
        for (size_t i = gap; i < count; i++) {
            const struct link link = links[i];
            size_t to = i;
            for (; to >= gap && link.key < links[to - gap].key; to -= gap)
                links[to] = links[to - gap];
            links[to] = link;
        }
    }
}

static void blend_list(const struct kiln_fragments *f, const struct link *links, size_t count,
                       const struct kiln_sprite *sprites, float (*planes)[KILN_TILE_PITCH], int x)
{
    float color[4], glow[3];
    for (int c = 0; c < 4; c++)
        color[c] = planes[KILN_TILE_RED + c][x];
    for (int c = 0; c < 3; c++)
        glow[c] = planes[KILN_TILE_GLOW_RED + c][x];
    for (size_t i = 0; i < count; i++) {
        const struct fragment *fragment = &f->fragments[links[i].fragment];
        const float *bloom = sprites[fragment->sprite].bloom;
        float passed = 1.0f - fragment->alpha;
        for (int c = 0; c < 3; c++) {
            color[c] = fragment->rgb[c] + color[c] * passed;
            glow[c] = fragment->rgb[c] * bloom[c] + glow[c] * passed;
        }
        color[3] = fragment->alpha + color[3] * passed;
    }
    for (int c = 0; c < 4; c++)
        planes[KILN_TILE_RED + c][x] = color[c];
    for (int c = 0; c < 3; c++)
        planes[KILN_TILE_GLOW_RED + c][x] = glow[c];
}

static void blend_rows(struct kiln_fragments *f, struct kiln_tile *tile, int y, int rows,
                       const struct kiln_sprite *sprites)
{
    make_lists(f);
    uint32_t first = 0;
    for (int pixel = 0; pixel < rows * KILN_TILE_WIDTH; pixel++) {
        uint32_t count = f->list_ends[pixel] - first;
        if (count > 0) {
            sort_list(f->links + first, count);
            blend_list(f, f->links + first, count, sprites,
                       tile->pixels[y + pixel / KILN_TILE_WIDTH], pixel % KILN_TILE_WIDTH);
        }
        first += count;
    }
}

void kiln_fragments_draw(struct kiln_fragments *fragments, kiln_tile_draw *draw,
                         struct kiln_tile *tile, const struct kiln_sprite *sprites,
                         const struct kiln_cells *cells, const uint32_t *list, size_t count)
{
    struct kiln_fragments *f = fragments;
    int rows = tile->height;
    f->first_key = 0;
    for (int y = 0; y < tile->height;) {
        rows = rows < tile->height - y ? rows : tile->height - y;
        f->end_key = UINT64_MAX;
        if (!gather(f, draw, tile, y, rows, sprites, cells, list, count)) {
            rows = (rows + 1) / 2;
            continue;
        }
        blend_rows(f, tile, y, rows, sprites);
        f->first_key = f->end_key < UINT64_MAX ? f->end_key : 0;
        y += f->first_key ? 0 : rows;
    }
}
