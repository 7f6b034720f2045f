/* This header computes the light that smoke lets through to vectors of points: it gathers cells of
 * the grids that shared/smoke_grid.h describes. */
#ifndef KILN_DRAW_LIGHT_RAY_SMOKE_H
#define KILN_DRAW_LIGHT_RAY_SMOKE_H

#include "draw/light/smoke_shadow.h"
#include "draw/vector/real.h"
#include "shared/smoke_grid.h"

/* Describes points that light is computed for, and the lanes that need it. */
struct ray_point {
    struct vf3 at, normal;
    vi active; /* mask of the lanes */
};

/* Describes two neighbouring cells along an axis, between whose centres a position lies; positions
 * are clamped to the centres of the outer cells. part: the weight of the second cell. */
struct ray_cell {
    vi from, step;
    vf part;
};

SIMD struct ray_cell find_cell(vf at, int32_t stride)
{
    vf cell = vf_clamp(at * (float)KILN_SMOKE_GRID - 0.5f, 0.0f, (float)(KILN_SMOKE_GRID - 1));
    vi from = vi_of(cell);
    vi step = (from + 1 < KILN_SMOKE_GRID) & stride;
    return (struct ray_cell){from * stride, step, cell - vf_of(from)};
}

SIMD vf read_grid_row(const float *depth, vi from, const struct ray_cell *x)
{
    vf left = vf_gather(depth, from);
    return left + (vf_gather(depth, from + x->step) - left) * x->part;
}

SIMD vf read_grid(const float *depth, vf x, vf y, vf z)
{
    const struct ray_cell cx = find_cell(x, 1), cy = find_cell(y, KILN_SMOKE_GRID);
    const struct ray_cell cz = find_cell(z, KILN_SMOKE_GRID * KILN_SMOKE_GRID);
    vi from = cx.from + cy.from + cz.from, next = from + cz.step;
    vf near = read_grid_row(depth, from, &cx), far = read_grid_row(depth, next, &cx);
    near += (read_grid_row(depth, from + cy.step, &cx) - near) * cy.part;
    far += (read_grid_row(depth, next + cy.step, &cx) - far) * cy.part;
    return near + (far - near) * cz.part;
}

/* Returns the part of the light that smoke lets through to a point. */
SIMD vf smoke_lets_through(const float *depth, const float4 to_grid[3], const struct ray_point *p)
{
    vf one = vf_all(1.0f);
    if (!depth)
        return one;
    struct vf3 at = smoke_grid_place(to_grid[0], to_grid[1], to_grid[2], p->at);
    vi shaded = p->active & smoke_grid_shades(at);
    if (!any(shaded))
        return one;
    vf x = vf_where(shaded, at.x), y = vf_where(shaded, at.y), z = vf_where(shaded, at.z);
    return vf_select(shaded, smoke_transmittance(read_grid(depth, x, y, z)), one);
}

#endif
