/* This file makes and runs the programs of gas. A scene needs some of them only, and some from a
 * step on in which gas meets solids, so each is made when it is first used. */
#include "sim/gas/kernels.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/gas_kernel.h"

static bool check_device(const struct kiln_device *device, struct kiln_error *error)
{
    GLint blocks = 0;
    if (!device)
        return kiln_error_set(error, KILN_USAGE, "without a device, only gas=cpu is allowed");
    if (!device->info.exact)
        return kiln_error_set(error, KILN_USAGE,
                              "%s computes inexactly and cannot step gas; use gas=cpu",
                              device->info.name);
    glGetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &blocks);
    if (blocks < GAS_BINDINGS)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s: kernels may have %d storage blocks, and those of gas need %d; "
                              "use gas=cpu",
                              device->info.name, blocks, GAS_BINDINGS);
    return true;
}

struct gas_kernels *gas_kernels_create(struct kiln_device *device, struct kiln_error *error)
{
    if (!check_device(device, error))
        return NULL;
    struct gas_kernels *kernels = calloc(1, sizeof *kernels);
    if (kernels)
        kernels->device = device;
    else
        kiln_error_no_memory(error, "gas");
    return kernels;
}

void gas_kernels_destroy(struct gas_kernels **kernels)
{
    for (int i = 0; *kernels && i < GAS_KERNEL_COUNT; i++)
        if ((*kernels)->programs[i])
            glDeleteProgram((*kernels)->programs[i]);
    free(*kernels);
    *kernels = NULL;
}

bool gas_kernels_use(struct gas_kernels *kernels, enum gas_kernel kernel, struct kiln_error *error)
{
    static const struct kiln_program_params params[GAS_KERNEL_COUNT] = {
#define GAS_KERNEL_PARAMS(name, file, text)                                                        \
    [GAS_KERNEL_##name] = {.compute = "sim/gas/" file ".comp", .defines = text},
        GAS_KERNELS(GAS_KERNEL_PARAMS)
#undef GAS_KERNEL_PARAMS
    };
    GLuint *program = &kernels->programs[kernel];
    if (!*program)
        *program = kiln_program_create(kernels->device, &params[kernel], error);
    if (*program)
        glUseProgram(*program);
    return *program != 0;
}

void gas_kernels_dispatch(const struct gas_kernels *kernels, uint32_t count)
{
    glUniform1ui(GAS_AT_COUNT, count);
    kiln_device_dispatch(kernels->device, count, GAS_GROUP_SIZE);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

bool gas_kernels_bind(GLuint at, struct kiln_buffer *buffer, enum kiln_access access,
                      struct kiln_error *error)
{
    const GLuint gl = kiln_buffer_gl(buffer, access, error);
    if (gl)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, gl);
    return gl != 0;
}
