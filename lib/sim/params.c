/* From the scene to struct kiln_step_params. */
#include "sim/params.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "base/error.h"
#include "shared/exact.h"
#include "shared/random.h"
#include "shared/trace.h"
#include "sim/turned.h"

static_assert(sizeof(struct kiln_value) == 16, "std140");
static_assert(sizeof(struct kiln_derived_params) == 48, "std140");
static_assert(sizeof(struct kiln_emit_params) == 256, "std140");
static_assert(sizeof(struct kiln_force_params) == 176, "std140");
static_assert(sizeof(struct kiln_birth_group) == 16, "std140");
static_assert(offsetof(struct kiln_step_params, step) == 304, "std140");
static_assert(offsetof(struct kiln_step_params, randomness) == 368, "std140");
static_assert(offsetof(struct kiln_step_params, pushed) == 436, "std140");
static_assert(offsetof(struct kiln_step_params, bounds_min) == 448, "std140");
static_assert(offsetof(struct kiln_step_params, groups) == 736, "std140");
static_assert(offsetof(struct kiln_step_params, forces) == 1776, "std140");
static_assert(offsetof(struct kiln_step_params, family) == 4592, "std140");
static_assert(sizeof(struct kiln_step_params) == 4640, "std140");
static_assert(sizeof(struct kiln_step_params) <= 16384, "what every GL allows a uniform block");
static_assert(sizeof(struct kiln_surroundings) <= 16384, "what every GL allows a uniform block");
static_assert(sizeof(struct kiln_trace) == 112, "std430");
static_assert(offsetof(struct kiln_surroundings, colliders) == 16, "std140");
static_assert(offsetof(struct kiln_surroundings, grids) == 6880, "std140");
static_assert(sizeof(struct kiln_grid) == 48, "std140");
static_assert(sizeof(struct kiln_collider) == 208, "std140");
static_assert(sizeof(struct kiln_pose) == 160, "std140");

static_assert(KILN_MAX_BIRTH_GROUPS == KILN_MAX_BURSTS + 1, "the rate and each burst");
static_assert(KILN_MAX_COLLIDERS == KILN_MAX_OBJECTS + 1, "each object and the floor");

static_assert(EMIT_POINT == (uint)KILN_EMITTER_POINT && EMIT_SPHERE == (uint)KILN_EMITTER_SPHERE &&
                  EMIT_BOX == (uint)KILN_EMITTER_BOX && EMIT_DISC == (uint)KILN_EMITTER_DISC &&
                  EMIT_CONE == (uint)KILN_EMITTER_CONE,
              "the shaders' names of enum kiln_emitter_shape");
static_assert(FORCE_GRAVITY == (uint)KILN_FORCE_GRAVITY && FORCE_DRAG == (uint)KILN_FORCE_DRAG &&
                  FORCE_WIND == (uint)KILN_FORCE_WIND && FORCE_CURL == (uint)KILN_FORCE_CURL &&
                  FORCE_LIMIT == (uint)KILN_FORCE_LIMIT && FORCE_FIELD == (uint)KILN_FORCE_FIELD &&
                  FORCE_ATTRACT == (uint)KILN_FORCE_ATTRACT &&
                  FORCE_VORTEX == (uint)KILN_FORCE_VORTEX,
              "the shaders' names of enum kiln_force_kind");
static_assert(INTEGRATE_SEMI_IMPLICIT == (uint)KILN_INTEGRATE_SEMI_IMPLICIT &&
                  INTEGRATE_POSITION_FIRST == (uint)KILN_INTEGRATE_POSITION_FIRST &&
                  INTEGRATE_TRAPEZOID == (uint)KILN_INTEGRATE_TRAPEZOID &&
                  INTEGRATE_RK4 == (uint)KILN_INTEGRATE_RK4,
              "the shaders' names of enum kiln_integration");
static_assert(FALLOFF_INVERSE_SQUARE == (uint)KILN_FALLOFF_INVERSE_SQUARE &&
                  FALLOFF_INVERSE == (uint)KILN_FALLOFF_INVERSE &&
                  FALLOFF_CONSTANT == (uint)KILN_FALLOFF_CONSTANT &&
                  FALLOFF_LINEAR == (uint)KILN_FALLOFF_LINEAR,
              "the shaders' names of enum kiln_falloff");
static_assert(VORTEX_RANKINE == (uint)KILN_VORTEX_RANKINE &&
                  VORTEX_LAMB_OSEEN == (uint)KILN_VORTEX_LAMB_OSEEN,
              "the shaders' names of enum kiln_vortex_profile");

static_assert(BORN_OF_DEATH == 1 + (uint)KILN_EVENT_DEATH &&
                  BORN_OF_BOUNCE == 1 + (uint)KILN_EVENT_BOUNCE &&
                  BORN_OF_TRAIL == 1 + (uint)KILN_EVENT_TRAIL,
              "the shaders' names of enum kiln_event");
static_assert(ALIGN_WORLD == (uint)KILN_ALIGN_WORLD &&
                  ALIGN_VELOCITY == (uint)KILN_ALIGN_VELOCITY &&
                  ALIGN_NORMAL == (uint)KILN_ALIGN_NORMAL,
              "the shaders' names of enum kiln_align");

/* The key of the noise that all systems share: of no system. */
enum { NOISE_SYSTEM = KILN_MAX_SYSTEMS };

static float4 to_float4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

static void fill_emitter(struct kiln_emit_params *params, const struct kiln_emitter *emit)
{
    *params = (struct kiln_emit_params){
        .shape = (uint)emit->shape,
        .outward = emit->outward,
        .surface = emit->surface,
        .speed = emit->speed,
        .origin = emit->origin,
        .direction = emit->direction,
        .size = emit->size,
        .angle = emit->angle,
        .radius = emit->radius,
        .inherit = emit->inherit,
        .turn = emit->turn,
    };
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

/* Whether impacts do more than mirror. */
static bool rubs(const struct kiln_scene *scene, const struct kiln_collide *collide)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    const struct kiln_value *friction = &collide->friction;
    bool any = !is_one(&collide->restitution) || friction->count > 0 || friction->constant != 0.0f;
    any = any || (backdrop->floor_collide && !is_one(&backdrop->floor_restitution));
    for (uint32_t i = 0; i < backdrop->object_count; i++)
        any = any || (backdrop->objects[i].collide && !is_one(&backdrop->objects[i].restitution));
    return collide->enabled && any;
}

static uint what_force_does(const struct kiln_force *force)
{
    if (force->kind == KILN_FORCE_LIMIT)
        return FORCES_LIMIT;
    const bool none = force->pull.count == 0 && force->pull.constant == 0.0f;
    return force->kind == KILN_FORCE_DRAG && !none ? FORCES_SLOW : 0;
}

bool kiln_sim_needs_all_forces(const struct kiln_scene *scene)
{
    bool any = scene->integration >= KILN_INTEGRATE_TRAPEZOID;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            const struct kiln_force *force = &system->forces[k];
            any = any || force->kind == KILN_FORCE_ATTRACT || force->kind == KILN_FORCE_VORTEX ||
                  what_force_does(force) == FORCES_SLOW;
        }
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
        .noise_seed = random_key(scene->seed, NOISE_SYSTEM),
        .bounds_min = to_float4(system->bounds.min),
        .bounds_max = to_float4(system->bounds.max),
        .rubs = rubs(scene, &system->collide),
    };
    fill_emitter(&params->emit, &system->emit);
    for (uint32_t i = 0; i < system->force_count; i++)
        params->forces_do |= what_force_does(&system->forces[i]);
    for (uint32_t i = 0; i < system->demitter_count; i++) {
        params->demitter_min[i] = to_float4(system->demitters[i].min);
        params->demitter_max[i] = to_float4(system->demitters[i].max);
    }
}

/* Parents come first, so that their traces have places when their children ask. */
static void fill_families(struct kiln_sim_params *params, const struct kiln_scene *scene)
{
    params->trace_count = 0;
    kiln_family_order(scene, params->order);
    for (uint32_t k = 0; k < scene->system_count; k++) {
        uint32_t index = params->order[k];
        const struct kiln_system *system = &scene->systems[index];
        const struct kiln_parent *parent = &system->emit.parent;
        struct kiln_family_params *family = &params->systems[index].family;
        *family =
            (struct kiln_family_params){.dies = system->collide.enabled && system->collide.dies};
        if (parent->enabled) {
            family->born_of = 1 + (uint)parent->event;
            family->align = (uint)parent->align;
            family->slots = parent->slots;
            family->rate = parent->rate;
            family->parent_traces = params->systems[parent->system].family.traces;
        }
        if (kiln_family_has_children(scene, index)) {
            family->traced = 1;
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

bool kiln_sim_is_family(const struct kiln_step_params *params)
{
    const struct kiln_family_params *family = &params->family;
    return family->born_of != BORN_OF_CLOCK || family->traced != 0 || family->dies != 0;
}

void kiln_sim_params_init(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_sim_grids *grids)
{
    params->grids = grids;
    for (uint32_t i = 0; i < grids->count; i++)
        params->surroundings.grids[i] = grids->table[i];
    params->system_count = scene->system_count;
    for (uint32_t i = 0; i < scene->system_count; i++)
        fill_system(&params->systems[i], scene, i);
    fill_families(params, scene);
    fill_pushes(params, scene);
}

/* The value with its course over time taken at time_s; a curve over life stays one. */
static struct kiln_value at_time(const struct kiln_scene *scene, struct kiln_value value,
                                 float time_s)
{
    if (value.count != 0 && value.clock == KILN_CLOCK_LIFE)
        return value;
    return (struct kiln_value){.constant = kiln_scene_value(scene, &value, time_s)};
}

static struct kiln_value3 at_time3(const struct kiln_scene *scene, struct kiln_value3 value,
                                   float time_s)
{
    return (struct kiln_value3){at_time(scene, value.x, time_s), at_time(scene, value.y, time_s),
                                at_time(scene, value.z, time_s)};
}

static struct kiln_force_params force_at_time(const struct kiln_scene *scene,
                                              const struct kiln_sim_grids *grids,
                                              const struct kiln_force *force, float time_s)
{
    const bool attracts = force->kind == KILN_FORCE_ATTRACT;
    struct kiln_force_params params = {
        .kind = (uint)force->kind,
        .octaves = force->octaves,
        .profile = attracts ? (uint)force->falloff : (uint)force->profile,
        .grid = force->kind == KILN_FORCE_FIELD ? kiln_sim_grids_find(grids, force->file) : 0,
        .vector = at_time3(scene, force->vector, time_s),
        .drift = at_time3(scene, force->drift, time_s),
        .strength = at_time(scene, force->strength, time_s),
        .pull = at_time(scene, force->pull, time_s),
        .scale = at_time(scene, force->scale, time_s),
        .inward = kiln_scene_value(scene, &force->inward, time_s),
        .lift = kiln_scene_value(scene, &force->lift, time_s),
    };
    if (force->mode == KILN_WIND_ADD) {
        params.added = (float)((double)scene->rate.num / scene->rate.den);
        *(force->kind == KILN_FORCE_WIND ? &params.strength : &params.pull) =
            (struct kiln_value){.constant = 0.0f};
    }
    return params;
}

/* A box's lower and upper corner. */
static void box_corners(const struct kiln_scene *scene, const struct kiln_object *box, float time_s,
                        float4 *min, float4 *max)
{
    float3 center = kiln_scene_value3(scene, &box->center, time_s);
    float3 size = kiln_scene_value3(scene, &box->size, time_s);
    float3 low = float3_canon(float3_add_scaled(center, size, -0.5f));
    float3 high = float3_canon(float3_add_scaled(center, size, 0.5f));
    *min = FLOAT4(low.x, low.y, low.z, 0.0f);
    *max = FLOAT4(high.x, high.y, high.z, 0.0f);
}

static float4 canon4(float3 v, float w)
{
    return FLOAT4(exact_canon(v.x), exact_canon(v.y), exact_canon(v.z), exact_canon(w));
}

/* A round shape at a time: its centre and radius, half of its height, and what bounds it. */
struct round_values {
    float4 center;
    float half_height;
    float4 min, max;
};

static struct round_values round_values(const struct kiln_scene *scene,
                                        const struct kiln_object *object, float3 axis, float time_s)
{
    float3 center = kiln_scene_value3(scene, &object->center, time_s);
    float radius = kiln_scene_value(scene, &object->radius, time_s);
    float half = 0.0f;
    if (object->kind == KILN_OBJECT_CYLINDER)
        half = 0.5f * kiln_scene_value(scene, &object->height, time_s);
    float3 reach = FLOAT3(radius + half * exact_abs(axis.x), radius + half * exact_abs(axis.y),
                          radius + half * exact_abs(axis.z));
    return (struct round_values){.center = canon4(center, radius),
                                 .half_height = exact_canon(half),
                                 .min = canon4(float3_sub(center, reach), 0.0f),
                                 .max = canon4(float3_add(center, reach), 0.0f)};
}

static struct kiln_collider round_collider(const struct kiln_scene *scene,
                                           const struct kiln_object *object, float start_s,
                                           float end_s)
{
    float3 axis = FLOAT3(0.0f, 0.0f, 0.0f);
    if (object->kind == KILN_OBJECT_CYLINDER) /* it does not vary */
        axis = float3_normalize(kiln_scene_value3(scene, &object->axis, start_s),
                                FLOAT3(0.0f, 1.0f, 0.0f));
    struct round_values start = round_values(scene, object, axis, start_s);
    struct round_values end = round_values(scene, object, axis, end_s);
    return (struct kiln_collider){
        .min = start.min,
        .max = start.max,
        .min_end = end.min,
        .max_end = end.max,
        .center = start.center,
        .center_end = end.center,
        .axis = canon4(axis, start.half_height),
        .kind = object->kind == KILN_OBJECT_SPHERE ? COLLIDER_SPHERE : COLLIDER_CYLINDER,
        .half_height_end = end.half_height,
    };
}

static struct kiln_collider box_collider(const struct kiln_scene *scene,
                                         const struct kiln_object *object, float start_s,
                                         float end_s)
{
    struct kiln_collider box = {.kind = COLLIDER_BOX};
    box_corners(scene, object, start_s, &box.min, &box.max);
    box_corners(scene, object, end_s, &box.min_end, &box.max_end);
    return box;
}

/* The floor is a box as wide and deep as the world. */
static struct kiln_collider floor_collider(float before_m, float after_m)
{
    return (struct kiln_collider){
        .min = FLOAT4(-KILN_WORLD, -KILN_WORLD, -KILN_WORLD, 0.0f),
        .max = FLOAT4(KILN_WORLD, exact_canon(before_m), KILN_WORLD, 0.0f),
        .min_end = FLOAT4(-KILN_WORLD, -KILN_WORLD, -KILN_WORLD, 0.0f),
        .max_end = FLOAT4(KILN_WORLD, exact_canon(after_m), KILN_WORLD, 0.0f),
    };
}

/* Without end downwards; what is above it is not even looked up. */
static struct kiln_collider terrain_collider(const struct kiln_sim_grids *grids, uint32_t number)
{
    const struct kiln_grid *grid = &grids->table[number];
    const float width = (float)(grid->size.x - 1), depth = (float)(grid->size.z - 1);
    struct kiln_collider terrain = {
        .min = FLOAT4(grid->origin.x, -KILN_WORLD, grid->origin.z, 0.0f),
        .max = FLOAT4(exact_canon(grid->origin.x + width / grid->per_metre.x),
                      exact_canon(grids->top[number] + 0.01f),
                      exact_canon(grid->origin.z + depth / grid->per_metre.z), 0.0f),
        .kind = COLLIDER_TERRAIN,
        .grid = number,
    };
    terrain.min_end = terrain.min;
    terrain.max_end = terrain.max;
    return terrain;
}

/* A mesh at a time: rows from its frame to the world, and the number of metres for a unit. */
struct pose {
    float rows[3][3], position[3], scale;
};

static struct pose pose_at(const struct kiln_scene *scene, const struct kiln_object *mesh,
                           float time_s)
{
    const float3 at = kiln_scene_value3(scene, &mesh->center, time_s);
    struct pose pose = {.position = {at.x, at.y, at.z},
                        .scale = kiln_scene_value(scene, &mesh->scale, time_s)};
    kiln_scene_rotation(kiln_scene_value3(scene, &mesh->rotation, time_s), pose.rows);
    return pose;
}

/* The vector of the rotation from one to the other: along its axis, as long as its angle. */
static float3 turn_between(const struct pose *a, const struct pose *b)
{
    float turn[3][3]; /* b a^T */
    for (int i = 0; i < 9; i++)
        turn[i / 3][i % 3] = a->rows[i % 3][0] * b->rows[i / 3][0] +
                             a->rows[i % 3][1] * b->rows[i / 3][1] +
                             a->rows[i % 3][2] * b->rows[i / 3][2];
    const float3 skew = FLOAT3(0.5f * (turn[2][1] - turn[1][2]), 0.5f * (turn[0][2] - turn[2][0]),
                               0.5f * (turn[1][0] - turn[0][1]));
    const float sine = float3_length(skew);
    const float cosine = 0.5f * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0f);
    float angle = 0.0f;
    for (int i = 0; i < 4; i++) { /* what is left has this sine */
        const struct exact_angle found = exact_sincos(angle);
        angle += sine * found.cosine - cosine * found.sine;
    }
    return float3_scale(float3_normalize(skew, FLOAT3(0.0f, 0.0f, 0.0f)), angle);
}

/* The transposed rotation, shrunk, less the position. */
static void invert(const struct pose *pose, float4 to_local[3])
{
    for (int i = 0; i < 3; i++) {
        const float x = pose->rows[0][i] / pose->scale, y = pose->rows[1][i] / pose->scale;
        const float z = pose->rows[2][i] / pose->scale;
        const float moved = x * pose->position[0] + y * pose->position[1] + z * pose->position[2];
        to_local[i] = FLOAT4(exact_canon(x), exact_canon(y), exact_canon(z), exact_canon(-moved));
    }
}

/* The box in the world around the grid's, larger by a factor. */
static void bound(const struct pose *pose, const struct kiln_grid *grid, float factor, float4 *min,
                  float4 *max)
{
    const float half[3] = {0.5f * (float)(grid->size.x - 1) / grid->per_metre.x,
                           0.5f * (float)(grid->size.y - 1) / grid->per_metre.y,
                           0.5f * (float)(grid->size.z - 1) / grid->per_metre.z};
    const float middle[3] = {grid->origin.x + half[0], grid->origin.y + half[1],
                             grid->origin.z + half[2]};
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        float center = pose->position[i], reach = 0.0f;
        for (int c = 0; c < 3; c++) {
            center += pose->scale * pose->rows[i][c] * middle[c];
            reach += pose->scale * exact_abs(pose->rows[i][c]) * half[c];
        }
        low[i] = center - factor * reach;
        high[i] = center + factor * reach;
    }
    *min = to_float4(low);
    *max = to_float4(high);
}

/* While a mesh turns, its frame goes straight from one place to the next, and what is in it is
 * larger on the way: by less than half for less than 96 degrees a step. */
static struct kiln_collider mesh_collider(const struct kiln_scene *scene,
                                          const struct kiln_sim_grids *grids, uint32_t index,
                                          float start_s, float end_s, float steps_per_s,
                                          struct kiln_pose *out)
{
    const struct kiln_object *mesh = &scene->backdrop.objects[index];
    const uint32_t number = grids->of_object[index];
    const struct pose start = pose_at(scene, mesh, start_s), end = pose_at(scene, mesh, end_s);
    struct kiln_collider field = {
        .kind = COLLIDER_SDF, .grid = number, .mesh = number - grids->wind_count};
    const float factor = memcmp(start.rows, end.rows, sizeof start.rows) != 0 ? 1.5f : 1.0f;
    bound(&start, &grids->table[number], factor, &field.min, &field.max);
    bound(&end, &grids->table[number], factor, &field.min_end, &field.max_end);
    invert(&start, out->to_local);
    invert(&end, out->to_local_end);
    out->metres = FLOAT4(start.scale, end.scale, 0.0f, 0.0f);
    out->center = to_float4(start.position);
    out->center_end = to_float4(end.position);
    out->turn = canon4(float3_scale(turn_between(&start, &end), steps_per_s), 0.0f);
    return field;
}

static struct kiln_collider object_collider(struct kiln_surroundings *around,
                                            const struct kiln_scene *scene,
                                            const struct kiln_sim_grids *grids, uint32_t index,
                                            float start_s, float end_s)
{
    const struct kiln_object *object = &scene->backdrop.objects[index];
    struct kiln_collider c;
    if (kiln_turned_is(object))
        c = kiln_turned_collider(scene, object, start_s, end_s);
    else if (object->kind == KILN_OBJECT_BOX)
        c = box_collider(scene, object, start_s, end_s);
    else if (object->kind == KILN_OBJECT_TERRAIN)
        c = terrain_collider(grids, grids->of_object[index]);
    else if (object->kind == KILN_OBJECT_MESH)
        c = mesh_collider(scene, grids, index, start_s, end_s, around->steps_per_s,
                          &around->poses[grids->of_object[index] - grids->wind_count]);
    else
        c = round_collider(scene, object, start_s, end_s);
    c.restitution = kiln_scene_value(scene, &object->restitution, start_s);
    c.friction = kiln_scene_value(scene, &object->friction, start_s);
    return c;
}

static void fill_colliders(struct kiln_surroundings *around, const struct kiln_scene *scene,
                           const struct kiln_sim_grids *grids, float start_s, float end_s)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    around->collider_count = 0;
    around->steps_per_s = (float)((double)scene->rate.num / scene->rate.den);
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        if (!object->collide)
            continue;
        around->colliders[around->collider_count++] =
            object_collider(around, scene, grids, i, start_s, end_s);
    }
    if (backdrop->floor_collide) {
        struct kiln_collider *c = &around->colliders[around->collider_count++];
        *c = floor_collider(kiln_scene_value(scene, &backdrop->floor_height, start_s),
                            kiln_scene_value(scene, &backdrop->floor_height, end_s));
        c->restitution = kiln_scene_value(scene, &backdrop->floor_restitution, start_s);
        c->friction = kiln_scene_value(scene, &backdrop->floor_friction, start_s);
    }
}

/* Children have their serials from their parents': there is nothing to count. */
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

bool kiln_sim_params_step(struct kiln_sim_params *params, const struct kiln_scene *scene,
                          struct kiln_pool *pool, uint32_t step, struct kiln_error *error)
{
    if (step == 0 || step > KILN_MAX_STEPS)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: step %u; a run has at most %u steps",
                              scene->name, step, KILN_MAX_STEPS);
    float start_s = kiln_scene_time(scene, step - 1);
    float end_s = kiln_scene_time(scene, step);
    const bool staged = scene->integration >= KILN_INTEGRATE_TRAPEZOID;
    float forces_s = staged ? 0.5f * (start_s + end_s) : start_s;
    for (uint32_t n = 0; n < params->system_count; n++) {
        uint32_t i = params->order[n];
        const struct kiln_system *system = &scene->systems[i];
        struct kiln_step_params *p = &params->systems[i];
        p->step = step;
        p->time_s = start_s;
        if (system->emit.parent.enabled ? !count_children(p, scene, i, pool, error)
                                        : !count_births(p, scene, i, &pool->systems[i], error))
            return false;
        p->base = pool->systems[i].base;
        p->capacity = pool->systems[i].capacity;
        p->used = kiln_pool_used(&pool->systems[i]);
        p->randomness = at_time(scene, system->collide.randomness, start_s);
        p->slowdown = at_time(scene, system->collide.slowdown, start_s);
        p->restitution = at_time(scene, system->collide.restitution, start_s);
        p->friction = at_time(scene, system->collide.friction, start_s);
        for (uint32_t k = 0; k < system->force_count; k++)
            p->forces[k] = force_at_time(scene, params->grids, &system->forces[k], forces_s);
    }
    fill_colliders(&params->surroundings, scene, params->grids, start_s, end_s);
    return true;
}
