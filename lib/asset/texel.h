/* What the procedural flipbooks are made of: each is a gas that flows (or none), and a function
 * from a place and a time to a texel. Private to builtin.c and the files with the functions. */
#ifndef KILN_ASSET_TEXEL_H
#define KILN_ASSET_TEXEL_H

#include "asset/film.h"

struct texel {
    float height; /* of the lit surface, in half edges of the cell: its slope becomes the normal */
    float heat, density;
};

enum { TEXEL_LOBES = 22 };

/* A sphere of the heap that smoke is. */
struct texel_lobe {
    float x, y, size;
};

/* Where a texel is: on [-1, 1]^2, y up. */
struct texel_site {
    float u, v;
    float time;                     /* 0 at birth, 1 at death */
    float place_x, place_y;         /* where its gas was at its start */
    float heat;                     /* of its gas */
    const struct texel_lobe *lobes; /* TEXEL_LOBES of them */
};

struct builtin {
    const char *name;
    const struct kiln_film_gas *gas; /* NULL: nothing flows */
    struct texel (*texel)(const struct texel_site *site);
    float relief; /* how much the height tilts the normal */
};

/* Of texel_gas.c, which begins with what burns, and texel_solid.c. NULL names end them. */
extern const struct builtin kiln_builtin_gases[];
extern const struct builtin kiln_builtin_solids[];

void kiln_texel_lobes(struct texel_lobe lobes[TEXEL_LOBES]);

static inline float texel_mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float texel_saturate(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

/* 0 at `from`, 1 at `to`, in either order. */
static inline float texel_smooth(float from, float to, float x)
{
    float t = texel_saturate((x - from) / (to - from));
    return t * t * (3.0f - 2.0f * t);
}

#endif
