/* This file computes the grids of domains of gas from their boxes, and what they take.
 *
 * Units of activity are bricks of 8^3 cells, and windows follow them in steps of 16 cells, so that
 * a domain has a multiple of 16 along each edge. What that adds to the box lies above it, where
 * most gas goes, and on its four sides alike: the bottom stays where the file says. */
#include "scene/gas_shape.h"

#include <math.h>

#include "scene/gas_extent.h"
#include "scene/source.h"

static double edge_of(const struct kiln_gas_domain *domain, int axis)
{
    const struct kiln_value3 *size = &domain->size;
    const struct kiln_value *edges[3] = {&size->x, &size->y, &size->z};
    return (double)edges[axis]->constant;
}

static double cell_of(const struct kiln_gas_domain *domain)
{
    const double longest = fmax(edge_of(domain, 0), fmax(edge_of(domain, 1), edge_of(domain, 2)));
    const uint32_t stride = KILN_GAS_STRIDE;
    if (domain->cell > 0)
        return domain->cell;
    return longest / ((domain->cell_count + stride - 1) / stride * stride);
}

void kiln_gas_domain_cells(const struct kiln_gas_domain *domain, double cells[3])
{
    const double cell = cell_of(domain);
    for (int c = 0; c < 3; c++) {
        /* an edge that has a whole number of cells but for rounding has no more */
        const double count = ceil(edge_of(domain, c) / cell - 1e-4);
        cells[c] = fmax(1, ceil(count / KILN_GAS_STRIDE)) * KILN_GAS_STRIDE;
    }
}

void kiln_scene_gas_shape(struct kiln_gas_domain *domain)
{
    const struct kiln_value3 *center = &domain->center;
    struct kiln_gas_shape *shape = &domain->shape;
    double cells[3];
    kiln_gas_domain_cells(domain, cells);
    *shape = (struct kiln_gas_shape){
        .cells = {(int32_t)cells[0], (int32_t)cells[1], (int32_t)cells[2]},
        .cell = (float)cell_of(domain),
        .detailed = domain->detail > 1,
    };
    const double cell = (double)shape->cell;
    shape->corner = FLOAT3((float)((double)center->x.constant - 0.5 * cells[0] * cell),
                           (float)((double)center->y.constant - 0.5 * edge_of(domain, 1)),
                           (float)((double)center->z.constant - 0.5 * cells[2] * cell));
    for (int i = 0; i < 6; i++)
        shape->closed[i] = domain->sides[i] == KILN_SIDE_CLOSED;
    for (uint32_t i = 0; i < domain->source_count; i++)
        shape->colored |= kiln_gas_source_is_colored(&domain->sources[i]);
}

double kiln_gas_bytes_of(const struct kiln_gas_shape *shape, double cells)
{
    const struct kiln_gas_place block = {64, 64, 64};
    const double blocks = cells / (64.0 * 64.0 * 64.0), bricks = cells / GAS_BRICK_CELLS;
    return blocks * (double)kiln_gas_window_bytes(block) +
           bricks * (double)kiln_gas_brick_bytes(shape);
}

static uint64_t cells_of(const struct kiln_gas_domain *domain)
{
    const struct kiln_gas_place *n = &domain->shape.cells;
    return domain->enabled ? (uint64_t)n->x * (uint64_t)n->y * (uint64_t)n->z : 0;
}

uint32_t kiln_gas_least_substeps(const struct kiln_scene *scene,
                                 const struct kiln_gas_domain *domain)
{
    const double rate = (double)scene->rate.num / (double)scene->rate.den;
    const double least = ceil(domain->rate / rate - 1e-9);
    return least > 1 ? (uint32_t)least : 1;
}

uint64_t kiln_gas_cells(const struct kiln_scene *scene)
{
    uint64_t cells = 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        cells += cells_of(&scene->gas[i]);
    return cells;
}

/* Returns the least number of steps of the gas in a step of the scene. */
static uint64_t substeps_of(const struct kiln_scene *scene, const struct kiln_gas_domain *domain)
{
    const uint32_t least = kiln_gas_least_substeps(scene, domain);
    return domain->substeps > least ? domain->substeps : least;
}

uint64_t kiln_gas_cell_steps(const struct kiln_scene *scene, uint64_t steps)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        sum += steps * substeps_of(scene, &scene->gas[i]) * cells_of(&scene->gas[i]);
    return sum; /* of at most KILN_MAX_STEPS * KILN_MAX_SUBSTEPS * KILN_MAX_GAS_CELLS */
}

/* Returns the bytes of a domain that gas fills. */
static uint64_t bytes_of(const struct kiln_gas_domain *domain)
{
    const uint64_t bricks = cells_of(domain) / GAS_BRICK_CELLS;
    if (!domain->enabled)
        return 0;
    return kiln_gas_window_bytes(domain->shape.cells) +
           bricks * kiln_gas_brick_bytes(&domain->shape);
}

uint64_t kiln_gas_most_bytes(const struct kiln_scene *scene)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        bytes += bytes_of(&scene->gas[i]);
    return bytes;
}

void kiln_scene_gas_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const struct kiln_gas_extent extent = kiln_gas_extent(scene, i);
        if (extent.bricks == 0)
            continue;
        kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, 1, kiln_gas_window_bytes(extent.cells));
        /* a window that moves lies in memory twice */
        kiln_footprint_pass(footprint, KILN_FOOTPRINT_GAS, kiln_gas_window_bytes(extent.cells));
        kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, extent.bricks,
                           kiln_gas_brick_bytes(&scene->gas[i].shape));
    }
    kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, kiln_sources_sizes(scene).gas_words,
                       sizeof(float4));
}

void kiln_scene_visit_gas(const struct kiln_scene *scene,
                          void (*visit)(void *user, const struct kiln_gas_info *info), void *user)
{
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const struct kiln_gas_domain *domain = &scene->gas[i];
        const struct kiln_gas_place *n = &domain->shape.cells;
        const struct kiln_gas_info info = {
            .name = domain->name,
            .enabled = domain->enabled,
            .cells = {(uint32_t)n->x, (uint32_t)n->y, (uint32_t)n->z},
            .cell_m = (double)domain->shape.cell,
            .memory_bytes = bytes_of(domain),
            .substeps = (uint32_t)substeps_of(scene, domain),
        };
        visit(user, &info);
    }
}
