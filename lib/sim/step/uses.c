/* This file finds out what the systems of a program use of a step's code, so that the driver's
 * compiler gets no more. Each mask has a bit for a part that any system uses at any time: a part
 * that is left out wrongly would be a wrong state. */
#include "sim/step/uses.h"

#include "base/text.h"
#include "shared/uses.h"
#include "sim/world/colliders.h"

struct uses {
    uint keys, forces, emitters, collide, births;
};

static uint bit(uint part, bool used)
{
    return used ? 1u << part : 0u;
}

static bool has_keys(const struct kiln_value *value)
{
    return value->count > 0;
}

static bool has_keys3(const struct kiln_value3 *value)
{
    return has_keys(&value->x) || has_keys(&value->y) || has_keys(&value->z);
}

/* Values of a step are evaluated by the host but for curves over a particle's life. */
static bool has_curve(const struct kiln_value *value)
{
    return has_keys(value) && value->clock == KILN_CLOCK_LIFE;
}

static bool has_curve3(const struct kiln_value3 *value)
{
    return has_curve(&value->x) || has_curve(&value->y) || has_curve(&value->z);
}

static uint keys_of_births(const struct kiln_step_params *step)
{
    const struct kiln_emit_params *emit = &step->emit;
    const struct kiln_range *life = &step->derived.life, *speed = &emit->speed;
    return bit(KEYED_LIFE, has_keys(&life->min) || has_keys(&life->max)) |
           bit(KEYED_SPEED, has_keys(&speed->min) || has_keys(&speed->max)) |
           bit(KEYED_ORIGIN, has_keys3(&emit->origin)) |
           bit(KEYED_DIRECTION, has_keys3(&emit->direction)) |
           bit(KEYED_SIZE, has_keys3(&emit->size)) | bit(KEYED_ANGLE, has_keys(&emit->angle)) |
           bit(KEYED_RADIUS, has_keys(&emit->radius)) |
           bit(KEYED_INHERIT, has_keys(&emit->inherit)) | bit(KEYED_TURN, has_keys(&emit->turn));
}

static uint keys_of_impacts(const struct kiln_collide *collide)
{
    return bit(KEYED_RANDOMNESS, has_curve(&collide->randomness)) |
           bit(KEYED_SLOWDOWN, has_curve(&collide->slowdown)) |
           bit(KEYED_RESTITUTION, has_curve(&collide->restitution)) |
           bit(KEYED_FRICTION, has_curve(&collide->friction));
}

static uint keys_of_force(const struct kiln_force *force)
{
    return bit(KEYED_FORCE_VECTOR, has_curve3(&force->vector)) |
           bit(KEYED_FORCE_SECOND, has_curve3(&force->second)) |
           bit(KEYED_FORCE_STRENGTH, has_curve(&force->strength)) |
           bit(KEYED_FORCE_PULL, has_curve(&force->pull)) |
           bit(KEYED_FORCE_QUADRATIC, has_curve(&force->quadratic)) |
           bit(KEYED_FORCE_SCALE, has_curve(&force->scale));
}

uint kiln_sim_colliders_used(const struct kiln_scene *scene)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    uint used = bit(COLLIDER_BOX, kiln_backdrop_floor_collides(backdrop));
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        if (object->collide)
            used |= 1u << kiln_sim_collider_kind(object);
    }
    return used;
}

static void add_system(struct uses *uses, const struct kiln_scene *scene,
                       const struct kiln_step_params *step, const struct kiln_system *system)
{
    uses->keys |= keys_of_births(step) | keys_of_impacts(&system->collide);
    uses->emitters |= 1u << step->emit.shape;
    uses->births |= 1u << step->family.born_of;
    if (kiln_sim_colliders_used(scene) != 0)
        uses->collide |= 1u << step->collide;
    for (uint32_t i = 0; i < system->force_count; i++) {
        uses->keys |= keys_of_force(&system->forces[i]);
        uses->forces |= 1u << (uint)system->forces[i].kind;
    }
}

void kiln_sim_add_uses(struct kiln_text *defines, const struct kiln_scene *scene,
                       const struct kiln_sim_params *params, bool families)
{
    struct uses uses = {.keys = 0};
    for (uint32_t i = 0; i < params->system_count; i++) {
        const struct kiln_step_params *step = &params->systems[i];
        if (kiln_sim_is_family(step) == families)
            add_system(&uses, scene, step, &scene->systems[i]);
    }
    kiln_text_add(defines,
                  "#define USES_KEYS %uu\n#define USES_FORCES %uu\n#define USES_EMITTERS %uu\n"
                  "#define USES_COLLIDERS %uu\n#define USES_COLLIDE %uu\n"
                  "#define USES_BIRTHS %uu\n#define USES_INTEGRATION %uu\n",
                  uses.keys, uses.forces, uses.emitters, kiln_sim_colliders_used(scene),
                  uses.collide, uses.births, (uint)scene->integration);
}
