/* Counts what a job takes, for every room. kiln_limits.h lists the limits; lib/job/limits.c reads
 * and documents them. */
#ifndef KILN_BASE_BUDGET_H
#define KILN_BASE_BUDGET_H

#include "kiln.h"

/* Counts an amount. False with KILN_OVER_LIMIT when the sum of all amounts exceeds the limit;
 * `what` names the amount in the message: "fire.png". A NULL budget has no limits. */
bool kiln_budget_take(struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                      const char *what, struct kiln_error *error);

/* Adds to the processor time of processes that the job has started and that run, in microseconds;
 * less than 0 takes away. The system tells the time of such a process only when it has ended, so
 * whoever waits for one adds its time from now and then, and takes all of it away when it ends.
 * Does nothing for NULL. */
void kiln_budget_add_running(struct kiln_budget *budget, int64_t microseconds);

/* Returns what is left of a limit; UINT64_MAX where there is none. */
uint64_t kiln_budget_left(struct kiln_budget *budget, enum kiln_limit limit);

/* Returns whether an amount that is not summed, such as the pixels of a frame, is within a limit.
 * If not, text becomes "16777217 pixels of a frame, and the limit `pixels` is 16777216". */
bool kiln_budget_allows(const struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                        char text[160]);

/* Sets the count of a limit to 0, for limits that each scene has for itself. Does nothing for
 * NULL. */
void kiln_budget_reset(struct kiln_budget *budget, enum kiln_limit limit);

/* Writes an amount in its unit: "4 GiB", "1.5 s" (for 1500 ms). */
void kiln_limit_format(enum kiln_limit limit, uint64_t amount, char text[32]);

/* Returns a limit's name: "memory". */
const char *kiln_limit_name(enum kiln_limit limit);

#endif
