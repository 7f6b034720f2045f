/* Puts triangles into a lattice of cells (Drone 2007, 7.5.2.1 and 7.5.2.3). A cell that triangles
 * touch on their way through a step keeps the plane of one of them, and how it moves. */
#ifndef KILN_SIM_WORLD_VOXELS_H
#define KILN_SIM_WORLD_VOXELS_H

#include "base/thread.h"
#include "kiln.h"
#include "shared/layout.h"

enum {
    KILN_MAX_VOXEL_EDGE = 256,       /* cells along an axis */
    KILN_MAX_VOXEL_CELLS = 1 << 22,  /* in all */
    KILN_MAX_VOXEL_VISITS = 1 << 28, /* of cells by triangles: by the box around each and its way */
};

/* Triangles at the start and at the end of a step; vertices go straight from one to the other. */
struct kiln_voxels_input {
    const float (*before)[3], (*after)[3]; /* m, finite and within 1e6 */
    uint32_t vertex_count;
    const uint32_t (*triangles)[3];
    uint32_t triangle_count;
    float spacing;  /* m: edge of a cell, above 0; doubled until the limits above hold */
    float3 heading; /* unit: where most particles go */
    bool two_sided; /* which side of a triangle is its front does not matter */
};

/* A plane in a cell: a place on it, at the start and at the end, and its unit normals then. */
struct kiln_voxel {
    float3 start, end;
    float3 normal, normal_end;
    uint32_t triangle;
};

struct kiln_voxels {
    float origin[3];  /* m: the lowest corner; a cell at least is around the triangles */
    float spacing;    /* m */
    float per_metre;  /* cells */
    uint32_t size[3]; /* cells */
    /* One a cell, by z, y, x. Above 0: 1 + the number of the cell's plane. Else the cell has no
     * plane, and -mark cells around it have none either (diagonals count as sides), at most 7. */
    float *marks;
    struct kiln_voxel *planes; /* in the order of their cells */
    uint32_t plane_count;
    struct kiln_voxels_scratch *scratch;
};

/* Builds the lattice; voxels starts as zeros and may be built again. False with KILN_DEVICE_FAILED:
 * memory is short; with KILN_INVALID_INPUT: it would take too long, and the message says what to
 * do. kiln_voxels_finish frees what there is.
 *
 * In a cell, triangles that face against the heading come before those that are seen edge-on, and
 * these before those that face along it; then those that the line along the heading through the
 * middle of the cell meets there; then whose plane it meets first; then the lower number. That is
 * decided by integers, for corners rounded to 1/1024 of a cell, so that it is the same everywhere.
 * A cell is touched if a triangle that stands still comes within 1/512 of it. One that moves
 * touches those that it comes so near to, and may touch others around its way. Triangles that have
 * no area at the end of the step, after rounding, touch nothing. */
bool kiln_voxels_build(struct kiln_voxels *voxels, const struct kiln_voxels_input *input,
                       struct kiln_threads *threads, struct kiln_error *error);
void kiln_voxels_finish(struct kiln_voxels *voxels);

#endif
