/* This file makes a model of what a glTF scene shows while nothing moves. Meshes without a skin are
 * placed by their nodes, and shared between them. A mesh with a skin lies where its joints are, as
 * the specification says: where its own node is does not matter. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

static const double identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

struct still {
    struct gltf *g;
    struct decode_model *model;
    size_t mesh_capacity, part_capacity, triangle_count;
    /* the place, from 1, of each mesh's primitives among the model's meshes */
    size_t *made;
    uint32_t *ranks;       /* of the materials of the file; the last: of none */
    double (*bones)[3][4]; /* of the skin of the node at hand, to the file's space; NULL: none */
    uint32_t bone_count;
    bool placed; /* the bones have placed the primitive at hand */
};

/* ---- materials ------------------------------------------------------------------------------- */

/* Ranks the materials by their first use, that of a node's children before its own. The triangles
 * of a surface are ordered so since kiln's first version, and states of particles depend on it. */
static bool rank_materials(struct still *s)
{
    struct gltf *g = s->g;
    const uint32_t materials = g->lists[GLTF_MATERIALS].count;
    uint32_t next = 0, number = 0;
    uint32_t *nodes = gltf_children_first(g);
    s->ranks = nodes ? malloc(((size_t)materials + 1) * sizeof *s->ranks) : NULL;
    if (!s->ranks) {
        free(nodes);
        return decode_out_of_memory(g->error);
    }
    for (uint32_t i = 0; i <= materials; i++)
        s->ranks[i] = materials;
    for (uint32_t i = 0; i < g->order_count; i++) {
        const json_t *mesh = gltf_element(g, GLTF_MESHES, g->nodes[nodes[i]].mesh);
        const json_t *list = gltf_member(mesh, "primitives");
        size_t p_at = 0;
        for (const json_t *p; (p = gltf_item(list, p_at)); p_at++) {
            if (gltf_index(gltf_member(p, "material"), &number) && number < materials &&
                s->ranks[number] == materials)
                s->ranks[number] = next++;
        }
    }
    free(nodes);
    return true;
}

/* ---- growing --------------------------------------------------------------------------------- */

static bool add_mesh(struct still *s, struct gltf_primitive *from, size_t *number)
{
    struct decode_model *model = s->model;
    if (model->mesh_count == s->mesh_capacity) {
        s->mesh_capacity = 2 * s->mesh_capacity + 16;
        struct decode_model_mesh *more = realloc(model->meshes, s->mesh_capacity * sizeof *more);
        if (!more)
            return decode_out_of_memory(s->g->error);
        model->meshes = more;
    }
    *number = model->mesh_count++;
    model->meshes[*number] = (struct decode_model_mesh){.vertex_count = from->vertex_count,
                                                        .triangle_count = from->triangle_count,
                                                        .positions = from->positions,
                                                        .normals = from->normals,
                                                        .uvs = from->uvs,
                                                        .colors = from->colors,
                                                        .second_uvs = from->second_uvs,
                                                        .triangles = from->triangles,
                                                        .material = s->ranks[from->material],
                                                        .source = from->material};
    from->positions = from->normals = NULL;
    from->uvs = from->second_uvs = NULL;
    from->colors = NULL;
    from->triangles = NULL;
    return true;
}

static bool add_part(struct still *s, size_t mesh, const double rows[3][4])
{
    struct decode_model *model = s->model;
    const size_t triangles = model->meshes[mesh].triangle_count;
    if (triangles == 0)
        return true;
    if (triangles > KILN_MAX_MESH_TRIANGLES - s->triangle_count)
        return decode_refuse_size(s->g->error);
    s->triangle_count += triangles;
    if (model->part_count == s->part_capacity) {
        s->part_capacity = 2 * s->part_capacity + 16;
        struct decode_model_part *more = realloc(model->parts, s->part_capacity * sizeof *more);
        if (!more)
            return decode_out_of_memory(s->g->error);
        model->parts = more;
    }
    struct decode_model_part *part = &model->parts[model->part_count++];
    part->mesh = mesh;
    memcpy(part->rows, rows, sizeof part->rows);
    return true;
}

/* ---- skins ----------------------------------------------------------------------------------- */

/* Finds the matrices of the bones of a node's skin. */
static bool find_bones(struct still *s, uint32_t node)
{
    struct gltf *g = s->g;
    struct gltf_skin skin = {.count = 0};
    bool ok = gltf_read_skin(g, g->nodes[node].skin, &skin);
    s->bone_count = skin.count;
    s->bones = ok ? malloc((size_t)skin.count * sizeof *s->bones) : NULL;
    if (ok && !s->bones)
        ok = decode_out_of_memory(g->error);
    for (uint32_t i = 0; ok && i < skin.count; i++)
        gltf_multiply(g->nodes[skin.bones[i].node].world, skin.bones[i].offset, s->bones[i]);
    free(skin.bones);
    return ok;
}

static void place_vertex(const double m[3][4], float position[3], float *normal)
{
    double p[3], n[3];
    for (int row = 0; row < 3; row++)
        p[row] = m[row][0] * (double)position[0] + m[row][1] * (double)position[1] +
                 m[row][2] * (double)position[2] + m[row][3];
    for (int row = 0; normal && row < 3; row++) { /* by the cofactors */
        const double *a = m[(row + 1) % 3], *b = m[(row + 2) % 3];
        n[row] = 0.0;
        for (int c = 0; c < 3; c++)
            n[row] += (a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]) *
                      (double)normal[c];
    }
    const double sign = gltf_determinant(m) < 0.0 ? -1.0 : 1.0;
    for (int c = 0; c < 3; c++) {
        position[c] = (float)p[c];
        if (normal)
            normal[c] = (float)(sign * n[c]);
    }
}

/* Places the vertices of a primitive by the bones. Triangles that bones mirror are turned, as
 * lib/asset/geometry/skin.c does. */
static bool place_by_bones(struct still *s, struct gltf_primitive *primitive)
{
    double m[3][4];
    for (uint32_t i = 0; i < primitive->vertex_count; i++) {
        for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
            if (primitive->weights[i].bones[k] >= s->bone_count)
                return GLTF_SET(s->g, "a vertex has joint %u of a skin of %u",
                                primitive->weights[i].bones[k], s->bone_count);
        }
    }
    for (uint32_t i = 0; i < primitive->triangle_count; i++) {
        uint32_t *corners = primitive->triangles[i];
        const uint32_t second = corners[1];
        gltf_blend(&primitive->weights[corners[0]], s->bones, m);
        if (gltf_determinant(m) < 0.0) {
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
    for (uint32_t i = 0; i < primitive->vertex_count; i++) {
        gltf_blend(&primitive->weights[i], s->bones, m);
        place_vertex(m, primitive->positions[i], primitive->normals ? primitive->normals[i] : NULL);
    }
    return true;
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static bool make_mesh(struct still *s, uint32_t node, const json_t *json, size_t *number)
{
    struct gltf *g = s->g;
    struct gltf_primitive primitive;
    bool ok = gltf_read_primitive(g, json, g->wanted->uvs || g->wanted->materials, s->bones != NULL,
                                  &primitive);
    float *weights = NULL;
    if (ok)
        weights = gltf_default_weights(g, node, primitive.target_count, &ok);
    if (weights)
        gltf_morph(&primitive, weights);
    free(weights);
    s->placed = s->bones && primitive.weights;
    if (ok && s->placed)
        ok = place_by_bones(s, &primitive);
    ok = ok && add_mesh(s, &primitive, number);
    gltf_finish_primitive(&primitive);
    return ok;
}

/* Returns whether a node's mesh can be shared with other nodes: no skin and no weights of its own
 * change it. */
static bool is_shared(const struct still *s, uint32_t node)
{
    const struct gltf *g = s->g;
    return !s->bones && gltf_member(gltf_element(g, GLTF_NODES, node), "weights") == NULL;
}

static bool place_mesh(struct still *s, uint32_t node, const struct gltf_instances *instances,
                       size_t mesh)
{
    double rows[3][4];
    if (s->placed)
        return add_part(s, mesh, identity);
    for (uint32_t i = 0; i < instances->count; i++) {
        gltf_multiply(s->g->nodes[node].world, instances->rows[i], rows);
        if (!add_part(s, mesh, rows))
            return false;
    }
    return true;
}

/* Adds the primitives of a node's mesh. */
static bool add_primitives(struct still *s, uint32_t node, const struct gltf_instances *instances)
{
    struct gltf *g = s->g;
    const uint32_t mesh = g->nodes[node].mesh;
    const json_t *list = gltf_member(gltf_element(g, GLTF_MESHES, mesh), "primitives");
    const bool shared = is_shared(s, node);
    size_t next = shared ? s->made[mesh] : 0;
    const bool is_made = next > 0;
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(list, i_at)); i_at++) {
        size_t number = next - 1;
        if (!is_made && !make_mesh(s, node, i, &number))
            return false;
        if (!is_made && shared && s->made[mesh] == 0)
            s->made[mesh] = number + 1;
        next = number + 2;
        if (!place_mesh(s, node, instances, number))
            return false;
    }
    return true;
}

static bool add_node(struct still *s, uint32_t node)
{
    struct gltf *g = s->g;
    struct gltf_instances instances = {.count = 0};
    bool ok = gltf_find_instances(g, node, &instances) &&
              (g->nodes[node].skin == GLTF_NONE || find_bones(s, node));
    ok = ok && add_primitives(s, node, &instances);
    free(instances.rows);
    free(s->bones);
    s->bones = NULL;
    s->placed = false;
    return ok;
}

bool gltf_still(struct gltf *g, struct decode_model *model)
{
    struct still s = {.g = g, .model = model};
    s.made = calloc((size_t)g->lists[GLTF_MESHES].count + 1, sizeof *s.made);
    bool ok = s.made != NULL;
    if (!ok)
        decode_out_of_memory(g->error);
    ok = ok && rank_materials(&s);
    for (uint32_t i = 0; ok && i < g->order_count; i++) {
        const struct gltf_node *node = &g->nodes[g->order[i]];
        if (node->shown && node->mesh != GLTF_NONE)
            ok = add_node(&s, g->order[i]);
    }
    free(s.made);
    free(s.ranks);
    return ok;
}
