/* This file decides when surfaces are kept, and for which lamps. Two pictures in a row that show
 * the same surfaces are taken for a sign that more will follow. */
#include "draw/backdrop/surface_cache.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"

enum {
    STRIP = 64, /* px; rows are stored in whole strips */
    /* Pixels at edges that have room, as a multiple of a row's, for each KILN_EDGE_TILE rows. */
    EDGE_ROWS = 2,
};

static uint32_t tiles_of(const struct kiln_surface_cache *cache)
{
    return (cache->height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
}

static uint32_t width_of(const struct kiln_scene *scene)
{
    return (scene->width + STRIP - 1) / STRIP * STRIP;
}

static uint32_t rays_of(const struct kiln_scene *scene)
{
    return kiln_shape_features(scene).floor_gloss ? 2 : 1;
}

struct kiln_surface_cache *kiln_surface_cache_create(const struct kiln_scene *scene, uint32_t lanes,
                                                     struct kiln_error *error)
{
    struct kiln_surface_cache *cache = calloc(1, sizeof *cache);
    if (cache) {
        cache->width = width_of(scene);
        cache->height = scene->height;
        cache->lanes = lanes;
        cache->rays = rays_of(scene);
        cache->flags = calloc((size_t)cache->width * cache->height, sizeof *cache->flags);
        cache->edges = calloc(tiles_of(cache), sizeof *cache->edges);
        cache->strips =
            calloc((size_t)tiles_of(cache) * (cache->width / STRIP), sizeof *cache->strips);
        cache->shown = calloc(1, sizeof *cache->shown);
        cache->lights = calloc(KILN_MOST_LAMPS, sizeof *cache->lights);
    }
    if (!cache || !cache->flags || !cache->edges || !cache->strips || !cache->shown ||
        !cache->lights) {
        kiln_error_no_memory(error, "the backdrop");
        kiln_surface_cache_destroy(&cache);
    }
    return cache;
}

void kiln_surface_cache_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_surface_cache *c = NULL;
    const struct kiln_cached_edges *e = NULL;
    const bool haze = kiln_scene_value_max(scene, &scene->backdrop.haze) > 0.0f;
    const uint64_t tiles = (scene->height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    const uint64_t planes = KILN_CACHE_PLANES + (haze ? 3u : 0u) + kiln_scene_shadow_lights(scene);
    const uint64_t ray = rays_of(scene) * planes * sizeof *c->centers;
    const uint64_t edges = tiles * EDGE_ROWS * width_of(scene); /* pixels that have room */
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, (uint64_t)width_of(scene) * scene->height,
                       ray + sizeof *c->flags);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, edges,
                       KILN_EDGE_SAMPLES * ray + sizeof *e->columns + sizeof *e->rows);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, tiles * (width_of(scene) / STRIP),
                       sizeof *c->strips);
}

static void free_edges(struct kiln_surface_cache *cache)
{
    for (uint32_t i = 0; cache->edges && i < tiles_of(cache); i++) {
        free(cache->edges[i].columns);
        free(cache->edges[i].rows);
        free(cache->edges[i].rays);
        cache->edges[i] = (struct kiln_cached_edges){0};
    }
}

void kiln_surface_cache_destroy(struct kiln_surface_cache **cache)
{
    struct kiln_surface_cache *c = *cache;
    if (!c)
        return;
    free_edges(c);
    free(c->edges);
    free(c->strips);
    free(c->centers);
    free(c->flags);
    free(c->shown);
    free(c->lights);
    free(c);
    *cache = NULL;
}

/* ---- what is the same ------------------------------------------------------------------------ */

/* Copies inputs without all that changes only the light: pictures whose copies are equal show the
 * same surfaces, sun and sky. */
static void keep_surfaces(const struct kiln_backdrop_inputs *inputs,
                          struct kiln_backdrop_inputs *surfaces)
{
    memcpy(surfaces, inputs, sizeof *surfaces);
    struct kiln_draw_backdrop *block = &surfaces->block;
    surfaces->view.clock = surfaces->view.within = surfaces->view.exposure = (float4){0};
    surfaces->view.clock_step = (uint4){0};
    block->counts.y = block->counts.w = 0;
    block->sun_color.w = 0.0f;
    memset(block->lights, 0, sizeof block->lights);
    memset(block->sun_to_grid, 0, sizeof block->sun_to_grid);
    memset(block->sky_to_grid, 0, sizeof block->sky_to_grid);
    surfaces->shapes.counts.w = 0;
    memset(surfaces->shapes.world_to_bin, 0, sizeof surfaces->shapes.world_to_bin);
}

static bool same_surfaces(const struct kiln_backdrop_inputs *a,
                          const struct kiln_backdrop_inputs *b)
{
    return memcmp(&a->view, &b->view, sizeof a->view) == 0 &&
           memcmp(&a->block, &b->block, sizeof a->block) == 0 &&
           memcmp(&a->shapes, &b->shapes, sizeof a->shapes) == 0 && a->paint == b->paint;
}

/* Returns a light without what does not change its shadows of objects. Lights that particles may
 * hide, or nothing hides, get a radius below 0 and are never kept. */
static struct kiln_draw_light keep_shadows(const struct kiln_draw_light *light)
{
    struct kiln_draw_light kept = *light;
    kept.color = (float4){0.0f, 0.0f, 0.0f, light->color.w};
    kept.casters.z = kept.casters.w = 0;
    kept.maps.y = kept.maps.z = kept.maps.w = 0.0f;
    kept.smoke_ahead = kept.smoke_right = (float4){0};
    if (light->casters.y >> KILN_LAMP_SOLID_SHIFT || !(light->casters.x | light->casters.y))
        kept.color.w = -1.0f;
    return kept;
}

/* Replaces the lights of the picture before. Returns the lamps whose shadows are still the same. */
static struct kiln_lamp_set find_still_lamps(struct kiln_surface_cache *cache,
                                             const struct kiln_draw_backdrop *block)
{
    struct kiln_lamp_set still = {.words = {0}};
    for (uint32_t i = 0; i < KILN_MOST_LAMPS; i++) {
        struct kiln_draw_light now = {.color = {0.0f, 0.0f, 0.0f, -1.0f}};
        if (i < block->counts.y)
            now = keep_shadows(&block->lights[i]);
        if (now.color.w >= 0.0f && memcmp(&now, &cache->lights[i], sizeof now) == 0)
            kiln_bits_add(still.words, i);
        cache->lights[i] = now;
    }
    return still;
}

/* ---- filling --------------------------------------------------------------------------------- */

static bool reserve_edges(struct kiln_surface_cache *cache)
{
    const uint32_t vectors = EDGE_ROWS * cache->width / cache->lanes;
    const size_t pixels = (size_t)vectors * cache->lanes;
    const size_t floats = (size_t)vectors * KILN_EDGE_SAMPLES * kiln_cache_ray(cache);
    bool ok = true;
    for (uint32_t i = 0; ok && i < tiles_of(cache); i++) {
        struct kiln_cached_edges *edges = &cache->edges[i];
        edges->room = vectors;
        edges->columns = malloc(pixels * sizeof *edges->columns);
        edges->rows = malloc(pixels * sizeof *edges->rows);
        edges->rays = malloc(floats * sizeof *edges->rays); /* its pages come when they are used */
        ok = edges->columns && edges->rows && edges->rays;
    }
    return ok;
}

/* Makes room for the planes that a picture needs. */
static bool reserve(struct kiln_surface_cache *cache)
{
    const uint32_t tall = cache->lanes / KILN_CACHE_COLUMNS; /* rows of a vector */
    const uint32_t rows = (cache->height + tall - 1) / tall * tall;
    const size_t floats = (size_t)cache->rays * cache->planes * cache->width * rows;
    if (floats == cache->floats)
        return true;
    free(cache->centers);
    free_edges(cache);
    cache->centers = kiln_alloc_pages(floats * sizeof *cache->centers);
    cache->floats = cache->centers && reserve_edges(cache) ? floats : 0;
    return cache->floats > 0;
}

static void start_to_fill(struct kiln_surface_cache *cache,
                          const struct kiln_backdrop_inputs *inputs, struct kiln_lamp_set lamps)
{
    const bool haze = inputs->block.floor_params.z > 0.0f;
    cache->haze = haze ? KILN_CACHE_PLANES : 0;
    cache->first_lamp = KILN_CACHE_PLANES + (haze ? 3 : 0);
    cache->has_plane = cache->lamps = lamps;
    cache->planes = cache->first_lamp + kiln_bits_below(lamps.words, KILN_MOST_LAMPS);
    cache->use = reserve(cache) ? KILN_CACHE_TO_FILL : KILN_CACHE_UNUSED;
    memset(cache->flags, 0, (size_t)cache->width * cache->height);
    for (uint32_t i = 0; i < tiles_of(cache); i++)
        cache->edges[i].count = 0;
}

void kiln_surface_cache_begin(struct kiln_surface_cache *cache,
                              const struct kiln_backdrop_inputs *inputs)
{
    struct kiln_backdrop_inputs surfaces;
    keep_surfaces(inputs, &surfaces);
    const bool same = same_surfaces(&surfaces, cache->shown);
    const bool holds = same && cache->use != KILN_CACHE_UNUSED;
    memcpy(cache->shown, &surfaces, sizeof surfaces);
    const struct kiln_lamp_set still = find_still_lamps(cache, &inputs->block);
    const struct kiln_lamp_set more = kiln_lamps_without(&still, &cache->lamps);
    if (holds && !kiln_lamps_any(&more)) {
        cache->use = KILN_CACHE_FILLED;
        cache->lamps = still;
    } else if (same) {
        start_to_fill(cache, inputs, still);
    } else {
        cache->use = KILN_CACHE_UNUSED;
    }
}
