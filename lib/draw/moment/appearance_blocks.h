/* This header declares living particles in blocks of KILN_LANES slots, which vectorised loops
 * compute (appearance_simd.c). The lighting stage uses it where it visits all particles. */
#ifndef KILN_DRAW_MOMENT_APPEARANCE_BLOCKS_H
#define KILN_DRAW_MOMENT_APPEARANCE_BLOCKS_H

#include "base/simd.h"
#include "draw/moment/appearance.h"
#include "particles/lanes.h"
#include "shared/exact.h"
#include "shared/look_layout.h"

/* Holds the struct kiln_appearance of each slot; where no particle lives, radius and opacity are 0.
 */
struct kiln_appearance_block {
    struct kiln_lanes lanes;
    uint32_t alive[KILN_LANES]; /* 0 or 1 */
    struct kiln_floats3 position;
    kiln_floats radius, progress, opacity;
};

/* Describes a progress through life as a place between two samples of a look, which are four floats
 * apart in a row of the table. */
struct kiln_look_place {
    int sample, texel; /* number of the first sample; its offset in a row of the table, in floats */
    float part;        /* weight of the second sample, 0 to 1 */
};

static inline struct kiln_look_place kiln_look_place_at(float progress)
{
    float x = progress * (float)(KILN_LOOK_SAMPLES - 1);
    int sample = exact_int(x);
    sample = sample > KILN_LOOK_SAMPLES - 2 ? KILN_LOOK_SAMPLES - 2 : sample;
    return (struct kiln_look_place){sample, 4 * sample, x - (float)sample};
}

/* Computes the particles in slots first to first + KILN_LANES - 1; slots from system->used on count
 * as empty. */
typedef void kiln_appearance_find(const struct kiln_appearance_system *system, uint32_t first,
                                  struct kiln_appearance_block *block);
KILN_SIMD_DECLARE(kiln_appearance_find, kiln_appearance_find);

#endif
