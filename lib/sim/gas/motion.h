/* Says how the frame of a domain of gas moves, which its node moves and turns. */
#ifndef KILN_SIM_GAS_MOTION_H
#define KILN_SIM_GAS_MOTION_H

#include "sim/gas/frames.h"

/* Says how a domain moves with its node, m/s and rad/s in its own axes and metres. */
struct gas_motion {
    double velocity[3], spin[3];
};

/* Returns how a domain moves whose frame is this one. */
static inline struct gas_motion gas_motion_of(const struct kiln_node_frame *frame)
{
    struct gas_motion motion;
    double axis[3][3];
    gas_axes(frame, axis);
    for (int i = 0; i < 3; i++) {
        motion.velocity[i] = motion.spin[i] = 0.0;
        for (int c = 0; c < 3; c++) {
            motion.velocity[i] += axis[i][c] * frame->velocity[c] / frame->scale;
            motion.spin[i] += axis[i][c] * frame->spin[c];
        }
    }
    return motion;
}

static inline void gas_cross(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
