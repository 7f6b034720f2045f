/* Handles SIGINT, SIGTERM and SIGHUP: the first asks the job to stop, the second ends the program.
 * SIGABRT ends it with a message. A handler can reach the state of the program only through
 * variables of a file, so this file has some. */
#include "signals.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "event.h"
#include "exit_message.h"
#include "report.h"

static volatile sig_atomic_t received;
static volatile sig_atomic_t has_grace; /* the program ends GRACE_US after the first signal */

/* Microseconds that a job has to stop after the first signal, since an encoder of a library cannot
 * be stopped in the middle of a large frame. So the program ends within a second. */
static const long GRACE_US = 500000;

static const char *name_of(int number)
{
    return number == SIGINT ? "SIGINT" : number == SIGTERM ? "SIGTERM" : "SIGHUP";
}

/* Writes the message about a job that a signal has ended: "kiln: stopped by SIGTERM; ...". */
static void describe_end(char line[128], int number)
{
    strcpy(line, "kiln: stopped by ");
    strcat(line, name_of(number));
    strcat(line, "; unfinished files are discarded\n");
}

/* Handles a signal that ends the program at once. It prints nothing on standard error, since the
 * user asked for the end. */
static void end_program(int number)
{
    char line[128];
    describe_end(line, number);
    kiln_abandon_outputs();
    events_write_final(line + strlen("kiln: "), 128 + number);
    _exit(128 + number);
}

static void on_signal(int number)
{
    if (received)
        end_program(number);
    received = number;
    if (has_grace) { /* setitimer is a plain system call, so a handler may call it */
        const int before = errno;
        setitimer(ITIMER_REAL, &(struct itimerval){.it_value.tv_usec = GRACE_US}, NULL);
        errno = before;
    }
}

static void on_grace_over(int number)
{
    if (!received) { /* SIGALRM from elsewhere ends the program as usual */
        kiln_abandon_outputs();
        signal(number, SIG_DFL);
        raise(number);
        return;
    }
    char line[128];
    describe_end(line, received);
    exit_with_message(line, 128 + received);
}

static void on_abort(int number)
{
    (void)number;
    exit_with_message("kiln: ended by SIGABRT; perhaps the machine is short of memory; unfinished "
                      "files are discarded\n",
                      KILN_DEVICE_FAILED);
}

/* Unblocks the signal, which may have been blocked when the program was started. */
static void unblock(int number)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, number);
    pthread_sigmask(SIG_UNBLOCK, &set, NULL);
}

static void install_one(int number, void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
    unblock(number);
}

static void install(void (*handler)(int))
{
    install_one(SIGINT, handler);
    install_one(SIGTERM, handler);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* not in nohup */
        install_one(SIGHUP, handler);
}

void signals_install_abort(void)
{
    install_one(SIGABRT, on_abort);
}

void signals_install(void)
{
    install(on_signal);
}

void signals_install_for_job(void)
{
    install_one(SIGALRM, on_grace_over);
    has_grace = true;
    install(on_signal);
}

void signals_install_immediate(void)
{
    install(end_program);
}

bool signals_wants_stop(void *user)
{
    (void)user;
    return received != 0 || events_failed();
}

int signals_received(void)
{
    return received;
}

int signals_report(const char *what, const char *format, ...)
{
    if (!received)
        return KILN_READER_GONE;
    char how[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(how, sizeof how, format, args);
    va_end(args);
    report((enum kiln_code)(128 + received), "%s: stopped by %s%s", what, name_of(received), how);
    return 128 + received;
}
