/* Tells what a scene's meshes are, for kiln check. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "asset/geometry/closed.h"
#include "asset/geometry/mesh_measure.h"
#include "kiln_program.h"
#include "scene/mesh_looks.h"
#include "scene/scene.h"

enum { NOTES_SIZE = 2 * KILN_MESSAGE_SIZE };

struct telling {
    const struct kiln_scene *scene;
    void (*visit)(void *user, const struct kiln_mesh_info *info);
    void *user;
};

static const char *format_of(const char *path)
{
    static const char *const formats[][2] = {
        {".obj", "OBJ"}, {".gltf", "glTF"}, {".glb", "GLB"}, {".ply", "PLY"}, {".stl", "STL"}};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++) {
        if (strcasecmp(dot, formats[i][0]) == 0)
            return formats[i][1];
    }
    return "mesh";
}

/* Returns a path without the asset root before it. */
static const char *below_root(const struct kiln_scene *scene, const char *path)
{
    const size_t length = scene->asset_root ? strlen(scene->asset_root) : 0;
    return length > 0 && strncmp(path, scene->asset_root, length) == 0 && path[length] == '/'
               ? path + length + 1
               : path;
}

/* Adds the lines of `more` that `notes` has not. */
static void add_notes(char notes[NOTES_SIZE], const char *more)
{
    char line[KILN_MESSAGE_SIZE];
    for (const char *at = more; *at;) {
        const size_t length = strcspn(at, "\n"), used = strlen(notes);
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        if (!strstr(notes, line))
            snprintf(notes + used, (size_t)NOTES_SIZE - used, "%s\n", line);
        at += length + (at[length] == '\n');
    }
}

/* Loads a mesh once more, with its materials, and describes them. The mesh of the scene has none.
 * The caller frees the text; NULL: memory is short. */
static char *describe_looks(const struct kiln_scene *scene, const char *path,
                            char notes[NOTES_SIZE])
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load_with_materials(scene->loader, path, &error);
    if (!mesh && error.code == KILN_DEVICE_FAILED)
        return NULL;
    add_notes(notes, mesh ? mesh->notes : error.message);
    char *text = mesh ? kiln_mesh_looks_describe(mesh->looks) : strdup("");
    kiln_mesh_destroy(&mesh);
    return text;
}

/* Fills in what is measured: where a mesh is open, or how thin it is. False: memory is short. */
static bool measure(const struct kiln_mesh *mesh, struct kiln_opening *opening,
                    struct kiln_mesh_info *info)
{
    info->thinnest = INFINITY;
    info->open = opening->text;
    memcpy(info->min, mesh->min, sizeof info->min);
    memcpy(info->max, mesh->max, sizeof info->max);
    return kiln_mesh_find_opening(mesh, opening) &&
           (*opening->text || kiln_mesh_thinnest(mesh, &info->thinnest));
}

static bool tell(void *user, const char *path, const struct kiln_mesh *mesh,
                 const struct kiln_skin *skin)
{
    const struct telling *telling = user;
    struct kiln_opening opening;
    struct kiln_mesh_clip clips[KILN_MAX_CLIPS];
    char notes[NOTES_SIZE] = "";
    add_notes(notes, mesh->notes);
    char *looks = describe_looks(telling->scene, path, notes);
    struct kiln_mesh_info info = {.path = below_root(telling->scene, path),
                                  .format = format_of(path),
                                  .triangles = mesh->triangle_count,
                                  .vertices = mesh->vertex_count,
                                  .joints = skin ? kiln_skin_bone_count(skin) : 0,
                                  .morph_targets = mesh->morph_target_count,
                                  .clips = clips,
                                  .clip_count = skin ? kiln_skin_clip_count(skin) : 0,
                                  .looks = looks,
                                  .notes = notes};
    for (uint32_t i = 0; i < info.clip_count; i++)
        clips[i] = (struct kiln_mesh_clip){kiln_skin_clip_name(skin, i),
                                           (double)kiln_skin_clip_length(skin, i)};
    const bool ok = looks && measure(mesh, &opening, &info);
    if (ok)
        telling->visit(telling->user, &info);
    free(looks);
    return ok;
}

bool kiln_scene_visit_meshes(const struct kiln_scene *scene,
                             void (*visit)(void *user, const struct kiln_mesh_info *info),
                             void *user)
{
    struct telling telling = {scene, visit, user};
    return kiln_mesh_library_visit(scene->meshes, tell, &telling);
}
