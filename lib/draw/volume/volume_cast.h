/* Casts rays through a domain of gas, whose blocks are lit: a ray for each pixel, or a grid of rays
 * and others where they are needed (volume_between.h). */
#ifndef KILN_DRAW_VOLUME_VOLUME_CAST_H
#define KILN_DRAW_VOLUME_VOLUME_CAST_H

#include "draw/volume/volume_gl.h"
#include "draw/volume/volume_march.h"
#include "draw/volume/volume_tiles.h"

/* Describes what rays are cast through, and where to. */
struct kiln_volume_cast {
    struct kiln_volume_march *march; /* its members of the grid are set here */
    const struct kiln_volume_march_rows *rows;
    struct kiln_volume_tiles *tiles; /* are found here */
    uint8_t *touched;                /* of each tile: set to 1 where gas was drawn */
    float *grid;                     /* room for its rays; NULL: each pixel has a ray */
    struct kiln_volume_gl *gl; /* marches in place of `rows` and `grid`; NULL: there is none */
    bool same_field;           /* gl has the field from the last call */
};

/* Draws the gas over the planes of the march. Returns false with an error when memory is short or
 * the job has ended. */
bool kiln_volume_cast(const struct kiln_volume_cast *cast, struct kiln_threads *threads,
                      struct kiln_error *error);

/* Returns the bytes of the grid of a scene; 0: no domain has it. */
size_t kiln_volume_grid_of(const struct kiln_scene *scene);

/* Returns the bytes of the grid of a picture. */
size_t kiln_volume_grid_bytes(uint32_t width, uint32_t height);

#endif
