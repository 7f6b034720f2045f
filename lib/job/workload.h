/* Estimates how the work of a clip's steps and frames varies over time, from the births and lives
 * of its particles, without running it. The unit is arbitrary: lib/job/plan.c measures some frames
 * and steps, and scales the rest by these numbers. */
#ifndef KILN_JOB_WORKLOAD_H
#define KILN_JOB_WORKLOAD_H

#include "scene/scene.h"

struct kiln_workload;

/* Returns NULL when memory is short. The scene must outlive the result. */
struct kiln_workload *kiln_workload_create(const struct kiln_scene *scene);
void kiln_workload_destroy(struct kiln_workload **workload);

/* Return the work of a frame, of one step to it from the frame before, and of the steps `from` + 1
 * to `to`. */
double kiln_workload_frame(const struct kiln_workload *workload, uint32_t frame);
double kiln_workload_steps(const struct kiln_workload *workload, uint32_t from, uint32_t to);

/* Return a frame with nearly the least, and with nearly the most work: the first such one. */
uint32_t kiln_workload_lightest(const struct kiln_workload *workload);
uint32_t kiln_workload_heaviest(const struct kiln_workload *workload);

#endif
