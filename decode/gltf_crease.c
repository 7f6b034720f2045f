/* This file gives normals to the parts of a moving glTF mesh that have none in the file: those that
 * the mesh has while it does not move (surface.c), turned back to the space of its vertices. At a
 * crease, a vertex has several normals, so it becomes several vertices. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

struct creases {
    struct gltf *g;
    struct kiln_mesh_result *result;
    double (*bones)[3][4]; /* at rest, to the file's space */
    struct decode_corner *corners;
    /* The new vertices: a list for each old one, whose numbers count from 1. */
    float (*vertices)[6];
    struct kiln_skin_weights *weights;
    uint32_t *sources, *next, *heads;
    uint32_t count;
};

static void get_rows(mat4 m, double rows[3][4])
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++)
            rows[row][column] = (double)m[column][row];
    }
}

/* Finds the matrices of all bones while no clip plays. */
static bool place_bones(struct creases *c)
{
    const struct kiln_skin_result *skin = &c->result->skin;
    double(*nodes)[3][4] = malloc((size_t)skin->node_count * sizeof *nodes);
    c->bones = malloc(((size_t)skin->bone_count + 1) * sizeof *c->bones);
    const bool ok = nodes && c->bones;
    if (!ok)
        decode_out_of_memory(c->g->error);
    for (uint32_t i = 0; ok && i < skin->node_count; i++) {
        mat4 rest;
        double own[3][4];
        memcpy(rest, skin->nodes[i].rest, sizeof rest);
        get_rows(rest, own);
        if (i == 0)
            memcpy(nodes[i], own, sizeof own);
        else
            gltf_multiply(nodes[skin->nodes[i].parent], own, nodes[i]);
    }
    for (uint32_t i = 0; ok && i < skin->bone_count; i++) {
        mat4 offset;
        double own[3][4];
        memcpy(offset, skin->bones[i].offset, sizeof offset);
        get_rows(offset, own);
        gltf_multiply(nodes[skin->bones[i].node], own, c->bones[i]);
    }
    free(nodes);
    return ok;
}

static void place_corner(const struct creases *c, uint32_t vertex, bool has_normal,
                         struct decode_corner *corner)
{
    const float *v = c->result->vertices[vertex];
    double m[3][4];
    gltf_blend(&c->result->skin.weights[vertex], c->bones, m);
    for (int row = 0; row < 3; row++)
        corner->position[row] = (float)(m[row][0] * (double)v[0] + m[row][1] * (double)v[1] +
                                        m[row][2] * (double)v[2] + m[row][3]) +
                                0.0f;
    corner->has_normal = has_normal;
}

/* Places the corners of all triangles at rest. The corners of a mirrored triangle take another
 * order, as those of a mesh that does not move. Returns which corner is at a place. */
static int place_of(bool mirrored, int corner)
{
    return mirrored && corner > 0 ? 3 - corner : corner;
}

static bool is_mirrored(const struct creases *c, const uint32_t corners[3])
{
    double m[3][4];
    gltf_blend(&c->result->skin.weights[corners[0]], c->bones, m);
    return gltf_determinant(m) < 0.0;
}

static void place_piece(const struct creases *c, const struct gltf_piece *piece)
{
    for (uint32_t i = 0; i < piece->triangle_count; i++) {
        const uint32_t number = piece->first_triangle + i;
        const uint32_t *corners = c->result->triangles[number];
        const bool mirrored = is_mirrored(c, corners);
        for (int k = 0; k < 3; k++)
            place_corner(c, corners[k], piece->has_normals,
                         &c->corners[(size_t)number * 3 + (size_t)place_of(mirrored, k)]);
    }
}

/* Turns a normal of the pose at rest back: the matrix that turns normals is the inverse of the
 * transpose of the matrix of vertices. */
static void turn_back(const struct creases *c, uint32_t vertex, const float normal[3], float out[3])
{
    double m[3][4], n[3];
    gltf_blend(&c->result->skin.weights[vertex], c->bones, m);
    for (int column = 0; column < 3; column++)
        n[column] = m[0][column] * (double)normal[0] + m[1][column] * (double)normal[1] +
                    m[2][column] * (double)normal[2];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const bool good = length > 1e-30 && length < 1e30;
    for (int k = 0; k < 3; k++)
        out[k] = good ? (float)(n[k] / length) : k == 1 ? 1.0f : 0.0f;
}

static bool add_vertex(struct creases *c, uint32_t from, const float normal[3], uint32_t *number)
{
    if (c->count == KILN_MAX_MESH_VERTICES)
        return decode_refuse_size(c->g->error);
    *number = c->count++;
    memcpy(c->vertices[*number], c->result->vertices[from], 3 * sizeof(float));
    memcpy(c->vertices[*number] + 3, normal, 3 * sizeof(float));
    c->weights[*number] = c->result->skin.weights[from];
    c->sources[*number] = from;
    return true;
}

/* Finds the new vertex of a corner: one with the same normal, or another. */
static bool join(struct creases *c, uint32_t from, const float normal[3], uint32_t *number)
{
    for (uint32_t i = c->heads[from]; i > 0; i = c->next[i - 1]) {
        *number = i - 1;
        if (memcmp(c->vertices[*number] + 3, normal, 3 * sizeof(float)) == 0)
            return true;
    }
    if (!add_vertex(c, from, normal, number))
        return false;
    c->next[*number] = c->heads[from];
    c->heads[from] = *number + 1;
    return true;
}

static bool divide_piece(struct creases *c, struct gltf_piece *piece)
{
    const uint32_t first = c->count;
    for (uint32_t i = 0; i < piece->triangle_count; i++) {
        uint32_t *corners = c->result->triangles[piece->first_triangle + i];
        const bool mirrored = is_mirrored(c, corners);
        const size_t at = ((size_t)piece->first_triangle + i) * 3;
        uint32_t now[3];
        for (int k = 0; k < 3; k++) {
            float normal[3];
            turn_back(c, corners[k], c->corners[at + (size_t)place_of(mirrored, k)].normal, normal);
            if (!join(c, corners[k], normal, &now[k]))
                return false;
        }
        memcpy(corners, now, sizeof now);
    }
    piece->first = first;
    piece->count = c->count - first;
    return true;
}

/* Copies the vertices of a piece that has normals. */
static bool keep_piece(struct creases *c, struct gltf_piece *piece)
{
    const uint32_t first = c->count;
    uint32_t number = 0;
    for (uint32_t i = 0; i < piece->count; i++) {
        const uint32_t from = piece->first + i;
        if (!add_vertex(c, from, c->result->vertices[from] + 3, &number))
            return false;
    }
    for (uint32_t i = 0; i < piece->triangle_count; i++) {
        uint32_t *corners = c->result->triangles[piece->first_triangle + i];
        for (int k = 0; k < 3; k++)
            corners[k] = corners[k] - piece->first + first;
    }
    piece->first = first;
    return true;
}

static bool take_memory(struct creases *c)
{
    const size_t most = (size_t)c->result->vertex_count + 3 * (size_t)c->result->triangle_count;
    const size_t count = most < KILN_MAX_MESH_VERTICES ? most + 1 : KILN_MAX_MESH_VERTICES;
    c->vertices = malloc(count * sizeof *c->vertices);
    c->weights = malloc(count * sizeof *c->weights);
    c->sources = malloc(count * sizeof *c->sources);
    c->next = malloc(count * sizeof *c->next);
    c->heads = calloc((size_t)c->result->vertex_count + 1, sizeof *c->heads);
    c->corners = calloc(3 * (size_t)c->result->triangle_count + 1, sizeof *c->corners);
    const bool ok = c->vertices && c->weights && c->sources && c->next && c->heads && c->corners;
    if (!ok)
        decode_out_of_memory(c->g->error);
    return ok;
}

static bool divide(struct creases *c, struct gltf_piece *pieces, uint32_t count)
{
    struct kiln_mesh_result *result = c->result;
    if (!take_memory(c) || !place_bones(c))
        return false;
    for (uint32_t i = 0; i < count; i++)
        place_piece(c, &pieces[i]);
    if (!decode_find_normals(c->corners, 3 * (size_t)result->triangle_count, c->g->error))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (!(pieces[i].has_normals ? keep_piece(c, &pieces[i]) : divide_piece(c, &pieces[i])))
            return false;
    }
    result->vertex_count = c->count;
    memcpy(result->vertices, c->vertices, c->count * sizeof *c->vertices);
    memcpy(result->skin.weights, c->weights, c->count * sizeof *c->weights);
    return true;
}

bool gltf_put_creases(struct gltf *g, struct gltf_piece *pieces, uint32_t count,
                      struct kiln_mesh_result *result, uint32_t **sources)
{
    struct creases c = {.g = g, .result = result};
    bool is_needed = false;
    for (uint32_t i = 0; i < count; i++)
        is_needed = is_needed || !pieces[i].has_normals;
    if (!is_needed)
        return true;
    const bool ok = divide(&c, pieces, count);
    free(c.bones);
    free(c.corners);
    free(c.vertices);
    free(c.weights);
    free(c.next);
    free(c.heads);
    *sources = c.sources;
    return ok;
}
