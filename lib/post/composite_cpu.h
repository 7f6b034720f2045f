/* Technique `cpu` runs stage `composite` in threads over rows, in arithmetic that is the same on
 * every machine. Its functions are those of post/composite.h. */
#ifndef KILN_POST_COMPOSITE_CPU_H
#define KILN_POST_COMPOSITE_CPU_H

#include "post/composite.h"

struct kiln_composite_cpu;

struct kiln_composite_cpu *kiln_composite_cpu_create(const struct kiln_scene *scene,
                                                     const struct kiln_composite_params *params,
                                                     struct kiln_error *error);
void kiln_composite_cpu_destroy(struct kiln_composite_cpu **stage);

bool kiln_composite_cpu_run(struct kiln_composite_cpu *stage,
                            const struct kiln_composite_inputs *inputs, struct kiln_error *error);
bool kiln_composite_cpu_read_display(const struct kiln_composite_cpu *stage, void *pixels,
                                     struct kiln_error *error);
void kiln_composite_cpu_exchange_beauty(struct kiln_composite_cpu *stage, float **pixels);

#endif
