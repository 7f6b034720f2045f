/* This file casts the rays of the backdrop's picture for technique backdrop=cpu, a vector of rays
 * at a time. */
#include <assert.h>
#include <string.h>

#include "draw/backdrop/backdrop_rows.h"
#include "draw/backdrop/ray_casters.h"
#include "draw/backdrop/ray_samples.h"

static_assert((int)TILE == (int)GRID_HEIGHT && (int)STRIP == (int)GRID_WIDTH,
              "a strip of the picture has a grid");
static_assert((int)KILN_CACHE_COLUMNS == (int)GRID_STEP, "the cache has the vectors of strips");

/* ---- rows ------------------------------------------------------------------------------------ */

/* Returns the shapes that may be visible in TILE + 1 rows from y, in `width` columns from x. */
static struct kiln_shape_set find_shapes(const struct kiln_backdrop_picture *p, uint32_t x,
                                         uint32_t y, uint32_t width)
{
    const int32_t left = (int32_t)x, top = (int32_t)y, right = left + (int32_t)width;
    struct kiln_shape_set shapes = kiln_shape_set_empty(p->frame->shapes->counts.x);
    for (uint32_t i = 0; i < p->frame->shapes->counts.x; i++) {
        const struct kiln_pixel_box *b = &p->boxes[i];
        if (b->x_from < right && b->x_to > left && b->y_from <= top + TILE && b->y_to > top)
            kiln_shape_set_add(&shapes, i);
    }
    return shapes;
}

/* Returns the lights that objects may hide and whose shadows are not in the cache. */
static struct grid_lights find_shadow_lights(const struct kiln_backdrop_picture *p,
                                             const struct kiln_casters *casters)
{
    const struct kiln_draw_backdrop *b = p->frame->backdrop;
    struct grid_lights lights = {.sky = p->frame->shapes->counts.z > 0 ||
                                        kiln_shape_set_any(&p->frame->all_casters->sun_objects)};
    for (uint32_t i = 0; i < b->counts.y; i++) {
        if (b->lights[i].casters.y || kiln_shape_set_any(&casters->lamps[i]))
            kiln_bits_add(lights.lamps.words, i);
    }
    if (p->use == KILN_CACHE_FILLED)
        lights = (struct grid_lights){kiln_lamps_without(&lights.lamps, &p->cache->lamps), false};
    return lights;
}

/* Places nodes of a strip's reflections where the nodes of the strip are on the floor. */
SIMD void place_mirrored_nodes(const struct kiln_ray_frame *frame, int first, const struct ray *ray,
                               const struct ray_hit *hit, vi within, struct light_grid *mirrored)
{
    const vi floor = within & (hit->surface == 0.0f);
    const struct vf3 at = ray_at(ray, hit->t);
    if (!any(floor)) {
        place_nodes(first, hit, at, floor, mirrored);
        return;
    }
    const struct ray reflected = {at, floor_reflection_along(frame, ray).at.direction};
    const struct ray_place nowhere = {.layer = -1};
    const struct ray_hit seen =
        trace(frame, frame->all_shapes, &reflected, vf_all(2.0f * RAY_FAR), &nowhere);
    place_nodes(first, &seen, ray_at(&reflected, seen.t), floor, mirrored);
}

/* Places the nodes of the strip at (x, y), and of its reflections (NULL: none). */
static void place_grids(const struct kiln_backdrop_picture *p, const struct kiln_shape_set *shapes,
                        uint32_t x, uint32_t y, struct light_grid *grid,
                        struct light_grid *mirrored)
{
    const struct kiln_ray_frame *frame = p->frame;
    const vi width = vi_all((int32_t)p->width), height = vi_all((int32_t)p->height);
    for (int i = 0; i < GRID_NODES; i += LANES) {
        const vi node = vi_count() + i, above = vi_of((vf_of(node) + 0.5f) * (1.0f / GRID_COLUMNS));
        vi column = (node - above * GRID_COLUMNS) * GRID_STEP + (int32_t)x;
        vi row = above * GRID_STEP + (int32_t)y;
        const vi within = (column < width) & (row < height);
        column = vi_select(column < width, column, width - 1);
        row = vi_select(row < height, row, height - 1);
        const struct eye_rays eye = rays_through_pixels(frame, column, row);
        const struct ray_hit hit =
            trace(frame, shapes, &eye.ray, find_floor(frame, &eye.ray), &eye.place);
        place_nodes(i, &hit, ray_at(&eye.ray, hit.t), within, grid);
        if (mirrored)
            place_mirrored_nodes(frame, i, &eye.ray, &hit, within, mirrored);
    }
}

/* Returns the numbers of the surfaces that rays hit, by which edges are found. */
SIMD vf mark_surfaces(const struct kiln_ray_frame *frame, const struct eye_rays *eye,
                      const struct ray_hit *first, const struct cached_rays *cached)
{
    if (is_filled(cached))
        return read_cached(cached, KILN_CACHE_MARKED);
    vf surface = first->surface;
    if (frame->meshes)
        KILN_SIMD_NAME(kiln_rays_mark_edges)(frame, &eye->place, first, &surface);
    fill_cached(cached, KILN_CACHE_MARKED, surface);
    return surface;
}

enum { STRIP_VECTORS = TILE * STRIP / LANES };

/* Holds what the rays through the centres of a strip's pixels hit, by vector. */
struct strip_hits {
    struct ray_hit hits[STRIP_VECTORS];
};

/* Holds the rays of a vector of pixels. */
struct strip_pixels {
    uint32_t x, y;          /* of the first pixel */
    uint32_t columns, rows; /* that are in the picture */
    struct eye_rays eye;
    struct cached_rays cached;
};

/* Begins with vector i of the strip at (x, y). Returns false if it is beside the picture. */
SIMD bool begin_pixels(const struct kiln_backdrop_picture *p, uint32_t x, uint32_t y, uint32_t i,
                       struct strip_pixels *pixels)
{
    x += i % GRID_BLOCKS_A_ROW * GRID_STEP;
    y += i / GRID_BLOCKS_A_ROW * GRID_VECTOR_ROWS;
    if (x >= p->width || y >= p->height)
        return false;
    const uint32_t columns = p->width - x, rows = p->height - y;
    const vi column = grid_lane_columns() + (int32_t)x, row = grid_lane_rows() + (int32_t)y;
    const vi last_column = vi_all((int32_t)p->width - 1), last_row = vi_all((int32_t)p->height - 1);
    pixels->x = x;
    pixels->y = y;
    pixels->columns = columns < GRID_STEP ? columns : GRID_STEP;
    pixels->rows = rows < GRID_VECTOR_ROWS ? rows : GRID_VECTOR_ROWS;
    pixels->eye =
        rays_through_pixels(p->frame, vi_select(column < last_column, column, last_column),
                            vi_select(row < last_row, row, last_row));
    pixels->cached = cached_centers(p->cache, p->use, x, y);
    return true;
}

/* Stores numbers of a vector of pixels, `size` floats each, into a picture. */
SIMD void store_pixels(const struct kiln_backdrop_picture *p, const struct strip_pixels *pixels,
                       const float *numbers, size_t size, float *picture)
{
    float *to = picture + ((size_t)pixels->y * p->width + pixels->x) * size;
    const size_t columns = pixels->columns * size;
    for (uint32_t row = 0; row < pixels->rows; row++)
        memcpy(to + (size_t)row * p->width * size, numbers + (size_t)row * GRID_STEP * size,
               columns * sizeof *to);
}

/* Returns where the cache keeps the box around what the strip at (x, y) shows. */
static struct kiln_lit_box *box_in_cache(const struct kiln_surface_cache *cache, uint32_t x,
                                         uint32_t y)
{
    return &cache->strips[((size_t)y / TILE * cache->width + x) / STRIP];
}

/* Finds what the pixels of the strip at (x, y) show. Returns a box around it and the grid's nodes
 * (NULL: none). */
static struct kiln_lit_box trace_strip(const struct kiln_backdrop_picture *p,
                                       const struct kiln_shape_set *shapes, uint32_t x, uint32_t y,
                                       const struct light_grid *grid, struct strip_hits *strip)
{
    struct lit_vectors lit = no_lit_vectors();
    for (int i = 0; grid && i < GRID_NODES; i += LANES)
        add_lit(&lit, load_vector(grid->at, i),
                (vf_load(grid->surface + i) >= 0.0f) & (vi_count() + i < GRID_NODES));
    for (uint32_t i = 0; i < STRIP_VECTORS; i++) {
        struct strip_pixels pixels;
        if (!begin_pixels(p, x, y, i, &pixels))
            continue;
        const struct ray_hit hit =
            find_hit(p->frame, shapes, &pixels.eye.ray, &pixels.eye.place, &pixels.cached);
        add_lit(&lit, ray_at(&pixels.eye.ray, hit.t), hit.surface >= 0.0f);
        strip->hits[i] = hit;
    }
    return lit_box_of(&lit);
}

/* Lights what the pixels of the strip at (x, y) show. grid, mirrored: or NULL. */
static void light_strip(const struct kiln_backdrop_picture *p, uint32_t x, uint32_t y,
                        const struct light_grid *grid, const struct light_grid *mirrored,
                        const struct strip_hits *strip)
{
    const struct kiln_ray_frame *frame = p->frame;
    for (uint32_t i = 0; i < STRIP_VECTORS; i++) {
        struct strip_pixels pixels;
        if (!begin_pixels(p, x, y, i, &pixels))
            continue;
        const struct grid_pixels in_grid = {grid, mirrored, pixels.x - x, pixels.y - y};
        const struct ray_help help = {grid ? &in_grid : NULL, &pixels.cached};
        const struct ray_hit hit =
            p->use == KILN_CACHE_FILLED ? read_cached_hit(&pixels.cached) : strip->hits[i];
        const struct shaded_rays shaded = shade_hits(frame, &pixels.eye.ray, &hit, &help);
        const vf surface = mark_surfaces(frame, &pixels.eye, &hit, &pixels.cached);
        _Alignas(64) float colors[4 * LANES], depths[LANES], surfaces[LANES];
        store_colors(colors, &shaded.color);
        vf_store(depths, hit.t);
        vf_store(surfaces, 4.0f * surface + shaded.light);
        store_pixels(p, &pixels, colors, 4, p->color);
        store_pixels(p, &pixels, depths, 1, p->depth);
        store_pixels(p, &pixels, surfaces, 1, p->surfaces);
    }
}

/* Returns whether a strip needs a grid although no shadow is interpolated. A box that is to be kept
 * has nodes in it, since smoke may come later. box: around what the strip shows, if it is kept. */
static bool needs_grid(const struct kiln_backdrop_picture *p, const struct kiln_lit_box *box)
{
    const bool anywhere = p->use != KILN_CACHE_FILLED || p->frame->floor_gloss; /* reflections */
    return p->use == KILN_CACHE_TO_FILL || is_smoky(p->frame, anywhere ? NULL : box);
}

static void cast_rows(const struct kiln_backdrop_picture *whole, uint32_t y)
{
    struct kiln_backdrop_picture picture = *whole; /* with the casters of a strip */
    struct kiln_ray_frame frame = *whole->frame;
    picture.frame = &frame;
    const struct grid_lights all = find_shadow_lights(whole, frame.all_casters);
    const bool any_light = all.sky || kiln_lamps_any(&all.lamps);
    struct light_grid room, mirrored_room;
    struct strip_hits strip;
    struct kiln_lit_box fresh;
    for (uint32_t x = 0; x < whole->width; x += STRIP) {
        struct kiln_lit_box *lit =
            whole->use == KILN_CACHE_UNUSED ? &fresh : box_in_cache(whole->cache, x, y);
        const bool has_grid = any_light || needs_grid(whole, lit);
        struct light_grid *grid = has_grid ? &room : NULL;
        struct light_grid *mirrored = has_grid && frame.floor_gloss ? &mirrored_room : NULL;
        /* with a column and a row more, for the nodes */
        const struct kiln_shape_set shapes = find_shapes(whole, x, y, STRIP + 1);
        if (grid)
            place_grids(whole, &shapes, x, y, grid, mirrored);
        if (whole->use != KILN_CACHE_FILLED)
            *lit = trace_strip(whole, &shapes, x, y, grid, &strip);
        const struct kiln_casters casters = find_casters(whole->frame, lit);
        frame.casters = &casters;
        if (grid) {
            KILN_SIMD_NAME(kiln_rays_judge_grid)
            (&frame, find_shadow_lights(&picture, &casters), grid);
            KILN_SIMD_NAME(kiln_rays_judge_smoke)(&frame, lit, grid);
        }
        if (mirrored) {
            KILN_SIMD_NAME(kiln_rays_judge_grid)(whole->frame, all, mirrored);
            KILN_SIMD_NAME(kiln_rays_judge_smoke)(whole->frame, NULL, mirrored);
        }
        light_strip(&picture, x, y, grid, mirrored, &strip);
    }
}

/* ---- edges in the cache ---------------------------------------------------------------------- */

/* Flags listed pixels as edges, and leaves those out of the list that are in the cache. Returns how
 * many are left. */
static int take_out_cached(const struct kiln_surface_cache *cache, int count,
                           int32_t at[2][EDGE_ROOM])
{
    int left = 0;
    for (int i = 0; i < count; i++) {
        uint8_t *flags = &cache->flags[(size_t)at[1][i] * cache->width + (size_t)at[0][i]];
        at[0][left] = at[0][i];
        at[1][left] = at[1][i];
        left += !(*flags & KILN_PIXEL_IS_CACHED);
        *flags |= KILN_PIXEL_IS_EDGE;
    }
    return left;
}

/* Adds a vector of pixels to the cache if it has room. Returns whether it has. */
static bool add_to_cache(const struct kiln_surface_cache *cache, struct kiln_cached_edges *edges,
                         vi column, vi row, struct cached_rays *cached)
{
    if (edges->count == edges->room)
        return false;
    memcpy(edges->columns + (size_t)edges->count * LANES, &column, sizeof column);
    memcpy(edges->rows + (size_t)edges->count * LANES, &row, sizeof row);
    for (int i = 0; i < LANES; i++)
        cache->flags[(size_t)row[i] * cache->width + (size_t)column[i]] |= KILN_PIXEL_IS_CACHED;
    *cached = cached_samples(cache, edges, edges->count++, KILN_CACHE_TO_FILL);
    return true;
}

/* Lights the cached pixels that are at edges in this picture. */
static void light_cached_edges(const struct kiln_backdrop_picture *p,
                               const struct kiln_cached_edges *edges, uint32_t count)
{
    const struct kiln_surface_cache *cache = p->cache;
    const struct kiln_shape_set none = kiln_shape_set_empty(0);
    for (uint32_t k = 0; k < count; k++) {
        vi column, row;
        memcpy(&column, edges->columns + (size_t)k * LANES, sizeof column);
        memcpy(&row, edges->rows + (size_t)k * LANES, sizeof row);
        vi edge;
        for (int i = 0; i < LANES; i++)
            edge[i] = -((cache->flags[(size_t)row[i] * cache->width + (size_t)column[i]] &
                         KILN_PIXEL_IS_EDGE) != 0);
        if (!any(edge))
            continue;
        const struct cached_rays cached = cached_samples(cache, edges, k, KILN_CACHE_FILLED);
        antialias_cached(p, &none, column, row, edge, &cached);
    }
}

static void forget_edges(const struct kiln_surface_cache *cache, uint32_t y, uint32_t y_to)
{
    uint8_t *flags = cache->flags + (size_t)y * cache->width;
    for (size_t i = 0; i < (size_t)(y_to - y) * cache->width; i++)
        flags[i] &= KILN_PIXEL_IS_CACHED;
}

/* ---- rows of edges --------------------------------------------------------------------------- */

/* Antialiases listed pixels of EDGE_STRIP columns from x. edges: NULL without a cache. */
static void antialias_listed(const struct kiln_backdrop_picture *p, uint32_t x, uint32_t y,
                             int count, int32_t at[2][EDGE_ROOM], struct kiln_cached_edges *edges)
{
    if (count == 0)
        return;
    const struct kiln_shape_set shapes = find_shapes(p, x, y, EDGE_STRIP);
    for (int i = 1; i < LANES; i++) { /* the last vector repeats its last pixel */
        at[0][count - 1 + i] = at[0][count - 1];
        at[1][count - 1 + i] = at[1][count - 1];
    }
    int i = 0;
    struct cached_rays cached;
    for (; i < count && edges; i += LANES) {
        const vi column = vi_load(at[0] + i), row = vi_load(at[1] + i);
        if (!add_to_cache(p->cache, edges, column, row, &cached))
            break;
        antialias_cached(p, &shapes, column, row, vi_count() < count - i, &cached);
    }
    for (; i < count; i += SAMPLED_PIXELS) {
        const int some = count - i < SAMPLED_PIXELS ? count - i : SAMPLED_PIXELS;
        antialias_together(p, &shapes, some, at[0] + i, at[1] + i);
    }
}

static void antialias_rows(const struct kiln_backdrop_picture *p, uint32_t y)
{
    int32_t at[2][EDGE_ROOM];
    struct kiln_cached_edges *edges =
        p->use == KILN_CACHE_UNUSED ? NULL : &p->cache->edges[y / TILE];
    const uint32_t cached = edges ? edges->count : 0;
    if (edges)
        forget_edges(p->cache, y, rows_from(p, y));
    for (uint32_t x = 0; x < p->width; x += EDGE_STRIP) {
        int count = 0;
        for (uint32_t strip = x; strip < x + EDGE_STRIP && strip < p->width; strip += STRIP)
            count = list_edges(p, strip, y, count, at);
        if (edges)
            count = take_out_cached(p->cache, count, at);
        antialias_listed(p, x, y, count, at, edges);
    }
    if (edges)
        light_cached_edges(p, edges, cached);
}

const struct kiln_backdrop_rows KILN_SIMD_NAME(kiln_backdrop_rows) = {
    .lanes = LANES,
    .cast = cast_rows,
    .antialias = antialias_rows,
};
