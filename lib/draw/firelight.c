/* A system's particles are gathered by their progress through life: each belongs to the two nearest
 * of its lights, in parts. Particles of one age are near each other in a jet, a flame or a burst,
 * and since ages grow evenly a light moves and flickers with its part of the fire and never jumps.
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

struct gatherer {
    uint32_t count;
    struct gathering lights[KILN_MAX_FIRE_LIGHTS];
};

static void add_to_light(struct gathering *light, const struct kiln_living *particle, double weight)
{
    double area = 4.0 * (double)particle->radius * (double)particle->radius;
    double sent = weight * FILL * area * (double)particle->opacity;
    const float glow[3] = {particle->glow.x, particle->glow.y, particle->glow.z};
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

static void gather(void *context, const struct kiln_living *particle)
{
    struct gatherer *gatherer = context;
    double place = (double)particle->progress * (gatherer->count - 1);
    uint32_t first = (uint32_t)place;
    double part = place - first;
    add_to_light(&gatherer->lights[first], particle, 1.0 - part);
    if (part > 0.0)
        add_to_light(&gatherer->lights[first + 1], particle, part);
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

uint32_t kiln_firelight_gather(const struct kiln_scene *scene, const struct kiln_pool *pool,
                               const struct kiln_particle *records, const struct kiln_view *view,
                               const float4 *table, struct kiln_draw_light *lights)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        float3 strength = kiln_scene_value3(scene, &look->light, view->clock.x);
        if (!scene->systems[i].enabled || !(strength.x + strength.y + strength.z > 0.0f))
            continue;
        struct gatherer gatherer = {.count = look->light_count};
        kiln_living_visit(scene, pool, records, view, table, i, gather, &gatherer);
        for (uint32_t k = 0; k < gatherer.count && count < KILN_MAX_FIRE_LIGHTS; k++) {
            if (gatherer.lights[k].energy > 0.0)
                lights[count++] = make_light(&gatherer.lights[k], strength);
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
