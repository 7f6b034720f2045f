/* The loops of technique backdrop=cpu over the picture, for each width of vectors. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_ROWS_H
#define KILN_DRAW_BACKDROP_BACKDROP_ROWS_H

#include "base/simd.h"
#include "draw/backdrop/ray.h"

/* Pixels from .. to - 1 in which an object may be seen. */
struct kiln_pixel_box {
    int32_t x_from, x_to, y_from, y_to;
};

struct kiln_backdrop_picture {
    const struct kiln_ray_frame *frame;
    uint32_t width, height;
    float *color;    /* RGBA */
    float *depth;    /* m */
    float *surfaces; /* of each pixel's centre: a number that changes at every edge */
    struct kiln_pixel_box boxes[KILN_MAX_OBJECTS], spheres[KILN_MAX_OBJECTS],
        cylinders[KILN_MAX_OBJECTS], capsules[KILN_MAX_OBJECTS], turned[KILN_MAX_OBJECTS];
};

/* Each draws KILN_EDGE_TILE rows from row y. */
struct kiln_backdrop_rows {
    /* A ray through the centre of each pixel: colour, depth, surface. */
    void (*cast)(const struct kiln_backdrop_picture *picture, uint32_t y);
    /* Then KILN_EDGE_SAMPLES rays a pixel in tiles where neighbours show different surfaces. */
    void (*antialias)(const struct kiln_backdrop_picture *picture, uint32_t y);
};

KILN_SIMD_DECLARE(const struct kiln_backdrop_rows, kiln_backdrop_rows);

#endif
