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
    KILN_MESH_PAD = 16, /* pixels by which vectors may pass the right edge */
};

/* Describes a projected triangle by planes over positions (u, v) of a picture, each as factors of
 * u, v and 1. A position is inside where no edge plane is negative. Triangles with a common edge
 * have the same plane for it with opposite signs, so that no position lies between them. */
struct kiln_projected_triangle {
    float edges[3][3];
    float nearness[3];       /* the nearest triangle has the greatest value */
    struct kiln_row_range x; /* columns of pixels that the triangle may touch */
    float top, bottom;       /* samples above and below these places are outside, px */
};

/* Returns the rows of pixels that a triangle may touch; none where it is beside the picture.
 * height: of the picture, px. */
static inline struct kiln_row_range
kiln_rows_of_triangle(const struct kiln_projected_triangle *triangle, float height)
{
    if (triangle->x.from >= triangle->x.to)
        return (struct kiln_row_range){0, 0};
    return kiln_row_range_between(triangle->top, triangle->bottom, height);
}

/* Describes KILN_MESH_ROWS rows of a picture, in several layers. Each layer samples pixels at its
 * own offset. */
struct kiln_mesh_strip {
    uint32_t width, y, rows;
    float u, v, u_step, v_step; /* of the picture's upper left corner; steps from pixel to pixel */
    uint32_t layers;
    float offsets[KILN_MESH_LAYERS][2]; /* of layers, px, from a pixel's upper left corner */
    float nearness_max;                 /* greatest nearness that is drawn */
    float *nearness;                    /* of the nearest triangle, by row, layer, pixel; 0: none */
    int32_t *triangles; /* 1 + number of the nearest triangle, likewise; NULL: not wanted */
    size_t pitch;       /* entries of a row of one layer */
};

struct kiln_mesh_rows {
    /* Draws the triangles whose numbers are in the list, in the list's order. */
    void (*draw)(const struct kiln_mesh_strip *strip,
                 const struct kiln_projected_triangle *triangles, const uint32_t *list,
                 size_t count);
};

KILN_SIMD_DECLARE(const struct kiln_mesh_rows, kiln_mesh_rows);

#endif
