/* Decides whether a job goes on: its caller may have cancelled it, or a limit may be reached. Every
 * kind of job asks here. */
#include "job/stop.h"

#include "base/error.h"

bool kiln_stop_ask(const struct kiln_stop *stop, struct kiln_error *error)
{
    const bool ends =
        kiln_cancel_is_requested(stop->cancel) || (stop->stop && stop->stop(stop->user));
    if (stop->stop && stop->device && !kiln_device_make_current(stop->device, error))
        return false;
    return ends ? kiln_error_set(error, KILN_INTERRUPTED, "stopped")
                : kiln_budget_is_kept(stop->budget, error);
}

static bool ask(void *user, struct kiln_error *error)
{
    return kiln_stop_ask(user, error);
}

struct kiln_caller kiln_stop_caller(struct kiln_stop *stop)
{
    return (struct kiln_caller){ask, stop};
}
