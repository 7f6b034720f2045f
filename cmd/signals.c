/* A handler has no other way to reach the program than variables of the file: the only ones. */
#include "signals.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "kiln.h"

static volatile sig_atomic_t received;
static timer_t patience; /* runs out PATIENCE_NS after the first signal; valid when has_patience */
static volatile sig_atomic_t has_patience;

/* An encoder of a library cannot be left in the middle of a large frame. Whatever a job still does
 * so long after the signal is given up: it ends within a second. */
static const long PATIENCE_NS = 500000000;

static void end_program(int number)
{
    kiln_abandon_outputs();
    _exit(128 + number);
}

static void on_signal(int number)
{
    if (received)
        end_program(number);
    received = number;
    if (has_patience)
        timer_settime(patience, 0, &(struct itimerspec){.it_value.tv_nsec = PATIENCE_NS}, NULL);
}

static void on_patience_over(int number)
{
    (void)number;
    const char *name = signals_name(received);
    static const char before[] = "kiln: stopped by ",
                      after[] = "; what was not whole is given up\n";
    char line[sizeof before + sizeof after + 16];
    size_t size = 0;
    for (const char *words[] = {before, name, after}, **word = words; word < words + 3; word++) {
        memcpy(line + size, *word, strlen(*word));
        size += strlen(*word);
    }
    ssize_t written = write(STDERR_FILENO, line, size);
    (void)written;
    end_program(received);
}

static void install(void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* not by nohup */
        sigaction(SIGHUP, &action, NULL);
}

void signals_install(void)
{
    install(on_signal);
}

void signals_install_for_job(void)
{
    struct sigaction action = {.sa_handler = on_patience_over};
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGALRM};
    sigemptyset(&action.sa_mask);
    has_patience = sigaction(SIGALRM, &action, NULL) == 0 &&
                   timer_create(CLOCK_MONOTONIC, &event, &patience) == 0;
    install(on_signal);
}

void signals_end_at_once(void)
{
    install(end_program);
}

bool signals_wants_stop(void *user)
{
    (void)user;
    return received != 0;
}

const char *signals_name(int number)
{
    return number == SIGINT ? "SIGINT" : number == SIGTERM ? "SIGTERM" : "SIGHUP";
}

int signals_received(void)
{
    return received;
}
