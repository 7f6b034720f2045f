/* The exactness probe tests whether a driver computes the same bits as C and may therefore simulate
 * (docs/determinism.md, 1). The geometry and the fragment stage are probed only if
 * simulate=feedback or simulate=texels is to run on them. */
#ifndef KILN_GPU_PROBE_H
#define KILN_GPU_PROBE_H

#include "gpu/device.h"

/* Names the shader stages that can simulate. The geometry stage gets vectors as vertices and
 * returns results by transform feedback; the fragment stage gets and returns texels. */
enum kiln_probe_stage { KILN_PROBE_COMPUTE, KILN_PROBE_GEOMETRY, KILN_PROBE_FRAGMENT };

/* Runs the shared exact arithmetic in a stage with special and random test vectors and compares the
 * results with C bit for bit. Returns false with the first difference in `reason`, or with an empty
 * reason and an error if the probe could not run. */
bool kiln_probe_exact(struct kiln_device *device, enum kiln_probe_stage stage, char reason[256],
                      struct kiln_error *error);

/* Does the same as kiln_probe_exact with `count` vectors. kiln_probe_exact takes 4096, few enough
 * to run at every start. */
bool kiln_probe_vectors(struct kiln_device *device, enum kiln_probe_stage stage, uint32_t count,
                        char reason[256], struct kiln_error *error);

#endif
