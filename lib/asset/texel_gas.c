/* Flames, smoke and steam. The large shapes are those of a gas that flows; torn sheets and wisps
 * are noise over the places where the gas came from, so that they are stretched and folded with it;
 * and a threshold that rises with age eats the thin parts first (erosion). */
#include "asset/texel.h"
#include "asset/turbulence.h"

#include "shared/random.h"

#include <math.h>

/* 1 inside of the cell, 0 before its border. */
static float inside_cell(float u, float v)
{
    float x = texel_smooth(0.97f, 0.80f, fabsf(u)), y = texel_smooth(0.97f, 0.80f, fabsf(v));
    return x * y;
}

/* Turbulence that the coarse fluid cannot make by itself: vorticity of two sizes. */
static void stir(struct kiln_fluid *fluid, float time, float amount, float frequency, uint32_t seed)
{
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        float x = frequency * kiln_fluid_at(i % KILN_FLUID_EDGE);
        float y = frequency * kiln_fluid_at(i / KILN_FLUID_EDGE);
        float turning = kiln_noise(x, y, time, seed) +
                        0.8f * kiln_noise(2.3f * x, 2.3f * y, 1.4f * time, seed + 1);
        fluid->vorticity[i] += amount * turning;
    }
}

static void cool(struct kiln_fluid *fluid, float rate, float dt)
{
    float kept = 1.0f - rate * dt;
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++)
        fluid->heat[i] *= kept;
}

/* ---- flame: climbs from the cell's foot, parts from it and burns out ------------------------- */

static const float FLAME_FOOT = -0.80f, FLAME_RISE = 0.8f;

/* What feeds a flame: hot gas at the foot, of a width that grows at first, so that its head is no
 * mushroom, and that flickers. */
struct flame {
    float width; /* half of the source */
    float sway;
    float grain; /* places of the flicker in a half edge */
    uint32_t seed;
};

static void feed_flame(struct kiln_fluid *fluid, const struct flame *flame, float time)
{
    float strength = texel_smooth(-0.12f, 0.10f, time) * texel_smooth(0.66f, 0.40f, time);
    float width = flame->width * texel_mix(0.4f, 1.0f, texel_smooth(0.0f, 0.3f, time));
    float sway = flame->sway * kiln_noise(2.6f * time, 0.5f, 0.5f, flame->seed);
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        float x = kiln_fluid_at(i % KILN_FLUID_EDGE), y = kiln_fluid_at(i / KILN_FLUID_EDGE);
        float dx = (x - sway) / width, dy = (y - FLAME_FOOT) / 0.12f;
        float within = texel_smooth(1.0f, 0.2f, dx * dx + dy * dy);
        if (within <= 0.0f)
            continue;
        float flicker =
            0.55f + 1.3f * kiln_noise(flame->grain * x, 7.0f * time, 0.3f, flame->seed + 1);
        float given = within * strength * texel_saturate(flicker);
        if (given > fluid->heat[i])
            fluid->heat[i] = given;
        fluid->place_x[i] = texel_mix(fluid->place_x[i], x, within);
        fluid->place_y[i] = texel_mix(fluid->place_y[i], y - FLAME_RISE * time, within);
    }
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

/* One narrow tongue. */
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

static const struct texel NOTHING = {0.0f, 0.0f, 0.0f};

static struct texel flame_texel(const struct texel_site *s)
{
    if (s->heat < 0.1f)
        return NOTHING;
    float x = s->place_x, y = s->place_y;
    float warp = 0.12f * kiln_noise_octaves(3.0f * x, 3.0f * y, 0.8f * s->time, 2, 131);
    float sheets = kiln_noise_ridges(2.4f * (x + warp), 2.0f * (y + warp), 0.9f * s->time, 5, 141);
    float height = texel_smooth(-0.3f, 1.0f, s->v);
    float threshold = texel_mix(0.20f, 0.46f, s->time * s->time) + 0.12f * height;
    /* At the rim, where the air's places and the gas's meet, there is no detail. */
    float within = texel_smooth(0.12f, 0.55f, s->heat);
    float excess = s->heat + 1.2f * (sheets - 0.36f) * within - threshold;
    float foot = texel_smooth(-0.92f, -0.45f, s->v);
    float top = texel_smooth(0.97f, 0.5f, s->v);
    return (struct texel){
        .heat = texel_saturate(1.25f * excess),
        .density = texel_smooth(-0.04f, 0.42f, excess) * inside_cell(s->u, s->v) * foot * top,
    };
}

/* ---- fire: a ball of burning gas that rolls, swells and tears into sheets -------------------- */

static void start_fire(struct kiln_fluid *fluid)
{
    fluid->swelling = 0.30f;
    fluid->drag = 0.8f;
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        float x = kiln_fluid_at(i % KILN_FLUID_EDGE), y = kiln_fluid_at(i / KILN_FLUID_EDGE);
        float ragged = 0.22f * kiln_noise_octaves(2.6f * x, 2.6f * y, 0.0f, 3, 201);
        fluid->heat[i] = texel_smooth(0.66f, 0.30f, sqrtf(x * x + y * y) + ragged);
    }
    stir(fluid, 0.0f, 16.0f, 2.6f, 211);
}

static void drive_fire(struct kiln_fluid *fluid, float time, float dt)
{
    stir(fluid, 3.0f * time, 60.0f * dt, 3.6f, 221);
}

static const struct kiln_film_gas FIRE_GAS = {start_fire, drive_fire};

static struct texel fire_texel(const struct texel_site *s)
{
    if (s->heat < 0.02f)
        return NOTHING;
    float x = s->place_x, y = s->place_y;
    float warp_x = 0.18f * kiln_noise_octaves(3.0f * x + 5.0f, 3.0f * y, 0.4f * s->time, 2, 231);
    float warp_y = 0.18f * kiln_noise_octaves(3.0f * x, 3.0f * y + 9.0f, 0.4f * s->time, 2, 233);
    float sheets =
        kiln_noise_ridges(2.1f * (x + warp_x), 2.1f * (y + warp_y), 0.2f * s->time, 5, 241);
    float threshold = texel_mix(0.18f, 1.10f, 0.65f * s->time * s->time + 0.35f * s->time);
    float there = texel_saturate(4.0f * s->heat);
    float torn = texel_mix(1.15f, 0.80f, s->time); /* in the end, few thick shreds are left */
    float excess = 0.75f * s->heat + torn * (sheets - 0.34f) * there - threshold;
    return (struct texel){
        .heat = texel_saturate(1.2f * excess) * texel_saturate(0.3f + sheets),
        .density =
            texel_smooth(0.0f, texel_mix(0.26f, 0.45f, s->time), excess) * inside_cell(s->u, s->v),
    };
}

/* ---- smoke: a heap of billows that roll ---------------------------------------------------------
 */

static struct texel_lobe lobe_at(uint32_t index)
{
    uint stream = random_stream(0x10be5u, index);
    struct exact_angle angle = exact_sincos(EXACT_TWO_PI * random_unit(stream, 0));
    float away = 0.50f * exact_sqrt(random_unit(stream, 1));
    if (index == 0) /* the one in the middle */
        return (struct texel_lobe){0.0f, 0.0f, 0.52f};
    return (struct texel_lobe){away * angle.cosine, away * angle.sine,
                               0.18f + 0.26f * random_unit(stream, 2) * random_unit(stream, 4)};
}

void kiln_texel_lobes(struct texel_lobe lobes[TEXEL_LOBES])
{
    for (uint32_t i = 0; i < TEXEL_LOBES; i++)
        lobes[i] = lobe_at(i);
}

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

/* The heap seen from the front; a power mean joins the domes. */
static float heap_height(const struct texel_lobe *lobes, float x, float y)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < TEXEL_LOBES; i++) {
        float dx = x - lobes[i].x, dy = y - lobes[i].y;
        float squared = lobes[i].size * lobes[i].size - (dx * dx + dy * dy);
        float dome = squared > 0.0f ? 2.25f * squared : 0.0f; /* the square of its height */
        sum += dome * dome;
    }
    return sqrtf(sqrtf(sum));
}

static struct texel smoke_texel(const struct texel_site *s)
{
    float x = s->place_x, y = s->place_y;
    float away2 = x * x + y * y; /* the heap is within 0.95 */
    if (away2 > 0.95f * 0.95f)
        return NOTHING;
    x += 0.16f * kiln_noise_octaves(2.4f * x + 5.0f, 2.4f * y, 0.6f * s->time, 3, 321);
    y += 0.16f * kiln_noise_octaves(2.4f * x, 2.4f * y + 9.0f, 0.6f * s->time, 3, 323);
    float height = heap_height(s->lobes, x, y);
    float fine = kiln_noise_octaves(5.5f * x, 5.5f * y, s->time, 4, 331);
    float coarse = kiln_noise_octaves(2.4f * x + 3.0f, 2.4f * y, 0.8f * s->time, 2, 341);
    height += 0.10f * fine * texel_saturate(3.0f * height);
    float excess = height - texel_mix(0.05f, 0.16f, s->time) +
                   0.30f * coarse * texel_mix(0.5f, 1.1f, s->time) + 0.12f * fine -
                   0.5f * texel_smooth(0.5f, 0.9f, away2);
    return (struct texel){
        .height = height,
        .heat = texel_saturate(excess),
        .density = texel_smooth(0.0f, 0.55f, excess) * inside_cell(s->u, s->v),
    };
}

/* ---- puff: thin steam that drifts apart in wisps ------------------------------------------------
 */

static void start_puff(struct kiln_fluid *fluid)
{
    fluid->swelling = 0.35f;
    fluid->drag = 0.6f;
    for (uint32_t i = 0; i < KILN_FLUID_SIZE; i++) {
        float x = kiln_fluid_at(i % KILN_FLUID_EDGE), y = kiln_fluid_at(i / KILN_FLUID_EDGE);
        float ragged = 0.25f * kiln_noise_octaves(2.0f * x, 2.0f * y, 0.0f, 3, 401);
        fluid->heat[i] = texel_smooth(0.70f, 0.0f, sqrtf(x * x + y * y) + ragged);
    }
    stir(fluid, 0.0f, 9.0f, 2.4f, 411);
}

static void drive_puff(struct kiln_fluid *fluid, float time, float dt)
{
    stir(fluid, 2.5f * time, 34.0f * dt, 3.2f, 421);
}

static const struct kiln_film_gas PUFF_GAS = {start_puff, drive_puff};

static struct texel puff_texel(const struct texel_site *s)
{
    if (s->heat < 0.005f)
        return NOTHING;
    float wisps = kiln_noise_octaves(2.6f * s->place_x, 2.6f * s->place_y, 0.5f * s->time, 5, 431);
    float density = s->heat * texel_saturate(0.55f + 1.5f * wisps);
    float thinned = texel_saturate(density - texel_mix(0.0f, 0.25f, s->time));
    return (struct texel){
        .height = 0.35f * density,
        .heat = density,
        .density = 0.8f * thinned * inside_cell(s->u, s->v),
    };
}

const struct builtin kiln_builtin_gases[] = {
    {"fire", &FIRE_GAS, fire_texel, 0.0f},      {"flame", &FLAME_GAS, flame_texel, 0.0f},
    {"tongue", &TONGUE_GAS, flame_texel, 0.0f}, {"smoke", &SMOKE_GAS, smoke_texel, 14.0f},
    {"puff", &PUFF_GAS, puff_texel, 6.0f},      {0},
};
