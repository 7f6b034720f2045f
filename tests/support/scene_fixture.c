/* Builds scenes in memory, without a scene file or parser, for tests of single stages: adds values,
 * key frames, systems, forces, interactions and colliders, and makes larger scenes of them. */
#include "support/scene_fixture.h"

#include <string.h>

#include "particles/births.h"
#include "scene/family.h"
#include "scene/options.h"
#include "support/cmocka.h"

void fixture_init(struct scene_fixture *f)
{
    kiln_mesh_library_destroy(&f->scene.meshes);
    memset(f, 0, sizeof *f);
    f->scene.name = "fixture";
    f->scene.seed = 7;
    f->scene.fps = (struct kiln_rational){60, 1};
    f->scene.rate = (struct kiln_rational){60, 1};
    f->scene.frames = 300;
    f->scene.steps_per_frame = 1;
    f->scene.dt_s = 1.0f / 60.0f;
    f->scene.keys = f->keys;
    f->scene.backdrop.floor_restitution = f->scene.backdrop.floor_friction =
        (struct kiln_value){.constant = 1.0f};
}

struct kiln_value fixture_constant(float x)
{
    return (struct kiln_value){.constant = x};
}

struct kiln_value fixture_keys(struct scene_fixture *f, uint32_t clock, uint32_t count,
                               const float (*points)[2])
{
    struct kiln_value value = {.first = f->scene.key_count, .count = count, .how = clock};
    for (uint32_t i = 0; i < count; i++) {
        float slope = 0.0f;
        if (i + 1 < count)
            slope = (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
        float area =
            points[0][0] * points[0][1]; /* integral of the value from 0 to the first key */
        for (uint32_t k = 1; k <= i; k++)
            area += (points[k][0] - points[k - 1][0]) * 0.5f * (points[k][1] + points[k - 1][1]);
        f->keys[f->scene.key_count++] = FLOAT4(points[i][0], points[i][1], slope, area);
    }
    return value;
}

struct kiln_value fixture_ramp(struct scene_fixture *f, uint32_t clock, float x0, float y0,
                               float x1, float y1)
{
    const float points[2][2] = {{x0, y0}, {x1, y1}};
    return fixture_keys(f, clock, 2, points);
}

struct kiln_value3 fixture_constant3(float x, float y, float z)
{
    return (struct kiln_value3){fixture_constant(x), fixture_constant(y), fixture_constant(z)};
}

struct kiln_range fixture_range(float min, float max)
{
    return (struct kiln_range){fixture_constant(min), fixture_constant(max)};
}

struct kiln_system *fixture_add_system(struct scene_fixture *f, const char *name, float rate)
{
    struct kiln_system *system = &f->scene.systems[f->scene.system_count];
    system->seed = f->scene.system_count++;
    system->name = name;
    system->enabled = true;
    system->emit.rate = fixture_constant(rate);
    system->emit.life = fixture_range(1.0f, 2.0f);
    system->emit.speed = fixture_range(1.0f, 2.0f);
    system->emit.direction = fixture_constant3(0.0f, 1.0f, 0.0f);
    system->collide.slowdown = system->collide.restitution = fixture_constant(1.0f);
    system->collide.chance = fixture_constant(1.0f);
    return system;
}

struct kiln_force *fixture_add_force(struct kiln_system *system, enum kiln_force_kind kind)
{
    struct kiln_force *force = &system->forces[system->force_count++];
    force->kind = kind;
    force->octaves = 1;
    force->scale = fixture_constant(1.0f);
    return force;
}

struct kiln_object *fixture_add_box(struct scene_fixture *f, float x, float y, float z, float width,
                                    float height, float depth)
{
    struct kiln_object *box = &f->scene.backdrop.objects[f->scene.backdrop.object_count++];
    box->center = fixture_constant3(x, y, z);
    box->size = fixture_constant3(width, height, depth);
    box->collide = true;
    box->restitution = box->friction = fixture_constant(1.0f);
    return box;
}

struct kiln_object *fixture_add_sphere(struct scene_fixture *f, float x, float y, float z,
                                       float radius)
{
    struct kiln_object *sphere = fixture_add_box(f, x, y, z, 0.0f, 0.0f, 0.0f);
    sphere->kind = KILN_OBJECT_SPHERE;
    sphere->radius = fixture_constant(radius);
    return sphere;
}

struct kiln_object *fixture_add_cylinder(struct scene_fixture *f, float x, float y, float z,
                                         float radius, float height)
{
    struct kiln_object *cylinder = fixture_add_sphere(f, x, y, z, radius);
    cylinder->kind = KILN_OBJECT_CYLINDER;
    cylinder->height = fixture_constant(height);
    cylinder->axis = fixture_constant3(0.0f, 1.0f, 0.0f);
    return cylinder;
}

struct kiln_object *fixture_add_capsule(struct scene_fixture *f, float x, float y, float z,
                                        float radius, float height)
{
    struct kiln_object *capsule = fixture_add_cylinder(f, x, y, z, radius, height);
    capsule->kind = KILN_OBJECT_CAPSULE;
    return capsule;
}

struct kiln_object *fixture_add_plane(struct scene_fixture *f, float x, float y, float z)
{
    struct kiln_object *plane = fixture_add_box(f, x, y, z, 0.0f, 0.0f, 0.0f);
    plane->kind = KILN_OBJECT_PLANE;
    plane->axis = fixture_constant3(0.0f, 1.0f, 0.0f);
    return plane;
}

struct kiln_object *fixture_add_terrain(struct scene_fixture *f, float y, float width, float height,
                                        uint32_t samples)
{
    struct kiln_object *terrain = fixture_add_box(f, 0.0f, y, 0.0f, width, height, width);
    terrain->kind = KILN_OBJECT_TERRAIN;
    terrain->samples[0] = samples;
    terrain->samples[1] = samples / 2 + 2;
    terrain->hills = fixture_constant(0.5f);
    terrain->roughness = fixture_constant(0.5f);
    terrain->octaves = 3;
    terrain->seed = 5;
    return terrain;
}

struct kiln_object *fixture_add_mesh(struct scene_fixture *f, const char *file, float x, float y,
                                     float z)
{
    struct kiln_object *mesh = fixture_add_box(f, x, y, z, 0.0f, 0.0f, 0.0f);
    struct kiln_error error = {0};
    f->scene.asset_root = "/";
    if (!f->scene.meshes)
        f->scene.meshes = kiln_mesh_library_create(NULL);
    mesh->kind = KILN_OBJECT_MESH;
    mesh->file = file;
    mesh->shown = mesh->collision_mesh = kiln_mesh_library_get(f->scene.meshes, file, &error);
    if (!mesh->collision_mesh)
        fail_msg("%s", error.message);
    mesh->scale = fixture_constant(1.0f);
    mesh->cells = 20;
    return mesh;
}

void fixture_map_depths(struct kiln_object *mesh, uint32_t resolution)
{
    mesh->collider = KILN_COLLIDER_DEPTH_MAPS;
    mesh->depth_resolution = resolution;
    mesh->depth_direction_count = 3;
    mesh->depth_directions[0] = fixture_constant3(1.0f, 0.0f, 0.0f);
    mesh->depth_directions[1] = fixture_constant3(0.0f, 1.0f, 0.0f);
    mesh->depth_directions[2] = fixture_constant3(0.0f, 0.0f, 1.0f);
}

struct kiln_object *fixture_add_moving_mesh(struct scene_fixture *f)
{
    const uint32_t time = KILN_CLOCK_TIME;
    struct kiln_object *mesh =
        fixture_add_mesh(f, KILN_SOURCE_DIR "/tests/mutation/tetrahedron.obj", 0.2f, 0.3f, -0.2f);
    mesh->center.x = fixture_ramp(f, time, 0.0f, 0.2f, 3.0f, 0.9f);
    mesh->rotation.x = fixture_constant(-0.7f);
    mesh->rotation.y = fixture_ramp(f, time, 0.0f, 0.0f, 4.0f, 30.0f);
    mesh->scale = fixture_ramp(f, time, 0.0f, 0.8f, 2.0f, 1.3f);
    return mesh;
}

void fixture_add_moving_volumes(struct scene_fixture *f)
{
    for (int i = 0; i < 2; i++) {
        fixture_add_moving_mesh(f);
        struct kiln_object *mesh = &f->scene.backdrop.objects[f->scene.backdrop.object_count - 1];
        mesh->collider = KILN_COLLIDER_VOLUME;
        mesh->heading = fixture_constant3(0.2f, -1.0f, 0.0f);
        mesh->sides = i ? KILN_SIDES_TWO : KILN_SIDES_ONE;
        mesh->center.z = fixture_constant(i ? 0.6f : -0.2f);
        mesh->restitution = fixture_constant(i ? 0.5f : 1.0f);
    }
}

struct fixture_rate {
    const struct kiln_scene *scene;
    const struct kiln_value *rate;
};

static float fixture_rate_at(const void *context, float time_s)
{
    const struct fixture_rate *c = context;
    return kiln_scene_value(c->scene, c->rate, time_s);
}

struct kiln_system *fixture_add_child(struct scene_fixture *f, const char *name, uint32_t parent,
                                      enum kiln_event event, uint32_t count)
{
    struct kiln_system *system = fixture_add_system(f, name, 0.0f);
    system->emit.parent = (struct kiln_parent){.enabled = true,
                                               .name = f->scene.systems[parent].name,
                                               .system = parent,
                                               .event = event,
                                               .count = {count, count}};
    return system;
}

void fixture_finish(struct scene_fixture *f, uint32_t steps)
{
    uint32_t order[KILN_MAX_SYSTEMS];
    kiln_family_order(&f->scene, order);
    for (uint32_t k = 0; k < f->scene.system_count; k++) {
        uint32_t i = order[k];
        struct kiln_system *system = &f->scene.systems[i];
        struct kiln_parent *parent = &system->emit.parent;
        if (parent->enabled) {
            parent->slots = (uint32_t)kiln_family_slots(&f->scene, parent);
            system->capacity = f->scene.systems[parent->system].capacity * parent->slots;
            continue;
        }
        struct fixture_rate context = {&f->scene, &system->emit.rate};
        struct kiln_births_source source = {
            .rate = fixture_rate_at,
            .context = &context,
            .bursts = system->emit.bursts,
            .burst_count = system->emit.burst_count,
            .random_key = kiln_scene_derived(&f->scene, i).random_key,
            .steps_num = f->scene.rate.num,
            .steps_den = f->scene.rate.den,
            .warmup_steps = f->scene.warmup_steps,
        };
        struct kiln_births_bound bound =
            kiln_births_bound(&source, steps, kiln_family_lifespan(&f->scene, i, steps));
        system->capacity = (uint32_t)bound.capacity;
    }
}

/* ---- larger scenes --------------------------------------------------------------------------- */

void fixture_zoo_backdrop(struct scene_fixture *f)
{
    const uint32_t time = KILN_CLOCK_TIME;
    struct kiln_backdrop *backdrop = &f->scene.backdrop;
    backdrop->floor_enabled = true;
    backdrop->floor_collide = true;
    backdrop->floor_height = fixture_constant(-0.5f);
    fixture_add_box(f, 2.0f, 1.0f, 0.0f, 1.0f, 2.0f, 1.5f);
    fixture_add_box(f, 2.5f, 1.0f, 0.2f, 0.5f, 0.5f, 3.0f);
    struct kiln_object *moving = fixture_add_box(f, 0.0f, 1.5f, 0.0f, 0.5f, 0.4f, 0.5f);
    moving->center.x = fixture_ramp(f, time, 0.3f, -2.0f, 2.0f, 2.0f);
    moving->center.y = fixture_ramp(f, time, 0.0f, 0.2f, 3.0f, 2.0f);
    struct kiln_object *growing = fixture_add_box(f, -1.0f, 0.5f, 0.5f, 0.2f, 0.2f, 0.2f);
    growing->size.y = fixture_ramp(f, time, 0.5f, 0.1f, 2.5f, 2.0f);
    fixture_add_box(f, 0.0f, 0.0f, 0.0f, 90.0f, 90.0f, 90.0f)->collide = false;
}

void fixture_add_round(struct scene_fixture *f)
{
    const uint32_t time = KILN_CLOCK_TIME;
    struct kiln_object *sphere = fixture_add_sphere(f, 0.8f, 0.8f, 0.2f, 0.4f);
    sphere->center.z = fixture_ramp(f, time, 0.0f, -1.0f, 4.0f, 1.0f);
    struct kiln_object *cylinder = fixture_add_cylinder(f, -0.5f, 2.2f, 0.0f, 0.25f, 1.0f);
    cylinder->axis = fixture_constant3(1.0f, 0.5f, -0.3f);
    cylinder->radius = fixture_ramp(f, time, 0.5f, 0.1f, 3.0f, 0.5f);
    cylinder->height = fixture_ramp(f, time, 0.0f, 0.2f, 2.0f, 1.4f);
}

void fixture_add_oriented(struct scene_fixture *f)
{
    const uint32_t time = KILN_CLOCK_TIME;
    struct kiln_object *box = fixture_add_box(f, 0.6f, 0.9f, 0.0f, 0.9f, 0.1f, 0.8f);
    box->rotation.y = fixture_ramp(f, time, 0.0f, 0.0f, 4.0f, 30.0f);
    box->rotation.z = fixture_ramp(f, time, 1.0f, 0.2f, 3.0f, -2.0f);
    box->center.y = fixture_ramp(f, time, 0.0f, 0.4f, 4.0f, 1.4f);
    box->restitution = fixture_ramp(f, time, 0.0f, 1.0f, 3.0f, 0.2f);
    struct kiln_object *still = fixture_add_box(f, -0.6f, 0.2f, 0.3f, 0.5f, 0.4f, 0.3f);
    still->rotation = fixture_constant3(0.3f, 1.0f, -0.4f);
    struct kiln_object *capsule = fixture_add_capsule(f, -0.4f, 1.8f, 0.0f, 0.2f, 0.8f);
    capsule->axis.x = fixture_ramp(f, time, 0.0f, -1.0f, 3.0f, 2.0f);
    capsule->center.z = fixture_ramp(f, time, 0.0f, -0.5f, 4.0f, 0.5f);
    capsule->radius = fixture_ramp(f, time, 1.0f, 0.1f, 3.0f, 0.3f);
    struct kiln_object *rod = fixture_add_cylinder(f, 1.2f, 1.6f, 0.0f, 0.15f, 1.0f);
    rod->axis.z = fixture_ramp(f, time, 0.0f, 1.0f, 2.0f, -1.0f);
    struct kiln_object *cone = fixture_add_cylinder(f, 0.1f, 2.2f, 0.2f, 0.3f, 0.6f);
    cone->kind = KILN_OBJECT_CONE;
    cone->axis.x = fixture_ramp(f, time, 0.0f, -0.5f, 3.0f, 1.0f);
    cone->radius = fixture_ramp(f, time, 0.0f, 0.3f, 2.0f, 0.5f);
    struct kiln_object *plane = fixture_add_plane(f, -1.2f, 0.0f, 0.0f);
    plane->axis = fixture_constant3(1.0f, 0.3f, 0.1f);
    plane->center.x = fixture_ramp(f, time, 0.0f, -1.8f, 2.0f, -1.2f);
    struct kiln_object *turning = fixture_add_plane(f, 0.0f, -0.3f, -1.0f);
    turning->axis.x = fixture_ramp(f, time, 0.0f, -0.2f, 2.0f, 0.2f);
    for (uint32_t i = 0; i < f->scene.system_count; i += 2) {
        struct kiln_collide *collide = &f->scene.systems[i].collide;
        collide->restitution = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 1.0f, 1.0f, 0.3f);
        collide->friction = fixture_constant(0.3f);
    }
}

struct kiln_force *fixture_add_field(struct kiln_system *system)
{
    struct kiln_force *field = fixture_add_force(system, KILN_FORCE_FIELD);
    field->file = KILN_SOURCE_DIR "/tests/support/whirl.grid";
    field->strength = fixture_constant(1.0f);
    field->pull = fixture_constant(2.0f);
    return field;
}

struct kiln_interaction *fixture_add_collisions(struct kiln_system *system, float radius)
{
    struct kiln_interaction *collide = &system->interactions[system->interaction_count++];
    collide->kind = KILN_INTERACT_COLLIDE;
    collide->radius = fixture_constant(radius);
    collide->restitution = fixture_constant(0.8f);
    collide->apart = fixture_constant(0.5f);
    collide->rounds = 3;
    return collide;
}

struct kiln_interaction *fixture_add_gravity(struct kiln_system *system, float strength)
{
    struct kiln_interaction *gravity = &system->interactions[system->interaction_count++];
    gravity->kind = KILN_INTERACT_GRAVITY;
    gravity->strength = fixture_constant(strength);
    gravity->softening = fixture_constant(0.05f);
    return gravity;
}

struct kiln_flock *fixture_add_flock(struct kiln_system *system, float radius)
{
    struct kiln_interaction *flock = &system->interactions[system->interaction_count++];
    flock->kind = KILN_INTERACT_FLOCK;
    flock->flock = (struct kiln_flock){
        .radius = fixture_constant(radius),
        .view = fixture_constant(5.0f),
        .space = fixture_constant(0.4f * radius),
        .separation = fixture_constant(4.0f),
        .avoidance = fixture_constant(3.0f),
        .horizon = fixture_constant(0.5f),
        .cohesion = fixture_constant(2.0f),
        .alignment = fixture_constant(1.5f),
        .all_cohesion = fixture_constant(0.1f),
        .all_alignment = fixture_constant(0.2f),
        .acceleration = fixture_constant(20.0f),
        .slowest = fixture_constant(0.5f),
        .fastest = fixture_constant(6.0f),
    };
    return &flock->flock;
}

static void fixture_zoo_point(struct scene_fixture *f)
{
    struct kiln_system *s = fixture_add_system(f, "point", 300.0f);
    s->emit.angle = fixture_constant(0.4f);
    s->emit.direction = fixture_constant3(2.0f, 1.0f, 0.1f);
    s->emit.speed = fixture_range(2.0f, 8.0f);
    fixture_add_force(s, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -9.81f, 0.0f);
    s->collide.enabled = true;
    s->collide.randomness = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.0f, 1.0f, 1.0f);
    s->collide.slowdown = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.4f, 4.0f, 1.0f);
}

static void fixture_zoo_sphere(struct scene_fixture *f)
{
    static const float rates[4][2] = {{-0.5f, 0.0f}, {0.5f, 400.0f}, {1.5f, 30.0f}, {3.0f, 200.0f}};
    struct kiln_system *s = fixture_add_system(f, "sphere", 0.0f);
    s->emit.rate = fixture_keys(f, KILN_CLOCK_TIME, 4, rates);
    s->emit.shape = KILN_EMITTER_SPHERE;
    s->emit.surface = s->emit.outward = true;
    s->emit.radius = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.1f, 3.0f, 0.6f);
    s->emit.origin = fixture_constant3(0.0f, 1.0f, 0.0f);
    s->emit.origin.x = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -2.0f, 2.0f, 2.0f);
    s->emit.inherit = fixture_constant(0.7f);
    s->emit.life.max = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 1.2f, 3.0f, 2.0f);
    fixture_add_force(s, KILN_FORCE_DRAG)->pull =
        fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.1f, 1.0f, 300.0f);
    s->collide.enabled = true;
    s->collide.slowdown = fixture_constant(0.8f);
}

static void fixture_zoo_box(struct scene_fixture *f)
{
    struct kiln_system *s = fixture_add_system(f, "box", 250.0f);
    s->emit.shape = KILN_EMITTER_BOX;
    s->emit.size = fixture_constant3(1.0f, 0.2f, 2.0f);
    s->emit.angle = fixture_constant(3.14159274f);
    struct kiln_force *wind = fixture_add_force(s, KILN_FORCE_WIND);
    wind->vector = fixture_constant3(1.0f, 0.0f, 0.0f);
    wind->vector.z = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -2.0f, 2.0f, 2.0f);
    wind->pull = fixture_constant(2.0f);
    struct kiln_force *curl = fixture_add_force(s, KILN_FORCE_CURL);
    curl->strength = fixture_constant(1.5f);
    curl->pull = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.0f, 0.5f, 4.0f);
    curl->scale = fixture_constant(0.8f);
    curl->octaves = 3;
    s->bounds = (struct kiln_bounds){true, {-1.5f, -0.4f, -2.0f}, {1.5f, 1.0f, 2.0f}};
}

static void fixture_zoo_disc(struct scene_fixture *f)
{
    struct kiln_system *s = fixture_add_system(f, "disc", 200.0f);
    s->emit.shape = KILN_EMITTER_DISC;
    s->emit.surface = true;
    s->emit.radius = fixture_constant(0.5f);
    s->emit.origin = fixture_constant3(0.0f, 0.1f, -1.0f);
    s->emit.direction = fixture_constant3(0.3f, 1.0f, -0.5f);
    struct kiln_force *curl = fixture_add_force(s, KILN_FORCE_CURL);
    curl->strength = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.0f, 4.0f, 3.0f);
    curl->pull = fixture_constant(1.0f);
    curl->scale = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.3f, 1.0f, 1.5f);
    curl->drift = fixture_constant3(0.2f, -0.4f, 1.0f);
    curl->octaves = 4;
    s->demitters[0].box = (struct kiln_bounds){true, {0.2f, 0.5f, -2.0f}, {0.6f, 3.0f, 0.0f}};
    s->demitters[1].box = (struct kiln_bounds){true, {-0.6f, 0.8f, -2.0f}, {-0.2f, 3.0f, 0.0f}};
    s->demitter_count = 2;
}

static void fixture_zoo_cone(struct scene_fixture *f)
{
    struct kiln_system *s = fixture_add_system(f, "cone", 20.0f);
    s->emit.shape = KILN_EMITTER_CONE;
    s->emit.radius = fixture_constant(0.2f);
    s->emit.angle = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.0f, 3.0f, 1.5f);
    s->emit.direction = fixture_constant3(1.0f, 0.0f, 0.0f);
    s->emit.direction.y = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -1.0f, 3.0f, 1.0f);
    s->emit.speed = fixture_range(5.0f, 90.0f);
    s->emit.origin = fixture_constant3(0.0f, 1.0f, 0.0f);
    s->emit.bursts[0] = (struct kiln_burst){.time_s = -0.31, .count = {90, 90}};
    s->emit.bursts[1] = (struct kiln_burst){.time_s = 1.0, .count = {300, 300}};
    s->emit.bursts[2] = (struct kiln_burst){.time_s = 1.011, .count = {150, 150}};
    s->emit.burst_count = 3;
    fixture_add_force(s, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -5.0f, 0.0f);
    s->collide.enabled = true;
    s->collide.randomness = fixture_constant(0.4f);
    s->collide.slowdown = fixture_constant(0.9f);
}

static void fixture_zoo_clamped(struct scene_fixture *f)
{
    struct kiln_system *s = fixture_add_system(f, "clamped", 150.0f);
    s->emit.shape = KILN_EMITTER_BOX;
    s->emit.surface = true;
    s->emit.size = fixture_constant3(6.0f, 4.0f, 3.0f);
    s->emit.angle = fixture_constant(1.0f);
    s->emit.life = fixture_range(0.005f, 0.5f);
    s->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
    s->emit.speed = fixture_range(0.0f, 12.0f);
    s->collide.enabled = true;
    s->collide.mode = KILN_COLLIDE_CLAMP;
    s->collide.randomness = fixture_constant(0.7f);
    s->collide.slowdown = fixture_constant(0.5f);
}

static void fixture_zoo_rest(struct scene_fixture *f)
{
    struct kiln_system *off = fixture_add_system(f, "off", 100.0f);
    off->enabled = false;
    struct kiln_system *s = fixture_add_system(f, "ball", 100.0f);
    s->emit.shape = KILN_EMITTER_SPHERE;
    s->emit.radius = fixture_constant(2.0f);
    s->emit.origin = fixture_constant3(1.0f, 1.0f, 0.0f);
    struct kiln_force *lift = fixture_add_force(s, KILN_FORCE_GRAVITY);
    lift->vector = fixture_constant3(0.0f, 0.0f, 0.0f);
    lift->vector.y = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 9.0f, 1.0f, -9.0f);
    s->collide.enabled = true;
    s->collide.randomness = fixture_constant(1.0f);
    s->collide.slowdown = fixture_constant(0.5f);
}

void fixture_zoo(struct scene_fixture *f, enum kiln_integration integration, uint32_t steps)
{
    fixture_init(f);
    f->scene.integration = integration;
    f->scene.warmup_steps = 30;
    fixture_zoo_backdrop(f);
    fixture_zoo_point(f);
    fixture_zoo_sphere(f);
    fixture_zoo_box(f);
    fixture_zoo_disc(f);
    fixture_zoo_cone(f);
    fixture_zoo_clamped(f);
    fixture_zoo_rest(f);
    fixture_finish(f, steps);
}

uint32_t fixture_force_kinds(enum kiln_force_kind kinds[FIXTURE_MAX_FORCE_KINDS])
{
    uint32_t count = 0;
    for (const struct kiln_option_kind *row = kiln_force_kinds; row->name; row++) {
        bool known = false;
        for (uint32_t i = 0; i < count; i++)
            known = known || (int)kinds[i] == row->value;
        if (known || row->value == KILN_FORCE_GAS)
            continue; /* the row is a second name of a kind in the list, or needs a domain of gas */
        assert_true(count < FIXTURE_MAX_FORCE_KINDS);
        kinds[count++] = (enum kiln_force_kind)row->value;
    }
    return count;
}

void fixture_alone(struct scene_fixture *f, enum kiln_force_kind kind, uint32_t steps)
{
    fixture_init(f);
    struct kiln_system *s = fixture_add_system(f, "alone", 0.0f);
    s->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {1500, 1500}};
    s->emit.burst_count = 1;
    s->emit.shape = KILN_EMITTER_BOX;
    s->emit.size = fixture_constant3(1.0f, 1.0f, 1.0f);
    s->emit.angle = fixture_constant(3.0f);
    struct kiln_force *force = fixture_add_force(s, kind);
    force->vector = fixture_constant3(0.3f, -0.6f, 0.2f);
    force->axis = fixture_constant3(0.1f, 0.9f, -0.2f);
    force->strength = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.5f, 1.0f, 1.5f);
    force->pull = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 1.0f, 1.0f, 9.0f);
    force->quadratic = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.2f, 1.0f, 2.0f);
    force->scale = fixture_constant(0.7f);
    force->inward = fixture_constant(0.4f);
    force->lift = fixture_constant(0.6f);
    force->octaves = 2;
    force->file = KILN_SOURCE_DIR "/tests/support/whirl.grid";
    if (kind == KILN_FORCE_BAKED) {
        f->baked = (struct kiln_force){.kind = KILN_FORCE_CURL, .octaves = 2};
        f->baked.scale = f->baked.strength = f->baked.pull = fixture_constant(1.0f);
        force->box_center = fixture_constant3(0.0f, 0.0f, 0.0f);
        force->box_size = fixture_constant3(2.0f, 3.0f, 2.0f);
        force->cells = 8;
        force->every = 3;
        force->of = (struct kiln_baked_forces){&f->baked, 1};
    }
    fixture_finish(f, steps);
}

void fixture_add_whirls(struct scene_fixture *f)
{
    struct kiln_system *seeking = fixture_add_system(f, "seeking", 200.0f);
    seeking->emit.speed = fixture_range(0.0f, 12.0f);
    seeking->emit.angle = fixture_constant(3.0f);
    for (int i = 0; i < 4; i++) {
        struct kiln_force *force = fixture_add_force(seeking, KILN_FORCE_ATTRACT);
        force->vector = fixture_constant3(1.0f - (float)i, 1.0f, 0.3f);
        force->vector.x = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, -1.0f, 3.0f, 1.0f);
        force->strength = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 4.0f, 1.0f, -3.0f);
        force->scale = fixture_constant(0.001f + 0.1f * (float)i);
        force->falloff = (enum kiln_falloff)i;
    }
    struct kiln_force *drag = fixture_add_force(seeking, KILN_FORCE_DRAG);
    drag->pull = fixture_constant(0.2f);
    drag->quadratic = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 0.0f, 1.0f, 900.0f);
    fixture_add_force(seeking, KILN_FORCE_LIMIT)->strength = fixture_constant(8.0f);
    seeking->collide.enabled = true;

    struct kiln_system *whirling = fixture_add_system(f, "whirling", 200.0f);
    whirling->emit.shape = KILN_EMITTER_BOX;
    whirling->emit.size = fixture_constant3(2.0f, 1.0f, 2.0f);
    for (int i = 0; i < 2; i++) {
        struct kiln_force *force = fixture_add_force(whirling, KILN_FORCE_VORTEX);
        force->vector = fixture_constant3(0.1f, 0.0f, -0.2f * (float)i);
        force->axis = fixture_constant3(0.1f, 1.0f, 0.2f * (float)i);
        force->strength = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 3.0f, 1.0f, 5.0f);
        force->scale = fixture_constant(0.4f);
        force->inward = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.0f, 0.5f, 1.0f);
        force->lift = fixture_constant(0.7f);
        force->pull = fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 1.0f, 1.0f, 300.0f);
        force->profile = (enum kiln_vortex_profile)i;
    }
    struct kiln_force *added = fixture_add_force(whirling, KILN_FORCE_VORTEX);
    *added = whirling->forces[0];
    added->strength = fixture_constant(0.01f);
    added->mode = KILN_WIND_ADD;
    struct kiln_force *curl = fixture_add_force(whirling, KILN_FORCE_CURL);
    curl->strength = fixture_constant(0.02f);
    curl->drift = fixture_constant3(0.3f, 0.0f, -0.2f);
    curl->mode = KILN_WIND_ADD;
    struct kiln_force *wind = fixture_add_force(whirling, KILN_FORCE_WIND);
    wind->vector = fixture_constant3(0.01f, 0.0f, 0.0f);
    wind->mode = KILN_WIND_ADD;
}
