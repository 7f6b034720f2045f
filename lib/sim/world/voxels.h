/* Puts triangles into a lattice of cells (Drone 2007, 7.5.2.1 and 7.5.2.3). A cell that triangles
 * touch on their way through a step keeps the plane of one of them, at the start and the end of the
 * step. */
#ifndef KILN_SIM_WORLD_VOXELS_H
#define KILN_SIM_WORLD_VOXELS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "kiln.h"
#include "shared/layout.h"

enum {
    KILN_MAX_VOXEL_EDGE = 256,      /* cells along an axis */
    KILN_MAX_VOXEL_CELLS = 1 << 22, /* all cells */
    /* products of cells and triangles: cells in the box around each triangle and its way */
    KILN_MAX_VOXEL_VISITS = 1 << 28,
};

/* Triangles at the start and at the end of a step. Vertices move straight from one place to the
 * other. */
struct kiln_voxels_input {
    const float (*before)[3], (*after)[3]; /* m, finite and within 1e6 */
    uint32_t vertex_count;
    const uint32_t (*triangles)[3];
    uint32_t triangle_count;
    float spacing;  /* m: edge of a cell, above 0; doubled until the limits above hold */
    float3 heading; /* unit vector in which most particles fly */
    bool two_sided; /* true: front and back of a triangle count alike */
};

/* The plane of a cell: a place on it at the start and at the end of the step, and its unit normals
 * then. */
struct kiln_voxel {
    float3 start, end;
    float3 normal, normal_end;
    uint32_t triangle;
};

struct kiln_voxels {
    float origin[3];  /* m: the lowest corner; at least one cell lies around the triangles */
    float spacing;    /* m: edge of a cell */
    float per_metre;  /* cells a metre */
    uint32_t size[3]; /* number of cells along each axis */
    /* One mark a cell, by z, y, x. Above 0: 1 + the number of the cell's plane. Else the cell has
     * no plane, and no cell within -mark cells of it has one, also diagonally; -mark is at most
     * 7. */
    float *marks;
    struct kiln_voxel *planes; /* planes in the order of their cells */
    uint32_t plane_count;
    struct kiln_voxels_scratch *scratch;
};

/* Builds the lattice. voxels starts as zeros and may be built again. False with KILN_DEVICE_FAILED
 * when memory is short, and with KILN_INVALID_INPUT when it would take too long; then the message
 * says what to change. kiln_voxels_finish frees everything.
 *
 * If several triangles touch a cell, the cell keeps one of them. Triangles that face against the
 * heading come before those that are seen edge-on, and these before those that face along it. Among
 * equals, those come first that the line along the heading through the middle of the cell meets
 * inside the cell, then those whose plane the line meets first, then those with the lower number.
 * Integers decide this, for corners rounded to 1/1024 of a cell, so that it is the same everywhere.
 *
 * A triangle that does not move touches the cells that come within 1/512 of a cell of it. A
 * triangle that moves touches those along its way, and may touch others around it. Triangles that
 * have no area at the end of the step, after rounding, touch nothing. */
bool kiln_voxels_build(struct kiln_voxels *voxels, const struct kiln_voxels_input *input,
                       struct kiln_threads *threads, struct kiln_error *error);
void kiln_voxels_finish(struct kiln_voxels *voxels);

/* Adds the memory of a lattice of `cells` cells, of which `planes` have a plane. */
void kiln_voxels_footprint(uint64_t vertices, uint64_t triangles, uint64_t cells, uint64_t planes,
                           struct kiln_footprint *footprint);

#endif
