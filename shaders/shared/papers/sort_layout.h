/* Defines the uniform locations that only kernels of shaders/sort/papers have, beside those of
 * shared/sort_layout.h. */
#ifndef KILN_SHARED_PAPERS_SORT_LAYOUT_H
#define KILN_SHARED_PAPERS_SORT_LAYOUT_H

#include "shared/sort_layout.h"

#define SORT_AT_STAGE        7
#define SORT_AT_FIRST_PASS   8
#define SORT_AT_END_PASS     9
#define SORT_AT_CHOSEN       16
#define SORT_AT_SYSTEM_COUNT 19
#define SORT_AT_SYSTEMS      20 /* an array, which takes KILN_MAX_SYSTEMS locations from here on */

#endif
