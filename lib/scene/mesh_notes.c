/* This file warns of what the readers of meshes changed or left out: weights that do not sum to 1,
 * say. The mesh is used, so it is no error, but its author may want to know. */
#include "scene/mesh_notes.h"

#include <stdio.h>
#include <string.h>

#include "base/log.h"
#include "scene/asset_path.h"
#include "scene/scene.h"

/* Logs the notes of a mesh, one by one. path: the key of its file. */
static void warn(struct kiln_reader *reader, const struct kiln_node *root,
                 const struct kiln_log *log, const char *path, const char *file,
                 const struct kiln_mesh *mesh)
{
    for (const char *note = mesh->notes; *note;) {
        const size_t length = strcspn(note, "\n");
        struct kiln_error reason = {0}, found = {0}, *kept = reader->error;
        snprintf(reason.message, sizeof reason.message, "%s: %.*s", file, (int)length, note);
        reader->error = &found;
        kiln_asset_fail(reader, root, path, file, &reason);
        reader->error = kept;
        kiln_log_write(log, KILN_LOG_WARNING, "%s", found.message);
        note += length + (note[length] == '\n');
    }
}

void kiln_mesh_notes_warn(struct kiln_reader *reader, const struct kiln_node *root,
                          const struct kiln_log *log)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    char path[128];
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        snprintf(path, sizeof path, "backdrop.objects.%u.mesh.file", i);
        if (object->kind == KILN_OBJECT_MESH && object->shown)
            warn(reader, root, log, path, object->file, object->shown);
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look_mesh *mesh = &scene->systems[i].look.mesh;
        snprintf(path, sizeof path, "systems.%s.look.mesh.file", scene->systems[i].name);
        if (scene->systems[i].enabled && mesh->shown)
            warn(reader, root, log, path, mesh->file, mesh->shown);
    }
}
