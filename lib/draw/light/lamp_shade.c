/* This file visits all lit particles in blocks, for their shade from lamps (shade_simd.c).
 * Every drawing technique reads the same result. */
#include "draw/light/lamp_shade.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/shade_blocks.h"
#include "draw/light/sun_shade.h"
#include "scene/work.h"

enum { GRAIN = 8 * KILN_LANES /* slots that a worker takes at a time */, LIGHTS_OF_WORD = 4 };

struct kiln_lamp_shade {
    const struct kiln_scene *scene;
    struct kiln_shape_set casters[KILN_MOST_LAMPS]; /* by lamp */
    uint32_t *words;
    size_t room; /* of words */
};

bool kiln_lamp_shade_exists(const struct kiln_scene *scene)
{
    bool lit = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        lit |= kiln_sun_shade_concerns(scene, i);
    return lit && (scene->backdrop.object_count > 0 || kiln_shape_features(scene).solids) &&
           kiln_scene_shadow_lights(scene) > 0;
}

struct kiln_lamp_shade *kiln_lamp_shade_create(const struct kiln_scene *scene,
                                               struct kiln_error *error)
{
    struct kiln_lamp_shade *shade = calloc(1, sizeof *shade);
    if (shade)
        shade->scene = scene;
    else
        kiln_error_no_memory(error, "the shade of particles");
    return shade;
}

void kiln_lamp_shade_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_lamp_shade *s = NULL;
    const uint64_t planes = (kiln_scene_shadow_lights(scene) + LIGHTS_OF_WORD - 1) / LIGHTS_OF_WORD;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, kiln_work_particles(scene),
                       (planes ? planes : 1) * sizeof *s->words);
}

void kiln_lamp_shade_destroy(struct kiln_lamp_shade **shade)
{
    if (!*shade)
        return;
    free((*shade)->words);
    free(*shade);
    *shade = NULL;
}

/* Describes the system whose particles are being shaded. */
struct shade_job {
    kiln_appearance_find *find;
    kiln_lamp_shade_block *shade;
    const struct kiln_lamp_objects *objects;
    const struct kiln_draw_light *lights;
    const struct kiln_shape_set *casters; /* of each light */
    uint32_t light_count;
    struct kiln_appearance_system system;
    uint32_t *words; /* of the system's first slot, in the first plane */
    size_t plane;    /* words of a plane */
};

static void shade_block(const struct shade_job *job, uint32_t first)
{
    struct kiln_appearance_block block;
    uint32_t words[KILN_LANES];
    const uint32_t left = job->system.used - first;
    job->find(&job->system, first, &block);
    uint32_t *to = job->words + first;
    for (uint32_t light = 0; light < job->light_count; light += LIGHTS_OF_WORD) {
        const uint32_t rest = job->light_count - light;
        job->shade(job->objects, job->lights + light, job->casters + light,
                   rest < LIGHTS_OF_WORD ? rest : LIGHTS_OF_WORD, &block, words);
        memcpy(to, words, (left < KILN_LANES ? left : KILN_LANES) * sizeof *words);
        to += job->plane;
    }
}

static void shade_slots(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t slot = begin; slot < end; slot += KILN_LANES)
        shade_block(context, (uint32_t)slot);
}

static bool reserve(struct kiln_lamp_shade *shade, size_t words, struct kiln_error *error)
{
    if (words <= shade->room)
        return true;
    free(shade->words);
    shade->words = calloc(words, sizeof *shade->words);
    shade->room = shade->words ? words : 0;
    if (!shade->words)
        return kiln_error_no_memory(error, "the shade of particles");
    return true;
}

const uint32_t *kiln_lamp_shade_run(struct kiln_lamp_shade *shade, const struct kiln_moment *moment,
                                    struct kiln_threads *threads,
                                    const struct kiln_draw_light *lights, uint32_t light_count,
                                    const uint32_t *maps, const uint32_t *solid_maps,
                                    struct kiln_error *error)
{
    const size_t plane = kiln_lamp_shade_plane(moment->pool->slot_count);
    const size_t planes = (light_count + LIGHTS_OF_WORD - 1) / LIGHTS_OF_WORD;
    if (!reserve(shade, plane * (planes ? planes : 1), error))
        return NULL;
    const struct kiln_lamp_objects objects = {
        .shapes = &moment->shapes,
        .maps = maps,
        .solid_maps = solid_maps,
    };
    for (uint32_t i = 0; i < light_count; i++)
        shade->casters[i] = kiln_shape_set_of_lamp(&lights[i], moment->shapes.counts.x);
    for (uint32_t i = 0; i < shade->scene->system_count; i++) {
        if (!kiln_sun_shade_concerns(shade->scene, i))
            continue;
        struct shade_job job = {.find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd),
                                .shade = KILN_SIMD_PICK(kiln_lamp_shade_block, moment->simd),
                                .objects = &objects,
                                .lights = lights,
                                .casters = shade->casters,
                                .light_count = light_count,
                                .system = kiln_appearance_system(moment, i),
                                .words = shade->words + moment->pool->systems[i].base,
                                .plane = plane};
        kiln_threads_for(threads, job.system.used, GRAIN, shade_slots, &job);
    }
    return shade->words;
}
