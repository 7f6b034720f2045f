/* A kiln_device is either an OpenGL context without a display together with the properties of its
 * driver, or this machine without GL. */
#ifndef KILN_GPU_DEVICE_H
#define KILN_GPU_DEVICE_H

#include <epoxy/gl.h>
#include <pthread.h>

#include "base/handle.h"

/* llvmpipe limits the loop iterations of an invocation. It counts them over all loops, and for each
 * loop one more than its body runs. Beyond the limit every loop ends silently. The limit is
 * LP_MAX_TGSI_LOOP_ITERATIONS, which only its source documents. Kernels stay below it on software
 * for any input. */
enum { KILN_SOFTWARE_ITERATIONS = 65535 };

/* Counts the bytes that were copied between the host and the device. */
struct kiln_traffic {
    uint64_t to_device, to_host;
};

/* Counts the programs that were made since the device was opened. */
struct kiln_program_counts {
    uint32_t built;  /* compiled and linked */
    uint32_t loaded; /* taken from the cache (gpu/program_cache.h) */
};

struct kiln_device {
    struct kiln_handle handle;
    struct kiln_device_info info;
    struct kiln_log log;
    struct kiln_traffic traffic; /* contents of buffers, images and textures since the device was
                                  * opened */
    struct kiln_program_counts programs;
    uint32_t work_group_size; /* for programs created from now on; 0: each kernel's own
                               * default */
    void *display, *context;  /* EGL; NULL without GL */
    pthread_t thread;         /* the one that opened it */
    bool debug;
    bool gl_failed;       /* the debug callback received an error since the last
                           * kiln_device_check */
    char gl_message[512]; /* the first error that it received */
};

/* Returns the device, or NULL if it has no GL. Buffers, images, timers and stages take the result;
 * for them NULL means that they are on the host only. */
struct kiln_device *kiln_device_gl(struct kiln_device *device);

/* Makes the device's context current on this thread. Does nothing without GL. */
bool kiln_device_make_current(struct kiln_device *device, struct kiln_error *error);

/* Returns false with KILN_DEVICE_FAILED if GL reported an error since the last call, which includes
 * exhausted memory and a lost context. The message consists of `where` ("simulate") and the GL
 * error. */
bool kiln_device_check(struct kiln_device *device, const char *where, struct kiln_error *error);

/* Enclose GL calls in a debug group, so that a capture shows them under its name. */
void kiln_device_push_group(struct kiln_device *device, const char *name);
void kiln_device_pop_group(struct kiln_device *device);

/* Labels an object for debug output and captures: GL_BUFFER, GL_TEXTURE, GL_PROGRAM... */
void kiln_device_label(struct kiln_device *device, GLenum kind, GLuint object, const char *label);

/* Dispatches work groups for count invocations in two dimensions, since GL guarantees only 65535
 * groups an axis. A kernel finds its index as (WorkGroupID.y * NumWorkGroups.x + WorkGroupID.x) *
 * size + LocalInvocationID.x and must check it against the count. Dispatches nothing for count
 * 0. */
void kiln_device_dispatch(struct kiln_device *device, uint32_t count, uint32_t group_size);

/* Returns the number of invocations of a work group for a kernel that takes any power of two up to
 * `most`. This is `usual` if device->work_group_size is 0, otherwise the greatest power of two that
 * exceeds neither work_group_size nor the device's limit. */
uint32_t kiln_device_group_size(const struct kiln_device *device, uint32_t usual, uint32_t most);

#endif
