/* Reads --shard, which gives the number of this task among several tasks that share a clip. */
#ifndef KILN_CMD_SHARD_H
#define KILN_CMD_SHARD_H

#include "options.h"

#define SHARD_OPTION                                                                               \
    {                                                                                              \
        .name = "shard", .kind = OPTION_TEXT, .placeholder = "I/N|auto|auto/N",                    \
        .help = "Draw only the I-th of N shares of a clip's parts, and go on with files of it "    \
                "that are there. A part has two seconds. 'kiln join' makes the clip of all "       \
                "parts. auto takes I and N from the variables of a scheduler, such as "            \
                "SLURM_ARRAY_TASK_ID or SGE_TASK_ID. auto/N takes I alone from them, also from "   \
                "JOB_COMPLETION_INDEX or AWS_BATCH_JOB_ARRAY_INDEX."                               \
    }

struct shard {
    uint32_t index, count; /* index counts from 0; count 0: --shard is not used */
    const char *variable;  /* variable that gave the index; NULL: none did */
};

/* Reads --shard. Returns 0, or the exit code after reporting what is wrong. */
int shard_read(struct shard *shard, const struct arguments *arguments);

#endif
