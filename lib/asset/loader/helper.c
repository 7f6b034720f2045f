/* This file starts, talks to and ends the processes of kiln-decode: it is kiln's end of the socket.
 * A process gets no descriptors but the socket, and ignores the terminal's signals, since it ends
 * when kiln does. Nothing that it says is trusted: kiln waits with time limits, reads only as many
 * bytes as it asked for, and checks them. */
#include "asset/loader/helper.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <link.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/budget.h"
#include "base/clock.h"
#include "base/error.h"
#include "kiln_program.h"

enum { WAIT_MS = 20 };

struct kiln_helper {
    enum kiln_decode_kind kind;
    pid_t process;   /* 0: it has ended */
    bool is_limited; /* the job limits the process's memory */
    /* pidfd of the process, so that no other process is meant by its number; -1: the kernel has
     * none */
    int handle;
    int socket;
    /* When the present request began: the processor time that the process had taken, and the real
     * time. A process that sleeps takes no processor time, so both are limited. */
    double cpu_s, began_s;
    double most_s;              /* the limit of real time */
    struct kiln_budget *budget; /* counts the process's processor time; may be NULL */
    int64_t counted_us;         /* what the budget has counted */
    bool is_broken;
};

/* ---- finding the program --------------------------------------------------------------------- */

static bool is_program(const char *path)
{
    return access(path, X_OK) == 0;
}

/* Finds the folder of the program or shared library that holds this code. */
static bool find_own_folder(char folder[KILN_PATH_SIZE])
{
    static const char here = 0;
    Dl_info info;
    struct link_map *map = NULL;
    /* The dynamic linker has no name for the main program; the kernel has its path. */
    const bool is_library =
        dladdr1(&here, &info, (void **)&map, RTLD_DL_LINKMAP) != 0 && map && *map->l_name;
    char *real = realpath(is_library ? map->l_name : "/proc/self/exe", NULL);
    const char *slash = real ? strrchr(real, '/') : NULL;
    const bool fits = slash && slash - real < KILN_PATH_SIZE;
    if (fits)
        snprintf(folder, KILN_PATH_SIZE, "%.*s", (int)(slash - real), real);
    free(real);
    return fits;
}

static bool put_path(char path[KILN_PATH_SIZE], const char *folder, const char *subfolder)
{
    const int length = snprintf(path, KILN_PATH_SIZE, "%s/%skiln-decode", folder, subfolder);
    return length > 0 && length < KILN_PATH_SIZE && is_program(path);
}

bool kiln_helper_find(char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    /* Paths from the folder of a program as built, of a test as built, of an installed program, of
     * an installed library of one or several architectures. */
    static const char *const subfolders[] = {"libexec/kiln/", "../libexec/kiln/",
                                             "../../libexec/kiln/"};
    char folder[KILN_PATH_SIZE];
    const char *set = kiln_environment("KILN_LIBEXEC_DIR");
    if (set)
        return put_path(path, set, "") ||
               kiln_error_set(error, KILN_DEVICE_FAILED,
                              "%s: the program that decodes pictures, videos and meshes is missing "
                              "(KILN_LIBEXEC_DIR is set)",
                              path);
    const bool known = find_own_folder(folder);
    for (size_t i = 0; known && i < sizeof subfolders / sizeof *subfolders; i++) {
        if (put_path(path, folder, subfolders[i]))
            return true;
    }
    if (put_path(path, KILN_LIBEXEC_DIR, ""))
        return true;
    return kiln_error_set(error, KILN_DEVICE_FAILED,
                          "%s: the program that decodes pictures, videos and meshes is missing; it "
                          "belongs to kiln's installation",
                          path);
}

/* ---- starting and ending --------------------------------------------------------------------- */

static const char *kind_name(enum kiln_decode_kind kind)
{
#define WORD(id, word) word,
    static const char *const names[] = {KILN_DECODE_KINDS(WORD)};
#undef WORD
    return names[kind];
}

/* Chooses the environment of the process: the folders of libraries, and the variables of kiln and
 * of sanitizers. Variables with keys and passwords of a service do not reach it. malloc is told to
 * use large pages, for all kinds alike, since readers take and fill many MiB at once
 * (docs/speed-log.md, "Start, memory, states"). The caller frees the array. */
static char **choose_environment(void)
{
    static const char large_pages[] = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
    static const char *const prefixes[] = {"LD_", "KILN_", "ASAN_", "LSAN_", "UBSAN_", "LANG="};
    size_t count = 0, chosen_count = 0;
    while (environ && environ[count])
        count++;
    char **chosen = calloc(count + 2, sizeof *chosen);
    for (size_t i = 0; chosen && i < count; i++) {
        for (size_t k = 0; k < sizeof prefixes / sizeof *prefixes; k++) {
            if (strncmp(environ[i], prefixes[k], strlen(prefixes[k])) == 0)
                chosen[chosen_count++] = environ[i];
        }
    }
    if (chosen)
        chosen[chosen_count] = (char *)large_pages;
    return chosen;
}

static int spawn(pid_t *process, const char *path, enum kiln_decode_kind kind, uint64_t most_memory,
                 int socket)
{
    char memory[32];
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    int status = posix_spawn_file_actions_init(&actions);
    if (status)
        return status;
    status = posix_spawnattr_init(&attributes);
    if (status) {
        posix_spawn_file_actions_destroy(&actions);
        return status;
    }
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    for (int file = 0; file < 3 && !status; file++)
        status = posix_spawn_file_actions_addopen(&actions, file, "/dev/null", O_RDWR, 0);
    if (!status)
        status = posix_spawn_file_actions_adddup2(&actions, socket, KILN_DECODE_SOCKET);
    if (!status)
        status = posix_spawn_file_actions_addclosefrom_np(&actions, KILN_DECODE_SOCKET + 1);
    snprintf(memory, sizeof memory, "%" PRIu64, most_memory);
    char *const arguments[] = {(char *)"kiln-decode", (char *)kind_name(kind), memory, NULL};
    char **environment = choose_environment();
    if (!environment)
        status = ENOMEM;
    if (!status)
        status = posix_spawn(process, path, &actions, &attributes, arguments, environment);
    free(environment);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return status;
}

/* Returns the processor time that the process has taken; 0 where it is not known. */
static double cpu_seconds(const struct kiln_helper *helper)
{
    clockid_t clock;
    struct timespec used;
    if (helper->process <= 0 || clock_getcpuclockid(helper->process, &clock) != 0 ||
        clock_gettime(clock, &used) != 0)
        return 0.0;
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

/* Tells the budget what the process has taken so far, which it returns. */
static double count_seconds(struct kiln_helper *helper)
{
    const double used_s = cpu_seconds(helper);
    const int64_t used_us = (int64_t)(1e6 * used_s);
    if (helper->budget && used_us > helper->counted_us) {
        kiln_budget_add_running(helper->budget, used_us - helper->counted_us);
        helper->counted_us = used_us;
    }
    return used_s;
}

/* Opens a pair of sockets, neither of which gets the number of a standard descriptor. */
static bool open_pair(int pair[2])
{
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
        return false;
    for (int i = 0; i < 2; i++) {
        if (pair[i] >= KILN_DECODE_SOCKET)
            continue;
        const int higher = fcntl(pair[i], F_DUPFD_CLOEXEC, KILN_DECODE_SOCKET);
        const int reason = errno;
        close(pair[i]);
        pair[i] = higher;
        if (higher < 0) {
            close(pair[1 - i]);
            errno = reason;
            return false;
        }
    }
    return true;
}

/* Returns whether the caller cancelled or a limit of the job is exceeded. Then neither the file nor
 * the process is at fault. */
static bool is_of_caller(const struct kiln_error *reason)
{
    return reason->code == KILN_INTERRUPTED || reason->code == KILN_OVER_LIMIT;
}

bool kiln_helper_fail(const char *name, const struct kiln_error *reason, struct kiln_error *error)
{
    return is_of_caller(reason)
               ? kiln_error_set(error, reason->code, "%s", reason->message)
               : kiln_error_set(error, reason->code, "%s: %s", name, reason->message);
}

static bool greet(struct kiln_helper *helper, const struct kiln_caller *caller, const char *path,
                  struct kiln_error *error)
{
    struct kiln_decode_answer answer;
    struct kiln_error reason = {0};
    if (!kiln_helper_answer(helper, caller, 1u << KILN_DECODE_READY, &answer, &reason)) {
        if (reason.code == KILN_INVALID_INPUT)
            kiln_error_set(&reason, KILN_DEVICE_FAILED, "the program ended before it began");
        else if (!is_of_caller(&reason))
            reason.code = KILN_DEVICE_FAILED;
        return kiln_helper_fail(path, &reason, error);
    }
    return strcmp(answer.text, KILN_VERSION) == 0 ||
           kiln_error_set(error, KILN_DEVICE_FAILED,
                          "%s: the program belongs to kiln %s, and this is kiln " KILN_VERSION,
                          path, answer.text);
}

struct kiln_helper *kiln_helper_start(enum kiln_decode_kind kind, uint64_t most_memory,
                                      const struct kiln_caller *caller, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    int pair[2];
    if (!kiln_helper_find(path, error))
        return NULL;
    struct kiln_helper *helper = calloc(1, sizeof *helper);
    if (!helper || !open_pair(pair)) {
        kiln_error_set_errno(error, KILN_DEVICE_FAILED, helper ? errno : ENOMEM,
                             "no socket for kiln-decode");
        free(helper);
        return NULL;
    }
    *helper = (struct kiln_helper){.kind = kind,
                                   .socket = pair[0],
                                   .handle = -1,
                                   .is_limited = most_memory != UINT64_MAX,
                                   .began_s = kiln_clock_seconds(),
                                   .most_s = KILN_DECODE_REAL_SECONDS};
    const int status = spawn(&helper->process, path, kind, most_memory, pair[1]);
    close(pair[1]);
    if (status) {
        kiln_error_set_errno(error, KILN_DEVICE_FAILED, status, "%s: the program cannot be started",
                             path);
        close(helper->socket);
        free(helper);
        return NULL;
    }
    helper->handle = (int)syscall(SYS_pidfd_open, helper->process, 0);
    if (!greet(helper, caller, path, error))
        kiln_helper_end(&helper);
    return helper;
}

static void kill_process(const struct kiln_helper *helper)
{
    if (helper->handle >= 0)
        syscall(SYS_pidfd_send_signal, helper->handle, SIGKILL, NULL, 0);
    else
        kill(helper->process, SIGKILL);
}

/* Ends the process. Returns its status, or 0 when other code has already taken it from the
 * system. */
static int end(struct kiln_helper *helper)
{
    int status = 0;
    if (helper->process <= 0)
        return 0;
    kiln_budget_add_running(helper->budget, -helper->counted_us); /* the system counts it now */
    kill_process(helper);
    pid_t ended;
    do {
        ended = waitpid(helper->process, &status, 0);
    } while (ended < 0 && errno == EINTR);
    close(helper->socket);
    if (helper->handle >= 0)
        close(helper->handle);
    helper->socket = helper->handle = -1;
    helper->process = 0;
    helper->is_broken = true;
    return ended < 0 ? 0 : status;
}

void kiln_helper_end(struct kiln_helper **helper)
{
    if (!*helper)
        return;
    end(*helper);
    free(*helper);
    *helper = NULL;
}

enum kiln_decode_kind kiln_helper_kind(const struct kiln_helper *helper)
{
    return helper->kind;
}

bool kiln_helper_is_broken(const struct kiln_helper *helper)
{
    return helper->is_broken;
}

/* A process that waits for a request sends nothing, so there must be nothing to read. */
bool kiln_helper_is_waiting(const struct kiln_helper *helper)
{
    struct pollfd socket = {.fd = helper->socket, .events = POLLIN};
    return !helper->is_broken && poll(&socket, 1, 0) == 0;
}

void kiln_helper_begin(struct kiln_helper *helper)
{
    helper->cpu_s = count_seconds(helper);
    helper->began_s = kiln_clock_seconds();
}

void kiln_helper_count(struct kiln_helper *helper, struct kiln_budget *budget)
{
    helper->budget = budget;
}

void kiln_helper_limit_time(struct kiln_helper *helper, double most_s)
{
    helper->most_s = most_s;
}

void kiln_helper_break(struct kiln_helper *helper)
{
    helper->is_broken = true;
}

/* ---- sending and receiving ------------------------------------------------------------------- */

/* Returns whether a signal is one that a decoder gets because of the file that it decodes. */
static bool is_own_fault(int signal)
{
    return signal == SIGSEGV || signal == SIGBUS || signal == SIGILL || signal == SIGFPE ||
           signal == SIGABRT || signal == SIGXCPU || signal == SIGSYS || signal == SIGXFSZ;
}

/* Reports why the process is gone. It may be about to end by itself, so this waits for its own
 * status before killing it. */
static bool fail_gone(struct kiln_helper *helper, const struct kiln_caller *caller,
                      struct kiln_error *error)
{
    helper->is_broken = true;
    /* The caller is asked first, since a signal may have ended its whole process group. */
    if (!kiln_may_go_on(caller, error))
        return false;
    siginfo_t info = {.si_pid = 0};
    const double start_s = kiln_clock_seconds();
    const struct timespec pause = {.tv_nsec = 1000000};
    int asked = 0;
    while (helper->process > 0 && info.si_pid == 0 && asked == 0 &&
           kiln_clock_seconds() - start_s < 1.0) {
        asked = waitid(P_PID, (id_t)helper->process, &info, WEXITED | WNOHANG | WNOWAIT);
        nanosleep(&pause, NULL);
    }
    const int status = end(helper);
    if (info.si_pid != 0 && WIFSIGNALED(status) && !is_own_fault(WTERMSIG(status)))
        return kiln_error_set(
            error, KILN_DEVICE_FAILED, "the process that decodes it was ended by signal %d%s",
            WTERMSIG(status),
            WTERMSIG(status) == SIGKILL ? "; perhaps the machine is short of memory" : "");
    if (asked != 0)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "the process that decodes it ended for an unknown reason");
    return kiln_error_set(error, KILN_INVALID_INPUT, "the file is broken: the decoder fails on it");
}

static bool fail_time(struct kiln_helper *helper, double seconds, const char *of,
                      struct kiln_error *error)
{
    helper->is_broken = true;
    return kiln_error_set(error, KILN_INVALID_INPUT, "decoding took longer than %g s%s", seconds,
                          of);
}

/* Returns whether the present request may go on: the caller wants it, and it is within its limits
 * of time. */
static bool may_wait(struct kiln_helper *helper, const struct kiln_caller *caller,
                     struct kiln_error *error)
{
    const double cpu_s = count_seconds(helper);
    if (!kiln_may_go_on(caller, error)) {
        helper->is_broken = true;
        return false;
    }
    if (cpu_s - helper->cpu_s > KILN_DECODE_SECONDS)
        return fail_time(helper, KILN_DECODE_SECONDS, " of processor time", error);
    return kiln_clock_seconds() - helper->began_s <= helper->most_s ||
           fail_time(helper, helper->most_s, "", error);
}

bool kiln_helper_send(struct kiln_helper *helper, const void *bytes, size_t size, int file,
                      struct kiln_error *error)
{
    union {
        struct cmsghdr header;
        char room[CMSG_SPACE(sizeof(int))];
    } control = {.header = {.cmsg_len = CMSG_LEN(sizeof file),
                            .cmsg_level = SOL_SOCKET,
                            .cmsg_type = SCM_RIGHTS}};
    struct iovec part = {(void *)bytes, size};
    struct msghdr message = {.msg_iov = &part, .msg_iovlen = 1};
    if (file >= 0) {
        memcpy(CMSG_DATA(&control.header), &file, sizeof file);
        message.msg_control = &control;
        message.msg_controllen = sizeof control.room;
    }
    ssize_t sent;
    do {
        sent =
            helper->is_broken ? -1 : sendmsg(helper->socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    } while (sent < 0 && !helper->is_broken && errno == EINTR);
    /* Messages are far smaller than a socket's buffer. If it is full, the process does not read. */
    if (sent != (ssize_t)size && !helper->is_broken && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        helper->is_broken = true;
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the file is broken: the decoder does not answer");
    }
    return sent == (ssize_t)size || fail_gone(helper, NULL, error);
}

bool kiln_helper_receive(struct kiln_helper *helper, const struct kiln_caller *caller, void *bytes,
                         size_t size, struct kiln_error *error)
{
    for (size_t done = 0; done < size;) {
        if (helper->is_broken)
            return fail_gone(helper, caller, error);
        const ssize_t got = recv(helper->socket, (char *)bytes + done, size - done, MSG_DONTWAIT);
        if (got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR))
            return fail_gone(helper, caller, error);
        done += got > 0 ? (size_t)got : 0;
        /* The limits hold for one that sends slowly, too, so they are compared after each part. */
        if (done < size && !may_wait(helper, caller, error))
            return false;
        struct pollfd ready = {.fd = helper->socket, .events = POLLIN};
        if (got < 0)
            poll(&ready, 1, WAIT_MS);
    }
    return true;
}

/* Accepts the codes that a decoder may send; "over limit" only where it was given a limit. */
static enum kiln_code code_of(const struct kiln_helper *helper, int32_t code)
{
    const bool known = code == KILN_IO || code == KILN_DEVICE_FAILED ||
                       (code == KILN_OVER_LIMIT && helper->is_limited);
    return known ? (enum kiln_code)code : KILN_INVALID_INPUT;
}

bool kiln_helper_answer(struct kiln_helper *helper, const struct kiln_caller *caller,
                        unsigned expected, struct kiln_decode_answer *answer,
                        struct kiln_error *error)
{
    if (!kiln_helper_receive(helper, caller, answer, sizeof *answer, error))
        return false;
    const bool ends = memchr(answer->text, '\0', sizeof answer->text) != NULL;
    if (ends && answer->what == KILN_DECODE_FAILED)
        return kiln_error_set(error, code_of(helper, answer->code), "%s", answer->text);
    if (ends && answer->what < 32 && (expected & 1u << answer->what))
        return true;
    helper->is_broken = true;
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "the file is broken: the decoder returned inconsistent data");
}
