/* This header declares the shadows of opaque particles, which are spheres or meshes. Bins lie
 * across the sun's direction; the list of a bin has the particles that may hide the sun from places
 * in it. Drawing techniques compute the exact cover of each sphere from the lists
 * (shaders/draw/light/solid_shadow.glsl), so that a shadow is as sharp as the sun is small. Meshes
 * have silhouettes in tiles. A sphere with as large a shadow stands for a mesh where the sun's disc
 * blurs its silhouette, or where meshes are too many for tiles. */
#ifndef KILN_DRAW_LIGHT_SOLID_SHADOW_H
#define KILN_DRAW_LIGHT_SOLID_SHADOW_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/moment/appearance.h"
#include "draw/moment/shapes.h"

/* Holds the lists of one moment; they are valid until the next run. */
struct kiln_solid_bins {
    uint32_t edge;            /* bins in each direction; 0: there is no solid */
    float4 world_to_bin[2];   /* rows: a world position to bins */
    const uint32_t *bins;     /* first entry and entry count of each bin, in rows of `edge` */
    const float4 *list;       /* world position and radius of a sphere, m */
    size_t entry_count, rows; /* rows: of KILN_SOLID_ROW entries, as allocated */
    const float4 *tiles; /* of each entry: where its tile starts in the atlas, in texels; half of
                          * the tile's width, m; the width in texels, or 0 for a sphere. NULL: no
                          * entry has a tile, here and below */
    const float *silhouettes; /* as of kiln_instance_tiles_texels */
    uint32_t longest;         /* number of entries of the longest list */
};

struct kiln_solid_shadow;

/* Returns NULL with an error. The scene and the meshes of its particles must outlive the result. */
struct kiln_solid_shadow *kiln_solid_shadow_create(const struct kiln_scene *scene,
                                                   const struct kiln_instances *meshes,
                                                   struct kiln_error *error);

/* Adds the memory of the lists of solids. */
void kiln_solid_shadow_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_solid_shadow_destroy(struct kiln_solid_shadow **shadow);

/* Lists the living solids. The order in which they will be drawn has no effect on the lists. */
bool kiln_solid_shadow_run(struct kiln_solid_shadow *shadow, const struct kiln_moment *moment,
                           struct kiln_threads *threads, struct kiln_solid_bins *bins,
                           struct kiln_error *error);

#endif
