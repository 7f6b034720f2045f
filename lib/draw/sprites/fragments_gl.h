/* A kiln_fragments_gl blends particles in an order that is decided pixel by pixel, for techniques
 * that draw them by a vertex shader: lists in GL are counted, filled, sorted and blended
 * (shared/fragment_layout.h). */
#ifndef KILN_DRAW_SPRITES_FRAGMENTS_GL_H
#define KILN_DRAW_SPRITES_FRAGMENTS_GL_H

#include "draw/sprites/particles.h"
#include "gpu/program.h"

struct kiln_fragments_gl;

/* particles: the programs' vertex and geometry shader and their defines. NULL with an error. */
struct kiln_fragments_gl *kiln_fragments_gl_create(struct kiln_device *device,
                                                   const struct kiln_program_params *particles,
                                                   struct kiln_error *error);
void kiln_fragments_gl_destroy(struct kiln_fragments_gl **fragments);

/* Draws the particles that submit draws, with the program in use, into the framebuffer that is
 * bound and cleared, draw->framebuffer. Lists are made for so many rows, or pixels of a row, at a
 * time that memory stays bounded, unless one pixel alone needs more. KILN_DEVICE_FAILED, with
 * advice, where the device's storage blocks are too small for that or for the picture. */
bool kiln_fragments_gl_run(struct kiln_fragments_gl *fragments,
                           const struct kiln_particles_draw *draw, void (*submit)(void *context),
                           void *context, struct kiln_error *error);

#endif
