/* A handler has no other way to reach the program than a file-scope variable: the only one. */
#include "signals.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "kiln.h"

static volatile sig_atomic_t received;

static void on_signal(int number)
{
    if (received) {
        kiln_abandon_outputs();
        _exit(128 + number);
    }
    received = number;
}

void signals_install(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* not by nohup */
        sigaction(SIGHUP, &action, NULL);
}

int signals_received(void)
{
    return received;
}
