/* Tells what a scene's meshes are, for kiln check. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "asset/geometry/closed.h"
#include "asset/geometry/mesh_measure.h"
#include "kiln_program.h"
#include "scene/scene.h"

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

static bool tell(void *user, const char *path, const struct kiln_mesh *mesh,
                 const struct kiln_skin *skin)
{
    const struct telling *telling = user;
    struct kiln_opening opening;
    struct kiln_mesh_clip clips[KILN_MAX_CLIPS];
    struct kiln_mesh_info info = {.path = below_root(telling->scene, path),
                                  .format = format_of(path),
                                  .triangles = mesh->triangle_count,
                                  .vertices = mesh->vertex_count,
                                  .joints = skin ? kiln_skin_bone_count(skin) : 0,
                                  .morph_targets = mesh->morph_target_count,
                                  .clips = clips,
                                  .clip_count = skin ? kiln_skin_clip_count(skin) : 0,
                                  .open = opening.text,
                                  .notes = mesh->notes,
                                  .thinnest = INFINITY};
    for (uint32_t i = 0; i < info.clip_count; i++)
        clips[i] = (struct kiln_mesh_clip){kiln_skin_clip_name(skin, i),
                                           (double)kiln_skin_clip_length(skin, i)};
    memcpy(info.min, mesh->min, sizeof info.min);
    memcpy(info.max, mesh->max, sizeof info.max);
    if (!kiln_mesh_find_opening(mesh, &opening) ||
        (!*opening.text && !kiln_mesh_thinnest(mesh, &info.thinnest)))
        return false;
    telling->visit(telling->user, &info);
    return true;
}

bool kiln_scene_visit_meshes(const struct kiln_scene *scene,
                             void (*visit)(void *user, const struct kiln_mesh_info *info),
                             void *user)
{
    struct telling telling = {scene, visit, user};
    return kiln_mesh_library_visit(scene->meshes, tell, &telling);
}
