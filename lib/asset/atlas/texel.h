/* Declares the rows of the table of procedural flipbooks. Each flipbook is a gas that flows, or
 * none, and a function from places at a time to texels. Only builtin.c and the files with these
 * functions include this header. */
#ifndef KILN_ASSET_ATLAS_TEXEL_H
#define KILN_ASSET_ATLAS_TEXEL_H

#include "asset/atlas/film.h"

enum {
    TEXEL_LOBES = 22,
    TEXEL_ROW = KILN_FLUID_FINEST, /* the most texels of a row */
    /* rows are filled up to a multiple of this, so that loops have whole vectors */
    TEXEL_BLOCK = 16,
};

/* A sphere in the heap of spheres that smoke consists of. */
struct texel_lobe {
    float x, y, size;
};

/* The texels of a row that may be visible. Coordinates are on [-1, 1]^2, y up. */
struct texel_sites {
    float time;                                   /* 0 at birth, 1 at death */
    float v;                                      /* height of the row */
    float u[TEXEL_ROW];                           /* places of the texels in the row */
    float place_x[TEXEL_ROW], place_y[TEXEL_ROW]; /* where the gas of each texel was at its start */
    float heat[TEXEL_ROW];                        /* heat of the gas */
    const struct texel_lobe *lobes;               /* TEXEL_LOBES spheres */
    uint32_t count;                               /* number of texels, a multiple of TEXEL_BLOCK */
};

struct texels {
    /* height of the lit surface, in half edges of the cell; its slope gives */
    float height[TEXEL_ROW];
    /* the normal */
    float heat[TEXEL_ROW], density[TEXEL_ROW];
};

struct builtin {
    const char *name;
    const struct kiln_film_gas *gas; /* NULL: there is no gas */
    void (*texels)(const struct texel_sites *sites, struct texels *texels);
    float relief;     /* factor on the slopes of the height that give the normal */
    float least_heat; /* texels with less heat than this are empty; */
    /* also texels whose gas began farther from 0 than the root of this, unless it is 0 */
    float reach2;
};

/* Holds the flipbooks of texel_gas_simd.c or texel_solid_simd.c, a NULL name behind the last. The
 * list of gas begins with those that burn. */
struct builtin_list {
    struct builtin builtins[6];
};
KILN_SIMD_DECLARE(const struct builtin_list, kiln_builtin_gases);
KILN_SIMD_DECLARE(const struct builtin_list, kiln_builtin_solids);

static inline float texel_mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float texel_saturate(float x)
{
    /* single comparisons, which compilers turn into vectors */
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
