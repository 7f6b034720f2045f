/* This header declares a rasteriser of triangles into rows of a picture, for each width of vectors.
 * Technique backdrop=cpu uses it where GL has its own rasteriser. */
#ifndef KILN_DRAW_VECTOR_MESH_ROWS_H
#define KILN_DRAW_VECTOR_MESH_ROWS_H

#include <stddef.h>
#include <stdint.h>

#include "base/simd.h"
#include "draw/vector/row_lists.h"

enum {
    KILN_MESH_ROWS = 8,
    KILN_MESH_LAYERS = 5,
    KILN_MESH_PAD = 16, /* pixels that vectors may reach beyond the right edge */
};

/* Describes a triangle over positions (u, v) of a picture by planes, as factors of u, v and 1. A
 * position is inside where no edge is negative. Of two triangles with a common edge, each has the
 * other's plane times -1, so that no position is between them. */
struct kiln_flat_triangle {
    float edges[3][3];
    float nearness[3];          /* the greatest of all is seen */
    struct kiln_row_range x, y; /* pixels that it may touch */
};

/* KILN_MESH_ROWS rows of a picture, in several layers, whose places in a pixel differ. */
struct kiln_mesh_strip {
    uint32_t width, y, rows;
    float u, v, u_step, v_step; /* of the upper left pixel's corner, and a pixel on */
    uint32_t layers;
    float offsets[KILN_MESH_LAYERS][2]; /* px, from the corner */
    float most;                         /* nearness beyond which nothing is seen */
    float *nearness;                    /* by row, layer, pixel: what is there; 0: nothing */
    int32_t *triangles;                 /* the same; NULL: not wanted */
    size_t pitch;                       /* of a row of a layer */
};

struct kiln_mesh_rows {
    /* Draws triangles, numbers of which are in the list, in its order. */
    void (*draw)(const struct kiln_mesh_strip *strip, const struct kiln_flat_triangle *triangles,
                 const uint32_t *list, size_t count);
};

KILN_SIMD_DECLARE(const struct kiln_mesh_rows, kiln_mesh_rows);

#endif
