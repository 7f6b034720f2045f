/* This header declares how rows of the picture are drawn with particles that are spheres or meshes,
 * for each width of vectors. */
#ifndef KILN_DRAW_SOLIDS_SOLID_ROWS_H
#define KILN_DRAW_SOLIDS_SOLID_ROWS_H

#include "base/simd.h"
#include "draw/backdrop/ray.h"
#include "draw/vector/row_lists.h"

enum {
    KILN_SOLID_ROWS = 8,
    KILN_SOLID_SAMPLES = 4,
    KILN_SOLID_PAD = 16, /* pixels that vectors may reach beyond the right edge */
};

struct kiln_drawn_sphere {
    float center[3], radius; /* in view space, m */
    float albedo[3], lit;    /* 1 lit .. 0 shows its colour as it is */
    float glow[3];           /* light that it emits */
    float segments;          /* of each colour; 0: no pattern, below 0: a stripe */
    float bloom[3];          /* weights of equation 3.2 */
    float other[3], pose[4]; /* of a pattern: the second albedo; from the ball to the world */
    struct kiln_row_range x; /* pixels that it may touch */
};

struct kiln_drawn_instance {
    float to_view[3][4]; /* rows: from the mesh to view space, m */
    float albedo[3], lit;
    float glow[3], shade; /* shade: radius of the sphere that throws its shadow, m */
    float bloom[3];
    uint32_t first, triangles; /* corner; 0: it is no mesh, or not to be drawn */
    struct kiln_row_range x;
};

/* KILN_SOLID_ROWS rows of the picture from row y. Samples are by row, sample and pixel, `pitch`
 * floats apart; all pixels have room for KILN_SOLID_PAD more at the end of a row. */
struct kiln_solid_strip {
    const struct kiln_ray_frame *frame;
    const struct kiln_drawn_sphere *spheres;
    const struct kiln_drawn_instance *instances; /* by the same numbers; NULL: none is a mesh */
    const float4 (*corners)[2];                  /* of the meshes */
    const struct kiln_row_range *rows;           /* that they may touch */
    const uint32_t *list;                        /* those of the strip */
    size_t count;
    bool patterned; /* some spheres have patterns */
    uint32_t width, y, y_to;
    const float *scene_color, *scene_depth; /* of the picture */
    float *color, *depth, *bloom;
    float *samples;     /* depths, m */
    int32_t *nearest;   /* the particles there; -1: none */
    int32_t *triangles; /* of those that are meshes */
    uint32_t *entries;  /* room for 3 a sample of a row */
    size_t pitch;
};

struct kiln_solid_rows {
    void (*draw)(const struct kiln_solid_strip *strip);
};

KILN_SIMD_DECLARE(const struct kiln_solid_rows, kiln_solid_rows);

#endif
