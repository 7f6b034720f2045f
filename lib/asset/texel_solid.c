/* Things with a shape of their own: grains, drops, splinters, glints. */
#include "asset/texel.h"

#include "shared/random.h"

#include <math.h>

/* A glowing grain: a hot point with a faint halo, the same at any age. */
static struct texel spark_texel(const struct texel_site *s)
{
    float r2 = s->u * s->u + s->v * s->v;
    float core = texel_saturate(1.0f - r2 / 0.16f);
    float halo = texel_saturate(1.0f - r2 / 0.92f);
    return (struct texel){.heat = core,
                          .density = 0.75f * core * core + 0.25f * halo * halo * halo};
}

/* A glint with four rays that shrink with age. */
static struct texel star_texel(const struct texel_site *s)
{
    float u = fabsf(s->u), v = fabsf(s->v), reach = texel_mix(0.95f, 0.35f, s->time);
    float along = texel_saturate(1.0f - u / reach), across = texel_saturate(1.0f - v / reach);
    float ray = along * along * texel_saturate(1.0f - v / (0.10f * along + 0.01f)) +
                across * across * texel_saturate(1.0f - u / (0.10f * across + 0.01f));
    float core = texel_saturate(1.0f - (u * u + v * v) / 0.07f);
    float halo = texel_saturate(1.0f - (u * u + v * v) / (reach * reach));
    float bright = texel_saturate(core * core + 0.7f * ray);
    return (struct texel){.heat = bright,
                          .density = texel_saturate(bright + 0.18f * halo * halo * halo)};
}

/* A drop of water: its rim covers more than its middle, which one sees through, and a highlight
 * sits to the upper left. */
static struct texel drop_texel(const struct texel_site *s)
{
    float r2 = (s->u * s->u + s->v * s->v) / (0.84f * 0.84f);
    float dome = r2 < 1.0f ? exact_sqrt(1.0f - r2) : 0.0f;
    float du = s->u + 0.28f, dv = s->v - 0.32f;
    float highlight = texel_smooth(0.05f, 0.0f, du * du + dv * dv);
    float rim = texel_mix(0.35f, 0.8f, r2);
    float edge = texel_smooth(1.0f, 0.86f, r2);
    return (struct texel){.height = 0.8f * dome,
                          .heat = highlight,
                          .density = edge * (rim + highlight * (1.0f - rim))};
}

/* What a drop throws up where it lands, from the side: a crown that rises and opens, and droplets
 * that fly from it. The ground is a quarter of the cell above its foot. */
static struct texel splash_texel(const struct texel_site *s)
{
    enum { DROPLETS = 26 };
    const float ground = -0.5f;
    float t = s->time, v = s->v - ground;
    float wet = 0.0f;
    for (uint32_t i = 0; i < DROPLETS; i++) {
        uint stream = random_stream(0x5b1a5u, i);
        float x = 1.3f * (random_unit(stream, 0) - 0.5f) * t;
        float climb = texel_mix(1.4f, 4.2f, random_unit(stream, 1));
        float y = climb * t - 4.4f * t * t;
        float size = texel_mix(0.025f, 0.07f, random_unit(stream, 2)) * (1.2f - 0.6f * t);
        float dx = (s->u - 0.3f * x - x) / size, dy = (v - y) / size;
        wet += y > -0.1f ? texel_smooth(1.0f, 0.3f, dx * dx + dy * dy) : 0.0f;
    }
    float width = 0.12f + 0.55f * t, height = 0.02f + 2.2f * t * (1.0f - t) * (1.0f - t);
    float wall = fabsf(s->u) - width - 0.25f * v;
    float crown = texel_smooth(0.09f, 0.0f, fabsf(wall)) * texel_smooth(height, 0.4f * height, v);
    float rings = (s->u * s->u) / (width * width) + v * v / (0.09f * width * width);
    float ripple = texel_smooth(0.5f, 0.0f, fabsf(rings - 1.0f)) * (1.0f - t);
    wet += v > 0.0f ? crown * (1.0f - t) : 0.0f;
    wet = texel_saturate(wet + 0.4f * ripple) * texel_smooth(1.0f, 0.75f, t);
    return (struct texel){.height = 0.3f * wet, .heat = wet, .density = 0.8f * wet};
}

/* A splinter of stone that turns once in its life: what twelve planes leave of space, seen from the
 * front. Each of the cells is a view of its own, too. */
static struct texel debris_texel(const struct texel_site *s)
{
    enum { PLANES = 12 };
    struct exact_angle turn = exact_sincos(EXACT_TWO_PI * s->time);
    float front = 1.0f, back = -1.0f, beside = 1.0f;
    for (uint32_t i = 0; i < PLANES; i++) {
        uint stream = random_stream(0xdeb21u, i);
        float3 n = random_direction(stream, 0, FLOAT3(0.0f, 1.0f, 0.0f), -1.0f);
        float away = texel_mix(0.34f, 0.66f, random_unit(stream, 2));
        float x = turn.cosine * n.x + turn.sine * n.z;
        float z = turn.cosine * n.z - turn.sine * n.x;
        float room = away - x * s->u - n.y * s->v; /* left of the plane, less z times depth */
        if (z > 0.05f)
            front = exact_min(front, room / z);
        else if (z < -0.05f)
            back = exact_max(back, room / z);
        else
            beside = exact_min(beside, room);
    }
    float thickness = exact_min(front - back, beside);
    float r2 = s->u * s->u + s->v * s->v;
    return (struct texel){.height = texel_saturate(0.5f + 0.5f * front),
                          .heat = texel_saturate(0.5f * thickness),
                          .density = texel_smooth(0.0f, 0.05f, thickness) *
                                     texel_smooth(0.92f, 0.85f, r2)};
}

const struct builtin kiln_builtin_solids[] = {
    {"spark", NULL, spark_texel, 0.0f},    {"star", NULL, star_texel, 0.0f},
    {"drop", NULL, drop_texel, 18.0f},     {"splash", NULL, splash_texel, 6.0f},
    {"debris", NULL, debris_texel, 40.0f}, {0},
};
