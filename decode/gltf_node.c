/* This file finds the nodes of a glTF document that its scene shows, and where they are. It walks
 * the tree without recursion, since an untrusted file decides the depth. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

/* ---- matrices -------------------------------------------------------------------------------- */

void gltf_multiply(const double a[3][4], const double b[3][4], double out[3][4])
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a[row][3] : 0.0;
            for (int k = 0; k < 3; k++)
                sum += a[row][k] * b[k][column];
            out[row][column] = sum;
        }
    }
}

void gltf_compose(const struct gltf_pose *pose, double rows[3][4])
{
    const double x = pose->turn[0], y = pose->turn[1], z = pose->turn[2], w = pose->turn[3];
    const double turn[3][3] = {
        {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)},
        {2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)},
        {2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)}};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            rows[row][column] = turn[row][column] * pose->scale[column];
        rows[row][3] = pose->move[row];
    }
}

double gltf_determinant(const double m[3][4])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool gltf_check_last_row(struct gltf *g, const double row[4])
{
    bool good = true;
    for (int c = 0; c < 4; c++)
        good = good && fabs(row[c] - (c == 3)) <= 1e-5;
    return good || GLTF_SET(g, "a matrix has the last row %g %g %g %g; allowed is 0 0 0 1", row[0],
                            row[1], row[2], row[3]);
}

/* Finds the quaternion of a rotation matrix, by its largest component. */
static void find_turn(const double m[3][3], double q[4])
{
    const double trace[4] = {m[0][0] - m[1][1] - m[2][2], m[1][1] - m[0][0] - m[2][2],
                             m[2][2] - m[0][0] - m[1][1], m[0][0] + m[1][1] + m[2][2]};
    int most = 3;
    for (int i = 0; i < 3; i++)
        most = trace[i] > trace[most] ? i : most;
    const double root = sqrt(1.0 + trace[most]), part = root > 0.0 ? 0.5 / root : 0.0;
    q[most] = 0.5 * root;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        if (most == 3)
            q[i] = (m[k][j] - m[j][k]) * part;
        else if (i == most)
            q[3] = (m[k][j] - m[j][k]) * part;
        else
            q[i] = (m[most][i] + m[i][most]) * part;
    }
}

/* Finds the translation, rotation and scale of a matrix. A mirror is a negative scale along x. A
 * shear is lost, which matters only for nodes that clips move, and glTF does not allow there. */
static void decompose(const double rows[3][4], struct gltf_pose *pose)
{
    double turn[3][3];
    for (int c = 0; c < 3; c++) {
        pose->move[c] = rows[c][3];
        pose->scale[c] =
            sqrt(rows[0][c] * rows[0][c] + rows[1][c] * rows[1][c] + rows[2][c] * rows[2][c]);
    }
    if (gltf_determinant(rows) < 0.0)
        pose->scale[0] = -pose->scale[0];
    for (int row = 0; row < 3; row++) {
        for (int c = 0; c < 3; c++)
            turn[row][c] = pose->scale[c] != 0.0 ? rows[row][c] / pose->scale[c] : row == c;
    }
    find_turn(turn, pose->turn);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Gets a member that is an array of numbers. */
static bool get_numbers(struct gltf *g, const json_t *object, const char *key, uint32_t count,
                        double *numbers, bool *is_there)
{
    const json_t *array = gltf_member(object, key);
    *is_there = array != NULL;
    if (!*is_there)
        return true;
    bool good = gltf_size(array) == count;
    for (size_t i = 0; good && i < count; i++)
        good = gltf_number(gltf_item(array, i), &numbers[i]);
    return good || GLTF_SET(g, "the %s of a node is not %u numbers", key, count);
}

static bool read_transform(struct gltf *g, const json_t *json, struct gltf_node *node)
{
    double m[16] = {0};
    bool is_there = false;
    node->pose = (struct gltf_pose){{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};
    if (!get_numbers(g, json, "matrix", 16, m, &is_there))
        return false;
    if (is_there) {
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 4; column++)
                node->local[row][column] = m[4 * column + row];
        }
        decompose(node->local, &node->pose);
        return gltf_check_last_row(g, (const double[4]){m[3], m[7], m[11], m[15]});
    }
    if (!get_numbers(g, json, "translation", 3, node->pose.move, &is_there) ||
        !get_numbers(g, json, "rotation", 4, node->pose.turn, &is_there) ||
        !get_numbers(g, json, "scale", 3, node->pose.scale, &is_there))
        return false;
    gltf_compose(&node->pose, node->local);
    return true;
}

static bool read_node(struct gltf *g, uint32_t number)
{
    const json_t *json = gltf_element(g, GLTF_NODES, number);
    struct gltf_node *node = &g->nodes[number];
    if (!read_transform(g, json, node) ||
        !gltf_reference(g, json, "mesh", GLTF_MESHES, &node->mesh) ||
        !gltf_reference(g, json, "skin", GLTF_SKINS, &node->skin))
        return false;
    const json_t *children = gltf_member(json, "children");
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(children, i_at)); i_at++) {
        uint32_t child = 0;
        if (!gltf_index(i, &child) || child >= g->lists[GLTF_NODES].count)
            return GLTF_SET(g, "node %u has a child that is no node", number);
        if (g->nodes[child].parent != GLTF_NONE)
            return GLTF_SET(g, "node %u is the child of two nodes", child);
        g->nodes[child].parent = number;
    }
    return true;
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Puts the children of a node on the stack, the first one on top. */
static void push_children(struct gltf *g, uint32_t number, uint32_t *stack, uint32_t *height)
{
    const json_t *children = gltf_member(gltf_element(g, GLTF_NODES, number), "children");
    const uint32_t first = *height;
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(children, i_at)); i_at++) {
        uint32_t child = 0;
        (void)gltf_index(i, &child); /* read_node has checked it */
        stack[(*height)++] = child;
    }
    for (uint32_t a = first, b = *height; a + 1 < b; a++, b--) {
        const uint32_t swap = stack[a];
        stack[a] = stack[b - 1];
        stack[b - 1] = swap;
    }
}

/* Adds a root and all nodes below it to the order, each before its children. A node has one parent,
 * and a root none, so each node comes once. */
static void add_tree(struct gltf *g, uint32_t root, bool shown, uint32_t *stack)
{
    uint32_t height = 0;
    stack[height++] = root;
    while (height > 0) {
        const uint32_t number = stack[--height];
        struct gltf_node *node = &g->nodes[number];
        if (node->parent == GLTF_NONE)
            memcpy(node->world, node->local, sizeof node->world);
        else
            gltf_multiply(g->nodes[node->parent].world, node->local, node->world);
        node->shown = shown;
        node->placed = true;
        g->order[g->order_count++] = number;
        push_children(g, number, stack, &height);
    }
}

/* Gets the nodes of the scene: that which the file names, else the first; without scenes, all. */
static bool add_scene(struct gltf *g, uint32_t *stack)
{
    uint32_t number = 0;
    if (!gltf_reference(g, g->root, "scene", GLTF_SCENES, &number))
        return false;
    const json_t *scene = gltf_element(g, GLTF_SCENES, number == GLTF_NONE ? 0 : number);
    if (!scene) {
        for (uint32_t i = 0; i < g->lists[GLTF_NODES].count; i++) {
            if (g->nodes[i].parent == GLTF_NONE)
                add_tree(g, i, true, stack);
        }
        return true;
    }
    const json_t *roots = gltf_member(scene, "nodes");
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(roots, i_at)); i_at++) {
        uint32_t root = 0;
        if (!gltf_index(i, &root) || root >= g->lists[GLTF_NODES].count)
            return GLTF_SET(g, "the scene has a node that is none of the %u nodes",
                            g->lists[GLTF_NODES].count);
        if (g->nodes[root].parent != GLTF_NONE || g->nodes[root].placed)
            return GLTF_SET(g, "node %u is twice in the scene, as a root and below one", root);
        add_tree(g, root, true, stack);
    }
    return true;
}

/* Adds the tree of a joint that is not in the scene. Nodes on the way to its root are marked, so
 * that no way is gone twice; a tree that is a circle has no root, and is not added. */
static void add_tree_of(struct gltf *g, uint32_t joint, uint32_t *stack)
{
    uint32_t at = joint;
    while (!g->nodes[at].needed && !g->nodes[at].placed) {
        g->nodes[at].needed = true; /* find_needed takes the mark away */
        if (g->nodes[at].parent == GLTF_NONE) {
            add_tree(g, at, false, stack);
            return;
        }
        at = g->nodes[at].parent;
    }
}

static bool add_joints(struct gltf *g, uint32_t *stack)
{
    for (uint32_t s = 0; s < g->lists[GLTF_SKINS].count; s++) {
        const json_t *joints = gltf_member(gltf_element(g, GLTF_SKINS, s), "joints");
        size_t i_at = 0;
        for (const json_t *i; (i = gltf_item(joints, i_at)); i_at++) {
            uint32_t joint = 0;
            if (!gltf_index(i, &joint) || joint >= g->lists[GLTF_NODES].count)
                return GLTF_SET(g, "a joint of skin %u is none of the %u nodes", s,
                                g->lists[GLTF_NODES].count);
            add_tree_of(g, joint, stack);
            if (!g->nodes[joint].placed)
                return GLTF_SET(g, "node %u, a joint, is below itself", joint);
        }
    }
    return true;
}

static void mark(struct gltf *g, uint32_t number)
{
    for (; number != GLTF_NONE && !g->nodes[number].needed; number = g->nodes[number].parent)
        g->nodes[number].needed = true;
}

/* Marks the nodes that show meshes, or move those that do. */
static void find_needed(struct gltf *g)
{
    for (uint32_t i = 0; i < g->order_count; i++)
        g->nodes[g->order[i]].needed = false;
    for (uint32_t i = 0; i < g->order_count; i++) {
        const struct gltf_node *node = &g->nodes[g->order[i]];
        if (!node->shown || node->mesh == GLTF_NONE)
            continue;
        mark(g, g->order[i]);
        const json_t *skin = gltf_element(g, GLTF_SKINS, node->skin);
        const json_t *joints = gltf_member(skin, "joints");
        size_t j_at = 0;
        for (const json_t *j; (j = gltf_item(joints, j_at)); j_at++) {
            uint32_t joint = 0;
            if (gltf_index(j, &joint))
                mark(g, joint);
        }
    }
}

bool gltf_find_nodes(struct gltf *g)
{
    const uint32_t count = g->lists[GLTF_NODES].count;
    g->nodes = calloc((size_t)count + 1, sizeof *g->nodes);
    g->order = malloc(((size_t)count + 1) * sizeof *g->order);
    uint32_t *stack = malloc(((size_t)count + 1) * sizeof *stack);
    bool ok = g->nodes && g->order && stack;
    if (!ok)
        decode_out_of_memory(g->error);
    for (uint32_t i = 0; ok && i < count; i++)
        g->nodes[i].parent = GLTF_NONE;
    for (uint32_t i = 0; ok && i < count; i++)
        ok = read_node(g, i);
    ok = ok && add_scene(g, stack) && add_joints(g, stack);
    if (ok)
        find_needed(g);
    free(stack);
    return ok;
}

uint32_t *gltf_children_first(struct gltf *g)
{
    const size_t most = 2 * (size_t)g->lists[GLTF_NODES].count + 2;
    uint32_t *nodes = malloc(((size_t)g->order_count + 1) * sizeof *nodes);
    uint32_t *stack = malloc(most * sizeof *stack);
    bool *open = calloc((size_t)g->lists[GLTF_NODES].count + 1, sizeof *open);
    uint32_t count = 0, height = 0;
    for (uint32_t i = 0; nodes && stack && open && i < g->order_count; i++) {
        if (g->nodes[g->order[i]].parent != GLTF_NONE)
            continue;
        stack[height++] = g->order[i];
        while (height > 0) {
            const uint32_t number = stack[height - 1];
            if (open[number]) { /* its children are done */
                nodes[count++] = number;
                height--;
            } else {
                open[number] = true;
                push_children(g, number, stack, &height);
            }
        }
    }
    free(stack);
    free(open);
    if (count < g->order_count || !nodes) {
        free(nodes);
        decode_out_of_memory(g->error);
        return NULL;
    }
    return nodes;
}

/* ---- instances ------------------------------------------------------------------------------- */

/* Reads one attribute of the instances; *values is NULL if there is none. */
static bool read_instances(struct gltf *g, const json_t *attributes, const char *key,
                           const char *type, uint32_t *count, float **values)
{
    uint32_t accessor = 0, own = 0;
    if (!gltf_reference(g, attributes, key, GLTF_ACCESSORS, &accessor))
        return false;
    if (accessor == GLTF_NONE)
        return true;
    if (!gltf_count(g, accessor, KILN_MAX_MESH_TRIANGLES, "instances", &own))
        return false;
    if (*count != GLTF_NONE && own != *count)
        return GLTF_SET(g, "the attributes of instances have %u and %u elements", *count, own);
    *count = own;
    *values = gltf_read(g, accessor, type, (struct gltf_range){0, own});
    return *values != NULL;
}

static void place_instances(const float *moves, const float *turns, const float *scales,
                            struct gltf_instances *instances)
{
    for (size_t i = 0; i < instances->count; i++) {
        struct gltf_pose pose = {{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};
        for (size_t c = 0; c < 3; c++) {
            pose.move[c] = moves ? (double)moves[3 * i + c] : 0.0;
            pose.scale[c] = scales ? (double)scales[3 * i + c] : 1.0;
        }
        for (size_t c = 0; turns && c < 4; c++)
            pose.turn[c] = (double)turns[4 * i + c];
        gltf_compose(&pose, instances->rows[i]);
    }
}

bool gltf_find_instances(struct gltf *g, uint32_t node, struct gltf_instances *instances)
{
    const json_t *json = gltf_element(g, GLTF_NODES, node);
    const json_t *extension = gltf_extension(json, "EXT_mesh_gpu_instancing");
    const json_t *attributes = gltf_member(extension, "attributes");
    float *moves = NULL, *turns = NULL, *scales = NULL;
    uint32_t count = GLTF_NONE;
    bool ok = read_instances(g, attributes, "TRANSLATION", "VEC3", &count, &moves) &&
              read_instances(g, attributes, "ROTATION", "VEC4", &count, &turns) &&
              read_instances(g, attributes, "SCALE", "VEC3", &count, &scales);
    instances->count = count == GLTF_NONE ? 1 : count;
    instances->rows = ok ? calloc((size_t)instances->count + 1, sizeof *instances->rows) : NULL;
    if (ok && !instances->rows)
        ok = decode_out_of_memory(g->error);
    if (ok)
        place_instances(moves, turns, scales, instances);
    free(moves);
    free(turns);
    free(scales);
    return ok;
}
