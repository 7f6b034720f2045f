/* A kiln_moment_gl holds the looks of a drawn moment as buffers and a texture of GL, for the
 * shaders that draw particles. */
#ifndef KILN_DRAW_MOMENT_MOMENT_GL_H
#define KILN_DRAW_MOMENT_MOMENT_GL_H

#include "draw/moment/moment.h"
#include "gpu/device.h"

/* Returns NULL when memory is short. No GL object is made before the first kiln_moment_bind. */
struct kiln_moment_gl *kiln_moment_gl_create(struct kiln_device *device);
void kiln_moment_gl_destroy(struct kiln_moment_gl **gl);

/* Binds the blocks of looks (KILN_BIND_LOOKS) and of the keys of values (KILN_BIND_KEYS). */
bool kiln_moment_bind_looks(const struct kiln_moment *moment, struct kiln_error *error);

/* Appends the definitions with which shaders that include draw/moment/record.glsl are compiled for
 * a scene. */
void kiln_moment_gl_defines(const struct kiln_scene *scene, struct kiln_text *defines);

/* Binds the data of particles that shaders read (shaders/draw/moment/record.glsl): the pool's
 * records, the draw entries, the looks and their table. It does not bind the blocks of view and
 * backdrop, which kiln_draw_blocks_bind does. The moment must have a device. */
bool kiln_moment_bind(const struct kiln_moment *moment, struct kiln_buffer *entries,
                      struct kiln_error *error);

#endif
