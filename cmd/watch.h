/* Runs a thread that calls a function at regular times, to check limits beside the thread that
 * works. */
#ifndef KILN_CMD_WATCH_H
#define KILN_CMD_WATCH_H

struct watch;

/* Starts a thread that calls `look` every `every_ms` ms and has all signals blocked. Returns NULL
 * when the system refuses memory or a thread. */
struct watch *watch_create(void (*look)(void *user), void *user, int every_ms);

/* Ends the thread and waits for it; does nothing for NULL. */
void watch_destroy(struct watch **watch);

/* Returns the time of a monotonic clock in seconds, from an arbitrary start. */
double now_s(void);

#endif
