/* This header declares sums of light over blocks of living particles, by vectorised loops
 * (light_simd.c). */
#ifndef KILN_DRAW_LIGHT_LIGHT_BLOCKS_H
#define KILN_DRAW_LIGHT_LIGHT_BLOCKS_H

#include "draw/moment/appearance_blocks.h"

/* Holds kiln_appearance_glow at the samples of a look. */
struct kiln_glow {
    float red[KILN_LOOK_SAMPLES], green[KILN_LOOK_SAMPLES], blue[KILN_LOOK_SAMPLES];
    /* that of each particle of the block, where it depends on more than life; or NULL */
    const struct kiln_floats3 *own;
};

/* Holds sums over the particles of one light. */
struct kiln_light_sums {
    double color[3];    /* light sent, m^2 */
    double energy;      /* sum of the channels of color; the weight of the members below */
    double position[3]; /* m, times energy */
    double square;      /* of the distance from the world's origin, m^2, times energy */
    double radius;      /* of a particle, m, times energy */
};

struct kiln_light_loops {
    /* Adds the light of each particle to the two lights that its progress lies between. fill: the
     * part of a billboard's square that its cell fills with light. */
    void (*gather_fire)(const struct kiln_appearance_block *block, const struct kiln_glow *glow,
                        float fill, uint32_t light_count, struct kiln_light_sums *lights);
    /* Computes the extinction of each particle, summed over the volume of its ball, m^2. The middle
     * of the ball hides `cover` times the particle's opacity; `shadow` scales its optical depth. */
    void (*find_extinction)(const struct kiln_appearance_block *block, float cover, float shadow,
                            float extinction[KILN_LANES]);
};
KILN_SIMD_DECLARE(const struct kiln_light_loops, kiln_light_loops);

#endif
