/* This header computes the colour of haze for vectors of level directions, for all that is drawn
 * but surfaces. */
#ifndef KILN_DRAW_VECTOR_HAZE_COLOR_H
#define KILN_DRAW_VECTOR_HAZE_COLOR_H

#include "base/real.h"
#include "draw/vector/particle_math.h"
#include "shared/haze.h"
#include "shared/surface_light.h"

/* Returns the colour of haze in a level direction, as horizon_color in backdrop/ray_light.h does,
 * but with fewer colours of a sky that is a picture. */
SIMD struct vf3 haze_toward(const struct kiln_draw_backdrop *b, struct vf3 level)
{
    struct vf3 color = vf3_all(b->sky_horizon);
    if (b->counts.x != 0) {
        const vf place = haze_place(level);
        const vi low = vi_of(place);
        const vf part = place - vf_of(low);
        const float *haze = &b->haze[0].x;
        const vi from = (low & (KILN_HAZE_PARTS - 1)) * 4;
        const vi to = ((low + 1) & (KILN_HAZE_PARTS - 1)) * 4;
        color.x = vf_lerp(vf_gather(haze, from), vf_gather(haze, to), part);
        color.y = vf_lerp(vf_gather(haze + 1, from), vf_gather(haze + 1, to), part);
        color.z = vf_lerp(vf_gather(haze + 2, from), vf_gather(haze + 2, to), part);
    }
    if (b->sky_horizon.w > 0.0f) {
        const vf glow = sky_glow(level, b->sun_direction, b->floor_params.w);
        color = vf3_add_scaled(color, vf3_all(b->sun_color), b->sky_horizon.w * glow);
    }
    return color;
}

/* Returns whether there is haze before sprites and gas. */
static inline bool has_haze(const struct kiln_draw_backdrop *b)
{
    return b->floor_params.z > 0.0f && b->counts.z == 0;
}

#endif
