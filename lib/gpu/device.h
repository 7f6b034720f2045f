/* A kiln_device is an OpenGL context without a display, with what kiln knows about its driver; or
 * this machine without GL. */
#ifndef KILN_GPU_DEVICE_H
#define KILN_GPU_DEVICE_H

#include <epoxy/gl.h>

#include "kiln.h"

/* llvmpipe limits the loop iterations of an invocation, counted over all its loops, each one
 * iteration more than its body runs; beyond the limit every loop ends silently. The limit is
 * LP_MAX_TGSI_LOOP_ITERATIONS, which only its source documents. Kernels stay below it on software
 * for any input. */
enum { KILN_SOFTWARE_ITERATIONS = 65535 };

/* Counts the bytes that were copied between the host and the device. */
struct kiln_traffic {
    uint64_t to_device, to_host;
};

struct kiln_device {
    struct kiln_device_info info;
    struct kiln_log log;
    struct kiln_traffic traffic; /* since it was opened: contents of buffers, images, textures */
    uint32_t work_group_size;    /* for programs made from now on; 0: what suits each kernel */
    void *display, *context;     /* EGL; NULL without GL */
    bool debug;
    bool gl_failed;       /* the debug callback saw an error; sticky */
    char gl_message[512]; /* the first such error */
};

/* Returns the device, or NULL when it has no GL. Buffers, images, timers and stages take the
 * result: for them NULL means the host alone. */
struct kiln_device *kiln_device_gl(struct kiln_device *device);

/* Makes the device's context current on this thread. Does nothing without GL. */
bool kiln_device_make_current(struct kiln_device *device, struct kiln_error *error);

/* Returns false, with the place and the GL error, if GL reported one since the last call; `where`
 * is a word for the message ("simulate"). Out of memory and a lost context are
 * KILN_DEVICE_FAILED. */
bool kiln_device_check(struct kiln_device *device, const char *where, struct kiln_error *error);

/* Brackets a block of GL with a debug group, so that a capture shows it by name. */
void kiln_device_push_group(struct kiln_device *device, const char *name);
void kiln_device_pop_group(struct kiln_device *device);

/* Labels an object for debug output and captures: GL_BUFFER, GL_TEXTURE, GL_PROGRAM... */
void kiln_device_label(struct kiln_device *device, GLenum kind, GLuint object, const char *label);

/* Dispatches work groups for count invocations in two dimensions, since one axis takes 65535 only.
 * A kernel finds its index as (WorkGroupID.y * NumWorkGroups.x + WorkGroupID.x) * size +
 * LocalInvocationID.x and must check it against the count. Dispatches nothing for count 0. */
void kiln_device_dispatch(struct kiln_device *device, uint32_t count, uint32_t group_size);

/* Returns how many invocations a work group has, for a kernel that takes any power of two up to
 * `most`: `usual` if no size is asked for, otherwise the greatest power of two that is not above
 * the size asked for and that the device takes. */
uint32_t kiln_device_group_size(const struct kiln_device *device, uint32_t usual, uint32_t most);

#endif
