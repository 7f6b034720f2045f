/* This file sorts and blends the fragments of each pixel of a tile. It finds the fragments of a
 * sprite by drawing the sprite alone into an empty tile, so that the code that draws sprites needs
 * no lists. A row with too many fragments is drawn again for the nearer ones, so that no fragment
 * is left out. */
#include "draw/sprites/fragments.h"

#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "draw/sprites/packets.h"

enum {
    ROWS_AT_A_TIME = 16, /* this many fit into the first-level cache beside packets */
    PIXELS_AT_A_TIME = KILN_TILE_WIDTH * ROWS_AT_A_TIME,
    LEAST_LANES = 4
};

struct kiln_fragments {
    const struct kiln_packet_code *code;
    struct kiln_tile *scratch; /* some rows of the tile, with one sprite at a time */
    struct kiln_packets packets;
    size_t room; /* greatest number of packets: all, and in the tile that is being drawn */
    size_t tile_room;
    /* numbers of packets, list by list, and the end of the list of each vector of pixels */
    uint32_t *lists, list_ends[PIXELS_AT_A_TIME / LEAST_LANES];
};

struct kiln_fragments *kiln_fragments_create(enum kiln_simd simd)
{
    struct kiln_fragments *f = calloc(1, sizeof *f);
    if (!f)
        return NULL;
    f->code = KILN_SIMD_PICK(kiln_packet_code, simd);
    const size_t lanes = (size_t)f->code->lanes;
    f->room = KILN_PACKET_PIXELS / lanes;
    f->scratch = aligned_alloc(64, sizeof *f->scratch);
    f->packets.packets = kiln_alloc_pages(f->room * f->code->size);
    f->packets.places = malloc(f->room * sizeof *f->packets.places);
    f->packets.keys =
        kiln_alloc_pages((2 * f->room + KILN_PACKET_SORT_BLOCK) * lanes * sizeof *f->packets.keys);
    f->lists = malloc(f->room * sizeof *f->lists);
    if (!f->scratch || !f->packets.packets || !f->packets.places || !f->packets.keys || !f->lists)
        kiln_fragments_destroy(&f);
    return f;
}

uint64_t kiln_fragments_bytes(enum kiln_simd simd)
{
    const struct kiln_fragments *f = NULL;
    const struct kiln_packet_code *code = KILN_SIMD_PICK(kiln_packet_code, simd);
    const uint64_t lanes = (uint64_t)code->lanes, room = KILN_PACKET_PIXELS / lanes;
    return sizeof *f->scratch + room * (code->size + sizeof *f->packets.places + sizeof *f->lists) +
           (2 * room + KILN_PACKET_SORT_BLOCK) * lanes * sizeof *f->packets.keys;
}

void kiln_fragments_destroy(struct kiln_fragments **fragments)
{
    struct kiln_fragments *f = *fragments;
    if (!f)
        return;
    free(f->scratch);
    free(f->packets.packets);
    free(f->packets.places);
    free(f->packets.keys);
    free(f->lists);
    free(f);
    *fragments = NULL;
}

/* ---- gathering ------------------------------------------------------------------------------- */

/* Returns the pixels of a tile that a sprite may touch. */
static struct kiln_packet_box find_box(const struct kiln_tile *tile, const struct kiln_sprite *s)
{
    return (struct kiln_packet_box){
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
    memcpy((char *)scratch + offsetof(struct kiln_tile, x),
           (const char *)tile + offsetof(struct kiln_tile, x),
           sizeof *tile - offsetof(struct kiln_tile, x));
    scratch->y = tile->y + y;
    scratch->height = rows;
    scratch->glow = f->packets.glow ? KILN_TILE_GLOW_WEIGHED : KILN_TILE_GLOW_NONE;
    for (int row = 0; row < rows; row++) {
        memset(scratch->pixels[row], 0, KILN_TILE_DEPTH * sizeof *scratch->pixels[row]);
        memcpy(scratch->pixels[row][KILN_TILE_DEPTH], tile->pixels[y + row][KILN_TILE_DEPTH],
               sizeof scratch->pixels[row][KILN_TILE_DEPTH]);
    }
    f->packets.count = 1;
}

/* Returns the greatest number of packets that a sprite may have in a box. */
static size_t most_packets(const struct kiln_fragments *f, const struct kiln_packet_box *box)
{
    const int lanes = f->code->lanes;
    if (box->x_from >= box->x_to)
        return 0;
    return (size_t)((box->x_to - 1) / lanes - box->x_from / lanes + 1) *
           (size_t)(box->y_to - box->y_from);
}

static size_t count_before(const uint64_t *keys, size_t count, uint64_t key)
{
    size_t before = 0;
    for (size_t i = 1; i < count; i++)
        before += keys[i] < key;
    return before;
}

/* Drops about the nearer half of the packets, and gathers only farther fragments from now on. A key
 * occurs in a row at most once a packet, so there is a key that divides the packets. */
static void drop_nearer(struct kiln_fragments *f)
{
    struct kiln_packets *p = &f->packets;
    const size_t count = p->count;
    uint64_t *keys = (uint64_t *)(void *)p->keys;
    for (size_t i = 1; i < count; i++)
        keys[i] = f->code->least_key(p, i);
    uint64_t low = p->first_key, high = p->end_key;
    size_t kept_count;
    do {
        p->end_key = low + (high - low) / 2;
        kept_count = count_before(keys, count, p->end_key);
        if (kept_count < count / 4)
            low = p->end_key;
        else
            high = p->end_key;
    } while (kept_count < count / 4 || kept_count > count * 3 / 4);
    p->count = 1;
    for (size_t i = 1; i < count; i++) {
        if (keys[i] >= p->end_key)
            continue;
        memcpy((char *)p->packets + p->count * p->stride, (const char *)p->packets + i * p->stride,
               p->stride);
        p->places[p->count++] = p->places[i];
    }
}

/* Gathers the fragments of some rows of a tile. In a single row it gathers as many as there is room
 * for: the farthest of those that have not been blended yet. Returns false if several rows together
 * have too many fragments. */
static bool gather(struct kiln_fragments *f, kiln_tile_draw *draw, const struct kiln_tile *tile,
                   int y, int rows, struct kiln_sprites sprites, const struct kiln_cells *cells,
                   const uint32_t *list, size_t count)
{
    begin_rows(f, tile, y, rows);
    for (size_t i = 0; i < count; i++) {
        const struct kiln_sprite *s = &sprites.sprites[list[i]];
        const struct kiln_packet_box box = find_box(f->scratch, s);
        if (box.y_from >= box.y_to)
            continue;
        const size_t most = f->packets.count + most_packets(f, &box);
        if (most > f->tile_room && rows > 1)
            return false;
        if (most > f->tile_room)
            drop_nearer(f);
        draw(f->scratch, sprites, cells, &list[i], 1);
        f->code->add(&f->packets, f->scratch, &box, s, &sprites.extras[list[i]], (uint32_t)i);
    }
    return true;
}

/* ---- blending -------------------------------------------------------------------------------- */

/* Lists the packets of each vector of pixels: it counts them, turns counts into places by a prefix
 * sum, and writes the lists. */
static void make_lists(struct kiln_fragments *f)
{
    const struct kiln_packets *p = &f->packets;
    memset(f->list_ends, 0, sizeof f->list_ends);
    for (size_t i = 1; i < p->count; i++)
        f->list_ends[p->places[i]]++;
    uint32_t begin = 0;
    for (size_t place = 0; place < sizeof f->list_ends / sizeof *f->list_ends; place++) {
        const uint32_t length = f->list_ends[place];
        f->list_ends[place] = begin;
        begin += length;
    }
    for (size_t i = 1; i < p->count; i++)
        f->lists[f->list_ends[p->places[i]]++] = (uint32_t)i;
}

static void blend_rows(struct kiln_fragments *f, struct kiln_tile *tile, int y, int rows)
{
    make_lists(f);
    const int lanes = f->code->lanes;
    uint32_t first = 0;
    for (int pixel = 0; pixel < rows * KILN_TILE_WIDTH; pixel += lanes) {
        const uint32_t end = f->list_ends[pixel / lanes];
        if (end > first)
            f->code->blend(&f->packets, f->lists + first, end - first,
                           tile->pixels[y + pixel / KILN_TILE_WIDTH], pixel % KILN_TILE_WIDTH);
        first = end;
    }
}

void kiln_fragments_draw(struct kiln_fragments *fragments, kiln_tile_draw *draw,
                         struct kiln_tile *tile, struct kiln_sprites sprites,
                         const struct kiln_cells *cells, const uint32_t *list, size_t count)
{
    struct kiln_fragments *f = fragments;
    struct kiln_packets *p = &f->packets;
    int rows = ROWS_AT_A_TIME;
    p->first_key = 0;
    p->glow = tile->gas && tile->glow == KILN_TILE_GLOW_WEIGHED;
    p->stride = p->glow ? f->code->glow_size : f->code->size;
    memset(p->packets, 0, p->stride); /* number 0, where the tile before may have had number 1 */
    f->tile_room = f->room * f->code->size / p->stride;
    for (int y = 0; y < tile->height;) {
        rows = rows < tile->height - y ? rows : tile->height - y;
        p->end_key = KILN_PACKET_KEYS_END;
        if (!gather(f, draw, tile, y, rows, sprites, cells, list, count)) {
            rows = (rows + 1) / 2;
            continue;
        }
        blend_rows(f, tile, y, rows);
        p->first_key = p->end_key < KILN_PACKET_KEYS_END ? p->end_key : 0;
        y += p->first_key ? 0 : rows;
    }
}
