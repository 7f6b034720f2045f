/* This file computes the part of the sun that each lit particle sees past the backdrop, on the
 * host. The cover of an object has a closed form, except for a mesh, which has a map. Every drawing
 * technique reads the same result. */
#include "draw/light/sun_shade.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/light_blocks.h"
#include "draw/light/sun_mesh.h"

enum { GRAIN = 8 * KILN_LANES }; /* slots that a worker takes at a time */

/* Describes an oriented box in its own frame. */
struct oriented_box {
    struct kiln_sun_box box; /* centred at the origin */
    struct kiln_sun_frame sun;
};

struct kiln_sun_shade {
    const struct kiln_scene *scene;
    struct kiln_sun_mesh *maps; /* one for each mesh */
    struct kiln_sun_frame sun;  /* of the current frame, as are shapes and boxes */
    const struct kiln_draw_shapes *shapes;
    uint32_t box_count;
    struct kiln_sun_box boxes[KILN_MAX_OBJECTS];
    struct kiln_sun_cylinder cylinders[KILN_MAX_OBJECTS]; /* shapes->counts.y of them */
    struct oriented_box oriented[KILN_MAX_OBJECTS];       /* shapes->oriented_counts.y of them */
    float *visible; /* by slot, whole rows of KILN_SUN_SHADE_ROW */
};

bool kiln_sun_shade_concerns(const struct kiln_scene *scene, uint32_t system)
{
    const struct kiln_system *s = &scene->systems[system];
    return s->enabled && !kiln_look_is_opaque(&s->look) &&
           kiln_scene_value_max(scene, &s->look.lit) > 0.0f;
}

bool kiln_sun_shade_exists(const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (kiln_sun_shade_concerns(scene, i))
            return scene->backdrop.object_count > 0;
    }
    return false;
}

struct kiln_sun_shade *kiln_sun_shade_create(const struct kiln_scene *scene,
                                             struct kiln_error *error)
{
    size_t meshes = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        meshes += kiln_object_is_mesh(&scene->backdrop.objects[i]);
    struct kiln_sun_shade *shade = calloc(1, sizeof *shade);
    if (shade)
        shade->maps = calloc(meshes ? meshes : 1, sizeof *shade->maps);
    if (!shade || !shade->maps) {
        kiln_error_no_memory(error, "the shade of particles");
        free(shade);
        return NULL;
    }
    shade->scene = scene;
    return shade;
}

void kiln_sun_shade_destroy(struct kiln_sun_shade **shade)
{
    if (!*shade)
        return;
    free((*shade)->maps);
    free((*shade)->visible);
    free(*shade);
    *shade = NULL;
}

static float3 xyz(float4 v)
{
    return (float3){v.x, v.y, v.z};
}

static float3 into_box(const struct kiln_draw_oriented_box *box, float3 v)
{
    return (float3){float3_dot(v, xyz(box->rows[0])), float3_dot(v, xyz(box->rows[1])),
                    float3_dot(v, xyz(box->rows[2]))};
}

static struct oriented_box oriented_box_at(const struct kiln_draw_oriented_box *box,
                                           const struct kiln_sun_frame *sun)
{
    const struct kiln_sun_frame there = {into_box(box, sun->right), into_box(box, sun->up),
                                         into_box(box, sun->towards), sun->spread};
    const float3 middle = {0.0f, 0.0f, 0.0f};
    return (struct oriented_box){kiln_sun_box_at(middle, xyz(box->half_size), &there), there};
}

static void place_objects(struct kiln_sun_shade *shade, const struct kiln_moment *moment)
{
    const struct kiln_scene *scene = shade->scene;
    const struct kiln_mesh *const *meshes = moment->meshes.loaded;
    const float time_s = moment->view.clock.x;
    shade->sun = moment->sun;
    shade->shapes = &moment->shapes;
    shade->box_count = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (object->kind != KILN_OBJECT_BOX || kiln_object_is_oriented_box(object))
            continue;
        float3 size = kiln_scene_value3(scene, &object->size, time_s);
        const float3 half = {0.5f * size.x, 0.5f * size.y, 0.5f * size.z};
        shade->boxes[shade->box_count++] =
            kiln_sun_box_at(kiln_scene_value3(scene, &object->center, time_s), half, &shade->sun);
    }
    for (uint32_t i = 0; i < shade->shapes->counts.y; i++) {
        const float4 cylinder = shade->shapes->cylinders[i], axis = shade->shapes->cylinder_axis[i];
        shade->cylinders[i] =
            kiln_sun_cylinder_at(xyz(cylinder), cylinder.w, xyz(axis), axis.w, &shade->sun);
    }
    for (uint32_t i = 0; i < shade->shapes->oriented_counts.y; i++)
        shade->oriented[i] = oriented_box_at(&shade->shapes->oriented_boxes[i], &shade->sun);
    for (uint32_t i = 0; i < shade->shapes->counts.z; i++)
        kiln_sun_mesh_update(&shade->maps[i], meshes[i], &shade->shapes->meshes[i], &shade->sun);
}

/* Describes the system whose particles are being shaded. */
struct shade_job {
    const struct kiln_sun_shade *shade;
    kiln_appearance_find *find;
    const struct kiln_light_loops *loops;
    struct kiln_appearance_system system;
    float *visible; /* by slot of the system */
};

static float oriented_visibility(const struct kiln_sun_shade *shade, struct kiln_ball ball)
{
    const struct kiln_draw_shapes *shapes = shade->shapes;
    float visible = 1.0f;
    for (uint32_t i = 0; i < shapes->oriented_counts.x; i++)
        visible *= 1.0f - kiln_capsule_sun_cover(xyz(shapes->capsules[i]), shapes->capsules[i].w,
                                                 xyz(shapes->capsule_axis[i]),
                                                 shapes->capsule_axis[i].w, ball, &shade->sun);
    for (uint32_t i = 0; i < shapes->oriented_counts.y; i++) {
        const struct oriented_box *oriented = &shade->oriented[i];
        const struct kiln_draw_oriented_box *box = &shapes->oriented_boxes[i];
        const struct kiln_ball there = {into_box(box, float3_sub(ball.center, xyz(box->center))),
                                        ball.radius};
        visible *= 1.0f - kiln_sun_box_cover(&oriented->box, there, &oriented->sun);
    }
    return visible;
}

/* Returns the part of the sun that a ball sees past all objects except boxes along the axes and
 * cylinders. */
static float others_visibility(const struct kiln_sun_shade *shade, struct kiln_ball ball)
{
    const struct kiln_draw_shapes *shapes = shade->shapes;
    const struct kiln_sun_frame *sun = &shade->sun;
    float visible = 1.0f;
    for (uint32_t i = 0; i < shapes->counts.x; i++)
        visible *=
            1.0f - kiln_sphere_sun_cover(xyz(shapes->spheres[i]), shapes->spheres[i].w, ball, sun);
    for (uint32_t i = 0; i < shapes->counts.z; i++)
        visible *= 1.0f - kiln_sun_mesh_cover(&shade->maps[i], ball);
    return visible * oriented_visibility(shade, ball);
}

/* Returns whether any object except boxes along the axes and cylinders may hide the sun. */
static bool has_others(const struct kiln_sun_shade *shade)
{
    const struct kiln_draw_shapes *shapes = shade->shapes;
    const uint4 counts = shapes->counts, oriented = shapes->oriented_counts;
    return counts.x > 0 || counts.z > 0 || oriented.x > 0 || oriented.y > 0;
}

/* Computes the shade of a block of particles. The parts that objects let through are multiplied, as
 * on the backdrop's surfaces. */
static void shade_block(const struct shade_job *job, uint32_t first)
{
    const struct kiln_sun_shade *shade = job->shade;
    struct kiln_appearance_block block;
    alignas(64) float visible[KILN_LANES];
    job->find(&job->system, first, &block);
    for (uint32_t i = 0; i < KILN_LANES; i++)
        visible[i] = 1.0f;
    const struct kiln_sun_shapes shapes = {shade->boxes, shade->cylinders, shade->box_count,
                                           shade->shapes->counts.y};
    job->loops->shade(&block, &shapes, &shade->sun, visible);
    if (has_others(shade)) {
        for (uint32_t i = 0; i < KILN_LANES; i++) {
            const struct kiln_ball ball = {kiln_get3(&block.position, i), block.radius[i]};
            visible[i] *= block.alive[i] ? others_visibility(shade, ball) : 1.0f;
        }
    }
    const uint32_t left = job->system.used - first;
    memcpy(job->visible + first, visible,
           (left < KILN_LANES ? left : KILN_LANES) * sizeof *visible);
}

static void shade_slots(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t slot = begin; slot < end; slot += KILN_LANES)
        shade_block(context, (uint32_t)slot);
}

const float *kiln_sun_shade_run(struct kiln_sun_shade *shade, const struct kiln_moment *moment,
                                struct kiln_threads *threads, struct kiln_error *error)
{
    if (!shade->visible) { /* once, since the number of slots does not change */
        size_t rows = (moment->pool->slot_count + KILN_SUN_SHADE_ROW - 1) / KILN_SUN_SHADE_ROW;
        shade->visible = calloc(rows * KILN_SUN_SHADE_ROW, sizeof *shade->visible);
    }
    if (!shade->visible) {
        kiln_error_no_memory(error, "the shade of particles");
        return NULL;
    }
    place_objects(shade, moment);
    for (uint32_t i = 0; i < shade->scene->system_count; i++) {
        struct shade_job job = {.shade = shade,
                                .find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd),
                                .loops = KILN_SIMD_PICK(kiln_light_loops, moment->simd)};
        if (!kiln_sun_shade_concerns(shade->scene, i))
            continue;
        job.system = kiln_appearance_system(moment, i);
        job.visible = shade->visible + moment->pool->systems[i].base;
        kiln_threads_for(threads, job.system.used, GRAIN, shade_slots, &job);
    }
    return shade->visible;
}
