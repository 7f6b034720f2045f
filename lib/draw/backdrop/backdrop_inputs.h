/* This header declares the inputs of both techniques of stage `backdrop`. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_INPUTS_H
#define KILN_DRAW_BACKDROP_BACKDROP_INPUTS_H

#include "draw/backdrop/backdrop.h"
#include "draw/moment/meshes.h"

/* Holds all inputs of the picture except the grids of smoke and the lists of solids. */
struct kiln_backdrop_inputs {
    struct kiln_view view;
    struct kiln_draw_backdrop block;
    struct kiln_draw_shapes shapes;
    const struct kiln_shape_seen *from_sun; /* of each shape; borrowed from the moment */
    uint64_t paint;                         /* kiln_painted_all_changes; 0: no mesh takes paint */
};

struct kiln_picture_size {
    uint32_t width, height; /* texels; 0: there is no picture */
};

#endif
