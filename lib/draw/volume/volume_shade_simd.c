/* This file finds how much of the light of sun and sky reaches places of a block of gas through
 * smoke of particles and of other domains, by the grids that the lighting stage has filled. */
#include "draw/light/ray_smoke.h"
#include "draw/volume/volume_places.h"
#include "draw/volume/volume_shade.h"

void KILN_SIMD_NAME(kiln_volume_smoke_reach)(const struct kiln_volume_shade *shade,
                                             const struct kiln_volume_frame *frame,
                                             struct kiln_gas_place brick,
                                             struct kiln_volume_smoke_parts *parts)
{
    for (int first = 0; first < VOLUME_PLACES; first += LANES) {
        const struct ray_point point = {.at = volume_places_of(frame, brick, first),
                                        .active = vi_all(-1)};
        const vf sun = smoke_depth_to(shade->sun.depth, shade->sun.to_grid, &point);
        const vf sky = smoke_depth_to(shade->sky.depth, shade->sky.to_grid, &point);
        vf_store(parts->once + first, vf_exp(-sun));
        vf_store(parts->more + first, (VOLUME_TWICE * vf_exp(-VOLUME_TWICE_DIMS * sun) +
                                       VOLUME_THRICE * vf_exp(-VOLUME_THRICE_DIMS * sun)) *
                                          (1.0f / (VOLUME_TWICE + VOLUME_THRICE)));
        vf_store(parts->sky + first, vf_exp(-VOLUME_SKY_DIMS * sky));
    }
}
