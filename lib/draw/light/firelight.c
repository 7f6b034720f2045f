/* This file gathers the light of fire into a few point lights. The particles of a system are
 * gathered by their progress through life: each particle is shared between the two of the system's
 * lights that are nearest to its progress. Particles of one age are near each other in a jet, a
 * flame or a burst. Since ages grow evenly, a light moves and flickers with its part of the fire
 * and never jumps.
 *
 * Sums are taken over chunks of slots, whose number depends on the slots alone, and then over
 * the chunks, so that the result is the same for any number of threads. */
#include "draw/light/firelight.h"

#include <math.h>

#include "draw/light/light_blocks.h"

/* The part of a billboard's square that its cell fills with light. */
static const float CELL_FILL = 0.25f;

static const double PI = 3.14159265358979;

enum { MAX_CHUNKS = 16, MIN_CHUNK = 2048 /* slots */ };

struct system_lights {
    kiln_appearance_find *find;
    const struct kiln_light_loops *loops;
    struct kiln_appearance_system system;
    struct kiln_glow glow;
    uint32_t light_count;
    uint32_t chunks;
    struct kiln_light_sums lights[MAX_CHUNKS][KILN_MAX_FIRE_LIGHTS];
};

/* Finds the light of each particle of a block whose look has values over other clocks than life. */
static void find_own_glow(const struct kiln_appearance_system *system, uint32_t first,
                          const struct kiln_appearance_block *block, struct kiln_floats3 *own)
{
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_appearance particle;
        float3 glow = {0.0f, 0.0f, 0.0f};
        if (block->alive[i] && kiln_appearance_at(system, first + i, &particle))
            glow = kiln_appearance_glow(system, &particle.clocks);
        kiln_set3(own, i, glow);
    }
}

/* Gathers some chunks; each consists of whole blocks. */
static void gather_chunks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct system_lights *fire = context;
    const uint64_t blocks = (fire->system.used + KILN_LANES - 1) / KILN_LANES;
    struct kiln_appearance_block block;
    struct kiln_floats3 own;
    struct kiln_glow glow = fire->glow;
    glow.own = fire->system.program->count > 0 ? &own : NULL;
    for (size_t chunk = begin; chunk < end; chunk++) {
        uint64_t last = blocks * (chunk + 1) / fire->chunks;
        for (uint64_t k = blocks * chunk / fire->chunks; k < last; k++) {
            fire->find(&fire->system, (uint32_t)k * KILN_LANES, &block);
            if (fire->system.program->count > 0)
                find_own_glow(&fire->system, (uint32_t)k * KILN_LANES, &block, &own);
            fire->loops->gather_fire(&block, &glow, CELL_FILL, fire->light_count,
                                     fire->lights[chunk]);
        }
    }
}

static void sample_glow(struct system_lights *fire)
{
    for (uint32_t i = 0; i < KILN_LOOK_SAMPLES; i++) {
        struct value_clocks clocks = value_clocks_at(0.0f, 0, 0);
        clocks.life = (float)i / (float)(KILN_LOOK_SAMPLES - 1);
        const float3 glow = kiln_appearance_glow(&fire->system, &clocks);
        fire->glow.red[i] = glow.x;
        fire->glow.green[i] = glow.y;
        fire->glow.blue[i] = glow.z;
    }
}

static void add_sums(struct kiln_light_sums *sum, const struct kiln_light_sums *other)
{
    for (int c = 0; c < 3; c++) {
        sum->color[c] += other->color[c];
        sum->position[c] += other->position[c];
    }
    sum->energy += other->energy;
    sum->square += other->square;
    sum->radius += other->radius;
}

/* Gathers a system's lights; the sums are left in the first chunk. */
static void gather_system(struct system_lights *fire, struct kiln_threads *threads)
{
    uint32_t useful = fire->system.used / MIN_CHUNK + 1;
    fire->chunks = useful < MAX_CHUNKS ? useful : MAX_CHUNKS;
    kiln_threads_for(threads, fire->chunks, 1, gather_chunks, fire);
    for (uint32_t chunk = 1; chunk < fire->chunks; chunk++) {
        for (uint32_t k = 0; k < fire->light_count; k++)
            add_sums(&fire->lights[0][k], &fire->lights[chunk][k]);
    }
}

/* Makes a point light of gathered sums. A patch of radiance L and area A gives a surface that faces
 * it at distance d the irradiance L A / d^2. A light of colour c (the radiance of a white surface
 * at 1 m, irradiance over pi) gives it pi c / d^2. The light's radius is how far its particles are
 * spread, so that a surface among them is not lit by a point. */
static struct kiln_draw_light make_light(const struct kiln_light_sums *light, float3 strength,
                                         bool shadow)
{
    double mean[3], square = 0.0;
    for (int c = 0; c < 3; c++) {
        mean[c] = light->position[c] / light->energy;
        square += mean[c] * mean[c];
    }
    double radius = light->radius / light->energy;
    double spread = light->square / light->energy - square;
    const float radius2 = (float)(radius * radius + (spread > 0.0 ? spread : 0.0));
    return (struct kiln_draw_light){
        .position_radius2 = {(float)mean[0], (float)mean[1], (float)mean[2], radius2},
        .color = {strength.x * (float)(light->color[0] / PI),
                  strength.y * (float)(light->color[1] / PI),
                  strength.z * (float)(light->color[2] / PI), sqrtf(radius2)},
        .casters = {shadow ? 1 : 0, 0, 0, shadow ? 1 : 0},
    };
}

/* Returns the lights of a system with nothing gathered yet. */
static struct system_lights system_lights_of(const struct kiln_moment *moment, uint32_t system)
{
    struct system_lights fire = {.find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd),
                                 .loops = KILN_SIMD_PICK(kiln_light_loops, moment->simd),
                                 .system = kiln_appearance_system(moment, system),
                                 .light_count = moment->scene->systems[system].look.light_count};
    sample_glow(&fire);
    return fire;
}

uint32_t kiln_firelight_gather(const struct kiln_moment *moment, struct kiln_threads *threads,
                               struct kiln_draw_light *lights)
{
    const struct kiln_scene *scene = moment->scene;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        float3 strength = kiln_scene_system_value3(scene, i, &look->light, moment->view.clock.x);
        if (!scene->systems[i].enabled || !(strength.x + strength.y + strength.z > 0.0f))
            continue;
        struct system_lights fire = system_lights_of(moment, i);
        gather_system(&fire, threads);
        for (uint32_t k = 0; k < fire.light_count && count < KILN_MAX_FIRE_LIGHTS; k++) {
            if (fire.lights[0][k].energy > 0.0)
                lights[count++] = make_light(&fire.lights[0][k], strength, look->light_shadow);
        }
    }
    return count;
}
