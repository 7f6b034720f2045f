/* One after the other, in the order in which kiln_shapes_fill counts them. */
#include "draw/meshes.h"

#include "base/error.h"

static struct kiln_mesh *make_terrain(const struct kiln_object *object, struct kiln_error *error)
{
    const struct kiln_terrain_params params = kiln_scene_terrain(object);
    struct kiln_terrain *terrain = kiln_terrain_create(&params, error);
    struct kiln_mesh *mesh = terrain ? kiln_terrain_mesh(terrain, error) : NULL;
    kiln_terrain_destroy(&terrain);
    return mesh;
}

/* One that moves; what there is at a failure is for kiln_meshes_finish. */
static struct kiln_mesh *make_moving(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                                     const struct kiln_object *object, struct kiln_error *error)
{
    struct kiln_skin *skin =
        kiln_skin_load(object->file, scene->asset_root, scene->stop, scene->user, error);
    if (!skin)
        return NULL;
    meshes->skins[meshes->count] = skin;
    meshes->animations[meshes->count] = &object->animation;
    meshes->posed_s[meshes->count] = -1.0f;
    struct kiln_mesh *mesh = kiln_skin_copy_mesh(skin);
    if (!mesh)
        kiln_error_set(error, KILN_DEVICE_FAILED, "meshes: out of memory");
    return mesh;
}

static struct kiln_mesh *make_mesh(struct kiln_meshes *meshes, const struct kiln_scene *scene,
                                   const struct kiln_object *object, struct kiln_error *error)
{
    if (object->kind == KILN_OBJECT_TERRAIN)
        return make_terrain(object, error);
    if (object->animation.enabled)
        return make_moving(meshes, scene, object, error);
    return (kiln_object_takes_paint(object) ? kiln_mesh_load_unwrapped : kiln_mesh_load)(
        object->file, scene->asset_root, scene->stop, scene->user, error);
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
        struct kiln_mesh *mesh = make_mesh(meshes, scene, object, error);
        if (!mesh)
            return false;
        meshes->loaded[meshes->count++] = mesh;
        painted = painted || kiln_object_takes_paint(object);
    }
    if (painted)
        meshes->painted = kiln_painted_create(scene, meshes->loaded, error);
    return !painted || meshes->painted;
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
        kiln_skin_pose_mesh(meshes->skins[i], animation->number, seconds, meshes->loaded[i]);
        meshes->posed_s[i] = seconds;
    }
}

void kiln_meshes_finish(struct kiln_meshes *meshes)
{
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        kiln_mesh_destroy(&meshes->loaded[i]);
        kiln_skin_destroy(&meshes->skins[i]);
    }
    kiln_painted_destroy(&meshes->painted);
    meshes->count = 0;
}
