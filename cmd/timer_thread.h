/* Runs a thread that calls a function at regular times, to check limits beside the thread that
 * works. */
#ifndef KILN_CMD_TIMER_THREAD_H
#define KILN_CMD_TIMER_THREAD_H

struct timer_thread;

/* Starts a thread that calls `callback` every `every_ms` ms and has all signals blocked. Returns
 * NULL when the system refuses memory or a thread. */
struct timer_thread *timer_thread_create(void (*callback)(void *user), void *user, int every_ms);

/* Ends the thread and waits for it; does nothing for NULL. */
void timer_thread_destroy(struct timer_thread **timer);

/* Returns the time of a monotonic clock in seconds, from an arbitrary start. */
double now_s(void);

#endif
