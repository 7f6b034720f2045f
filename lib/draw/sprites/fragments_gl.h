/* A kiln_fragments_gl sorts and blends the fragments of each pixel in GL (post.compose: oit), for
 * techniques that draw particles by a vertex shader. Lists of fragments are counted, filled, sorted
 * and blended (shared/fragment_layout.h). */
#ifndef KILN_DRAW_SPRITES_FRAGMENTS_GL_H
#define KILN_DRAW_SPRITES_FRAGMENTS_GL_H

#include "draw/sprites/particles.h"
#include "gpu/program.h"

struct kiln_fragments_gl;

/* Returns NULL with an error. particles: the vertex and geometry shader that place particles, and
 * their defines, those of the scene; a fragment shader that writes lists is added to them. */
struct kiln_fragments_gl *kiln_fragments_gl_create(struct kiln_device *device,
                                                   const struct kiln_program_params *particles,
                                                   const struct kiln_scene *scene,
                                                   struct kiln_error *error);
void kiln_fragments_gl_destroy(struct kiln_fragments_gl **fragments);

/* Draws particles into draw->framebuffer, which must be bound and cleared. `submit` issues their
 * draw call with the program in use. Lists are made for some rows, or pixels of a row, at a time,
 * so that memory stays bounded unless one pixel alone needs more. Fails with KILN_DEVICE_FAILED,
 * and advice in the message, where the device's storage blocks are too small for a pixel or for the
 * picture. */
bool kiln_fragments_gl_run(struct kiln_fragments_gl *fragments,
                           const struct kiln_particles_draw *draw, void (*submit)(void *context),
                           void *context, struct kiln_error *error);

#endif
