/* This file turns a scene at one time into struct kiln_step_params, the parameters of a step. It
 * also counts the births of the step on the host. */
#include "sim/world/params.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "base/error.h"
#include "scene/scene_births.h"
#include "scene/source.h"
#include "shared/exact.h"
#include "shared/forces.h"
#include "shared/random.h"
#include "shared/trace.h"
#include "sim/world/colliders.h"
#include "sim/world/emit_frame.h"
#include "sim/world/force_params.h"
#include "sim/world/posed_births.h"

static_assert(sizeof(struct kiln_value) == 16, "std140");
static_assert(sizeof(struct kiln_derived_params) == 48, "std140");
static_assert(sizeof(struct kiln_emit_params) == 368, "std140");
static_assert(sizeof(struct kiln_still_frame) == 32, "std140");
static_assert(sizeof(struct kiln_force_params) == 288, "std140");
static_assert(sizeof(struct kiln_birth_group) == 16, "std140");
static_assert(offsetof(struct kiln_step_params, step) == 416, "std140");
static_assert(offsetof(struct kiln_step_params, randomness) == 480, "std140");
static_assert(offsetof(struct kiln_step_params, pushed) == 548, "std140");
static_assert(offsetof(struct kiln_step_params, bounds_min) == 592, "std140");
static_assert(offsetof(struct kiln_step_params, groups) == 1136, "std140");
static_assert(offsetof(struct kiln_step_params, forces) == 2192, "std140");
static_assert(offsetof(struct kiln_step_params, family) == 11408, "std140");
static_assert(offsetof(struct kiln_step_params, carry) == 11520, "std140");
static_assert(sizeof(struct kiln_step_params) == 11664, "std140");
static_assert(sizeof(struct kiln_step_params) <= 16384, "what every GL allows a uniform block");
static_assert(KILN_SURROUNDINGS_BLOCK <= 16384, "what every GL allows a uniform block");
static_assert(sizeof(struct kiln_trace) == 112, "std430");
static_assert(offsetof(struct kiln_surroundings, colliders) == 16, "std140");
static_assert(sizeof(struct kiln_grid) == 80, "std140");
static_assert(sizeof(struct kiln_collider) == 208, "std140");
static_assert(sizeof(struct kiln_pose) == 160, "std140");

static_assert(KILN_MAX_BIRTH_GROUPS == KILN_MAX_BURSTS + 2, "the rate, the way and each burst");
static_assert(KILN_MAX_COLLIDERS == KILN_MAX_OBJECTS + 1, "each object and the floor");

static_assert(EMIT_POINT == (uint)KILN_EMITTER_POINT && EMIT_SPHERE == (uint)KILN_EMITTER_SPHERE &&
                  EMIT_BOX == (uint)KILN_EMITTER_BOX && EMIT_DISC == (uint)KILN_EMITTER_DISC &&
                  EMIT_CONE == (uint)KILN_EMITTER_CONE && EMIT_LINE == (uint)KILN_EMITTER_LINE,
              "the shaders' names of enum kiln_emitter_shape");
static_assert(INTEGRATE_SEMI_IMPLICIT == (uint)KILN_INTEGRATE_SEMI_IMPLICIT &&
                  INTEGRATE_POSITION_FIRST == (uint)KILN_INTEGRATE_POSITION_FIRST &&
                  INTEGRATE_TRAPEZOID == (uint)KILN_INTEGRATE_TRAPEZOID &&
                  INTEGRATE_RK4 == (uint)KILN_INTEGRATE_RK4,
              "the shaders' names of enum kiln_integration");
static_assert(BORN_OF_DEATH == 1 + (uint)KILN_EVENT_DEATH &&
                  BORN_OF_BOUNCE == 1 + (uint)KILN_EVENT_BOUNCE &&
                  BORN_OF_TRAIL == 1 + (uint)KILN_EVENT_TRAIL,
              "the shaders' names of enum kiln_event");
static_assert(ALIGN_WORLD == (uint)KILN_ALIGN_WORLD &&
                  ALIGN_VELOCITY == (uint)KILN_ALIGN_VELOCITY &&
                  ALIGN_NORMAL == (uint)KILN_ALIGN_NORMAL,
              "the shaders' names of enum kiln_align");

static_assert(THEN_BOUNCE == (uint)KILN_THEN_BOUNCE && THEN_DIE == (uint)KILN_THEN_DIE &&
                  THEN_STOP == (uint)KILN_THEN_STOP && THEN_STICK == (uint)KILN_THEN_STICK,
              "the shaders' names of enum kiln_then");

static float4 to_float4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

static uint shape_of(const struct kiln_emitter *emit)
{
    switch (emit->shape) {
    case KILN_EMITTER_RING:
        return EMIT_DISC;
    case KILN_EMITTER_MESH:
        if (emit->source.on == KILN_ON_VERTICES)
            return EMIT_VERTICES;
        if (emit->source.on == KILN_ON_VOLUME)
            return EMIT_COLUMNS;
        return emit->source.made && emit->source.made->corners ? EMIT_POSED : EMIT_TRIANGLES;
    case KILN_EMITTER_IMAGE:
        return EMIT_IMAGE;
    case KILN_EMITTER_PATH:
        return EMIT_PATH;
    default:
        return (uint)emit->shape;
    }
}

static uint order_of(const struct kiln_emitter *emit)
{
    const bool closed = emit->shape == KILN_EMITTER_RING ||
                        (emit->shape == KILN_EMITTER_PATH && emit->source.path.closed);
    if (!emit->ordered)
        return ORDER_RANDOM;
    return closed ? ORDER_CLOSED : ORDER_OPEN;
}

void kiln_sim_emitter_fill(struct kiln_emit_params *params, const struct kiln_emitter *emit)
{
    const bool ring = emit->shape == KILN_EMITTER_RING;
    *params = (struct kiln_emit_params){
        .shape = shape_of(emit),
        .outward = emit->outward,
        .surface = ring || emit->surface,
        .nozzles = emit->nozzles,
        .speed = emit->speed,
        .origin = emit->origin,
        .direction = emit->direction,
        .size = emit->size,
        .angle = emit->angle,
        .radius = emit->radius,
        .inherit = emit->inherit,
        .turn = emit->turn,
        .attached = emit->attach.name != NULL || emit->source.of_object,
        .cells = emit->source.made ? emit->source.made->cells : 0,
        .order = order_of(emit),
    };
    if (params->shape == EMIT_IMAGE || params->shape == EMIT_COLUMNS)
        params->size.x = (struct kiln_value){.constant = emit->source.edge};
}

static uint collide_kind(const struct kiln_collide *collide)
{
    if (!collide->enabled)
        return COLLIDE_OFF;
    return collide->mode == KILN_COLLIDE_CLAMP ? COLLIDE_CLAMP : COLLIDE_SWEPT;
}

static bool is_one(const struct kiln_value *value)
{
    return value->count == 0 && value->constant == 1.0f;
}

/* Returns whether impacts do more than mirror a velocity: with friction or a restitution below 1.
 */
static bool rubs(const struct kiln_scene *scene, const struct kiln_collide *collide)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    const struct kiln_value *friction = &collide->friction;
    bool any = !is_one(&collide->restitution) || friction->count > 0 || friction->constant != 0.0f;
    any = any || (kiln_backdrop_floor_collides(backdrop) && !is_one(&backdrop->floor_restitution));
    for (uint32_t i = 0; i < backdrop->object_count; i++)
        any = any || (backdrop->objects[i].collide && !is_one(&backdrop->objects[i].restitution));
    return collide->enabled && any;
}

static uint what_force_does(const struct kiln_force *force)
{
    if (force->kind == KILN_FORCE_LIMIT)
        return FORCES_LIMIT;
    const bool none = force->quadratic.count == 0 && force->quadratic.constant == 0.0f;
    return force->kind == KILN_FORCE_DRAG && !none ? FORCES_SLOW : 0;
}

/* Returns whether kernels have a kind of force only if they are compiled with FORCES_ALL. */
static bool is_of_all_forces(enum kiln_force_kind kind)
{
    bool found = false;
#define FORCES_ROW(id, function) found = found || (uint)kind == (id);
    FORCES_MORE(FORCES_ROW)
#undef FORCES_ROW
    return found;
}

bool kiln_sim_needs_all_forces(const struct kiln_scene *scene)
{
    bool any = scene->integration >= KILN_INTEGRATE_TRAPEZOID;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            const struct kiln_force *force = &system->forces[k];
            any = any || is_of_all_forces(force->kind) || what_force_does(force) == FORCES_SLOW;
        }
    }
    return any;
}

bool kiln_sim_bakes_need_all_forces(const struct kiln_scene *scene,
                                    const struct kiln_sim_grids *grids)
{
    bool any = scene->integration >= KILN_INTEGRATE_TRAPEZOID;
    for (uint32_t i = grids->file_count; i < grids->wind_count; i++) {
        const struct kiln_baked_forces *of = &grids->baked[i - grids->file_count]->of;
        for (uint32_t k = 0; k < of->count; k++)
            any = any || is_of_all_forces(of->at[k].kind);
    }
    return any;
}

static void fill_system(struct kiln_step_params *params, const struct kiln_scene *scene,
                        uint32_t index)
{
    const struct kiln_system *system = &scene->systems[index];
    *params = (struct kiln_step_params){
        .derived = kiln_scene_derived(scene, index),
        .force_count = system->force_count,
        .integration = (uint)scene->integration,
        .collide = collide_kind(&system->collide),
        .demitter_count = system->demitter_count,
        .bounded = system->bounds.enabled,
        .noise_seed = random_noise_key(scene->seed),
        .bounds_min = to_float4(system->bounds.min),
        .bounds_max = to_float4(system->bounds.max),
        .rubs = rubs(scene, &system->collide),
        .carried = system->space.name != NULL,
    };
    kiln_sim_emitter_fill(&params->emit, &system->emit);
    for (uint32_t i = 0; i < system->force_count; i++)
        params->forces_do |= what_force_does(&system->forces[i]);
    for (uint32_t i = 0; i < system->demitter_count; i++) {
        params->demitter_min[i] = to_float4(system->demitters[i].box.min);
        params->demitter_max[i] = to_float4(system->demitters[i].box.max);
    }
}

static uint then_of(const struct kiln_collide *collide)
{
    if (!collide->enabled)
        return THEN_BOUNCE;
    return collide->dies ? THEN_DIE : (uint)collide->then;
}

bool kiln_sim_is_traced(const struct kiln_scene *scene, uint32_t system)
{
    return kiln_family_has_children(scene, system) || kiln_scene_paints(scene, system);
}

/* Fills in the family parameters. Parents come first, so that their traces have places before their
 * children's are filled in. */
static void fill_families(struct kiln_sim_params *params, const struct kiln_scene *scene)
{
    params->trace_count = 0;
    kiln_family_order(scene, params->order);
    for (uint32_t k = 0; k < scene->system_count; k++) {
        uint32_t index = params->order[k];
        const struct kiln_system *system = &scene->systems[index];
        const struct kiln_parent *parent = &system->emit.parent;
        struct kiln_family_params *family = &params->systems[index].family;
        *family = (struct kiln_family_params){
            .then = then_of(&system->collide),
            .keeps = kiln_look_lies(&system->look) ? FAMILY_KEEPS_NORMALS : 0,
        };
        if (parent->enabled) {
            const bool by_metre = parent->event == KILN_EVENT_TRAIL && parent->per_metre > 0;
            family->born_of = by_metre ? BORN_OF_WAY : 1 + (uint)parent->event;
            family->per_metre = (float)parent->per_metre;
            family->align = (uint)parent->align;
            family->slots = parent->slots;
            family->rate = parent->rate;
            family->fewest = parent->count[0];
            family->most = parent->count[1];
            family->impacts = parent->impact;
            family->parent_traces = params->systems[parent->system].family.traces;
        }
        if (kiln_sim_is_traced(scene, index)) {
            family->traced = 1;
            family->keeps |= kiln_family_is_inherited(scene, index) ? FAMILY_KEEPS_REMAINS : 0;
            family->counted = kiln_family_counted_hits(scene, index);
            family->traces = params->trace_count;
            params->trace_count += system->capacity;
        }
    }
}

static void fill_pushes(struct kiln_sim_params *params, const struct kiln_scene *scene)
{
    params->push_count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].interaction_count == 0)
            continue;
        params->systems[i].pushed = 1;
        params->systems[i].first_push = params->push_count;
        params->push_count += scene->systems[i].capacity;
    }
}

/* Fills in the rows of spins and ways, in the order of the pool (particles/pool.c). */
static void fill_spins(struct kiln_sim_params *params, const struct kiln_scene *scene)
{
    params->spin_count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        struct kiln_step_params *step = &params->systems[i];
        if (kiln_scene_system_spins(scene, i)) {
            step->spins = 1;
            step->rubs |= step->collide != COLLIDE_OFF;
            step->first_spin = params->spin_count;
            params->spin_count += scene->systems[i].capacity;
        }
        if (kiln_family_travels(scene, i)) {
            step->family.travels = 1;
            step->family.ways = params->spin_count;
            params->spin_count += scene->systems[i].capacity;
        }
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_parent *parent = &scene->systems[i].emit.parent;
        if (parent->enabled)
            params->systems[i].family.parent_ways = params->systems[parent->system].family.ways;
    }
}

static void find_spin(struct kiln_step_params *params, const struct kiln_scene *scene,
                      uint32_t system, float time_s)
{
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, system, KILN_INTERACT_COLLIDE);
    if (!params->spins)
        return;
    params->spin_low = kiln_scene_system_value(scene, system, &collide->turning.min, time_s);
    params->spin_high = kiln_scene_system_value(scene, system, &collide->turning.max, time_s);
    params->rolling = kiln_scene_system_value(scene, system, &collide->rolling, time_s);
    const float3 axis = kiln_scene_system_value3(scene, system, &collide->axis, time_s);
    params->spin_axis = FLOAT4(axis.x, axis.y, axis.z, 0.0f);
}

bool kiln_sim_is_family(const struct kiln_step_params *params)
{
    const struct kiln_family_params *family = &params->family;
    return family->born_of != BORN_OF_CLOCK || family->traced != 0 || family->then != THEN_BOUNCE;
}

void kiln_sim_params_init(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_sim_grids *grids)
{
    params->grids = grids;
    for (uint32_t i = 0; i < grids->count; i++)
        params->surroundings.grids[i] = grids->table[i];
    params->system_count = scene->system_count;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        fill_system(&params->systems[i], scene, i);
        params->systems[i].emit.first_word = grids->sources[i];
    }
    fill_families(params, scene);
    fill_pushes(params, scene);
    fill_spins(params, scene);
}

/* Sets the next serial of a system of children. It follows from the parents' serials, so no births
 * are counted. */
static bool count_children(struct kiln_step_params *params, const struct kiln_scene *scene,
                           uint32_t index, struct kiln_pool *pool, struct kiln_error *error)
{
    const struct kiln_parent *parent = &scene->systems[index].emit.parent;
    const struct kiln_pool_system *born = &pool->systems[parent->system];
    struct kiln_pool_system *slots = &pool->systems[index];
    if (!scene->systems[index].enabled)
        return true;
    if (slots->capacity != (uint64_t)born->capacity * parent->slots)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: systems.%s: %u slots, but %u parents with %u children each",
                              scene->name, scene->systems[index].name, slots->capacity,
                              born->capacity, parent->slots);
    uint64_t serials = born->next_serial * parent->slots;
    if (serials > UINT32_MAX)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: systems.%s: more than 2^32 births by step %u", scene->name,
                              scene->systems[index].name, params->step);
    slots->next_serial = serials;
    return true;
}

/* Counts the births of one system and tells the step about them. */
static bool count_births(struct kiln_step_params *params, const struct kiln_scene *scene,
                         uint32_t index, struct kiln_pool_system *slots, struct kiln_error *error)
{
    const struct kiln_system *system = &scene->systems[index];
    struct kiln_births births = {.count = 0};
    if (system->enabled) {
        struct kiln_scene_births counted;
        kiln_scene_births_init(&counted, scene, index);
        kiln_births_step(&counted.source, params->step, &slots->birth_wait, &births);
    }
    if (births.count > slots->capacity)
        return kiln_error_set(
            error, KILN_INVALID_INPUT, "%s: systems.%s: %u births in step %u, but only %u slots",
            scene->name, system->name, births.count, params->step, slots->capacity);
    if (slots->next_serial + births.count > UINT32_MAX)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: systems.%s: more than 2^32 births by step %u", scene->name,
                              system->name, params->step);
    params->first_serial = (uint)slots->next_serial;
    params->first_slot = slots->capacity ? params->first_serial % slots->capacity : 0;
    params->birth_count = births.count;
    params->group_count = births.group_count;
    for (uint32_t i = 0; i < births.group_count; i++)
        params->groups[i] = births.groups[i];
    slots->next_serial += births.count;
    return true;
}

bool kiln_sim_params_births(struct kiln_sim_params *params, const struct kiln_scene *scene,
                            struct kiln_pool *pool, uint32_t step, struct kiln_error *error)
{
    if (step == 0 || step > KILN_MAX_STEPS)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: step %u; a run has at most %u steps",
                              scene->name, step, KILN_MAX_STEPS);
    if (!kiln_sim_pose_births(params->grids, scene, step, error))
        return false;
    for (uint32_t n = 0; n < params->system_count; n++) {
        uint32_t i = params->order[n];
        struct kiln_step_params *p = &params->systems[i];
        p->step = step;
        p->time_s = kiln_scene_time(scene, step - 1);
        if (scene->systems[i].emit.parent.enabled
                ? !count_children(p, scene, i, pool, error)
                : !count_births(p, scene, i, &pool->systems[i], error))
            return false;
        p->base = pool->systems[i].base;
        p->capacity = pool->systems[i].capacity;
        p->used = kiln_pool_used(&pool->systems[i]);
        find_spin(p, scene, i, p->time_s);
        if (p->emit.attached)
            p->emit.frame = kiln_emit_frame(scene, &scene->systems[i].emit, step);
        if (p->carried)
            p->carry = kiln_carry_frame(scene, scene->systems[i].space.node, step);
    }
    return true;
}

/* Brings demitters that lie in nodes to where these are at the end of a step, when particles are
 * looked for in them. */
static void place_demitters(struct kiln_step_params *params, const struct kiln_scene *scene,
                            const struct kiln_system *system, float end_s)
{
    for (uint32_t i = 0; i < system->demitter_count; i++) {
        const struct kiln_demitter *demitter = &system->demitters[i];
        if (!demitter->attach.name)
            continue;
        const struct kiln_still_frame frame = kiln_sim_frame(scene, &demitter->attach, end_s);
        const float *low = demitter->box.min, *high = demitter->box.max;
        const float scale = frame.at.w;
        params->demitter_frames[i] = frame;
        params->demitter_min[i] =
            to_float4((float[]){low[0] * scale, low[1] * scale, low[2] * scale});
        params->demitter_max[i] =
            to_float4((float[]){high[0] * scale, high[1] * scale, high[2] * scale});
    }
}

bool kiln_sim_params_step(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_pool *pool, uint32_t step, struct kiln_error *error)
{
    if (!kiln_sim_params_births(params, scene, pool, step, error))
        return false;
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    const float forces_s = kiln_sim_forces_s(scene, step);
    for (uint32_t i = 0; i < params->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        struct kiln_step_params *p = &params->systems[i];
        const struct kiln_sim_moment start = {scene, i, start_s}, acting = {scene, i, forces_s};
        p->randomness = kiln_sim_value_at(&start, system->collide.randomness);
        p->slowdown = kiln_sim_value_at(&start, system->collide.slowdown);
        p->restitution = kiln_sim_value_at(&start, system->collide.restitution);
        p->friction = kiln_sim_value_at(&start, system->collide.friction);
        p->family.chance = kiln_sim_value_at(&start, system->collide.chance);
        for (uint32_t k = 0; k < system->force_count; k++)
            p->forces[k] = kiln_sim_force_params(&acting, params->grids, &system->forces[k]);
        place_demitters(p, scene, system, end_s);
    }
    kiln_sim_colliders_fill(&params->surroundings, scene, params->grids, start_s, end_s);
    return true;
}
