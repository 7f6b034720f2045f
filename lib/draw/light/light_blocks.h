/* This header declares sums of light and shade over blocks of living particles, by vectorised loops
 * (light_simd.c). */
#ifndef KILN_DRAW_LIGHT_LIGHT_BLOCKS_H
#define KILN_DRAW_LIGHT_LIGHT_BLOCKS_H

#include "draw/light/sun_box.h"
#include "draw/moment/living_blocks.h"

/* Holds kiln_living_glow at the samples of a look. */
struct kiln_glow {
    float red[KILN_LOOK_SAMPLES], green[KILN_LOOK_SAMPLES], blue[KILN_LOOK_SAMPLES];
};

/* Holds sums over the particles of one light. */
struct kiln_gathering {
    double color[3];    /* light sent, m^2 */
    double energy;      /* of all channels: the weight of what follows */
    double position[3]; /* m */
    double square;      /* of the distance from the origin, m^2 */
    double radius;      /* of a particle, m */
};

struct kiln_light_loops {
    /* Adds the light of each particle to the two lights that its progress lies between; fill is the
     * part of a cell that is filled. */
    void (*gather_fire)(const struct kiln_living_block *block, const struct kiln_glow *glow,
                        float fill, uint32_t light_count, struct kiln_gathering *lights);
    /* Computes each ball's extinction summed over its volume, m^2; the ball hides `cover` times its
     * opacity in the middle. */
    void (*find_extinction)(const struct kiln_living_block *block, float cover, float shadow,
                            float extinction[KILN_LANES]);
    /* Multiplies by the part of the sun that boxes let through. */
    void (*shade)(const struct kiln_living_block *block, const struct kiln_sun_box *boxes,
                  uint32_t box_count, const struct kiln_sun_frame *sun, float visible[KILN_LANES]);
};
KILN_SIMD_DECLARE(const struct kiln_light_loops, kiln_light_loops);

#endif
