/* This file makes a model of assimp's scene, so that surface.c needs to know one form only. */
#include <assimp/scene.h>
#include <stdlib.h>
#include <string.h>

#include "decode.h"
#include "model.h"

struct converting {
    const struct aiScene *scene;
    struct decode_model *model;
    struct kiln_error *error;
    size_t part_capacity;
    size_t triangle_count; /* of all parts */
};

/* ---- meshes ---------------------------------------------------------------------------------- */

static size_t count_triangles(const struct aiMesh *mesh)
{
    size_t count = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        count += mesh->mFaces[i].mNumIndices == 3;
    return count;
}

static void copy_vectors(const struct aiVector3D *from, size_t count, float (*out)[3])
{
    for (size_t i = 0; i < count; i++) {
        const float v[3] = {from[i].x, from[i].y, from[i].z};
        memcpy(out[i], v, sizeof v);
    }
}

static void copy_triangles(const struct aiMesh *mesh, uint32_t (*out)[3])
{
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        for (int c = 0; c < 3 && face->mNumIndices == 3; c++)
            (*out)[c] = face->mIndices[c];
        out += face->mNumIndices == 3;
    }
}

static bool copy_mesh(const struct aiMesh *from, struct decode_model_mesh *to)
{
    const struct aiVector3D *uvs = from->mTextureCoords[0];
    const size_t vertices = from->mNumVertices;
    to->vertex_count = vertices;
    to->triangle_count = count_triangles(from);
    to->material = from->mMaterialIndex;
    to->positions = malloc(vertices * sizeof *to->positions);
    to->normals = from->mNormals ? malloc(vertices * sizeof *to->normals) : NULL;
    to->uvs = uvs ? malloc(vertices * sizeof *to->uvs) : NULL;
    to->triangles = malloc((to->triangle_count + 1) * sizeof *to->triangles);
    if (!to->positions || (from->mNormals && !to->normals) || (uvs && !to->uvs) || !to->triangles)
        return false;
    copy_vectors(from->mVertices, vertices, to->positions);
    if (from->mNormals)
        copy_vectors(from->mNormals, vertices, to->normals);
    for (size_t i = 0; uvs && i < vertices; i++) {
        to->uvs[i][0] = uvs[i].x;
        to->uvs[i][1] = uvs[i].y;
    }
    copy_triangles(from, to->triangles);
    return true;
}

static bool copy_meshes(struct converting *c)
{
    struct decode_model *model = c->model;
    const size_t count = c->scene->mNumMeshes;
    model->meshes = calloc(count + 1, sizeof *model->meshes);
    bool ok = model->meshes != NULL;
    for (size_t i = 0; ok && i < count; i++) {
        model->mesh_count = i + 1;
        ok = copy_mesh(c->scene->mMeshes[i], &model->meshes[i]);
    }
    return ok || decode_out_of_memory(c->error);
}

/* ---- parts ----------------------------------------------------------------------------------- */

struct placed {
    const struct aiNode *node;
    double rows[3][4];
};

/* Returns the placement of a node: its parent's matrix times its own. */
static struct placed place(const struct aiNode *node, const double parent[3][4])
{
    const struct aiMatrix4x4 *m = &node->mTransformation;
    const double own[4][4] = {{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                              {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                              {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4},
                              {0, 0, 0, 1}};
    struct placed placed = {.node = node};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += parent[row][k] * own[k][column];
            placed.rows[row][column] = sum;
        }
    }
    return placed;
}

/* Adds a mesh as a part, unless it has no triangle. The count is checked here, since a file may
 * place one mesh any number of times. */
static bool add_part(struct converting *c, size_t mesh, const double rows[3][4])
{
    struct decode_model *model = c->model;
    const size_t triangles = model->meshes[mesh].triangle_count;
    if (triangles == 0)
        return true;
    if (triangles > KILN_MAX_MESH_TRIANGLES - c->triangle_count)
        return decode_refuse_size(c->error);
    c->triangle_count += triangles;
    if (model->part_count == c->part_capacity) {
        c->part_capacity = 2 * c->part_capacity + 16;
        struct decode_model_part *more = realloc(model->parts, c->part_capacity * sizeof *more);
        if (!more)
            return decode_out_of_memory(c->error);
        model->parts = more;
    }
    struct decode_model_part *part = &model->parts[model->part_count++];
    part->mesh = mesh;
    memcpy(part->rows, rows, sizeof part->rows);
    return true;
}

/* Grows a stack by `more` entries and returns the first of them; NULL: no memory. */
static struct placed *push(struct placed **stack, size_t *count, size_t *capacity, size_t more)
{
    if (*count + more > *capacity) {
        *capacity = 2 * (*count + more);
        struct placed *grown = realloc(*stack, *capacity * sizeof *grown);
        if (!grown)
            return NULL;
        *stack = grown;
    }
    *count += more;
    return *stack + *count - more;
}

/* Adds the parts of all nodes. It walks the tree, each node before its children, without recursion,
 * since an untrusted file decides the depth. */
static bool find_parts(struct converting *c)
{
    static const double world[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    struct placed *stack = NULL;
    size_t count = 0, capacity = 0;
    struct placed *next = push(&stack, &count, &capacity, 1);
    if (next)
        *next = place(c->scene->mRootNode, world);
    bool ok = next || decode_out_of_memory(c->error);
    while (ok && count > 0) {
        const struct placed at = stack[--count];
        const unsigned children = at.node->mNumChildren;
        for (unsigned i = 0; ok && i < at.node->mNumMeshes; i++)
            ok = add_part(c, at.node->mMeshes[i], at.rows);
        next = push(&stack, &count, &capacity, children);
        ok = ok && (next || decode_out_of_memory(c->error));
        for (unsigned i = 0; ok && i < children; i++) /* the first one on top */
            next[children - 1 - i] = place(at.node->mChildren[i], at.rows);
    }
    free(stack);
    return ok;
}

bool decode_assimp_model(const struct aiScene *scene, struct decode_model *model,
                         struct kiln_error *error)
{
    struct converting c = {.scene = scene, .model = model, .error = error};
    return copy_meshes(&c) && find_parts(&c);
}
