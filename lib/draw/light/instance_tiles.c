/* This file draws the silhouettes of particles that are meshes, as the sun sees them, into tiles of
 * an atlas. It rasterises triangles into a bit mask of 4 x 4 bits a texel, in rows of words. A bit
 * is set if its centre lies in a triangle, whichever way the triangle faces. A texel is the part of
 * its bits that are set; texels of coarser levels are means. */
#include "draw/light/instance_tiles.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "shared/exact.h"

enum {
    SUB = 4, /* bits of a texel, across and down */
    BITS = KILN_INSTANCE_LARGEST_TILE * SUB,
    WORDS = BITS / 64,
    AT_A_TIME = 16,
};

struct kiln_instance_tiles {
    const struct kiln_instances *meshes;
    uint32_t edge;
    float *texels;
    struct kiln_silhouette *places; /* of the current run */
};

/* Returns where a level starts, in texels. */
static size_t level_at(uint32_t level)
{
    size_t at = 0;
    for (uint32_t i = 0; i < level; i++)
        at += (size_t)(KILN_INSTANCE_ATLAS >> i) * (KILN_INSTANCE_ATLAS >> i);
    return at;
}

struct kiln_instance_tiles *kiln_instance_tiles_create(const struct kiln_scene *scene,
                                                       const struct kiln_instances *meshes,
                                                       struct kiln_error *error)
{
    struct kiln_instance_tiles *tiles = calloc(1, sizeof *tiles);
    if (!tiles) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "shadows of meshes: out of memory");
        return NULL;
    }
    tiles->edge = kiln_instance_tile_edge(scene);
    tiles->meshes = meshes;
    tiles->texels = calloc(level_at(KILN_INSTANCE_LEVELS), sizeof *tiles->texels);
    if (!tiles->texels) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "shadows of meshes: out of memory");
        kiln_instance_tiles_destroy(&tiles);
    }
    return tiles;
}

void kiln_instance_tiles_destroy(struct kiln_instance_tiles **tiles)
{
    if (!*tiles)
        return;
    free((*tiles)->texels);
    free(*tiles);
    *tiles = NULL;
}

const struct kiln_instance_mesh *kiln_instance_tiles_mesh(const struct kiln_instance_tiles *tiles,
                                                          uint32_t system)
{
    return &tiles->meshes->meshes[system];
}

struct kiln_instance_tile kiln_instance_tile_at(const struct kiln_instance_tiles *tiles,
                                                uint32_t number)
{
    const uint32_t columns = KILN_INSTANCE_ATLAS / tiles->edge;
    return (struct kiln_instance_tile){number % columns * tiles->edge,
                                       number / columns * tiles->edge};
}

const float *kiln_instance_tiles_texels(const struct kiln_instance_tiles *tiles)
{
    return tiles->texels;
}

/* ---- bits ------------------------------------------------------------------------------------ */

/* Returns the first bit whose centre is at or after x. */
static int32_t bit_from(float x, int32_t bits)
{
    const float at = x - 0.5f;
    if (!(at > 0.0f))
        return 0;
    const int32_t whole = at < (float)bits ? (int32_t)at : bits;
    return whole + ((float)whole < at && whole < bits ? 1 : 0);
}

static void set_bits(uint64_t *row, int32_t from, int32_t to)
{
    for (int32_t word = from / 64; from < to; word++) {
        const int32_t end = (word + 1) * 64 < to ? (word + 1) * 64 : to;
        const int32_t count = end - from;
        row[word] |= (count == 64 ? ~UINT64_C(0) : ((UINT64_C(1) << count) - 1)) << from % 64;
        from = end;
    }
}

static void set_triangle(uint64_t (*rows)[WORDS], int32_t bits, const float p[3][2])
{
    const float low = exact_min(p[0][1], exact_min(p[1][1], p[2][1]));
    const float high = exact_max(p[0][1], exact_max(p[1][1], p[2][1]));
    float slopes[3];
    for (int k = 0; k < 3; k++) {
        const float *a = p[k], *b = p[(k + 1) % 3];
        slopes[k] = b[1] != a[1] ? (b[0] - a[0]) / (b[1] - a[1]) : 0.0f;
    }
    for (int32_t y = bit_from(low, bits), end = bit_from(high, bits); y < end; y++) {
        const float middle = (float)y + 0.5f;
        float from = (float)bits, to = 0.0f;
        for (int k = 0; k < 3; k++) {
            const float *a = p[k], *b = p[(k + 1) % 3];
            if ((a[1] <= middle) == (b[1] <= middle))
                continue;
            const float x = a[0] + (middle - a[1]) * slopes[k];
            from = exact_min(from, x);
            to = exact_max(to, x);
        }
        set_bits(rows[y], bit_from(from, bits), bit_from(to, bits));
    }
}

static void set_mesh(const struct kiln_instance_tiles *tiles, struct kiln_silhouette *place,
                     uint64_t (*rows)[WORDS])
{
    const struct kiln_instance_mesh *mesh = &tiles->meshes->meshes[place->system];
    const float4(*corners)[2] = (const float4(*)[2])tiles->meshes->corners + mesh->first;
    const int32_t bits = (int32_t)tiles->edge * SUB;
    const float half = 0.5f * (float)bits;
    for (int c = 0; c < 2; c++) {
        place->low[c] = 1.0f;
        place->high[c] = -1.0f;
    }
    for (uint32_t i = 0; i < mesh->triangles; i++) {
        float p[3][2];
        for (size_t k = 0; k < 3; k++) {
            const float4 at = corners[(size_t)3 * i + k][0];
            for (int c = 0; c < 2; c++) {
                const float *row = place->across[c];
                const float part = row[0] * at.x + row[1] * at.y + row[2] * at.z;
                place->low[c] = exact_min(place->low[c], part);
                place->high[c] = exact_max(place->high[c], part);
                p[k][c] = half + half * part;
            }
        }
        set_triangle(rows, bits, (const float(*)[2])p);
    }
}

/* ---- texels ---------------------------------------------------------------------------------- */

static float texel_of(uint64_t (*rows)[WORDS], uint32_t x, uint32_t y)
{
    int count = 0;
    for (uint32_t i = 0; i < SUB; i++) {
        const uint64_t word = rows[y * SUB + i][x * SUB / 64];
        count += __builtin_popcountll(word >> x * SUB % 64 & ((1 << SUB) - 1));
    }
    return (float)count / (SUB * SUB);
}

static float mean_of(const float *texels, size_t pitch)
{
    return 0.25f * (texels[0] + texels[1] + texels[pitch] + texels[pitch + 1]);
}

/* Writes a tile's texels at all levels. Returns the part of the tile that is covered. */
static float write_tile(struct kiln_instance_tiles *tiles, uint32_t number, uint64_t (*rows)[WORDS])
{
    const struct kiln_instance_tile tile = kiln_instance_tile_at(tiles, number);
    const float *finer = NULL;
    float last = 0.0f;
    for (uint32_t level = 0; tiles->edge >> level > 0; level++) {
        const uint32_t pitch = KILN_INSTANCE_ATLAS >> level, edge = tiles->edge >> level;
        float *texels =
            tiles->texels + level_at(level) + (size_t)(tile.y >> level) * pitch + (tile.x >> level);
        for (uint32_t y = 0; y < edge; y++) {
            for (uint32_t x = 0; x < edge; x++) {
                const float *of = finer ? finer + (size_t)4 * pitch * y + (size_t)2 * x : NULL;
                last = of ? mean_of(of, (size_t)2 * pitch) : texel_of(rows, x, y);
                texels[(size_t)y * pitch + x] = last;
            }
        }
        finer = texels;
    }
    return last;
}

static void draw_tiles(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_instance_tiles *tiles = context;
    uint64_t rows[BITS][WORDS];
    for (size_t i = begin; i < end; i++) {
        memset(rows, 0, (size_t)tiles->edge * SUB * sizeof *rows);
        set_mesh(tiles, &tiles->places[i], rows);
        tiles->places[i].covered = write_tile(tiles, (uint32_t)i, rows);
    }
}

void kiln_instance_tiles_run(struct kiln_instance_tiles *tiles, struct kiln_silhouette *places,
                             uint32_t count, struct kiln_threads *threads)
{
    tiles->places = places;
    kiln_threads_for(threads, count, AT_A_TIME, draw_tiles, tiles);
}
