/* This file makes the procedural flipbooks of objects with a fixed shape: grains, drops, splinters
 * and glints. */
#include <math.h>

#include "asset/atlas/texel.h"
#include "shared/random.h"

/* Draws a glowing grain: a hot point with a faint halo, the same at any age. */
static void spark_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    for (uint32_t i = 0; i < s->count; i++) {
        float r2 = s->u[i] * s->u[i] + s->v * s->v;
        float core = texel_saturate(1.0f - r2 / 0.16f);
        float halo = texel_saturate(1.0f - r2 / 0.92f);
        out->height[i] = 0.0f;
        out->heat[i] = core;
        out->density[i] = 0.75f * core * core + 0.25f * halo * halo * halo;
    }
}

/* Draws a glint with four rays that shrink with age. */
static void star_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float v = fabsf(s->v), reach = texel_mix(0.95f, 0.35f, s->time);
    const float across = texel_saturate(1.0f - v / reach);
    for (uint32_t i = 0; i < s->count; i++) {
        float u = fabsf(s->u[i]), along = texel_saturate(1.0f - u / reach);
        float ray = along * along * texel_saturate(1.0f - v / (0.10f * along + 0.01f)) +
                    across * across * texel_saturate(1.0f - u / (0.10f * across + 0.01f));
        float core = texel_saturate(1.0f - (u * u + v * v) / 0.07f);
        float halo = texel_saturate(1.0f - (u * u + v * v) / (reach * reach));
        float bright = texel_saturate(core * core + 0.7f * ray);
        out->height[i] = 0.0f;
        out->heat[i] = bright;
        out->density[i] = texel_saturate(bright + 0.18f * halo * halo * halo);
    }
}

/* Draws a drop of water. Its rim covers more than its middle, which is transparent, and a highlight
 * lies to the upper left. */
static void drop_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    for (uint32_t i = 0; i < s->count; i++) {
        float u = s->u[i], r2 = (u * u + s->v * s->v) / (0.84f * 0.84f);
        float dome = r2 < 1.0f ? exact_sqrt(1.0f - r2) : 0.0f;
        float du = u + 0.28f, dv = s->v - 0.32f;
        float highlight = texel_smooth(0.05f, 0.0f, du * du + dv * dv);
        float rim = texel_mix(0.35f, 0.8f, r2);
        float edge = texel_smooth(1.0f, 0.86f, r2);
        out->height[i] = 0.8f * dome;
        out->heat[i] = highlight;
        out->density[i] = edge * (rim + highlight * (1.0f - rim));
    }
}

/* Draws the splash of a drop on the ground from the side: a crown that rises and opens, and
 * droplets that fly from it. The ground is a quarter of the cell above its lower edge. */
static void splash_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    enum { DROPLETS = 26 };
    const float ground = -0.5f, t = s->time, v = s->v - ground;
    float wet[TEXEL_ROW] = {0};
    for (uint32_t k = 0; k < DROPLETS; k++) {
        uint stream = random_stream(0x5b1a5u, k);
        float x = 1.3f * (random_unit(stream, 0) - 0.5f) * t;
        float climb = texel_mix(1.4f, 4.2f, random_unit(stream, 1));
        float y = climb * t - 4.4f * t * t;
        float size = texel_mix(0.025f, 0.07f, random_unit(stream, 2)) * (1.2f - 0.6f * t);
        float dy = (v - y) / size;
        if (y <= -0.1f || dy * dy >= 1.0f)
            continue;
        for (uint32_t i = 0; i < s->count; i++) {
            float dx = (s->u[i] - 0.3f * x - x) / size;
            wet[i] += texel_smooth(1.0f, 0.3f, dx * dx + dy * dy);
        }
    }
    const float width = 0.12f + 0.55f * t, height = 0.02f + 2.2f * t * (1.0f - t) * (1.0f - t);
    const float climbing = texel_smooth(height, 0.4f * height, v);
    const float standing = v > 0.0f ? 1.0f - t : 0.0f;
    for (uint32_t i = 0; i < s->count; i++) {
        float u = s->u[i], wall = fabsf(u) - width - 0.25f * v;
        float crown = texel_smooth(0.09f, 0.0f, fabsf(wall)) * climbing;
        float rings = (u * u) / (width * width) + v * v / (0.09f * width * width);
        float ripple = texel_smooth(0.5f, 0.0f, fabsf(rings - 1.0f)) * (1.0f - t);
        float all = wet[i] + crown * standing;
        all = texel_saturate(all + 0.4f * ripple) * texel_smooth(1.0f, 0.75f, t);
        out->height[i] = 0.3f * all;
        out->heat[i] = all;
        out->density[i] = 0.8f * all;
    }
}

/* Draws a splinter of stone that turns once in its life: the body inside twelve planes, seen from
 * the front. A single cell is also a complete view. */
static void debris_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    enum { PLANES = 12 };
    struct exact_angle turn = exact_sincos(EXACT_TWO_PI * s->time);
    float front[TEXEL_ROW], back[TEXEL_ROW], beside[TEXEL_ROW];
    for (uint32_t i = 0; i < s->count; i++) {
        front[i] = beside[i] = 1.0f;
        back[i] = -1.0f;
    }
    for (uint32_t k = 0; k < PLANES; k++) {
        uint stream = random_stream(0xdeb21u, k);
        float3 n = random_direction(stream, 0, FLOAT3(0.0f, 1.0f, 0.0f), -1.0f);
        const float away = texel_mix(0.34f, 0.66f, random_unit(stream, 2));
        const float x = turn.cosine * n.x + turn.sine * n.z;
        const float z = turn.cosine * n.z - turn.sine * n.x;
        for (uint32_t i = 0; i < s->count; i++) {
            /* distance of the plane, less z times depth */
            float room = away - x * s->u[i] - n.y * s->v;
            if (z > 0.05f)
                front[i] = exact_min(front[i], room / z);
            else if (z < -0.05f)
                back[i] = exact_max(back[i], room / z);
            else
                beside[i] = exact_min(beside[i], room);
        }
    }
    for (uint32_t i = 0; i < s->count; i++) {
        float thickness = exact_min(front[i] - back[i], beside[i]);
        float r2 = s->u[i] * s->u[i] + s->v * s->v;
        out->height[i] = texel_saturate(0.5f + 0.5f * front[i]);
        out->heat[i] = texel_saturate(0.5f * thickness);
        out->density[i] = texel_smooth(0.0f, 0.05f, thickness) * texel_smooth(0.92f, 0.85f, r2);
    }
}

/* Draws what follows a spark, for ribbons: a hot line with a faint halo, the same all along. */
static void trail_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float v2 = s->v * s->v;
    const float core = texel_saturate(1.0f - v2 / 0.16f), halo = texel_saturate(1.0f - v2);
    for (uint32_t i = 0; i < s->count; i++) {
        out->height[i] = 0.0f;
        out->heat[i] = core;
        out->density[i] = 0.75f * core * core + 0.25f * halo * halo * halo;
    }
}

/* Draws an even strip with soft edges, for ribbons of cloth, smoke and water. */
static void band_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float v2 = s->v * s->v, cover = texel_smooth(1.0f, 0.6f, v2);
    for (uint32_t i = 0; i < s->count; i++) {
        out->height[i] = 0.0f;
        out->heat[i] = 1.0f;
        out->density[i] = cover;
    }
}

const struct builtin_list KILN_SIMD_NAME(kiln_builtin_solids) = {{
    {.name = "spark", .texels = spark_texels},
    {.name = "star", .texels = star_texels},
    {.name = "drop", .texels = drop_texels, .relief = 18.0f},
    {.name = "splash", .texels = splash_texels, .relief = 6.0f},
    {.name = "debris", .texels = debris_texels, .relief = 40.0f},
    {.name = "trail", .texels = trail_texels},
    {.name = "band", .texels = band_texels},
    {0},
}};
