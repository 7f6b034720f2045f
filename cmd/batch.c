/* Runs kiln render --batch. Each job is a process: this program, started anew by posix_spawn with
 * the options of the call and those of the job. The batch's own process reads no scene and opens no
 * device, so no job can harm it. Jobs share what is slow to make (flipbooks, distance fields)
 * through the cache on disk. */
#include "batch.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "batch_check.h"
#include "event.h"
#include "pool.h"
#include "report.h"
#include "signals.h"
#include "timer_thread.h"

/* The state of a job. */
struct running {
    int log; /* memory file of what the job prints; -1: the job is not running */
    double began_s;
};

struct batch {
    struct kiln_batch *jobs;
    char program[KILN_PATH_SIZE]; /* path of this program */
    const char *limits;           /* --limits of the call, for every job; or NULL */
    char **common_arguments;      /* arguments that every job gets */
    size_t common_count;
    struct running *running; /* one for each job */
    bool keep_going, quiet;
    int code; /* the greatest exit code so far */
    size_t failed, ended;
};

/* ---- the command line of a job --------------------------------------------------------------- */

/* Returns whether an option of the call is not copied to the jobs. --limits is among these, since
 * add_limits joins it with the limits of a job. */
static bool is_batch_option(const char *name)
{
    static const char *const batch_options[] = {"batch",  "jobs",     "keep-going", "limits",
                                                "events", "progress", "quiet"};
    for (size_t i = 0; i < sizeof batch_options / sizeof *batch_options; i++) {
        if (strcmp(batch_options[i], name) == 0)
            return true;
    }
    return false;
}

static int refuse_options(const struct arguments *arguments)
{
    static const char *const refused[] = {"output", "manifest", "shard", "pipe", "json"};
    if (arguments->operand_count > 0)
        return report(KILN_USAGE, "render: --batch: a scene on the command line is not allowed "
                                  "with it; the file of jobs names the scenes");
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        if (arguments_last(arguments, refused[i]))
            return report(
                KILN_USAGE,
                "render: --%s: not allowed with --batch; the file of jobs has a key for it",
                refused[i]);
    }
    return 0;
}

static char *argument_text(const struct option_use *use)
{
    char *text = NULL;
    const int length = use->text ? asprintf(&text, "--%s=%s", use->option->name, use->text)
                                 : asprintf(&text, "--%s", use->option->name);
    return length < 0 ? NULL : text;
}

static bool collect_common_arguments(struct batch *batch, const struct arguments *arguments)
{
    batch->common_arguments = calloc(arguments->use_count + 1, sizeof *batch->common_arguments);
    if (!batch->common_arguments)
        return false;
    for (size_t i = 0; i < arguments->use_count; i++) {
        const struct option_use *use = &arguments->uses[i];
        if (is_batch_option(use->option->name))
            continue;
        char *text = argument_text(use);
        if (!text)
            return false;
        batch->common_arguments[batch->common_count++] = text;
    }
    return true;
}

/* The arguments of a job. free_command_line frees all but the first `borrowed_count`. */
struct command_line {
    char **argv; /* NULL ends the array */
    size_t count, borrowed_count;
    bool failed;
};

static void add(struct command_line *line, const char *name, const char *value)
{
    char *argument = NULL;
    if (!value)
        return;
    if (asprintf(&argument, "%s%s", name, value) < 0) {
        line->failed = true;
        return;
    }
    line->argv[line->count++] = argument;
}

/* Adds the limits of the call, followed by those of the job: a later value of a limit replaces an
 * earlier one. */
static void add_limits(struct command_line *line, const char *call_limits, const char *job_limits)
{
    char *both = NULL;
    if (call_limits && job_limits && asprintf(&both, "%s,%s", call_limits, job_limits) < 0)
        line->failed = true;
    else
        add(line, "--limits=", both ? both : job_limits ? job_limits : call_limits);
    free(both);
}

static struct command_line make_command_line(const struct batch *batch,
                                             const struct kiln_batch_job *job)
{
    enum { OWN_ARGUMENTS = 16 };
    struct command_line line = {
        .argv =
            calloc(batch->common_count + job->override_count + OWN_ARGUMENTS, sizeof *line.argv)};
    if (!line.argv) {
        line.failed = true;
        return line;
    }
    line.argv[line.count++] = (char *)"kiln";
    line.argv[line.count++] = (char *)"render";
    for (size_t i = 0; i < batch->common_count; i++)
        line.argv[line.count++] = batch->common_arguments[i];
    line.borrowed_count = line.count;
    add(&line, "--quiet", "");
    add(&line, "--output=", job->output.text);
    add(&line, "--asset-root=", job->asset_root);
    add(&line, "--states=", job->states);
    add(&line, "--manifest=", job->manifest.text);
    add(&line, "--frames=", job->frames.text);
    add_limits(&line, batch->limits, job->limits.text);
    char timeout[32];
    snprintf(timeout, sizeof timeout, "%.3f", job->timeout_s);
    add(&line, "--timeout=", job->timeout_s > 0 ? timeout : NULL);
    for (size_t i = 0; i < job->override_count; i++)
        add(&line, "--set=", job->overrides[i]);
    add(&line, "--", "");
    add(&line, "", job->scene);
    return line;
}

static void free_command_line(struct command_line *line)
{
    for (size_t i = line->borrowed_count; i < line->count; i++)
        free(line->argv[i]);
    free(line->argv);
}

/* ---- processes ------------------------------------------------------------------------------- */

/* Starts a job in a process group of its own. Its standard input is empty; standard output and
 * standard error go into the log. Returns 0 or an errno value. */
static int spawn(const struct batch *batch, char **argv, int log, const sigset_t *mask, pid_t *id)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, log, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, log, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, mask);
    const int failure = posix_spawn(id, batch->program, &files, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return failure;
}

/* Begins an event with the members that identify its job. */
static struct kiln_json begin_event(const char *name, const struct kiln_batch_job *job)
{
    struct kiln_json json = event_begin(name);
    kiln_json_string(&json, "name", job->name);
    kiln_json_string(&json, "scene", job->scene);
    kiln_json_string(&json, "output", job->output.text);
    return json;
}

static void write_start_event(const struct kiln_batch_job *job, pid_t id)
{
    if (!events_are_wanted())
        return;
    struct kiln_json json = begin_event("job_began", job);
    kiln_json_int(&json, "process", id);
    event_end(&json);
}

static pid_t start_job(void *user, size_t index, struct pool_start *start)
{
    struct batch *batch = user;
    const struct kiln_batch_job *job = kiln_batch_job(batch->jobs, index);
    struct command_line line = make_command_line(batch, job);
    pid_t id = -1;
    const int log = memfd_create("log", MFD_CLOEXEC);
    int failure = line.failed ? ENOMEM : errno;
    if (log >= 0 && !line.failed)
        failure = spawn(batch, line.argv, log, start->mask, &id);
    free_command_line(&line);
    if (id < 0 && log >= 0)
        close(log);
    batch->running[index] = (struct running){.log = id < 0 ? -1 : log, .began_s = now_s()};
    if (id >= 0)
        write_start_event(job, id);
    if (id < 0 && failure != EAGAIN) /* after EAGAIN, the pool tries again later */
        start->problem = "the job cannot be started";
    errno = failure;
    return id;
}

/* Copies the log of a job to standard error. Each line gets the job's name in front, in place of
 * "kiln" if it has that. *message gets the last line that is not a warning, as the reason of a
 * failure; the caller frees it. */
static void show_log(int log, const char *name, char **message)
{
    static const char program[] = "kiln: ", warning[] = "warning: ";
    FILE *in = log >= 0 && lseek(log, 0, SEEK_SET) == 0 ? fdopen(log, "r") : NULL;
    size_t room = 0;
    char *line = NULL;
    *message = NULL;
    while (in && getline(&line, &room, in) > 0) {
        const bool has_name = strncmp(line, program, sizeof program - 1) == 0;
        const char *text = line + (has_name ? sizeof program - 1 : 0);
        line[strcspn(line, "\n")] = '\0';
        fprintf(stderr, "%s: %s\n", name, text);
        if (strncmp(text, warning, sizeof warning - 1) == 0)
            continue;
        free(*message);
        *message = strdup(text);
    }
    free(line);
    if (in)
        fclose(in);
    else if (log >= 0)
        close(log);
}

static void write_job_event(const struct batch *batch, const struct kiln_batch_job *job,
                            const struct pool_end *end, int code, const char *message)
{
    if (!events_are_wanted())
        return;
    const size_t count = kiln_batch_count(batch->jobs);
    char status[64];
    snprintf(status, sizeof status, "%zu of %zu jobs", batch->ended, count);
    event_progress(batch->ended, count, status);
    if (code)
        event_openjd("fail", "%s: %s", job->name, message ? message : "failed");
    struct kiln_json json = begin_event("job", job);
    kiln_json_int(&json, "code", code);
    kiln_json_string(&json, "again", exit_code_again(code));
    kiln_json_string(&json, "message", code ? message : NULL);
    kiln_json_time(&json, "total_s", end->total_s);
    if (code && message)
        event_add_place(&json, message);
    event_end(&json);
}

static void end_job(void *user, size_t index, const struct pool_end *end)
{
    struct batch *batch = user;
    const struct kiln_batch_job *job = kiln_batch_job(batch->jobs, index);
    const int code = end->signal ? 128 + end->signal : end->exit_code;
    char name[KILN_MESSAGE_SIZE], killed[64], *message;
    kiln_shown(name, sizeof name, job->name);
    show_log(batch->running[index].log, name, &message);
    batch->running[index].log = -1;
    snprintf(killed, sizeof killed, "ended by signal %d", end->signal);
    const char *why = *end->problem ? end->problem : end->signal ? killed : message;
    batch->ended++;
    batch->failed += code != 0;
    batch->code = code > batch->code ? code : batch->code;
    write_job_event(batch, job, end, code, why);
    if (*end->problem || end->signal)
        fprintf(stderr, "%s: %s\n", name, why);
    if (!batch->quiet && code)
        printf("%s: exit code %d after %.3f s\n", name, code, end->total_s);
    else if (!batch->quiet)
        printf("%s: done in %.3f s\n", name, end->total_s);
    fflush(stdout);
    free(message);
}

/* Reports the jobs that were stopped with the batch. Returns their number. */
static size_t report_stopped_jobs(struct batch *batch)
{
    const int received = signals_received();
    struct pool_end end = {.exit_code = received ? 128 + received : KILN_READER_GONE};
    size_t count = 0;
    for (size_t i = 0; i < kiln_batch_count(batch->jobs); i++) {
        if (batch->running[i].log < 0)
            continue;
        end.total_s = now_s() - batch->running[i].began_s;
        end_job(batch, i, &end);
        count++;
    }
    return count;
}

static bool has_enough(void *user)
{
    const struct batch *batch = user;
    return batch->code != 0 && !batch->keep_going;
}

/* ---- the batch ------------------------------------------------------------------------------- */

/* Reads all of standard input. Returns a text that ends with a zero byte, which the caller frees;
 * NULL when memory is short. */
static char *read_input(size_t *size)
{
    char *text = NULL, block[1 << 14];
    size_t got = 0, total = 0;
    FILE *out = open_memstream(&text, size);
    if (!out)
        return NULL;
    do {
        got = fread(block, 1, sizeof block, stdin);
        total += fwrite(block, 1, got, out);
    } while (got > 0 && total < KILN_MAX_BATCH_SIZE);
    const bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}

static struct kiln_batch *read_file(const char *path, struct kiln_error *error)
{
    if (strcmp(path, "-") != 0)
        return kiln_batch_read(path, error);
    size_t size = 0;
    char *text = read_input(&size);
    if (!text) {
        error->code = KILN_DEVICE_FAILED;
        snprintf(error->message, sizeof error->message,
                 "out of memory for the jobs of standard input");
        return NULL;
    }
    struct kiln_batch *batch =
        kiln_batch_parse(text, size, "standard input", KILN_BATCH_LINES, error);
    free(text);
    return batch;
}

static struct kiln_batch *read_jobs(const struct arguments *arguments, struct kiln_error *error)
{
    struct kiln_batch *batch = read_file(arguments_text(arguments, "batch", ""), error);
    const char *suffix = arguments_last(arguments, "flipbook") ? ".png" : ".mp4";
    if (batch && !batch_check(batch, suffix, error))
        kiln_batch_destroy(&batch);
    return batch;
}

static uint32_t count_jobs_at_a_time(const struct arguments *arguments)
{
    const uint32_t cores = pool_cores(), threads = arguments_integer(arguments, "threads", 0);
    return arguments_integer(arguments, "jobs",
                             threads > 0 && threads < cores ? cores / threads : 1);
}

static int run_pool(struct batch *batch, const struct arguments *arguments)
{
    const size_t count = kiln_batch_count(batch->jobs);
    const struct pool pool = {.count = count,
                              .jobs = count_jobs_at_a_time(arguments),
                              .start = start_job,
                              .ended = end_job,
                              .stop = signals_wants_stop,
                              .no_more = has_enough,
                              .user = batch};
    struct kiln_error error = {0};
    const double began_s = now_s();
    batch->running = malloc(count * sizeof *batch->running);
    if (!batch->running)
        return report_no_memory();
    for (size_t i = 0; i < count; i++)
        batch->running[i].log = -1;
    if (pool_run(&pool, &error)) {
        if (!batch->quiet)
            printf("%zu of %zu jobs in %.3f s, %zu failed\n", batch->ended, count,
                   now_s() - began_s, batch->failed);
        return batch->code;
    }
    if (error.code != KILN_INTERRUPTED)
        return report_error(&error);
    const size_t done = batch->ended, stopped = report_stopped_jobs(batch);
    return signals_report("batch", " after %zu of %zu jobs, while %zu ran", done, count, stopped);
}

/* Sets two variables for the jobs. KILN_BATCH_PROCESS is the id of this process, so that a job ends
 * when this process does (main.c). GLIBC_TUNABLES, unless it is set already, makes malloc use large
 * pages: half the time of a job of one small frame went into page faults (docs/speed-log.md, "Jobs
 * in parts"). */
static bool set_environment(void)
{
    static const char memory[] = "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=33554432:"
                                 "glibc.malloc.top_pad=67108864";
    char process[32];
    snprintf(process, sizeof process, "%d", (int)getpid());
    return setenv("KILN_BATCH_PROCESS", process, 1) == 0 &&
           setenv("GLIBC_TUNABLES", memory, 0) == 0;
}

int batch_run(const struct arguments *arguments)
{
    struct batch batch = {.keep_going = arguments_flag(arguments, "keep-going"),
                          .quiet = arguments_flag(arguments, "quiet") || events_use_stdout(),
                          .limits = arguments_text(arguments, "limits", NULL)};
    struct kiln_error error = {0};
    signals_install_immediate(); /* no loop checks for signals while the jobs are read */
    int code = refuse_options(arguments);
    const ssize_t length = readlink("/proc/self/exe", batch.program, sizeof batch.program - 1);
    if (code == 0 && length < 0)
        code = report(KILN_IO, "/proc/self/exe: %s",
                      strerror(errno)); /* NOLINT(concurrency-mt-unsafe): one thread calls it */
    if (code == 0 && !(batch.jobs = read_jobs(arguments, &error)))
        code = report_error(&error);
    if (code == 0 && !collect_common_arguments(&batch, arguments))
        code = report_no_memory();
    if (code == 0 && !set_environment())
        code = report_no_memory();
    signals_install();
    if (code == 0)
        code = run_pool(&batch, arguments);
    for (size_t i = 0; i < batch.common_count; i++)
        free(batch.common_arguments[i]);
    free(batch.common_arguments);
    free(batch.running);
    kiln_batch_destroy(&batch.jobs);
    return code;
}
