/* A kiln_run holds all state that a run changes, so that it can be saved and loaded whole. Only an
 * order that a spread sort keeps is elsewhere, in the sort stage: kiln_loop_kept_sort returns
 * it. */
#ifndef KILN_FRAME_RUN_H
#define KILN_FRAME_RUN_H

#include "particles/pool.h"

struct kiln_run {
    uint32_t step;         /* steps done */
    struct kiln_pool pool; /* the particles of every system */
};

#endif
