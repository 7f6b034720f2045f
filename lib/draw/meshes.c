/* One after the other, in the order in which kiln_shapes_fill counts them. */
#include "draw/meshes.h"

static struct kiln_mesh *make_terrain(const struct kiln_object *object, struct kiln_error *error)
{
    const struct kiln_terrain_params params = kiln_scene_terrain(object);
    struct kiln_terrain *terrain = kiln_terrain_create(&params, error);
    struct kiln_mesh *mesh = terrain ? kiln_terrain_mesh(terrain, error) : NULL;
    kiln_terrain_destroy(&terrain);
    return mesh;
}

bool kiln_meshes_init(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                      struct kiln_error *error)
{
    *meshes = (struct kiln_meshes){.count = 0};
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_is_mesh(object))
            continue;
        struct kiln_mesh *mesh =
            object->kind == KILN_OBJECT_TERRAIN
                ? make_terrain(object, error)
                : kiln_mesh_load(object->file, scene->asset_root, scene->stop, scene->user, error);
        if (!mesh)
            return false;
        meshes->loaded[meshes->count++] = mesh;
    }
    return true;
}

void kiln_meshes_finish(struct kiln_meshes *meshes)
{
    for (uint32_t i = 0; i < meshes->count; i++)
        kiln_mesh_destroy(&meshes->loaded[i]);
    meshes->count = 0;
}
