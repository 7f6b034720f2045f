/* Lets a process give up rights for good: files that it may open (by Landlock, which Linux has from
 * 5.13 on) and system calls that it may make (by seccomp). Two places call it. kiln-decode gives up
 * all files, and all system calls but a list, before it decodes anything (decode/confine.c). A
 * process that sandboxes itself keeps the files of its command, and gives up a list of system calls
 * (job/sandbox.c).
 *
 * The order of calls matters: kiln_seccomp_open, then kiln_landlock_confine, then
 * kiln_seccomp_confine. The first one loads a library, which Landlock could prevent; the last one
 * may forbid the system calls of Landlock. Landlock restricts only the calling thread and the
 * threads that it starts, so the process must have no other threads yet. */
#ifndef KILN_BASE_CONFINE_H
#define KILN_BASE_CONFINE_H

#include <stddef.h>

#include "kiln.h"

/* Sanitizers open files and start threads at any time, so a program that is built with one confines
 * nothing. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KILN_UNCONFINED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KILN_UNCONFINED 1
#endif
#endif
#ifndef KILN_UNCONFINED
#define KILN_UNCONFINED 0
#endif

/* Rights to a file, or to a folder and all that is below it. None contains another: a place that is
 * written and read needs both. */
enum { KILN_MAY_READ = 1, KILN_MAY_WRITE = 2, KILN_MAY_EXECUTE = 4 };

struct kiln_place {
    const char *path;
    unsigned may;
};

/* Returns the version of the kernel's Landlock interface, or 0 where Landlock is missing, switched
 * off, or not used because of a sanitizer. */
int kiln_landlock_version(void);

/* Returns whether the kernel has seccomp filters, and libseccomp, which makes them, is
 * installed. */
bool kiln_has_seccomp(void);

/* Loads libseccomp, so that kiln_seccomp_confine finds it when the process may not open its file
 * any more. Returns false with KILN_IO where it is not installed. Does nothing where the kernel has
 * no seccomp. */
bool kiln_seccomp_open(struct kiln_error *error);

/* Restricts this thread and the threads and processes that it starts. From now on they can open
 * files only at these places and can use no TCP. They can reach only processes that are restricted
 * as they are, by signals and by abstract Unix sockets. Kernels before Landlock version 4 do not
 * restrict TCP, and those before version 6 restrict neither signals nor sockets. A place that does
 * not exist is skipped. Does nothing where there is no Landlock. Returns false with
 * KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_landlock_confine(const struct kiln_place *places, size_t count, struct kiln_error *error);

/* Describes a system call of a list. With all other members 0, it means the call with any
 * arguments. `mask` or `differs` set a condition on one argument. `and_mask` adds a condition on
 * another argument, and may be used only together with one of these. */
struct kiln_system_call {
    int number;            /* such as SCMP_SYS(read) of <seccomp.h> */
    unsigned argument;     /* the number of the first argument that has a condition, from 0 */
    uint64_t mask;         /* not 0: only calls where (argument & mask) == value */
    uint64_t value;        /* what `mask` or `differs` compares with */
    unsigned and_argument; /* the number of the second argument that has a condition */
    uint64_t and_mask;     /* not 0: only calls where the second argument has none of these bits */
    bool differs;          /* true: only calls where argument != value; mask is ignored */
    int refusal;           /* errno of the call in a list of forbidden calls; 0: EPERM */
};

enum kiln_calls { KILN_ONLY_THESE_CALLS, KILN_ALL_BUT_THESE_CALLS };

/* Restricts the system calls of all threads of this process, and of the threads and processes that
 * they start. A list names either the only calls that are allowed, and all others fail with ENOSYS;
 * or the calls that are forbidden, and these fail with their `refusal`. Does nothing where the
 * kernel has no seccomp. Returns false with KILN_IO where libseccomp is not installed, and with
 * KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_seccomp_confine(enum kiln_calls which, const struct kiln_system_call *calls, size_t count,
                          struct kiln_error *error);

#endif
