/* Technique `tiled` draws particles by compute kernels, without rasteriser and blending. It is
 * meant for GPUs with few raster units. Scenes with `post.compose: oit` are drawn by technique
 * `geometry` instead, which writes lists of fragments. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_TILED_H
#define KILN_DRAW_SPRITES_PARTICLES_TILED_H

#include "draw/sprites/particles_geometry.h"

struct kiln_tiled;

/* geometry binds what shaders read of particles, and must outlive it. NULL with an error. */
struct kiln_tiled *kiln_tiled_create(struct kiln_device *device, const struct kiln_scene *scene,
                                     struct kiln_geometry *geometry, struct kiln_error *error);
void kiln_tiled_destroy(struct kiln_tiled **tiled);

/* Does what kiln_particles_run does. */
bool kiln_tiled_run(struct kiln_tiled *tiled, const struct kiln_particles_draw *draw,
                    struct kiln_error *error);

#endif
