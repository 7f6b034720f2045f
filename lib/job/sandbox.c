/* Confines the process to a job's own folders (Landlock) and forbids the system calls that no job
 * needs (seccomp). kiln-decode can still be started: its file, the dynamic linker and libraries
 * stay readable. kiln-decode confines itself further (decode/confine.c). */
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <sched.h>
#include <seccomp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "asset/loader/helper.h"
#include "base/cache.h"
#include "base/confine.h"
#include "base/error.h"
#include "base/sized.h"
#include "base/temporary.h"
#include "kiln_program.h"

enum { MOST_PLACES = 256 };

struct places {
    struct kiln_place items[MOST_PLACES];
    size_t count;
    struct kiln_error *error;
};

/* Adds a place; its path must outlive the places. */
static bool add(struct places *places, const char *path, unsigned may)
{
    if (places->count == MOST_PLACES)
        return kiln_error_set(places->error, KILN_USAGE,
                              "a sandbox allows at most %d files and folders, and there are more",
                              MOST_PLACES);
    places->items[places->count++] = (struct kiln_place){path, may};
    return true;
}

/* ---- where a job writes ---------------------------------------------------------------------- */

/* Finds the folder of a pattern and makes it if it is missing; the caller frees it. */
static char *make_folder(const char *pattern, struct kiln_error *error)
{
    struct stat status;
    char *folder = malloc(strlen(pattern) + 3);
    if (!folder) {
        kiln_error_no_memory(error, "a sandbox");
        return NULL;
    }
    strcpy(folder, pattern);
    if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode)) {
        folder[strcspn(folder, "{#%")] = '\0';
        char *slash = strrchr(folder, '/');
        strcpy(slash ? slash + 1 : folder, slash ? "" : "./");
        if (!kiln_make_parent_folders(folder, error)) {
            free(folder);
            return NULL;
        }
    }
    return folder;
}

static bool add_writable(struct places *places, const struct kiln_sandbox_params *params,
                         char **folders)
{
    for (size_t i = 0; i < params->writable_count; i++) {
        folders[i] = make_folder(params->writable[i], places->error);
        if (!folders[i] || !add(places, folders[i], KILN_MAY_READ | KILN_MAY_WRITE))
            return false;
    }
    return true;
}

/* ---- what every job needs -------------------------------------------------------------------- */

/* Finds the dynamic linker, which the kernel starts with kiln-decode. */
static int find_linker(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size;
    const char **linker = user;
    if (info->dlpi_addr == getauxval(AT_BASE) && *info->dlpi_name)
        *linker = info->dlpi_name;
    return *linker != NULL;
}

/* Adds the folders of libraries, and the files of the system that the C library reads. */
static bool add_machine(struct places *places, char *library_path)
{
    static const struct kiln_place common[] = {
        {"/usr", KILN_MAY_READ},
        {"/lib", KILN_MAY_READ},
        {"/lib32", KILN_MAY_READ},
        {"/lib64", KILN_MAY_READ},
        {"/etc/ld.so.cache", KILN_MAY_READ},
        {"/proc/self", KILN_MAY_READ},
        {"/sys/devices/system/cpu", KILN_MAY_READ},
        {"/sys/kernel/mm/transparent_hugepage", KILN_MAY_READ}, /* malloc of kiln-decode */
        {"/dev/null", KILN_MAY_READ | KILN_MAY_WRITE},
        {"/dev/full", KILN_MAY_READ | KILN_MAY_WRITE},
    };
    for (size_t i = 0; i < sizeof common / sizeof *common; i++) {
        if (!add(places, common[i].path, common[i].may))
            return false;
    }
    char *rest = library_path;
    for (const char *folder; rest && (folder = strsep(&rest, ":"));) {
        if (*folder && !add(places, folder, KILN_MAY_READ))
            return false;
    }
    return true;
}

/* The modules that kiln-decode opens for some files. They lie beside it (decode/module.c). */
static const char *const modules[] = {"kiln-openexr.so", "kiln-draco.so"};

enum { MODULES = sizeof modules / sizeof *modules };

struct helper_paths {
    char program[KILN_PATH_SIZE], modules[MODULES][KILN_PATH_SIZE];
};

static bool add_module(struct places *places, const char *program, const char *module,
                       char path[KILN_PATH_SIZE])
{
    const int folder = (int)(strrchr(program, '/') - program);
    const int length = snprintf(path, KILN_PATH_SIZE, "%.*s/%s", folder, program, module);
    return length >= KILN_PATH_SIZE || access(path, R_OK) != 0 || add(places, path, KILN_MAY_READ);
}

/* Adds kiln-decode and its modules. A job without pictures runs without them. */
static bool add_helper(struct places *places, struct helper_paths *paths)
{
    const char *linker = NULL;
    struct kiln_error ignored = {0};
    dl_iterate_phdr(find_linker, &linker);
    if (linker && !add(places, linker, KILN_MAY_READ | KILN_MAY_EXECUTE))
        return false;
    if (!kiln_helper_find(paths->program, &ignored))
        return true;
    if (!add(places, paths->program, KILN_MAY_READ | KILN_MAY_EXECUTE))
        return false;
    for (int i = 0; i < MODULES; i++) {
        if (!add_module(places, paths->program, modules[i], paths->modules[i]))
            return false;
    }
    return true;
}

static bool add_cache(struct places *places, char cache[KILN_PATH_SIZE])
{
    struct kiln_error ignored = {0};
    if (!kiln_cache_folder(cache))
        return true;
    strcat(cache, "/"); /* path has room for one more character */
    return !kiln_make_parent_folders(cache, &ignored) ||
           add(places, cache, KILN_MAY_READ | KILN_MAY_WRITE);
}

/* ---- calls ----------------------------------------------------------------------------------- */

#define CALL(name)                                                                                 \
    {                                                                                              \
        .number = SCMP_SYS(name)                                                                   \
    }
#define CALL_WITH(name, bits)                                                                      \
    {                                                                                              \
        .number = SCMP_SYS(name), .mask = bits, .value = bits                                      \
    }
#define CALL_OF_OTHERS(name)                                                                       \
    {                                                                                              \
        .number = SCMP_SYS(name), .differs = true                                                  \
    }
#define CALL_UNLESS_NULL(name, which)                                                              \
    {                                                                                              \
        .number = SCMP_SYS(name), .argument = which, .differs = true                               \
    }

/* System calls that no job makes and that have been used to leave sandboxes or to attack the
 * kernel. */
static const struct kiln_system_call refused[] = {
    CALL(socket),
    CALL(connect),
    CALL(bind),
    CALL(listen),
    CALL(accept),
    CALL(accept4),
    CALL(execveat),
    CALL(ptrace),
    CALL(process_vm_readv),
    CALL(process_vm_writev),
    CALL(pidfd_getfd),
    CALL(process_madvise),
    CALL(kcmp),
    CALL(mount),
    CALL(umount2),
    CALL(pivot_root),
    CALL(chroot),
    CALL(unshare),
    CALL(setns),
    CALL(open_tree),
    CALL(move_mount),
    CALL(fsopen),
    CALL(fsconfig),
    CALL(fsmount),
    CALL(fspick),
    CALL(mount_setattr),
    CALL(name_to_handle_at),
    CALL(open_by_handle_at),
    CALL(init_module),
    CALL(finit_module),
    CALL(delete_module),
    CALL(kexec_load),
    CALL(kexec_file_load),
    CALL(reboot),
    CALL(swapon),
    CALL(swapoff),
    CALL(vhangup),
    CALL(syslog),
    CALL(acct),
    CALL(quotactl),
    CALL(quotactl_fd),
    CALL(bpf),
    CALL(perf_event_open),
    CALL(userfaultfd),
    CALL(io_uring_setup),
    CALL(io_uring_enter),
    CALL(io_uring_register),
    CALL(add_key),
    CALL(request_key),
    CALL(keyctl),
    CALL(personality),
    CALL(settimeofday),
    CALL(clock_settime),
    CALL(adjtimex),
    CALL(clock_adjtime),
    CALL(sethostname),
    CALL(setdomainname),
    CALL(iopl),
    CALL(ioperm),
    CALL(modify_ldt),
    CALL(mknod),
    CALL(mknodat),
    CALL(setuid),
    CALL(setgid),
    CALL(setreuid),
    CALL(setregid),
    CALL(setresuid),
    CALL(setresgid),
    CALL(setgroups),
    CALL(capset),
    /* changes that Landlock does not restrict */
    CALL(chmod),
    CALL(fchmod),
    CALL(fchmodat),
    CALL(chown),
    CALL(fchown),
    CALL(lchown),
    CALL(fchownat),
    CALL(utime),
    CALL(utimes),
    CALL(utimensat),
    CALL(futimesat),
    CALL(setxattr),
    CALL(lsetxattr),
    CALL(fsetxattr),
    CALL(removexattr),
    CALL(lremovexattr),
    CALL(fremovexattr),
    CALL(truncate), /* Landlock restricts it from version 3 on */
    CALL(inotify_add_watch),
    CALL(fanotify_init),
    CALL(fanotify_mark),
    /* Objects of System V belong to a user. A process reaches them by a number, which it can guess,
     * so not only the calls that open them are refused. */
    CALL(shmget),
    CALL(shmat),
    CALL(shmctl),
    CALL(msgget),
    CALL(msgctl),
    CALL(msgsnd),
    CALL(msgrcv),
    CALL(semget),
    CALL(semctl),
    CALL(semop),
    CALL(semtimedop),
    CALL(mq_open),
    CALL(mq_unlink),
    CALL(memfd_create),
    CALL(memfd_secret),
    /* What others share with the process by a descriptor that it inherits: connections and pipes.
     * sendmsg stays, by which kiln-decode gets a file. */
    CALL_UNLESS_NULL(sendto, 4), /* an address */
    CALL(sendmmsg),
    CALL(recvmmsg),
    CALL(shutdown),
    CALL(setsockopt),
    CALL(splice),
    CALL(tee),
    CALL(vmsplice),
    CALL(sendfile),
    /* calls that change other processes */
    CALL_OF_OTHERS(prlimit64),
    CALL(setpriority),
    CALL(sched_setscheduler),
    CALL(sched_setparam),
    CALL(sched_setattr),
    CALL_OF_OTHERS(sched_setaffinity),
    CALL(ioprio_set),
    CALL(tkill),
    CALL(migrate_pages),
    CALL(move_pages),
    /* A supervisor ends a job by its process group, which no process of the job may leave. */
    CALL(setsid),
    CALL(setpgid),
    /* Namespaces of the process's own. clone3 is refused with ENOSYS, because a filter cannot see
     * its flags; the C library then calls clone. */
    {.number = SCMP_SYS(clone3), .refusal = ENOSYS},
    CALL_WITH(clone, CLONE_NEWUSER),
    CALL_WITH(clone, CLONE_NEWNS),
    CALL_WITH(clone, CLONE_NEWNET),
    CALL_WITH(clone, CLONE_NEWPID),
    CALL_WITH(clone, CLONE_NEWIPC),
    CALL_WITH(clone, CLONE_NEWUTS),
    CALL_WITH(clone, CLONE_NEWCGROUP),
};

/* Calls newer than libseccomp 2.5, which has no names for them. They have the same numbers on every
 * kind of processor. Some change files in ways that Landlock does not know (fchmodat2, setxattrat,
 * file_setattr). They fail with ENOSYS, so that programs fall back to an older call. */
enum { FIRST_NEW_CALL = 451, END_OF_NEW_CALLS = 520 };

/* Calls that empty a file which is opened for reading alone, which Landlock restricts from version
 * 3 on. A filter cannot see the flags of openat2; the loader does without that call. */
static const struct kiln_system_call before_landlock_3[] = {
    {.number = SCMP_SYS(open), .argument = 1, .mask = O_TRUNC | O_ACCMODE, .value = O_TRUNC},
    {.number = SCMP_SYS(openat), .argument = 2, .mask = O_TRUNC | O_ACCMODE, .value = O_TRUNC},
    {.number = SCMP_SYS(openat2), .refusal = ENOSYS},
};

/* The commands of ioctl that a job needs: those by which isatty, a program that asks for the size
 * of its terminal, and an interpreter work. Others act on what a descriptor leads to and others
 * share: they type into a terminal (TIOCSTI, TIOCLINUX), change it, or make a shared pipe fail
 * (FIONBIO). */
static const uint32_t allowed_of_ioctl[] = {
    TCGETS,     0x802c542a, /* TCGETS2, whose header does not go with <sys/ioctl.h> */
    TIOCGWINSZ, FIONREAD,   FIOCLEX, FIONCLEX,
};

/* The commands of fcntl that change nothing but the process's own descriptors and locks. Others
 * change the open file, which others may share (F_SETFL), or send signals to others (F_SETOWN). */
static const uint32_t allowed_of_fcntl[] = {
    F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD,     F_SETFD,     F_GETFL,      F_GETLK,
    F_SETLK, F_SETLKW,        F_OFD_GETLK, F_OFD_SETLK, F_OFD_SETLKW, F_GETPIPE_SZ,
};

static bool limit_commands(struct kiln_error *error)
{
    static const struct kiln_commands calls[] = {
        {SYS_ioctl, 1, allowed_of_ioctl, sizeof allowed_of_ioctl / sizeof *allowed_of_ioctl},
        {SYS_fcntl, 1, allowed_of_fcntl, sizeof allowed_of_fcntl / sizeof *allowed_of_fcntl},
    };
    return kiln_seccomp_limit_commands(calls, sizeof calls / sizeof *calls, error);
}

static bool refuse_calls(struct kiln_error *error)
{
    enum {
        NAMED = sizeof refused / sizeof *refused,
        NEW = END_OF_NEW_CALLS - FIRST_NEW_CALL,
        OPENING = sizeof before_landlock_3 / sizeof *before_landlock_3,
    };
    struct kiln_system_call calls[NAMED + NEW + OPENING];
    size_t count = NAMED;
    memcpy(calls, refused, sizeof refused);
    for (int number = FIRST_NEW_CALL; number < END_OF_NEW_CALLS; number++)
        calls[count++] = (struct kiln_system_call){.number = number, .refusal = ENOSYS};
    if (kiln_landlock_version() < 3) {
        memcpy(calls + count, before_landlock_3, sizeof before_landlock_3);
        count += OPENING;
    }
    return kiln_seccomp_confine(KILN_ALL_BUT_THESE_CALLS, calls, count, error);
}

/* ---- entering -------------------------------------------------------------------------------- */

static struct kiln_sandbox_support find_support(void)
{
    return (struct kiln_sandbox_support){.size = sizeof(struct kiln_sandbox_support),
                                         .landlock = kiln_landlock_version(),
                                         .seccomp = kiln_has_seccomp(),
                                         .off = KILN_UNCONFINED};
}

void kiln_sandbox_get_support(struct kiln_sandbox_support *support)
{
    const struct kiln_sandbox_support found = find_support();
    kiln_sized_give(support, &found);
}

static bool check_support(const struct kiln_sandbox_params *params, struct kiln_error *error)
{
    const struct kiln_sandbox_support has = find_support();
    if (!params->required || (has.landlock && has.seccomp))
        return true;
    return kiln_error_set(error, KILN_DEVICE_FAILED, "no sandbox: %s",
                          has.off ? "this program was built with sanitizers"
                          : !has.landlock
                              ? "the kernel has no Landlock (Linux 5.13 or later, switched "
                                "on by the boot option lsm=)"
                              : "the kernel has no seccomp, or libseccomp2 is not installed");
}

static bool confine(const struct kiln_sandbox_params *params, char **folders, char *library_path,
                    struct kiln_error *error)
{
    struct places places = {.error = error};
    char cache[KILN_PATH_SIZE];
    struct helper_paths helper;
    for (size_t i = 0; i < params->readable_count; i++) {
        if (!add(&places, params->readable[i], KILN_MAY_READ))
            return false;
    }
    return add_writable(&places, params, folders) && add_machine(&places, library_path) &&
           add_cache(&places, cache) && add_helper(&places, &helper) && kiln_seccomp_open(error) &&
           kiln_landlock_confine(places.items, places.count, error) && limit_commands(error) &&
           refuse_calls(error);
}

bool kiln_sandbox_enter(const struct kiln_sandbox_params *given, struct kiln_error *error)
{
    struct kiln_sandbox_params taken = kiln_sandbox_defaults();
    const struct kiln_sandbox_params *params = &taken;
    const char *path = kiln_environment("LD_LIBRARY_PATH");
    if (!kiln_sized_take(&taken, given, "kiln_sandbox_params", error) ||
        !check_support(params, error))
        return false;
    char *library_path = strdup(path ? path : "");
    char **folders = calloc(params->writable_count + 1, sizeof *folders);
    const bool ok = library_path && folders ? confine(params, folders, library_path, error)
                                            : kiln_error_no_memory(error, "a sandbox");
    for (size_t i = 0; folders && i < params->writable_count; i++)
        free(folders[i]);
    free(folders);
    free(library_path);
    return ok;
}
