/* All state that a run changes, in one struct, so that it can be saved and loaded whole. (Only an
 * order that a spread sort keeps is elsewhere, in its stage: kiln_loop_kept_sort.) */
#ifndef KILN_FRAME_RUN_H
#define KILN_FRAME_RUN_H

#include "particles/pool.h"

struct kiln_run {
    uint32_t step;         /* steps done */
    struct kiln_pool pool; /* the particles of every system */
};

#endif
