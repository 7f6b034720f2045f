/* Declares how a process confines itself to its job, for programs that render scenes from untrusted
 * sources. This header is part of kiln.h, which includes it. */
#ifndef KILN_SANDBOX_H
#define KILN_SANDBOX_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The means by which this machine's kernel can confine a process. */
struct kiln_sandbox_support {
    size_t size;
    int landlock; /* version of Landlock's interface; 0: the kernel has none */
    bool seccomp;
    bool off; /* the program was built with sanitizers, which need more rights than a job */
};
KILN_EMPTY(kiln_sandbox_support, kiln_sandbox_support_empty)

KILN_API void kiln_sandbox_get_support(struct kiln_sandbox_support *support);

struct kiln_sandbox_params {
    size_t size;
    bool required; /* fail with KILN_DEVICE_FAILED where the kernel lacks Landlock or seccomp */
    /* Files and folders to read: asset roots, states. Paths that do not exist are ignored. */
    const char *const *readable;
    size_t readable_count;
    /* Files to write, patterns of files, or folders. The folder of each is made, and all below it
     * can be read and written. The folder of a pattern ("{scene}/f_####.png") is that of the text
     * before the first '{', '#' or '%'. A path that ends with '/' or is a folder stands for itself.
     */
    const char *const *writable;
    size_t writable_count;
};
KILN_EMPTY(kiln_sandbox_params, kiln_sandbox_defaults)

/* Confines this process and all that it starts, until they end. Files can be opened only below the
 * folders of `params`, in kiln's cache of distance fields and, to read, where the system's
 * libraries and files of the C library lie. The only program that can be started is kiln-decode. No
 * socket can be opened, and no other process can be traced or sent a signal. Of ioctl and fcntl,
 * only the commands remain that change nothing but the process itself; those that change a
 * terminal, a pipe or another open file fail with EPERM. Descriptors that are open stay open, and
 * can be read and written: close those that the job must not have. Call it before the first thread
 * is started, and render on the device "cpu": drivers of OpenGL need more rights. Returns false
 * with an error when the process cannot be confined; it may then have lost some rights already. */
KILN_API bool kiln_sandbox_enter(const struct kiln_sandbox_params *params,
                                 struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
