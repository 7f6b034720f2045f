/* This file makes a step's colliders from the scene's objects and the floor. Each collider has its
 * place at the start and at the end of the step. */
#include "sim/world/colliders.h"

#include <string.h>

#include "base/matrix.h"
#include "shared/exact.h"
#include "sim/world/oriented.h"

static float4 to_float4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

/* Computes a box's lower and upper corner. */
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

/* A sphere or cylinder at a time: centre, radius, half of the height, and the bounding box. */
struct round_values {
    float4 center;
    float half_height;
    float4 min, max;
};

static struct round_values round_values(const struct kiln_scene *scene,
                                        const struct kiln_object *object, float3 axis, float time_s)
{
    float3 center = kiln_object_center(scene, object, time_s);
    float radius = kiln_object_length(scene, object, &object->radius, time_s);
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
    if (object->kind == KILN_OBJECT_CYLINDER) /* a cylinder's height does not vary */
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
        .half_height_end = end.half_height,
    };
}

static struct kiln_collider box_collider(const struct kiln_scene *scene,
                                         const struct kiln_object *object, float start_s,
                                         float end_s)
{
    struct kiln_collider box = {.grid = 0};
    box_corners(scene, object, start_s, &box.min, &box.max);
    box_corners(scene, object, end_s, &box.min_end, &box.max_end);
    return box;
}

uint kiln_sim_collider_kind(const struct kiln_object *object)
{
    if (kiln_object_is_oriented(object))
        return kiln_oriented_kind(object);
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return COLLIDER_BOX;
    case KILN_OBJECT_TERRAIN:
        return COLLIDER_TERRAIN;
    case KILN_OBJECT_MESH:
        if (kiln_volumes_needs(object))
            return COLLIDER_VOLUME;
        return kiln_sim_mesh_row(object)->kind;
    case KILN_OBJECT_SPHERE:
        return COLLIDER_SPHERE;
    default:
        return COLLIDER_CYLINDER;
    }
}

/* Makes the floor's collider, a box as wide and deep as the world. */
static struct kiln_collider floor_collider(float before_m, float after_m)
{
    return (struct kiln_collider){
        .min = FLOAT4(-KILN_WORLD, -KILN_WORLD, -KILN_WORLD, 0.0f),
        .max = FLOAT4(KILN_WORLD, exact_canon(before_m), KILN_WORLD, 0.0f),
        .min_end = FLOAT4(-KILN_WORLD, -KILN_WORLD, -KILN_WORLD, 0.0f),
        .max_end = FLOAT4(KILN_WORLD, exact_canon(after_m), KILN_WORLD, 0.0f),
    };
}

/* Makes a terrain's collider, which has no lower end. Its box ends just above its highest point, so
 * that particles higher up need no look-up. */
static struct kiln_collider terrain_collider(const struct kiln_sim_grids *grids, uint32_t number)
{
    const struct kiln_grid *grid = &grids->table[number];
    const float width = (float)(grid->size.x - 1), depth = (float)(grid->size.z - 1);
    struct kiln_collider terrain = {
        .min = FLOAT4(grid->origin.x, -KILN_WORLD, grid->origin.z, 0.0f),
        .max = FLOAT4(exact_canon(grid->origin.x + width / grid->per_metre.x),
                      exact_canon(grids->top[number] + 0.01f),
                      exact_canon(grid->origin.z + depth / grid->per_metre.z), 0.0f),
        .grid = number,
        .steepest = grids->steepest[number],
    };
    terrain.min_end = terrain.min;
    terrain.max_end = terrain.max;
    return terrain;
}

/* The pose of a mesh at a time, from its frame to the world. scale: metres in one unit. */
struct pose {
    mat3 rotation;
    vec3 position;
    float scale;
};

static struct pose pose_at(const struct kiln_scene *scene, const struct kiln_object *mesh,
                           float time_s)
{
    const float3 at = kiln_object_center(scene, mesh, time_s);
    struct pose pose = {.position = {at.x, at.y, at.z},
                        .scale = kiln_object_length(scene, mesh, &mesh->scale, time_s)};
    kiln_object_rotation(scene, mesh, time_s, pose.rotation);
    return pose;
}

/* Returns the rotation from pose a to pose b as a vector along its axis, as long as its angle. */
static float3 turn_between(struct pose a, struct pose b)
{
    mat3 turn; /* b a^T */
    glm_mat3_transpose(a.rotation);
    glm_mat3_mul(b.rotation, a.rotation, turn);
    const float3 skew = FLOAT3(0.5f * (turn[1][2] - turn[2][1]), 0.5f * (turn[2][0] - turn[0][2]),
                               0.5f * (turn[0][1] - turn[1][0]));
    const float sine = float3_length(skew);
    const float cosine = 0.5f * (glm_mat3_trace(turn) - 1.0f);
    float angle = 0.0f;
    for (int i = 0; i < 4; i++) { /* the rest of the rotation has this sine */
        const struct exact_angle found = exact_sincos(angle);
        angle += sine * found.cosine - cosine * found.sine;
    }
    return float3_scale(float3_normalize(skew, FLOAT3(0.0f, 0.0f, 0.0f)), angle);
}

/* Inverts a pose: the rotation is transposed and divided by the scale. */
static void invert(struct pose pose, float4 to_local[3])
{
    for (int i = 0; i < 3; i++) {
        vec3 row;
        glm_vec3_divs(pose.rotation[i], pose.scale, row);
        to_local[i] = to_float4(row);
        to_local[i].w = exact_canon(-glm_vec3_dot(row, pose.position));
    }
}

/* A grid's bounding box, in the frame of its mesh. */
struct extent {
    vec3 half, middle;
};

static struct extent extent_of(const struct kiln_mesh_row *row, const struct kiln_grid *grid)
{
    struct extent extent;
    vec3 low;
    row->extent(grid, extent.half, low);
    glm_vec3_add(low, extent.half, extent.middle);
    return extent;
}

/* Finds the bounding box in the world of a posed extent, larger by a factor. */
static void bound(struct pose pose, const struct extent *extent, float factor, float4 *min,
                  float4 *max)
{
    vec3 center, low, high, reach = GLM_VEC3_ZERO_INIT;
    glm_vec3_copy(pose.position, center);
    glm_mat3_scale(pose.rotation, pose.scale);
    for (int c = 0; c < 3; c++) {
        vec3 size;
        glm_vec3_abs(pose.rotation[c], size);
        glm_vec3_muladds(pose.rotation[c], extent->middle[c], center);
        glm_vec3_muladds(size, extent->half[c], reach);
    }
    glm_vec3_scale(reach, factor, reach);
    glm_vec3_sub(center, reach, low);
    glm_vec3_add(center, reach, high);
    *min = to_float4(low);
    *max = to_float4(high);
}

/* Makes the collider and the pose of a mesh. While a mesh turns, its frame is interpolated linearly
 * between both poses, which enlarges the mesh on the way: by less than half for turns of less than
 * 96 degrees a step. */
static struct kiln_collider mesh_collider(const struct kiln_scene *scene,
                                          const struct kiln_sim_grids *grids, uint32_t index,
                                          float start_s, float end_s, float steps_per_s,
                                          struct kiln_pose *out)
{
    const struct kiln_object *mesh = &scene->backdrop.objects[index];
    const uint32_t number = grids->of_object[index];
    const struct pose start = pose_at(scene, mesh, start_s), end = pose_at(scene, mesh, end_s);
    struct kiln_collider field = {.grid = number, .mesh = number - grids->wind_count};
    const struct extent extent = extent_of(kiln_sim_mesh_row(mesh), &grids->table[number]);
    const float factor =
        memcmp(start.rotation, end.rotation, sizeof start.rotation) != 0 ? 1.5f : 1.0f;
    bound(start, &extent, factor, &field.min, &field.max);
    bound(end, &extent, factor, &field.min_end, &field.max_end);
    invert(start, out->to_local);
    invert(end, out->to_local_end);
    out->metres = FLOAT4(start.scale, end.scale, 0.0f, 0.0f);
    out->center = to_float4(start.position);
    out->center_end = to_float4(end.position);
    out->turn = canon4(float3_scale(turn_between(start, end), steps_per_s), 0.0f);
    return field;
}

static struct kiln_collider object_collider(struct kiln_surroundings *around,
                                            const struct kiln_scene *scene,
                                            const struct kiln_sim_grids *grids, uint32_t index,
                                            float start_s, float end_s)
{
    const struct kiln_object *object = &scene->backdrop.objects[index];
    const uint kind = kiln_sim_collider_kind(object);
    struct kiln_collider c;
    switch (kind) {
    case COLLIDER_BOX:
        c = box_collider(scene, object, start_s, end_s);
        break;
    case COLLIDER_SPHERE:
    case COLLIDER_CYLINDER:
        c = round_collider(scene, object, start_s, end_s);
        break;
    case COLLIDER_TERRAIN:
        c = terrain_collider(grids, grids->of_object[index]);
        break;
    case COLLIDER_SDF:
    case COLLIDER_DEPTH:
        c = mesh_collider(scene, grids, index, start_s, end_s, around->steps_per_s,
                          &around->poses[grids->of_object[index] - grids->wind_count]);
        break;
    case COLLIDER_VOLUME:
        c = kiln_volumes_collider(&grids->volumes, index, grids->count, around->grids);
        break;
    default:
        c = kiln_oriented_collider(scene, object, start_s, end_s);
    }
    c.kind = kind;
    if (kind < COLLIDER_TERRAIN) {
        const float3 turn = kiln_object_turn(scene, object, start_s, end_s, c.spin);
        c.min.w = turn.x;
        c.max.w = turn.y;
        c.min_end.w = turn.z;
    }
    c.restitution = kiln_scene_value(scene, &object->restitution, start_s);
    c.friction = kiln_scene_value(scene, &object->friction, start_s);
    return c;
}

bool kiln_sim_stores_surroundings(const struct kiln_scene *scene)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    uint32_t count = kiln_backdrop_floor_collides(backdrop), meshes = 0;
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        count += object->collide;
        meshes += object->collide && kiln_object_is_mesh(object);
    }
    return count > KILN_BLOCK_COLLIDERS || meshes > KILN_BLOCK_MESHES;
}

void kiln_sim_colliders_fill(struct kiln_surroundings *around, const struct kiln_scene *scene,
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
    if (kiln_backdrop_floor_collides(backdrop)) {
        struct kiln_collider *c = &around->colliders[around->collider_count++];
        *c = floor_collider(kiln_scene_value(scene, &backdrop->floor_height, start_s),
                            kiln_scene_value(scene, &backdrop->floor_height, end_s));
        c->restitution = kiln_scene_value(scene, &backdrop->floor_restitution, start_s);
        c->friction = kiln_scene_value(scene, &backdrop->floor_friction, start_s);
    }
}
