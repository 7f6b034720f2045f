/* An OpenGL context without a display, and what kiln knows about its driver; or this machine
 * without GL. */
#ifndef KILN_GPU_DEVICE_H
#define KILN_GPU_DEVICE_H

#include <epoxy/gl.h>

#include "kiln.h"

/* llvmpipe lets the loops of an invocation run so many times, all together, each once more than its
 * body; then, silently, every loop ends (LP_MAX_TGSI_LOOP_ITERATIONS, which nothing but its source
 * tells). Kernels for any input stay below on software. */
enum { KILN_SOFTWARE_ITERATIONS = 65535 };

/* Bytes that went from one side to the other. */
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

/* The device, or NULL when it has no GL: what buffers, images, timers and stages take, for whom
 * NULL is the host alone. */
struct kiln_device *kiln_device_gl(struct kiln_device *device);

/* Makes the device's context current on this thread; without GL there is nothing to do. */
bool kiln_device_make_current(struct kiln_device *device, struct kiln_error *error);

/* False, with the place and the GL error, if GL reported one since the last call; `where` is a word
 * for the message ("simulate"). Out of memory and a lost context are KILN_DEVICE_FAILED. */
bool kiln_device_check(struct kiln_device *device, const char *where, struct kiln_error *error);

/* Brackets a block of GL with a debug group, so that a capture shows it by name. */
void kiln_device_push_group(struct kiln_device *device, const char *name);
void kiln_device_pop_group(struct kiln_device *device);

/* Labels an object for debug output and captures: GL_BUFFER, GL_TEXTURE, GL_PROGRAM... */
void kiln_device_label(struct kiln_device *device, GLenum kind, GLuint object, const char *label);

/* Work groups for count invocations in two dimensions, since one axis takes 65535 only; a kernel
 * finds its index as (WorkGroupID.y * NumWorkGroups.x + WorkGroupID.x) * size + LocalInvocationID.x
 * and must check it against the count. Dispatches nothing for count 0. */
void kiln_device_dispatch(struct kiln_device *device, uint32_t count, uint32_t group_size);

/* How many invocations a work group of a kernel has that takes any power of two up to `most`, and
 * `usual` where none is asked for: the next lower one to what is, within what the device takes. */
uint32_t kiln_device_group_size(const struct kiln_device *device, uint32_t usual, uint32_t most);

#endif
