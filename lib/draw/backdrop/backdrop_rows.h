/* This header declares the loops of technique backdrop=cpu over the picture, for each width of
 * vectors. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_ROWS_H
#define KILN_DRAW_BACKDROP_BACKDROP_ROWS_H

#include "base/simd.h"
#include "draw/backdrop/ray.h"
#include "draw/backdrop/surface_cache.h"

/* Holds the range of pixels, from .. to - 1, in which a shape may be seen. */
struct kiln_pixel_box {
    int32_t x_from, x_to, y_from, y_to;
};

struct kiln_backdrop_picture {
    const struct kiln_ray_frame *frame;
    uint32_t width, height;
    float *color;            /* RGBA */
    float *depth;            /* m */
    float *surfaces;         /* the number of each pixel by which edges are found (draw_layout.h) */
    enum kiln_cache_use use; /* of the cache for this picture */
    struct kiln_surface_cache *cache;              /* NULL: it is unused */
    struct kiln_pixel_box boxes[KILN_MAX_OBJECTS]; /* of shapes */
};

/* Each function draws KILN_EDGE_TILE rows from row y. */
struct kiln_backdrop_rows {
    uint32_t lanes; /* width of vectors */
    /* Casts a ray through the centre of each pixel and writes colour, depth and surface. */
    void (*cast)(const struct kiln_backdrop_picture *picture, uint32_t y);
    /* Casts KILN_EDGE_SAMPLES rays a pixel at edges. All rows must have been cast before. */
    void (*antialias)(const struct kiln_backdrop_picture *picture, uint32_t y);
};

KILN_SIMD_DECLARE(const struct kiln_backdrop_rows, kiln_backdrop_rows);

#endif
