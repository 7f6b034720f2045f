/* A kiln_between computes the particles at an instant within a step from the states before and
 * after the step (shaders/shared/between.h). */
#ifndef KILN_DRAW_MOMENT_BETWEEN_H
#define KILN_DRAW_MOMENT_BETWEEN_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/moment/moment.h"

struct kiln_between;

/* in_gl: records are computed in GL, where the simulation leaves them, instead of on the host; both
 * give the same bits. device may be NULL unless in_gl; the moment must have the device and outlive
 * the result; the threads are borrowed. Returns NULL with KILN_DEVICE_FAILED on failure. */
struct kiln_between *kiln_between_create(struct kiln_device *device,
                                         const struct kiln_moment *moment, bool in_gl,
                                         struct kiln_threads *threads, struct kiln_error *error);

/* Adds the memory of the particles within a step, on the host. */
void kiln_between_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_between_destroy(struct kiln_between **between);

/* Returns a pool with the particles at the instant, or NULL with an error. before, after: the
 * states at the start and at the end of step instant.step; they must differ by this step alone. The
 * result belongs to kiln_between and is valid until the next call. Its canvases, which are those
 * after the step, belong to `after`. */
struct kiln_pool *kiln_between_run(struct kiln_between *between, struct kiln_pool *before,
                                   struct kiln_pool *after, struct kiln_instant instant,
                                   struct kiln_error *error);

#endif
