/* This header declares the functions that create GLSL programs from the embedded shader files. */
#ifndef KILN_GPU_PROGRAM_H
#define KILN_GPU_PROGRAM_H

#include "base/text.h"
#include "gpu/device.h"

/* Names the files of a program, relative to shaders/ ("draw/sprites/particles.frag"); a stage that
 * is NULL is absent. defines is NULL or text to insert after #version, such as "#define N 1\n". */
struct kiln_program_params {
    const char *compute, *vertex, *geometry, *fragment;
    const char *defines;
    /* The outputs of the last stage before rasterisation that transform feedback writes,
     * interleaved in one buffer. */
    const char *const *captured;
    size_t captured_count;
};

/* Compiles and links a program. Returns 0 on failure with an error that names the shader file and
 * line. `#include "path"` is resolved under shaders/, or under KILN_SHADER_DIR when the environment
 * names one. The caller deletes the program with glDeleteProgram. */
GLuint kiln_program_create(struct kiln_device *device, const struct kiln_program_params *params,
                           struct kiln_error *error);

/* Does the same with `defines` in place of params->defines, which is ignored, and frees the text.
 */
GLuint kiln_program_create_defined(struct kiln_device *device,
                                   const struct kiln_program_params *params,
                                   struct kiln_text *defines, struct kiln_error *error);

/* Returns the text of a shader with every include resolved, as the driver gets it, or NULL with an
 * error on failure. The caller frees the text. The build writes such texts for the validator. */
char *kiln_program_source(const char *file, const char *defines, struct kiln_error *error);

#endif
