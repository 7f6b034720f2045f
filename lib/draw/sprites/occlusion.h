/* A kiln_occlusion rejects particles behind opaque geometry before they are shaded: it is a depth
 * buffer with the depth of the scene, for techniques that draw particles by a vertex shader. */
#ifndef KILN_DRAW_SPRITES_OCCLUSION_H
#define KILN_DRAW_SPRITES_OCCLUSION_H

#include "draw/sprites/particles.h"

struct kiln_occlusion;

/* NULL with an error. device must outlive it. */
struct kiln_occlusion *kiln_occlusion_create(struct kiln_device *device, struct kiln_error *error);
void kiln_occlusion_destroy(struct kiln_occlusion **occlusion);

/* Until kiln_occlusion_end, fragments behind the scene are not shaded; their depth is
 * occlusion_place() of shaders/draw/sprites/occlusion.glsl. Does nothing where that would take
 * longer. draw->framebuffer must be bound, as must the bindings of kiln_geometry_bind_draw. */
bool kiln_occlusion_begin(struct kiln_occlusion *occlusion, const struct kiln_particles_draw *draw,
                          struct kiln_error *error);
void kiln_occlusion_end(struct kiln_occlusion *occlusion);

#endif
