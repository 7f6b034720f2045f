/* This file draws the silhouettes of particles that are meshes, as the sun sees them, into tiles of
 * an atlas. It rasterises triangles into a bit mask. A texel is the part of its bits that are set;
 * texels of coarser levels are means. */
#include "draw/light/instance_tiles.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/bit_mask.h"
#include "shared/exact.h"

enum {
    BITS = KILN_INSTANCE_LARGEST_TILE * KILN_BIT_CELL,
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
        kiln_error_no_memory(error, "the shadows of meshes");
        return NULL;
    }
    tiles->edge = kiln_instance_tile_edge(scene);
    tiles->meshes = meshes;
    tiles->texels = calloc(level_at(KILN_INSTANCE_LEVELS), sizeof *tiles->texels);
    if (!tiles->texels) {
        kiln_error_no_memory(error, "the shadows of meshes");
        kiln_instance_tiles_destroy(&tiles);
    }
    return tiles;
}

uint64_t kiln_instance_tiles_bytes(void)
{
    const struct kiln_instance_tiles *t = NULL;
    return level_at(KILN_INSTANCE_LEVELS) * sizeof *t->texels;
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

/* ---- silhouettes ----------------------------------------------------------------------------- */

static void set_mesh(const struct kiln_instance_tiles *tiles, struct kiln_silhouette *place,
                     const struct kiln_bit_mask *mask)
{
    const struct kiln_instance_mesh *mesh = &tiles->meshes->meshes[place->system];
    const float4(*corners)[2] = (const float4(*)[2])tiles->meshes->corners + mesh->first;
    const float half = 0.5f * (float)mask->edge;
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
        kiln_bit_mask_add(mask, (const float(*)[2])p);
    }
}

/* ---- texels ---------------------------------------------------------------------------------- */

static float mean_of(const float *texels, size_t pitch)
{
    return 0.25f * (texels[0] + texels[1] + texels[pitch] + texels[pitch + 1]);
}

/* Writes a tile's texels at all levels. Returns the part of the tile that is covered. */
static float write_tile(struct kiln_instance_tiles *tiles, uint32_t number,
                        const struct kiln_bit_mask *mask)
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
                last = of ? mean_of(of, (size_t)2 * pitch) : kiln_bit_mask_part(mask, x, y);
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
    const struct kiln_bit_mask mask = {rows[0], WORDS, (int32_t)tiles->edge * KILN_BIT_CELL};
    for (size_t i = begin; i < end; i++) {
        memset(rows, 0, (size_t)mask.edge * sizeof *rows);
        set_mesh(tiles, &tiles->places[i], &mask);
        tiles->places[i].covered = write_tile(tiles, (uint32_t)i, &mask);
    }
}

void kiln_instance_tiles_run(struct kiln_instance_tiles *tiles, struct kiln_silhouette *places,
                             uint32_t count, struct kiln_threads *threads)
{
    tiles->places = places;
    kiln_threads_for(threads, count, AT_A_TIME, draw_tiles, tiles);
}
