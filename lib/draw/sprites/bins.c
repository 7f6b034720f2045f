/* This file lists for each tile of the picture the sprites that touch it, by counting, a prefix sum
 * and scattering. Threads count and write pieces of the sprites independently. Each piece has its
 * own places in the lists, which the prefix sum gives, so a list has the order of the sprites for
 * any number of threads. */
#include "draw/sprites/bins.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"

enum {
    PIECE = 4096,          /* sprites of a piece */
    MOST_LISTED = 1 << 23, /* sprites of all lists of kiln_bins_fill_some, where it lists more than
                              LEAST_FILLED */
    LEAST_FILLED = 512     /* sprites, which it lists together whatever the lists need */
};

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "the bins");
}

bool kiln_bins_init(struct kiln_bins *bins, uint32_t width, uint32_t height,
                    struct kiln_error *error)
{
    *bins = (struct kiln_bins){
        .columns = (width + KILN_TILE_WIDTH - 1) / KILN_TILE_WIDTH,
        .rows = (height + KILN_TILE_HEIGHT - 1) / KILN_TILE_HEIGHT,
    };
    size_t tiles = (size_t)bins->columns * bins->rows;
    bins->depth = calloc(tiles, sizeof *bins->depth);
    bins->first = calloc(tiles + 1, sizeof *bins->first);
    return (bins->depth && bins->first) || out_of_memory(error);
}

void kiln_bins_finish(struct kiln_bins *bins)
{
    free(bins->depth);
    free(bins->counts);
    free(bins->first);
    free(bins->list);
    free(bins->boxes);
    *bins = (struct kiln_bins){0};
}

struct measure {
    struct kiln_bins *bins;
    const float *depth;
    uint32_t width, height;
};

static struct kiln_tile_depth measure_tile(const struct measure *m, uint32_t x, uint32_t y)
{
    uint32_t x_to = x + KILN_TILE_WIDTH < m->width ? x + KILN_TILE_WIDTH : m->width;
    uint32_t y_to = y + KILN_TILE_HEIGHT < m->height ? y + KILN_TILE_HEIGHT : m->height;
    float nearest = m->depth[(size_t)y * m->width + x], farthest = nearest;
    for (; y < y_to; y++) {
        const float *row = m->depth + (size_t)y * m->width;
        for (uint32_t i = x; i < x_to; i++) {
            nearest = row[i] < nearest ? row[i] : nearest;
            farthest = row[i] > farthest ? row[i] : farthest;
        }
    }
    return (struct kiln_tile_depth){nearest, farthest};
}

static void measure_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct measure *m = context;
    for (size_t row = begin; row < end; row++) {
        for (uint32_t column = 0; column < m->bins->columns; column++)
            m->bins->depth[row * m->bins->columns + column] =
                measure_tile(m, column * KILN_TILE_WIDTH, (uint32_t)row * KILN_TILE_HEIGHT);
    }
}

void kiln_bins_measure(struct kiln_bins *bins, const float *depth, uint32_t width, uint32_t height,
                       struct kiln_threads *threads)
{
    bins->columns = (width + KILN_TILE_WIDTH - 1) / KILN_TILE_WIDTH;
    bins->rows = (height + KILN_TILE_HEIGHT - 1) / KILN_TILE_HEIGHT;
    struct measure measure = {bins, depth, width, height};
    kiln_threads_for(threads, bins->rows, 1, measure_rows, &measure);
}

struct filling {
    struct kiln_bins *bins;
    uint32_t begin, end;           /* sprites */
    size_t first_tile, tile_count; /* the tiles that get lists */
    uint64_t total;                /* of all counts */
};

bool kiln_bins_begin(struct kiln_bins *bins, uint32_t count, struct kiln_error *error)
{
    if (count <= bins->box_room)
        return true;
    free(bins->boxes);
    bins->boxes = kiln_alloc_pages(count * sizeof *bins->boxes);
    bins->box_room = bins->boxes ? count : 0;
    return bins->boxes || out_of_memory(error);
}

void kiln_bins_note(const struct kiln_bins *bins, const struct kiln_sprite *sprites, size_t begin,
                    size_t end)
{
    for (size_t i = begin; i < end; i++) {
        const struct kiln_sprite *s = &sprites[i];
        const float depth = s->flags & KILN_SPRITE_DEEP ? 0.0f : s->depth;
        bins->boxes[i] = (struct kiln_bin_box){s->x_from, s->y_from, s->x_to, s->y_to, depth};
    }
}

/* Returns whether a sprite lies behind the scene everywhere in a tile. */
static bool is_hidden(const struct kiln_bin_box *s, struct kiln_tile_depth depth)
{
    return s->depth > depth.farthest;
}

/* Visits each tile of each sprite of a piece. Without a list it counts the sprites of each tile;
 * with a list it writes each sprite to the place that `counts` has for the tile, and advances the
 * place. */
static void visit_piece(const struct filling *f, size_t piece, uint32_t *list)
{
    const struct kiln_bins *bins = f->bins;
    size_t tiles = (size_t)bins->columns * bins->rows;
    uint32_t *counts = bins->counts + piece * tiles;
    uint32_t begin = f->begin + (uint32_t)piece * PIECE;
    uint32_t end = f->end - begin < PIECE ? f->end : begin + PIECE;
    for (uint32_t i = begin; i < end; i++) {
        const struct kiln_bin_box *s = &bins->boxes[i];
        if (s->x_from >= s->x_to)
            continue;
        uint32_t left = (uint32_t)s->x_from / KILN_TILE_WIDTH;
        uint32_t right = (uint32_t)(s->x_to - 1) / KILN_TILE_WIDTH;
        uint32_t bottom = (uint32_t)(s->y_to - 1) / KILN_TILE_HEIGHT;
        for (uint32_t y = (uint32_t)s->y_from / KILN_TILE_HEIGHT; y <= bottom; y++) {
            for (uint32_t x = left; x <= right; x++) {
                size_t tile = (size_t)y * bins->columns + x;
                if (tile - f->first_tile >= f->tile_count || is_hidden(s, bins->depth[tile]))
                    continue;
                if (list)
                    list[counts[tile]] = i;
                counts[tile]++;
            }
        }
    }
}

static void count_pieces(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct filling *f = context;
    size_t tiles = (size_t)f->bins->columns * f->bins->rows;
    memset(f->bins->counts + begin * tiles, 0, (end - begin) * tiles * sizeof *f->bins->counts);
    for (size_t piece = begin; piece < end; piece++)
        visit_piece(f, piece, NULL);
}

static void write_pieces(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct filling *f = context;
    for (size_t piece = begin; piece < end; piece++)
        visit_piece(f, piece, f->bins->list);
}

/* Turns counts into places by a prefix sum, tile by tile. */
static void scan(struct kiln_bins *bins, size_t pieces)
{
    size_t tiles = (size_t)bins->columns * bins->rows, place = 0;
    for (size_t tile = 0; tile < tiles; tile++) {
        bins->first[tile] = (uint32_t)place;
        for (size_t piece = 0; piece < pieces; piece++) {
            uint32_t *count = &bins->counts[piece * tiles + tile], was = *count;
            *count = (uint32_t)place;
            place += was;
        }
    }
    bins->first[tiles] = (uint32_t)place;
}

/* Makes room for `count` elements; earlier contents are lost. Returns false when memory is short.
 */
static bool make_room(uint32_t **array, size_t *room, size_t count)
{
    if (count <= *room)
        return true;
    free(*array);
    *room = count + count / 4;
    *array = malloc(*room * sizeof **array);
    if (!*array)
        *room = 0;
    return *array != NULL;
}

static size_t count_of_pieces(const struct filling *f)
{
    return (f->end - f->begin + PIECE - 1) / PIECE;
}

/* Counts the sprites of each tile, piece by piece, and those of all tiles. */
static bool count(struct filling *f, struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_bins *bins = f->bins;
    const size_t pieces = count_of_pieces(f), counts = pieces * bins->columns * bins->rows;
    if (!make_room(&bins->counts, &bins->count_room, counts))
        return out_of_memory(error);
    kiln_threads_for(threads, pieces, 1, count_pieces, f);
    f->total = 0;
    for (size_t i = 0; i < counts; i++)
        f->total += bins->counts[i];
    return true;
}

/* Writes the lists of the counted sprites. */
static bool write_lists(struct filling *f, struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_bins *bins = f->bins;
    if (f->total > UINT32_MAX || !make_room(&bins->list, &bins->list_room, f->total))
        return out_of_memory(error);
    scan(bins, count_of_pieces(f));
    kiln_threads_for(threads, count_of_pieces(f), 1, write_pieces, f);
    return true;
}

bool kiln_bins_fill_tiles(struct kiln_bins *bins, uint32_t sprites, size_t begin, size_t end,
                          struct kiln_threads *threads, struct kiln_error *error)
{
    struct filling filling = {
        .bins = bins, .end = sprites, .first_tile = begin, .tile_count = end - begin};
    return count(&filling, threads, error) && write_lists(&filling, threads, error);
}

bool kiln_bins_fill_some(struct kiln_bins *bins, uint32_t begin, uint32_t *end,
                         struct kiln_threads *threads, struct kiln_error *error)
{
    struct filling filling = {.bins = bins,
                              .begin = begin,
                              .end = *end,
                              .tile_count = (size_t)bins->columns * bins->rows};
    if (!count(&filling, threads, error))
        return false;
    while (filling.total > MOST_LISTED && filling.end - begin > LEAST_FILLED) {
        filling.end = begin + (filling.end - begin) / 2;
        if (!count(&filling, threads, error))
            return false;
    }
    *end = filling.end;
    return write_lists(&filling, threads, error);
}

void kiln_bins_footprint(uint32_t width, uint32_t height, uint64_t sprites,
                         struct kiln_footprint *footprint)
{
    const struct kiln_bins *b = NULL;
    const uint64_t columns = (width + KILN_TILE_WIDTH - 1) / KILN_TILE_WIDTH;
    const uint64_t tiles = columns * ((height + KILN_TILE_HEIGHT - 1) / KILN_TILE_HEIGHT);
    const uint64_t pieces = (sprites + PIECE - 1) / PIECE;
    const uint64_t listed = sprites < MOST_LISTED / tiles ? sprites * tiles : MOST_LISTED;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, tiles,
                       sizeof *b->depth + sizeof *b->first);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, sprites, sizeof *b->boxes);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, pieces * tiles, sizeof *b->counts);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, listed, sizeof *b->list);
}
