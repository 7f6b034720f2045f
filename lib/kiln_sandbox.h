/* Declares how a process confines itself to its job, for programs that render scenes from untrusted
 * sources. This header is part of kiln.h, which includes it. */
#ifndef KILN_SANDBOX_H
#define KILN_SANDBOX_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the kernel of this machine has to confine a process. */
struct kiln_sandbox_support {
    size_t size;
    int landlock; /* version of its interface; 0: none */
    bool seccomp;
    bool off; /* this program was built with sanitizers, which need more than a job does */
};
KILN_EMPTY(kiln_sandbox_support, kiln_sandbox_support_empty)

KILN_API void kiln_sandbox_get_support(struct kiln_sandbox_support *support);

struct kiln_sandbox_params {
    size_t size;
    bool required; /* KILN_DEVICE_FAILED where the kernel lacks Landlock or seccomp */
    /* Files and folders: asset roots, states. What does not exist is passed over. */
    const char *const *readable;
    size_t readable_count;
    /* Files that will be written, or patterns of such: the folder that each is in is made, and can
     * be read and written with all below it; of a pattern ("{scene}/f_####.png") what stands before
     * the first '{', '#' or '%'. A path that ends with '/' or is a folder is that folder. */
    const char *const *writable;
    size_t writable_count;
};
KILN_EMPTY(kiln_sandbox_params, kiln_sandbox_defaults)

/* Gives rights up, for the rest of the process and all that it starts: files can be opened below
 * those folders, below kiln's cache of distance fields, and where the dynamic linker finds
 * libraries (to read), nothing else; no program can be started but kiln-decode, no socket opened,
 * no other process traced or sent a signal. Call it before the first thread is started, and render
 * on the device "cpu": drivers of OpenGL need more. False with an error when something cannot be
 * confined that should be; the process may then have lost some rights already. */
KILN_API bool kiln_sandbox_enter(const struct kiln_sandbox_params *params,
                                 struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
