/* A kiln_integer_textures is a set of textures (RGBA32UI, four words a texel) that one draw writes
 * at the same time. Fragment shaders write exact bits to them. */
#ifndef KILN_GPU_INTEGER_TEXTURES_H
#define KILN_GPU_INTEGER_TEXTURES_H

#include "gpu/device.h"

enum { KILN_MAX_INTEGER_TEXTURES = 8 }; /* every OpenGL 4.3 has at least 8 draw buffers */

/* A zero-initialised kiln_integer_textures holds nothing and may be finished. */
struct kiln_integer_textures {
    GLuint textures[KILN_MAX_INTEGER_TEXTURES];
    uint32_t count;
    uint32_t width, height;
    GLuint framebuffer, vertex_array;
};

/* Creates the textures, filled with zeros. Returns false with an error on failure;
 * kiln_integer_textures_finish frees all objects, also then. */
bool kiln_integer_textures_init(struct kiln_integer_textures *set, struct kiln_device *device,
                                uint32_t count, uint32_t width, uint32_t height, const char *label,
                                struct kiln_error *error);
void kiln_integer_textures_finish(struct kiln_integer_textures *set);

/* Binds the textures to the texture units first, first + 1, ... */
void kiln_integer_textures_bind(const struct kiln_integer_textures *set, GLuint first);

/* Runs the current program, whose vertex shader must be gpu/framebuffer_fill.vert, over `rows`
 * whole rows from first_row on. */
void kiln_integer_textures_draw(const struct kiln_integer_textures *set, uint32_t first_row,
                                uint32_t rows);

#endif
