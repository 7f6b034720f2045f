/* This header computes the haze in front of a vector of sprites by shared/haze.h. All of a sprite
 * is as far away as the middle of its particle. */
#ifndef KILN_DRAW_SPRITES_SPRITE_HAZE_H
#define KILN_DRAW_SPRITES_SPRITE_HAZE_H

#include "draw/sprites/sprite_lanes.h"
#include "shared/haze.h"
#include "shared/surface_light.h"

/* Holds what haze leaves of the colours of sprites, and what it adds to each colour where a sprite
 * covers what is behind it. */
struct sprite_haze {
    vf clear;
    struct vf3 added;
};

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

/* Returns whether there is haze before sprites. */
static inline bool has_haze(const struct kiln_draw_backdrop *b)
{
    return b->floor_params.z > 0.0f && b->counts.z == 0;
}

static struct sprite_haze find_haze(const struct sprite_lanes *p, bool covers)
{
    const struct kiln_draw_backdrop *b = p->pass->backdrop;
    const struct vf3 way = vf3_sub(p->record.position, vf3_all(p->pass->view->eye));
    struct sprite_haze haze;
    memset(&haze, 0, sizeof haze);
    haze.clear = haze_clear(b->floor_params.z, vf_all(1.0f), vf3_length(way));
    if (covers)
        haze.added = vf3_scale(haze_toward(b, haze_level(way)), 1.0f - haze.clear);
    return haze;
}

#endif
