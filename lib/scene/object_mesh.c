/* Loads the meshes of the backdrop's objects, and finds the clips of those that move. */
#include "scene/object_mesh.h"

#include <stdio.h>

#include "scene/asset_path.h"

static bool import(const struct kiln_scene *scene, struct kiln_object *object,
                   struct kiln_error *error)
{
    struct kiln_mesh_library *meshes = scene->meshes;
    const bool painted = kiln_object_takes_paint(object) && !object->animation.enabled;
    if (object->animation.enabled) {
        object->skin = kiln_mesh_library_get_skin(meshes, object->file, error);
        object->shown = object->skin ? kiln_skin_mesh(object->skin) : NULL;
    } else {
        object->shown = (painted ? kiln_mesh_library_get_unwrapped
                                 : kiln_mesh_library_get)(meshes, object->file, error);
    }
    if (object->shown && object->collide)
        object->met = painted ? kiln_mesh_library_get(meshes, object->file, error) : object->shown;
    return object->shown && (object->met || !object->collide);
}

bool kiln_object_mesh_settle(struct kiln_reader *reader, const struct kiln_node *root, uint32_t i)
{
    struct kiln_object *object = &kiln_reader_scene(reader)->backdrop.objects[i];
    struct kiln_animation *animation = &object->animation;
    if (object->kind != KILN_OBJECT_MESH)
        return true;
    char path[64];
    struct kiln_error error = {0};
    const bool imported = import(kiln_reader_scene(reader), object, &error);
    const bool found = imported && (!animation->enabled ||
                                    kiln_skin_find_clip(object->skin, animation->clip, object->file,
                                                        &animation->number, &error));
    if (found && animation->enabled)
        animation->length = kiln_skin_clip_length(object->skin, animation->number);
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.%s", i,
             imported ? "animation.clip" : "file");
    return found || kiln_asset_fail(reader, root, path, object->file, &error);
}
