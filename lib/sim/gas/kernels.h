/* Declares the kernels of gas, shaders/sim/gas/gas_*.comp, and the buffers that they work on.
 * Stages step several domains; each has its own buffers and all have the same programs. */
#ifndef KILN_SIM_GAS_KERNELS_H
#define KILN_SIM_GAS_KERNELS_H

#include "gpu/buffer.h"

/* name, file, what is defined in it */
#define GAS_KERNELS(X)                                                                             \
    X(CENTRES, "gas_centres", "")                                                                  \
    X(TRACE, "gas_trace", "")                                                                      \
    X(EXTRAS, "gas_extras", "")                                                                    \
    X(WALLS, "gas_walls", "")                                                                      \
    X(WALLS_EXTRAS, "gas_walls", "#define GAS_EXTRAS 1\n")                                         \
    X(SPIN, "gas_spin", "")                                                                        \
    X(NOISE, "gas_noise", "")                                                                      \
    X(REACT, "gas_react", "")                                                                      \
    X(FOUND, "gas_found", "")                                                                      \
    X(BLOW, "gas_blow", "")                                                                        \
    X(ADD, "gas_add", "")                                                                          \
    X(ADD_COLORED, "gas_add", "#define GAS_COLORED 1\n")                                           \
    X(EMPTY, "gas_empty", "")                                                                      \
    X(PUSH, "gas_push", "")                                                                        \
    X(PUSH_WALLED, "gas_push", "#define GAS_WALLED 1\n")                                           \
    X(DIVERGE, "gas_diverge", "")                                                                  \
    X(DIVERGE_WALLED, "gas_diverge", "#define GAS_WALLED 1\n")                                     \
    X(RELAX, "gas_relax", "")                                                                      \
    X(RELAX_WALLED, "gas_relax", "#define GAS_WALLED 1\n")                                         \
    X(COARSEST, "gas_coarsest", "")                                                                \
    X(COARSEST_WALLED, "gas_coarsest", "#define GAS_WALLED 1\n")                                   \
    X(RESTRICT, "gas_restrict", "")                                                                \
    X(RESTRICT_WALLED, "gas_restrict", "#define GAS_WALLED 1\n")                                   \
    X(PROLONG, "gas_prolong", "")                                                                  \
    X(RESIDUAL, "gas_residual", "")                                                                \
    X(RESIDUAL_WALLED, "gas_residual", "#define GAS_WALLED 1\n")                                   \
    X(PROJECT, "gas_project", "")                                                                  \
    X(PROJECT_WALLED, "gas_project", "#define GAS_WALLED 1\n")

enum gas_kernel {
#define GAS_KERNEL_NAME(name, file, defines) GAS_KERNEL_##name,
    GAS_KERNELS(GAS_KERNEL_NAME)
#undef GAS_KERNEL_NAME
        GAS_KERNEL_COUNT,
};

struct gas_kernels {
    struct kiln_device *device;
    GLuint programs[GAS_KERNEL_COUNT]; /* 0: not made yet */
};

/* Checks that a device, which is borrowed, can run the kernels. Programs are made when they are
 * first used. NULL with KILN_USAGE, KILN_NO_DEVICE, or KILN_DEVICE_FAILED: memory is short. */
struct gas_kernels *gas_kernels_create(struct kiln_device *device, struct kiln_error *error);
void gas_kernels_destroy(struct gas_kernels **kernels);

/* Makes a program the current one. */
bool gas_kernels_use(struct gas_kernels *kernels, enum gas_kernel kernel, struct kiln_error *error);

/* Runs the current program for so many invocations. */
void gas_kernels_dispatch(const struct gas_kernels *kernels, uint32_t count);

/* Binds a buffer to a place of shared/gas_kernel.h. */
bool gas_kernels_bind(GLuint at, struct kiln_buffer *buffer, enum kiln_access access,
                      struct kiln_error *error);

#endif
