/* Stands in for a kiln whose job has taken it over. It enters the sandbox of libkiln as `kiln
 * render
 * --sandbox=require` does. Then, instead of rendering, it attacks the worker in the way that the
 * file job/attack names. Its second line is the path of a file that belongs to somebody else. */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "kiln.h"

#define CLIP  "output/clip.mp4"
#define LIMIT ((off_t)8 << 20) /* of `output`, in bytes */

enum { LIFE_S = 60, CHAINS = 4, CHAIN_S = 10, DEEP = 1200 };

static char secret[4096];

/* ---- what attacks are made of ---------------------------------------------------------------- */

static void rest(long milliseconds)
{
    const struct timespec time = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&time, NULL);
}

static bool is_there(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

static int write_file(const char *path, const char *text)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const bool written = file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text);
    return written && close(file) == 0 ? 0 : 1;
}

static int write_clip(void)
{
    return write_file(CLIP, "a clip");
}

/* Makes a clip of so many bytes, which take no room. */
static int clip_of(off_t bytes)
{
    const int file = open(CLIP, O_WRONLY | O_CREAT, 0644);
    return file < 0 || ftruncate(file, bytes) != 0;
}

static void tell(const char *event, long number)
{
    char line[128];
    const int length =
        snprintf(line, sizeof line, "{\"event\": \"%s\", \"process\": %ld}\n", event, number);
    if (write(STDOUT_FILENO, line, (size_t)length) != length)
        _exit(9);
}

/* Makes this process hard to find and to end, as far as the sandbox lets it. */
static void hide(void)
{
    prctl(PR_SET_PDEATHSIG, 0);
    setsid();
    setpgid(0, 0);
    signal(SIGTERM, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    tell("left", getpid());
}

/* Starts a process that outlives the job. `flags` are those of clone. Returns true in it. */
static bool leave(unsigned long flags)
{
    if (syscall(SYS_clone, flags | SIGCHLD, 0, 0, 0, 0) != 0)
        return false;
    hide();
    return true;
}

/* ---- processes that stay --------------------------------------------------------------------- */

/* Returns whether the worker has looked at the clip: it makes itself the owner, or records the
 * result. */
static bool worker_has_looked(void)
{
    struct stat status;
    return (lstat(CLIP, &status) == 0 && status.st_uid != getuid()) || is_there("result.tmp") ||
           is_there("result.json");
}

/* Swaps the clip for a link to the secret as soon as the worker has looked at the clip. */
static int swap_at_the_result(void)
{
    if (leave(0)) {
        for (const time_t end = time(NULL) + LIFE_S; time(NULL) < end && !worker_has_looked();)
            continue;
        unlink(CLIP);
        _exit(symlink(secret, CLIP));
    }
    rest(50);
    return clip_of(LIMIT);
}

/* Swaps the clip for a link to the secret and back, as fast as it can. */
static int swap_always(void)
{
    if (leave(0)) {
        for (const time_t end = time(NULL) + LIFE_S; time(NULL) < end;) {
            write_file("output/file", "a clip");
            if (symlink(secret, "output/link") == 0)
                rename("output/link", CLIP);
            rename("output/file", CLIP);
        }
        _exit(0);
    }
    rest(50);
    return is_there(CLIP) ? 0 : write_clip();
}

static void *rest_in_thread(void *unused)
{
    rest(LIFE_S * 1000L);
    return unused;
}

/* Leaves a process whose first thread ends, so that /proc calls it a zombie, while another goes on.
 */
static void leave_headless(unsigned long flags)
{
    pthread_t thread;
    if (!leave(flags))
        return;
    if (pthread_create(&thread, NULL, rest_in_thread, NULL) == 0)
        syscall(SYS_exit, 0);
    _exit(9);
}

/* Leaves a child, an orphan, and a process that is a child of the worker. */
static int outlive(void)
{
    if (leave(0) || leave(CLONE_PARENT))
        _exit((rest(LIFE_S * 1000L), 0));
    leave_headless(0);
    leave_headless(CLONE_PARENT);
    if (fork() == 0) {
        if (leave(0))
            _exit((rest(LIFE_S * 1000L), 0));
        _exit(0);
    }
    rest(50);
    return write_clip();
}

/* Leaves processes that have another number at each moment. */
static int chains(void)
{
    const time_t end = time(NULL) + CHAIN_S;
    for (int i = 0; i < CHAINS; i++) {
        if (leave(i % 2 ? CLONE_PARENT : 0)) {
            for (; time(NULL) < end; rest(20)) {
                if (fork() > 0)
                    _exit(0);
            }
            _exit(0);
        }
    }
    rest(50);
    return write_clip();
}

/* Leaves processes, and waits for the end of the worker. The second try of the job succeeds. */
static int wait_for_the_next_worker(void)
{
    if (is_there("events.2.ndjson"))
        return write_clip();
    if (!leave(0) && !leave(CLONE_PARENT)) {
        leave_headless(0);
        tell("waits", getpid());
    }
    rest(LIFE_S * 1000L);
    return 1;
}

/* Leaves only processes that a next worker finds hard to see: one that /proc calls a zombie, and a
 * chain of processes that live for less time than it takes to list them. */
static int hide_from_the_next_worker(void)
{
    if (is_there("events.2.ndjson"))
        return write_clip();
    leave_headless(0);
    if (leave(0)) {
        for (const time_t end = time(NULL) + LIFE_S; time(NULL) < end;) {
            if (fork() > 0)
                _exit(0);
        }
        _exit(0);
    }
    rest(LIFE_S * 1000L);
    return 1;
}

/* Does not end when it is told to. */
static int stay(void)
{
    if (is_there("events.1.ndjson") && is_there("job/go"))
        return write_clip();
    hide();
    rest(LIFE_S * 1000L);
    return 1;
}

/* ---- what is no clip ------------------------------------------------------------------------- */

static int link_to_secret(void)
{
    return symlink(secret, CLIP);
}

static int link_to_itself(void)
{
    return symlink("clip.mp4", CLIP);
}

static int second_name(void)
{
    return write_clip() || link(CLIP, "output/another");
}

static int pipe_as_clip(void)
{
    return syscall(SYS_mknodat, AT_FDCWD, CLIP, S_IFIFO | 0600, 0) == 0 || errno == EPERM
               ? write_clip()
               : 1;
}

static int folder_as_clip(void)
{
    return mkdir(CLIP, 0700);
}

static int terabyte(void)
{
    return clip_of((off_t)1 << 40);
}

static int beyond_the_limit(void)
{
    return clip_of(LIMIT + 1);
}

static int up_to_the_limit(void)
{
    return clip_of(LIMIT);
}

static int no_clip(void)
{
    return 0;
}

/* ---- what the worker reads and removes ------------------------------------------------------- */

static int hide_files(void)
{
    return mkdir("output/a", 0311) || mkdir("output/a/b", 0311) || mkdir("output/a/b/c", 0) ||
           write_file("output/a/b/file", "x") || write_clip();
}

static int go_deep(void)
{
    const int folder = open(".", O_PATH | O_DIRECTORY);
    if (chdir("output") != 0)
        return 1;
    for (int i = 0; i < DEEP; i++) {
        if (mkdir("deep", 0700) != 0 || chdir("deep") != 0)
            return 1;
    }
    return fchdir(folder) || write_clip();
}

/* Takes all room that the disk has. */
static int fill_by(int file)
{
    static char block[1 << 16];
    memset(block, 'x', sizeof block);
    for (size_t size = sizeof block; file >= 0 && size; size /= 2) {
        while (write(file, block, size) > 0)
            continue;
    }
    return 1;
}

static int fill_the_disk(void)
{
    return fill_by(open("output/fill", O_WRONLY | O_CREAT | O_APPEND, 0600));
}

/* Fills the disk in the cache, which stays when the job has ended. */
static int fill_the_cache(void)
{
    char path[4096];
    const char *cache = getenv("XDG_CACHE_HOME");
    const int length = snprintf(path, sizeof path, "%s/kiln/fill", cache ? cache : "");
    return length < (int)sizeof path ? fill_by(open(path, O_WRONLY | O_CREAT | O_APPEND, 0600)) : 2;
}

/* Takes all numbers of files that the disk has. */
static int make_many_files(void)
{
    char path[64];
    for (int i = 0;; i++) {
        snprintf(path, sizeof path, "output/file%d", i);
        if (mkdir(path, 0700) != 0)
            return 1;
    }
}

static int fill_by_events(void)
{
    return fill_by(STDOUT_FILENO);
}

static int fill_by_messages(void)
{
    return fill_by(STDERR_FILENO);
}

/* Takes back what it has told, as if it had never started. */
static int never_started(void)
{
    return ftruncate(STDOUT_FILENO, 0) ? 2 : 1;
}

static int endless_line(void)
{
    return ftruncate(STDOUT_FILENO, (off_t)64 << 30) || write_clip();
}

/* Writes millions of lines, each of which the worker looks at. */
static int many_events(void)
{
    enum { LINES = 30 << 20 };
    for (int i = 0; i < LINES; i++)
        putchar_unlocked(i % 2 ? '\n' : '1');
    return fflush(stdout) ? 1 : write_clip();
}

static int long_message(void)
{
    enum { BYTES = 30000 };
    printf("{\"event\": \"error\", \"message\": \"");
    for (int i = 0; i < BYTES; i++)
        putchar('a');
    printf("\"}\n{\"event\": \"ended\", \"code\": 3, \"again\": \"never\"}\n");
    return fflush(stdout) ? 1 : 3;
}

static int strange_events(void)
{
    printf("[]\n7\n{\"event\": []}\n{\"event\": \"ended\"}\n{\"event\": \"error\"}\n\xff\xfe\n"
           "{\"event\": \"error\", \"message\": {\"a\": \"\\ud800\\u001b\"}}\n");
    for (int i = 0; i < 5000; i++)
        putchar('[');
    return fflush(stdout) ? 1 : 3;
}

/* ---- what needs the test's help -------------------------------------------------------------- */

static int wait_for_go(void)
{
    for (int i = 0; i < LIFE_S * 100 && !is_there("job/go"); i++)
        rest(10);
    return write_clip();
}

static int wait_for_removal(void)
{
    for (int i = 0; i < LIFE_S * 100 && is_there("job/attack"); i++)
        rest(10);
    return 0;
}

/* ---- the process ----------------------------------------------------------------------------- */

static const struct attack {
    const char *name;
    int (*run)(void);
} attacks[] = {
    {"good", write_clip},
    {"swap at the result", swap_at_the_result},
    {"swap always", swap_always},
    {"outlive", outlive},
    {"chains", chains},
    {"next worker", wait_for_the_next_worker},
    {"hidden from the next worker", hide_from_the_next_worker},
    {"stay", stay},
    {"link", link_to_secret},
    {"loop", link_to_itself},
    {"second name", second_name},
    {"pipe", pipe_as_clip},
    {"folder", folder_as_clip},
    {"terabyte", terabyte},
    {"beyond the limit", beyond_the_limit},
    {"up to the limit", up_to_the_limit},
    {"no clip", no_clip},
    {"hidden files", hide_files},
    {"deep", go_deep},
    {"fill the disk", fill_the_disk},
    {"fill the cache", fill_the_cache},
    {"many files", make_many_files},
    {"fill by events", fill_by_events},
    {"fill by messages", fill_by_messages},
    {"many events", many_events},
    {"never started", never_started},
    {"endless line", endless_line},
    {"long message", long_message},
    {"strange events", strange_events},
    {"wait for go", wait_for_go},
    {"wait for removal", wait_for_removal},
};

static bool enter(void)
{
    static const char *const readable[] = {"job"}, *const writable[] = {CLIP};
    const struct kiln_sandbox_params params = {.size = sizeof params,
                                               .readable = readable,
                                               .readable_count = 1,
                                               .writable = writable,
                                               .writable_count = 1,
                                               .required = true};
    struct kiln_error error = {0};
    if (kiln_sandbox_enter(&params, &error))
        return true;
    fprintf(stderr, "%s\n", error.message);
    return false;
}

int main(int argc, char **argv)
{
    char name[64] = "";
    if (argc > 1 && strcmp(argv[1], "render") != 0)
        return puts("output        8 MiB       as `kiln help limits` says it") < 0;
    if (!enter())
        return 5;
    FILE *file = fopen("job/attack", "r");
    if (!file || fscanf(file, "%63[^\n]\n%4095[^\n]", name, secret) < 1)
        return 5;
    tell("started", getpid());
    for (size_t i = 0; i < sizeof attacks / sizeof *attacks; i++) {
        if (strcmp(attacks[i].name, name) == 0)
            return attacks[i].run();
    }
    fprintf(stderr, "no attack '%s'\n", name);
    return 5;
}
