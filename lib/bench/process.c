/* Runs kiln as a process that writes its events into a pipe. At each line that names a point, the
 * parent reads the CPU clock of the process, which counts the work of all its threads. The reading
 * may be late by as long as the parent takes to wake up. The end of the pipe's data says that the
 * process has ended. */
#include "bench/process.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"

enum {
    EVENTS = 3,
    /* the descriptor of the events in the process */ LINE_START_SIZE = 32,
    WAKE_MS = 200,
    END_NS = 500000 /* between looks at a process that closed its events, which mostly has ended */
};
static const double grace_s = 5; /* the time from SIGTERM until SIGKILL */

struct child {
    const struct kiln_bench_run *run;
    struct kiln_process *process;
    pid_t id;
    char line_start[LINE_START_SIZE]; /* the start of the current line */
    size_t length;                    /* length of the current line */
    double start_s;
    bool stopped;
    bool timed_out;
    double stopped_s; /* when the stop was asked for */
};

/* Starts the process with empty standard input. Returns 0 or an errno value. */
static int spawn(struct child *child, const char **arguments, int log, int events)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&files, log, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, log, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&files, events, EVENTS);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP); /* Ctrl-C is for the parent */
    posix_spawnattr_setpgroup(&attributes, 0);
    const char *program = child->process->program ? child->process->program : "/proc/self/exe";
    const int failure =
        posix_spawnp(&child->id, program, &files, &attributes, (char **)arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return failure;
}

/* ---- Events ---------------------------------------------------------------------------------- */

static void take_point(struct child *child, enum kiln_process_point point)
{
    clockid_t clock;
    struct timespec now;
    child->process->clock_s[point] = kiln_clock_seconds() - child->start_s;
    if (clock_getcpuclockid(child->id, &clock) == 0 && clock_gettime(clock, &now) == 0)
        child->process->cpu_s[point] = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void take_line(struct child *child)
{
    double *cpu_s = child->process->cpu_s, *clock_s = child->process->clock_s;
    if (strncmp(child->line_start, "{\"event\": \"device\"", 18) == 0)
        take_point(child, KILN_PROCESS_DEVICE);
    if (strncmp(child->line_start, "{\"event\": \"frame\"", 17) != 0)
        return;
    take_point(child, KILN_PROCESS_LAST);
    if (cpu_s[KILN_PROCESS_FIRST] > 0.0)
        return;
    cpu_s[KILN_PROCESS_FIRST] = cpu_s[KILN_PROCESS_LAST];
    clock_s[KILN_PROCESS_FIRST] = clock_s[KILN_PROCESS_LAST];
}

static void take_bytes(struct child *child, const char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (child->length < LINE_START_SIZE)
            child->line_start[child->length] = bytes[i];
        child->length++;
        if (bytes[i] != '\n')
            continue;
        if (child->length >= LINE_START_SIZE)
            take_line(child);
        child->length = 0;
    }
}

/* Ends the process when a stop is asked for, or when it takes too long: by SIGTERM, and by SIGKILL
 * when that does not help. */
static void check_stop(struct child *child)
{
    const double limit_s = child->process->timeout_s, now_s = kiln_clock_seconds();
    if (!child->stopped && !child->timed_out && limit_s > 0 && now_s > child->start_s + limit_s) {
        child->timed_out = true;
        child->stopped_s = now_s;
        kill(-child->id, SIGTERM);
    }
    const struct kiln_bench_params *params = child->run->params;
    if (!child->stopped && params->stop && params->stop(params->user)) {
        child->stopped = true;
        child->stopped_s = kiln_clock_seconds();
        kill(-child->id, SIGTERM);
    }
    if ((child->stopped || child->timed_out) && now_s > child->stopped_s + grace_s)
        kill(-child->id, SIGKILL);
}

/* Reads events until the other end of the pipe is closed. */
static void read_events(struct child *child, int events)
{
    char bytes[4096];
    for (;;) {
        struct pollfd descriptor = {.fd = events, .events = POLLIN};
        check_stop(child);
        if (poll(&descriptor, 1, WAKE_MS) <= 0)
            continue;
        const ssize_t got = read(events, bytes, sizeof bytes);
        if (got == 0 || (got < 0 && errno != EINTR))
            return;
        take_bytes(child, bytes, got > 0 ? (size_t)got : 0);
    }
}

/* ---- The end --------------------------------------------------------------------------------- */

/* Reads the last line that the process printed, without its newline. */
static void read_last_line(int log, char line[KILN_MESSAGE_SIZE])
{
    char text[KILN_MESSAGE_SIZE];
    const off_t size = lseek(log, 0, SEEK_END), room = (off_t)sizeof text - 1;
    const ssize_t got = pread(log, text, sizeof text - 1, size > room ? size - room : 0);
    size_t length = got > 0 ? (size_t)got : 0;
    while (length > 0 && text[length - 1] == '\n')
        length--;
    text[length] = '\0';
    const char *last = strrchr(text, '\n');
    snprintf(line, KILN_MESSAGE_SIZE, "%s", last ? last + 1 : text);
}

static bool finish(struct child *child, const char **arguments, int log, struct kiln_error *error)
{
    char *line = child->process->last_line;
    struct rusage usage = {0};
    int status = 0;
    /* a process may close its events before it ends */
    for (pid_t ended = 0; ended == 0 || (ended < 0 && errno == EINTR);) {
        ended = wait4(child->id, &status, WNOHANG, &usage);
        if (ended == 0) {
            check_stop(child);
            nanosleep(&(struct timespec){.tv_nsec = END_NS}, NULL);
        }
    }
    child->process->elapsed_s = kiln_clock_seconds() - child->start_s;
    child->process->clock_s[KILN_PROCESS_END] = child->process->elapsed_s;
    child->process->cpu_s[KILN_PROCESS_END] =
        (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec +
        (double)usage.ru_stime.tv_sec + 1e-6 * (double)usage.ru_stime.tv_usec;
    if (child->stopped)
        return kiln_error_set(error, KILN_INTERRUPTED, "stopped");
    if (child->timed_out)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "kiln %s has not ended within %.0f s",
                              arguments[0], child->process->timeout_s);
    read_last_line(log, line);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (!WIFEXITED(status))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "kiln %s was ended by signal %d",
                              arguments[0], WTERMSIG(status));
    return kiln_error_set(error, (enum kiln_code)WEXITSTATUS(status),
                          "kiln %s has exit code %d: %.700s", arguments[0], WEXITSTATUS(status),
                          line);
}

/* Makes the arguments: "kiln", the command, the option for its events, and the others. Returns
 * NULL when memory is short. */
static const char **make_arguments(const char **arguments, bool reports_events)
{
    size_t count = 0, used = 0;
    while (arguments[count])
        count++;
    const char **all = calloc(count + 3, sizeof *all);
    if (!all)
        return NULL;
    all[used++] = "kiln";
    all[used++] = arguments[0];
    if (reports_events)
        all[used++] = "--events=ndjson:fd=3";
    memcpy(all + used, arguments + 1, (count - 1) * sizeof *all);
    return all;
}

bool kiln_process_run(const struct kiln_bench_run *run, const char **arguments,
                      struct kiln_process *process, struct kiln_error *error)
{
    struct child child = {.run = run, .process = process, .start_s = kiln_clock_seconds()};
    const char **all = make_arguments(arguments, process->reports_events);
    const int log = memfd_create("log", MFD_CLOEXEC);
    int ends[2] = {-1, -1};
    int failure = log < 0 || pipe2(ends, O_CLOEXEC) != 0 ? errno : all ? 0 : ENOMEM;
    failure = failure ? failure : spawn(&child, all, log, ends[1]);
    free(all);
    if (ends[1] >= 0)
        close(ends[1]);
    if (failure == 0)
        read_events(&child, ends[0]);
    const bool ok = failure == 0 ? finish(&child, arguments, log, error)
                                 : kiln_error_set_errno(error, KILN_DEVICE_FAILED, failure,
                                                        "kiln %s cannot be started", arguments[0]);
    if (ends[0] >= 0)
        close(ends[0]);
    if (log >= 0)
        close(log);
    return ok;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

void kiln_process_remove_folder(const char *path)
{
    /* NOLINTNEXTLINE(concurrency-mt-unsafe): this call does not change the working folder */
    nftw(path, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}
