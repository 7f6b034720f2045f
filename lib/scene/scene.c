/* This file answers questions about a scene: the times of its steps and frames, animated values at
 * a time, and what follows from its options, such as whether particles spin. It also frees a scene.
 *
 * Validation, the simulation, drawing and jobs call it on the host, from any thread: it changes no
 * scene, except that kiln_scene_destroy frees one. Times, values and rotations reach particles,
 * whose states must be equal to the bit on every machine (docs/determinism.md), so they use IEEE
 * arithmetic and shared/exact.h; sinf or cosf must not replace exact_sincos. */
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#include "asset/loader/loader.h"
#include "base/matrix.h"
#include "scene/node_cache.h"
#include "scene/scene_births.h"
#include "scene/work.h"
#include "shared/exact.h"
#include "shared/random.h"

float kiln_scene_time(const struct kiln_scene *scene, uint32_t step)
{
    /* The factors are below 2^32 and 2^21, so a double holds the product exactly. The division is
     * rounded as IEEE 754 says. So every machine gets the same time. */
    double steps = (double)step - (double)scene->warmup_steps;
    return (float)(steps * (double)scene->rate.den / (double)scene->rate.num);
}

uint32_t kiln_scene_frame_step(const struct kiln_scene *scene, uint32_t frame)
{
    return scene->warmup_steps + frame * scene->steps_per_frame;
}

static struct value_clocks scene_clocks(const struct kiln_scene *scene, float time_s)
{
    const uint32_t key = random_noise_key(scene->seed);
    return value_clocks_at(time_s, key, key);
}

struct value_clocks kiln_scene_clocks(const struct kiln_scene *scene, uint32_t system, float time_s)
{
    if (system >= KILN_MAX_SYSTEMS)
        return value_clocks_at(time_s, random_gas_key(scene->seed, system - KILN_MAX_SYSTEMS),
                               random_noise_key(scene->seed));
    const struct kiln_derived_params derived = kiln_scene_derived(scene, system);
    return value_clocks_at(time_s, derived.random_key, derived.scene_key);
}

float kiln_scene_value(const struct kiln_scene *scene, const struct kiln_value *value, float time_s)
{
    return value_at(scene->keys, *value, scene_clocks(scene, time_s));
}

float kiln_scene_system_value(const struct kiln_scene *scene, uint32_t system,
                              const struct kiln_value *value, float time_s)
{
    return value_at(scene->keys, *value, kiln_scene_clocks(scene, system, time_s));
}

float3 kiln_scene_system_value3(const struct kiln_scene *scene, uint32_t system,
                                const struct kiln_value3 *value, float time_s)
{
    return value3_at(scene->keys, *value, kiln_scene_clocks(scene, system, time_s));
}

float3 kiln_scene_value3(const struct kiln_scene *scene, const struct kiln_value3 *value,
                         float time_s)
{
    return FLOAT3(kiln_scene_value(scene, &value->x, time_s),
                  kiln_scene_value(scene, &value->y, time_s),
                  kiln_scene_value(scene, &value->z, time_s));
}

bool kiln_value3_is_constant(const struct kiln_value3 *value)
{
    return value->x.count == 0 && value->y.count == 0 && value->z.count == 0;
}

bool kiln_range_is_one_value(const struct kiln_range *range)
{
    const struct kiln_value *min = &range->min, *max = &range->max;
    return min->constant == max->constant && min->first == max->first && min->count == max->count &&
           min->how == max->how;
}

bool kiln_object_is_oriented_box(const struct kiln_object *object)
{
    const struct kiln_value3 *r = &object->rotation;
    return object->kind == KILN_OBJECT_BOX &&
           (object->attach.name || !kiln_value3_is_constant(r) || r->x.constant != 0.0f ||
            r->y.constant != 0.0f || r->z.constant != 0.0f);
}

float kiln_scene_value_max(const struct kiln_scene *scene, const struct kiln_value *value)
{
    return kiln_value_most(scene->keys, value);
}

float kiln_scene_value_min(const struct kiln_scene *scene, const struct kiln_value *value)
{
    return kiln_value_least(scene->keys, value);
}

bool kiln_scene_view_stands(const struct kiln_scene *scene)
{
    const struct kiln_camera *camera = &scene->camera;
    return scene->pixel_samples == 1 &&
           (!camera->attach.name || kiln_node_stands(scene, camera->attach.node)) &&
           kiln_value3_is_constant(&camera->position) && kiln_value3_is_constant(&camera->target) &&
           camera->fov.count == 0 && camera->roll.count == 0 && camera->near_plane.count == 0 &&
           !(kiln_scene_value_max(scene, &camera->aperture) > 0.0f);
}

/* Returns whether a colour is ever more than black. */
static bool ever_shines(const struct kiln_scene *scene, const struct kiln_value3 *color)
{
    return kiln_scene_value_max(scene, &color->x) > 0.0f ||
           kiln_scene_value_max(scene, &color->y) > 0.0f ||
           kiln_scene_value_max(scene, &color->z) > 0.0f;
}

bool kiln_scene_has_sun(const struct kiln_scene *scene)
{
    return ever_shines(scene, &scene->backdrop.sun_color);
}

uint32_t kiln_scene_gas_lights(const struct kiln_scene *scene, uint32_t domain)
{
    const struct kiln_gas_domain *d = &scene->gas[domain];
    const bool shines = d->enabled && d->burn.enabled &&
                        kiln_scene_value_max(scene, &d->look.light) > 0.0f &&
                        kiln_scene_value_max(scene, &d->look.intensity) > 0.0f;
    return shines ? KILN_GAS_LIGHTS : 0;
}

bool kiln_scene_gas_is_smoke(const struct kiln_scene *scene, uint32_t domain)
{
    const struct kiln_gas_domain *d = &scene->gas[domain];
    return d->enabled && d->look.shadow &&
           (kiln_scene_value_max(scene, &d->look.extinction) > 0.0f ||
            kiln_scene_value_max(scene, &d->look.absorption) > 0.0f);
}

bool kiln_scene_has_firelight(const struct kiln_scene *scene)
{
    bool found = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        found |= scene->systems[i].enabled && ever_shines(scene, &scene->systems[i].look.light);
    for (uint32_t i = 0; i < scene->gas_count; i++)
        found |= kiln_scene_gas_lights(scene, i) > 0;
    return found;
}

bool kiln_scene_has_smoke(const struct kiln_scene *scene)
{
    bool found = false;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        found |= kiln_system_is_smoke(system) &&
                 kiln_scene_value_max(scene, &system->look.shadow) > 0.0f;
    }
    for (uint32_t i = 0; i < scene->gas_count; i++)
        found |= kiln_scene_gas_is_smoke(scene, i);
    return found;
}

bool kiln_scene_has_haze(const struct kiln_scene *scene)
{
    return !scene->backdrop.transparent &&
           kiln_scene_value_max(scene, &scene->backdrop.haze) > 0.0f;
}

uint32_t kiln_scene_shadow_lights(const struct kiln_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->backdrop.light_count; i++)
        count += scene->backdrop.lights[i].shadow;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (system->enabled && system->look.light_shadow && ever_shines(scene, &system->look.light))
            count += system->look.light_count;
    }
    for (uint32_t i = 0; i < scene->gas_count; i++)
        count += kiln_scene_gas_lights(scene, i);
    return count;
}

void kiln_scene_rotation(float3 angles, float columns[3][3])
{
    const struct exact_angle x = exact_sincos(angles.x), y = exact_sincos(angles.y);
    const struct exact_angle z = exact_sincos(angles.z);
    float sx = x.sine, cx = x.cosine, sy = y.sine, cy = y.cosine, sz = z.sine, cz = z.cosine;
    mat3 rotation = {{cz * cy, sz * cy, -sy},
                     {cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx},
                     {cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx}};
    glm_mat3_copy(rotation, columns);
}

bool kiln_object_is_mesh(const struct kiln_object *object)
{
    return object->kind == KILN_OBJECT_MESH || object->kind == KILN_OBJECT_TERRAIN;
}

/* Returns how many whole lengths of its clip an animation has gone through at a time, or 0 if it
 * does not repeat. Sets how many seconds of the clip it has gone through in all. */
static float rounds_of(const struct kiln_animation *animation, float time_s, float *seconds)
{
    const float length = animation->length;
    *seconds = animation->start.constant + animation->speed.constant * time_s;
    return animation->loop && length > 0.0f ? floorf(*seconds / length) : 0.0f;
}

float kiln_scene_animation_s(const struct kiln_animation *animation, float time_s)
{
    float seconds;
    const float rounds = rounds_of(animation, time_s, &seconds);
    return exact_clamp(seconds - rounds * animation->length, 0.0f, animation->length);
}

float kiln_scene_animation_speed(const struct kiln_animation *animation, float time_s)
{
    const float speed = animation->speed.constant, length = animation->length;
    float seconds;
    rounds_of(animation, time_s, &seconds);
    const bool stays =
        speed > 0.0f ? seconds < 0.0f || seconds >= length : seconds <= 0.0f || seconds > length;
    return stays && !animation->loop ? 0.0f : speed;
}

bool kiln_scene_animation_ends(const struct kiln_animation *animation, float from_s, float to_s,
                               float *end_s)
{
    float seconds;
    const float before = rounds_of(animation, from_s, &seconds);
    const float after = rounds_of(animation, to_s, &seconds);
    *end_s = animation->speed.constant > 0.0f ? animation->length : 0.0f;
    return before != after;
}

bool kiln_object_takes_paint(const struct kiln_object *object)
{
    return object->kind == KILN_OBJECT_MESH && object->paint.enabled;
}

bool kiln_scene_paints(const struct kiln_scene *scene, uint32_t system)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        any = any || kiln_object_takes_paint(&scene->backdrop.objects[i]);
    return any && scene->systems[system].enabled && scene->systems[system].paint.enabled;
}

struct kiln_terrain_params kiln_scene_terrain(const struct kiln_scene *scene,
                                              const struct kiln_object *terrain)
{
    const struct kiln_value3 *at = &terrain->center, *size = &terrain->size;
    return (struct kiln_terrain_params){
        .loader = scene->loader,
        .image = terrain->file,
        .samples = {terrain->samples[0], terrain->samples[1]},
        .position = {at->x.constant, at->y.constant, at->z.constant},
        .size = {size->x.constant, size->y.constant, size->z.constant},
        .hills = terrain->hills.constant,
        .roughness = terrain->roughness.constant,
        .ridges = terrain->ridges.constant,
        .octaves = terrain->octaves,
        .seed = terrain->seed,
    };
}

void kiln_scene_destroy(struct kiln_scene **scene)
{
    struct kiln_scene *s = scene ? *scene : NULL;
    if (!s)
        return;
    *scene = NULL;
    if (!kiln_handle_retire(&s->handle, KILN_HANDLE_SCENE))
        return;
    kiln_mesh_library_destroy(&s->meshes);
    kiln_loader_destroy(&s->loader);
    kiln_node_cache_finish(s->node_cache);
    kiln_arena_destroy(&s->tree_arena);
    kiln_arena_destroy(&s->arena);
    kiln_handle_free(&s->handle, sizeof *s);
}

struct kiln_derived_params kiln_scene_derived(const struct kiln_scene *scene, uint32_t system)
{
    return (struct kiln_derived_params){
        .random_key = random_system_key(scene->seed, scene->systems[system].seed),
        .scene_key = random_noise_key(scene->seed),
        .warmup_steps = scene->warmup_steps,
        .dt_s = scene->dt_s,
        .life = scene->systems[system].emit.life};
}

const struct kiln_interaction *kiln_scene_interaction(const struct kiln_scene *scene,
                                                      uint32_t system,
                                                      enum kiln_interaction_kind kind)
{
    const struct kiln_system *s = &scene->systems[system];
    for (uint32_t i = 0; i < s->interaction_count; i++)
        if (s->interactions[i].kind == kind)
            return &s->interactions[i];
    return NULL;
}

float kiln_scene_contact_radius(const struct kiln_scene *scene, uint32_t system)
{
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, system, KILN_INTERACT_COLLIDE);
    if (!collide)
        return 0.0f;
    const struct kiln_look *look = &scene->systems[system].look;
    float largest = kiln_scene_value_max(scene, &collide->radius);
    if (collide->as_drawn) {
        const float low = kiln_scene_value_max(scene, &look->scale.min);
        const float high = kiln_scene_value_max(scene, &look->scale.max);
        largest = 0.5f * kiln_scene_value_max(scene, &look->size) * (low > high ? low : high);
    }
    return largest > 1e-4f ? largest : 1e-4f;
}

bool kiln_scene_system_spins(const struct kiln_scene *scene, uint32_t system)
{
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, system, KILN_INTERACT_COLLIDE);
    return collide && collide->spins;
}

bool kiln_scene_spins(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        any = any || kiln_scene_system_spins(scene, i);
    return any;
}

/* Returns the rate of births at a time, for lib/particles/births.c. */
static float rate_at(const void *context, float time_s)
{
    const struct kiln_scene_births *births = context;
    return kiln_scene_system_value(births->scene, births->system, births->rate, time_s);
}

void kiln_scene_births_init(struct kiln_scene_births *births, const struct kiln_scene *scene,
                            uint32_t system)
{
    const struct kiln_emitter *emit = &scene->systems[system].emit;
    *births = (struct kiln_scene_births){
        .source = {.rate = rate_at,
                   .context = births,
                   .bursts = emit->bursts,
                   .burst_count = emit->burst_count,
                   .random_key = kiln_scene_derived(scene, system).random_key,
                   .steps_num = scene->rate.num,
                   .steps_den = scene->rate.den,
                   .warmup_steps = scene->warmup_steps,
                   .by_way = emit->by_way,
                   .way_count = emit->way_count},
        .scene = scene,
        .system = system,
        .rate = &emit->rate,
    };
}
