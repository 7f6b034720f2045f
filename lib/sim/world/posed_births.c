/* This file poses the meshes with an animation on which particles are born. The mesh is posed at
 * both ends of a step, and each triangle goes straight from one pose to the other, so places in
 * between are off by the curvature of the way of a vertex: 1 mm for a hand that turns at 1 m from
 * its shoulder by 5 degrees in a step. Where a clip restarts within a step, the births of that step
 * lie on the end of the clip. */
#include "sim/world/posed_births.h"

#include <stdlib.h>

#include "asset/geometry/skin.h"
#include "base/error.h"
#include "scene/source.h"
#include "shared/exact.h"
#include "shared/source.h"

/* Returns the object that particles of a system are born on, if it has an animation, or NULL. */
static const struct kiln_object *posed_object(const struct kiln_scene *scene, uint32_t system)
{
    const struct kiln_emit_source *from = &scene->systems[system].emit.source;
    return from->made && from->made->corners ? &scene->backdrop.objects[from->number] : NULL;
}

bool kiln_sim_posed_init(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                         struct kiln_error *error)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_object *object = posed_object(scene, i);
        if (!object)
            continue;
        grids->poses[i] = calloc(2 * (size_t)object->shown->vertex_count, sizeof *grids->poses[i]);
        if (!grids->poses[i])
            return kiln_error_no_memory(error, "the vertices of %s", object->file);
    }
    return true;
}

void kiln_sim_posed_finish(struct kiln_sim_grids *grids)
{
    for (uint32_t i = 0; i < KILN_MAX_SYSTEMS; i++)
        free(grids->poses[i]);
}

void kiln_sim_posed_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_sim_grids *grids = NULL;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_object *object = posed_object(scene, i);
        if (object)
            kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS,
                               2 * (uint64_t)object->shown->vertex_count, sizeof *grids->poses[i]);
    }
}

/* Writes a vector and keeps the fourth number of the word. */
static void write_word(float4 *word, const float v[3])
{
    word->x = exact_canon(v[0]);
    word->y = exact_canon(v[1]);
    word->z = exact_canon(v[2]);
}

static void write_triangle(float4 *words, const uint32_t corners[3], float (*before)[6],
                           float (*after)[6])
{
    float ways[2][3][3]; /* at both ends: the first corner, and the ways to the others */
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++) {
            ways[0][k][c] = before[corners[k]][c] - (k > 0 ? before[corners[0]][c] : 0.0f);
            ways[1][k][c] = after[corners[k]][c] - (k > 0 ? after[corners[0]][c] : 0.0f);
        }
    }
    for (int k = 0; k < 3; k++) {
        const float *from = ways[0][k], *to = ways[1][k];
        write_word(&words[k], from);
        write_word(&words[3 + k],
                   (const float[3]){to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    }
}

void kiln_sim_pose_words(float4 *words, const struct kiln_source *source,
                         const struct kiln_object *object, float (*poses)[6], float start_s,
                         float end_s)
{
    const struct kiln_animation *animation = &object->animation;
    const uint32_t vertices = object->shown->vertex_count;
    float(*after)[6] = poses + vertices, last_s;
    if (!kiln_scene_animation_ends(animation, start_s, end_s, &last_s))
        last_s = kiln_scene_animation_s(animation, end_s);
    kiln_skin_pose(object->skin, animation->number, kiln_scene_animation_s(animation, start_s),
                   poses);
    kiln_skin_pose(object->skin, animation->number, last_s, after);
    for (uint32_t i = 0; i < source->cells; i++)
        write_triangle(words + (size_t)i * SOURCE_POSED_WORDS, source->corners[i], poses, after);
}

bool kiln_sim_pose_births(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                          uint32_t step, struct kiln_error *error)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_object *object = posed_object(scene, i);
        if (!object || grids->posed_step[i] == step)
            continue;
        float4 *words = kiln_buffer_host(&grids->words, KILN_READ_WRITE, error);
        if (!words)
            return false;
        kiln_sim_pose_words(words + grids->sources[i], scene->systems[i].emit.source.made, object,
                            grids->poses[i], start_s, end_s);
        grids->posed_step[i] = step;
    }
    return true;
}
