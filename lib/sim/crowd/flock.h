/* Declares the vectorised loop that sums up, on the host, the neighbours that a particle of a flock
 * sees. */
#ifndef KILN_SIM_CROWD_FLOCK_H
#define KILN_SIM_CROWD_FLOCK_H

#include "base/simd.h"
#include "shared/interact_flock.h"

enum {
    KILN_FLOCK_ROWS = 6, /* floats of each body: place and velocity */
    KILN_FLOCK_ROOM = 64 /* bytes behind the rows that may be read */
};

/* The bodies of a flock, as the loop reads them. */
struct kiln_flock_birds {
    struct kiln_crowd view;
    /* a row for each of x, y, z and the velocity's components, in the order of the bodies */
    const float *rows[KILN_FLOCK_ROWS];
};

/* Computes flock_look for the body `self`. */
typedef struct flock_sums kiln_flock_look(const struct kiln_flock_birds *birds, uint32_t self);

struct kiln_flock_loops {
    kiln_flock_look *look;
};
KILN_SIMD_DECLARE(const struct kiln_flock_loops, kiln_flock_loops);

#endif
