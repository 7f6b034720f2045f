/* Declares the loop that sums up, on the host, what a bird of a flock sees of its neighbours. */
#ifndef KILN_SIM_CROWD_FLOCK_H
#define KILN_SIM_CROWD_FLOCK_H

#include "base/simd.h"
#include "shared/interact_flock.h"

enum {
    KILN_FLOCK_ROWS = 6, /* floats of each body */
    KILN_FLOCK_ROOM = 64 /* bytes that may be read behind them */
};

/* What a flock looks at. */
struct kiln_flock_birds {
    struct kiln_crowd view;
    const float *rows[KILN_FLOCK_ROWS]; /* of the bodies in their order: x, y, z, then velocities */
};

/* flock_look, for the body `self`. */
typedef struct flock_sums kiln_flock_look(const struct kiln_flock_birds *birds, uint32_t self);

struct kiln_flock_loops {
    kiln_flock_look *look;
};
KILN_SIMD_DECLARE(const struct kiln_flock_loops, kiln_flock_loops);

#endif
