/* lib/job/sandbox.c: a process that has entered a sandbox can do what a job does, and nothing of
 * what somebody would want who has taken it over. Each question is asked in a process of its own.
 */
#include <fcntl.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "kiln.h"
#include "support/cmocka.h"
#include "support/folders.h"

static pid_t other; /* a process that is none of ours to touch */

/* ---- what is tried --------------------------------------------------------------------------- */

static bool opens(const char *path, int flags)
{
    const int file = open(path, flags, 0600);
    if (file >= 0)
        close(file);
    return file >= 0;
}

static bool read_inside(void)
{
    return opens("in/a", O_RDONLY);
}

static bool write_to_output(void)
{
    return opens("out/a", O_WRONLY | O_CREAT) && rename("out/a", "out/b") == 0 &&
           mkdir("out/deep", 0700) == 0 && unlink("out/b") == 0;
}

static void *nothing(void *user)
{
    return user;
}

static bool start_threads(void)
{
    pthread_t thread;
    return pthread_create(&thread, NULL, nothing, NULL) == 0 && pthread_join(thread, NULL) == 0;
}

static bool decode_a_picture(void)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image =
        kiln_asset_image_load(NULL, KILN_SOURCE_DIR "/tests/cli/scenes/puff.png", &error);
    const bool decoded = image != NULL;
    kiln_asset_image_destroy(&image);
    return decoded;
}

static bool read_outside(void)
{
    return opens("secret", O_RDONLY) || opens("in/../secret", O_RDONLY) ||
           opens("in/link", O_RDONLY) || opens("/etc/passwd", O_RDONLY);
}

static bool write_outside(void)
{
    return opens("in/b", O_WRONLY | O_CREAT) || opens("in/a", O_WRONLY) ||
           opens("new", O_WRONLY | O_CREAT) || opens("/tmp/kiln-sandbox", O_WRONLY | O_CREAT) ||
           truncate("in/a", 0) == 0;
}

static bool change_outside(void)
{
    return unlink("secret") == 0 || rename("secret", "out/secret") == 0 ||
           link("secret", "out/hard") == 0 || mkdir("folder", 0700) == 0 ||
           symlink("../secret", "in/soft") == 0;
}

/* Writes or reads the cache of programs, which a driver of a job outside would trust. */
static bool reach_programs(void)
{
    return opens("cache/kiln-programs/a", O_RDONLY) ||
           opens("cache/kiln-programs/b", O_WRONLY | O_CREAT) ||
           rename("cache/kiln", "cache/kiln-programs2") == 0 ||
           rename("cache/kiln-programs", "cache/kiln/programs") == 0;
}

/* Writes the cache of flipbooks. */
static bool write_to_cache(void)
{
    return opens("cache/kiln/a", O_WRONLY | O_CREAT);
}

static bool open_sockets(void)
{
    return socket(AF_INET, SOCK_STREAM, 0) >= 0 || socket(AF_INET6, SOCK_DGRAM, 0) >= 0 ||
           socket(AF_UNIX, SOCK_STREAM, 0) >= 0;
}

static bool start_programs(void)
{
    const pid_t child = fork();
    int status = 0;
    if (child == 0) {
        execl("/bin/true", "true", (char *)NULL);
        execl("/bin/sh", "sh", "-c", ":", (char *)NULL);
        _exit(99);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WEXITSTATUS(status) != 99;
}

static bool reach_processes(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/environ", (int)other);
    return kill(other, SIGTERM) == 0 || ptrace(PTRACE_ATTACH, other, NULL, NULL) == 0 ||
           opens(path, O_RDONLY);
}

/* Calls that the C library has no names for yet. */
enum { FCHMODAT2 = 452, SETXATTRAT = 463 };

static bool sets_attribute(const char *path)
{
    const struct {
        uint64_t value;
        uint32_t size, flags;
    } attribute = {(uintptr_t) "x", 1, 0};
    return syscall(SETXATTRAT, AT_FDCWD, path, 0, "user.kiln", &attribute, sizeof attribute) == 0;
}

static bool change_others(void)
{
    const struct rlimit limit = {1000, 1000};
    return prlimit(other, RLIMIT_CPU, &limit, NULL) == 0 || chmod("secret", 0777) == 0 ||
           utimensat(AT_FDCWD, "secret", NULL, 0) == 0 || setpriority(PRIO_PROCESS, 0, 5) == 0 ||
           syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, 0, 0, 0, 0) > 0 ||
           syscall(SYS_memfd_create, "x", 0) >= 0 ||
           syscall(FCHMODAT2, AT_FDCWD, "secret", 0777, 0) == 0 || sets_attribute("secret");
}

static bool make_devices(void)
{
    return mknod("out/null", S_IFCHR | 0600, (dev_t)0x103) == 0 || mkfifo("out/fifo", 0600) == 0 ||
           chroot("out") == 0;
}

/* Takes 256 MiB in a process that cannot read its files below /proc: the sandbox lets only the
 * process that entered it read its own. Returns whether the limit of memory was met. */
static bool meet_the_limit_of_memory(void)
{
    enum { TAKEN = 256 << 20 };
    const pid_t child = fork();
    int status = 0;
    if (child == 0) {
        struct kiln_limits limits = kiln_limits_empty();
        struct kiln_error error = {0};
        limits.most[KILN_LIMIT_memory] = (uint64_t)128 << 20;
        struct kiln_budget *budget = kiln_budget_create(&limits);
        if (!budget || opens("/proc/self/statm", O_RDONLY) || !kiln_budget_is_kept(budget, &error))
            _exit(2);
        char *bytes = malloc(TAKEN);
        for (size_t i = 0; bytes && i < TAKEN; i += 4096)
            ((volatile char *)bytes)[i] = 1;
        _exit(kiln_budget_is_kept(budget, &error) ? 0 : error.code == KILN_OVER_LIMIT ? 1 : 3);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
           WEXITSTATUS(status) == 1;
}

/* Returns whether a process that this one starts can make a call; the call changes that process
 * alone. */
static bool child_can(bool (*call)(void))
{
    const pid_t child = fork();
    int status = 1;
    if (child == 0)
        _exit(call() ? 0 : 1);
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

static bool call_setsid(void)
{
    return setsid() > 0;
}

static bool call_setpgid(void)
{
    return setpgid(0, 0) == 0;
}

/* A supervisor ends a job by its process group, and finds what is left by its session. */
static bool leave_the_session(void)
{
    return child_can(call_setsid);
}

static bool leave_the_group(void)
{
    return child_can(call_setpgid);
}

/* ---- asking ---------------------------------------------------------------------------------- */

static bool enter(void)
{
    static const char *const readable[] = {"in", KILN_SOURCE_DIR "/tests/cli/scenes"};
    static const char *const writable[] = {"out/{scene}_####.png"};
    const struct kiln_sandbox_params params = {.size = sizeof params,
                                               .readable = readable,
                                               .readable_count = 2,
                                               .writable = writable,
                                               .writable_count = 1,
                                               .required = true};
    struct kiln_error error = {0};
    return kiln_sandbox_enter(&params, &error);
}

static bool succeeds(bool (*attempt)(void))
{
    const pid_t child = fork();
    int status = 0;
    if (child == 0)
        _exit(!enter() ? 2 : attempt() ? 1 : 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) < 2);
    return WEXITSTATUS(status) == 1;
}

static int set_up(void **state)
{
    test_enter_folder(state);
    test_write_file("in/a", "a");
    test_write_file("secret", "s");
    test_write_file("cache/kiln-programs/a", "a");
    test_write_file("cache/kiln/old", "o");
    char folder[256], cache[300];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(cache, sizeof cache, "%s/cache", folder);
    assert_int_equal(setenv("XDG_CACHE_HOME", cache, 1), 0);
    const int linked = symlink("../secret", "in/link");
    other = fork();
    if (other == 0) {
        pause();
        _exit(0);
    }
    return linked != 0 || other < 0;
}

static int tear_down(void **state)
{
    kill(other, SIGKILL);
    waitpid(other, NULL, 0);
    return test_leave_folder(state);
}

static bool is_possible(void)
{
    struct kiln_sandbox_support has = kiln_sandbox_support_empty();
    kiln_sandbox_get_support(&has);
    return has.landlock >= 6 && has.seccomp;
}

static void a_job_can_work(void **state)
{
    (void)state;
    if (!is_possible())
        skip();
    assert_true(succeeds(read_inside));
    assert_true(succeeds(write_to_output));
    assert_true(succeeds(write_to_cache));
    assert_true(succeeds(start_threads));
    assert_true(succeeds(decode_a_picture));
}

static void memory_is_limited_without_proc(void **state)
{
    (void)state;
    if (!is_possible())
        skip();
    assert_true(succeeds(meet_the_limit_of_memory));
}

static void nothing_else_can_be_done(void **state)
{
    (void)state;
    if (!is_possible())
        skip();
    assert_false(succeeds(read_outside));
    assert_false(succeeds(write_outside));
    assert_false(succeeds(change_outside));
    assert_false(succeeds(reach_programs));
    assert_false(succeeds(open_sockets));
    assert_false(succeeds(start_programs));
    assert_false(succeeds(reach_processes));
    assert_false(succeeds(change_others));
    assert_false(succeeds(make_devices));
    assert_false(succeeds(leave_the_session));
    assert_false(succeeds(leave_the_group));
}

/* The attempts above are no attempts unless they work without a sandbox. */
static void all_of_it_works_outside(void **state)
{
    (void)state;
    assert_true(read_outside() && write_outside() && change_outside() && reach_programs() &&
                write_to_cache() && open_sockets() && start_programs() && leave_the_session() &&
                leave_the_group());
    unlink("/tmp/kiln-sandbox");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_job_can_work, set_up, tear_down),
        cmocka_unit_test_setup_teardown(memory_is_limited_without_proc, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_else_can_be_done, set_up, tear_down),
        cmocka_unit_test_setup_teardown(all_of_it_works_outside, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("sandbox", tests, NULL, NULL);
}
