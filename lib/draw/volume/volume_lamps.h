/* Declares what is in the way of lamps that light gas: smoke, objects and solid particles. It is
 * found at every second cell of a block along each axis, and interpolated between. */
#ifndef KILN_DRAW_VOLUME_VOLUME_LAMPS_H
#define KILN_DRAW_VOLUME_VOLUME_LAMPS_H

#include "draw/light/lamps.h"
#include "draw/volume/volume_light.h"

enum {
    VOLUME_SPARSE = GAS_BRICK / 2 + 1, /* places along an edge of a block */
    VOLUME_PLACES = 128 /* floats for VOLUME_SPARSE^3 places, rows along x: whole vectors */
};

/* Holds a lamp, and what may be in its way. */
struct kiln_volume_lamp {
    const struct kiln_draw_light *light;
    struct kiln_shape_set casters;
    struct kiln_lamp_objects objects;
    const float *smoke; /* maps of kiln_lamp_smoke_run; NULL: there are none */
};

/* Returns whether nothing is in the way of a lamp. */
static inline bool kiln_volume_lamp_is_clear(const struct kiln_volume_lamp *lamp)
{
    return !(lamp->smoke && lamp->light->casters.z) && !lamp->light->casters.y &&
           !kiln_shape_set_any(&lamp->casters);
}

/* Finds place number n of a block, m; beyond the last one, that one. */
static inline void kiln_volume_find_place(const struct kiln_volume_frame *frame,
                                          struct kiln_gas_place brick, int n, float at[3])
{
    enum { EDGE = VOLUME_SPARSE, LAST = EDGE * EDGE * EDGE - 1 };
    n = n < LAST ? n : LAST;
    const float x = (float)(brick.x * GAS_BRICK + 2 * (n % EDGE)) + 0.5f;
    const float y = (float)(brick.y * GAS_BRICK + 2 * (n / EDGE % EDGE)) + 0.5f;
    const float z = (float)(brick.z * GAS_BRICK + 2 * (n / (EDGE * EDGE))) + 0.5f;
    for (int c = 0; c < 3; c++)
        at[c] = frame->corner[c] + frame->edges[0][c] * x + frame->edges[1][c] * y +
                frame->edges[2][c] * z;
}

/* Writes the part of a lamp's light, in that of a white surface, that smoke of a block scatters: of
 * its octaves, what smoke leaves of them, and past objects. */
typedef void kiln_volume_lamp_reach(const struct kiln_volume_lamp *lamp,
                                    const struct kiln_volume_frame *frame,
                                    struct kiln_gas_place brick, float parts[VOLUME_PLACES]);
KILN_SIMD_DECLARE(kiln_volume_lamp_reach, kiln_volume_lamp_reach);

/* Interpolates the row of cells (y, z) of a block between its places. */
static inline void kiln_volume_spread(const float parts[VOLUME_PLACES], int y, int z,
                                      float row[GAS_BRICK])
{
    const float *corner = parts + ((ptrdiff_t)(z / 2) * VOLUME_SPARSE + y / 2) * VOLUME_SPARSE;
    const int up = y & 1 ? VOLUME_SPARSE : 0, far = z & 1 ? VOLUME_SPARSE * VOLUME_SPARSE : 0;
    float places[VOLUME_SPARSE];
    for (int i = 0; i < VOLUME_SPARSE; i++)
        places[i] =
            0.25f * ((corner[i] + corner[i + up]) + (corner[i + far] + corner[i + far + up]));
    for (int x = 0; x < GAS_BRICK; x++)
        row[x] = 0.5f * (places[x / 2] + places[(x + 1) / 2]);
}

#endif
