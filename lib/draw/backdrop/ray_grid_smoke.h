/* This header computes the part of each light that smoke lets through to surfaces. Smoke is
 * blurred, so that mostly this is interpolated on a strip's grid (ray_grid.h). */
#ifndef KILN_DRAW_BACKDROP_RAY_GRID_SMOKE_H
#define KILN_DRAW_BACKDROP_RAY_GRID_SMOKE_H

#include "draw/backdrop/ray_grid.h"
#include "draw/light/ray_smoke.h"

/* How much what smoke lets through may bend (bend_around), in parts of a light. */
#define GRID_SMOKE_BEND 0.02f

/* How far corners of a block may lie from each other, in the cells in which smoke is known along
 * each axis. Smoke that is narrower than a block would be missed. */
#define GRID_SMOKE_CELLS 1.0f

/* More than rounding moves a place in a smoke's grid, as a part of the terms that it is the sum of.
 */
#define GRID_SMOKE_ROUNDING 1e-5f

/* Returns whether there is smoke that may hide a light. light: the number of a lamp, GRID_SUN or
 * GRID_SKY. */
static inline bool has_smoke(const struct kiln_ray_frame *frame, uint32_t light)
{
    if (light == GRID_SUN)
        return frame->smoke_to_sun != NULL;
    if (light == GRID_SKY)
        return frame->smoke_to_sky != NULL;
    return frame->lamp_smoke && light < frame->backdrop->counts.y &&
           frame->backdrop->lights[light].casters.z;
}

/* Returns whether light that reaches places in a box may cross smoke (smoke_grid_shades). to_grid:
 * rows of the map from the world to the smoke's grid. */
static inline bool smoke_may_shade(const float4 to_grid[3], const struct kiln_lit_box *box)
{
    bool may = true;
    for (int k = 0; k < 3; k++) {
        const float row[3] = {to_grid[k].x, to_grid[k].y, to_grid[k].z};
        float middle = to_grid[k].w, reach = GRID_SMOKE_ROUNDING * exact_abs(middle);
        for (int c = 0; c < 3; c++) {
            const float at = row[c] * 0.5f * (box->from[c] + box->to[c]);
            middle += at;
            reach += exact_abs(row[c]) * 0.5f * (box->to[c] - box->from[c]) +
                     GRID_SMOKE_ROUNDING * exact_abs(at);
        }
        reach += GRID_SMOKE_ROUNDING;
        may &= middle - reach <= 1.0f && (k == 2 || middle + reach >= 0.0f);
    }
    return may;
}

/* Returns whether smoke may hide a light from places in a box, or from anything (NULL). */
static inline bool has_smoke_before(const struct kiln_ray_frame *frame, uint32_t light,
                                    const struct kiln_lit_box *box)
{
    if (!has_smoke(frame, light))
        return false;
    if (!box || light < GRID_LAMPS)
        return true;
    const struct kiln_draw_backdrop *b = frame->backdrop;
    return box->from[0] <= box->to[0] &&
           smoke_may_shade(light == GRID_SUN ? b->sun_to_grid : b->sky_to_grid, box);
}

/* Returns whether smoke may hide any light from places in a box, or from anything (NULL). */
static inline bool is_smoky(const struct kiln_ray_frame *frame, const struct kiln_lit_box *box)
{
    bool smoky = false;
    for (uint32_t light = 0; light < GRID_SMOKY; light++)
        smoky |= has_smoke_before(frame, light, box);
    return smoky;
}

/* Computes the part of a light that smoke lets through to points. */
SIMD vf find_past_smoke(const struct kiln_ray_frame *frame, uint32_t light,
                        const struct ray_point *p)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    if (light == GRID_SUN)
        return smoke_lets_through(frame->smoke_to_sun, b->sun_to_grid, p);
    if (light == GRID_SKY)
        return smoke_lets_through(frame->smoke_to_sky, b->sky_to_grid, p);
    return smoke_transmittance(lamp_smoke_depth(frame->lamp_smoke, &b->lights[light], p));
}

/* Returns where points lie in what is known of the smoke before a light: in cells along the axes of
 * a grid, or of a lamp's map. */
SIMD struct vf3 smoke_cells_of(const struct kiln_ray_frame *frame, uint32_t light, struct vf3 at)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    if (light < GRID_LAMPS) {
        const struct kiln_draw_light *lamp = &b->lights[light];
        const struct vf3 towards = vf3_towards(lamp->position_radius2, at);
        const struct lamp_smoke_place place =
            lamp_smoke_place_of(vf3_scale(towards, vf_all(-1.0f)), *lamp);
        return (struct vf3){place.x, place.y, place.layer};
    }
    const float4 *to_grid = light == GRID_SUN ? b->sun_to_grid : b->sky_to_grid;
    const float cells = (float)KILN_SMOKE_GRID;
    const struct vf3 place = smoke_grid_place(to_grid[0], to_grid[1], to_grid[2], at);
    return (struct vf3){place.x * cells, place.y * cells, vf_clamp(place.z, 0.0f, 1.0f) * cells};
}

/* Returns the blocks whose corners lie at most GRID_SMOKE_CELLS from each other, of LANES blocks.
 * cells: of the nodes, along an axis. */
SIMD vi are_corners_near(const float *cells, vi node)
{
    vf least = vf_gather(cells, node), most = least;
    for (int32_t corner = 1; corner < 4; corner++) {
        const vf other = vf_gather(cells, node + (corner % 2 + corner / 2 * GRID_COLUMNS));
        least = vf_min(least, other);
        most = vf_max(most, other);
    }
    return most - least <= GRID_SMOKE_CELLS;
}

/* Finds the blocks in which what smoke lets through of a light may be interpolated. */
SIMD void judge_smoke_of(const struct kiln_ray_frame *frame, uint32_t light,
                         struct light_grid *grid)
{
    float cells[3][GRID_NODE_ROOM];
    for (int first = 0; first < GRID_NODES; first += LANES) {
        const struct ray_point p = {load_vector(grid->at, first), load_vector(grid->normal, first),
                                    vf_load(grid->surface + first) >= 0.0f};
        vf_store(grid->past_smoke[light] + first,
                 vf_select(p.active, find_past_smoke(frame, light, &p), vf_all(-1.0f)));
        const struct vf3 in_smoke = smoke_cells_of(frame, light, p.at);
        vf_store(cells[0] + first, in_smoke.x);
        vf_store(cells[1] + first, in_smoke.y);
        vf_store(cells[2] + first, in_smoke.z);
    }
    int32_t near_blocks[GRID_BLOCKS];
    for (int first = 0; first < GRID_BLOCKS; first += LANES) {
        const vi node = grid_blocks_from(first).node;
        const vi all = vi_load(grid->alike + first) & are_corners_near(cells[0], node) &
                       are_corners_near(cells[1], node) & are_corners_near(cells[2], node);
        memcpy(near_blocks + first, &all, sizeof all);
    }
    judge_bend(grid->past_smoke[light], GRID_SMOKE_BEND, near_blocks, grid->smoke_smooth[light]);
}

/* Returns the part of a light that smoke lets through to points. place: in the grid, or NULL. */
SIMD vf past_smoke(const struct kiln_ray_frame *frame, uint32_t light, const struct ray_point *p,
                   const struct grid_place *place)
{
    if (!(place ? place->grid->smoky[light] : has_smoke(frame, light)))
        return vf_all(1.0f);
    vf part = vf_all(1.0f);
    vi known = vi_all(0);
    if (place)
        known = grid_between(place, place->grid->past_smoke[light],
                             place->grid->smoke_smooth[light], &part);
    const struct ray_point others = {p->at, p->normal, p->active & ~known};
    const vf found = any(others.active) ? find_past_smoke(frame, light, &others) : vf_all(1.0f);
    return vf_select(known, part, found);
}

#endif
