/* This file visits the tiles of a picture that a domain of gas touches. A grid takes two visits,
 * since pixels at the border of a tile lie between rays of two tiles. */
#include "draw/volume/volume_cast.h"

#include <string.h>

/* Returns the pixels of a picture's edge that have a ray of the grid. */
static uint32_t grid_along(uint32_t pixels)
{
    return (pixels + 1) / 2;
}

size_t kiln_volume_grid_bytes(uint32_t width, uint32_t height)
{
    return (size_t)grid_along(width) * grid_along(height) * VOLUME_RAY * sizeof(float);
}

/* Describes a visit of all tiles. */
struct visit {
    const struct kiln_volume_cast *cast;
    void (*tile)(const struct kiln_volume_march *march, const struct kiln_volume_tile *tile);
};

/* Notes that gas may lie in a tile. */
static void touch(const struct kiln_volume_cast *cast, size_t tile, float near_m)
{
    if (cast->march->profiles)
        cast->march->profiles->near_m[tile] = near_m;
    cast->touched[tile] = 1;
}

/* Visits the tiles of rows of tiles that gas touches. */
static void visit_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct visit *visit = context;
    const struct kiln_volume_cast *cast = visit->cast;
    const uint32_t across = kiln_tiles_along(cast->march->width);
    for (size_t row = begin; row < end; row++)
        for (uint32_t x = 0; x < across; x++) {
            const size_t number = row * across + x;
            const struct kiln_tile_depths depths = cast->tiles->depths[number];
            const struct kiln_volume_tile tile = {x * VOLUME_TILE, (uint32_t)row * VOLUME_TILE,
                                                  depths.near_m, depths.far_m};
            if (!(depths.near_m < depths.far_m))
                continue;
            touch(cast, number, depths.near_m);
            visit->tile(cast->march, &tile);
        }
}

/* Sets rows of the grid to rays that see no gas. */
static void empty_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_volume_march *m = context;
    for (size_t row = begin; row < end; row++)
        for (uint32_t column = 0; column < m->grid_across; column++) {
            float *ray = kiln_volume_grid_ray(m, column, (uint32_t)row);
            memset(ray, 0, VOLUME_RAY * sizeof *ray);
            ray[VOLUME_RAY_END] = kiln_volume_ray_end(m, 2 * (row * m->width + column));
        }
}

/* Sets up the grid of a domain whose tiles have been found. */
static void place_grid(const struct kiln_volume_cast *cast)
{
    struct kiln_volume_march *m = cast->march;
    const size_t tiles = (size_t)kiln_tiles_along(m->width) * kiln_tiles_along(m->height);
    m->grid = cast->grid;
    m->grid_across = grid_along(m->width);
    m->grid_down = grid_along(m->height);
    m->far_m = m->near_m;
    for (size_t i = 0; i < tiles; i++)
        m->far_m = exact_max(m->far_m, cast->tiles->depths[i].far_m);
}

/* Marches through all tiles in GL. */
static bool cast_in_gl(const struct kiln_volume_cast *cast, struct kiln_error *error)
{
    const size_t tiles =
        (size_t)kiln_tiles_along(cast->march->width) * kiln_tiles_along(cast->march->height);
    for (size_t i = 0; i < tiles; i++) {
        const struct kiln_tile_depths depths = cast->tiles->depths[i];
        if (depths.near_m < depths.far_m)
            touch(cast, i, depths.near_m);
    }
    return kiln_volume_gl_march(cast->gl, cast->march, cast->tiles, cast->same_field, error);
}

bool kiln_volume_cast(const struct kiln_volume_cast *cast, struct kiln_threads *threads,
                      struct kiln_error *error)
{
    const uint32_t down = kiln_tiles_along(cast->march->height);
    struct visit visit = {cast, cast->rows->draw};
    if (!kiln_volume_tiles_find(cast->tiles, cast->march, threads, error))
        return false;
    if (cast->gl)
        return cast_in_gl(cast, error);
    if (!cast->grid)
        return kiln_threads_try(threads, down, 1, visit_rows, &visit, error);
    place_grid(cast);
    visit.tile = cast->rows->march_grid;
    if (!kiln_threads_try(threads, cast->march->grid_down, 32, empty_rows, cast->march, error) ||
        !kiln_threads_try(threads, down, 1, visit_rows, &visit, error))
        return false;
    visit.tile = cast->rows->draw_between;
    return kiln_threads_try(threads, down, 1, visit_rows, &visit, error);
}
