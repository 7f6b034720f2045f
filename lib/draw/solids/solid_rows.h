/* This header declares the drawing of solid particles, spheres and meshes, into rows of the
 * picture, for each width of vectors. solids_cpu.c prepares the data, solid_simd.c draws. */
#ifndef KILN_DRAW_SOLIDS_SOLID_ROWS_H
#define KILN_DRAW_SOLIDS_SOLID_ROWS_H

#include "base/simd.h"
#include "draw/backdrop/ray.h"
#include "draw/vector/row_lists.h"

enum {
    KILN_SOLID_ROWS = 8,          /* rows of a strip */
    KILN_SOLID_SAMPLES = 4,       /* samples of a pixel */
    KILN_SOLID_PAD = 16,          /* pixels that vectors may reach beyond the right edge */
    KILN_SOLID_VISIBLE_WORDS = 3, /* words of a particle that is visible in a pixel */
};

struct kiln_drawn_sphere {
    float center[3], radius; /* in view space, m */
    float albedo[3], lit;    /* lit: 1: the albedo is lit; 0: it is shown as it is */
    float glow[3];           /* emitted light */
    float segments;          /* segments of each colour; 0: no pattern; below 0: a stripe */
    float bloom[3];          /* bloom weights (Heinz 2019, equation 3.2) */
    float part;              /* below 1 where it is drawn larger than it is, to fill a pixel */
    float other[3], pose[4]; /* for a pattern: second albedo; quaternion, sphere to world */
    struct kiln_row_range x; /* columns that it may touch */
};

struct kiln_drawn_instance {
    float to_view[3][4]; /* rows of the matrix from the mesh to view space, m */
    float albedo[3], lit;
    float glow[3], shade;      /* shade: radius of the sphere that stands for it in shadows, m */
    float bloom[3], part;      /* part: as of a sphere */
    uint32_t first, triangles; /* first corner; number of triangles, 0 if no mesh is drawn */
    struct kiln_row_range x;
};

/* Describes at most KILN_SOLID_ROWS rows of the picture, from row y to y_to - 1. Sample arrays are
 * indexed by row, sample and pixel; their rows are `pitch` elements, the width and KILN_SOLID_PAD
 * more. */
struct kiln_solid_strip {
    const struct kiln_ray_frame *frame;
    const struct kiln_drawn_sphere *spheres;
    const struct kiln_drawn_instance *instances; /* indexed like spheres; NULL: no meshes */
    const float4 (*corners)[2];                  /* corners of the meshes: position, normal */
    const struct kiln_row_range *ranges;         /* rows that each particle may touch */
    const uint32_t *list;                        /* numbers of the particles in the strip */
    size_t count;
    bool patterned; /* true: some spheres have patterns */
    uint32_t width, y, y_to;
    const float *scene_color, *scene_depth; /* the picture behind the particles; m */
    float *color, *depth, *bloom;           /* the pictures to write */
    float *samples;                         /* scratch: the least depth in each sample, m */
    int32_t *nearest;                       /* scratch: the particle at that depth; -1: none */
    int32_t *triangles;                     /* scratch: its triangle, if it is a mesh */
    /* scratch: the particles visible in a row, KILN_SOLID_VISIBLE_WORDS for each of its samples */
    uint32_t *visible;
    size_t pitch;
};

struct kiln_solid_rows {
    void (*draw)(const struct kiln_solid_strip *strip);
};

KILN_SIMD_DECLARE(const struct kiln_solid_rows, kiln_solid_rows);

#endif
