/* Reads and watches the limits of a job, from --limits, --timeout and the environment. */
#ifndef KILN_CMD_LIMITS_H
#define KILN_CMD_LIMITS_H

#include "options.h"

#define LIMITS_OPTION                                                                              \
    {                                                                                              \
        .name = "limits", .kind = OPTION_TEXT, .placeholder = "KEY=VALUE,...",                     \
        .help = "End with exit code 8 before the job takes more than these limits. 'service' "     \
                "stands for a preset (see 'kiln help limits').",                                   \
        .fallback = "the environment's KILN_LIMITS"                                                \
    }
#define TIMEOUT_OPTION                                                                             \
    {                                                                                              \
        .name = "timeout", .kind = OPTION_TIME, .placeholder = "TIME",                             \
        .help = "End the command with exit code 8 after that time, loading and encoding "          \
                "included. The time is in seconds, or has a unit: ms, s, min or h.",               \
        .fallback = "none", .min = 0.001, .max = 1e7                                               \
    }

/* The limits of a job. The struct must not move while a thread watches it. */
struct limits {
    struct kiln_budget *budget; /* NULL: there are none */
    struct timer_thread *timer;
    int exceeded_ms; /* how long the job has been over a limit */
};

/* Reads the limits and starts to watch them; time counts from here. `command` starts the messages.
 * A job that has not ended by itself half a second after it exceeded its time or memory is ended
 * with a message. Returns 0, or the exit code after reporting. The caller calls limits_end in both
 * cases. */
int limits_begin(struct limits *limits, const char *command, const struct arguments *arguments);
void limits_end(struct limits *limits);

#endif
