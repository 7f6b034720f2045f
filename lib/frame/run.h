/* A kiln_run holds all state that a run changes, so that it can be saved and loaded as a whole. The
 * only exception is the history that a stage may keep, which kiln_loop_history returns. */
#ifndef KILN_FRAME_RUN_H
#define KILN_FRAME_RUN_H

#include "particles/pool.h"

struct kiln_run {
    uint32_t step;         /* number of simulated steps */
    struct kiln_pool pool; /* the particles of every system */
};

#endif
