/* Declares the light that reaches a domain of gas from outside: the sun and the sky, dimmed by the
 * smoke on their way. A sweep visits slices of the window one by one, from the side of a light on,
 * and hands the optical depth on from slice to slice. */
#ifndef KILN_DRAW_VOLUME_VOLUME_LIGHT_H
#define KILN_DRAW_VOLUME_VOLUME_LIGHT_H

#include "base/simd.h"
#include "draw/volume/volume_field.h"
#include "shared/draw_layout.h"

/* The octaves of the light that gas scatters, in parts of that of a white surface, and how much
 * less than straight light the later ones are dimmed (Wrenninge et al., "Oz: The Great and
 * Volumetric", 2013). */
#define VOLUME_ONCE        0.34f
#define VOLUME_TWICE       0.26f
#define VOLUME_TWICE_DIMS  0.42f
#define VOLUME_THRICE      0.07f
#define VOLUME_THRICE_DIMS 0.16f

/* How much less than straight light that of the sky is dimmed, most of which is scattered. */
#define VOLUME_SKY_DIMS 0.5f

enum {
    VOLUME_SKY_WAYS = 5,     /* directions of the sky */
    VOLUME_SLICE_MARGIN = 16 /* floats of zeros before and behind the rows of a slice */
};

/* A direction of light, as the slices of a sweep see it. */
struct kiln_volume_way {
    int32_t lanes, rows;       /* whole cells from a slice to the one before it */
    float lane_part, row_part; /* and parts of cells */
    float half;                /* optical depth of half a cell with smoke 1 */
    float *before, *here;      /* optical depth at the far end of the cells of both slices */
};

/* Describes a sweep. Axes have the numbers 0 to 2; rows of a slice lie along the first one. */
struct kiln_volume_sweep {
    const struct kiln_volume_field *field;
    int32_t count[3];   /* cells of the window along the sweep's axes: lanes, rows, slices */
    ptrdiff_t brick[3]; /* bricks to the next one along each of these axes */
    ptrdiff_t cell[3];  /* floats to the next cell of a brick */
    ptrdiff_t drawn[3]; /* floats to the next cell of a block */
    ptrdiff_t pitch;    /* floats of a row of a slice */
    struct kiln_volume_way ways[VOLUME_SKY_WAYS];
    uint32_t way_count;
    bool sun; /* true: the light of the sun is written; false: that of the sky */
};

/* Where cells of a window lie in the world. */
struct kiln_volume_frame {
    float corner[3];   /* m: the window's lowest corner */
    float edges[3][3]; /* m: from a cell to the next one along each axis of the window */
    float cell_m;      /* length of these edges */
};

struct kiln_volume_light_rows {
    /* Computes a row of a slice. */
    void (*sweep)(const struct kiln_volume_sweep *sweep, int32_t slice, int32_t row);
    /* Adds the light of a lamp to the light from all sides of a block. parts: of
     * kiln_volume_lamp_reach; NULL: nothing is in its way. */
    void (*add_lamp)(const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                     const struct kiln_draw_light *lamp, const float *parts, float *block);
};
KILN_SIMD_DECLARE(const struct kiln_volume_light_rows, kiln_volume_light_rows);

/* Holds the slices of sweeps. */
struct kiln_volume_slices {
    float *floats;
    size_t room;
};

/* Describes the light of a domain at a moment, in the axes of its window. */
struct kiln_volume_light {
    float to_sun[3]; /* unit */
    bool sun, sky;   /* false: the light is black */
    float thickness; /* optical depth of a cell with smoke 1 */
};

/* Writes VOLUME_SUN and VOLUME_SCATTERED, and the part of the sky's light to VOLUME_RED, of all
 * blocks, without the cells that they share. Returns false with an error when memory is short. */
bool kiln_volume_light_run(struct kiln_volume_slices *slices, const struct kiln_volume_field *field,
                           const struct kiln_volume_light *light,
                           const struct kiln_volume_light_rows *rows, struct kiln_threads *threads,
                           struct kiln_error *error);

/* Returns the most bytes of the slices of a domain. */
uint64_t kiln_volume_slices_bytes(struct kiln_gas_place cells);

#endif
