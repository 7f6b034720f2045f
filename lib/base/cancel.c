/* Holds a caller's request to stop a job: one atomic flag that is only ever set, so any thread may
 * set it and any may read it. */
#include <stdatomic.h>
#include <stdlib.h>

#include "kiln.h"

struct kiln_cancel {
    atomic_bool requested;
};

struct kiln_cancel *kiln_cancel_create(void)
{
    return calloc(1, sizeof(struct kiln_cancel));
}

void kiln_cancel_destroy(struct kiln_cancel **cancel)
{
    if (!cancel)
        return;
    free(*cancel);
    *cancel = NULL;
}

void kiln_cancel_request(struct kiln_cancel *cancel)
{
    atomic_store(&cancel->requested, true);
}

bool kiln_cancel_is_requested(const struct kiln_cancel *cancel)
{
    return cancel && atomic_load(&cancel->requested);
}
