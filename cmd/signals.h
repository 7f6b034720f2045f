/* SIGINT, SIGTERM and SIGHUP: the first asks the job to stop, the second ends the program at once.
 */
#ifndef KILN_CMD_SIGNALS_H
#define KILN_CMD_SIGNALS_H

#include <stdbool.h>

void signals_install(void);

/* The same for jobs that leave nothing half-written: one that has not stopped by itself half a
 * second after the first signal is ended as by a second one, with a message. */
void signals_install_for_job(void);

/* From now on already the first ends the program at once: nothing half-written is left, but nothing
 * is finished either. */
void signals_end_at_once(void);

/* The signal that asked to stop, or 0. */
int signals_received(void);

/* Whether one did, or nobody takes the events any more: the `stop` of the library's functions. */
bool signals_wants_stop(void *user);

/* Prints "WHAT: stopped by SIGTERM" and what the format makes (" after 3 frames"); returns the exit
 * code for it. Without a signal the reader of events went away: KILN_READER_GONE, of which main
 * tells. */
int signals_report(const char *what, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
