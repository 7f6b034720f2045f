/* As light_particle() of shaders/draw/particle.glsl. */
#include "draw/sprite_light.h"

#include "base/vector.h"
#include "shared/exact.h"

enum { LIGHTS_AT_A_TIME = 8 };

static const float PI = 3.14159265f;

/* Smoke scatters: a sprite's far side is dimmer, not black. Light from a direction is half ambient,
 * half along the normal: factors for the four parts of the light. */
static void add_light(struct kiln_sprite_light *light, const float radiance[3],
                      const float factors[4])
{
    for (int part = 0; part < 4; part++) {
        for (int c = 0; c < 3; c++)
            light->parts[part][c] += radiance[c] * factors[part];
    }
}

static void add_far_light(struct kiln_sprite_light *light, const struct kiln_sprite_axes *axes,
                          float4 radiance, float factor, float3 direction)
{
    const float color[3] = {radiance.x, radiance.y, radiance.z};
    float half = 0.5f * factor;
    const float factors[4] = {half, half * float3_dot(direction, axes->right),
                              half * float3_dot(direction, axes->up),
                              half * float3_dot(direction, axes->normal)};
    add_light(light, color, factors);
}

void kiln_sprite_lights_fill(struct kiln_sprite_lights *lights,
                             const struct kiln_draw_backdrop *backdrop)
{
    *lights = (struct kiln_sprite_lights){.count = 0};
    uint32_t count = backdrop->counts.y;
    for (uint32_t i = 0; i < count && i < KILN_SPRITE_LIGHTS; i++) {
        const struct kiln_draw_light *light = &backdrop->lights[i];
        lights->x[i] = light->position_radius2.x;
        lights->y[i] = light->position_radius2.y;
        lights->z[i] = light->position_radius2.z;
        lights->radius2[i] = light->position_radius2.w;
        lights->color[i][0] = light->color.x;
        lights->color[i][1] = light->color.y;
        lights->color[i][2] = light->color.z;
    }
    lights->count = (count + LIGHTS_AT_A_TIME - 1) / LIGHTS_AT_A_TIME * LIGHTS_AT_A_TIME;
}

static void add_point_lights(struct kiln_sprite_light *light,
                             const struct kiln_sprite_lights *lights,
                             const struct kiln_sprite_axes *axes, float lit, float3 position)
{
    float factors[4][LIGHTS_AT_A_TIME];
    for (uint32_t first = 0; first < lights->count; first += LIGHTS_AT_A_TIME) {
        for (uint32_t k = 0; k < LIGHTS_AT_A_TIME; k++) {
            uint32_t i = first + k;
            float x = lights->x[i] - position.x, y = lights->y[i] - position.y;
            float z = lights->z[i] - position.z;
            float d2 = x * x + y * y + z * z;
            float half = 0.5f * lit / (d2 + lights->radius2[i] + 1e-12f);
            float towards = half / sqrtf(d2 + 1e-9f);
            factors[0][k] = half;
            factors[1][k] = (x * axes->right.x + y * axes->right.y + z * axes->right.z) * towards;
            factors[2][k] = (x * axes->up.x + y * axes->up.y + z * axes->up.z) * towards;
            factors[3][k] =
                (x * axes->normal.x + y * axes->normal.y + z * axes->normal.z) * towards;
        }
        for (uint32_t k = 0; k < LIGHTS_AT_A_TIME; k++) {
            const float at[4] = {factors[0][k], factors[1][k], factors[2][k], factors[3][k]};
            add_light(light, lights->color[first + k], at);
        }
    }
}

KILN_WIDE_VECTORS
struct kiln_sprite_light kiln_sprite_light(const struct kiln_sprite_pass *pass, uint32_t slot,
                                           float lit, const struct kiln_sprite_axes *axes,
                                           float3 position)
{
    const struct kiln_draw_backdrop *b = pass->backdrop;
    struct kiln_sprite_light light = {{{1.0f - lit, 1.0f - lit, 1.0f - lit}}};
    if (lit <= 0.0f)
        return light;
    /* The horizon's light comes from all sides and crosses less of the smoke than that from above.
     */
    float sky = kiln_lighting_sky(pass->lighting, position);
    float sun = kiln_lighting_sun(pass->lighting, position);
    if (pass->lighting->sunlit)
        sun *= pass->lighting->sunlit[slot];
    const float horizon[3] = {b->sky_horizon.x, b->sky_horizon.y, b->sky_horizon.z};
    const float ambient[4] = {lit * exact_sqrt(sky)};
    add_light(&light, horizon, ambient);
    add_far_light(&light, axes, b->sky_top, lit * sky, (float3){0.0f, 1.0f, 0.0f});
    float3 sun_direction = {b->sun_direction.x, b->sun_direction.y, b->sun_direction.z};
    add_far_light(&light, axes, b->sun_color, lit * sun / PI, sun_direction);
    add_point_lights(&light, &pass->lights, axes, lit, position);
    return light;
}
