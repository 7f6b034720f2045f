/* Stands in for a job that a malicious file has taken over. Each attempt uses what a job may
 * inherit (a terminal, a pipe that others share, a socket, a process, objects of System V) to act
 * on what lies outside the job. It is made twice, each time in a process of its own: once as the
 * process is started, and once after kiln_sandbox_enter. In the sandbox every attempt must be
 * refused. Outside, the attempts that need no special rights must work, since they are no attempts
 * otherwise.
 *
 *     taken_job FOLDER
 *
 * FOLDER is a folder in which it may write, and which has a folder `in`. It prints a line for each
 * attempt, and ends with 1 if one is not as it should be, and with 77 where the kernel has no
 * sandbox. */
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <mqueue.h>
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/sendfile.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "kiln.h"

/* What the job inherits. */
static int terminal, pipe_ends[2], datagram, stream[2], secret, unwritten, victim_handle;
static pid_t victim; /* another process of the same user */
static struct sockaddr_in listener = {.sin_family = AF_INET};
static int memory_id, queue_id, semaphore_id;

/* ---- attempts: each function returns 0 if it worked, or errno
 * ------------------------------------
 */

static int result(long value)
{
    return value < 0 ? errno : 0;
}

/* Types a command into the shell that waits at the terminal. */
static int type_command(void)
{
    char byte = 'x';
    return result(ioctl(terminal, TIOCSTI, &byte));
}

/* The kernel ignores the upper half of a command. */
static int type_by_high_bits(void)
{
    char byte = 'x';
    return result(syscall(SYS_ioctl, terminal, (uint64_t)1 << 32 | TIOCSTI, &byte));
}

static int select_text(void)
{
    char subcode = 3; /* paste the selection, as if it were typed */
    return result(ioctl(terminal, TIOCLINUX, &subcode));
}

static int set_discipline(void)
{
    int discipline = 0;
    return result(ioctl(terminal, TIOCSETD, &discipline));
}

static int take_console(void)
{
    return result(ioctl(terminal, TIOCCONS, 0));
}

static int hide_typing(void)
{
    struct termios modes;
    if (tcgetattr(terminal, &modes) != 0)
        return errno;
    modes.c_lflag &= ~(tcflag_t)ECHO;
    return result(tcsetattr(terminal, TCSANOW, &modes));
}

static int resize_terminal(void)
{
    struct winsize size = {.ws_row = 1, .ws_col = 1};
    return result(ioctl(terminal, TIOCSWINSZ, &size));
}

static int close_terminal_to_others(void)
{
    return result(ioctl(terminal, TIOCEXCL, 0));
}

static int drop_typing(void)
{
    return result(tcflush(terminal, TCIFLUSH));
}

static int take_foreground(void)
{
    return result(ioctl(terminal, TIOCSPGRP, &(pid_t){getpgrp()}));
}

/* Makes a shared pipe fail in the processes that share it. */
static int unblock_by_ioctl(void)
{
    return result(ioctl(pipe_ends[0], FIONBIO, &(int){1}));
}

static int unblock_by_fcntl(void)
{
    return result(fcntl(pipe_ends[0], F_SETFL, O_NONBLOCK));
}

/* Lets a log be overwritten that was opened to append. */
static int end_appending(void)
{
    return result(fcntl(secret, F_SETFL, 0));
}

static int ask_for_signals(void)
{
    return result(ioctl(pipe_ends[0], FIOASYNC, &(int){1}));
}

static int own_signals(void)
{
    return result(fcntl(pipe_ends[0], F_SETOWN, victim));
}

static int own_signals_by_ioctl(void)
{
    return result(ioctl(stream[0], FIOSETOWN, &victim));
}

static int choose_signal(void)
{
    return result(fcntl(pipe_ends[0], F_SETSIG, SIGKILL));
}

static int shrink_pipe(void)
{
    return result(fcntl(pipe_ends[0], F_SETPIPE_SZ, 4096));
}

static int lease_file(void)
{
    return result(fcntl(unwritten, F_SETLEASE, F_RDLCK));
}

static int high_bits_of_fcntl(void)
{
    return result(syscall(SYS_fcntl, pipe_ends[0], (uint64_t)1 << 32 | F_SETFL, O_NONBLOCK));
}

/* Reads from a shared pipe what another process is to read. */
static int copy_pipe(void)
{
    int own[2];
    if (pipe(own) != 0)
        return errno;
    return result(tee(pipe_ends[0], own[1], 1, SPLICE_F_NONBLOCK));
}

static int splice_pipe(void)
{
    int own[2];
    if (pipe(own) != 0)
        return errno;
    return result(splice(pipe_ends[0], NULL, own[1], NULL, 1, SPLICE_F_NONBLOCK));
}

static int gift_pages(void)
{
    static char page[4096];
    struct iovec part = {page, sizeof page};
    int own[2];
    if (pipe(own) != 0)
        return errno;
    return result(vmsplice(own[1], &part, 1, SPLICE_F_NONBLOCK));
}

static int send_file(void)
{
    return result(sendfile(pipe_ends[1], secret, &(off_t){0}, 1));
}

/* Sends to any address by a socket that somebody else has opened. */
static int send_to_address(void)
{
    return result(sendto(datagram, "x", 1, 0, (const void *)&listener, sizeof listener));
}

static int send_many(void)
{
    struct iovec part = {(char *)"x", 1};
    struct mmsghdr message = {.msg_hdr = {.msg_name = &listener,
                                          .msg_namelen = sizeof listener,
                                          .msg_iov = &part,
                                          .msg_iovlen = 1}};
    return result(sendmmsg(datagram, &message, 1, 0));
}

static int end_connection(void)
{
    return result(shutdown(stream[0], SHUT_RDWR));
}

static int set_socket(void)
{
    return result(setsockopt(stream[0], SOL_SOCKET, SO_SNDBUF, &(int){1}, sizeof(int)));
}

/* Opens an inherited file again, to read what may only be written. */
static int open_again(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", secret);
    return result(open(path, O_RDONLY));
}

static int open_terminal_again(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", terminal);
    return result(open(path, O_RDWR | O_NOCTTY));
}

static int open_controlling_terminal(void)
{
    return result(open("/dev/tty", O_RDWR | O_NOCTTY));
}

static int link_file(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", secret);
    unlink("out/linked");
    return result(linkat(AT_FDCWD, path, AT_FDCWD, "out/linked", AT_SYMLINK_FOLLOW));
}

/* Runs a program that lies in no file. */
static int run_from_memory(void)
{
    const int file = memfd_create("x", 0);
    return file < 0 ? errno : 0;
}

static int run_descriptor(void)
{
    char *const arguments[] = {(char *)"true", NULL};
    const int file = open("/bin/true", O_RDONLY);
    syscall(SYS_execveat, file, "", arguments, NULL, AT_EMPTY_PATH);
    return errno;
}

static int signal_handle(void)
{
    return result(syscall(SYS_pidfd_send_signal, victim_handle, SIGUSR2, NULL, 0));
}

static int take_from_handle(void)
{
    return result(syscall(SYS_pidfd_getfd, victim_handle, 0, 0));
}

static int remove_memory(void)
{
    return result(shmctl(memory_id, IPC_RMID, NULL));
}

static int send_to_queue(void)
{
    const struct {
        long type;
        char text[1];
    } message = {1, {'x'}};
    return result(msgsnd(queue_id, &message, 1, IPC_NOWAIT));
}

static int remove_queue(void)
{
    return result(msgctl(queue_id, IPC_RMID, NULL));
}

static int take_semaphore(void)
{
    struct sembuf step = {.sem_op = 1};
    return result(semop(semaphore_id, &step, 1));
}

static int remove_semaphore(void)
{
    return result(semctl(semaphore_id, 0, IPC_RMID));
}

static int remove_message_queue(void)
{
    return result(mq_unlink("/kiln-hostile"));
}

static const struct attempt {
    const char *name;
    int (*make)(void);
    /* without a sandbox, because it needs rights or a kind of terminal that may be missing */
    bool may_fail;
    bool of_machine; /* it would act on the whole machine, so it is made in the sandbox alone */
} attempts[] = {
    {.name = "type a command (TIOCSTI)", .make = type_command, .may_fail = true},
    {.name = "type a command (TIOCSTI, high bits)", .make = type_by_high_bits, .may_fail = true},
    {.name = "paste a selection (TIOCLINUX)", .make = select_text, .may_fail = true},
    {.name = "set a line discipline (TIOCSETD)", .make = set_discipline, .may_fail = true},
    {.name = "take the console (TIOCCONS)", .make = take_console, .of_machine = true},
    {.name = "hide what is typed (TCSETS)", .make = hide_typing},
    {.name = "resize the terminal (TIOCSWINSZ)", .make = resize_terminal},
    {.name = "close the terminal to others (TIOCEXCL)", .make = close_terminal_to_others},
    {.name = "drop what was typed (TCFLSH)", .make = drop_typing},
    {.name = "take the foreground (TIOCSPGRP)", .make = take_foreground},
    {.name = "unblock a pipe (FIONBIO)", .make = unblock_by_ioctl},
    {.name = "unblock a pipe (F_SETFL)", .make = unblock_by_fcntl},
    {.name = "unblock a pipe (F_SETFL, high bits)", .make = high_bits_of_fcntl},
    {.name = "end appending (F_SETFL)", .make = end_appending},
    {.name = "ask for signals (FIOASYNC)", .make = ask_for_signals},
    {.name = "send signals to others (F_SETOWN)", .make = own_signals},
    {.name = "send signals to others (FIOSETOWN)", .make = own_signals_by_ioctl},
    {.name = "choose the signal (F_SETSIG)", .make = choose_signal},
    {.name = "shrink a pipe (F_SETPIPE_SZ)", .make = shrink_pipe},
    {.name = "lease a file (F_SETLEASE)", .make = lease_file},
    {.name = "copy from a pipe (tee)", .make = copy_pipe},
    {.name = "move from a pipe (splice)", .make = splice_pipe},
    {.name = "give pages to a pipe (vmsplice)", .make = gift_pages},
    {.name = "send a file (sendfile)", .make = send_file},
    {.name = "send to an address (sendto)", .make = send_to_address},
    {.name = "send to an address (sendmmsg)", .make = send_many},
    {.name = "end a connection (shutdown)", .make = end_connection},
    {.name = "change a socket (setsockopt)", .make = set_socket},
    {.name = "open a file again", .make = open_again},
    {.name = "open the terminal again", .make = open_terminal_again, .may_fail = true},
    {.name = "open the controlling terminal", .make = open_controlling_terminal},
    {.name = "link a file", .make = link_file, .may_fail = true},
    {.name = "make a file in memory", .make = run_from_memory},
    {.name = "run a descriptor (execveat)", .make = run_descriptor},
    {.name = "signal by a process descriptor", .make = signal_handle},
    {.name = "take a descriptor of a process", .make = take_from_handle, .may_fail = true},
    {.name = "send to a message queue", .make = send_to_queue},
    {.name = "post a semaphore", .make = take_semaphore},
    {.name = "remove shared memory", .make = remove_memory},
    {.name = "remove a message queue", .make = remove_queue},
    {.name = "remove semaphores", .make = remove_semaphore},
    {.name = "remove a queue by name", .make = remove_message_queue},
};

/* ---- what the job inherits ------------------------------------------------------------------- */

static void require(bool ok, const char *what)
{
    if (ok)
        return;
    perror(what);
    exit(2);
}

/* Starts a process that ends by a signal or when this one ends. */
static void start_victim(void)
{
    int ends[2];
    require(pipe(ends) == 0, "pipe");
    victim = fork();
    require(victim >= 0, "fork");
    if (victim == 0) {
        char byte;
        signal(SIGUSR2, SIG_IGN);
        close(ends[1]);
        _exit(read(ends[0], &byte, 1) != 0);
    }
    close(ends[0]);
    victim_handle = (int)syscall(SYS_pidfd_open, victim, 0);
    require(victim_handle >= 0, "pidfd_open");
}

static void make_objects(void)
{
    memory_id = shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600);
    queue_id = msgget(IPC_PRIVATE, IPC_CREAT | 0600);
    semaphore_id = semget(IPC_PRIVATE, 1, IPC_CREAT | 0600);
    const mqd_t queue = mq_open("/kiln-hostile", O_RDWR | O_CREAT, 0600, NULL);
    require(memory_id >= 0 && queue_id >= 0 && semaphore_id >= 0 && queue >= 0, "objects");
    mq_close(queue);
}

static void remove_objects(void)
{
    shmctl(memory_id, IPC_RMID, NULL);
    msgctl(queue_id, IPC_RMID, NULL);
    semctl(semaphore_id, 0, IPC_RMID);
    mq_unlink("/kiln-hostile");
}

static void open_sockets(void)
{
    socklen_t size = sizeof listener;
    const int bound = socket(AF_INET, SOCK_DGRAM, 0);
    listener.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    require(bound >= 0 && bind(bound, (const void *)&listener, size) == 0 &&
                getsockname(bound, (void *)&listener, &size) == 0,
            "a socket");
    datagram = socket(AF_INET, SOCK_DGRAM, 0);
    require(datagram >= 0 && socketpair(AF_UNIX, SOCK_STREAM, 0, stream) == 0, "sockets");
}

/* Leads a session of its own, whose terminal it opens. */
static void open_terminal(void)
{
    int other;
    setsid();
    require(openpty(&other, &terminal, NULL, NULL, NULL) == 0, "openpty");
    require(ioctl(terminal, TIOCSCTTY, 0) == 0, "TIOCSCTTY");
}

static void inherit(void)
{
    open_sockets();
    open_terminal();
    secret = open("secret", O_RDWR | O_APPEND | O_CREAT, 0600);
    require(secret >= 0 && write(secret, "s", 1) == 1, "secret");
    close(open("unwritten", O_WRONLY | O_CREAT, 0600));
    unwritten = open("unwritten", O_RDONLY);
    require(unwritten >= 0, "unwritten");
    require(pipe(pipe_ends) == 0 && write(pipe_ends[1], "xx", 2) == 2, "pipe");
}

/* ---- asking ---------------------------------------------------------------------------------- */

static void enter(void)
{
    static const char *const readable[] = {"in"}, *const writable[] = {"out/"};
    const struct kiln_sandbox_params params = {.size = sizeof params,
                                               .readable = readable,
                                               .readable_count = 1,
                                               .writable = writable,
                                               .writable_count = 1,
                                               .required = true};
    struct kiln_error error = {0};
    if (kiln_sandbox_enter(&params, &error))
        return;
    fprintf(stderr, "%s\n", error.message);
    exit(2);
}

/* Makes an attempt in a new process with new things to inherit. Returns 0 if it worked, otherwise
 * errno; -1 if the process ended in another way. */
static int ask(const struct attempt *attempt, bool confined)
{
    int answer[2], got = -1;
    require(pipe(answer) == 0, "pipe");
    make_objects();
    fflush(stdout);
    const pid_t child = fork();
    require(child >= 0, "fork");
    if (child == 0) {
        signal(SIGHUP, SIG_IGN); /* comes when the terminal closes */
        inherit();
        if (confined)
            enter();
        fcntl(answer[1], F_SETFD, FD_CLOEXEC); /* a program that runs closes it without an answer */
        errno = 0;
        got = attempt->make();
        if (write(answer[1], &got, sizeof got) != (ssize_t)sizeof got)
            _exit(2);
        _exit(0);
    }
    close(answer[1]);
    if (read(answer[0], &got, sizeof got) != (ssize_t)sizeof got)
        got = attempt->make == run_descriptor ? 0 : -1;
    close(answer[0]);
    waitpid(child, NULL, 0);
    remove_objects();
    return got;
}

static bool check(const struct attempt *attempt)
{
    const int outside = attempt->of_machine ? 0 : ask(attempt, false), inside = ask(attempt, true);
    const bool refused = inside == EPERM || inside == EACCES || inside == ENOSYS || inside == EXDEV;
    const bool is_attempt = outside == 0 || attempt->may_fail;
    printf("%-40s %-32s %-32s %s\n", attempt->name,
           attempt->of_machine ? "not made"
           : outside           ? strerror(outside)
                               : "works",
           inside > 0 ? strerror(inside)
           : inside   ? "ended"
                      : "works",
           !refused      ? "NOT REFUSED"
           : !is_attempt ? "NO ATTEMPT"
                         : "");
    return refused && is_attempt;
}

int main(int argc, char **argv)
{
    struct kiln_sandbox_support has = kiln_sandbox_support_empty();
    int failed = 0;
    kiln_sandbox_get_support(&has);
    if (has.off || has.landlock < 6 || !has.seccomp)
        return 77;
    require(argc == 2 && chdir(argv[1]) == 0, "taken_job FOLDER");
    start_victim();
    printf("%-40s %-32s %-32s\n", "ATTEMPT", "OUTSIDE", "IN THE SANDBOX");
    for (size_t i = 0; i < sizeof attempts / sizeof *attempts; i++)
        failed += !check(&attempts[i]);
    printf("%zu attempts, %d of them not as they should be\n", sizeof attempts / sizeof *attempts,
           failed);
    return failed > 0;
}
