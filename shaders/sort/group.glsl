/* Sums the values of earlier invocations in work groups of SORT_GROUP_SIZE
 * (shared/group_sum.glsl). */
#ifndef KILN_SORT_GROUP_GLSL
#define KILN_SORT_GROUP_GLSL

#include "shared/sort_layout.h"
#include "sort/index.glsl"

#define GROUP_SIZE SORT_GROUP_SIZE
#include "shared/group_sum.glsl"

#endif
