/* This header computes the light that falls on a vector of sprites by shared/billboard_light.h. */
#ifndef KILN_DRAW_SPRITES_SPRITE_LIGHT_H
#define KILN_DRAW_SPRITES_SPRITE_LIGHT_H

#include "draw/light/ray_smoke.h"
#include "draw/sprites/sprite_lanes.h"
#include "shared/billboard_light.h"

/* Computes the light on sprites along the axes of their billboards. The look's `lit` is the part of
 * the scene's light that a sprite reflects; the rest of its light is white and comes from all
 * sides. */
static void light_sprites(const struct sprite_lanes *p, struct light_sum *light)
{
    const struct kiln_draw_backdrop *b = p->pass->backdrop;
    const struct kiln_lighting *lighting = p->pass->lighting;
    vf lit = vf_max(p->cover.c[3], vf_all(0.0f));
    const struct ray_point point = {.at = p->record.position, .active = p->visible & (lit > 0.0f)};
    struct light_sum sum;
    memset(&sum, 0, sizeof sum);
    if (any(point.active)) {
        vf sky = smoke_lets_through(lighting->smoke ? lighting->sky_depth : NULL,
                                    lighting->sky_to_grid, &point);
        vf sun = smoke_lets_through(lighting->smoke ? lighting->sun_depth : NULL,
                                    lighting->sun_to_grid, &point);
        if (lighting->sunlit)
            sun *= vf_gather(lighting->sunlit, p->slots);
        sum = light_sum_of_sky(b->sky_horizon, b->sky_top, lit, sky);
        sum = light_sum_add_sun(sum, b->sun_color, b->sun_direction, lit, sun);
        for (uint32_t i = 0; i < b->counts.y; i++)
            sum = light_sum_add_lamp(sum, b->lights[i], lit, point.at);
    }
    *light = light_sum_along_plane(sum, 1.0f - p->cover.c[3], p->pass->view->world_to_view[0],
                                   p->pass->view->world_to_view[1], p->pass->view->world_to_view[2],
                                   p->plane);
}

#endif
