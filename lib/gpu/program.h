/* GLSL programs from the embedded shader files. */
#ifndef KILN_GPU_PROGRAM_H
#define KILN_GPU_PROGRAM_H

#include "gpu/device.h"

/* The files of a program, named under shaders/ ("draw/sprites/particles.frag"); NULL stages are
 * absent. defines is text put after #version, "#define N 1\n" lines, or NULL. */
struct kiln_program_params {
    const char *compute, *vertex, *geometry, *fragment;
    const char *defines;
    /* Outputs of the last stage before rasterising that transform feedback writes, one behind the
     * other into one buffer. */
    const char *const *captured;
    size_t captured_count;
};

/* Compiles and links; 0 on failure, and then the message names the shader file and line. `#include
 * "path"` is resolved under shaders/, or under KILN_SHADER_DIR when the environment names one. The
 * caller deletes it with glDeleteProgram. */
GLuint kiln_program_create(struct kiln_device *device, const struct kiln_program_params *params,
                           struct kiln_error *error);

/* The text of a shader with every include resolved, as the driver gets it; the build writes these
 * for the validator. NULL on failure; free() it. */
char *kiln_program_source(const char *file, const char *defines, struct kiln_error *error);

#endif
