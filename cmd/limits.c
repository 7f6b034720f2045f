/* Reads the limits of a job, and watches time and memory from a thread, since the code that loads
 * or encodes a picture does not check the limits. */
#include "limits.h"

#include <math.h>
#include <stdlib.h>

#include "exit_message.h"
#include "report.h"
#include "scene_in.h"
#include "timer_thread.h"

enum { CHECK_INTERVAL_MS = 50, GRACE_MS = 500 };

/* Ends the program when a limit is exceeded, after it has given the job time to end by itself. */
static void check_budget(void *user)
{
    struct limits *limits = user;
    struct kiln_error error = {0};
    if (kiln_budget_is_kept(limits->budget, &error))
        return;
    limits->exceeded_ms += CHECK_INTERVAL_MS;
    if (limits->exceeded_ms < GRACE_MS)
        return;
    char scene[KILN_MESSAGE_SIZE] = "", line[2 * KILN_MESSAGE_SIZE + 64];
    const bool loads = scene_in_describe(scene);
    snprintf(line, sizeof line, "kiln: %s%s%s; unfinished files are discarded\n", scene,
             loads ? ": " : "", error.message);
    exit_with_message(line, KILN_OVER_LIMIT);
}

/* ---- reading --------------------------------------------------------------------------------- */

static int read_limits(struct kiln_limits *limits, const char *command,
                       const struct arguments *arguments)
{
    const char *environment = kiln_environment("KILN_LIMITS");
    const char *text = arguments_text(arguments, "limits", NULL);
    const double timeout_s = arguments_number(arguments, "timeout", 0);
    struct kiln_error error = {0};
    if (environment && *environment && !kiln_limits_parse(limits, environment, &error))
        return report(error.code, "KILN_LIMITS: %s", error.message);
    if (text && !kiln_limits_parse(limits, text, &error))
        return report(error.code, "%s: --limits: %s", command, error.message);
    if (timeout_s > 0)
        limits->most[KILN_LIMIT_time] = (uint64_t)ceil(timeout_s * 1e3);
    return 0;
}

int limits_begin(struct limits *limits, const char *command, const struct arguments *arguments)
{
    struct kiln_limits read = kiln_limits_empty();
    *limits = (struct limits){.budget = NULL};
    const int code = read_limits(&read, command, arguments);
    bool any = false;
    for (size_t i = 0; i < KILN_LIMIT_COUNT; i++)
        any = any || read.most[i] > 0;
    if (code || !any)
        return code;
    limits->budget = kiln_budget_create(&read);
    if (!limits->budget)
        return report_no_memory();
    if (read.most[KILN_LIMIT_time] + read.most[KILN_LIMIT_cpu] + read.most[KILN_LIMIT_memory] == 0)
        return 0;
    limits->timer = timer_thread_create(check_budget, limits, CHECK_INTERVAL_MS);
    return limits->timer ? 0 : report(KILN_DEVICE_FAILED, "cannot start a thread for limits");
}

void limits_end(struct limits *limits)
{
    timer_thread_destroy(&limits->timer);
    kiln_budget_destroy(&limits->budget);
}
