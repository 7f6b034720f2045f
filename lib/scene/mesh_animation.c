#include "scene/mesh_animation.h"

#include <stdio.h>

#include "asset/skin.h"
#include "scene/particle_mesh.h"

bool kiln_mesh_animation_settle(struct kiln_reader *reader, const struct kiln_node *root,
                                uint32_t i)
{
    struct kiln_scene *scene = reader->scene;
    struct kiln_object *object = &scene->backdrop.objects[i];
    struct kiln_animation *animation = &object->animation;
    if (object->kind != KILN_OBJECT_MESH || !animation->enabled)
        return true;
    char path[64];
    struct kiln_error error = {0};
    struct kiln_skin *skin =
        kiln_skin_load(object->file, scene->asset_root, scene->stop, scene->user, &error);
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.%s", i, skin ? "animation.clip" : "file");
    const bool found = skin && kiln_skin_find_clip(skin, animation->clip, object->file,
                                                   &animation->number, &error);
    if (found)
        animation->length = kiln_skin_clip_length(skin, animation->number);
    kiln_skin_destroy(&skin);
    return found || kiln_mesh_file_fail(reader, root, path, object->file, &error);
}
