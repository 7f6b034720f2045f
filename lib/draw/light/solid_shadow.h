/* This header declares the shadow of opaque particles, spheres and meshes: lists of those that may
 * lie between a place and the sun, by bins across the sun's direction. Techniques of drawing
 * compute the exact cover of each sphere from them (shaders/draw/light/solid_shadow.glsl), so that
 * a shadow is as sharp as the sun is small. Meshes have silhouettes in tiles; spheres with as large
 * a shadow stand for them where the sun's disc blurs the silhouettes, or where meshes are too many
 * for tiles. */
#ifndef KILN_DRAW_LIGHT_SOLID_SHADOW_H
#define KILN_DRAW_LIGHT_SOLID_SHADOW_H

#include "base/thread.h"
#include "draw/moment/living.h"
#include "draw/moment/shapes.h"

/* Holds the lists of one moment; they are valid until the next run. */
struct kiln_solid_bins {
    uint32_t edge;            /* bins in each direction; 0: there is no solid */
    float4 world_to_bin[2];   /* rows: a world position to bins */
    const uint32_t *bins;     /* two numbers a bin, in rows of `edge`: first entry, entries */
    const float4 *list;       /* world position and radius of a sphere, m */
    size_t entry_count, rows; /* rows: of KILN_SOLID_ROW entries that there is memory for */
    const float4 *tiles;      /* of meshes, for each entry: where its tile starts in the atlas, in
                               * texels; half of its width, m; and in texels, or 0: it is a sphere.
                               * NULL: none has one, here and below */
    const float *silhouettes; /* as of kiln_instance_tiles_texels */
    uint32_t longest;         /* entries of the bin with the most */
};

struct kiln_solid_shadow;

/* NULL with an error. The scene and the meshes of its particles must outlive it. */
struct kiln_solid_shadow *kiln_solid_shadow_create(const struct kiln_scene *scene,
                                                   const struct kiln_instances *meshes,
                                                   struct kiln_error *error);
void kiln_solid_shadow_destroy(struct kiln_solid_shadow **shadow);

/* Lists the living solids, whatever the order in which they will be drawn. */
bool kiln_solid_shadow_run(struct kiln_solid_shadow *shadow, const struct kiln_moment *moment,
                           struct kiln_threads *threads, struct kiln_solid_bins *bins,
                           struct kiln_error *error);

#endif
