/* Runs a thread that looks at something at regular times beside the thread that works. */
#ifndef KILN_CMD_WATCH_H
#define KILN_CMD_WATCH_H

struct watch;

/* Calls `look` every so many ms, from a thread that gets no signals. NULL when the system refuses
 * memory or a thread. */
struct watch *watch_create(void (*look)(void *user), void *user, int every_ms);

/* Waits for the last look; does nothing for NULL. */
void watch_destroy(struct watch **watch);

/* Seconds of a clock that never jumps, from an arbitrary start. */
double now_s(void);

#endif
