/* A system's particles are gathered by their progress through life: each belongs to the two nearest
 * of its lights, in parts. Particles of one age are near each other in a jet, a flame or a burst,
 * and since ages grow evenly a light moves and flickers with its part of the fire and never jumps.
 *
 * Sums are taken over stretches of slots, as many as the slots ask for, and then over the
 * stretches: the same for any number of threads.
 */
#include "draw/firelight.h"

#include <math.h>

/* The part of a billboard's square that its cell fills with light. */
static const double FILL = 0.25;

static const double PI = 3.14159265358979;

/* Sums over the particles of one light. */
struct gathering {
    double color[3];    /* light sent, m^2 */
    double energy;      /* of all channels: the weight of what follows */
    double position[3]; /* m */
    double square;      /* of the distance from the origin, m^2 */
    double radius;      /* of a particle, m */
};

enum { MOST_STRETCHES = 16, LEAST_STRETCH = 2048 /* slots */ };

struct gatherer {
    struct kiln_living_system system;
    uint32_t light_count;
    uint32_t stretches;
    struct gathering lights[MOST_STRETCHES][KILN_MAX_FIRE_LIGHTS];
};

static void add_to_light(struct gathering *light, const struct kiln_living *particle,
                         float3 emitted, double weight)
{
    double area = 4.0 * (double)particle->radius * (double)particle->radius;
    double sent = weight * FILL * area * (double)particle->opacity;
    const float glow[3] = {emitted.x, emitted.y, emitted.z};
    const float position[3] = {particle->position.x, particle->position.y, particle->position.z};
    double energy = 0.0;
    for (int c = 0; c < 3; c++) {
        light->color[c] += sent * (double)glow[c];
        energy += sent * (double)glow[c];
    }
    light->energy += energy;
    light->radius += energy * (double)particle->radius;
    for (int c = 0; c < 3; c++) {
        light->position[c] += energy * (double)position[c];
        light->square += energy * (double)position[c] * (double)position[c];
    }
}

static void gather_stretches(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct gatherer *gatherer = context;
    const struct kiln_living_system *system = &gatherer->system;
    for (size_t stretch = begin; stretch < end; stretch++) {
        struct gathering *lights = gatherer->lights[stretch];
        uint32_t slot = (uint32_t)((uint64_t)system->used * stretch / gatherer->stretches);
        uint32_t last = (uint32_t)((uint64_t)system->used * (stretch + 1) / gatherer->stretches);
        for (; slot < last; slot++) {
            struct kiln_living particle;
            if (!kiln_living_at(system, slot, &particle))
                continue;
            float3 emitted = kiln_living_glow(system, particle.progress);
            double place = (double)particle.progress * (gatherer->light_count - 1);
            uint32_t first = (uint32_t)place;
            double part = place - first;
            add_to_light(&lights[first], &particle, emitted, 1.0 - part);
            if (part > 0.0)
                add_to_light(&lights[first + 1], &particle, emitted, part);
        }
    }
}

static void add_gathering(struct gathering *sum, const struct gathering *other)
{
    for (int c = 0; c < 3; c++) {
        sum->color[c] += other->color[c];
        sum->position[c] += other->position[c];
    }
    sum->energy += other->energy;
    sum->square += other->square;
    sum->radius += other->radius;
}

/* Leaves the sums in the first stretch. */
static void gather_system(struct gatherer *gatherer, struct kiln_threads *threads)
{
    uint32_t useful = gatherer->system.used / LEAST_STRETCH + 1;
    gatherer->stretches = useful < MOST_STRETCHES ? useful : MOST_STRETCHES;
    kiln_threads_for(threads, gatherer->stretches, 1, gather_stretches, gatherer);
    for (uint32_t stretch = 1; stretch < gatherer->stretches; stretch++) {
        for (uint32_t k = 0; k < gatherer->light_count; k++)
            add_gathering(&gatherer->lights[0][k], &gatherer->lights[stretch][k]);
    }
}

/* A patch of radiance L and area A lights a surface that faces it at distance d by L A / d^2; a
 * light of colour c (what arrives at 1 m, over pi) by pi c / d^2. The light's radius is how far its
 * particles are spread, so that a surface among them is not lit by a point. */
static struct kiln_draw_light make_light(const struct gathering *light, float3 strength)
{
    double mean[3], square = 0.0;
    for (int c = 0; c < 3; c++) {
        mean[c] = light->position[c] / light->energy;
        square += mean[c] * mean[c];
    }
    double radius = light->radius / light->energy;
    double spread = light->square / light->energy - square;
    return (struct kiln_draw_light){
        .position_radius2 = {(float)mean[0], (float)mean[1], (float)mean[2],
                             (float)(radius * radius + (spread > 0.0 ? spread : 0.0))},
        .color = {strength.x * (float)(light->color[0] / PI),
                  strength.y * (float)(light->color[1] / PI),
                  strength.z * (float)(light->color[2] / PI), 0.0f},
    };
}

uint32_t kiln_firelight_gather(const struct kiln_living_moment *moment,
                               struct kiln_threads *threads, struct kiln_draw_light *lights)
{
    const struct kiln_scene *scene = moment->scene;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        float3 strength = kiln_scene_value3(scene, &look->light, moment->view->clock.x);
        if (!scene->systems[i].enabled || !(strength.x + strength.y + strength.z > 0.0f))
            continue;
        struct gatherer gatherer = {.system = kiln_living_system(moment, i),
                                    .light_count = look->light_count};
        gather_system(&gatherer, threads);
        for (uint32_t k = 0; k < gatherer.light_count && count < KILN_MAX_FIRE_LIGHTS; k++) {
            if (gatherer.lights[0][k].energy > 0.0)
                lights[count++] = make_light(&gatherer.lights[0][k], strength);
        }
    }
    return count;
}

bool kiln_firelight_exists(const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_value3 *light = &scene->systems[i].look.light;
        if (scene->systems[i].enabled && (kiln_scene_value_max(scene, &light->x) > 0.0f ||
                                          kiln_scene_value_max(scene, &light->y) > 0.0f ||
                                          kiln_scene_value_max(scene, &light->z) > 0.0f))
            return true;
    }
    return false;
}
