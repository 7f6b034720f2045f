/* This file computes the part of the sun that each lit particle sees past the backdrop, on the
 * host. The cover of an object has a closed form, except for a mesh, which has a map. Every drawing
 * technique reads the same result. */
#include "draw/light/sun_shade.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/shade_blocks.h"
#include "draw/light/sun_mesh.h"
#include "scene/work.h"

enum { GRAIN = 8 * KILN_LANES }; /* slots that a worker takes at a time */

struct kiln_sun_shade {
    const struct kiln_scene *scene;
    struct kiln_sun_mesh *maps; /* one for each mesh */
    struct kiln_sun_frame sun;  /* of the current frame, as are the shapes */
    const struct kiln_draw_shapes *shapes;
    const struct kiln_shape_seen *from_sun;
    struct kiln_shape_set casters;
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

static size_t count_meshes(const struct kiln_scene *scene)
{
    size_t meshes = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        meshes += kiln_object_is_mesh(&scene->backdrop.objects[i]);
    return meshes;
}

struct kiln_sun_shade *kiln_sun_shade_create(const struct kiln_scene *scene,
                                             struct kiln_error *error)
{
    const size_t meshes = count_meshes(scene);
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

void kiln_sun_shade_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_sun_shade *s = NULL;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, count_meshes(scene), sizeof *s->maps);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, kiln_work_particles(scene),
                       sizeof *s->visible);
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

void kiln_sun_shade_place(struct kiln_sun_shade *shade, const struct kiln_moment *moment)
{
    const struct kiln_mesh *const *meshes = moment->meshes.loaded;
    shade->sun = moment->sun;
    shade->shapes = &moment->shapes;
    shade->from_sun = moment->from_sun;
    shade->casters = kiln_shapes_that_hide(shade->shapes);
    for (uint32_t i = 0; i < shade->shapes->counts.z; i++)
        kiln_sun_mesh_update(&shade->maps[i], meshes[i], &shade->shapes->meshes[i], &shade->sun);
}

/* Describes the system whose particles are being shaded. */
struct shade_job {
    const struct kiln_sun_shade *shade;
    kiln_appearance_find *find;
    enum kiln_simd simd;
    struct kiln_appearance_system system;
    float *visible; /* by slot of the system */
};

/* Returns the part of the sun that a ball sees past meshes. */
static float past_meshes(const struct kiln_sun_shade *shade, struct kiln_ball ball)
{
    float visible = 1.0f;
    for (uint32_t i = 0; i < shade->shapes->counts.z; i++)
        visible *= 1.0f - kiln_sun_mesh_cover(&shade->maps[i], ball);
    return visible;
}

/* The parts that objects let through are multiplied, as on the backdrop's surfaces. */
void kiln_sun_shade_balls(const struct kiln_sun_shade *shade, enum kiln_simd simd,
                          const struct kiln_appearance_block *block, float *visible)
{
    kiln_sun_shade_block *shade_block = KILN_SIMD_PICK(kiln_sun_shade_block, simd);
    shade_block(shade->shapes, &shade->casters, shade->from_sun, &shade->sun, block, visible);
    for (uint32_t i = 0; i < KILN_LANES && shade->shapes->counts.z > 0; i++) {
        const struct kiln_ball ball = {kiln_get3(&block->position, i), block->radius[i]};
        visible[i] *= block->alive[i] ? past_meshes(shade, ball) : 1.0f;
    }
}

/* Computes the shade of a block of particles. */
static void shade_block(const struct shade_job *job, uint32_t first)
{
    struct kiln_appearance_block block;
    alignas(64) float visible[KILN_LANES];
    job->find(&job->system, first, &block);
    kiln_sun_shade_balls(job->shade, job->simd, &block, visible);
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
    kiln_sun_shade_place(shade, moment);
    for (uint32_t i = 0; i < shade->scene->system_count; i++) {
        struct shade_job job = {.shade = shade,
                                .find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd),
                                .simd = moment->simd};
        if (!kiln_sun_shade_concerns(shade->scene, i))
            continue;
        job.system = kiln_appearance_system(moment, i);
        job.visible = shade->visible + moment->pool->systems[i].base;
        kiln_threads_for(threads, job.system.used, GRAIN, shade_slots, &job);
    }
    return shade->visible;
}
