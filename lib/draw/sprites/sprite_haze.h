/* This header computes the haze in front of a vector of sprites by shared/haze.h. All of a sprite
 * is as far away as the middle of its particle. */
#ifndef KILN_DRAW_SPRITES_SPRITE_HAZE_H
#define KILN_DRAW_SPRITES_SPRITE_HAZE_H

#include "draw/sprites/sprite_lanes.h"
#include "draw/vector/haze_color.h"

/* Holds what haze leaves of the colours of sprites, and what it adds to each colour where a sprite
 * covers what is behind it. */
struct sprite_haze {
    vf clear;
    struct vf3 added;
};

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
