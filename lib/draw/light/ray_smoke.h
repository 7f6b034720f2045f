/* This header computes the light that smoke lets through to vectors of points. It gathers cells of
 * the grids of sun and sky (shared/smoke_grid.h), and of the maps of lamps
 * (shared/lamp_smoke.h). */
#ifndef KILN_DRAW_LIGHT_RAY_SMOKE_H
#define KILN_DRAW_LIGHT_RAY_SMOKE_H

#include "base/real.h"
#include "draw/light/lamp_smoke.h"
#include "draw/light/smoke_shadow.h"
#include "shared/lamp_smoke.h"
#include "shared/smoke_grid.h"

/* Describes points that light is computed for, and the lanes that need it. */
struct ray_point {
    struct vf3 at, normal;
    vi active; /* mask of the lanes */
};

/* Describes the cells of a grid, rows along x. */
struct smoke_cells {
    const float *values;
    int32_t edge; /* cells along each axis */
};

/* Describes two neighbouring cells along an axis, between whose centres a position lies; positions
 * are clamped to the centres of the outer cells. part: the weight of the second cell. */
struct ray_cell {
    vi from, step;
    vf part;
};

/* at: in cells from the centre of the first cell; count: of the cells along the axis. */
SIMD struct ray_cell find_cell(vf at, int32_t count, int32_t stride)
{
    vf cell = vf_clamp(at, 0.0f, (float)(count - 1));
    vi from = vi_of(cell);
    vi step = (from + 1 < count) & stride;
    return (struct ray_cell){from * stride, step, cell - vf_of(from)};
}

SIMD vf read_cells_along(const float *values, vi from, const struct ray_cell *x)
{
    vf left = vf_gather(values, from);
    return left + (vf_gather(values, from + x->step) - left) * x->part;
}

SIMD vf read_cells(const float *values, const struct ray_cell *x, const struct ray_cell *y,
                   const struct ray_cell *z)
{
    vi from = x->from + y->from + z->from, next = from + z->step;
    vf near = read_cells_along(values, from, x), far = read_cells_along(values, next, x);
    near += (read_cells_along(values, from + y->step, x) - near) * y->part;
    far += (read_cells_along(values, next + y->step, x) - far) * y->part;
    return near + (far - near) * z->part;
}

/* Interpolates a grid at a place, 0 to 1 along each axis. */
SIMD vf read_grid(const struct smoke_cells *cells, vf x, vf y, vf z)
{
    const int32_t edge = cells->edge;
    const float size = (float)edge;
    const struct ray_cell cx = find_cell(x * size - 0.5f, edge, 1);
    const struct ray_cell cy = find_cell(y * size - 0.5f, edge, edge);
    const struct ray_cell cz = find_cell(z * size - 0.5f, edge, edge * edge);
    return read_cells(cells->values, &cx, &cy, &cz);
}

/* Returns the optical depth of the smoke between a light and a point; exactly 0 where its light
 * does not cross the grid. depth: the grid, or NULL: there is no smoke. */
SIMD vf smoke_depth_to(const float *depth, const float4 to_grid[3], const struct ray_point *p)
{
    if (!depth)
        return vf_all(0.0f);
    struct vf3 at = smoke_grid_place(to_grid[0], to_grid[1], to_grid[2], p->at);
    vi shaded = p->active & smoke_grid_shades(at);
    if (!any(shaded))
        return vf_all(0.0f);
    const struct smoke_cells cells = {depth, KILN_SMOKE_GRID};
    vf x = vf_where(shaded, at.x), y = vf_where(shaded, at.y), z = vf_where(shaded, at.z);
    return vf_where(shaded, read_grid(&cells, x, y, z));
}

/* Returns the part of the light that smoke lets through to a point. */
SIMD vf smoke_lets_through(const float *depth, const float4 to_grid[3], const struct ray_point *p)
{
    if (!depth)
        return vf_all(1.0f);
    return smoke_transmittance(smoke_depth_to(depth, to_grid, p));
}

/* Returns the optical depth of the smoke between a lamp and a point. maps: those of
 * kiln_lamp_smoke_run, or NULL. */
SIMD vf lamp_smoke_depth(const float *maps, const struct kiln_draw_light *lamp,
                         const struct ray_point *p)
{
    if (!maps || !lamp->casters.z || !any(p->active))
        return vf_all(0.0f);
    const struct vf3 from = vf3_scale(vf3_towards(lamp->position_radius2, p->at), vf_all(-1.0f));
    const struct lamp_smoke_place place = lamp_smoke_place_of(from, *lamp);
    const struct ray_cell x = find_cell(place.x, KILN_LAMP_SMOKE_WIDTH, 1);
    const struct ray_cell y = find_cell(place.y, KILN_LAMP_SMOKE_HEIGHT, KILN_LAMP_SMOKE_WIDTH);
    const struct ray_cell layer =
        find_cell(place.layer, KILN_LAMP_SMOKE_LAYERS, KILN_LAMP_SMOKE_LAYER);
    const float *map = maps + (size_t)(lamp->casters.z - 1) * KILN_LAMP_SMOKE_MAP;
    return vf_where(p->active, read_cells(map, &x, &y, &layer));
}

#endif
