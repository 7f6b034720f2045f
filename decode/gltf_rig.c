/* This file fills in the nodes of a glTF document as a rig: where each is, which is a joint, which
 * has a camera. Meshes are not read. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

static bool put_camera(struct gltf *g, const json_t *node, struct kiln_rig_node *out)
{
    uint32_t number = 0;
    if (!gltf_reference(g, node, "camera", GLTF_CAMERAS, &number))
        return false;
    if (number == GLTF_NONE)
        return true;
    const json_t *camera = gltf_element(g, GLTF_CAMERAS, number);
    const json_t *type = gltf_member(camera, "type");
    if (gltf_is(type, "orthographic")) {
        out->camera = KILN_RIG_ORTHOGRAPHIC;
        return true;
    }
    out->camera = KILN_RIG_PERSPECTIVE;
    const json_t *perspective = gltf_member(camera, "perspective");
    return (gltf_is(type, "perspective") &&
            gltf_number(gltf_member(perspective, "yfov"), &out->fov)) ||
           GLTF_SET(g, "camera %u is neither orthographic nor of perspective with a 'yfov'",
                    number);
}

static bool put_node(struct gltf *g, uint32_t number, const struct gltf_moved *moved,
                     struct kiln_rig_node *out)
{
    const json_t *json = gltf_element(g, GLTF_NODES, number);
    const struct gltf_node *node = &g->nodes[number];
    const uint32_t own = moved[number].node;
    *out = (struct kiln_rig_node){
        .number = number, .parent = node->parent == GLTF_NONE ? own : moved[node->parent].node};
    if (gltf_text(gltf_member(json, "name"), out->name, sizeof out->name) >= sizeof out->name)
        memset(out->name, 0, sizeof out->name); /* its number says which it is */
    memcpy(out->local, node->local, sizeof out->local);
    memcpy(out->move, node->pose.move, sizeof out->move);
    memcpy(out->turn, node->pose.turn, sizeof out->turn);
    memcpy(out->scale, node->pose.scale, sizeof out->scale);
    return put_camera(g, json, out);
}

/* Marks the joints of all skins. gltf_find_nodes has checked their numbers, and placed them. */
static void mark_joints(const struct gltf *g, const struct gltf_moved *moved,
                        struct kiln_rig_result *rig)
{
    for (uint32_t s = 0; s < g->lists[GLTF_SKINS].count; s++) {
        const json_t *joints = gltf_member(gltf_element(g, GLTF_SKINS, s), "joints");
        size_t i_at = 0;
        for (const json_t *i; (i = gltf_item(joints, i_at)); i_at++) {
            uint32_t joint = 0;
            if (gltf_index(i, &joint))
                rig->nodes[moved[joint].node].is_joint = 1;
        }
    }
}

bool gltf_rig(struct gltf *g, struct kiln_mesh_result *result)
{
    struct kiln_rig_result *rig = &result->rig;
    const size_t nodes = (size_t)g->lists[GLTF_NODES].count + 1;
    if (g->order_count == 0)
        return GLTF_SET(g, "the scene has no nodes");
    if (g->order_count > KILN_MAX_RIG_NODES)
        return GLTF_SET(g, "more than %d nodes; no more are allowed", KILN_MAX_RIG_NODES);
    struct gltf_moved *moved = calloc(nodes, sizeof *moved);
    if (!moved)
        return decode_out_of_memory(g->error);
    for (size_t i = 0; i < nodes; i++)
        moved[i].node = GLTF_NONE;
    bool ok = true;
    for (uint32_t i = 0; ok && i < g->order_count; i++) {
        moved[g->order[i]].node = rig->node_count;
        ok = put_node(g, g->order[i], moved, &rig->nodes[rig->node_count]);
        rig->node_count++;
    }
    if (ok)
        mark_joints(g, moved, rig);
    ok = ok && gltf_put_clips(g, moved, result);
    free(moved);
    return ok;
}
