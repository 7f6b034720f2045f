/* A kiln_geometry draws particles by technique `geometry`, in which a geometry shader makes
 * billboards of points, or `instanced`, which needs none, for drivers whose geometry shaders are
 * slow. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_GEOMETRY_H
#define KILN_DRAW_SPRITES_PARTICLES_GEOMETRY_H

#include "draw/sprites/particles.h"

struct kiln_geometry;

/* Makes the stage. For technique `tiled` the stage only binds the data that the kernels read,
 * unless post.compose is oit: then it draws, too. Returns NULL with an error. */
struct kiln_geometry *kiln_geometry_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_atlas *atlas,
                                           enum kiln_raster_technique technique,
                                           struct kiln_error *error);
void kiln_geometry_destroy(struct kiln_geometry **stage);

/* Appends the "#define" lines of shaders that draw a scene's particles
 * (shaders/draw/sprites/particle.glsl). */
void kiln_geometry_defines(const struct kiln_scene *scene, struct kiln_text *defines);

/* Returns how many sprites each draw entry of the scene has: RIBBONS of ribbon.glsl, or 1. */
uint32_t kiln_geometry_items(const struct kiln_geometry *stage);

/* Binds the data of kiln_moment_bind, and the lighting, the atlas and its motion, and the scene's
 * depth, which shaders/draw/sprites/shade.glsl reads. */
bool kiln_geometry_bind_draw(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                             struct kiln_error *error);
bool kiln_geometry_run(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                       struct kiln_error *error);

#endif
