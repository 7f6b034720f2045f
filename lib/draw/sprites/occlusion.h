/* A kiln_occlusion rejects particles behind opaque geometry before they are shaded: it is a depth
 * buffer with the depth of the scene, for techniques that draw particles by a vertex shader. */
#ifndef KILN_DRAW_SPRITES_OCCLUSION_H
#define KILN_DRAW_SPRITES_OCCLUSION_H

#include "draw/sprites/particles.h"

struct kiln_occlusion;

/* Returns NULL with an error. device must outlive the result. */
struct kiln_occlusion *kiln_occlusion_create(struct kiln_device *device, struct kiln_error *error);
void kiln_occlusion_destroy(struct kiln_occlusion **occlusion);

/* Rejects fragments behind the scene until kiln_occlusion_end; shaders must place fragments by
 * occlusion_z() of shaders/draw/sprites/occlusion.glsl. Does nothing where rejecting would cost
 * more time than it saves. draw->framebuffer must be bound, and the bindings of
 * kiln_geometry_bind_draw must be in place. */
bool kiln_occlusion_begin(struct kiln_occlusion *occlusion, const struct kiln_particles_draw *draw,
                          struct kiln_error *error);
void kiln_occlusion_end(struct kiln_occlusion *occlusion);

#endif
