/* This file finds how much of a lamp's light reaches places of a block of gas: past objects, seen
 * from a ball of two cells, and through smoke, by the map that the lighting stage has made. */
#include "draw/light/ray_lamp.h"
#include "draw/light/ray_smoke.h"
#include "draw/volume/volume_lamps.h"
#include "draw/volume/volume_places.h"

void KILN_SIMD_NAME(kiln_volume_lamp_reach)(const struct kiln_volume_lamp *lamp,
                                            const struct kiln_volume_frame *frame,
                                            struct kiln_gas_place brick, float parts[VOLUME_PLACES])
{
    const struct kiln_draw_light *light = lamp->light;
    for (int first = 0; first < VOLUME_PLACES; first += LANES) {
        const struct vf3 at = volume_places_of(frame, brick, first);
        const vi active = vi_all(-1);
        const struct vf3 towards = vf3_normalize(vf3_towards(light->position_radius2, at));
        const struct ray_point point = {.at = at, .normal = towards, .active = active};
        const vf depth = lamp_smoke_depth(lamp->smoke, light, &point);
        vf seen = vf_all(1.0f);
        if (light->casters.y || kiln_shape_set_any(&lamp->casters))
            seen = lamp_visibility(&lamp->objects, light, &lamp->casters, at, towards, NULL,
                                   vf_all(frame->cell_m), active);
        const vf scattered = VOLUME_ONCE * vf_exp(-depth) +
                             VOLUME_TWICE * vf_exp(-VOLUME_TWICE_DIMS * depth) +
                             VOLUME_THRICE * vf_exp(-VOLUME_THRICE_DIMS * depth);
        vf_store(parts + first, seen * scattered);
    }
}
