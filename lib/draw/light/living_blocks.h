/* The living particles in blocks of slots, and the loops over them that become vectors
 * (living_simd.c): what lighting asks of all particles. */
#ifndef KILN_DRAW_LIVING_BLOCKS_H
#define KILN_DRAW_LIVING_BLOCKS_H

#include "base/simd.h"
#include "draw/light/sun_box.h"
#include "draw/moment/living.h"
#include "particles/lanes.h"
#include "shared/look_layout.h"

/* struct kiln_living of each slot; where none lives, radius and opacity are 0. */
struct kiln_living_block {
    struct kiln_lanes lanes;
    uint32_t alive[KILN_LANES]; /* 0 or 1 */
    struct kiln_floats3 position;
    kiln_floats radius, progress, opacity;
};

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

struct kiln_living_loops {
    /* Slots first to first + KILN_LANES - 1, of which those from system->used on are empty. */
    void (*find)(const struct kiln_living_system *system, uint32_t first,
                 struct kiln_living_block *block);
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
KILN_SIMD_DECLARE(const struct kiln_living_loops, kiln_living_loops);

#endif
