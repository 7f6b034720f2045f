/* Handles SIGINT, SIGTERM and SIGHUP: the first asks the job to stop, the second ends the program
 * at once. SIGABRT ends it with a message. */
#ifndef KILN_CMD_SIGNALS_H
#define KILN_CMD_SIGNALS_H

#include <stdbool.h>

/* Makes SIGABRT remove half-written files and end the program with a message and the exit code
 * KILN_DEVICE_FAILED. FFmpeg and LLVM call abort() where some of their allocations fail. */
void signals_install_abort(void);

/* Installs the handlers of the other signals. */
void signals_install(void);

/* Installs the handlers for a job whose half-written files can be removed at any time. If it has
 * not stopped half a second after the first signal, the program ends with a message. */
void signals_install_for_job(void);

/* Makes the first signal end the program at once: half-written files are removed, and no file is
 * finished. */
void signals_install_immediate(void);

/* Returns the number of the signal that asked to stop, or 0. */
int signals_received(void);

/* Returns whether a signal asked to stop, or writing events has failed. It is the `stop` callback
 * of the library's functions. */
bool signals_wants_stop(void *user);

/* Reports "WHAT: stopped by SIGTERM" and the formatted text (" after 3 frames"), and returns the
 * exit code for the signal. Without a signal, the reader of events went away: returns
 * KILN_READER_GONE, which main reports. */
int signals_report(const char *what, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
