/* Checks the scene and the device of a job. Each function of kiln.h that draws or simulates takes
 * hold of both first. */
#ifndef KILN_JOB_HOLD_H
#define KILN_JOB_HOLD_H

#include "gpu/device.h"

/* Takes hold of a device and a scene for a job of this thread. Returns false with KILN_USAGE for
 * NULL, for a device of another thread and, in debug builds, for what was destroyed or is something
 * else (base/handle.h); then there is no hold to release. */
bool kiln_hold_take(const struct kiln_device *device, const struct kiln_scene *scene,
                    struct kiln_error *error);

/* Returns false with KILN_USAGE if the caller has destroyed one of them since. Only debug builds
 * know that. */
bool kiln_hold_check(const struct kiln_device *device, const struct kiln_scene *scene,
                     struct kiln_error *error);

void kiln_hold_release(const struct kiln_device *device, const struct kiln_scene *scene);

#endif
