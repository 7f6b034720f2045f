/* A handler has no other way to reach the program than a file-scope variable: the only one. */
#include "signals.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "kiln.h"

static volatile sig_atomic_t received;

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
