/* Counters of what a job takes, for every room. Which limits there are is in kiln_limits.h; how
 * they are read, and what they are for, in lib/job. */
#ifndef KILN_BASE_BUDGET_H
#define KILN_BASE_BUDGET_H

#include "kiln.h"

/* Counts an amount. False with KILN_OVER_LIMIT when all that was counted is more than the limit;
 * `what` says whose it is: "fire.png". A NULL budget has no limits. */
bool kiln_budget_take(struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                      const char *what, struct kiln_error *error);

/* What is left of a limit; UINT64_MAX where there is none. */
uint64_t kiln_budget_left(struct kiln_budget *budget, enum kiln_limit limit);

/* Whether an amount that is no sum, such as the pixels of a frame, is within a limit; if not, text
 * gets "16777217 pixels of a frame, and the limit `pixels` is 16777216". */
bool kiln_budget_allows(const struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                        char text[160]);

/* Begins to count again at 0, for what is limited a scene. Does nothing for
 * NULL. */
void kiln_budget_reset(struct kiln_budget *budget, enum kiln_limit limit);

/* An amount in its unit: "4 GiB", "1500 ms". */
void kiln_limit_format(enum kiln_limit limit, uint64_t amount, char text[32]);

/* "memory". */
const char *kiln_limit_name(enum kiln_limit limit);

#endif
