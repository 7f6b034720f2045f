/* Sums of light and shade over blocks of living particles, by loops that become vectors
 * (light_simd.c). */
#ifndef KILN_DRAW_LIGHT_LIGHT_BLOCKS_H
#define KILN_DRAW_LIGHT_LIGHT_BLOCKS_H

#include "draw/light/sun_box.h"
#include "draw/moment/living_blocks.h"

/* kiln_living_glow at the samples of a look. */
struct kiln_glow {
    float red[KILN_LOOK_SAMPLES], green[KILN_LOOK_SAMPLES], blue[KILN_LOOK_SAMPLES];
};

/* Sums over the particles of one light. */
struct kiln_gathering {
    double color[3];    /* light sent, m^2 */
    double energy;      /* of all channels: the weight of what follows */
    double position[3]; /* m */
    double square;      /* of the distance from the origin, m^2 */
    double radius;      /* of a particle, m */
};

struct kiln_light_loops {
    /* Adds what the particles emit, cells being filled to a part, to the two lights that each lies
     * between by its progress. */
    void (*gather_fire)(const struct kiln_living_block *block, const struct kiln_glow *glow,
                        float fill, uint32_t light_count, struct kiln_gathering *lights);
    /* Of a ball of smoke that hides `cover` times its opacity in the middle: the extinction summed
     * over its volume, m^2. */
    void (*find_extinction)(const struct kiln_living_block *block, float cover, float shadow,
                            float extinction[KILN_LANES]);
    /* Multiplies by what boxes let through of the sun. */
    void (*shade)(const struct kiln_living_block *block, const struct kiln_sun_box *boxes,
                  uint32_t box_count, const struct kiln_sun_frame *sun, float visible[KILN_LANES]);
};
KILN_SIMD_DECLARE(const struct kiln_light_loops, kiln_light_loops);

#endif
