/* What lies behind opaque geometry, rejected before it is shaded: a depth buffer with the depth of
 * the scene, for techniques that draw particles by a vertex shader. */
#ifndef KILN_DRAW_SPRITES_OCCLUSION_H
#define KILN_DRAW_SPRITES_OCCLUSION_H

#include "draw/sprites/particles.h"

struct kiln_occlusion;

/* NULL with an error. device must outlive it. */
struct kiln_occlusion *kiln_occlusion_create(struct kiln_device *device, struct kiln_error *error);
void kiln_occlusion_destroy(struct kiln_occlusion **occlusion);

/* Until kiln_occlusion_end, fragments that show nothing, since the scene is nearer, are not shaded;
 * their depth is occlusion_place() of shaders/draw/sprites/occlusion.glsl. Does nothing where that
 * would take longer. draw->framebuffer is bound, as is what kiln_geometry_bind_draw binds. */
bool kiln_occlusion_begin(struct kiln_occlusion *occlusion, const struct kiln_particles_draw *draw,
                          struct kiln_error *error);
void kiln_occlusion_end(struct kiln_occlusion *occlusion);

#endif
