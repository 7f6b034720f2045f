/* Lets a process give up rights for good: the right to open files (by Landlock, which Linux has
 * from 5.13 on) and the right to make system calls (by seccomp). decode/confine.c calls these
 * functions before kiln-decode decodes anything: it keeps no file, and only the system calls of a
 * list. job/sandbox.c calls them in a process that sandboxes itself: it keeps the files that its
 * command reads and writes, and all system calls except those of a list.
 *
 * The order of calls matters: kiln_seccomp_open, then kiln_landlock_confine, then
 * kiln_seccomp_confine. The first one loads a library, which Landlock could prevent; the last one
 * may forbid the system calls of Landlock. Landlock restricts only the calling thread and the
 * threads that it starts, so the process must have no other threads yet. */
#ifndef KILN_BASE_CONFINE_H
#define KILN_BASE_CONFINE_H

#include <stddef.h>

#include "kiln.h"

/* KILN_UNCONFINED is 1 in a program that is built with a sanitizer which opens files or starts
 * threads at any time. Such a program confines nothing: the functions below do nothing and succeed.
 */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KILN_UNCONFINED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||                         \
    __has_feature(memory_sanitizer)
#define KILN_UNCONFINED 1
#endif
#endif
#ifndef KILN_UNCONFINED
#define KILN_UNCONFINED 0
#endif

/* Rights to a file, or to a folder and all that is below it. No right implies another: a file that
 * is written and read needs both. */
enum { KILN_MAY_READ = 1, KILN_MAY_WRITE = 2, KILN_MAY_EXECUTE = 4 };

/* A file or folder, and what the process may do with it. */
struct kiln_place {
    const char *path;
    unsigned may;
};

/* Returns the version of the kernel's Landlock ABI, or 0 where Landlock is missing, switched
 * off, or not used because of a sanitizer. */
int kiln_landlock_version(void);

/* Returns whether the kernel has seccomp filters, and libseccomp, which makes them, is
 * installed. */
bool kiln_has_seccomp(void);

/* Loads libseccomp, so that kiln_seccomp_confine finds it when the process may not open its file
 * any more. Returns false with KILN_IO where it is not installed. Does nothing and returns true
 * where the kernel has no seccomp. */
bool kiln_seccomp_open(struct kiln_error *error);

/* Restricts this thread and the threads and processes that it starts. From now on they can open
 * files only at these places and can use no TCP. They can send signals to, and connect by abstract
 * Unix sockets with, only processes under the same restriction. Kernels before version 4 of the
 * Landlock ABI do not restrict TCP, and those before version 6 restrict neither signals nor
 * sockets. A place that does not exist is skipped. Does nothing and returns true where there is no
 * Landlock. Returns false with KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_landlock_confine(const struct kiln_place *places, size_t count, struct kiln_error *error);

/* Describes a system call of a list. With all other members 0, the entry matches the call with any
 * arguments. `mask` or `differs` restricts the entry to calls in which one argument meets a
 * condition. `and_none_of` adds a condition on another argument; it may be used only together with
 * `mask` or `differs`. */
struct kiln_system_call {
    int number;            /* such as SCMP_SYS(read) of <seccomp.h> */
    unsigned argument;     /* the number of the first argument that has a condition, from 0 */
    uint64_t mask;         /* not 0: the entry matches if (the argument & mask) == value */
    uint64_t value;        /* what `mask` or `differs` compares with */
    unsigned and_argument; /* the number of the second argument that has a condition */
    uint64_t and_none_of; /* not 0: it matches only if the second argument has none of these bits */
    bool differs;         /* true: it matches if the argument != value; mask is ignored */
    int refusal;          /* errno that a forbidden call sets; 0: EPERM */
};

enum kiln_call_list { KILN_ONLY_THESE_CALLS, KILN_ALL_BUT_THESE_CALLS };

/* Restricts the system calls of all threads of this process, and of the threads and processes that
 * they start. A list names either the only calls that are allowed, and all others fail with ENOSYS;
 * or the calls that are forbidden, and these fail with their `refusal`. Does nothing and returns
 * true where the kernel has no seccomp. Returns false with KILN_IO where libseccomp is not
 * installed, and with KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_seccomp_confine(enum kiln_call_list which, const struct kiln_system_call *calls,
                          size_t count, struct kiln_error *error);

/* Describes a system call whose commands are limited, such as ioctl: `argument` is the number of
 * the argument that holds the command, and `allowed` lists the only commands that remain. */
struct kiln_commands {
    long number; /* such as SYS_ioctl of <sys/syscall.h> */
    unsigned argument;
    const uint32_t *allowed;
    size_t count; /* at most 100 */
};

/* Restricts the commands of system calls, of all threads of this process and of all that they
 * start. Other commands fail with EPERM. Only the low 32 bits of a command are compared, since the
 * kernel ignores the others. Does nothing and returns true where the kernel has no seccomp; returns
 * false with KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_seccomp_limit_commands(const struct kiln_commands *calls, size_t count,
                                 struct kiln_error *error);

#endif
