/* Techniques `geometry` and `instanced` of the particles, and what other stages of a device read of
 * particles. */
#ifndef KILN_DRAW_PARTICLES_GEOMETRY_H
#define KILN_DRAW_PARTICLES_GEOMETRY_H

#include "draw/sprites/particles.h"

struct kiln_geometry;

/* Of another technique, it is only asked to bind. */
struct kiln_geometry *kiln_geometry_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_atlas *atlas,
                                           enum kiln_raster_technique technique,
                                           struct kiln_error *error);
void kiln_geometry_destroy(struct kiln_geometry **stage);

/* The defines of shaders that draw particles of a scene (shaders/draw/sprites/particle.glsl). */
void kiln_geometry_defines(const struct kiln_scene *scene, char *out, size_t size);

/* See kiln_particles_bind and kiln_particles_run. */
bool kiln_geometry_bind(struct kiln_geometry *stage, struct kiln_pool *pool,
                        struct kiln_buffer *entries, float time_s, struct kiln_error *error);
/* The same, and what shaders/draw/sprites/shade.glsl reads: atlas, motion and depth of the scene.
 */
bool kiln_geometry_bind_draw(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                             struct kiln_error *error);
bool kiln_geometry_run(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                       struct kiln_error *error);

#endif
