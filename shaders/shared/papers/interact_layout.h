/* Defines the storage block and the uniform locations that only kernels of shaders/sim/crowd/papers
 * have, beside those of shared/limits.h. */
#ifndef KILN_SHARED_PAPERS_INTERACT_LAYOUT_H
#define KILN_SHARED_PAPERS_INTERACT_LAYOUT_H

#include "shared/limits.h"

#define INTERACT_BIND_ORDER 7 /* order of the second grid */

#define INTERACT_AT_ENTRY_COUNT 1
#define INTERACT_AT_RUN         2
#define INTERACT_AT_DISTANCE    3

#endif
