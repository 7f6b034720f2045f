/* A kiln_tiled draws particles by technique `tiled`: compute kernels do the work of rasteriser and
 * blending, for GPUs with few raster units. Scenes with `post.compose: oit` are drawn by
 * kiln_geometry instead, which writes lists of fragments. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_TILED_H
#define KILN_DRAW_SPRITES_PARTICLES_TILED_H

#include "draw/sprites/particles_geometry.h"

struct kiln_tiled;

/* Returns NULL with an error. geometry binds the particles' data for the kernels; device and
 * geometry must outlive the result. */
struct kiln_tiled *kiln_tiled_create(struct kiln_device *device, const struct kiln_scene *scene,
                                     struct kiln_geometry *geometry, struct kiln_error *error);
void kiln_tiled_destroy(struct kiln_tiled **tiled);

/* Draws the particles of a pass, as kiln_particles_run does. */
bool kiln_tiled_run(struct kiln_tiled *tiled, const struct kiln_particles_draw *draw,
                    struct kiln_error *error);

#endif
