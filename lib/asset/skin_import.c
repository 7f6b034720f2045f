/* What assimp knows of nodes, bones and clips. It drops how keys are interpolated, so the file
 * itself is asked for that. */
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <string.h>

#include "asset/mesh_import.h"
#include "base/error.h"

struct skinning {
    const struct kiln_mesh_request *request;
    const struct aiScene *scene;
    struct kiln_mesh_result *result;
    const struct aiNode *nodes[KILN_MAX_SKIN_NODES];
};

#define SET(s, ...) kiln_error_set(&(s)->result->error, KILN_INVALID_INPUT, __VA_ARGS__)

/* ---- interpolation --------------------------------------------------------------------------- */

/* What is between the quotes at or after `at`, and where it ends; NULL: no more of them. */
static const char *next_string(const char *at, const char *end, const char **after)
{
    const char *first = memchr(at, '"', (size_t)(end - at));
    const char *c = first ? first + 1 : end;
    while (c < end && *c != '"')
        c += *c == '\\' ? 2 : 1;
    if (c >= end)
        return NULL;
    *after = c;
    return first + 1;
}

/* Where the value of a key starts whose quotes end at `after`; NULL: it is no key. */
static const char *value_at(const char *after, const char *end)
{
    const char *c = after + 1;
    bool colon = false;
    while (c < end && (strchr(" \t\r\n", *c) || (*c == ':' && !colon)))
        colon |= *c++ == ':';
    return colon && c < end ? c : NULL;
}

static bool check_interpolation(const struct skinning *s)
{
    static const char key[] = "interpolation", linear[] = "LINEAR";
    const char *at = s->request->bytes, *end = at + s->request->size, *after = NULL;
    for (const char *text; (text = next_string(at, end, &after)) != NULL; at = after + 1) {
        const char *value = after - text == sizeof key - 1 && memcmp(text, key, sizeof key - 1) == 0
                                ? value_at(after, end)
                                : NULL;
        text = value && *value == '"' ? next_string(value, end, &after) : NULL;
        if (text &&
            (after - text != sizeof linear - 1 || memcmp(text, linear, sizeof linear - 1) != 0))
            return SET(s, "%s: a sampler's interpolation is '%.*s'; allowed is LINEAR",
                       s->request->name, (int)(after - text < 40 ? after - text : 40), text);
    }
    return true;
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static bool put_matrix(const struct skinning *s, const struct aiMatrix4x4 *m, kiln_affine out)
{
    const kiln_affine rows = {
        {m->a1, m->a2, m->a3, m->a4}, {m->b1, m->b2, m->b3, m->b4}, {m->c1, m->c2, m->c3, m->c4}};
    memcpy(out, rows, sizeof rows);
    return (m->d1 == 0.0f && m->d2 == 0.0f && m->d3 == 0.0f && m->d4 == 1.0f) ||
           SET(s, "%s: a matrix has the last row %g %g %g %g; allowed is 0 0 0 1", s->request->name,
               (double)m->d1, (double)m->d2, (double)m->d3, (double)m->d4);
}

/* Parents before their children, without recursion: a file may be as deep as it likes. */
static bool put_nodes(struct skinning *s)
{
    struct kiln_skin_result *out = &s->result->skin;
    s->nodes[out->node_count++] = s->scene->mRootNode;
    for (uint32_t i = 0; i < out->node_count; i++) {
        const struct aiNode *node = s->nodes[i];
        if (!put_matrix(s, &node->mTransformation, out->nodes[i].rest))
            return false;
        if (node->mNumChildren > KILN_MAX_SKIN_NODES - out->node_count)
            return SET(s, "%s: more than %d nodes", s->request->name, KILN_MAX_SKIN_NODES);
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
    return SET(s, "%s: %s nodes are called '%.100s', which moves; allowed is one", s->request->name,
               count ? "several" : "no", name->data);
}

/* ---- vertices -------------------------------------------------------------------------------- */

static bool put_bone(struct skinning *s, uint32_t node, const kiln_affine offset, uint16_t *number)
{
    struct kiln_skin_result *out = &s->result->skin;
    uint32_t i = 0;
    while (i < out->bone_count && (out->bones[i].node != node ||
                                   memcmp(out->bones[i].offset, offset, sizeof(kiln_affine)) != 0))
        i++;
    if (i == KILN_MAX_SKIN_BONES)
        return SET(s, "%s: more than %d bones", s->request->name, KILN_MAX_SKIN_BONES);
    if (i == out->bone_count) {
        out->bones[i].node = node;
        memcpy(out->bones[i].offset, offset, sizeof(kiln_affine));
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
    return SET(s, "%s: more than %d bones move vertex %u", s->request->name, KILN_SKIN_INFLUENCES,
               vertex);
}

/* As its bones say; without them, as the node does that it hangs on. */
static bool put_weights(struct skinning *s, const struct aiMesh *mesh, uint32_t node,
                        uint32_t first)
{
    static const kiln_affine same = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    uint16_t number = 0;
    if (mesh->mNumBones == 0) {
        if (!put_bone(s, node, same, &number))
            return false;
        for (uint32_t i = 0; i < mesh->mNumVertices; i++)
            s->result->skin.weights[first + i] =
                (struct kiln_skin_weights){.bones = {number}, .weights = {1.0f}};
        return true;
    }
    for (unsigned b = 0; b < mesh->mNumBones; b++) {
        const struct aiBone *bone = mesh->mBones[b];
        uint32_t joint = 0;
        kiln_affine offset;
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

static bool put_meshes(struct skinning *s)
{
    s->result->skin.has_normals = true;
    for (uint32_t i = 0; i < s->result->skin.node_count; i++) {
        const struct aiNode *node = s->nodes[i];
        for (unsigned k = 0; k < node->mNumMeshes; k++) {
            const struct aiMesh *mesh = s->scene->mMeshes[node->mMeshes[k]];
            const uint32_t first = s->result->vertex_count;
            if (mesh->mNumAnimMeshes > 0)
                return SET(s, "%s: a mesh has morph targets; allowed are nodes and bones",
                           s->request->name);
            if (!kiln_mesh_import_part(s->request, mesh, s->result) ||
                !put_weights(s, mesh, i, first))
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
        SET(s, "%s: more than %d keys", s->request->name, KILN_MAX_CLIP_KEYS);
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

static bool put_channel(struct skinning *s, const struct aiNodeAnim *from, double rate)
{
    struct kiln_skin_result *out = &s->result->skin;
    if (out->channel_count == KILN_MAX_CLIP_CHANNELS)
        return SET(s, "%s: clips move more than %d nodes", s->request->name,
                   KILN_MAX_CLIP_CHANNELS);
    struct kiln_skin_channel *channel = &out->channels[out->channel_count++];
    struct kiln_skin_track *tracks = channel->tracks;
    return find_node(s, &from->mNodeName, &channel->node) &&
           put_vectors(s, from->mPositionKeys, from->mNumPositionKeys, rate,
                       &tracks[KILN_CHANNEL_MOVE]) &&
           put_turns(s, from->mRotationKeys, from->mNumRotationKeys, rate,
                     &tracks[KILN_CHANNEL_TURN]) &&
           put_vectors(s, from->mScalingKeys, from->mNumScalingKeys, rate,
                       &tracks[KILN_CHANNEL_SCALE]);
}

static bool put_clips(struct skinning *s)
{
    struct kiln_skin_result *out = &s->result->skin;
    for (unsigned i = 0; i < s->scene->mNumAnimations; i++) {
        const struct aiAnimation *from = s->scene->mAnimations[i];
        if (i == KILN_MAX_CLIPS)
            return SET(s, "%s: more than %d animations", s->request->name, KILN_MAX_CLIPS);
        if (from->mNumMeshChannels + from->mNumMorphMeshChannels > 0)
            return SET(s, "%s: an animation moves more than nodes and bones", s->request->name);
        struct kiln_skin_clip *clip = &out->clips[out->clip_count++];
        clip->first = out->channel_count;
        clip->count = from->mNumChannels;
        if (snprintf(clip->name, sizeof clip->name, "%s", from->mName.data) >=
            (int)sizeof clip->name)
            return SET(s, "%s: the name of an animation is longer than %d bytes", s->request->name,
                       KILN_MAX_CLIP_NAME - 1);
        /* assimp's default where a file says nothing */
        const double rate = from->mTicksPerSecond > 0.0 ? from->mTicksPerSecond : 25.0;
        for (unsigned c = 0; c < from->mNumChannels; c++) {
            if (!put_channel(s, from->mChannels[c], rate))
                return false;
        }
    }
    return out->clip_count > 0 || SET(s, "%s: the file has no animation", s->request->name);
}

bool kiln_skin_import(const struct kiln_mesh_request *request, const struct aiScene *scene,
                      struct kiln_mesh_result *result)
{
    struct skinning s = {.request = request, .scene = scene, .result = result};
    return check_interpolation(&s) && put_nodes(&s) && put_meshes(&s) && put_clips(&s);
}
