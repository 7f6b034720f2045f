/* Declares the lists of procedural flipbooks. Each flipbook has a function that computes texels
 * from their positions and the time. It may also have a gas, which flows and carries start places
 * along. builtin.c finds a flipbook in the lists by its name, and texel_cell_simd.c calls its
 * function for each row of a cell. Only these two and the files of the lists (texel_gas_simd.c,
 * texel_solid_simd.c) include this header. */
#ifndef KILN_ASSET_ATLAS_TEXEL_H
#define KILN_ASSET_ATLAS_TEXEL_H

#include "asset/atlas/film.h"

enum {
    TEXEL_LOBES = 22,
    TEXEL_ROW = KILN_FLUID_FINEST, /* the most texels of a row of pixels */
    /* rows are filled up to a multiple of this, so that loops have whole vectors */
    TEXEL_BLOCK = 16,
};

/* A sphere of the heap of spheres that the flipbook `smoke` shows from the front. */
struct texel_lobe {
    float x, y, size; /* place of the centre on [-1, 1]^2, and radius */
};

/* The texels of one row, without those that are surely empty. Coordinates are on [-1, 1]^2, y up.
 * Without a gas, place_x, place_y and heat are 0. */
struct texel_sites {
    float time;         /* 0 at birth, 1 at death */
    float v;            /* height of the row */
    float u[TEXEL_ROW]; /* places of the texels in the row */
    /* where the gas that is now at each texel was when it started to flow */
    float place_x[TEXEL_ROW], place_y[TEXEL_ROW];
    float heat[TEXEL_ROW];          /* heat of the gas */
    const struct texel_lobe *lobes; /* TEXEL_LOBES spheres; only `smoke` uses them */
    uint32_t count;                 /* number of texels, a multiple of TEXEL_BLOCK */
};

/* Holds what a flipbook's function computes for a texel. */
struct texels {
    /* height of the lit surface, in half edges of the cell; its slopes give the normal */
    float height[TEXEL_ROW];
    float heat[TEXEL_ROW];    /* how hot the texel glows, 0 to 1 */
    float density[TEXEL_ROW]; /* how much the texel covers, 0 to 1 */
};

struct builtin {
    const char *name;
    const struct kiln_film_gas *gas; /* NULL: there is no gas */
    void (*texels)(const struct texel_sites *sites, struct texels *texels);
    float relief;     /* factor on the slopes of the height that give the normal */
    float least_heat; /* texels whose gas has less heat than this are empty */
    /* Texels whose gas started farther than this from (0, 0) are empty. The value is squared; 0
     * sets no limit. */
    float reach_squared;
};

/* Holds the flipbooks of texel_gas_simd.c (gas) or texel_solid_simd.c (things of a fixed shape). A
 * NULL name ends the list. Messages and pages list the flipbooks in this order: those that burn
 * come first. */
struct builtin_list {
    struct builtin builtins[8];
};
KILN_SIMD_DECLARE(const struct builtin_list, kiln_builtin_gases);
KILN_SIMD_DECLARE(const struct builtin_list, kiln_builtin_solids);

static inline float texel_mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float texel_saturate(float x)
{
    /* single comparisons, which compilers turn into vector instructions */
    float positive = x < 0.0f ? 0.0f : x;
    return positive > 1.0f ? 1.0f : positive;
}

/* Returns a smooth step from 0 at `from` to 1 at `to`, which may be in either order. */
static inline float texel_smooth(float from, float to, float x)
{
    float t = texel_saturate((x - from) / (to - from));
    return t * t * (3.0f - 2.0f * t);
}

#endif
