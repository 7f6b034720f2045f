/* Defines the uniform locations of the kernels that only benchmarks run, for C and GLSL. */
#ifndef KILN_SHARED_PAPERS_BENCH_LAYOUT_H
#define KILN_SHARED_PAPERS_BENCH_LAYOUT_H

#include "shared/sort_layout.h"

/* Locations of the passes over a field (shaders/bench/papers/bitonic_field.comp), which also use
 * SORT_AT_COUNT and SORT_AT_DISTANCE. */
#define FIELD_AT_PASS       1
#define FIELD_AT_SORTED     2
#define FIELD_AT_WIDTH      3
#define FIELD_AT_FIRST_WORD 4

/* Locations of the splats of forces (shaders/bench/papers/force_splat.frag). */
#define SPLAT_AT_ROW       0
#define SPLAT_AT_SOFTENING 1

#endif
