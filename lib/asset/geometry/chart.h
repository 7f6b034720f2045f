/* Where the texels of a mesh's texture lie on the mesh: the position buffer of Drone 2007, 7.6.1.1,
 * by exact rasterisation of the triangles in texture space, so that it is the same on every
 * machine.
 */
#ifndef KILN_ASSET_GEOMETRY_CHART_H
#define KILN_ASSET_GEOMETRY_CHART_H

#include "asset/geometry/mesh.h"

enum {
    KILN_CHART_BLOCK = 64, /* texels that are painted together: near each other in space */
    KILN_CHART_BORDER = 2, /* texels around triangles, which filtering reaches */
    KILN_MAX_CHART = 2048, /* texels along an edge; a power of two, as all are */
    KILN_MIN_CHART = 16,
};

/* Texels in blocks, the last of which is filled up with those of nowhere: far away, and of number
 * KILN_CHART_NOWHERE. */
#define KILN_CHART_NOWHERE 0xffffffffu

struct kiln_chart {
    uint32_t edge;        /* texels */
    uint32_t count;       /* of texels on the mesh or in the border around it */
    uint32_t block_count; /* of KILN_CHART_BLOCK texels */
    uint32_t *texels;     /* row * edge + column; rows go with v, columns with u */
    float *place[3];      /* in units of the mesh's file, by axis */
    float *normal[3];     /* unit */
    float (*low)[3];      /* bounds of each block's places */
    float (*high)[3];
    uint8_t *on;          /* by row * edge + column: is it one of these texels? */
    float min[3], max[3]; /* of all places */
};

/* The mesh is an unwrapped one, edge a power of two; name stands for its file in messages. NULL:
 * KILN_INVALID_INPUT where a triangle lies outside of 0 to 1, two lie at one place, or there is no
 * texel at all; KILN_DEVICE_FAILED for memory. */
struct kiln_chart *kiln_chart_create(const struct kiln_mesh *mesh, uint32_t edge, const char *name,
                                     struct kiln_error *error);
void kiln_chart_destroy(struct kiln_chart **chart);

#endif
