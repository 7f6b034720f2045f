/* Lets a process give up rights for good: the files that it may reach (Landlock, in the kernel from
 * 5.13 on) and the system calls that it may make (seccomp). */
#ifndef KILN_BASE_CONFINE_H
#define KILN_BASE_CONFINE_H

#include <stddef.h>

#include "kiln.h"

/* Sanitizers need files and threads at any time, so programs with them confine nothing. */
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

/* Rights at a place and below it. */
enum { KILN_MAY_READ = 1, KILN_MAY_WRITE = 2, KILN_MAY_EXECUTE = 4 };

struct kiln_place {
    const char *path;
    unsigned may;
};

/* Returns the version of the kernel's Landlock interface; 0: the kernel has none, or it is switched
 * off. */
int kiln_landlock_version(void);

/* Returns whether the kernel has seccomp filters, and the machine libseccomp, which makes them. */
bool kiln_has_seccomp(void);

/* Opens libseccomp, which kiln_seccomp_confine needs. Call it before Landlock, which prevents it.
 * KILN_IO where it is not installed. */
bool kiln_seccomp_open(struct kiln_error *error);

/* Restricts this thread and the threads that it starts. From now on they can open files only at
 * these places, open no TCP connections, and send signals only to their own children, as far as the
 * kernel's version supports it. A place that does not exist is skipped. Does nothing where there is
 * no Landlock; KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_landlock_confine(const struct kiln_place *places, size_t count, struct kiln_error *error);

/* A system call with any arguments. With a mask: only where (argument & mask) == value and another
 * argument has none of some bits. With `differs`: only where the argument is not the value. */
struct kiln_system_call {
    int number; /* SCMP_SYS(read) of <seccomp.h> */
    unsigned argument;
    uint64_t mask; /* 0: any argument */
    uint64_t value;
    unsigned and_argument;
    uint64_t and_mask; /* 0: any second argument */
    bool differs;      /* the argument is not the value */
    int refusal;       /* errno of the refused call; 0: EPERM */
};

enum kiln_calls { KILN_ONLY_THESE_CALLS, KILN_ALL_BUT_THESE_CALLS };

/* Restricts the system calls of all threads of this process and of what they start. Calls that are
 * not allowed fail: with ENOSYS where the list names the allowed ones, with EPERM where it names
 * the forbidden ones. Does nothing where there is no seccomp; KILN_DEVICE_FAILED when the kernel
 * refuses. */
bool kiln_seccomp_confine(enum kiln_calls which, const struct kiln_system_call *calls, size_t count,
                          struct kiln_error *error);

#endif
