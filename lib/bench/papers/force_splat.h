/* Computes gravity by splatting forces (Drone 2007, 7.4.2 and 7.4.3.1), for tests and benchmarks
 * only. No state of a simulation depends on sums of the blending unit. */
#ifndef KILN_BENCH_PAPERS_FORCE_SPLAT_H
#define KILN_BENCH_PAPERS_FORCE_SPLAT_H

#include "gpu/framebuffer.h"
#include "shared/platform.h"

struct kiln_force_splat;

/* Creates a splat for up to `most` bodies, at least 1. It adds up in a texture of GL_RGBA32F or
 * GL_RGBA16F. Returns NULL with an error (KILN_DEVICE_FAILED). */
struct kiln_force_splat *kiln_force_splat_create(struct kiln_device *device, GLenum format,
                                                 uint32_t most, struct kiln_error *error);
void kiln_force_splat_destroy(struct kiln_force_splat **splat);

/* Adds up the accelerations of each body by all sources (gravity_source: m, m/s^2 at 1 m). *ms is
 * the time that this takes once the sources lie in GL. */
bool kiln_force_splat_run(struct kiln_force_splat *splat, const float4 *sources, uint32_t count,
                          float softening_square, double *ms, struct kiln_error *error);

/* Returns the accelerations of the last run, m/s^2, in the order of its sources; w is not used.
 * They belong to the splat until its next run. Returns NULL with an error. */
const float4 *kiln_force_splat_sums(struct kiln_force_splat *splat, struct kiln_error *error);

#endif
