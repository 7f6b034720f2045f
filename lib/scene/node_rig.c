/* This file settles the nodes of a scene that are nodes of glTF files: it loads the files, and
 * finds the nodes, the clips and the cameras that the scene names. */
#include "scene/node_rig.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/rig.h"
#include "scene/asset_path.h"

/* ---- keys that go together ------------------------------------------------------------------- */

static bool fail(struct kiln_reader *reader, const struct kiln_node *root,
                 const struct kiln_scene_node *node, const char *key, const char *text)
{
    char path[96];
    snprintf(path, sizeof path, "nodes.%s.%s", node->name, key);
    return kiln_reader_error_at(reader, root, path, "%s", text);
}

static bool is_zero(const struct kiln_value3 *value)
{
    return kiln_value3_is_constant(value) && value->x.constant == 0.0f &&
           value->y.constant == 0.0f && value->z.constant == 0.0f;
}

/* Returns the key of a joint's own place that the scene gives, or NULL. */
static const char *find_own_place(const struct kiln_scene_node *node)
{
    if (node->parent.name)
        return "parent";
    if (node->position.path.points.count > 0 || !is_zero(&node->position.value))
        return "position";
    if (!is_zero(&node->rotation))
        return "rotation";
    return node->scale.count > 0 || node->scale.constant != 1.0f ? "scale" : NULL;
}

static bool check_keys(struct kiln_reader *reader, const struct kiln_node *root,
                       const struct kiln_scene_node *node)
{
    char path[96];
    snprintf(path, sizeof path, "nodes.%s", node->name);
    const struct kiln_node *nodes = kiln_node_entry(root, "nodes");
    const struct kiln_node *rows = nodes ? kiln_node_entry(nodes, node->name) : NULL;
    if (node->file && !node->file_node)
        return fail(reader, root, node, "file", "needs `node`, which says which node of the file");
    if (!node->file && node->file_node)
        return fail(reader, root, node, "node", "needs `file`, whose node it is");
    if (!node->file && rows && kiln_node_entry(rows, "animation") && node->animation.enabled)
        return fail(reader, root, node, "animation",
                    node->mesh ? "must be left out, since the joint follows the animation of its "
                                 "mesh, which stands in backdrop.objects"
                               : "needs `file`, whose animation it is");
    if (node->mesh && !node->joint)
        return fail(reader, root, node, "mesh", "needs `joint`, which says which joint of it");
    if (!node->mesh && node->joint)
        return fail(reader, root, node, "joint", "needs `mesh`, whose joint it is");
    if (node->mesh && node->file)
        return fail(reader, root, node, "mesh",
                    "a node is either a joint of a mesh or a node of a file");
    if (node->mesh && find_own_place(node))
        return fail(reader, root, node, find_own_place(node),
                    "must be left out, since the mesh says where its joint is; a node with this "
                    "one as parent has a place of its own");
    return true;
}

/* ---- objects --------------------------------------------------------------------------------- */

/* Finds the object of a number, which is that of its place, from 0. */
static bool find_numbered_object(struct kiln_reader *reader, const struct kiln_node *root,
                                 const char *path, uint64_t number, struct kiln_scene_node *node)
{
    const struct kiln_backdrop *backdrop = &kiln_reader_scene(reader)->backdrop;
    if (backdrop->object_count == 0)
        return kiln_reader_error_at(reader, root, path, "backdrop.objects has no objects");
    if (number >= backdrop->object_count)
        return kiln_reader_error_at(reader, root, path,
                                    "backdrop.objects has no object %" PRIu64
                                    "; allowed is from 0 to %u",
                                    number, backdrop->object_count - 1);
    node->object = (uint32_t)number;
    return backdrop->objects[number].kind == KILN_OBJECT_MESH ||
           kiln_reader_error_at(reader, root, path,
                                "must be a mesh; object %" PRIu64 " is of another kind", number);
}

static bool find_object(struct kiln_reader *reader, const struct kiln_node *root,
                        struct kiln_scene_node *node)
{
    const struct kiln_backdrop *backdrop = &kiln_reader_scene(reader)->backdrop;
    const char *names[KILN_MAX_OBJECTS];
    uint32_t count = 0;
    uint64_t number = 0;
    char path[96], suggestion[512], quoted[64];
    snprintf(path, sizeof path, "nodes.%s.mesh", node->name);
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const struct kiln_object *object = &backdrop->objects[i];
        if (object->kind != KILN_OBJECT_MESH || !object->name)
            continue;
        names[count++] = object->name;
        node->object = i;
        if (strcmp(object->name, node->mesh) == 0)
            return true;
    }
    if (kiln_text_to_uint64(node->mesh, &number))
        return find_numbered_object(reader, root, path, number, node);
    kiln_option_suggest(suggestion, sizeof suggestion, node->mesh, names, count);
    kiln_node_quote(quoted, node->mesh);
    if (count == 0 && backdrop->object_count > 0)
        return kiln_reader_error_at(reader, root, path,
                                    "unknown mesh '%s' in backdrop.objects (no mesh has a name; "
                                    "allowed is a number from 0 to %u)",
                                    quoted, backdrop->object_count - 1);
    return kiln_reader_error_at(reader, root, path, "unknown mesh '%s' in backdrop.objects%s",
                                quoted, suggestion);
}

bool kiln_node_rigs_find_objects(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        struct kiln_scene_node *node = &scene->nodes[i];
        if (!check_keys(reader, root, node) || (node->mesh && !find_object(reader, root, node)))
            return false;
        if (!node->file)
            node->animation.enabled = false; /* it is on where the scene does not speak of it */
    }
    return true;
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Finds the node and the clip of a file that a node of the scene names. */
static bool find_in_file(const struct kiln_scene *scene, struct kiln_scene_node *node,
                         const char *file, const char **key, struct kiln_error *error)
{
    struct kiln_animation *animation = &node->animation;
    *key = "file";
    node->rig = kiln_mesh_library_get_rig(scene->meshes, file, error);
    if (!node->rig)
        return false;
    *key = node->mesh ? "joint" : "node";
    if (!kiln_rig_find_node(node->rig, node->mesh ? node->joint : node->file_node,
                            node->mesh != NULL, file, &node->rig_node, error))
        return false;
    *key = "animation.clip";
    if (node->mesh || !animation->enabled)
        return true;
    if (kiln_rig_clip_count(node->rig) == 0 && strcmp(animation->clip, "0") == 0) {
        animation->enabled = false;
        return true;
    }
    if (!kiln_rig_find_clip(node->rig, animation->clip, file, &animation->number, error))
        return false;
    animation->length = kiln_rig_clip_length(node->rig, animation->number);
    return true;
}

/* Finds the clip of a mesh before the mesh is loaded. Its own errors come when that is. */
static uint32_t clip_of(const struct kiln_scene *scene, const struct kiln_scene_node *node)
{
    const struct kiln_animation *animation =
        node->mesh ? &scene->backdrop.objects[node->object].animation : &node->animation;
    struct kiln_error ignored = {0};
    uint32_t number = KILN_RIG_AT_REST;
    return animation->enabled &&
                   kiln_rig_find_clip(node->rig, animation->clip, "", &number, &ignored)
               ? number
               : KILN_RIG_AT_REST;
}

/* Warns of a scale of the file's node, or of one above it, that a node of a scene cannot have. */
static void warn_of_scale(struct kiln_reader *reader, const struct kiln_node *root,
                          const char *path, const struct kiln_scene_node *node)
{
    const uint32_t clip = clip_of(kiln_reader_scene(reader), node);
    struct kiln_rig_scale scale;
    char name[80];
    if (!kiln_rig_find_scale(node->rig, node->rig_node, clip, &scale))
        return;
    if (*scale.name)
        snprintf(name, sizeof name, "'%s'", scale.name);
    else
        snprintf(name, sizeof name, "%u", scale.number);
    kiln_reader_warn_at(reader, root, path,
                        "node %s of the file has the scale [%g, %g, %g]; a node of a scene has one "
                        "scale, %g at least, so %g is taken",
                        name, scale.axes[0], scale.axes[1], scale.axes[2], KILN_RIG_LEAST_SCALE,
                        scale.taken);
}

static bool settle(struct kiln_reader *reader, const struct kiln_node *root,
                   struct kiln_scene_node *node)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const char *file = node->mesh ? scene->backdrop.objects[node->object].file : node->file;
    const char *key = NULL;
    struct kiln_error error = {0};
    char path[96];
    const bool found = find_in_file(scene, node, file, &key, &error);
    if (!found && node->mesh && !node->rig)
        key = "mesh";
    snprintf(path, sizeof path, "nodes.%s.%s", node->name, key);
    if (!found)
        return kiln_asset_fail(reader, root, path, file, &error);
    snprintf(path, sizeof path, "nodes.%s.%s", node->name, node->mesh ? "joint" : "node");
    warn_of_scale(reader, root, path, node);
    return true;
}

bool kiln_node_rigs_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        struct kiln_scene_node *node = &scene->nodes[i];
        if ((node->file || node->mesh) && !settle(reader, root, node))
            return false;
    }
    return true;
}

/* ---- cameras --------------------------------------------------------------------------------- */

bool kiln_node_rigs_take_camera(struct kiln_reader *reader, const struct kiln_node *root,
                                uint32_t node, bool has_fov, bool *ok)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_scene_node *of = &scene->nodes[node];
    double fov_rad = 0;
    *ok = true;
    const enum kiln_rig_camera camera =
        of->file ? kiln_rig_camera_of(of->rig, of->rig_node, &fov_rad) : KILN_RIG_NO_CAMERA;
    if (camera == KILN_RIG_NO_CAMERA)
        return false;
    if (has_fov)
        return true;
    if (camera == KILN_RIG_ORTHOGRAPHIC)
        *ok =
            kiln_reader_error_at(reader, root, "camera.attach",
                                 "the camera of '%s' is orthographic, and that of a scene is not; "
                                 "camera.fov makes it one of perspective",
                                 of->name);
    else if (!(fov_rad >= KILN_DEG(1) && fov_rad <= KILN_DEG(170)))
        *ok = kiln_reader_error_at(reader, root, "camera.attach",
                                   "the camera of '%s' has a field of view of %g deg; allowed is "
                                   "from 1 deg to 170 deg, and camera.fov may give another one",
                                   of->name, fov_rad / KILN_DEG(1));
    else
        scene->camera.fov = (struct kiln_value){.constant = (float)fov_rad};
    return true;
}
