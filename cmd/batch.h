/* kiln render --batch: many jobs, each in a process of its own. */
#ifndef KILN_CMD_BATCH_H
#define KILN_CMD_BATCH_H

#include "options.h"

#define BATCH_OPTION                                                                               \
    {                                                                                              \
        .name = "batch", .kind = OPTION_TEXT, .placeholder = "JOBS", .reach = REACH_READ,          \
        .help = "Render the jobs of a file, each in a process of its own, instead of scenes; '-' " \
                "is standard input (see 'kiln help jobs'). Other options hold for every job, "     \
                "unless it says something else.",                                                  \
    }
#define JOBS_OPTION                                                                                \
    {                                                                                              \
        .name = "jobs", .kind = OPTION_INTEGER, .placeholder = "N",                                \
        .help = "Jobs of --batch at a time.",                                                      \
        .fallback = "as many as there are cores for the threads of each", .min = 1, .max = 1024    \
    }

/* Renders the jobs of --batch. Returns the greatest exit code. */
int batch_run(const struct arguments *arguments);

#endif
