/* This file confines the process before it reads a byte of an untrusted file. It limits memory,
 * files and processor time, and allows no files by name, no new descriptors but those that kiln
 * sends, no other processes and no new code. The decoders are not trusted, so several layers
 * confine them: resource limits, Landlock and seccomp. */
#include "base/confine.h"

#include <errno.h>
#include <seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/error.h"
#include "decode.h"

/* The most memory for each kind of file, in bytes beyond those that the process has when it begins.
 * A picture of the largest size takes 1 GiB as floats in the decoder, and 1 GiB in kiln's layout.
 */
static const uint64_t most_memory_of[] = {
    [KILN_DECODE_PNG] = (uint64_t)1 << 30,      [KILN_DECODE_JPEG] = (uint64_t)1 << 30,
    [KILN_DECODE_WEBP] = (uint64_t)2 << 30,     [KILN_DECODE_TIFF] = (uint64_t)3 << 30,
    [KILN_DECODE_PROFILE] = (uint64_t)3 << 30,  [KILN_DECODE_PICTURE] = (uint64_t)3 << 30,
    [KILN_DECODE_EXR] = (uint64_t)3 << 30,      [KILN_DECODE_VIDEO] = (uint64_t)4 << 30,
    [KILN_DECODE_OPENEXR] = (uint64_t)3 << 30,  [KILN_DECODE_MESH] = (uint64_t)1280 << 20,
    [KILN_DECODE_DRACO] = (uint64_t)1280 << 20,
};

enum {
    MOST_CPU_SECONDS = 3600, /* for all files; kiln waits less long for one file or frame */
    MOST_DESCRIPTORS = 16,   /* the three of every process, the socket, and files from kiln */
    MOST_STACK = 8 << 20,    /* bytes; the usual limit, under which the libraries are tested */
    OTHER_SPACE = 64 << 20,  /* bytes of address space beyond the memory: gaps for alignment */
};

/* The limit of memory that this process has set, in bytes; 0 if a lower limit was there already. */
static uint64_t own_limit;

/* Whether own_limit is the limit of the job, which is lower than that of the kind of file. */
static bool is_limited;

bool decode_out_of_memory(struct kiln_error *error)
{
    if (own_limit == 0)
        return kiln_error_no_memory(error, "decoding a picture");
    return kiln_error_set(error, is_limited ? KILN_OVER_LIMIT : KILN_INVALID_INPUT,
                          "decoding takes more than %llu MiB of memory",
                          (unsigned long long)(own_limit >> 20));
}

/* The struct holds the memory that the process takes before it decodes, in bytes. */
struct in_use {
    uint64_t space; /* the size of its address space */
    uint64_t data;  /* what RLIMIT_DATA counts */
};

/* Finds what is in use, from the first and sixth number of /proc/self/statm. */
static struct in_use find_in_use(void)
{
    char text[256] = "";
    FILE *file = fopen("/proc/self/statm", "re");
    if (file) {
        if (!fgets(text, sizeof text, file))
            text[0] = '\0';
        fclose(file);
    }
    const char *number = text;
    for (int i = 0; i < 5 && number; i++) {
        number = strchr(number, ' ');
        number = number ? number + 1 : NULL;
    }
    /* In kiln's sandbox, /proc cannot be read. The libraries take less than this. */
    const struct in_use unknown = {(uint64_t)1 << 30, (uint64_t)256 << 20};
    const uint64_t page = (uint64_t)sysconf(_SC_PAGESIZE);
    return number
               ? (struct in_use){strtoull(text, NULL, 10) * page, strtoull(number, NULL, 10) * page}
               : unknown;
}

/* Lowers a resource limit. Returns true if the soft limit was higher. */
static bool lower(int resource, uint64_t soft, uint64_t hard)
{
    struct rlimit limit;
    if (getrlimit((__rlimit_resource_t)resource, &limit) != 0)
        return false;
    const bool lowers = soft < limit.rlim_cur;
    limit.rlim_cur = lowers ? soft : limit.rlim_cur;
    limit.rlim_max = hard < limit.rlim_max ? hard : limit.rlim_max;
    setrlimit((__rlimit_resource_t)resource, &limit);
    return lowers;
}

static void limit_resources(enum kiln_decode_kind kind, uint64_t most_memory)
{
    struct rlimit space;
    const struct in_use now = find_in_use();
    const uint64_t own = most_memory_of[kind];
    const uint64_t most = own < most_memory ? own : most_memory;
    lower(RLIMIT_CORE, 0, 0);
    lower(RLIMIT_FSIZE, 0, 0);
    lower(RLIMIT_NPROC, 0, 0);
    lower(RLIMIT_NOFILE, MOST_DESCRIPTORS, MOST_DESCRIPTORS);
    if (kind != KILN_DECODE_VIDEO)
        lower(RLIMIT_CPU, MOST_CPU_SECONDS, MOST_CPU_SECONDS);
    lower(RLIMIT_STACK, MOST_STACK, MOST_STACK);
    /* Sanitizers have tables that are larger than any limit, so there is no limit with them.
     * RLIMIT_DATA counts neither the stack nor memory that is only read, whose tables of pages take
     * memory of the kernel: the address space is limited, too, to what all decoders stay below. */
    if (!KILN_UNCONFINED && lower(RLIMIT_DATA, now.data + most, now.data + most) &&
        getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur == RLIM_INFINITY)
        own_limit = most;
    if (!KILN_UNCONFINED)
        lower(RLIMIT_AS, now.space + most + MOST_STACK + OTHER_SPACE,
              now.space + most + MOST_STACK + OTHER_SPACE);
    is_limited = most_memory < own;
}

#define CALL(name)                                                                                 \
    {                                                                                              \
        .number = SCMP_SYS(name)                                                                   \
    }
#define CALL_WITHOUT(name, which, bits)                                                            \
    {                                                                                              \
        .number = SCMP_SYS(name), .argument = which, .mask = bits                                  \
    }

/* Lists all that the libraries of any kind use, and no more. Sending needs no call but write, which
 * leaves no way to send descriptors, addresses or urgent data. */
static const struct kiln_system_call allowed[] = {
    CALL(recvmsg), /* requests from kiln, with descriptors */
    CALL(write),   /* answers */
    CALL(read),
    CALL(pread64),
    CALL(lseek),
    CALL(close),
    /* memory, but none that is executable */
    CALL(brk),
    CALL(munmap),
    CALL(mremap),
    CALL(madvise),
    CALL_WITHOUT(mprotect, 2, PROT_EXEC),
    CALL(sysinfo), /* qsort of the C library asks how much memory there is */
    CALL(futex),
    CALL(clock_gettime), /* where the kernel's clock is no memory of the process */
    CALL(gettimeofday),
    /* abort */
    CALL(getpid),
    CALL(gettid),
    CALL(restart_syscall), /* after SIGSTOP and SIGCONT */
    CALL(exit),
    CALL(exit_group),
};

bool decode_confine(enum kiln_decode_kind kind, uint64_t most_memory, struct kiln_error *error)
{
    struct kiln_system_call calls[sizeof allowed / sizeof *allowed + 3];
    size_t count = sizeof allowed / sizeof *allowed;
    memcpy(calls, allowed, sizeof allowed);
    /* mmap may only map private memory, which the limit counts: no shared memory, and no stack that
     * grows. */
    static const int maps[] = {SCMP_SYS(mmap), SCMP_SYS(mmap2)};
    for (size_t i = 0; i < 2; i++)
        calls[count++] = (struct kiln_system_call){.number = maps[i],
                                                   .argument = 2,
                                                   .mask = PROT_EXEC,
                                                   .and_argument = 3,
                                                   .and_none_of = MAP_SHARED | MAP_GROWSDOWN};
    /* abort() sends a signal to this process. No other process may get one. */
    calls[count++] = (struct kiln_system_call){
        .number = SCMP_SYS(tgkill), .mask = UINT32_MAX, .value = (uint64_t)getpid()};
    limit_resources(kind, most_memory);
    /* The kernel ends this process with the thread of kiln that started it, whatever the process
     * does. */
    return (prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0) == 0 ||
            kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "PR_SET_PDEATHSIG")) &&
           kiln_seccomp_open(error) &&
           (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 ||
            kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "no_new_privs")) &&
           (prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) == 0 ||
            kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "PR_SET_DUMPABLE")) &&
           kiln_landlock_confine(NULL, 0, error) &&
           kiln_seccomp_confine(KILN_ONLY_THESE_CALLS, calls, count, error);
}
