/* This file checks options against each other and fills in what follows from them: steps,
 * capacities, bounds. */
#include "scene/validate.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "asset/atlas/cells_in.h"
#include "asset/geometry/chart.h"
#include "scene/asset_path.h"
#include "scene/emit_way.h"
#include "scene/family.h"
#include "scene/gas_settle.h"
#include "scene/impacts.h"
#include "scene/instant.h"
#include "scene/look_defaults.h"
#include "scene/motion_layout.h"
#include "scene/node_settle.h"
#include "scene/object_mesh.h"
#include "scene/options.h"
#include "scene/particle_mesh.h"
#include "scene/regions.h"
#include "scene/ribbon.h"
#include "scene/samples.h"
#include "scene/scene_births.h"
#include "scene/source.h"

/* ---- clock ---------------------------------------------------------------------------------- */

/* Writes a multiple of the frame rate as a number that a scene may have. */
static void print_multiple(char out[32], struct kiln_rational fps, uint64_t multiple)
{
    uint64_t num = fps.num * multiple;
    if (1000000 % fps.den == 0) /* a rate has at most six decimals */
        kiln_unit_print_number(out, (double)num / (double)fps.den);
    else
        snprintf(out, 32, "%" PRIu64 "/%" PRIu32, num, fps.den);
}

static bool refuse_rate(struct kiln_reader *reader, const struct kiln_node *root, uint64_t below)
{
    char lower[32], upper[32];
    print_multiple(lower, kiln_reader_scene(reader)->fps, below);
    print_multiple(upper, kiln_reader_scene(reader)->fps, below + 1);
    if (below == 0)
        return kiln_reader_error_at(reader, root, "simulation.rate",
                                    "must be a whole multiple of output.fps; the nearest is %s",
                                    upper);
    return kiln_reader_error_at(reader, root, "simulation.rate",
                                "must be a whole multiple of output.fps; the nearest are %s and %s",
                                lower, upper);
}

static bool settle_clock(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    uint64_t fps_num = scene->fps.num, fps_den = scene->fps.den;
    if (scene->rate.num == 0) { /* auto */
        uint64_t multiple = (60 * fps_den + fps_num - 1) / fps_num;
        uint64_t num = fps_num * multiple, den = fps_den;
        kiln_unit_reduce(&num, &den);
        scene->rate = (struct kiln_rational){(uint32_t)num, (uint32_t)den};
    }
    /* is rate / fps a whole number? */
    uint64_t above = scene->rate.num * fps_den, below = scene->rate.den * fps_num;
    if (above % below != 0)
        return refuse_rate(reader, root, above / below);
    scene->steps_per_frame = (uint32_t)(above / below);
    scene->dt_s = (float)((double)scene->rate.den / (double)scene->rate.num);

    double warmup = scene->warmup_s * (double)scene->rate.num / (double)scene->rate.den;
    double steps = floor(warmup + 0.5) + (double)(scene->frames - 1) * scene->steps_per_frame +
                   (kiln_scene_moment_count(scene) > 1 || scene->camera.shutter_phase > 0
                        ? scene->steps_per_frame
                        : 0);
    if (steps > (double)KILN_MAX_STEPS)
        return kiln_reader_error_at(
            reader, root, "output.frames",
            "the clip and its warm-up have %.0f steps; a run has at most %u", steps,
            KILN_MAX_STEPS);
    scene->warmup_steps = (uint32_t)floor(warmup + 0.5);
    return true;
}

/* ---- systems -------------------------------------------------------------------------------- */

/* Gives each system without a seed its place as its number, and warns where another system has
 * asked for that number. Two systems that both ask for one number are meant to draw alike. */
static void settle_seeds(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    bool pinned[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < scene->system_count; i++) {
        pinned[i] = scene->systems[i].seed != KILN_INTEGER_BY_WORD;
        scene->systems[i].seed = pinned[i] ? scene->systems[i].seed : i;
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        for (uint32_t k = 0; k < scene->system_count && !pinned[i]; k++) {
            const struct kiln_system *own = &scene->systems[i], *other = &scene->systems[k];
            char path[64];
            snprintf(path, sizeof path, "systems.%s", own->name);
            if (pinned[k] && other->seed == own->seed && own->enabled && other->enabled)
                kiln_reader_warn_at(reader, root, path,
                                    "its place is %u, which is also the seed of systems.%s, so "
                                    "both draw the same numbers; a seed of its own sets it apart",
                                    own->seed, other->name);
        }
    }
}

/* Bounds the births of a system over the whole run. */
static struct kiln_births_bound births_bound(const struct kiln_scene *scene, uint32_t index)
{
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_parent *parent = &system->emit.parent;
    if (!system->enabled)
        return (struct kiln_births_bound){0};
    if (parent->enabled) { /* the parent comes earlier in the order, so its slots are known */
        struct kiln_births_bound bound = births_bound(scene, parent->system);
        bound.capacity = (uint64_t)scene->systems[parent->system].capacity * parent->slots;
        bound.total *= parent->slots; /* stays below 2^63, since generations are few */
        return bound;
    }
    struct kiln_scene_births births;
    kiln_scene_births_init(&births, scene, index);
    uint32_t steps = kiln_scene_last_step(scene, scene->frames - 1);
    if (steps == scene->warmup_steps) /* frame 0 shows bursts that happen in the step after it */
        steps++;
    return kiln_births_bound(&births.source, steps, kiln_family_lifespan(scene, index, steps));
}

static bool refuse_crowd(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system, uint32_t step)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    char path[128], time[48];
    snprintf(path, sizeof path, "systems.%s.emit.bursts", system->name);
    kiln_unit_print(time, KILN_SECONDS, kiln_scene_time(scene, step - 1));
    return kiln_reader_error_at(reader, root, path,
                                "the step at %s has more than %d bursts: let them be less frequent",
                                time, KILN_MAX_BURSTS);
}

static bool settle_capacity(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    uint64_t total = 0;
    uint32_t order[KILN_MAX_SYSTEMS];
    kiln_family_order(scene, order);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        struct kiln_system *system = &scene->systems[order[i]];
        struct kiln_births_bound bound = births_bound(scene, order[i]);
        uint64_t slots = bound.capacity ? bound.capacity : 1; /* no buffer may be empty */
        char path[128];
        snprintf(path, sizeof path, "systems.%s.emit", system->name);
        if (bound.crowded)
            return refuse_crowd(reader, root, system, bound.crowded);
        const uint64_t mebibyte = 1 << 20, bytes = sizeof(struct kiln_particle);
        const char *advice = system->emit.parent.enabled ? "children, or the parents' rate or life"
                                                         : "rate, bursts or life";
        if (slots > KILN_MAX_PARTICLES - total)
            return kiln_reader_error_at(reader, root, path,
                                        "up to %" PRIu64 " particles at once need %" PRIu64
                                        " MiB; the systems of a scene may have %d in all (%" PRIu64
                                        " MiB), of which %" PRIu64 " are taken: lower %s",
                                        slots, slots * bytes / mebibyte, KILN_MAX_PARTICLES,
                                        KILN_MAX_PARTICLES * bytes / mebibyte, total, advice);
        if (bound.total > UINT32_MAX)
            return kiln_reader_error_at(reader, root, path,
                                        "the run has %" PRIu64 " births; at most %" PRIu32
                                        " are allowed",
                                        bound.total, UINT32_MAX);
        if (slots > KILN_MAX_FLOCK && kiln_scene_interaction(scene, order[i], KILN_INTERACT_FLOCK))
            return kiln_reader_error_at(reader, root, path,
                                        "a flock has up to %" PRIu64
                                        " particles at once; at most %d are allowed: lower %s",
                                        slots, KILN_MAX_FLOCK, advice);
        system->capacity = (uint32_t)slots;
        total += slots;
    }
    return true;
}

/* Calls `check` at the time of every key of some values, and once if they have no keys. */
static bool at_all_keys(const struct kiln_scene *scene, const struct kiln_value3 *const *vectors,
                        unsigned count,
                        bool (*check)(const struct kiln_scene *scene,
                                      const struct kiln_value3 *const *vectors, float time_s))
{
    bool ok = check(scene, vectors, 0);
    for (unsigned v = 0; v < count; v++) {
        const struct kiln_value *parts[3] = {&vectors[v]->x, &vectors[v]->y, &vectors[v]->z};
        for (unsigned c = 0; c < 3; c++) {
            for (uint32_t i = 0; i < parts[c]->count; i++)
                ok = ok && check(scene, vectors, scene->keys[parts[c]->first + i].x);
        }
    }
    return ok;
}

static bool is_not_zero(const struct kiln_scene *scene, const struct kiln_value3 *const *vectors,
                        float time_s)
{
    float3 v = kiln_scene_value3(scene, vectors[0], time_s);
    return v.x != 0 || v.y != 0 || v.z != 0;
}

/* Returns whether a vector that varies as a whole is [0, 0, 0] at one of its keys, whatever its
 * clock counts. */
static bool has_zero_key(const struct kiln_scene *scene, const struct kiln_value3 *v)
{
    const bool whole = kiln_value3_is_whole(scene->keys, v) && !(v->x.how & VALUE_PLUS);
    bool found = false;
    for (uint32_t i = 0; whole && i < v->x.count; i++)
        found = found || (scene->keys[v->x.first + i].y == 0 &&
                          scene->keys[v->y.first + i].y == 0 && scene->keys[v->z.first + i].y == 0);
    return found;
}

static bool are_apart(const struct kiln_scene *scene, const struct kiln_value3 *const *vectors,
                      float time_s)
{
    float3 a = kiln_scene_value3(scene, vectors[0], time_s);
    float3 b = kiln_scene_value3(scene, vectors[1], time_s);
    return a.x != b.x || a.y != b.y || a.z != b.z;
}

static bool check_shape(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system)
{
    const struct kiln_look *look = &system->look;
    const struct kiln_value3 *axis = &look->axis;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.axis", system->name);
    if (!at_all_keys(kiln_reader_scene(reader), &axis, 1, is_not_zero))
        return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
    const struct kiln_value3 *normal = &look->facing.normal;
    snprintf(path, sizeof path, "systems.%s.look.facing.normal", system->name);
    if (!at_all_keys(kiln_reader_scene(reader), &normal, 1, is_not_zero))
        return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
    snprintf(path, sizeof path, "systems.%s.look.blend", system->name);
    if (kiln_look_is_opaque(look) && look->blend != KILN_BLEND_ALPHA)
        return kiln_reader_error_at(reader, root, path,
                                    "must be alpha for %s, which cover what is behind",
                                    look->shape == KILN_SHAPE_MESH ? "meshes" : "spheres");
    return true;
}

/* Checks the division of an image into a system's cells. */
static bool check_division(struct kiln_reader *reader, const struct kiln_node *root,
                           const struct kiln_system *system, const char *file)
{
    const struct kiln_look *look = &system->look;
    const struct kiln_cells_source source = {file, look->columns, look->rows, 1,
                                             kiln_reader_scene(reader)->loader};
    struct kiln_error error = {0};
    if (file[0] != '/' || kiln_cells_check_layout(&source, &error))
        return true;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.cells", system->name);
    return kiln_asset_fail(reader, root, path, file, &error);
}

/* Checks the cells of a system's atlas. Only billboards show one. */
static bool check_cells(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system)
{
    const struct kiln_look *look = &system->look;
    if (!kiln_look_has_texture(look))
        return true;
    for (uint32_t i = 0; i < look->atlas_count; i++) {
        if (!check_division(reader, root, system, look->atlas[i]))
            return false;
    }
    return check_division(reader, root, system, look->motion);
}

static const char *shape_name(const struct kiln_emitter *emit)
{
    static const char *const names[] = {
        [KILN_EMITTER_POINT] = "point", [KILN_EMITTER_SPHERE] = "sphere",
        [KILN_EMITTER_BOX] = "box",     [KILN_EMITTER_DISC] = "disc",
        [KILN_EMITTER_CONE] = "cone",   [KILN_EMITTER_LINE] = "line",
        [KILN_EMITTER_RING] = "ring",   [KILN_EMITTER_MESH] = "mesh",
        [KILN_EMITTER_IMAGE] = "image", [KILN_EMITTER_PATH] = "path",
    };
    return names[emit->shape];
}

static bool check_flock(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                        const struct kiln_flock *flock)
{
    const float slowest = kiln_scene_value_max(kiln_reader_scene(reader), &flock->slowest);
    const float fastest = kiln_scene_value_max(kiln_reader_scene(reader), &flock->fastest);
    if (slowest > fastest)
        return kiln_reader_error_at(
            reader, root, path,
            "the slowest speed of a flock, %g m/s, is above its fastest, %g m/s", (double)slowest,
            (double)fastest);
    return true;
}

/* Settles what impacts do, which has two keys: `dies` is that of older scenes. */
static bool settle_impacts(struct kiln_reader *reader, const struct kiln_node *root,
                           struct kiln_system *system)
{
    struct kiln_collide *collide = &system->collide;
    const bool stops = collide->then >= KILN_THEN_STOP;
    const char *word = collide->then == KILN_THEN_STICK ? "stick" : "stop";
    char path[128];
    if (!kiln_impacts_agree(reader, root, system))
        return false;
    snprintf(path, sizeof path, "systems.%s.collide.then", system->name);
    if (collide->dies && stops)
        return kiln_reader_error_at(reader, root, path, "must not be %s where `dies` is true",
                                    word);
    if (collide->enabled && stops && system->interaction_count > 0)
        return kiln_reader_error_at(reader, root, path,
                                    "must not be %s where particles interact, since nothing "
                                    "pushes a particle that has stopped",
                                    word);
    collide->dies |= collide->then == KILN_THEN_DIE;
    if (collide->dies)
        collide->then = KILN_THEN_DIE;
    return true;
}

/* Checks a system's interactions. Two of a kind are refused, since each would be computed from the
 * state before the other. */
static bool check_interactions(struct kiln_reader *reader, const struct kiln_node *root,
                               const struct kiln_system *system)
{
    char path[128];
    for (uint32_t i = 0; i < system->interaction_count; i++) {
        const struct kiln_interaction *interaction = &system->interactions[i];
        snprintf(path, sizeof path, "systems.%s.interact", system->name);
        for (uint32_t k = 0; k < i; k++) {
            if (system->interactions[k].kind == interaction->kind)
                return kiln_reader_error_at(
                    reader, root, path,
                    "entries %u and %u are of the same kind; one entry of each kind is allowed", k,
                    i);
        }
        if (interaction->kind == KILN_INTERACT_COLLIDE && !interaction->as_drawn &&
            kiln_scene_value_max(kiln_reader_scene(reader), &interaction->radius) <= 0.0f)
            return kiln_reader_error_at(reader, root, path,
                                        "the radius of entry %u is 0 at all times, so nothing can "
                                        "collide; it must be above 0",
                                        i);
        if (interaction->kind == KILN_INTERACT_FLOCK &&
            !check_flock(reader, root, path, &interaction->flock))
            return false;
    }
    return true;
}

/* Refuses a look that moves or paints something and varies over the distance to the eye: a state
 * must not depend on the camera. */
static bool check_distances(struct kiln_reader *reader, const struct kiln_node *root,
                            uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, index, KILN_INTERACT_COLLIDE);
    const uint32_t distance = 1u << KILN_CLOCK_DISTANCE;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.size", system->name);
    if (collide && collide->as_drawn &&
        (kiln_value_uses(scene->keys, &system->look.size) & distance))
        return kiln_reader_error_at(reader, root, path,
                                    "cannot vary over the distance to the eye, since particles "
                                    "collide as they are drawn");
    snprintf(path, sizeof path, "systems.%s.look.color", system->name);
    if (system->paint.enabled && (kiln_value3_uses(scene->keys, &system->look.color) & distance))
        return kiln_reader_error_at(reader, root, path,
                                    "cannot vary over the distance to the eye, since the system "
                                    "paints with it");
    return true;
}

static bool check_systems(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        struct kiln_system *system = &scene->systems[i];
        const struct kiln_emitter *emit = &system->emit;
        const struct kiln_value3 *direction = &emit->direction;
        char path[128];
        kiln_look_settle(&system->look);
        snprintf(path, sizeof path, "systems.%s.emit.from.%s.direction", system->name,
                 shape_name(emit));
        if (!emit->outward &&
            (!at_all_keys(scene, &direction, 1, is_not_zero) || has_zero_key(scene, direction)))
            return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
        snprintf(path, sizeof path, "systems.%s.look.cells", system->name);
        uint32_t cells = system->look.columns * system->look.rows;
        if (cells > KILN_MAX_CELLS)
            return kiln_reader_error_at(reader, root, path,
                                        "found %u cells; at most %d are allowed", cells,
                                        KILN_MAX_CELLS);
        snprintf(path, sizeof path, "systems.%s.look.motion", system->name);
        if (system->look.motion[0] == '/' &&
            (system->look.atlas_count > 1 || system->look.atlas[0][0] != '/'))
            return kiln_reader_error_at(reader, root, path,
                                        "a motion file needs exactly one atlas file");
        snprintf(path, sizeof path, "systems.%s.paint.when", system->name);
        if (system->paint.enabled && system->paint.when == KILN_PAINT_IMPACT &&
            !system->collide.enabled)
            return kiln_reader_error_at(reader, root, path,
                                        "impact needs systems.%s.collide: without it, no particle "
                                        "bounces or ends at a surface",
                                        system->name);
        if (!check_shape(reader, root, system) || !check_cells(reader, root, system) ||
            !kiln_motion_layout_settle(reader, root, system) ||
            !kiln_regions_check(reader, root, i) || !settle_impacts(reader, root, system) ||
            !check_interactions(reader, root, system) || !check_distances(reader, root, i) ||
            !kiln_particle_mesh_settle(reader, root, system))
            return false;
        if (!system->bounds.enabled)
            system->bounds = scene->bounds;
    }
    return true;
}

/* ---- backdrop and camera --------------------------------------------------------------------- */

/* Returns the key of an object's direction; NULL: the object has none. */
static const char *name_of_axis(const struct kiln_object *object)
{
    if (object->kind == KILN_OBJECT_CYLINDER)
        return "cylinder.axis";
    if (object->kind == KILN_OBJECT_CAPSULE)
        return "capsule.axis";
    if (object->kind == KILN_OBJECT_CONE)
        return "cone.axis";
    return object->kind == KILN_OBJECT_PLANE ? "plane.normal" : NULL;
}

static bool check_solid(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_object *mesh = &scene->backdrop.objects[index];
    char path[80];
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.depth_maps.directions", index);
    if (mesh->depth_direction_count == 0)
        return kiln_reader_error_at(reader, root, path, "must name at least one direction");
    for (uint32_t i = 0; i < mesh->depth_direction_count; i++) {
        const struct kiln_value3 *direction = &mesh->depth_directions[i];
        snprintf(path, sizeof path, "backdrop.objects.%u.mesh.depth_maps.directions.%u", index, i);
        if (!at_all_keys(scene, &direction, 1, is_not_zero))
            return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
    }
    struct kiln_error error = {0};
    const struct kiln_mesh_grid *grid = kiln_mesh_grid_of(mesh->collider);
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.collide", index);
    return !mesh->collide || !grid || !grid->check || grid->check(mesh, &error) ||
           kiln_asset_fail(reader, root, path, mesh->file, &error);
}

/* Checks a mesh that takes paint. */
static bool check_paint(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_object *object = &scene->backdrop.objects[index];
    const uint32_t size = object->paint.size;
    char path[64];
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.paint", index);
    if (object->animation.enabled)
        return kiln_reader_error_at(reader, root, path,
                                    "a mesh with an animation cannot take paint");
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.paint.size", index);
    if ((size & (size - 1)) != 0)
        return kiln_reader_error_at(reader, root, path,
                                    "found %u; allowed are powers of two from 16 to 2048", size);
    struct kiln_error error = {0};
    struct kiln_chart *chart = kiln_chart_create(object->shown, size, object->file, &error);
    const bool good = chart != NULL;
    kiln_chart_destroy(&chart);
    if (good)
        return true;
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.paint", index);
    return kiln_asset_fail(reader, root, path, object->file, &error);
}

static bool check_objects(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    uint32_t meshes = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        const struct kiln_value3 *axis = &object->axis;
        const char *name = name_of_axis(object);
        char path[64];
        snprintf(path, sizeof path, "backdrop.objects.%u.%s", i, name ? name : "");
        if (name && !at_all_keys(scene, &axis, 1, is_not_zero))
            return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
        if (!kiln_object_is_mesh(object))
            continue;
        if (!kiln_object_mesh_settle(reader, root, i))
            return false;
        const struct kiln_value3 *heading = &object->heading;
        snprintf(path, sizeof path, "backdrop.objects.%u.mesh.heading", i);
        if (object->kind == KILN_OBJECT_MESH && !at_all_keys(scene, &heading, 1, is_not_zero))
            return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
        snprintf(path, sizeof path, "backdrop.objects.%u.mesh.collide", i);
        if (object->collide && object->animation.enabled &&
            object->collider != KILN_COLLIDER_VOLUME)
            return kiln_reader_error_at(reader, root, path,
                                        "a mesh with an animation needs the collider volume");
        if (object->kind == KILN_OBJECT_MESH && !check_solid(reader, root, i))
            return false;
        if (kiln_object_takes_paint(object) && !check_paint(reader, root, i))
            return false;
        if (++meshes > KILN_MAX_MESHES)
            return kiln_reader_error_at(reader, root, "backdrop.objects",
                                        "more than %d meshes; no more are allowed",
                                        KILN_MAX_MESHES);
    }
    return true;
}

static bool check_lights(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->backdrop.light_count; i++) {
        const struct kiln_light *light = &scene->backdrop.lights[i];
        const struct kiln_value3 *direction = &light->direction;
        char path[64];
        snprintf(path, sizeof path, "backdrop.lights.%u.%s.direction", i,
                 light->kind == KILN_LIGHT_SPOT ? "spot" : "rectangle");
        if (light->kind != KILN_LIGHT_POINT && !at_all_keys(scene, &direction, 1, is_not_zero))
            return kiln_reader_error_at(reader, root, path, "must not be [0, 0, 0]");
    }
    return true;
}

static bool check_backdrop(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    const struct kiln_value3 *sun = &backdrop->sun_direction;
    if (!at_all_keys(scene, &sun, 1, is_not_zero))
        return kiln_reader_error_at(reader, root, "backdrop.sun.direction",
                                    "must not be [0, 0, 0]");
    if (kiln_backdrop_floor_collides(backdrop) && backdrop->floor_height.count > 0)
        return kiln_reader_error_at(
            reader, root, "backdrop.floor.height",
            "cannot vary while the floor collides; set backdrop.floor.collide to false");
    return check_lights(reader, root) && check_objects(reader, root);
}

static bool check_camera(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_value3 *ends[2] = {&scene->camera.position, &scene->camera.target};
    if (!at_all_keys(scene, ends, 2, are_apart))
        return kiln_reader_error_at(reader, root, "camera.target",
                                    "must not be the position of the camera");
    const double opens = scene->camera.shutter_phase;
    const double closes =
        opens + (scene->camera.shutter_samples > 1 ? scene->camera.shutter_angle : 0);
    if (closes > KILN_DEG(360) * (1 + 1e-9))
        return kiln_reader_error_at(reader, root, "camera.shutter.phase",
                                    "phase and angle together are more than the 360 deg of a "
                                    "frame");
    if (kiln_scene_value_max(scene, &scene->camera.aperture) > 0.0f &&
        kiln_scene_moment_count(scene) == 1)
        kiln_reader_warn_at(
            reader, root, "camera.aperture",
            "a lens is drawn by moments, and a frame has one: it shows what a pinhole "
            "does; output.samples: 16 shows the lens");
    return true;
}

bool kiln_validate(struct kiln_reader *reader, const struct kiln_node *root)
{
    settle_seeds(reader, root);
    return settle_clock(reader, root) && kiln_nodes_settle(reader, root) &&
           check_camera(reader, root) && check_backdrop(reader, root) &&
           check_systems(reader, root) && kiln_family_settle(reader, root) &&
           kiln_ribbons_check(reader, root) && kiln_gas_settle(reader, root) &&
           kiln_sources_settle(reader, root) && kiln_emit_ways_settle(reader, root) &&
           settle_capacity(reader, root) && kiln_particle_mesh_count(reader, root) &&
           kiln_samples_settle(reader, root);
}
