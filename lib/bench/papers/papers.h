/* Declares the suites that repeat measurements of the papers, and the ways to compute that only
 * they measure. Published values stand beside the measured ones. */
#ifndef KILN_BENCH_PAPERS_H
#define KILN_BENCH_PAPERS_H

#include "bench/gravity_row.h"
#include "bench/suite.h"

/* The thesis: Heinz 2019. */
bool kiln_suite_figure_4_4(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_figure_4_5(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_figure_4_6(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_sizes(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_bytes(const struct kiln_bench_run *run, struct kiln_error *error);

/* UberFlow 2004. */
bool kiln_suite_table_1(const struct kiln_bench_run *run, struct kiln_error *error);
bool kiln_suite_table_2(const struct kiln_bench_run *run, struct kiln_error *error);

#define KILN_UBERFLOW_SOURCE "UberFlow 2004, ATI 9800 Pro"

/* Drone 2007: forces that are splatted into a texture of 32-bit or of 16-bit floats
 * (force_splat.h). */
extern const struct kiln_gravity_row kiln_gravity_splats_32_row, kiln_gravity_splats_16_row;

#endif
