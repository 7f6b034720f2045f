/* This header computes the light that falls on a vector of sprites by shared/billboard_light.h. */
#ifndef KILN_DRAW_SPRITES_SPRITE_LIGHT_H
#define KILN_DRAW_SPRITES_SPRITE_LIGHT_H

#include "draw/light/ray_smoke.h"
#include "draw/sprites/sprite_lanes.h"
#include "shared/billboard_light.h"

/* Returns the part of a light, 0 to 1, that sprites see past the backdrop. */
SIMD vf lamp_part_of(const struct kiln_lighting *lighting, uint32_t light, vi slots)
{
    const uint32_t *plane =
        lighting->lamplit + light / 4 * kiln_lamp_shade_plane(lighting->slot_count);
    const vi word = vi_gather((const int32_t *)plane, slots);
    const vi part = word >> (int32_t)(8 * (light % 4)) & KILN_LAMP_SHADE_ONE;
    return vf_of(part) * (1.0f / (float)KILN_LAMP_SHADE_ONE);
}

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
        const vf one = vf_all(1.0f);
        const vf above = smoke_depth_to(lighting->smoke ? lighting->sky_depth : NULL,
                                        lighting->sky_to_grid, &point);
        const vf before_sun = smoke_depth_to(lighting->smoke ? lighting->sun_depth : NULL,
                                             lighting->sun_to_grid, &point);
        const vf past = lighting->sunlit ? vf_gather(lighting->sunlit, p->slots) : one;
        const vf reflected = (p->cover.c[0] + p->cover.c[1] + p->cover.c[2]) * (1.0f / 3.0f);
        const vf diffusion = smoke_diffusion(reflected);
        sum = light_sum_of_sky(b->sky_horizon, b->sky_top, lit, above, diffusion);
        sum = light_sum_add_sun(sum, b->sun_color, b->sun_direction, lit,
                                light_parts_through(before_sun, diffusion, past));
        for (uint32_t i = 0; i < b->counts.y; i++) {
            const vf before_lamp = lamp_smoke_depth(lighting->lamp_smoke, &b->lights[i], &point);
            const vf seen = lighting->lamplit ? lamp_part_of(lighting, i, p->slots) : one;
            sum = light_sum_add_lamp(sum, b->lights[i], lit, point.at,
                                     light_parts_through(before_lamp, diffusion, seen));
        }
    }
    *light = light_sum_along_plane(sum, 1.0f - p->cover.c[3], p->pass->view->world_to_view[0],
                                   p->pass->view->world_to_view[1], p->pass->view->world_to_view[2],
                                   p->plane);
}

#endif
