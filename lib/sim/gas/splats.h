/* Sums up points that are sources of gas: particles, and samples of the meshes, images and paths
 * that are sources. A cell counts by the points around it. */
#ifndef KILN_SIM_GAS_SPLATS_H
#define KILN_SIM_GAS_SPLATS_H

#include "particles/pool.h"
#include "scene/scene.h"
#include "sim/gas/frames.h"
#include "sim/gas/solver.h"

struct gas_splats {
    /* Of each brick that a point reaches: sums over the points near each cell, of velocities times
     * weights, m/s in the domain's frame, and of weights. */
    float (*brick)[GAS_BRICK_CELLS][4];
    uint32_t *number; /* of each brick of the domain: 1 + its place, or 0 */
    uint32_t count, room;
    float3 low, high; /* m: of a box about all points, with their reach */
    bool any;
    float4 *words;     /* of a mesh with an animation: its triangles in the step */
    float (*poses)[6]; /* and its vertices */
};

/* Returns the number of the brick of a domain in which a cell lies. */
static inline size_t gas_brick_number(const struct kiln_gas_shape *shape,
                                      struct kiln_gas_place cell)
{
    const size_t x = (size_t)(cell.x / GAS_BRICK), y = (size_t)(cell.y / GAS_BRICK);
    const size_t bricks_x = (size_t)(shape->cells.x / GAS_BRICK);
    const size_t bricks_y = (size_t)(shape->cells.y / GAS_BRICK);
    return ((size_t)(cell.z / GAS_BRICK) * bricks_y + y) * bricks_x + x;
}

void gas_splats_finish(struct gas_splats *splats);

/* Returns the bricks of a domain that a box reaches, in the domain's frame. */
struct gas_region gas_region_of(const struct kiln_gas_shape *shape, float3 low, float3 high);

/* How points count. Velocities are relative to the domain. */
struct gas_splatting {
    const struct kiln_scene *scene;
    const struct kiln_gas_domain *domain;
    uint32_t step; /* at whose end the frames of nodes are taken */
    float reach;   /* m: of a point */
    float inherit; /* part of its velocity */
};

/* Sums up the particles of a system, in the order of their serials. False with KILN_DEVICE_FAILED
 * when memory is short or the pool cannot be read. */
bool gas_splats_set_particles(struct gas_splats *splats, const struct gas_splatting *how,
                              struct kiln_pool *pool, uint32_t system, struct kiln_error *error);

/* Sums up samples of a mesh, an image or a path, which lie in the same places of it in each step.
 */
bool gas_splats_set_samples(struct gas_splats *splats, const struct gas_splatting *how,
                            const struct kiln_emitter *emit, uint32_t seed,
                            struct kiln_error *error);

#endif
