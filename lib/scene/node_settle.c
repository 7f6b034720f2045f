/* This file settles the nodes of a scene when all of its rows are read: names become numbers, rings
 * of parents are refused, the curves of paths are measured once, and files with nodes are read. */
#include "scene/node_settle.h"

#include <stdio.h>
#include <string.h>

#include "scene/baked.h"
#include "scene/node_rig.h"
#include "scene/options.h"

/* ---- names ----------------------------------------------------------------------------------- */

/* Finds the node that the option at a path names, if it names one. */
static bool find_node(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                      struct kiln_attach *attach)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const char *names[KILN_MAX_NODES];
    if (!attach->name)
        return true;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        names[i] = scene->nodes[i].name;
        attach->node = i;
        if (strcmp(names[i], attach->name) == 0)
            return true;
    }
    char suggestion[512], quoted[64];
    kiln_option_suggest(suggestion, sizeof suggestion, attach->name, names, scene->node_count);
    kiln_node_quote(quoted, attach->name);
    return kiln_reader_error_at(reader, root, path, "unknown node '%s'%s", quoted, suggestion);
}

/* Refuses a node that no attached part could name. */
static bool check_names(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (strcmp(scene->nodes[i].name, "none") == 0)
            return kiln_reader_error_at(reader, root, "nodes.none",
                                        "must have another name, since none stands for no node");
    }
    return true;
}

static bool find_parents(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    bool ok = true;
    for (uint32_t i = 0; ok && i < scene->node_count; i++) {
        char path[80];
        snprintf(path, sizeof path, "nodes.%s.parent", scene->nodes[i].name);
        ok = find_node(reader, root, path, &scene->nodes[i].parent);
    }
    return ok;
}

/* Refuses an object that lies in a joint of its own mesh. joint: the node that is this joint; the
 * nodes on the way to it are named. */
static bool refuse_object(struct kiln_reader *reader, const struct kiln_node *root, uint32_t joint)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const uint32_t number = scene->nodes[joint].object;
    const struct kiln_object *object = &scene->backdrop.objects[number];
    char path[80], chain[256] = "";
    size_t length = 0;
    for (uint32_t at = object->attach.node; at != joint; at = kiln_node_outer(scene, at)->node) {
        if (length < sizeof chain)
            length += (size_t)snprintf(chain + length, sizeof chain - length, "%s%s",
                                       length ? ", " : ", by way of ", scene->nodes[at].name);
    }
    snprintf(path, sizeof path, "backdrop.objects.%u.mesh.attach", number);
    return kiln_reader_error_at(
        reader, root, path,
        "the object would lie in a joint of its own mesh, '%s'%s%s; it may be attached to a node "
        "that does not lie in it",
        scene->nodes[joint].name, chain, length < sizeof chain ? "" : "...");
}

/* Refuses a node that is among its own parents, and names those on the way. */
static bool check_ring(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_attach *outer = kiln_node_outer(scene, index);
    uint32_t count = 0, at = index;
    while (outer->name && outer->node != index && count <= scene->node_count) {
        outer = kiln_node_outer(scene, outer->node);
        count++;
    }
    if (!outer->name || outer->node != index)
        return true; /* also where it leads into a ring of others, which is found from there */
    char path[80], chain[256];
    size_t length = (size_t)snprintf(chain, sizeof chain, "%s", scene->nodes[index].name);
    do {
        if (scene->nodes[at].mesh)
            return refuse_object(reader, root, at);
        at = kiln_node_outer(scene, at)->node;
        if (length < sizeof chain)
            length += (size_t)snprintf(chain + length, sizeof chain - length, ", %s",
                                       scene->nodes[at].name);
    } while (at != index);
    snprintf(path, sizeof path, "nodes.%s.parent", scene->nodes[index].name);
    return kiln_reader_error_at(
        reader, root, path,
        "the node is its own parent: %s%s; the first node of a chain has no "
        "parent",
        chain, length < sizeof chain ? "" : "...");
}

/* ---- paths ----------------------------------------------------------------------------------- */

static bool settle_path(struct kiln_reader *reader, const struct kiln_node *root,
                        struct kiln_scene_node *node)
{
    struct kiln_path *curve = &node->position.path;
    const uint32_t count = curve->points.count;
    char path[112];
    if (count == 0) {
        snprintf(path, sizeof path, "nodes.%s.heading", node->name);
        return node->heading == KILN_HEADING_FIXED ||
               kiln_reader_error_at(reader, root, path, "needs a position that is a path");
    }
    snprintf(path, sizeof path, "nodes.%s.position.path.over", node->name);
    if (!(curve->over.min.constant < curve->over.max.constant)) {
        char first[48], last[48];
        kiln_unit_print(first, KILN_SECONDS, curve->over.min.constant);
        kiln_unit_print(last, KILN_SECONDS, curve->over.max.constant);
        return kiln_reader_error_at(reader, root, path,
                                    "expected two times, [first, last], of which the second is the "
                                    "later one, found %s and %s",
                                    first, last);
    }
    snprintf(path, sizeof path, "nodes.%s.position.path.points", node->name);
    if (curve->closed && count < 3)
        return kiln_reader_error_at(reader, root, path,
                                    "found %u points; a closed path has 3 at least", count);
    if (curve->closed &&
        memcmp(curve->points.at[0], curve->points.at[count - 1], sizeof *curve->points.at) == 0)
        return kiln_reader_error_at(reader, root, path,
                                    "the last point must not be the first; a closed path goes on "
                                    "to the first by itself");
    curve->table = kiln_path_table_create(reader->arena, curve);
    return curve->table || kiln_reader_out_of_memory(reader);
}

/* ---- what is attached ------------------------------------------------------------------------ */

static const char *kind_of_object(const struct kiln_object *object)
{
    static const char *const names[] = {
        [KILN_OBJECT_BOX] = "box",           [KILN_OBJECT_SPHERE] = "sphere",
        [KILN_OBJECT_CYLINDER] = "cylinder", [KILN_OBJECT_MESH] = "mesh",
        [KILN_OBJECT_CAPSULE] = "capsule",   [KILN_OBJECT_PLANE] = "plane",
        [KILN_OBJECT_TERRAIN] = "terrain",   [KILN_OBJECT_CONE] = "cone",
    };
    return names[object->kind];
}

static bool find_backdrop(struct kiln_reader *reader, const struct kiln_node *root)
{
    static const char *const lights[] = {
        [KILN_LIGHT_POINT] = "point",
        [KILN_LIGHT_SPOT] = "spot",
        [KILN_LIGHT_RECTANGLE] = "rectangle",
    };
    struct kiln_backdrop *backdrop = &kiln_reader_scene(reader)->backdrop;
    bool ok = true;
    char path[80];
    for (uint32_t i = 0; ok && i < backdrop->object_count; i++) {
        struct kiln_object *object = &backdrop->objects[i];
        snprintf(path, sizeof path, "backdrop.objects.%u.%s.attach", i, kind_of_object(object));
        ok = find_node(reader, root, path, &object->attach);
    }
    for (uint32_t i = 0; ok && i < backdrop->light_count; i++) {
        struct kiln_light *light = &backdrop->lights[i];
        snprintf(path, sizeof path, "backdrop.lights.%u.%s.attach", i, lights[light->kind]);
        ok = find_node(reader, root, path, &light->attach);
    }
    return ok;
}

/* Finds the nodes of a force and of its region. */
static bool find_force(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                       struct kiln_force *force)
{
    char key[160];
    snprintf(key, sizeof key, "%s.attach", path);
    bool ok = find_node(reader, root, key, &force->attach);
    snprintf(key, sizeof key, "%s.region.attach", path);
    return ok && find_node(reader, root, key, &force->region.attach);
}

/* Finds the nodes of the forces of a system or of a domain of gas (kiln_owner_force), and of those
 * in its baked winds. */
static bool find_forces(struct kiln_reader *reader, const struct kiln_node *root, uint32_t owner,
                        struct kiln_force *forces, uint32_t count)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    uint32_t inner = count;
    bool ok = true;
    char path[128];
    for (uint32_t i = 0; ok && i < count; i++) {
        struct kiln_force *force = &forces[i];
        kiln_owner_force_path(scene, owner, i, path, sizeof path);
        ok = find_force(reader, root, path, force);
        for (uint32_t k = 0; ok && force->kind == KILN_FORCE_BAKED && k < force->of.count; k++) {
            kiln_owner_force_path(scene, owner, inner++, path, sizeof path);
            ok = find_force(reader, root, path, &force->of.at[k]);
        }
    }
    return ok;
}

static bool find_forces_of_system(struct kiln_reader *reader, const struct kiln_node *root,
                                  struct kiln_system *system)
{
    const uint32_t owner = (uint32_t)(system - kiln_reader_scene(reader)->systems);
    bool ok = find_forces(reader, root, owner, system->forces, system->force_count);
    char path[128];
    for (uint32_t i = 0; ok && i < system->demitter_count; i++) {
        snprintf(path, sizeof path, "systems.%s.demitters.%u.attach", system->name, i);
        ok = find_node(reader, root, path, &system->demitters[i].attach);
    }
    return ok;
}

static bool find_gas(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    char path[128];
    bool ok = true;
    for (uint32_t i = 0; ok && i < scene->gas_count; i++) {
        struct kiln_gas_domain *domain = &scene->gas[i];
        snprintf(path, sizeof path, "gas.%s.attach", domain->name);
        ok = find_node(reader, root, path, &domain->attach);
        for (uint32_t k = 0; ok && k < domain->source_count; k++) {
            snprintf(path, sizeof path, "gas.%s.sources.%u.attach", domain->name, k);
            ok = find_node(reader, root, path, &domain->sources[k].emit.attach);
        }
        ok = ok && find_forces(reader, root, scene->system_count + i, domain->forces,
                               domain->force_count);
    }
    return ok;
}

static bool find_systems(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        struct kiln_system *system = &scene->systems[i];
        struct kiln_emitter *emit = &system->emit;
        char path[80];
        snprintf(path, sizeof path, "systems.%s.emit.attach", system->name);
        if (!find_node(reader, root, path, &emit->attach) ||
            !find_forces_of_system(reader, root, system))
            return false;
        char space[80];
        snprintf(space, sizeof space, "systems.%s.space", system->name);
        if (!find_node(reader, root, space, &system->space))
            return false;
        if (emit->attach.name && emit->parent.enabled)
            return kiln_reader_error_at(reader, root, path,
                                        "must be none for a system with a parent, around whose "
                                        "particles its own are born");
    }
    return true;
}

/* Checks that a camera that looks ahead in its node, at nothing, knows where it is in focus. */
static bool check_focus(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_value *focus = &scene->camera.focus;
    const bool by_target = focus->count == 0 && focus->constant == KILN_VALUE_BY_WORD;
    return !by_target || !(kiln_scene_value_max(scene, &scene->camera.aperture) > 0.0f) ||
           kiln_reader_error_at(reader, root, "camera.focus",
                                "must be a distance, such as 5 m, where a camera with an aperture "
                                "has no target in its node");
}

/* Puts a camera that says no more than its node into that node, and lets it look along z. A camera
 * of a file looks along -z. */
static bool settle_camera(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_camera *camera = &kiln_reader_scene(reader)->camera;
    if (!find_node(reader, root, "camera.attach", &camera->attach))
        return false;
    if (!camera->attach.name)
        return true;
    const struct kiln_node *rows = kiln_node_entry(root, "camera");
    const bool placed = rows && kiln_node_entry(rows, "position");
    const bool aimed = rows && kiln_node_entry(rows, "target");
    const bool has_fov = rows && kiln_node_entry(rows, "fov");
    bool ok = true;
    const bool is_of_file =
        kiln_node_rigs_take_camera(reader, root, camera->attach.node, has_fov, &ok);
    if (!placed)
        camera->position = (struct kiln_value3){.x = {.constant = 0}};
    if (placed && !aimed && !kiln_value3_is_constant(&camera->position))
        return kiln_reader_error_at(reader, root, "camera.position",
                                    "varies within a node, so the camera needs a target, too");
    if (!aimed) {
        if (!check_focus(reader, root))
            return false;
        camera->target = camera->position;
        camera->target.z.constant += is_of_file ? -1 : 1;
    }
    return ok;
}

bool kiln_nodes_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    bool ok = check_names(reader, root) && kiln_node_rigs_find_objects(reader, root) &&
              find_parents(reader, root) && find_backdrop(reader, root);
    for (uint32_t i = 0; ok && i < scene->node_count; i++)
        ok = check_ring(reader, root, i) && settle_path(reader, root, &scene->nodes[i]);
    return ok && kiln_node_rigs_settle(reader, root) && settle_camera(reader, root) &&
           find_systems(reader, root) && find_gas(reader, root);
}
