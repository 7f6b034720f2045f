/* A surface cache keeps what the rays of technique backdrop=cpu hit, and what the hits see of sun,
 * sky and lamps. Where the camera and all objects stand still, a picture under other light takes
 * these numbers from the cache and traces nothing. The numbers are those that tracing gives, so the
 * pictures are the same bytes. The cache is filled while the second picture of the same surfaces is
 * drawn. */
#ifndef KILN_DRAW_BACKDROP_SURFACE_CACHE_H
#define KILN_DRAW_BACKDROP_SURFACE_CACHE_H

#include "base/footprint.h"
#include "draw/backdrop/backdrop_inputs.h"
#include "draw/backdrop/casters.h"

/* Pixels of a row that are in one vector of rays; the others of it are in the rows below. */
enum { KILN_CACHE_COLUMNS = 4 };

/* Numbers of the planes of a vector of rays. A plane holds a float for each ray. */
enum {
    KILN_CACHE_T,
    KILN_CACHE_SURFACE,
    KILN_CACHE_NORMAL,                         /* 3 planes */
    KILN_CACHE_ALBEDO = KILN_CACHE_NORMAL + 3, /* 3; the colour of the sky where nothing is hit */
    KILN_CACHE_SUN = KILN_CACHE_ALBEDO + 3,    /* part of the sun that is seen past objects */
    KILN_CACHE_SKY,                            /* part of the sky that is seen past objects */
    KILN_CACHE_MARKED,                         /* the surface, marked by kiln_rays_mark_edges */
    KILN_CACHE_PIECE = KILN_CACHE_MARKED,      /* of a sample: the piece of surface that it is on */
    KILN_CACHE_PLANES, /* then 3 for the colour of haze, if the cache has it, and one a lamp */
};

/* Holds vectors of pixels at edges in KILN_EDGE_TILE rows of the picture. */
struct kiln_cached_edges {
    uint32_t count, room;    /* vectors */
    int32_t *columns, *rows; /* of each pixel */
    float *rays;             /* KILN_EDGE_SAMPLES rays of each vector after each other */
};

enum kiln_cache_use {
    KILN_CACHE_UNUSED, /* for this picture */
    KILN_CACHE_FILLED, /* its centres hold; a pixel that is now at an edge may not be in it yet */
    KILN_CACHE_TO_FILL,
};

/* Flags of a pixel. */
enum { KILN_PIXEL_IS_CACHED = 1, KILN_PIXEL_IS_EDGE = 2 };

struct kiln_surface_cache {
    enum kiln_cache_use use;
    uint32_t width, height; /* px; the width in whole strips */
    uint32_t lanes;
    uint32_t rays;       /* for a ray from the eye: itself, and its reflection in a glossy floor */
    uint32_t planes;     /* of a vector of rays */
    uint32_t haze;       /* the first plane of haze; 0: its colour is not kept */
    uint32_t first_lamp; /* the first plane of lamps */
    /* The lamps that have a plane, and those whose plane holds. */
    struct kiln_lamp_set has_plane, lamps;
    float *centers;
    uint8_t *flags;                     /* of pixels */
    struct kiln_lit_box *strips;        /* around what strips show (casters.h), by row */
    struct kiln_cached_edges *edges;    /* of each KILN_EDGE_TILE rows */
    struct kiln_backdrop_inputs *shown; /* of the picture before, of its surfaces alone */
    struct kiln_draw_light *lights;     /* of the picture before, as far as shadows go */
    size_t floats;                      /* that `centers` has room for */
};

/* Creates a cache; NULL with an error. lanes: width of vectors. */
struct kiln_surface_cache *kiln_surface_cache_create(const struct kiln_scene *scene, uint32_t lanes,
                                                     struct kiln_error *error);
void kiln_surface_cache_destroy(struct kiln_surface_cache **cache);

/* Adds the memory of the cache of a scene whose camera stands still. */
void kiln_surface_cache_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Decides what a picture may take from the cache and whether it fills it. Where memory is short,
 * the cache is not used. */
void kiln_surface_cache_begin(struct kiln_surface_cache *cache,
                              const struct kiln_backdrop_inputs *inputs);

/* Returns the floats of a ray from the eye and its reflection, for a vector of rays. */
static inline size_t kiln_cache_ray(const struct kiln_surface_cache *cache)
{
    return (size_t)cache->rays * cache->planes * cache->lanes;
}

#endif
