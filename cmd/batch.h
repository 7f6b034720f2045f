/* Declares kiln render --batch, which runs many jobs, each in a process of its own. */
#ifndef KILN_CMD_BATCH_H
#define KILN_CMD_BATCH_H

#include "options.h"

#define BATCH_OPTION                                                                               \
    {                                                                                              \
        .name = "batch", .kind = OPTION_TEXT, .placeholder = "JOBS", .access = ACCESS_READ,        \
        .help = "Render the jobs of a file, each in a process of its own, instead of scenes; '-' " \
                "is standard input (see 'kiln help jobs'). Other options hold for every job that " \
                "does not set them itself.",                                                       \
    }
#define JOBS_OPTION                                                                                \
    {                                                                                              \
        .name = "jobs", .kind = OPTION_INTEGER, .placeholder = "N",                                \
        .help = "Number of jobs of --batch that run at a time.",                                   \
        .fallback = "the number of cores divided by the threads of a job", .min = 1, .max = 1024   \
    }

/* Runs the jobs of the file that --batch names. Returns the greatest of their exit codes or, after
 * reporting, the code of a failure of the batch itself. */
int batch_run(const struct arguments *arguments);

#endif
