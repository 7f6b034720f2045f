/* Loads the mesh of an object of the backdrop, after all options are read, and finds the clip of an
 * animated mesh. The scene's library owns meshes and skins, which objects of the same file share.
 */
#include "scene/object_mesh.h"

#include <stdio.h>

#include "scene/asset_path.h"

/* Fills in the object's meshes, and its skin if it is animated. A mesh that takes paint is drawn
 * with texture coordinates for the paint, and collides without them. An animated mesh takes no
 * paint (validate.c refuses it). */
static bool load_meshes(const struct kiln_scene *scene, struct kiln_object *object,
                        struct kiln_error *error)
{
    struct kiln_mesh_library *meshes = scene->meshes;
    const bool unwrapped = kiln_object_takes_paint(object) && !object->animation.enabled;
    if (object->animation.enabled) {
        object->skin = kiln_mesh_library_get_skin(meshes, object->file, error);
        object->shown = object->skin ? kiln_skin_mesh(object->skin) : NULL;
    } else {
        object->shown = (unwrapped ? kiln_mesh_library_get_unwrapped
                                   : kiln_mesh_library_get)(meshes, object->file, error);
    }
    if (object->shown && object->collide)
        object->collision_mesh =
            unwrapped ? kiln_mesh_library_get(meshes, object->file, error) : object->shown;
    return object->shown && (object->collision_mesh || !object->collide);
}

bool kiln_object_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root, uint32_t i)
{
    struct kiln_object *object = &kiln_reader_scene(reader)->backdrop.objects[i];
    struct kiln_animation *animation = &object->animation;
    if (object->kind != KILN_OBJECT_MESH)
        return true;
    char path[64];
    struct kiln_error error = {0};
    const bool loaded = load_meshes(kiln_reader_scene(reader), object, &error);
    const bool found = loaded && (!animation->enabled ||
                                  kiln_skin_find_clip(object->skin, animation->clip, object->file,
                                                      &animation->number, &error));
    if (found && animation->enabled)
        animation->length = kiln_skin_clip_length(object->skin, animation->number);
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.%s", i,
             loaded ? "animation.clip" : "file");
    return found || kiln_asset_fail(reader, root, path, object->file, &error);
}
