/* Starts the process of each test by fork without exec: the parent has neither threads nor a
 * device, so a child can use its copy of the parent's memory. When the parent is killed, the kernel
 * ends its children. */
#include "test_pool.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "signals.h"
#include "test_files.h"

struct child {
    const struct pool_start *start;
    pid_t parent;
    int log;
    int (*run)(void *user, size_t index);
    void *user;
    size_t index;
};

_Noreturn static void run_child(const struct child *child)
{
    setpgid(0, 0);
    signals_install_immediate();
    signal(SIGABRT, SIG_DFL); /* the parent tells of a crash, and shows the end of the log */
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != child->parent) /* the parent has died already */
        _exit(128 + SIGTERM);
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (nothing < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(child->log, STDOUT_FILENO) < 0 ||
        dup2(child->log, STDERR_FILENO) < 0)
        _exit(KILN_IO);
    sigprocmask(SIG_SETMASK, child->start->mask, NULL);
    int code = child->run(child->user, child->index);
    fflush(stdout);
    _exit(code);
}

/* Forks the child and returns its id, or below 0 with errno. Signals that might stop the child are
 * blocked until it has its own handlers. */
static pid_t start_child(const struct child *child)
{
    sigset_t stops, before;
    sigemptyset(&stops);
    sigaddset(&stops, SIGINT);
    sigaddset(&stops, SIGTERM);
    sigaddset(&stops, SIGHUP);
    fflush(NULL);
    sigprocmask(SIG_BLOCK, &stops, &before);
    pid_t id = fork();
    if (id == 0)
        run_child(child);
    int failure = errno;
    if (id > 0)
        setpgid(id, id); /* also here: a signal to the group may come before the child calls it */
    sigprocmask(SIG_SETMASK, &before, NULL);
    errno = failure;
    return id;
}

pid_t test_pool_start(struct pool_start *start, const char *log,
                      int (*run)(void *user, size_t index), void *user, size_t index)
{
    const struct child child = {
        .start = start,
        .parent = getpid(),
        .log = create_log(log),
        .run = run,
        .user = user,
        .index = index,
    };
    if (child.log < 0) {
        start->problem = "cannot create its log file";
        return -1;
    }
    const pid_t id = start_child(&child);
    const int failure = errno;
    close(child.log);
    errno = failure;
    return id;
}
