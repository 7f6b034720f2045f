/* This file collects the meshes of the backdrop: it takes loaded meshes from the scene, makes
 * terrains, and poses copies of animated meshes. The meshes have the order of the scene's objects,
 * since kiln_shapes_fill numbers them in that order, too. Each copy keeps the animation time of its
 * pose, so that a mesh is posed and uploaded again only when that time has changed. */
#include "draw/moment/meshes.h"

#include "base/error.h"

static struct kiln_mesh *make_terrain(const struct kiln_scene *scene,
                                      const struct kiln_object *object, struct kiln_error *error)
{
    const struct kiln_terrain_params params = kiln_scene_terrain(scene, object);
    struct kiln_terrain *terrain = kiln_terrain_create(&params, error);
    struct kiln_mesh *mesh = terrain ? kiln_terrain_mesh(terrain, error) : NULL;
    kiln_terrain_destroy(&terrain);
    return mesh;
}

/* Returns a copy of an animated mesh, which kiln_meshes_pose changes, and notes its animation. */
static struct kiln_mesh *make_moving(struct kiln_meshes *meshes, const struct kiln_object *object,
                                     struct kiln_error *error)
{
    meshes->skins[meshes->count] = object->skin;
    meshes->animations[meshes->count] = &object->animation;
    meshes->posed_s[meshes->count] = -1.0f;
    struct kiln_mesh *mesh = kiln_mesh_copy(object->shown);
    if (!mesh)
        kiln_error_no_memory(error, "the meshes");
    return mesh;
}

static bool add_mesh(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                     const struct kiln_object *object, struct kiln_error *error)
{
    struct kiln_mesh **own = &meshes->own[meshes->count];
    if (object->kind == KILN_OBJECT_TERRAIN)
        *own = make_terrain(scene, object, error);
    else if (object->animation.enabled)
        *own = make_moving(meshes, object, error);
    else
        meshes->loaded[meshes->count] = object->shown;
    if (*own)
        meshes->loaded[meshes->count] = *own;
    return meshes->loaded[meshes->count++] != NULL;
}

bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error)
{
    *meshes = (struct kiln_meshes){.count = 0};
    bool painted = false;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_is_mesh(object))
            continue;
        if (!add_mesh(meshes, scene, object, error))
            return false;
        painted = painted || kiln_object_takes_paint(object);
    }
    if (painted)
        meshes->painted = kiln_painted_create(scene, meshes->loaded, error);
    return !painted || meshes->painted;
}

void kiln_meshes_count(const struct kiln_scene *scene, uint64_t *vertices, uint64_t *triangles)
{
    *vertices = *triangles = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        uint64_t own_vertices = 0, own_triangles = 0;
        if (object->kind == KILN_OBJECT_TERRAIN) {
            kiln_terrain_mesh_count(object->samples, &own_vertices, &own_triangles);
        } else if (object->kind == KILN_OBJECT_MESH) {
            own_vertices = object->shown->vertex_count;
            own_triangles = object->shown->triangle_count;
        }
        *vertices += own_vertices;
        *triangles += own_triangles;
    }
}

void kiln_meshes_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (object->kind == KILN_OBJECT_TERRAIN) {
            const struct kiln_mesh *m = NULL;
            uint64_t vertices, triangles;
            kiln_terrain_mesh_count(object->samples, &vertices, &triangles);
            kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, vertices, sizeof *m->vertices);
            kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, triangles, sizeof *m->triangles);
            kiln_footprint_pass(footprint, KILN_FOOTPRINT_OBJECTS,
                                kiln_terrain_bytes(object->samples));
        } else if (object->kind == KILN_OBJECT_MESH && object->animation.enabled) {
            kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, 1,
                               kiln_mesh_bytes(object->shown));
        }
    }
    kiln_painted_footprint(scene, footprint);
}

void kiln_meshes_pose(struct kiln_meshes *meshes, float time_s)
{
    for (uint32_t i = 0; i < meshes->count; i++) {
        const struct kiln_animation *animation = meshes->animations[i];
        if (!animation)
            continue;
        const float seconds = kiln_scene_animation_s(animation, time_s);
        if (seconds == meshes->posed_s[i])
            continue;
        kiln_skin_pose_mesh(meshes->skins[i], animation->number, seconds, meshes->own[i]);
        meshes->posed_s[i] = seconds;
    }
}

void kiln_meshes_finish(struct kiln_meshes *meshes)
{
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++)
        kiln_mesh_destroy(&meshes->own[i]);
    kiln_painted_destroy(&meshes->painted);
    meshes->count = 0;
}
