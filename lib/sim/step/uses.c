/* This file finds out what the systems of a program use of a step's code, so that the driver's
 * compiler gets no more. Each mask has a bit for a part that any system uses at any time: a part
 * that is left out wrongly would be a wrong state. */
#include "sim/step/uses.h"

#include "base/text.h"
#include "shared/uses.h"
#include "sim/world/colliders.h"

struct uses {
    uint keys, clocks, forces, emitters, collide, births, thens, demitters;
};

static uint bit(uint part, bool used)
{
    return used ? 1u << part : 0u;
}

/* Adds a value that kernels evaluate, whatever it varies over. uses: kiln_value_uses. */
static void add_value(struct uses *all, uint keyed, uint uses)
{
    all->keys |= bit(keyed, uses != 0);
    all->clocks |= uses;
}

/* Adds a value of a step, which the host evaluates if it is the same for all particles. */
static void add_curve(struct uses *all, uint keyed, uint uses)
{
    if (uses & KILN_VALUE_OF_PARTICLES)
        add_value(all, keyed, uses);
}

static void add_births(struct uses *uses, const float4 *keys, const struct kiln_step_params *step)
{
    const struct kiln_emit_params *emit = &step->emit;
    add_value(uses, KEYED_LIFE, kiln_range_uses(keys, &step->derived.life));
    add_value(uses, KEYED_SPEED, kiln_range_uses(keys, &emit->speed));
    add_value(uses, KEYED_ORIGIN, kiln_value3_uses(keys, &emit->origin));
    add_value(uses, KEYED_DIRECTION, kiln_value3_uses(keys, &emit->direction));
    add_value(uses, KEYED_SIZE, kiln_value3_uses(keys, &emit->size));
    add_value(uses, KEYED_ANGLE, kiln_value_uses(keys, &emit->angle));
    add_value(uses, KEYED_RADIUS, kiln_value_uses(keys, &emit->radius));
    add_value(uses, KEYED_INHERIT, kiln_value_uses(keys, &emit->inherit));
    add_value(uses, KEYED_TURN, kiln_value_uses(keys, &emit->turn));
    uses->clocks |= kiln_value_uses(keys, &step->family.rate);
}

static void add_impacts(struct uses *uses, const float4 *keys, const struct kiln_collide *collide)
{
    add_curve(uses, KEYED_RANDOMNESS, kiln_value_uses(keys, &collide->randomness));
    add_curve(uses, KEYED_SLOWDOWN, kiln_value_uses(keys, &collide->slowdown));
    add_curve(uses, KEYED_RESTITUTION, kiln_value_uses(keys, &collide->restitution));
    add_curve(uses, KEYED_FRICTION, kiln_value_uses(keys, &collide->friction));
    add_curve(uses, KEYED_CHANCE, kiln_value_uses(keys, &collide->chance));
}

static void add_force(struct uses *uses, const float4 *keys, const struct kiln_force *force)
{
    add_curve(uses, KEYED_FORCE_VECTOR, kiln_value3_uses(keys, &force->vector));
    add_curve(uses, KEYED_FORCE_SECOND, kiln_value3_uses(keys, &force->second));
    add_curve(uses, KEYED_FORCE_STRENGTH, kiln_value_uses(keys, &force->strength));
    add_curve(uses, KEYED_FORCE_PULL, kiln_value_uses(keys, &force->pull));
    add_curve(uses, KEYED_FORCE_QUADRATIC, kiln_value_uses(keys, &force->quadratic));
    add_curve(uses, KEYED_FORCE_SCALE, kiln_value_uses(keys, &force->scale));
    uses->forces |= 1u << kiln_force_number(force) | bit(FORCE_IN_REGION, force->region.enabled);
    uses->forces |=
        bit(FORCE_IN_NODE, force->attach.name != NULL || force->region.attach.name != NULL);
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
    add_births(uses, scene->keys, step);
    add_impacts(uses, scene->keys, &system->collide);
    uses->emitters |= 1u << step->emit.shape | bit(EMIT_ATTACHED, step->emit.attached != 0) |
                      bit(EMIT_ORDERED, step->emit.order != ORDER_RANDOM) |
                      bit(EMIT_CARRIED, step->carried != 0);
    uses->births |= 1u << step->family.born_of;
    uses->thens |= 1u << step->family.then;
    if (kiln_sim_colliders_used(scene) != 0)
        uses->collide |= 1u << step->collide;
    for (uint32_t i = 0; i < system->force_count; i++)
        add_force(uses, scene->keys, &system->forces[i]);
    for (uint32_t i = 0; i < system->demitter_count; i++)
        uses->demitters |= bit(DEMITTER_IN_NODE, system->demitters[i].attach.name != NULL);
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
                  "#define USES_KEYS %uu\n#define USES_CLOCKS %uu\n#define USES_FORCES "
                  "%uu\n#define USES_EMITTERS %uu\n"
                  "#define USES_COLLIDERS %uu\n#define USES_COLLIDE %uu\n"
                  "#define USES_BIRTHS %uu\n#define USES_THEN %uu\n#define USES_DEMITTERS %uu\n"
                  "#define USES_INTEGRATION %uu\n",
                  uses.keys, uses.clocks, uses.forces, uses.emitters,
                  kiln_sim_colliders_used(scene), uses.collide, uses.births, uses.thens,
                  uses.demitters, (uint)scene->integration);
}

void kiln_sim_add_bake_uses(struct kiln_text *defines, const struct kiln_scene *scene,
                            const struct kiln_sim_grids *grids)
{
    struct uses uses = {.keys = 0};
    for (uint32_t i = 0; i < grids->wind_count - grids->file_count; i++) {
        const struct kiln_baked_forces *of = &grids->baked[i]->of;
        for (uint32_t k = 0; k < of->count; k++)
            add_force(&uses, scene->keys, &of->at[k]);
    }
    kiln_text_add(defines,
                  "#define USES_KEYS 0u\n#define USES_CLOCKS 0u\n#define USES_FORCES %uu\n"
                  "#define USES_INTEGRATION %uu\n",
                  uses.forces, (uint)scene->integration);
}
