/* This header reads and writes what vectors of rays have in the surface cache. */
#ifndef KILN_DRAW_BACKDROP_RAY_CACHE_H
#define KILN_DRAW_BACKDROP_RAY_CACHE_H

#include "draw/backdrop/ray_shapes.h"
#include "draw/backdrop/surface_cache.h"

/* Describes the planes of a vector of rays. */
struct cached_rays {
    enum kiln_cache_use use;
    const struct kiln_surface_cache *cache; /* unset if it is not used, as the planes are */
    float *planes;
};

/* Describes rays of which nothing is kept. */
SIMD struct cached_rays not_cached(void)
{
    return (struct cached_rays){.use = KILN_CACHE_UNUSED};
}

SIMD bool is_filled(const struct cached_rays *rays)
{
    return rays->use == KILN_CACHE_FILLED;
}

SIMD vf read_cached(const struct cached_rays *rays, uint32_t plane)
{
    return vf_load(rays->planes + (size_t)plane * LANES);
}

SIMD struct vf3 read_cached3(const struct cached_rays *rays, uint32_t plane)
{
    return (struct vf3){read_cached(rays, plane), read_cached(rays, plane + 1),
                        read_cached(rays, plane + 2)};
}

/* Fills a plane if it is to be filled. */
SIMD void fill_cached(const struct cached_rays *rays, uint32_t plane, vf x)
{
    if (rays->use == KILN_CACHE_TO_FILL)
        vf_store(rays->planes + (size_t)plane * LANES, x);
}

SIMD void fill_cached3(const struct cached_rays *rays, uint32_t plane, struct vf3 v)
{
    fill_cached(rays, plane, v.x);
    fill_cached(rays, plane + 1, v.y);
    fill_cached(rays, plane + 2, v.z);
}

SIMD struct ray_hit read_cached_hit(const struct cached_rays *rays)
{
    return (struct ray_hit){.t = read_cached(rays, KILN_CACHE_T),
                            .surface = read_cached(rays, KILN_CACHE_SURFACE),
                            .normal = read_cached3(rays, KILN_CACHE_NORMAL),
                            .albedo = read_cached3(rays, KILN_CACHE_ALBEDO)};
}

SIMD void fill_cached_hit(const struct cached_rays *rays, const struct ray_hit *hit)
{
    fill_cached(rays, KILN_CACHE_T, hit->t);
    fill_cached(rays, KILN_CACHE_SURFACE, hit->surface);
    fill_cached3(rays, KILN_CACHE_NORMAL, hit->normal);
    fill_cached3(rays, KILN_CACHE_ALBEDO, hit->albedo);
}

/* Returns the plane of lamp i; 0: it has none that holds. */
SIMD uint32_t plane_of_lamp(const struct cached_rays *rays, uint32_t i)
{
    if (rays->use == KILN_CACHE_UNUSED || !kiln_bits_have(rays->cache->lamps.words, i))
        return 0;
    return rays->cache->first_lamp + kiln_bits_below(rays->cache->has_plane.words, i);
}

/* Returns the planes of the reflections of rays from the eye. */
SIMD struct cached_rays cached_reflections(const struct cached_rays *rays)
{
    struct cached_rays reflections = *rays;
    if (rays->use != KILN_CACHE_UNUSED)
        reflections.planes += (size_t)rays->cache->planes * LANES;
    return reflections;
}

/* Returns the planes of the vector whose first pixel is at (x, y). */
SIMD struct cached_rays cached_centers(const struct kiln_surface_cache *cache,
                                       enum kiln_cache_use use, uint32_t x, uint32_t y)
{
    if (use == KILN_CACHE_UNUSED)
        return not_cached();
    const uint32_t rows = LANES / KILN_CACHE_COLUMNS;
    const size_t vector = ((size_t)(y / rows) * cache->width + x) / KILN_CACHE_COLUMNS;
    return (struct cached_rays){use, cache, cache->centers + vector * kiln_cache_ray(cache)};
}

/* Returns the planes of the first sample of a vector of pixels at edges. */
SIMD struct cached_rays cached_samples(const struct kiln_surface_cache *cache,
                                       const struct kiln_cached_edges *edges, uint32_t vector,
                                       enum kiln_cache_use use)
{
    const size_t first = (size_t)vector * KILN_EDGE_SAMPLES * kiln_cache_ray(cache);
    return (struct cached_rays){use, cache, edges->rays + first};
}

/* Returns the planes of another sample. first: of the first one. */
SIMD struct cached_rays cached_sample(const struct cached_rays *first, int sample)
{
    struct cached_rays rays = *first;
    rays.planes += (size_t)sample * kiln_cache_ray(first->cache);
    return rays;
}

#endif
