/* This file converts the nodes, bones and clips of a mesh that moves from assimp's scene. Assimp's
 * scene does not tell how keys are interpolated, nor which rotations the file has, so both are read
 * from the glTF file itself. */
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <libfyaml.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

struct skinning {
    const struct decode_mesh *wanted;
    const struct aiScene *scene;
    struct kiln_mesh_result *result;
    struct kiln_error *error;
    struct fy_document *json; /* NULL: the file has no JSON */
    const struct aiNode *nodes[KILN_MAX_SKIN_NODES];
    long numbers[KILN_MAX_SKIN_NODES]; /* numbers of the nodes in the file; -1: not in it */
    bool turned[KILN_MAX_SKIN_NODES];  /* whether the clip at hand rotates the node */
};

#define SET(s, ...) kiln_error_set((s)->error, KILN_INVALID_INPUT, __VA_ARGS__)

/* ---- the file itself ------------------------------------------------------------------------- */

/* Returns the first member of that name, as assimp does. */
static struct fy_node *member(struct fy_node *node, const char *key)
{
    void *at = NULL;
    if (!node || !fy_node_is_mapping(node))
        return NULL;
    for (struct fy_node_pair *pair; (pair = fy_node_mapping_iterate(node, &at));) {
        size_t length = 0;
        const char *text = fy_node_get_scalar(fy_node_pair_key(pair), &length);
        if (text && length == strlen(key) && memcmp(text, key, length) == 0)
            return fy_node_pair_value(pair);
    }
    return NULL;
}

static const char *text_of(struct fy_node *node)
{
    const char *text = node ? fy_node_get_scalar0(node) : NULL;
    return text ? text : "";
}

/* Returns the next member of a list, or of an object (glTF 1); NULL after the last one. */
static struct fy_node *next_of(struct fy_node *node, void **at)
{
    if (node && fy_node_is_sequence(node))
        return fy_node_sequence_iterate(node, at);
    return node && fy_node_is_mapping(node) ? fy_node_pair_value(fy_node_mapping_iterate(node, at))
                                            : NULL;
}

static bool check_sampler(const struct skinning *s, struct fy_node *sampler)
{
    static const char linear[] = "LINEAR";
    struct fy_node *said = member(sampler, "interpolation");
    size_t length = 0;
    const char *text = said ? fy_node_get_scalar(said, &length) : linear;
    if (!said || (text && length == sizeof linear - 1 && memcmp(text, linear, length) == 0))
        return true;
    return SET(s, "a sampler's interpolation is '%.*s'; allowed is LINEAR",
               (int)(length < 40 ? length : 40), text ? text : "");
}

static bool read_json(struct skinning *s)
{
    if (s->wanted->format == KILN_MESH_OBJ)
        return true;
    /* an exporter's own additions may have a key twice */
    const struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_FORCE |
                                                 FYPCF_ALLOW_DUPLICATE_KEYS};
    size_t size;
    const char *json = decode_mesh_json(s->wanted, &size);
    s->json = fy_document_build_from_string(&config, json, size);
    if (s->json)
        return true;
    return SET(s, "the JSON cannot be read: it is broken, or nested deeper than %d levels",
               FYPCF_GUARANTEED_MINIMUM_DEPTH_LIMIT - 1);
}

static struct fy_node *json_member(const struct skinning *s, const char *key)
{
    return s->json ? member(fy_document_root(s->json), key) : NULL;
}

static bool check_interpolation(const struct skinning *s)
{
    struct fy_node *animations = json_member(s, "animations");
    void *at = NULL, *at_sampler = NULL;
    for (struct fy_node *one; (one = next_of(animations, &at)); at_sampler = NULL) {
        struct fy_node *samplers = member(one, "samplers");
        for (struct fy_node *sampler; (sampler = next_of(samplers, &at_sampler));) {
            if (!check_sampler(s, sampler))
                return false;
        }
    }
    return true;
}

/* Finds the numbers of nodes by their names. Assimp's nodes have the names of the file's nodes or,
 * without a name, "nodes[NUMBER]". */
static void find_numbers(struct skinning *s)
{
    const uint32_t count = s->result->skin.node_count;
    struct fy_node *nodes = json_member(s, "nodes");
    void *at = NULL;
    long number = 0;
    for (uint32_t i = 0; i < count; i++)
        s->numbers[i] = -1;
    for (struct fy_node *one; (one = next_of(nodes, &at)); number++) {
        char own[32];
        snprintf(own, sizeof own, "nodes[%ld]", number);
        const char *said = text_of(member(one, "name"));
        const char *name = *said ? said : own;
        for (uint32_t i = 0; i < count; i++) {
            if (strcmp(s->nodes[i]->mName.data, name) == 0)
                s->numbers[i] = number;
        }
    }
}

static void find_turned(struct skinning *s, struct fy_node *animation)
{
    struct fy_node *channels = member(animation, "channels");
    void *at = NULL;
    memset(s->turned, 0, sizeof s->turned);
    for (struct fy_node *one; (one = next_of(channels, &at));) {
        struct fy_node *target = member(one, "target");
        const char *digits = text_of(member(target, "node"));
        if (*digits == '\0' || strcmp(text_of(member(target, "path")), "rotation") != 0)
            continue;
        const long number = strtol(digits, NULL, 10);
        for (uint32_t i = 0; i < s->result->skin.node_count; i++)
            s->turned[i] = s->turned[i] || s->numbers[i] == number;
    }
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static bool put_matrix(const struct skinning *s, const struct aiMatrix4x4 *m, mat4 out)
{
    const float4 rows[3] = {
        {m->a1, m->a2, m->a3, m->a4}, {m->b1, m->b2, m->b3, m->b4}, {m->c1, m->c2, m->c3, m->c4}};
    kiln_matrix_from_rows(rows, out);
    return (m->d1 == 0.0f && m->d2 == 0.0f && m->d3 == 0.0f && m->d4 == 1.0f) ||
           SET(s, "a matrix has the last row %g %g %g %g; allowed is 0 0 0 1", (double)m->d1,
               (double)m->d2, (double)m->d3, (double)m->d4);
}

/* Stores the nodes, parents before their children, without recursion, since a file's tree may be of
 * any depth. */
static bool put_nodes(struct skinning *s)
{
    struct kiln_skin_result *out = &s->result->skin;
    s->nodes[out->node_count++] = s->scene->mRootNode;
    for (uint32_t i = 0; i < out->node_count; i++) {
        const struct aiNode *node = s->nodes[i];
        if (!put_matrix(s, &node->mTransformation, out->nodes[i].rest))
            return false;
        if (node->mNumChildren > KILN_MAX_SKIN_NODES - out->node_count)
            return SET(s, "more than %d nodes; no more are allowed", KILN_MAX_SKIN_NODES);
        for (unsigned c = 0; c < node->mNumChildren; c++) {
            out->nodes[out->node_count].parent = i;
            s->nodes[out->node_count++] = node->mChildren[c];
        }
    }
    return true;
}

static bool find_node(const struct skinning *s, const struct aiString *name, uint32_t *found)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->result->skin.node_count; i++) {
        if (strcmp(s->nodes[i]->mName.data, name->data) == 0) {
            *found = i;
            count++;
        }
    }
    if (count == 1)
        return true;
    return SET(s, "%s nodes are called '%.100s', which moves; exactly one node must have this name",
               count ? "several" : "no", name->data);
}

/* ---- vertices -------------------------------------------------------------------------------- */

static bool put_bone(struct skinning *s, uint32_t node, mat4 offset, uint16_t *number)
{
    struct kiln_skin_result *out = &s->result->skin;
    uint32_t i = 0;
    while (i < out->bone_count &&
           (out->bones[i].node != node || memcmp(out->bones[i].offset, offset, sizeof(mat4)) != 0))
        i++;
    if (i == KILN_MAX_SKIN_BONES)
        return SET(s, "more than %d bones; no more are allowed", KILN_MAX_SKIN_BONES);
    if (i == out->bone_count) {
        out->bones[i].node = node;
        glm_mat4_copy(offset, out->bones[i].offset);
        out->bone_count++;
    }
    *number = (uint16_t)i;
    return true;
}

static bool add_weight(struct skinning *s, uint32_t vertex, uint16_t bone, float weight)
{
    struct kiln_skin_weights *of = &s->result->skin.weights[vertex];
    for (int i = 0; i < KILN_SKIN_INFLUENCES; i++) {
        if (of->weights[i] == 0.0f) {
            of->bones[i] = bone;
            of->weights[i] = weight;
            return true;
        }
    }
    return SET(s, "more than %d bones move vertex %u; no more are allowed", KILN_SKIN_INFLUENCES,
               vertex);
}

/* Stores the weights of a mesh's vertices by its bones; a mesh without bones follows its node. */
static bool put_weights(struct skinning *s, const struct aiMesh *mesh, uint32_t node,
                        uint32_t first)
{
    uint16_t number = 0;
    if (mesh->mNumBones == 0) {
        if (!put_bone(s, node, GLM_MAT4_IDENTITY, &number))
            return false;
        for (uint32_t i = 0; i < mesh->mNumVertices; i++)
            s->result->skin.weights[first + i] =
                (struct kiln_skin_weights){.bones = {number}, .weights = {1.0f}};
        return true;
    }
    for (unsigned b = 0; b < mesh->mNumBones; b++) {
        const struct aiBone *bone = mesh->mBones[b];
        uint32_t joint = 0;
        mat4 offset;
        if (!find_node(s, &bone->mName, &joint) || !put_matrix(s, &bone->mOffsetMatrix, offset) ||
            !put_bone(s, joint, offset, &number))
            return false;
        for (unsigned w = 0; w < bone->mNumWeights; w++) {
            const struct aiVertexWeight *weight = &bone->mWeights[w];
            if (weight->mVertexId < mesh->mNumVertices && weight->mWeight != 0.0f &&
                !add_weight(s, first + weight->mVertexId, number, weight->mWeight))
                return false;
        }
    }
    return true;
}

static void put_vertex(const struct aiMesh *mesh, unsigned i, float out[6])
{
    const struct aiVector3D *p = &mesh->mVertices[i];
    struct aiVector3D n = mesh->mNormals ? mesh->mNormals[i] : (struct aiVector3D){0, 1, 0};
    float length = sqrtf(n.x * n.x + n.y * n.y + n.z * n.z);
    if (!(length > 1e-12f && length < 1e12f)) /* the normal of a triangle without an area */
        n = (struct aiVector3D){0, length = 1, 0};
    const float vertex[6] = {p->x, p->y, p->z, n.x / length, n.y / length, n.z / length};
    memcpy(out, vertex, sizeof vertex);
}

/* Appends the vertices and triangles of one of the file's meshes. */
static bool put_part(const struct aiMesh *mesh, struct kiln_mesh_result *result,
                     struct kiln_error *error)
{
    uint32_t first = result->vertex_count;
    if (mesh->mNumVertices > KILN_MAX_MESH_VERTICES - first)
        return decode_refuse_size(error);
    for (unsigned i = 0; i < mesh->mNumVertices; i++)
        put_vertex(mesh, i, result->vertices[first + i]);
    result->vertex_count += mesh->mNumVertices;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices != 3)
            continue;
        if (result->triangle_count == KILN_MAX_MESH_TRIANGLES)
            return decode_refuse_size(error);
        uint32_t *triangle = result->triangles[result->triangle_count++];
        for (int c = 0; c < 3; c++)
            triangle[c] = first + face->mIndices[c];
    }
    return true;
}

static bool put_meshes(struct skinning *s)
{
    s->result->skin.has_normals = true;
    for (uint32_t i = 0; i < s->result->skin.node_count; i++) {
        const struct aiNode *node = s->nodes[i];
        for (unsigned k = 0; k < node->mNumMeshes; k++) {
            const struct aiMesh *mesh = s->scene->mMeshes[node->mMeshes[k]];
            const uint32_t first = s->result->vertex_count;
            if (mesh->mNumAnimMeshes > 0)
                return SET(s, "a mesh has morph targets; allowed are nodes and bones");
            if (!put_part(mesh, s->result, s->error) || !put_weights(s, mesh, i, first))
                return false;
            s->result->skin.has_normals &= mesh->mNormals != NULL;
        }
    }
    return true;
}

/* ---- clips ----------------------------------------------------------------------------------- */

static struct kiln_skin_key *add_key(struct skinning *s, struct kiln_skin_track *track,
                                     double ticks, double rate)
{
    struct kiln_skin_result *out = &s->result->skin;
    if (out->key_count == KILN_MAX_CLIP_KEYS) {
        SET(s, "more than %d keys; no more are allowed", KILN_MAX_CLIP_KEYS);
        return NULL;
    }
    if (track->count++ == 0)
        track->first = out->key_count;
    struct kiln_skin_key *key = &out->keys[out->key_count++];
    key->seconds = (float)(ticks / rate);
    return key;
}

static bool put_vectors(struct skinning *s, const struct aiVectorKey *keys, unsigned count,
                        double rate, struct kiln_skin_track *track)
{
    for (unsigned i = 0; i < count; i++) {
        struct kiln_skin_key *key = add_key(s, track, keys[i].mTime, rate);
        if (!key)
            return false;
        const struct aiVector3D v = keys[i].mValue;
        memcpy(key->value, (float[4]){v.x, v.y, v.z}, sizeof key->value);
    }
    return true;
}

static bool put_turns(struct skinning *s, const struct aiQuatKey *keys, unsigned count, double rate,
                      struct kiln_skin_track *track)
{
    for (unsigned i = 0; i < count; i++) {
        struct kiln_skin_key *key = add_key(s, track, keys[i].mTime, rate);
        if (!key)
            return false;
        const struct aiQuaternion q = keys[i].mValue;
        memcpy(key->value, (float[4]){q.x, q.y, q.z, q.w}, sizeof key->value);
    }
    return true;
}

/* Removes a rotation that assimp 5.2 adds to a node which the clip does not rotate. Assimp takes it
 * from the node's matrix; for a mirrored node it is a half turn, although the clip's scale mirrors
 * the node, too. If the matrix has only a scale, with the same signs, the rotation becomes none. */
static void mend_turn(const struct skinning *s, const struct kiln_skin_channel *channel)
{
    struct kiln_skin_result *out = &s->result->skin;
    const struct kiln_skin_track *tracks = channel->tracks;
    vec4 *rest = out->nodes[channel->node].rest;
    if (s->turned[channel->node] || tracks[KILN_CHANNEL_TURN].count != 1 ||
        tracks[KILN_CHANNEL_SCALE].count == 0)
        return;
    const float *scale = out->keys[tracks[KILN_CHANNEL_SCALE].first].value;
    struct kiln_skin_key *turn = &out->keys[tracks[KILN_CHANNEL_TURN].first];
    bool unturned = fabsf(turn->value[3]) < 1e-4f && rest[0][0] * rest[1][1] * rest[2][2] < 0.0f;
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++)
            unturned = unturned && (i == c ? rest[i][i] * scale[i] > 0.0f : rest[c][i] == 0.0f);
    }
    if (unturned)
        memcpy(turn->value, (float[4]){0.0f, 0.0f, 0.0f, 1.0f}, sizeof turn->value);
}

static bool put_channel(struct skinning *s, const struct aiNodeAnim *from, double rate)
{
    struct kiln_skin_result *out = &s->result->skin;
    if (out->channel_count == KILN_MAX_CLIP_CHANNELS)
        return SET(s, "animations move more than %d nodes; no more are allowed",
                   KILN_MAX_CLIP_CHANNELS);
    struct kiln_skin_channel *channel = &out->channels[out->channel_count++];
    struct kiln_skin_track *tracks = channel->tracks;
    const bool put = find_node(s, &from->mNodeName, &channel->node) &&
                     put_vectors(s, from->mPositionKeys, from->mNumPositionKeys, rate,
                                 &tracks[KILN_CHANNEL_MOVE]) &&
                     put_turns(s, from->mRotationKeys, from->mNumRotationKeys, rate,
                               &tracks[KILN_CHANNEL_TURN]) &&
                     put_vectors(s, from->mScalingKeys, from->mNumScalingKeys, rate,
                                 &tracks[KILN_CHANNEL_SCALE]);
    if (put)
        mend_turn(s, channel);
    return put;
}

static bool put_clips(struct skinning *s)
{
    struct kiln_skin_result *out = &s->result->skin;
    struct fy_node *animations = json_member(s, "animations");
    void *at = NULL;
    find_numbers(s);
    for (unsigned i = 0; i < s->scene->mNumAnimations; i++) {
        find_turned(s, next_of(animations, &at));
        const struct aiAnimation *from = s->scene->mAnimations[i];
        if (i == KILN_MAX_CLIPS)
            return SET(s, "more than %d animations; no more are allowed", KILN_MAX_CLIPS);
        if (from->mNumMeshChannels + from->mNumMorphMeshChannels > 0)
            return SET(s, "an animation moves something other than nodes and bones");
        struct kiln_skin_clip *clip = &out->clips[out->clip_count++];
        clip->first = out->channel_count;
        clip->count = from->mNumChannels;
        if (snprintf(clip->name, sizeof clip->name, "%s", from->mName.data) >=
            (int)sizeof clip->name)
            return SET(s, "the name of an animation is longer than %d bytes",
                       KILN_MAX_CLIP_NAME - 1);
        /* ticks a second; without any, assimp's default */
        const double rate = from->mTicksPerSecond > 0.0 ? from->mTicksPerSecond : 25.0;
        for (unsigned c = 0; c < from->mNumChannels; c++) {
            if (!put_channel(s, from->mChannels[c], rate))
                return false;
        }
    }
    return out->clip_count > 0 || SET(s, "the file has no animation");
}

bool decode_skin(const struct decode_mesh *wanted, const struct aiScene *scene,
                 struct kiln_mesh_result *result, struct kiln_error *error)
{
    struct skinning s = {.wanted = wanted, .scene = scene, .result = result, .error = error};
    const bool imported = read_json(&s) && check_interpolation(&s) && put_nodes(&s) &&
                          put_meshes(&s) && put_clips(&s);
    fy_document_destroy(s.json);
    return imported;
}
