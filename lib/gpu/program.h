/* This header declares how GLSL programs are made from the embedded shader files. */
#ifndef KILN_GPU_PROGRAM_H
#define KILN_GPU_PROGRAM_H

#include "gpu/device.h"

/* Names the files of a program, relative to shaders/ ("draw/sprites/particles.frag"); NULL stages
 * are absent. defines is text put after #version, "#define N 1\n" lines, or NULL. */
struct kiln_program_params {
    const char *compute, *vertex, *geometry, *fragment;
    const char *defines;
    /* Names the outputs of the last stage before rasterising that transform feedback writes,
     * interleaved in one buffer. */
    const char *const *captured;
    size_t captured_count;
};

/* Compiles and links a program. Returns 0 on failure, and the message names the shader file and
 * line. `#include "path"` is resolved under shaders/, or under KILN_SHADER_DIR when the environment
 * names one. The caller deletes the program with glDeleteProgram. */
GLuint kiln_program_create(struct kiln_device *device, const struct kiln_program_params *params,
                           struct kiln_error *error);

/* Returns the text of a shader with every include resolved, as the driver gets it; the build writes
 * such texts for the validator. Returns NULL on failure; the caller frees the text. */
char *kiln_program_source(const char *file, const char *defines, struct kiln_error *error);

#endif
