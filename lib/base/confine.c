/* Takes rights from the process for good. Landlock limits the files that it opens, TCP, abstract
 * Unix sockets and signals; seccomp limits system calls. This file reaches Landlock by raw system
 * calls, since the C library has no functions for them, and seccomp through libseccomp, which knows
 * the numbers of system calls on each kind of machine. decode/confine.c and job/sandbox.c use it
 * when a process starts. */
#include "base/confine.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <seccomp.h>
#include <stddef.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "base/error.h"
#include "base/library.h"

/* ---- Landlock -------------------------------------------------------------------------------- */

/* Constants of the kernel that <linux/landlock.h> of Debian 12 does not have yet. The values are
 * from Documentation/userspace-api/landlock.rst of Linux. */
enum {
    FS_TRUNCATE = 1 << 14,               /* since version 3 of Landlock */
    FS_IOCTL_DEV = 1 << 15,              /* since version 5 */
    NET_BIND_TCP = 1 << 0,               /* since version 4 */
    NET_CONNECT_TCP = 1 << 1,            /* since version 4 */
    SCOPE_ABSTRACT_UNIX_SOCKET = 1 << 0, /* since version 6 */
    SCOPE_SIGNAL = 1 << 1,               /* since version 6 */
};

/* The kernel's struct landlock_ruleset_attr. The kernel reads it, so its members must not be moved.
 * A right that is named here is refused everywhere, except at places that grant it. */
struct ruleset {
    uint64_t files, network, scoped;
};

static const uint64_t READING = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
static const uint64_t WRITING = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR |
                                LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_DIR |
                                LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SYM |
                                LANDLOCK_ACCESS_FS_REFER | FS_TRUNCATE;
/* The rights that no place grants, so that nobody has them. */
static const uint64_t NEVER_GRANTED = LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_SOCK |
                                      LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK |
                                      FS_IOCTL_DEV;
/* The rights that can be granted for a file that is no folder. */
static const uint64_t FILE_RIGHTS = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE |
                                    LANDLOCK_ACCESS_FS_WRITE_FILE | FS_TRUNCATE | FS_IOCTL_DEV;

int kiln_landlock_version(void)
{
    const long version = KILN_UNCONFINED ? 0
                                         : syscall(SYS_landlock_create_ruleset, NULL, 0,
                                                   LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? (int)version : 0;
}

/* Returns all rights that a version of Landlock knows. The kernel refuses a ruleset with others. */
static struct ruleset all_rights(int version)
{
    struct ruleset all = {.files = LANDLOCK_ACCESS_FS_EXECUTE | READING | WRITING | NEVER_GRANTED};
    if (version < 2)
        all.files &= ~(uint64_t)LANDLOCK_ACCESS_FS_REFER;
    if (version < 3)
        all.files &= ~(uint64_t)FS_TRUNCATE;
    if (version < 5)
        all.files &= ~(uint64_t)FS_IOCTL_DEV;
    if (version >= 4)
        all.network = NET_BIND_TCP | NET_CONNECT_TCP;
    if (version >= 6)
        all.scoped = SCOPE_ABSTRACT_UNIX_SOCKET | SCOPE_SIGNAL;
    return all;
}

/* Grants the rights of a place. True also where there is no such place. */
static bool add_place(int ruleset, uint64_t known, const struct kiln_place *place)
{
    struct landlock_path_beneath_attr rule = {
        .parent_fd = open(place->path, O_PATH | O_CLOEXEC),
        .allowed_access = (place->may & KILN_MAY_READ ? READING : 0) |
                          (place->may & KILN_MAY_WRITE ? WRITING : 0) |
                          (place->may & KILN_MAY_EXECUTE ? LANDLOCK_ACCESS_FS_EXECUTE : 0)};
    if (rule.parent_fd < 0)
        return errno == ENOENT || errno == ENOTDIR;
    rule.allowed_access &= known;
    bool ok = syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
    if (!ok && errno == EINVAL) { /* the place is a file, which cannot have a folder's rights */
        rule.allowed_access &= FILE_RIGHTS;
        ok = syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
    }
    const int reason = errno;
    close(rule.parent_fd);
    errno = reason;
    return ok;
}

bool kiln_landlock_confine(const struct kiln_place *places, size_t count, struct kiln_error *error)
{
    const int version = kiln_landlock_version();
    if (version == 0)
        return true;
    const struct ruleset all = all_rights(version);
    const size_t size = version >= 6   ? sizeof all
                        : version >= 4 ? offsetof(struct ruleset, scoped)
                                       : offsetof(struct ruleset, network);
    const int ruleset = (int)syscall(SYS_landlock_create_ruleset, &all, size, 0);
    if (ruleset < 0)
        return kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno,
                                    "cannot make a ruleset of Landlock");
    bool ok = true;
    for (size_t i = 0; ok && i < count; i++) {
        ok = add_place(ruleset, all.files, &places[i]) ||
             kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "cannot allow %s by Landlock",
                                  places[i].path);
    }
    if (ok && (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
               syscall(SYS_landlock_restrict_self, ruleset, 0) != 0))
        ok = kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno,
                                  "cannot confine the process by Landlock");
    close(ruleset);
    return ok;
}

/* ---- seccomp --------------------------------------------------------------------------------- */

#define FUNCTIONS(F)                                                                               \
    F(seccomp_init)                                                                                \
    F(seccomp_attr_set)                                                                            \
    F(seccomp_rule_add_array)                                                                      \
    F(seccomp_load)                                                                                \
    F(seccomp_release)

struct seccomp {
    FUNCTIONS(KILN_LIBRARY_POINTER)
};

static bool open_library(struct seccomp *library, struct kiln_error *error)
{
#define FIND(function) {#function, &library->function},
    const struct kiln_library_function functions[] = {FUNCTIONS(FIND)};
    return kiln_library_open("libseccomp.so.2", "libseccomp2", functions,
                             sizeof functions / sizeof *functions, error);
}

static bool kernel_has_seccomp(void)
{
    return !KILN_UNCONFINED && prctl(PR_GET_SECCOMP, 0, 0, 0, 0) >= 0;
}

bool kiln_has_seccomp(void)
{
    struct seccomp library;
    struct kiln_error ignored = {0};
    return kernel_has_seccomp() && open_library(&library, &ignored);
}

/* Loads libseccomp while its file can still be read. The library stays loaded, so that
 * kiln_seccomp_confine can open it after Landlock has hidden the file. */
bool kiln_seccomp_open(struct kiln_error *error)
{
    struct seccomp library;
    return !kernel_has_seccomp() || open_library(&library, error);
}

/* Adds a rule for each system call of a list. `only`: the calls are allowed; otherwise they are
 * refused. Returns 0, or a negative errno. */
static int add_calls(const struct seccomp *library, scmp_filter_ctx filter, bool only,
                     const struct kiln_system_call *calls, size_t count)
{
    int status = library->seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC, 1);
    for (size_t i = 0; status == 0 && i < count; i++) {
        const struct kiln_system_call *call = &calls[i];
        const struct scmp_arg_cmp conditions[2] = {
            {.arg = call->argument,
             .op = call->differs ? SCMP_CMP_NE : SCMP_CMP_MASKED_EQ,
             .datum_a = call->differs ? call->value : call->mask,
             .datum_b = call->differs ? 0 : call->value},
            {.arg = call->and_argument, .op = SCMP_CMP_MASKED_EQ, .datum_a = call->and_none_of}};
        const unsigned first = call->mask != 0 || call->differs, second = call->and_none_of != 0;
        const uint32_t refused = SCMP_ACT_ERRNO((uint32_t)(call->refusal ? call->refusal : EPERM));
        status = library->seccomp_rule_add_array(filter, only ? SCMP_ACT_ALLOW : refused,
                                                 call->number, first + second, conditions);
    }
    return status;
}

bool kiln_seccomp_confine(enum kiln_call_list which, const struct kiln_system_call *calls,
                          size_t count, struct kiln_error *error)
{
    struct seccomp library;
    if (!kernel_has_seccomp())
        return true;
    if (!open_library(&library, error))
        return false;
    const bool only = which == KILN_ONLY_THESE_CALLS;
    scmp_filter_ctx filter = library.seccomp_init(only ? SCMP_ACT_ERRNO(ENOSYS) : SCMP_ACT_ALLOW);
    if (!filter)
        return kiln_error_no_memory(error, "a seccomp filter");
    int status = add_calls(&library, filter, only, calls, count);
    if (status == 0)
        status = library.seccomp_load(filter);
    library.seccomp_release(filter);
    return status == 0 || kiln_error_set_errno(error, KILN_DEVICE_FAILED, -status,
                                               "cannot install a seccomp filter");
}

/* ---- commands of system calls ---------------------------------------------------------------- */

/* A filter of instructions for the kernel. libseccomp cannot express "every command but these",
 * since one rule of it compares an argument only once. */
struct program {
    struct sock_filter steps[256];
    size_t count;
};

/* Adds an instruction; where it compares, `yes` and `no` are the instructions to skip. */
static void add_step(struct program *program, unsigned code, size_t value, size_t yes, size_t no)
{
    program->steps[program->count++] =
        (struct sock_filter){(uint16_t)code, (uint8_t)yes, (uint8_t)no, (uint32_t)value};
}

/* Adds the instructions that refuse a call with another command than those of its list. */
static void add_commands(struct program *program, const struct kiln_commands *call)
{
    const size_t low = __BYTE_ORDER == __LITTLE_ENDIAN ? 0 : sizeof(uint32_t);
    const size_t place = offsetof(struct seccomp_data, args) + call->argument * sizeof(uint64_t);
    add_step(program, BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr), 0, 0);
    add_step(program, BPF_JMP | BPF_JEQ | BPF_K, (size_t)call->number, 0, call->count + 3);
    add_step(program, BPF_LD | BPF_W | BPF_ABS, place + low, 0, 0);
    for (size_t i = 0; i < call->count; i++)
        add_step(program, BPF_JMP | BPF_JEQ | BPF_K, call->allowed[i], call->count - i, 0);
    add_step(program, BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM, 0, 0);
    add_step(program, BPF_RET | BPF_K, SECCOMP_RET_ALLOW, 0, 0);
}

bool kiln_seccomp_limit_commands(const struct kiln_commands *calls, size_t count,
                                 struct kiln_error *error)
{
    struct program program = {.count = 0};
    if (!kernel_has_seccomp())
        return true;
    for (size_t i = 0; i < count; i++) {
        const size_t needed = calls[i].count + 5;
        if (needed + 1 > sizeof program.steps / sizeof *program.steps - program.count)
            return kiln_error_set(error, KILN_DEVICE_FAILED, "too many commands of system calls");
        add_commands(&program, &calls[i]);
    }
    add_step(&program, BPF_RET | BPF_K, SECCOMP_RET_ALLOW, 0, 0);
    const struct sock_fprog filter = {(unsigned short)program.count, program.steps};
    long status = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (status == 0)
        status = syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &filter);
    if (status > 0) /* the number of a thread that has filters of its own */
        errno = ESRCH;
    return status == 0 || kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno,
                                               "cannot limit the commands of system calls");
}
