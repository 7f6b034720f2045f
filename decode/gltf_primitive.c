/* This file reads the primitives of glTF meshes: vertices, triangles of all modes, morph targets,
 * and the joints that move a vertex. Points and lines have no surface, and are left out. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

enum {
    MOST_TARGETS = 1024, /* of a primitive */
    MODE_TRIANGLES = 4,
    MODE_STRIP = 5,
    MODE_FAN = 6,
};

void gltf_finish_primitive(struct gltf_primitive *primitive)
{
    free(primitive->positions);
    free(primitive->normals);
    free(primitive->uvs);
    free(primitive->colors);
    free(primitive->second_uvs);
    free(primitive->triangles);
    free(primitive->weights);
    for (uint32_t i = 0; primitive->targets && i < primitive->target_count; i++) {
        free(primitive->targets[i].positions);
        free(primitive->targets[i].normals);
    }
    free(primitive->targets);
    *primitive = (struct gltf_primitive){.vertex_count = 0};
}

/* ---- triangles ------------------------------------------------------------------------------- */

/* Returns the place of a triangle's corner among the indices, in the order of glTF's specification.
 */
static size_t place_of(uint32_t mode, size_t triangle, size_t corner)
{
    if (mode == MODE_STRIP)
        return corner == 0 ? triangle : triangle + (triangle % 2 == 0 ? corner : 3 - corner);
    if (mode == MODE_FAN)
        return corner == 2 ? 0 : triangle + corner + 1;
    return 3 * triangle + corner;
}

/* Makes the triangles of `count` indices, or of the vertices in their order if `indices` is NULL.
 */
static bool put_triangles(struct gltf *g, uint32_t mode, const uint32_t *indices, uint32_t count,
                          struct gltf_primitive *out)
{
    const uint32_t triangles = mode == MODE_TRIANGLES ? count / 3 : count > 2 ? count - 2 : 0;
    if (triangles > KILN_MAX_MESH_TRIANGLES)
        return decode_refuse_size(g->error);
    out->triangles = malloc(((size_t)triangles + 1) * sizeof *out->triangles);
    if (!out->triangles)
        return decode_out_of_memory(g->error);
    for (size_t i = 0; i < triangles; i++) {
        for (size_t c = 0; c < 3; c++) {
            const size_t place = place_of(mode, i, c);
            out->triangles[i][c] = indices ? indices[place] : (uint32_t)place;
        }
    }
    out->triangle_count = triangles;
    return true;
}

/* Finds the range of vertices that indices name, and makes them count from its first one. */
static struct gltf_range find_range(uint32_t *indices, uint32_t count)
{
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        low = indices[i] < low ? indices[i] : low;
        high = indices[i] > high ? indices[i] : high;
    }
    if (count == 0)
        return (struct gltf_range){0, 0};
    for (uint32_t i = 0; i < count; i++)
        indices[i] -= low;
    return (struct gltf_range){low, high - low < UINT32_MAX ? high - low + 1 : UINT32_MAX};
}

/* Reads the triangles, and finds the range of vertices that they have. Meshes that share vertices
 * in one accessor have ranges of it, so that a large one is not read whole for each. */
static bool read_triangles(struct gltf *g, const json_t *json, uint32_t mode, uint32_t vertices,
                           struct gltf_range *range, struct gltf_primitive *out)
{
    uint32_t accessor = 0, count = 0;
    *range = (struct gltf_range){0, vertices};
    if (!gltf_reference(g, json, "indices", GLTF_ACCESSORS, &accessor))
        return false;
    if (accessor == GLTF_NONE)
        return vertices <= KILN_MAX_MESH_VERTICES ? put_triangles(g, mode, NULL, vertices, out)
                                                  : decode_refuse_size(g->error);
    if (!gltf_count(g, accessor, 3 * KILN_MAX_MESH_TRIANGLES, "indices", &count))
        return false;
    uint32_t *indices = gltf_read_integers(g, accessor, "SCALAR", (struct gltf_range){0, count});
    if (!indices)
        return false;
    *range = find_range(indices, count);
    bool ok = true;
    if ((uint64_t)range->first + range->count > vertices)
        ok = GLTF_SET(g, "accessor %u has the index %llu, and the mesh has %u vertices", accessor,
                      (unsigned long long)range->first + range->count - 1, vertices);
    else if (range->count > KILN_MAX_MESH_VERTICES)
        ok = decode_refuse_size(g->error);
    ok = ok && put_triangles(g, mode, indices, count, out);
    free(indices);
    return ok;
}

/* ---- influences ------------------------------------------------------------------------------ */

enum { MOST_SETS = 8, MOST_INFLUENCES = 4 * MOST_SETS };

struct influence {
    uint32_t joint;
    float weight;
};

/* Adds an influence; the same joint may come again. */
static void add_influence(struct influence *all, uint32_t *count, uint32_t joint, float weight)
{
    for (uint32_t i = 0; i < *count; i++) {
        if (all[i].joint == joint) {
            all[i].weight += weight;
            return;
        }
    }
    all[(*count)++] = (struct influence){joint, weight};
}

/* Keeps the strongest influences, in the order of their joints, in which they are summed up. */
static void keep_strongest(struct influence *all, uint32_t count, struct kiln_skin_weights *out)
{
    uint32_t kept = count;
    for (; kept > KILN_SKIN_INFLUENCES; kept--) {
        uint32_t least = 0;
        for (uint32_t i = 1; i < kept; i++)
            least = all[i].weight < all[least].weight ? i : least;
        memmove(&all[least], &all[least + 1], (kept - least - 1) * sizeof *all);
    }
    for (uint32_t i = 1; i < kept; i++) {
        for (uint32_t k = i; k > 0 && all[k].joint < all[k - 1].joint; k--) {
            const struct influence swap = all[k];
            all[k] = all[k - 1];
            all[k - 1] = swap;
        }
    }
    for (uint32_t i = 0; i < kept; i++) {
        out->bones[i] = (uint16_t)all[i].joint;
        out->weights[i] = all[i].weight;
    }
}

/* Makes the weights of a vertex sum to 1, unless they do up to rounding, which is left to those who
 * use them. A vertex without weights follows its first joint. */
static void normalize(struct kiln_skin_weights *of)
{
    double sum = 0.0;
    for (int i = 0; i < KILN_SKIN_INFLUENCES; i++)
        sum += (double)of->weights[i];
    const bool is_usable = sum > 1e-12 && sum < 1e12;
    for (int i = 0; i < KILN_SKIN_INFLUENCES && !(sum > 0.995 && sum < 1.005); i++)
        of->weights[i] = is_usable ? (float)((double)of->weights[i] / sum) : i == 0 ? 1.0f : 0.0f;
}

struct weighting {
    uint32_t *const *joints;
    float *const *weights;
    uint32_t sets;
    bool is_negative, is_unsound, has_more;
};

static void put_vertex_weights(struct weighting *w, uint32_t vertex, struct kiln_skin_weights *out)
{
    struct influence all[MOST_INFLUENCES];
    uint32_t count = 0;
    for (uint32_t set = 0; set < w->sets; set++) {
        for (size_t k = 0; k < 4; k++) {
            const float weight = w->weights[set][4 * (size_t)vertex + k];
            const uint32_t joint = w->joints[set][4 * (size_t)vertex + k];
            w->is_negative = w->is_negative || !(weight >= 0.0f);
            if (weight > 0.0f)
                add_influence(all, &count, joint < UINT16_MAX ? joint : UINT16_MAX, weight);
        }
    }
    if (count == 0)
        add_influence(all, &count, w->joints[0][4 * (size_t)vertex], 0.0f);
    w->has_more = w->has_more || count > KILN_SKIN_INFLUENCES;
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++)
        sum += all[i].weight;
    w->is_unsound = w->is_unsound || !(sum > 0.98f && sum < 1.02f);
    keep_strongest(all, count, out);
    normalize(out);
}

bool gltf_put_weights(struct gltf *g, struct gltf_primitive *primitive, uint32_t *const joints[],
                      float *const weights[], uint32_t sets)
{
    struct weighting w = {.joints = joints, .weights = weights, .sets = sets};
    primitive->weights = calloc((size_t)primitive->vertex_count + 1, sizeof *primitive->weights);
    if (!primitive->weights)
        return decode_out_of_memory(g->error);
    for (uint32_t i = 0; i < primitive->vertex_count; i++)
        put_vertex_weights(&w, i, &primitive->weights[i]);
    if (w.is_negative)
        return GLTF_SET(g, "the weight of a joint is negative or no number; allowed are numbers of "
                           "at least 0");
    if (w.is_unsound)
        gltf_note(g,
                  "the weights of some vertices do not sum to 1, and are scaled so that they do");
    if (w.has_more)
        gltf_note(g, "more than 4 joints move some vertices: those with the largest weights do");
    return true;
}

static bool read_sets(struct gltf *g, const json_t *attributes, struct gltf_range range,
                      uint32_t *joints[MOST_SETS], float *weights[MOST_SETS], uint32_t *sets)
{
    for (*sets = 0; *sets < MOST_SETS; ++*sets) {
        char joint_key[16], weight_key[16];
        uint32_t joint = 0, weight = 0;
        snprintf(joint_key, sizeof joint_key, "JOINTS_%u", *sets);
        snprintf(weight_key, sizeof weight_key, "WEIGHTS_%u", *sets);
        if (!gltf_reference(g, attributes, joint_key, GLTF_ACCESSORS, &joint) ||
            !gltf_reference(g, attributes, weight_key, GLTF_ACCESSORS, &weight))
            return false;
        if (joint == GLTF_NONE || weight == GLTF_NONE)
            return true;
        joints[*sets] = gltf_read_integers(g, joint, "VEC4", range);
        weights[*sets] = joints[*sets] ? gltf_read(g, weight, "VEC4", range) : NULL;
        if (!weights[*sets]) {
            free(joints[*sets]);
            joints[*sets] = NULL;
            return false;
        }
    }
    return true;
}

static bool read_weights(struct gltf *g, const json_t *attributes, struct gltf_range range,
                         struct gltf_primitive *out)
{
    uint32_t *joints[MOST_SETS] = {NULL}, sets = 0;
    float *weights[MOST_SETS] = {NULL};
    bool ok = read_sets(g, attributes, range, joints, weights, &sets);
    if (ok && sets > 0)
        ok = gltf_put_weights(g, out, joints, weights, sets);
    for (uint32_t i = 0; i < MOST_SETS; i++) {
        free(joints[i]);
        free(weights[i]);
    }
    return ok;
}

/* ---- attributes ------------------------------------------------------------------------------ */

/* Reads an attribute of the vertices; *out is NULL if there is none. */
static bool read_attribute(struct gltf *g, const json_t *attributes, const char *key,
                           const char *type, struct gltf_range range, float **out)
{
    uint32_t accessor = 0;
    if (!gltf_reference(g, attributes, key, GLTF_ACCESSORS, &accessor))
        return false;
    if (accessor == GLTF_NONE)
        return true;
    *out = gltf_read(g, accessor, type, range);
    return *out != NULL;
}

static bool read_targets(struct gltf *g, const json_t *json, struct gltf_range range,
                         struct gltf_primitive *out)
{
    const json_t *targets = gltf_member(json, "targets");
    const uint32_t count = gltf_size(targets);
    if (count > MOST_TARGETS)
        return GLTF_SET(g, "a mesh has %u morph targets; allowed are %d", count, MOST_TARGETS);
    if (count == 0)
        return true;
    out->targets = calloc(count, sizeof *out->targets);
    if (!out->targets)
        return decode_out_of_memory(g->error);
    out->target_count = count;
    uint32_t number = 0;
    size_t i_at = 0;
    for (const json_t *i; (i = gltf_item(targets, i_at)); i_at++) {
        struct gltf_target *target = &out->targets[number++];
        float *positions = NULL, *normals = NULL;
        const bool ok = read_attribute(g, i, "POSITION", "VEC3", range, &positions) &&
                        read_attribute(g, i, "NORMAL", "VEC3", range, &normals);
        target->positions = (float(*)[3])positions;
        target->normals = (float(*)[3])normals;
        if (!ok)
            return false;
    }
    return true;
}

static bool read_plain(struct gltf *g, const json_t *json, uint32_t mode, bool uvs, bool weights,
                       struct gltf_primitive *out)
{
    const json_t *attributes = gltf_member(json, "attributes");
    uint32_t accessor = 0, vertices = 0;
    struct gltf_range range;
    if (!gltf_reference(g, attributes, "POSITION", GLTF_ACCESSORS, &accessor))
        return false;
    if (accessor == GLTF_NONE)
        return true;
    if (!gltf_count(g, accessor, UINT32_MAX, "vertices", &vertices) ||
        !read_triangles(g, json, mode, vertices, &range, out))
        return false;
    float *positions = NULL, *normals = NULL, *coordinates = NULL;
    const bool ok =
        read_attribute(g, attributes, "POSITION", "VEC3", range, &positions) &&
        read_attribute(g, attributes, "NORMAL", "VEC3", range, &normals) &&
        (!uvs || read_attribute(g, attributes, "TEXCOORD_0", "VEC2", range, &coordinates));
    out->positions = (float(*)[3])positions;
    out->normals = (float(*)[3])normals;
    out->uvs = (float(*)[2])coordinates;
    if (ok)
        gltf_bound_uvs(out->uvs, range.count);
    out->vertex_count = range.count;
    return ok && gltf_read_colors(g, attributes, range, out) &&
           (!weights || read_weights(g, attributes, range, out)) &&
           read_targets(g, json, range, out);
}

/* ---- all of it ------------------------------------------------------------------------------- */

bool gltf_read_primitive(struct gltf *g, const json_t *json, bool uvs, bool weights,
                         struct gltf_primitive *primitive)
{
    *primitive = (struct gltf_primitive){.vertex_count = 0};
    uint32_t mode = MODE_TRIANGLES;
    const json_t *said = gltf_member(json, "mode");
    if (said && (!gltf_index(said, &mode) || mode > MODE_FAN))
        return GLTF_SET(g, "a primitive has a mode that glTF does not have");
    if (!gltf_reference(g, json, "material", GLTF_MATERIALS, &primitive->material))
        return false;
    if (primitive->material == GLTF_NONE)
        primitive->material = g->lists[GLTF_MATERIALS].count;
    const json_t *draco = gltf_draco_of(g, json);
    bool ok = true;
    if (draco)
        ok = gltf_read_draco(g, json, draco, uvs, weights, primitive) &&
             read_targets(g, json, (struct gltf_range){0, primitive->vertex_count}, primitive);
    else if (mode >= MODE_TRIANGLES)
        ok = read_plain(g, json, mode, uvs, weights, primitive);
    if (ok)
        gltf_place_uvs(g, primitive);
    return ok;
}

float *gltf_default_weights(struct gltf *g, uint32_t node, uint32_t count, bool *ok)
{
    const json_t *json = gltf_element(g, GLTF_NODES, node);
    const json_t *list = gltf_member(json, "weights");
    if (!list)
        list = gltf_member(gltf_element(g, GLTF_MESHES, g->nodes[node].mesh), "weights");
    *ok = true;
    if (count == 0 || gltf_size(list) == 0)
        return NULL;
    float *weights = calloc(count, sizeof *weights);
    *ok = weights != NULL;
    if (!weights)
        decode_out_of_memory(g->error);
    for (uint32_t i = 0; weights && i < count; i++) {
        double weight = 0.0;
        if (gltf_number(gltf_item(list, i), &weight))
            weights[i] = (float)weight;
    }
    return weights;
}

void gltf_morph(struct gltf_primitive *primitive, const float *weights)
{
    for (size_t i = 0; i < primitive->vertex_count; i++) {
        for (size_t c = 0; c < 3; c++) {
            double place = (double)primitive->positions[i][c];
            double normal = primitive->normals ? (double)primitive->normals[i][c] : 0.0;
            for (uint32_t t = 0; t < primitive->target_count; t++) {
                const struct gltf_target *target = &primitive->targets[t];
                const double weight = (double)weights[t];
                if (target->positions)
                    place += weight * (double)target->positions[i][c];
                if (target->normals && primitive->normals)
                    normal += weight * (double)target->normals[i][c];
            }
            primitive->positions[i][c] = (float)place;
            if (primitive->normals)
                primitive->normals[i][c] = (float)normal;
        }
    }
}
