/* Declares the chart of a mesh: where each texel of its texture lies on the mesh. This is the
 * position buffer of Drone 2007, 7.6.1.1. Triangles are rasterised exactly in texture space, so
 * that the chart is the same on every machine. */
#ifndef KILN_ASSET_GEOMETRY_CHART_H
#define KILN_ASSET_GEOMETRY_CHART_H

#include "asset/geometry/mesh.h"
#include "base/footprint.h"

enum {
    KILN_CHART_BLOCK = 64, /* texels that are painted together, near each other in space */
    KILN_CHART_BORDER = 2, /* texels around triangles that texture filters reach */
    KILN_MAX_CHART = 2048, /* most texels along an edge; each edge is a power of two */
    KILN_MIN_CHART = 16,
};

/* Lists texels in blocks. The last block is filled up with texels that are far away and have the
 * number KILN_CHART_NOWHERE. */
#define KILN_CHART_NOWHERE 0xffffffffu

struct kiln_chart {
    uint32_t edge;        /* texels along an edge */
    uint32_t count;       /* number of texels on the mesh or in the border around it */
    uint32_t block_count; /* number of blocks of KILN_CHART_BLOCK texels */
    uint32_t *texels;     /* row * edge + column; rows go with v, columns with u */
    float *place[3];      /* places in units of the mesh's file, by axis */
    float *normal[3];     /* unit normals, by axis */
    float (*low)[3];      /* bounds of each block's places */
    float (*high)[3];
    uint8_t *on;          /* by row * edge + column: 1 if the texel is in `texels` */
    float min[3], max[3]; /* bounds of all places */
};

/* Makes the chart of an unwrapped mesh; edge is a power of two. name stands for the file in
 * messages. NULL: KILN_INVALID_INPUT where a triangle lies outside of 0 to 1, two triangles
 * overlap, or there is no texel at all; KILN_DEVICE_FAILED when memory is short. */
struct kiln_chart *kiln_chart_create(const struct kiln_mesh *mesh, uint32_t edge, const char *name,
                                     struct kiln_error *error);
void kiln_chart_destroy(struct kiln_chart **chart);

/* Return the bytes of a chart, and those that making it takes besides, where the mesh covers all of
 * the texture. */
uint64_t kiln_chart_bytes(uint32_t edge);
uint64_t kiln_chart_making_bytes(uint32_t edge);

#endif
