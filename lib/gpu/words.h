/* Textures of whole words, four a texel (RGBA32UI), that are drawn into together: what fragment
 * shaders compute in, bit for bit. */
#ifndef KILN_GPU_WORDS_H
#define KILN_GPU_WORDS_H

#include "gpu/device.h"

enum { KILN_MAX_WORD_TEXTURES = 8 }; /* every GL draws into so many */

/* Zero-initialised has nothing. */
struct kiln_words {
    GLuint textures[KILN_MAX_WORD_TEXTURES];
    uint32_t count;
    uint32_t width, height;
    GLuint framebuffer, vertex_array;
};

/* Of zeros. False with an error; kiln_words_finish then frees what there is. */
bool kiln_words_init(struct kiln_words *words, struct kiln_device *device, uint32_t count,
                     uint32_t width, uint32_t height, const char *label, struct kiln_error *error);
void kiln_words_finish(struct kiln_words *words);

/* Makes the textures the units first, first + 1, ... of what is drawn next. */
void kiln_words_bind_textures(const struct kiln_words *words, GLuint first);

/* Runs the bound program, whose vertex shader is gpu/framebuffer_fill.vert, over whole rows. */
void kiln_words_draw(const struct kiln_words *words, uint32_t first_row, uint32_t rows);

#endif
