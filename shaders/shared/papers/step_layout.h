/* Defines the sizes, binding points and uniform locations that only kernels of
 * shaders/sim/step/papers have, beside those of shared/limits.h. */
#ifndef KILN_SHARED_PAPERS_STEP_LAYOUT_H
#define KILN_SHARED_PAPERS_STEP_LAYOUT_H

#include "shared/limits.h"

/* The storage block of records of techniques with two buffers. */
#define SIM_BIND_SECOND 3

/* The location of the number of slots in the kernel that copies textures. */
#define SIM_AT_SLOTS 4

/* Births that one emitter makes, of 8 words each; every geometry shader may write 1024 words. On
 * software GL it is one: other invocations step one slot, and there the loops of an emitter
 * together have a limit (gpu/device.h). */
#ifndef SIM_EMITTER_BIRTHS
#define SIM_EMITTER_BIRTHS 32
#endif

/* Slots in a row of the textures of technique `texels`. */
#define SIM_TEXEL_ROW 2048

#endif
