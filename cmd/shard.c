/* Reads --shard: the number of this task, from the option or from the variables in which a
 * scheduler numbers the tasks of an array. */
#include "shard.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"

enum { MAX_SHARDS = 1000000 };

/* The names of a scheduler's variables; NULL where it has none of that kind. */
struct scheduler {
    const char *id, *first, *step, *count, *last;
};

static const struct scheduler schedulers[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP",
     "SLURM_ARRAY_TASK_COUNT", NULL},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_STEPSIZE", NULL, "SGE_TASK_LAST"},
    {"JOB_COMPLETION_INDEX", NULL, NULL, NULL, NULL},
    {"AWS_BATCH_JOB_ARRAY_INDEX", NULL, NULL, NULL, NULL},
};
enum { SCHEDULER_COUNT = sizeof schedulers / sizeof *schedulers };

/* Reads a variable of the environment as a number; *is_there is false if it is not set. Returns 0,
 * or the exit code after reporting. */
static int read_variable(const char *name, uint64_t *value, bool *is_there)
{
    const char *text = name ? kiln_environment(name) : NULL;
    *is_there = text != NULL;
    if (!*is_there || kiln_text_to_uint64(text, value))
        return 0;
    return report(KILN_USAGE, "render: --shard: %s: found '%s', expected a whole number", name,
                  text);
}

/* Returns whether this is a task of the scheduler. Grid Engine sets "undefined" outside of an
 * array. */
static bool is_scheduler_active(const struct scheduler *scheduler)
{
    const char *id = kiln_environment(scheduler->id);
    return id && strcmp(id, "undefined") != 0;
}

/* Reads the number of the task, from 0, and the number of tasks, which is 0 if the scheduler does
 * not give it. Returns 0, or the exit code after reporting. */
static int read_task_number(const struct scheduler *scheduler, uint64_t *index, uint64_t *count)
{
    uint64_t id = 0, first = 0, step = 1, last = 0;
    bool has_id, has_first, has_step, has_last, has_count;
    *count = 0;
    int code = read_variable(scheduler->id, &id, &has_id);
    code = code ? code : read_variable(scheduler->first, &first, &has_first);
    code = code ? code : read_variable(scheduler->step, &step, &has_step);
    code = code ? code : read_variable(scheduler->last, &last, &has_last);
    code = code ? code : read_variable(scheduler->count, count, &has_count);
    if (code)
        return code;
    if (step == 0 || id < first || (id - first) % step != 0)
        return report(KILN_USAGE,
                      "render: --shard: %s is %" PRIu64 "; expected %" PRIu64
                      ", or a number that is a multiple of %" PRIu64 " above it",
                      scheduler->id, id, first, step);
    *index = (id - first) / step;
    if (has_last && last >= first)
        *count = (last - first) / step + 1;
    return 0;
}

/* Finds the shard of a scheduler's task. `total` is N of auto/N; with 0, for auto, the scheduler
 * must give the number of tasks. Returns 0, or the exit code after reporting. */
static int read_environment(struct shard *shard, uint64_t total)
{
    size_t i = 0;
    while (i < SCHEDULER_COUNT && !is_scheduler_active(&schedulers[i]))
        i++;
    if (i == SCHEDULER_COUNT)
        return report(KILN_USAGE, "render: --shard: auto: no scheduler says which task this is; "
                                  "looked for SLURM_ARRAY_TASK_ID, SGE_TASK_ID, "
                                  "JOB_COMPLETION_INDEX and AWS_BATCH_JOB_ARRAY_INDEX");
    uint64_t index = 0, count = 0;
    const int code = read_task_number(&schedulers[i], &index, &count);
    if (code)
        return code;
    if (total > 0 && count > 0 && count != total)
        return report(KILN_USAGE,
                      "render: --shard: auto/%" PRIu64 ": %s is one of %" PRIu64
                      " tasks; a repeated task must give its shard by number, such as 3/%" PRIu64,
                      total, schedulers[i].id, count, total);
    count = total ? total : count;
    if (count == 0)
        return report(KILN_USAGE,
                      "render: --shard: auto: %s gives the number of this task, but not the number "
                      "of tasks; give it by auto/N",
                      schedulers[i].id);
    if (index >= count || count > MAX_SHARDS)
        return report(KILN_USAGE,
                      "render: --shard: %s says that this is task %" PRIu64
                      ", but there are %" PRIu64 " tasks (at most %d are allowed)",
                      schedulers[i].id, index + 1, count, MAX_SHARDS);
    *shard = (struct shard){(uint32_t)index, (uint32_t)count, schedulers[i].id};
    return 0;
}

static int refuse(const char *text)
{
    return report(
        KILN_USAGE,
        "render: --shard: found '%s', expected I/N, such as 1/4, with I from 1 to N and N "
        "up to %d; or auto, or auto/N",
        text, MAX_SHARDS);
}

int shard_read(struct shard *shard, const struct arguments *arguments)
{
    const char *text = arguments_text(arguments, "shard", NULL);
    *shard = (struct shard){.count = 0};
    if (!text)
        return 0;
    if (strcmp(text, "auto") == 0)
        return read_environment(shard, 0);
    const char *slash = strchr(text, '/');
    uint64_t index = 0, count = 0;
    if (!slash || !kiln_text_to_uint64(slash + 1, &count) || count < 1 || count > MAX_SHARDS)
        return refuse(text);
    if (strncmp(text, "auto/", 5) == 0)
        return read_environment(shard, count);
    char digits[16] = "";
    const size_t length = (size_t)(slash - text);
    if (length < sizeof digits)
        memcpy(digits, text, length);
    if (!kiln_text_to_uint64(digits, &index) || index < 1 || index > count)
        return refuse(text);
    *shard = (struct shard){(uint32_t)index - 1, (uint32_t)count, NULL};
    return 0;
}
