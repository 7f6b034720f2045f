/* This file makes the procedural flipbooks of gas: flames, smoke and steam. The large shapes are
 * those of a fluid. Torn sheets and wisps are noise over the places where the gas came from, so
 * they are stretched and folded with it. A threshold that rises with age erodes the thin parts
 * first. */
#include <math.h>

#include "asset/atlas/texel.h"
#include "asset/atlas/turbulence.h"
#include "shared/random.h"

enum { EDGE = KILN_FLUID_EDGE };

/* Returns a mask along one axis: 1 inside of the cell, 0 before its border. */
static inline float inside(float u)
{
    return texel_smooth(0.97f, 0.80f, fabsf(u));
}

/* Computes the coordinates of columns, or of rows. */
static void coordinates(float at[EDGE])
{
    for (uint32_t i = 0; i < EDGE; i++)
        at[i] = kiln_fluid_coordinate(i);
}

/* Adds vorticity of two sizes: turbulence that the coarse fluid cannot make by itself. */
static void stir(struct kiln_fluid *fluid, float time, float amount, float frequency, uint32_t seed)
{
    struct turbulence_grid large, small;
    float x[EDGE], finer_x[EDGE];
    coordinates(x);
    for (int i = 0; i < EDGE; i++) {
        x[i] = frequency * x[i];
        finer_x[i] = 2.3f * x[i];
    }
    turbulence_grid_begin(&large, x, time, seed);
    turbulence_grid_begin(&small, finer_x, 1.4f * time, seed + 1);
    for (uint32_t row = 0; row < EDGE; row++) {
        float coarse[EDGE], fine[EDGE], y = frequency * kiln_fluid_coordinate(row);
        turbulence_grid_row(&large, y, coarse);
        turbulence_grid_row(&small, 2.3f * y, fine);
        float *vorticity = fluid->vorticity + (size_t)row * EDGE;
        for (int i = 0; i < EDGE; i++)
            vorticity[i] += amount * (coarse[i] + 0.8f * fine[i]);
    }
}

static void cool(struct kiln_fluid *fluid, float rate, float dt)
{
    float remaining = 1.0f - rate * dt;
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++)
        fluid->heat[i] *= remaining;
}

/* Adds a ball of gas whose heat goes from 0 to 1 between two ragged circles. */
static void heat_ball(struct kiln_fluid *fluid, float outer, float inner, float raggedness,
                      float frequency, uint32_t seed)
{
    float x[EDGE], noise_x[EDGE], noise_y[EDGE], ragged[EDGE];
    coordinates(x);
    for (uint32_t row = 0; row < EDGE; row++) {
        const float y = kiln_fluid_coordinate(row);
        for (int i = 0; i < EDGE; i++) {
            noise_x[i] = frequency * x[i];
            noise_y[i] = frequency * y;
        }
        turbulence_octaves(noise_x, noise_y, 0.0f, 3, seed, EDGE, ragged);
        float *heat = fluid->heat + (size_t)row * EDGE;
        for (int i = 0; i < EDGE; i++)
            heat[i] =
                texel_smooth(outer, inner, sqrtf(x[i] * x[i] + y * y) + raggedness * ragged[i]);
    }
}

/* Describes octaves of noise over the places where the gas began. */
struct detail {
    float frequency, shift_x, shift_y;
    float pace; /* speed of the third coordinate, time */
    int octaves;
    uint32_t seed;
};

static void detail_at(const struct texel_sites *s, const float *x, const float *y,
                      const struct detail *detail, float *out)
{
    float at_x[TEXEL_ROW], at_y[TEXEL_ROW];
    for (uint32_t i = 0; i < s->count; i++) {
        at_x[i] = detail->frequency * x[i] + detail->shift_x;
        at_y[i] = detail->frequency * y[i] + detail->shift_y;
    }
    turbulence_octaves(at_x, at_y, detail->pace * s->time, detail->octaves, detail->seed, s->count,
                       out);
}

/* ---- flame: climbs from the cell's foot, parts from it and burns out ------------------------- */

static const float FLAME_FOOT = -0.80f, FLAME_RISE = 0.8f;

/* Describes the hot gas that enters at the foot of a flame. Its width grows at first, so that the
 * head is no mushroom, and it flickers. */
struct flame {
    float width; /* half of the width of the source */
    float sway;
    float grain; /* periods of the flicker in a half edge */
    uint32_t seed;
};

/* The values of a flame's feed at one moment. */
struct flame_feed {
    float time, strength, width, sway;
    float x[EDGE], flicker[EDGE]; /* by column */
};

static void feed_row(struct kiln_fluid *fluid, uint32_t row, const struct flame_feed *feed)
{
    const float y = kiln_fluid_coordinate(row), dy = (y - FLAME_FOOT) / 0.12f;
    if (dy * dy >= 1.0f)
        return;
    float *heat = fluid->heat + (size_t)row * EDGE;
    float *place_x = fluid->place_x + (size_t)row * EDGE;
    float *place_y = fluid->place_y + (size_t)row * EDGE;
    for (int i = 0; i < EDGE; i++) {
        float x = feed->x[i], dx = (x - feed->sway) / feed->width;
        float within = texel_smooth(1.0f, 0.2f, dx * dx + dy * dy);
        float flicker = 0.55f + 1.3f * feed->flicker[i];
        float given = within * feed->strength * texel_saturate(flicker);
        heat[i] = given > heat[i] ? given : heat[i];
        place_x[i] = texel_mix(place_x[i], x, within);
        place_y[i] = texel_mix(place_y[i], y - FLAME_RISE * feed->time, within);
    }
}

static void feed_flame(struct kiln_fluid *fluid, const struct flame *flame, float time)
{
    float noise_x[EDGE], noise_y[EDGE];
    struct flame_feed feed = {
        .time = time,
        .strength = texel_smooth(-0.12f, 0.10f, time) * texel_smooth(0.66f, 0.40f, time),
        .width = flame->width * texel_mix(0.4f, 1.0f, texel_smooth(0.0f, 0.3f, time)),
        .sway = flame->sway * turbulence_at(2.6f * time, 0.5f, 0.5f, flame->seed),
    };
    coordinates(feed.x);
    for (int i = 0; i < EDGE; i++) {
        noise_x[i] = flame->grain * feed.x[i];
        noise_y[i] = 7.0f * time;
    }
    turbulence(noise_x, noise_y, 0.3f, flame->seed + 1, EDGE, feed.flicker);
    for (uint32_t row = 0; row < EDGE; row++)
        feed_row(fluid, row, &feed);
}

static void drive_flame(struct kiln_fluid *fluid, float time, float dt)
{
    fluid->buoyancy = 24.0f;
    fluid->drag = 1.0f;
    fluid->strain = 0.9f;
    fluid->rise = 2.0f;
    cool(fluid, 0.8f, dt);
    stir(fluid, 3.0f * time, 100.0f * dt, 3.4f, 101);
    feed_flame(fluid, &(struct flame){0.66f, 0.25f, 3.5f, 111}, time);
}

/* Drives one narrow tongue of flame. */
static void drive_tongue(struct kiln_fluid *fluid, float time, float dt)
{
    fluid->buoyancy = 16.0f;
    fluid->drag = 1.0f;
    fluid->strain = 0.8f;
    fluid->rise = 2.0f;
    cool(fluid, 0.8f, dt);
    stir(fluid, 3.0f * time, 120.0f * dt, 3.0f, 151);
    feed_flame(fluid, &(struct flame){0.42f, 0.35f, 2.0f, 161}, time);
}

static const struct kiln_film_gas FLAME_GAS = {.drive = drive_flame};
static const struct kiln_film_gas TONGUE_GAS = {.drive = drive_tongue};

static void flame_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float inside_v = inside(s->v);
    float x[TEXEL_ROW], y[TEXEL_ROW], warp[TEXEL_ROW], sheets[TEXEL_ROW];
    const struct detail warping = {3.0f, 0.0f, 0.0f, 0.8f, 2, 131};
    detail_at(s, s->place_x, s->place_y, &warping, warp);
    for (uint32_t i = 0; i < s->count; i++) {
        x[i] = 2.4f * (s->place_x[i] + 0.12f * warp[i]);
        y[i] = 2.0f * (s->place_y[i] + 0.12f * warp[i]);
    }
    turbulence_ridges(x, y, 0.9f * s->time, 5, 141, s->count, sheets);
    const float height = texel_smooth(-0.3f, 1.0f, s->v);
    const float threshold = texel_mix(0.20f, 0.46f, s->time * s->time) + 0.12f * height;
    const float foot = texel_smooth(-0.92f, -0.45f, s->v);
    const float top = texel_smooth(0.97f, 0.5f, s->v);
    for (uint32_t i = 0; i < s->count; i++) {
        /* There is no detail at the rim, where gas and air mix, since their start places differ. */
        float within = texel_smooth(0.12f, 0.55f, s->heat[i]);
        float excess = s->heat[i] + 1.2f * (sheets[i] - 0.36f) * within - threshold;
        out->height[i] = 0.0f;
        out->heat[i] = texel_saturate(1.25f * excess);
        out->density[i] =
            texel_smooth(-0.04f, 0.42f, excess) * (inside(s->u[i]) * inside_v) * foot * top;
    }
}

/* ---- fire: a ball of burning gas that rolls, swells and tears into sheets -------------------- */

static void start_fire(struct kiln_fluid *fluid)
{
    fluid->swelling = 0.30f;
    fluid->drag = 0.8f;
    heat_ball(fluid, 0.66f, 0.30f, 0.22f, 2.6f, 201);
    stir(fluid, 0.0f, 16.0f, 2.6f, 211);
}

static void drive_fire(struct kiln_fluid *fluid, float time, float dt)
{
    stir(fluid, 3.0f * time, 60.0f * dt, 3.6f, 221);
}

static const struct kiln_film_gas FIRE_GAS = {start_fire, drive_fire};

static void fire_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float inside_v = inside(s->v);
    float x[TEXEL_ROW], y[TEXEL_ROW], warp_x[TEXEL_ROW], warp_y[TEXEL_ROW], sheets[TEXEL_ROW];
    const struct detail warping_x = {3.0f, 5.0f, 0.0f, 0.4f, 2, 231};
    const struct detail warping_y = {3.0f, 0.0f, 9.0f, 0.4f, 2, 233};
    detail_at(s, s->place_x, s->place_y, &warping_x, warp_x);
    detail_at(s, s->place_x, s->place_y, &warping_y, warp_y);
    for (uint32_t i = 0; i < s->count; i++) {
        x[i] = 2.1f * (s->place_x[i] + 0.18f * warp_x[i]);
        y[i] = 2.1f * (s->place_y[i] + 0.18f * warp_y[i]);
    }
    turbulence_ridges(x, y, 0.2f * s->time, 5, 241, s->count, sheets);
    const float threshold = texel_mix(0.18f, 1.10f, 0.65f * s->time * s->time + 0.35f * s->time);
    const float torn = texel_mix(1.15f, 0.80f, s->time); /* at the end, few thick shreds are left */
    const float soft = texel_mix(0.26f, 0.45f, s->time);
    for (uint32_t i = 0; i < s->count; i++) {
        float there = texel_saturate(4.0f * s->heat[i]);
        float excess = 0.75f * s->heat[i] + torn * (sheets[i] - 0.34f) * there - threshold;
        out->height[i] = 0.0f;
        out->heat[i] = texel_saturate(1.2f * excess) * texel_saturate(0.3f + sheets[i]);
        out->density[i] = texel_smooth(0.0f, soft, excess) * (inside(s->u[i]) * inside_v);
    }
}

/* ---- smoke: a heap of billows that roll ------------------------------------------------------ */

static void start_smoke(struct kiln_fluid *fluid)
{
    fluid->swelling = 0.24f;
    fluid->drag = 1.0f;
    stir(fluid, 0.0f, 7.0f, 2.6f, 301);
}

static void drive_smoke(struct kiln_fluid *fluid, float time, float dt)
{
    stir(fluid, 2.5f * time, 15.0f * dt, 3.4f, 311);
}

static const struct kiln_film_gas SMOKE_GAS = {start_smoke, drive_smoke};

/* Computes the heights of the heap seen from the front; a power mean joins the domes. */
static void heap_heights(const struct texel_sites *s, const float *x, const float *y, float *height)
{
    for (uint32_t i = 0; i < s->count; i++)
        height[i] = 0.0f;
    for (uint32_t k = 0; k < TEXEL_LOBES; k++) {
        const struct texel_lobe lobe = s->lobes[k];
        for (uint32_t i = 0; i < s->count; i++) {
            float dx = x[i] - lobe.x, dy = y[i] - lobe.y;
            float squared = lobe.size * lobe.size - (dx * dx + dy * dy);
            float dome = squared > 0.0f ? 2.25f * squared : 0.0f; /* square of the dome's height */
            height[i] += dome * dome;
        }
    }
    for (uint32_t i = 0; i < s->count; i++)
        height[i] = sqrtf(sqrtf(height[i]));
}

#define SMOKE_REACH 0.95f /* the heap lies within this radius */

static void smoke_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float inside_v = inside(s->v);
    float x[TEXEL_ROW], y[TEXEL_ROW], warp[TEXEL_ROW], fine[TEXEL_ROW], coarse[TEXEL_ROW];
    const float *from_x = s->place_x, *from_y = s->place_y;
    detail_at(s, from_x, from_y, &(struct detail){2.4f, 5.0f, 0.0f, 0.6f, 3, 321}, warp);
    for (uint32_t i = 0; i < s->count; i++)
        x[i] = from_x[i] + 0.16f * warp[i];
    detail_at(s, x, from_y, &(struct detail){2.4f, 0.0f, 9.0f, 0.6f, 3, 323}, warp);
    for (uint32_t i = 0; i < s->count; i++)
        y[i] = from_y[i] + 0.16f * warp[i];
    heap_heights(s, x, y, out->height);
    detail_at(s, x, y, &(struct detail){5.5f, 0.0f, 0.0f, 1.0f, 4, 331}, fine);
    detail_at(s, x, y, &(struct detail){2.4f, 3.0f, 0.0f, 0.8f, 2, 341}, coarse);
    const float thin = texel_mix(0.05f, 0.16f, s->time), torn = texel_mix(0.5f, 1.1f, s->time);
    for (uint32_t i = 0; i < s->count; i++) {
        float away2 = from_x[i] * from_x[i] + from_y[i] * from_y[i];
        float height = out->height[i];
        height += 0.10f * fine[i] * texel_saturate(3.0f * height);
        float excess = height - thin + 0.30f * coarse[i] * torn + 0.12f * fine[i] -
                       0.5f * texel_smooth(0.5f, 0.9f, away2);
        out->height[i] = height;
        out->heat[i] = texel_saturate(excess);
        out->density[i] = texel_smooth(0.0f, 0.55f, excess) * (inside(s->u[i]) * inside_v);
    }
}

/* ---- puff: thin steam that drifts apart in wisps --------------------------------------------- */

static void start_puff(struct kiln_fluid *fluid)
{
    fluid->swelling = 0.35f;
    fluid->drag = 0.6f;
    heat_ball(fluid, 0.70f, 0.0f, 0.25f, 2.0f, 401);
    stir(fluid, 0.0f, 9.0f, 2.4f, 411);
}

static void drive_puff(struct kiln_fluid *fluid, float time, float dt)
{
    stir(fluid, 2.5f * time, 34.0f * dt, 3.2f, 421);
}

static const struct kiln_film_gas PUFF_GAS = {start_puff, drive_puff};

static void puff_texels(const struct texel_sites *restrict s, struct texels *restrict out)
{
    const float inside_v = inside(s->v);
    float wisps[TEXEL_ROW];
    detail_at(s, s->place_x, s->place_y, &(struct detail){2.6f, 0.0f, 0.0f, 0.5f, 5, 431}, wisps);
    const float thin = texel_mix(0.0f, 0.25f, s->time);
    for (uint32_t i = 0; i < s->count; i++) {
        float density = s->heat[i] * texel_saturate(0.55f + 1.5f * wisps[i]);
        float thinned = texel_saturate(density - thin);
        out->height[i] = 0.35f * density;
        out->heat[i] = density;
        out->density[i] = 0.8f * thinned * (inside(s->u[i]) * inside_v);
    }
}

const struct builtin_list KILN_SIMD_NAME(kiln_builtin_gases) = {{
    {"fire", &FIRE_GAS, fire_texels, .least_heat = 0.02f},
    {"flame", &FLAME_GAS, flame_texels, .least_heat = 0.1f},
    {"tongue", &TONGUE_GAS, flame_texels, .least_heat = 0.1f},
    {"smoke", &SMOKE_GAS, smoke_texels, .relief = 14.0f,
     .reach_squared = SMOKE_REACH * SMOKE_REACH},
    {"puff", &PUFF_GAS, puff_texels, .relief = 6.0f, .least_heat = 0.005f},
    {0},
}};
