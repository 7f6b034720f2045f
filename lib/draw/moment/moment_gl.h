/* This header declares the particles and looks of a drawn moment for programs in GL. */
#ifndef KILN_DRAW_MOMENT_MOMENT_GL_H
#define KILN_DRAW_MOMENT_MOMENT_GL_H

#include "draw/moment/moment.h"
#include "gpu/device.h"

/* NULL: no memory. Nothing of GL is made before the first kiln_moment_bind. */
struct kiln_moment_gl *kiln_moment_gl_create(struct kiln_device *device);
void kiln_moment_gl_destroy(struct kiln_moment_gl **gl);

/* Binds the data of particles that vertex shaders read (shaders/draw/moment/record.glsl): the
 * pool's records, the draw entries, the looks and their table. kiln_draw_blocks_bind binds the
 * blocks of view and backdrop. The moment must have a device. */
bool kiln_moment_bind(const struct kiln_moment *moment, struct kiln_buffer *entries,
                      struct kiln_error *error);

#endif
