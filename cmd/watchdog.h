/* Ends the program when a frame takes too long. A hung driver cannot be interrupted in any other
 * way: the thread that called it never comes back. */
#ifndef KILN_CMD_WATCHDOG_H
#define KILN_CMD_WATCHDOG_H

#include "kiln_program.h"

struct watchdog;

/* Returns NULL when the system refuses memory or a thread. */
struct watchdog *watchdog_create(void);
void watchdog_destroy(struct watchdog **watchdog);

/* Sets a deadline for `what` ("fire.yaml: frame 12"), limit_s from now. When it passes, the program
 * reports that, removes half-written files and exits with KILN_DEVICE_FAILED. */
void watchdog_arm(struct watchdog *watchdog, double limit_s, const char *what, ...)
    __attribute__((format(printf, 3, 4)));
void watchdog_disarm(struct watchdog *watchdog);

#endif
