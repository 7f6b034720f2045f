/* Lets a process give up rights for good: the files that it may reach (Landlock, in the kernel from
 * 5.13 on) and the system calls that it may make (seccomp). */
#ifndef KILN_BASE_CONFINE_H
#define KILN_BASE_CONFINE_H

#include <stddef.h>

#include "kiln.h"

/* The sanitizers want files and threads when they please: programs with them confine nothing. */
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

/* What may be done at a place and below it. */
enum { KILN_MAY_READ = 1, KILN_MAY_WRITE = 2, KILN_MAY_EXECUTE = 4 };

struct kiln_place {
    const char *path;
    unsigned may;
};

/* The version of Landlock's interface that the kernel has; 0: it has none, or it is switched off.
 */
int kiln_landlock_version(void);

/* Whether the kernel has seccomp filters, and the machine libseccomp, which makes them. */
bool kiln_has_seccomp(void);

/* Opens libseccomp, which kiln_seccomp_confine needs, and cannot open any more after Landlock.
 * KILN_IO where it is not installed. */
bool kiln_seccomp_open(struct kiln_error *error);

/* From now on, this thread and those that it starts can open files at these places alone, open no
 * TCP connections, and send signals to no other processes but their own children, as far as the
 * kernel knows how. A place that does not exist is passed over. Does nothing where there is no
 * Landlock; KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_landlock_confine(const struct kiln_place *places, size_t count, struct kiln_error *error);

/* A system call: with any arguments, or only where (argument & mask) == value and another argument
 * has none of some bits; or only where the argument is another than the value. */
struct kiln_system_call {
    int number; /* SCMP_SYS(read) of <seccomp.h> */
    unsigned argument;
    uint64_t mask; /* 0: any */
    uint64_t value;
    unsigned and_argument;
    uint64_t and_mask; /* 0: any */
    bool differs;      /* the argument is not the value */
    int refusal;       /* errno of one that is refused; 0: EPERM */
};

enum kiln_calls { KILN_ONLY_THESE_CALLS, KILN_ALL_BUT_THESE_CALLS };

/* From now on, all threads of this process, and what they start, can make some system calls and no
 * others, which fail: as unknown ones (ENOSYS) where only some are named, as forbidden ones (EPERM)
 * else. Does nothing where there is no seccomp; KILN_DEVICE_FAILED when the kernel refuses. */
bool kiln_seccomp_confine(enum kiln_calls which, const struct kiln_system_call *calls, size_t count,
                          struct kiln_error *error);

#endif
