/* This file fills in a glTF mesh that moves: nodes, bones, vertices before nodes and bones move
 * them, and morph targets whose weights a clip moves. Other targets are added to the vertices with
 * their default weights. Where a file has no normals, they get the creases that the mesh has while
 * it does not move. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

/* The vertices that a primitive of a node has in the result. */
struct part {
    uint32_t first, count, first_triangle, triangle_count;
    bool has_normals;
    uint32_t target_count; /* of targets whose weights move */
    struct gltf_target *targets;
    float *weights; /* of the targets by default; NULL: 0 */
};

struct moving {
    struct gltf *g;
    struct kiln_mesh_result *result;
    struct gltf_moved *moved; /* of the file's nodes */
    uint32_t *numbers;        /* of the result's nodes in the file; GLTF_NONE for the root */
    uint32_t *first_bones;    /* of the file's skins, from 1; 0: not yet */
    uint32_t *skin_counts;    /* joints of the same */
    struct part *parts;
    uint32_t part_count, part_capacity;
    /* Which vertex each one was before creases were found; NULL: there are none to find. */
    uint32_t *sources;
};

/* ---- nodes ----------------------------------------------------------------------------------- */

static void put_matrix(const double rows[3][4], mat4 out)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++)
            out[column][row] = (float)rows[row][column];
    }
    for (int column = 0; column < 4; column++)
        out[column][3] = column == 3 ? 1.0f : 0.0f;
}

static bool put_node(struct moving *m, uint32_t number, uint32_t parent)
{
    struct kiln_skin_result *skin = &m->result->skin;
    if (!m->g->nodes[number].needed)
        return true;
    if (skin->node_count == KILN_MAX_SKIN_NODES)
        return GLTF_SET(m->g, "more than %d nodes; no more are allowed", KILN_MAX_SKIN_NODES - 1);
    skin->nodes[skin->node_count].parent = parent;
    put_matrix(m->g->nodes[number].local, skin->nodes[skin->node_count].rest);
    m->numbers[skin->node_count] = number;
    m->moved[number].node = skin->node_count++;
    return true;
}

/* Stores the nodes that matter, those near the roots first, below a root of all. */
static bool put_nodes(struct moving *m)
{
    struct gltf *g = m->g;
    struct kiln_skin_result *skin = &m->result->skin;
    put_matrix((const double[3][4]){{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, skin->nodes[0].rest);
    skin->nodes[0].parent = 0;
    m->numbers[0] = GLTF_NONE;
    skin->node_count = 1;
    bool ok = true;
    for (uint32_t i = 0; ok && i < g->order_count; i++) {
        if (g->nodes[g->order[i]].parent == GLTF_NONE)
            ok = put_node(m, g->order[i], 0);
    }
    for (uint32_t i = 1; ok && i < skin->node_count; i++) {
        const json_t *list = gltf_member(gltf_element(g, GLTF_NODES, m->numbers[i]), "children");
        size_t c_at = 0;
        for (const json_t *c; ok && (c = gltf_item(list, c_at)); c_at++) {
            uint32_t child = 0;
            ok = gltf_index(c, &child) && put_node(m, child, i);
        }
    }
    return ok;
}

/* ---- bones ----------------------------------------------------------------------------------- */

static bool put_bone(struct moving *m, uint32_t node, const double offset[3][4])
{
    struct kiln_skin_result *skin = &m->result->skin;
    if (skin->bone_count == KILN_MAX_SKIN_BONES)
        return GLTF_SET(m->g, "more than %d bones; no more are allowed", KILN_MAX_SKIN_BONES);
    struct kiln_skin_bone *bone = &skin->bones[skin->bone_count++];
    bone->node = m->moved[node].node;
    put_matrix(offset, bone->offset);
    return bone->node != GLTF_NONE || GLTF_SET(m->g, "a joint is no node of the scene");
}

/* Stores the joints of a skin as bones, once. */
static bool put_skin(struct moving *m, uint32_t number)
{
    struct gltf_skin skin = {.count = 0};
    if (m->first_bones[number] > 0)
        return true;
    m->first_bones[number] = m->result->skin.bone_count + 1;
    bool ok = gltf_read_skin(m->g, number, &skin);
    m->skin_counts[number] = skin.count;
    for (uint32_t i = 0; ok && i < skin.count; i++)
        ok = put_bone(m, skin.bones[i].node, skin.bones[i].offset);
    free(skin.bones);
    return ok;
}

/* Stores the weights of a part's vertices by the bones of a skin. */
static bool put_weights(struct moving *m, const struct gltf_primitive *from, uint32_t skin,
                        uint32_t first)
{
    const uint32_t joints = m->skin_counts[skin], bone = m->first_bones[skin] - 1;
    for (uint32_t i = 0; i < from->vertex_count; i++) {
        struct kiln_skin_weights of = from->weights[i];
        for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
            if (of.bones[k] >= joints)
                return GLTF_SET(m->g, "a vertex has joint %u of a skin of %u", of.bones[k], joints);
            of.bones[k] = (uint16_t)(of.weights[k] > 0.0f ? of.bones[k] + bone : 0);
        }
        m->result->skin.weights[first + i] = of;
    }
    return true;
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* Adds room for a part. */
static struct part *add_part(struct moving *m)
{
    if (m->part_count == m->part_capacity) {
        m->part_capacity = 2 * m->part_capacity + 16;
        struct part *more = realloc(m->parts, m->part_capacity * sizeof *more);
        if (!more) {
            decode_out_of_memory(m->g->error);
            return NULL;
        }
        m->parts = more;
    }
    struct part *part = &m->parts[m->part_count++];
    *part = (struct part){.first = m->result->vertex_count,
                          .first_triangle = m->result->triangle_count};
    return part;
}

static void put_vertex(const struct gltf_primitive *from, uint32_t i, float out[6])
{
    const float *p = from->positions[i];
    float n[3] = {0, 1, 0}, length = 1;
    if (from->normals) {
        memcpy(n, from->normals[i], sizeof n);
        length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    if (!(length > 1e-12f && length < 1e12f)) { /* the normal of a triangle without an area */
        n[0] = n[2] = 0;
        n[1] = length = 1;
    }
    const float vertex[6] = {p[0], p[1], p[2], n[0] / length, n[1] / length, n[2] / length};
    memcpy(out, vertex, sizeof vertex);
}

/* Appends the vertices and triangles of a primitive. */
static bool put_part(struct moving *m, const struct gltf_primitive *from, struct part *part)
{
    struct kiln_mesh_result *result = m->result;
    const uint32_t first = result->vertex_count;
    if (from->vertex_count > KILN_MAX_MESH_VERTICES - first ||
        from->triangle_count > KILN_MAX_MESH_TRIANGLES - result->triangle_count)
        return decode_refuse_size(m->g->error);
    part->count = from->vertex_count;
    part->triangle_count = from->triangle_count;
    part->has_normals = from->normals != NULL;
    for (uint32_t i = 0; i < from->vertex_count; i++)
        put_vertex(from, i, result->vertices[first + i]);
    result->vertex_count += from->vertex_count;
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        uint32_t *triangle = result->triangles[result->triangle_count++];
        for (int c = 0; c < 3; c++)
            triangle[c] = first + from->triangles[i][c];
    }
    return true;
}

/* Stores a bone for each instance of a node, once. All primitives of the node follow them. */
static bool put_instance_bones(struct moving *m, uint32_t node,
                               const struct gltf_instances *instances)
{
    struct gltf_moved *moved = &m->moved[node];
    if (moved->first_bone > 0)
        return true;
    moved->first_bone = m->result->skin.bone_count + 1;
    for (uint32_t i = 0; i < instances->count; i++) {
        if (!put_bone(m, node, instances->rows[i]))
            return false;
    }
    return true;
}

/* Adds a primitive that follows one bone. */
static bool put_rigid(struct moving *m, uint32_t bone, const struct gltf_primitive *from,
                      struct part *part)
{
    if (!put_part(m, from, part))
        return false;
    for (uint32_t i = 0; i < from->vertex_count; i++)
        m->result->skin.weights[part->first + i] =
            (struct kiln_skin_weights){.bones = {(uint16_t)bone}, .weights = {1.0f}};
    return true;
}

/* Gives targets to the first part that has them. All instances have copies of them. */
static bool copy_targets(struct moving *m, const struct gltf_primitive *from, const float *weights,
                         struct part *part)
{
    part->targets = calloc(from->target_count, sizeof *part->targets);
    part->weights = calloc(from->target_count, sizeof *part->weights);
    if (!part->targets || !part->weights)
        return decode_out_of_memory(m->g->error);
    part->target_count = from->target_count;
    for (uint32_t t = 0; t < from->target_count; t++) {
        const size_t bytes = from->vertex_count * sizeof(float[3]);
        const struct gltf_target *target = &from->targets[t];
        part->weights[t] = weights ? weights[t] : 0.0f;
        part->targets[t].positions = target->positions ? malloc(bytes + 1) : NULL;
        part->targets[t].normals = target->normals ? malloc(bytes + 1) : NULL;
        if ((target->positions && !part->targets[t].positions) ||
            (target->normals && !part->targets[t].normals))
            return decode_out_of_memory(m->g->error);
        if (target->positions)
            memcpy(part->targets[t].positions, target->positions, bytes);
        if (target->normals)
            memcpy(part->targets[t].normals, target->normals, bytes);
    }
    return true;
}

static bool put_instances(struct moving *m, uint32_t node, const struct gltf_instances *instances,
                          const struct gltf_primitive *from, const float *weights, bool morphs)
{
    struct gltf_moved *moved = &m->moved[node];
    const uint32_t skin = m->g->nodes[node].skin;
    const bool skinned = from->weights != NULL;
    if (!skinned && !put_instance_bones(m, node, instances))
        return false;
    for (uint32_t i = 0; i < (skinned ? 1 : instances->count); i++) {
        struct part *part = add_part(m);
        if (!part ||
            !(skinned ? put_part(m, from, part) && put_weights(m, from, skin, part->first)
                      : put_rigid(m, moved->first_bone - 1 + i, from, part)) ||
            (morphs && !copy_targets(m, from, weights, part)))
            return false;
        moved->target_count = morphs ? from->target_count : 0;
        moved->part_count++;
    }
    return true;
}

static bool put_primitive(struct moving *m, uint32_t node, const json_t *json,
                          const struct gltf_instances *instances)
{
    struct gltf *g = m->g;
    const struct gltf_moved *moved = &m->moved[node];
    struct gltf_primitive primitive;
    bool ok = gltf_read_primitive(g, json, false, g->nodes[node].skin != GLTF_NONE, &primitive);
    const bool morphs = ok && primitive.target_count > 0 && gltf_morphs_move(g, node);
    float *weights = NULL;
    if (ok)
        weights = gltf_default_weights(g, node, primitive.target_count, &ok);
    if (weights && !morphs)
        gltf_morph(&primitive, weights);
    if (ok && moved->part_count > 0 && (morphs ? primitive.target_count : 0) != moved->target_count)
        ok = GLTF_SET(g, "the primitives of a mesh have different numbers of morph targets");
    if (ok && primitive.triangle_count > 0)
        ok = put_instances(m, node, instances, &primitive, weights, morphs);
    free(weights);
    gltf_finish_primitive(&primitive);
    return ok;
}

static bool put_mesh(struct moving *m, uint32_t node)
{
    struct gltf *g = m->g;
    const json_t *mesh = gltf_element(g, GLTF_MESHES, g->nodes[node].mesh);
    const json_t *list = gltf_member(mesh, "primitives");
    struct gltf_instances instances = {.count = 0};
    bool ok = gltf_find_instances(g, node, &instances) &&
              (g->nodes[node].skin == GLTF_NONE || put_skin(m, g->nodes[node].skin));
    size_t i_at = 0;
    for (const json_t *i; ok && (i = gltf_item(list, i_at)); i_at++)
        ok = put_primitive(m, node, i, &instances);
    free(instances.rows);
    return ok;
}

static bool put_meshes(struct moving *m)
{
    for (uint32_t i = 1; i < m->result->skin.node_count; i++) {
        const struct gltf_node *node = &m->g->nodes[m->numbers[i]];
        if (node->shown && node->mesh != GLTF_NONE && !put_mesh(m, m->numbers[i]))
            return false;
    }
    return true;
}

/* ---- morph targets --------------------------------------------------------------------------- */

static struct kiln_skin_delta *add_delta(struct moving *m, uint32_t *capacity)
{
    struct kiln_skin_result *skin = &m->result->skin;
    if (skin->delta_count == KILN_MAX_SKIN_DELTAS) {
        GLTF_SET(m->g, "morph targets move vertices more than %d times; no more are allowed",
                 KILN_MAX_SKIN_DELTAS);
        return NULL;
    }
    if (skin->delta_count == *capacity) {
        *capacity = 2 * *capacity + 1024;
        struct kiln_skin_delta *more = realloc(skin->deltas, *capacity * sizeof *more);
        if (!more) {
            decode_out_of_memory(m->g->error);
            return NULL;
        }
        skin->deltas = more;
    }
    return &skin->deltas[skin->delta_count++];
}

/* Stores the differences of one target: those of vertices that it changes. */
static bool put_target(struct moving *m, const struct part *part, uint32_t from, uint32_t number,
                       uint32_t *capacity)
{
    static const float none[3];
    const struct gltf_target *target = &part->targets[number];
    for (uint32_t i = part->first; i < part->first + part->count; i++) {
        const uint32_t source = m->sources ? m->sources[i] - from : i - part->first;
        const float *move = target->positions ? target->positions[source] : none;
        const float *turn = target->normals && part->has_normals ? target->normals[source] : none;
        if (memcmp(move, none, sizeof none) == 0 && memcmp(turn, none, sizeof none) == 0)
            continue;
        struct kiln_skin_delta *delta = add_delta(m, capacity);
        if (!delta)
            return false;
        delta->vertex = i;
        memcpy(delta->position, move, sizeof delta->position);
        memcpy(delta->normal, turn, sizeof delta->normal);
    }
    return true;
}

/* Stores the morph targets. `firsts` has the first vertex of each part before creases were found.
 */
static bool put_morphs(struct moving *m, const uint32_t *firsts)
{
    struct kiln_skin_result *skin = &m->result->skin;
    uint32_t capacity = 0;
    for (uint32_t p = 0; p < m->part_count; p++) {
        const struct part *part = &m->parts[p];
        for (uint32_t t = 0; t < part->target_count; t++) {
            if (skin->morph_count == KILN_MAX_SKIN_MORPHS)
                return GLTF_SET(m->g, "more than %d morph targets; no more are allowed",
                                KILN_MAX_SKIN_MORPHS);
            struct kiln_skin_morph *morph = &skin->morphs[skin->morph_count++];
            morph->first = skin->delta_count;
            morph->rest = part->weights[t];
            if (!put_target(m, part, firsts[p], t, &capacity))
                return false;
            morph->count = skin->delta_count - morph->first;
        }
    }
    return true;
}

/* Gives the nodes the numbers of their morphs: those of a node follow one another. */
static void number_morphs(struct moving *m)
{
    uint32_t next = 0;
    for (uint32_t i = 1; i < m->result->skin.node_count; i++) {
        struct gltf_moved *moved = &m->moved[m->numbers[i]];
        moved->first_morph = next;
        next += moved->target_count * moved->part_count;
    }
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool begin(struct moving *m)
{
    const struct gltf *g = m->g;
    const size_t nodes = (size_t)g->lists[GLTF_NODES].count + 1;
    const size_t skins = (size_t)g->lists[GLTF_SKINS].count + 1;
    m->moved = calloc(nodes, sizeof *m->moved);
    m->numbers = calloc(KILN_MAX_SKIN_NODES, sizeof *m->numbers);
    m->first_bones = calloc(skins, sizeof *m->first_bones);
    m->skin_counts = calloc(skins, sizeof *m->skin_counts);
    for (size_t i = 0; m->moved && i < nodes; i++)
        m->moved[i].node = GLTF_NONE;
    return (m->moved && m->numbers && m->first_bones && m->skin_counts) ||
           decode_out_of_memory(g->error);
}

static void finish(struct moving *m)
{
    for (uint32_t i = 0; i < m->part_count; i++) {
        for (uint32_t t = 0; m->parts[i].targets && t < m->parts[i].target_count; t++) {
            free(m->parts[i].targets[t].positions);
            free(m->parts[i].targets[t].normals);
        }
        free(m->parts[i].targets);
        free(m->parts[i].weights);
    }
    free(m->parts);
    free(m->moved);
    free(m->numbers);
    free(m->first_bones);
    free(m->skin_counts);
    free(m->sources);
}

/* Finds normals where the file has none, and then stores the morph targets. */
static bool put_normals_and_morphs(struct moving *m)
{
    uint32_t *firsts = calloc((size_t)m->part_count + 1, sizeof *firsts);
    struct gltf_piece *pieces = calloc((size_t)m->part_count + 1, sizeof *pieces);
    bool ok = firsts && pieces;
    if (!ok)
        decode_out_of_memory(m->g->error);
    for (uint32_t i = 0; ok && i < m->part_count; i++) {
        const struct part *part = &m->parts[i];
        firsts[i] = part->first;
        pieces[i] = (struct gltf_piece){part->first, part->count, part->first_triangle,
                                        part->triangle_count, part->has_normals};
    }
    ok = ok && gltf_put_creases(m->g, pieces, m->part_count, m->result, &m->sources);
    for (uint32_t i = 0; ok && i < m->part_count; i++) {
        m->parts[i].first = pieces[i].first;
        m->parts[i].count = pieces[i].count;
    }
    ok = ok && put_morphs(m, firsts);
    free(firsts);
    free(pieces);
    return ok;
}

bool gltf_moving(struct gltf *g, struct kiln_mesh_result *result)
{
    struct moving m = {.g = g, .result = result};
    bool ok = begin(&m) && put_nodes(&m) && put_meshes(&m) && put_normals_and_morphs(&m);
    if (ok) {
        number_morphs(&m);
        ok = gltf_put_clips(g, m.moved, result);
    }
    finish(&m);
    return ok;
}
