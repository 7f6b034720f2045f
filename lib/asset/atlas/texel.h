/* What the procedural flipbooks are made of: each is a gas that flows (or none), and a function
 * from places at a time to texels. Private to builtin.c and the files with the functions. */
#ifndef KILN_ASSET_ATLAS_TEXEL_H
#define KILN_ASSET_ATLAS_TEXEL_H

#include "asset/atlas/film.h"

enum {
    TEXEL_LOBES = 22,
    TEXEL_ROW = KILN_FLUID_FINEST, /* texels of a row at most */
    TEXEL_BLOCK = 16,              /* rows are filled up to a multiple: whole vectors */
};

/* A sphere of the heap that smoke is. */
struct texel_lobe {
    float x, y, size;
};

/* Where the texels of a row are that may show something: on [-1, 1]^2, y up. */
struct texel_sites {
    float time;                                   /* 0 at birth, 1 at death */
    float v;                                      /* their height */
    float u[TEXEL_ROW];                           /* their places in the row */
    float place_x[TEXEL_ROW], place_y[TEXEL_ROW]; /* where their gas was at its start */
    float heat[TEXEL_ROW];                        /* of their gas */
    const struct texel_lobe *lobes;               /* TEXEL_LOBES of them */
    uint32_t count;                               /* a multiple of TEXEL_BLOCK */
};

struct texels {
    float height[TEXEL_ROW]; /* of the lit surface, in half edges of the cell: its slope becomes */
                             /* the normal */
    float heat[TEXEL_ROW], density[TEXEL_ROW];
};

struct builtin {
    const char *name;
    const struct kiln_film_gas *gas; /* NULL: nothing flows */
    void (*texels)(const struct texel_sites *sites, struct texels *texels);
    float relief;     /* how much the height tilts the normal */
    float least_heat; /* where its gas has less, nothing shows; */
    float reach2;     /* nor where it began farther away than the root of this, unless it is 0 */
};

/* Of texel_gas_simd.c, which begins with what burns, and texel_solid_simd.c. A NULL name ends them.
 */
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
    float positive = x < 0.0f ? 0.0f : x; /* a step at a time becomes vectors */
    return positive > 1.0f ? 1.0f : positive;
}

/* 0 at `from`, 1 at `to`, in either order. */
static inline float texel_smooth(float from, float to, float x)
{
    float t = texel_saturate((x - from) / (to - from));
    return t * t * (3.0f - 2.0f * t);
}

#endif
