/* A kiln_words is a set of integer textures (RGBA32UI, four words a texel) that one draw writes at
 * the same time. Fragment shaders write exact bits to them. */
#ifndef KILN_GPU_WORDS_H
#define KILN_GPU_WORDS_H

#include "gpu/device.h"

enum { KILN_MAX_WORD_TEXTURES = 8 }; /* every OpenGL 4.3 has at least 8 draw buffers */

/* A zero-initialised kiln_words holds nothing and may be finished. */
struct kiln_words {
    GLuint textures[KILN_MAX_WORD_TEXTURES];
    uint32_t count;
    uint32_t width, height;
    GLuint framebuffer, vertex_array;
};

/* Creates the textures, filled with zeros. Returns false with an error on failure;
 * kiln_words_finish frees all objects, also then. */
bool kiln_words_init(struct kiln_words *words, struct kiln_device *device, uint32_t count,
                     uint32_t width, uint32_t height, const char *label, struct kiln_error *error);
void kiln_words_finish(struct kiln_words *words);

/* Binds the textures to the texture units first, first + 1, ... */
void kiln_words_bind_textures(const struct kiln_words *words, GLuint first);

/* Runs the current program, whose vertex shader must be gpu/framebuffer_fill.vert, over `rows`
 * whole rows from first_row on. */
void kiln_words_draw(const struct kiln_words *words, uint32_t first_row, uint32_t rows);

#endif
