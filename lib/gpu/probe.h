/* The exactness probe tells whether a driver computes as C does and may therefore simulate
 * (docs/determinism.md, 1). The geometry and the fragment stage are probed only when
 * simulate=feedback or texels is to run on them. */
#ifndef KILN_GPU_PROBE_H
#define KILN_GPU_PROBE_H

#include "gpu/device.h"

/* Names the shader stages that can simulate. For the geometry stage, vectors arrive as vertices and
 * results leave by transform feedback; for the fragment stage both are texels. */
enum kiln_probe_stage { KILN_PROBE_COMPUTE, KILN_PROBE_GEOMETRY, KILN_PROBE_FRAGMENT };

/* Runs edge and random vectors through the shared exact arithmetic in a stage and compares with C,
 * bit for bit. If it returns false, `reason` says which function differed first and how; it stays
 * empty when the probe could not run, and error is set. */
bool kiln_probe_exact(struct kiln_device *device, enum kiln_probe_stage stage, char reason[256],
                      struct kiln_error *error);

/* Does the same as kiln_probe_exact with `count` vectors; kiln_probe_exact takes few enough to run
 * at every start. */
bool kiln_probe_vectors(struct kiln_device *device, enum kiln_probe_stage stage, uint32_t count,
                        char reason[256], struct kiln_error *error);

#endif
