/* This header computes the light that falls on sprites, as light_particle() of
 * shaders/draw/sprites/particle.glsl does in GL. */
#ifndef KILN_DRAW_SPRITES_SPRITE_LIGHT_H
#define KILN_DRAW_SPRITES_SPRITE_LIGHT_H

#include "draw/light/ray_smoke.h"
#include "draw/sprites/sprite_subjects.h"

/* Holds light from everywhere, and how it changes along the billboard's axes (right, up, towards
 * the viewer): spherical harmonics of degrees 0 and 1, for each colour. */
struct sprite_light {
    vf parts[4][3];
};

/* Holds the same light with the second part along the axes of the world. */
struct light_sum {
    vf all[3];
    struct vf3 along[3];
};

/* Adds light from a direction: half of it ambient, half along the normal. Smoke scatters, so a
 * sprite's far side is dimmer, not black. factor: half of the light; towards: the direction times
 * that. */
SIMD void add_light(struct light_sum *sum, float4 radiance, vf factor, struct vf3 towards)
{
    const float color[3] = {radiance.x, radiance.y, radiance.z};
    for (int c = 0; c < 3; c++) {
        sum->all[c] += color[c] * factor;
        sum->along[c] = vf3_along(sum->along[c], towards, vf_all(color[c]));
    }
}

SIMD void add_far_light(struct light_sum *sum, float4 radiance, vf factor, float4 direction)
{
    vf half = 0.5f * factor;
    add_light(sum, radiance, half,
              (struct vf3){half * direction.x, half * direction.y, half * direction.z});
}

SIMD void add_point_lights(struct light_sum *sum, const struct kiln_draw_backdrop *b, vf lit,
                           struct vf3 position)
{
    vf half_lit = 0.5f * lit;
    for (uint32_t i = 0; i < b->counts.y; i++) {
        const float4 at = b->lights[i].position_radius2;
        struct vf3 towards = vf3_towards(at, position);
        vf d2 = vf3_dot(towards, towards);
        vf half = half_lit / (d2 + (at.w + 1e-12f));
        vf half_a_metre = half * vf_rsqrt(d2 + 1e-9f);
        add_light(sum, b->lights[i].color, half, vf3_scale(towards, half_a_metre));
    }
}

/* Lights sprites. lit: how much of the light is reflected; the rest of a sprite is as bright as if
 * in white light. */
static void light_sprites(const struct subjects *p, struct sprite_light *light)
{
    const struct kiln_draw_backdrop *b = p->pass->backdrop;
    const struct kiln_lighting *lighting = p->pass->lighting;
    vf lit = vf_max(p->cover.c[3], vf_all(0.0f));
    const struct ray_point point = {.at = p->record.position, .wanted = p->seen & (lit > 0.0f)};
    struct light_sum sum;
    memset(&sum, 0, sizeof sum);
    if (any(point.wanted)) {
        /* The horizon's light comes from all sides and crosses less of the smoke than that from
         * above. */
        vf sky = smoke_lets_through(lighting->smoke ? lighting->sky_depth : NULL,
                                    lighting->sky_to_grid, &point);
        vf sun = smoke_lets_through(lighting->smoke ? lighting->sun_depth : NULL,
                                    lighting->sun_to_grid, &point);
        if (lighting->sunlit)
            sun *= vf_gather(lighting->sunlit, p->slots);
        const float4 up = {0.0f, 1.0f, 0.0f, 0.0f};
        vf around = lit * vf_sqrt(sky);
        sum.all[0] = b->sky_horizon.x * around;
        sum.all[1] = b->sky_horizon.y * around;
        sum.all[2] = b->sky_horizon.z * around;
        add_far_light(&sum, b->sky_top, lit * sky, up);
        add_far_light(&sum, b->sun_color, lit * sun * (1.0f / RAY_PI), b->sun_direction);
        add_point_lights(&sum, b, lit, point.at);
    }
    for (int c = 0; c < 3; c++) {
        struct vf3 along = to_view(p->pass->view, sum.along[c]);
        light->parts[0][c] = (1.0f - p->cover.c[3]) + sum.all[c];
        light->parts[1][c] = vf3_dot(along, p->plane.right);
        light->parts[2][c] = vf3_dot(along, p->plane.up);
        light->parts[3][c] = vf3_dot(along, p->plane.normal);
    }
}

#endif
