/* Keeps a number of processes running and records how each ends. Each leads a process group of its
 * own, so Ctrl-C in a terminal reaches the parent alone, which then ends the others.
 *
 * The parent sleeps in sigtimedwait and has SIGCHLD blocked at all other times. So the end of a
 * child between a check and a sleep is not missed. */
#include "pool.h"

#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "timer_thread.h"

/* GRACE_S is how long a child may go on after SIGTERM before it is killed. REFUSAL_S is how long
 * the system may refuse a process while none runs before the task fails. */
static const double GRACE_S = 2, REFUSAL_S = 5;
static const double LONGEST_SLEEP_S = 0.25;

struct child {
    pid_t id; /* 0: none */
    size_t index;
    double started_s, limit_s;
    double sigterm_s; /* when it got SIGTERM; below 0: not yet */
};

struct run {
    const struct pool *pool;
    struct child *children; /* pool->jobs places */
    size_t running;
    size_t next;            /* the task to start next */
    double refusal_start_s; /* when the system began to refuse processes; below 0: it does not */
    bool stopping;
    sigset_t old_mask; /* the signals that were blocked before */
};

/* ---- Children ------------------------------------------------------------------------------- */

static void refuse(struct run *run, enum kiln_code code, const char *what, int failure)
{
    struct pool_end end = {.exit_code = (int)code};
    snprintf(end.problem, sizeof end.problem, "%s: %s", what,
             strerror(failure)); /* NOLINT(concurrency-mt-unsafe): one thread calls it */
    run->pool->ended(run->pool->user, run->next++, &end);
}

/* Starts the next task in a free place. Returns false when the system has no room for a process. */
static bool start_next(struct run *run, struct child *place)
{
    size_t index = run->next;
    struct pool_start start = {.mask = &run->old_mask, .time_limit_s = 1e9};
    pid_t id = run->pool->start(run->pool->user, index, &start);
    int failure = errno;
    if (id < 0 && start.problem) {
        refuse(run, KILN_IO, start.problem, failure);
        return true;
    }
    double now = now_s();
    if (id < 0) {
        if (run->refusal_start_s < 0)
            run->refusal_start_s = now;
        if (run->running > 0 || now - run->refusal_start_s < REFUSAL_S)
            return false;
        refuse(run, KILN_DEVICE_FAILED, "cannot start a process", failure);
        return true;
    }
    run->next++;
    run->refusal_start_s = -1;
    run->running++;
    *place = (struct child){
        .id = id, .index = index, .started_s = now, .limit_s = start.time_limit_s, .sigterm_s = -1};
    return true;
}

static void terminate(struct child *child)
{
    if (child->sigterm_s >= 0)
        return;
    kill(-child->id, SIGTERM);
    child->sigterm_s = now_s();
}

/* Asks a child beyond its time limit to end, and kills it if it has not ended within GRACE_S. */
static void watch_child(struct child *child)
{
    double now = now_s();
    if (now - child->started_s > child->limit_s)
        terminate(child);
    if (child->sigterm_s >= 0 && now - child->sigterm_s > GRACE_S)
        kill(-child->id, SIGKILL);
}

/* Records the end of a child, if it has ended. */
static void reap_child(struct run *run, struct child *child)
{
    int status = 0;
    pid_t id;
    do
        id = waitpid(child->id, &status, WNOHANG);
    while (id < 0 && errno == EINTR);
    if (id == 0)
        return;
    /* An id below 0 means that other code has reaped the child, so its status is unknown. */
    struct pool_end end = {.total_s = now_s() - child->started_s,
                           .exit_code = KILN_DEVICE_FAILED,
                           .timed_out = child->sigterm_s >= 0};
    if (id > 0 && WIFSIGNALED(status) && !end.timed_out)
        end.signal = WTERMSIG(status);
    if (id > 0 && WIFEXITED(status))
        end.exit_code = WEXITSTATUS(status);
    child->id = 0;
    run->running--;
    if (!run->stopping)
        run->pool->ended(run->pool->user, child->index, &end);
}

/* ---- The pool ------------------------------------------------------------------------------- */

/* Sleeps until a child ends or reaches its time limit, at most LONGEST_SLEEP_S. */
static void sleep_until_event(const struct run *run)
{
    double sleep_s = LONGEST_SLEEP_S, now = now_s();
    for (uint32_t i = 0; i < run->pool->jobs; i++) {
        const struct child *child = &run->children[i];
        double left_s = child->started_s + child->limit_s - now;
        if (child->id && child->sigterm_s < 0 && left_s < sleep_s)
            sleep_s = left_s > 0.001 ? left_s : 0.001;
    }
    sigset_t child_signal;
    sigemptyset(&child_signal);
    sigaddset(&child_signal, SIGCHLD);
    sigtimedwait(&child_signal, NULL, &(struct timespec){.tv_nsec = (long)(1e9 * sleep_s)});
}

static bool may_start(const struct run *run)
{
    const struct pool *pool = run->pool;
    return !run->stopping && run->next < pool->count &&
           !(pool->no_more && pool->no_more(pool->user));
}

/* Starts tasks while there are free places. */
static void start_children(struct run *run)
{
    const struct pool *pool = run->pool;
    for (uint32_t i = 0; i < pool->jobs; i++) {
        while (!run->children[i].id && may_start(run)) {
            if (!start_next(run, &run->children[i]))
                return;
        }
    }
}

static void watch_children(struct run *run)
{
    for (uint32_t i = 0; i < run->pool->jobs; i++) {
        struct child *child = &run->children[i];
        if (child->id)
            reap_child(run, child);
        if (child->id && run->stopping)
            terminate(child);
        if (child->id)
            watch_child(child);
    }
}

static void work(struct run *run)
{
    while (run->running > 0 || may_start(run)) {
        run->stopping = run->stopping || run->pool->stop(run->pool->user);
        if (!run->stopping)
            start_children(run);
        watch_children(run);
        if (run->running > 0 || run->refusal_start_s >= 0)
            sleep_until_event(run);
    }
}

uint32_t pool_cores(void)
{
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? (uint32_t)CPU_COUNT(&set) : 1;
}

bool pool_run(const struct pool *pool, struct kiln_error *error)
{
    struct run run = {.pool = pool, .refusal_start_s = -1};
    run.children = calloc(pool->jobs, sizeof *run.children);
    if (!run.children) {
        *error =
            (struct kiln_error){.code = KILN_DEVICE_FAILED, .message = "out of memory for a job"};
        return false;
    }
    /* Some programs start kiln with SIGCHLD ignored. The status of children would then be lost. */
    struct sigaction action = {.sa_handler = SIG_DFL}, old_action;
    sigemptyset(&action.sa_mask);
    sigaction(SIGCHLD, &action, &old_action);
    sigset_t child_signal;
    sigemptyset(&child_signal);
    sigaddset(&child_signal, SIGCHLD);
    sigprocmask(SIG_BLOCK, &child_signal, &run.old_mask);
    work(&run);
    sigprocmask(SIG_SETMASK, &run.old_mask, NULL);
    sigaction(SIGCHLD, &old_action, NULL);
    free(run.children);
    if (run.stopping)
        *error = (struct kiln_error){.code = KILN_INTERRUPTED, .message = "stopped"};
    return !run.stopping;
}
