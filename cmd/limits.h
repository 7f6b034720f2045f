/* Reads and watches the limits of a job, from --limits, --timeout and the environment. */
#ifndef KILN_CMD_LIMITS_H
#define KILN_CMD_LIMITS_H

#include "options.h"

#define LIMITS_OPTION                                                                              \
    {                                                                                              \
        .name = "limits", .kind = OPTION_TEXT, .placeholder = "KEY=VALUE,...",                     \
        .help = "End with exit code 8 before more is taken; 'service' stands for a set of them "   \
                "(see 'kiln help limits').",                                                       \
        .fallback = "the environment's KILN_LIMITS"                                                \
    }
#define TIMEOUT_OPTION                                                                             \
    {                                                                                              \
        .name = "timeout", .kind = OPTION_TIME, .placeholder = "TIME",                             \
        .help = "End with exit code 8 after that time, loading and encoding included: seconds, "   \
                "or with a unit, ms, s, min or h.",                                                \
        .fallback = "none", .min = 0.001, .max = 1e7                                               \
    }

/* Limits that are watched over; they must not move. */
struct limits {
    struct kiln_budget *budget; /* NULL: there are none */
    struct watch *watch;
    int over_ms; /* that the watch has found too much taken */
};

/* Reads them, for the command of a name; time counts from here. A job that has not ended by itself
 * half a second after a limit of time or memory is ended with a message. Returns 0 or, after
 * reporting, an exit code. limits_end frees, also after a failure. */
int limits_begin(struct limits *limits, const char *command, const struct arguments *arguments);
void limits_end(struct limits *limits);

#endif
