/* Declares the passes between cells of gas and the faces between them. */
#ifndef KILN_SIM_GAS_FACES_H
#define KILN_SIM_GAS_FACES_H

#include "sim/gas/multigrid.h"
#include "sim/gas/pass.h"

struct gas_faces {
    /* Adds to the faces below the cells of a brick the mean change of the velocity on both sides.
     * Faces on solids get the velocity of the solid. */
    void (*push)(const struct gas_pass *pass, const struct gas_level *level, gas_brick_place at);
    /* Fills f, which has the expansion of the cells of active bricks in the order of the faces,
     * with the right side of the pressure's equation, in m^2/s, for planes [begin, end). */
    void (*diverge)(const struct gas_pass *pass, const struct gas_level *level, int32_t begin,
                    int32_t end);
    /* Takes the pressure's gradient off the faces of planes [begin, end). Returns the largest
     * velocity across them along any axis, m/s, or NaN if a velocity is. */
    float (*project)(const struct gas_pass *pass, const struct gas_level *level, int32_t begin,
                     int32_t end);
};
KILN_SIMD_DECLARE(const struct gas_faces, kiln_gas_faces);

#endif
