/* SIGINT, SIGTERM and SIGHUP: the first asks the job to stop, the second ends the program at once.
 */
#ifndef KILN_CMD_SIGNALS_H
#define KILN_CMD_SIGNALS_H

void signals_install(void);

/* The signal that asked to stop, or 0. */
int signals_received(void);

#endif
