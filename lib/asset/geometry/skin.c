/* This file poses meshes that move: it finds the pose of the nodes from keys, then matrices, then
 * vertices. It uses + - * / and square roots alone, so that every machine gives the same bits.
 * skin_check.c has checked the numbers before. */
#include "asset/geometry/skin.h"

#include <ctype.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "base/error.h"

/* The memory in which a pose is computed: with thousands of nodes, too large for the stack. */
struct scratch {
    pthread_mutex_t mutex;
    mat4 *nodes, *bones;
    float *morphs; /* weights */
};

struct kiln_skin {
    struct kiln_mesh *mesh; /* the mesh at rest */
    float (*sources)[6];    /* vertices before nodes and bones are applied; normals of any length */
    struct kiln_skin_weights *weights;
    uint32_t node_count, bone_count, clip_count, morph_count;
    struct kiln_skin_node *nodes;
    struct kiln_skin_bone *bones;
    struct kiln_skin_clip *clips;
    struct kiln_skin_channel *channels;
    struct kiln_skin_key *keys;
    struct kiln_skin_morph *morphs;
    struct kiln_skin_morph_channel *morph_channels;
    struct kiln_skin_delta *deltas;
    struct scratch *scratch;
    uint64_t bytes; /* of all arrays, without those of the mesh */
};

/* ---- between keys ---------------------------------------------------------------------------- */

/* Returns sin(t angle) / sin(angle) from the cosine of an angle of at most a quarter turn. It is a
 * series in (cosine - 1) whose coefficients are polynomials of t (Eberly 2011, A Fast and Accurate
 * Algorithm for Computing SLERP). A term is at most half of the one before. */
static float part_of_turn(float t, float cosine)
{
    enum { TERMS = 22 };
    const float x = cosine - 1.0f, square = t * t;
    float term = t, sum = t;
    for (int i = 1; i <= TERMS; i++) {
        const float n = (float)i, odd = 2.0f * n + 1.0f;
        term *= (square / (n * odd) - n / odd) * x;
        sum += term;
    }
    return sum;
}

/* Interpolates two quaternions along the shorter way, at constant speed. */
static void turn_between(versor a, versor b, float t, versor out)
{
    const float cosine = glm_quat_dot(a, b), sign = cosine < 0.0f ? -1.0f : 1.0f;
    const float from = part_of_turn(1.0f - t, sign * cosine);
    const float to = sign * part_of_turn(t, sign * cosine);
    glm_vec4_scale(a, from, out);
    glm_vec4_muladds(b, to, out);
    glm_quat_normalize(out); /* corrects the rounding of its length */
}

/* Interpolates by a cubic Hermite spline from one key frame to the next, each of which has three
 * keys (glTF 2.0, appendix C.5). */
static void spline_between(struct kiln_skin_key *a, struct kiln_skin_key *b, float t, vec4 out)
{
    const float square = t * t, cube = square * t, length = b->seconds - a->seconds;
    const float towards = 3.0f * square - 2.0f * cube;
    glm_vec4_scale(a[1].value, 1.0f - towards, out);
    glm_vec4_muladds(a[2].value, length * (cube - 2.0f * square + t), out);
    glm_vec4_muladds(b[1].value, towards, out);
    glm_vec4_muladds(b[0].value, length * (cube - square), out);
}

/* Reads a track at a moment; a track without keys does not change the value. */
static void read_track(const struct kiln_skin *skin, const struct kiln_skin_track *track,
                       bool turns, float seconds, vec4 out)
{
    const uint32_t parts = kiln_skin_parts(track);
    if (track->count == 0)
        return;
    struct kiln_skin_key *keys = skin->keys + track->first;
    /* the last key frame at or before the moment is in low .. high - 1 */
    uint32_t low = 0, high = track->count / parts;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        *(keys[(size_t)middle * parts].seconds <= seconds ? &low : &high) = middle;
    }
    const uint32_t next = (low + 1) * parts < track->count ? low + 1 : low;
    struct kiln_skin_key *a = &keys[(size_t)low * parts], *b = &keys[(size_t)next * parts];
    float t =
        seconds > a->seconds && b > a ? (seconds - a->seconds) / (b->seconds - a->seconds) : 0.0f;
    if (t == 0.0f || track->interpolation == KILN_SKIN_STEP)
        glm_vec4_copy(a[parts / 2].value, out);
    else if (track->interpolation == KILN_SKIN_CUBIC)
        spline_between(a, b, t, out);
    else if (turns)
        turn_between(a->value, b->value, t, out);
    else
        glm_vec4_lerp(a->value, b->value, t, out);
    if (turns && track->interpolation == KILN_SKIN_CUBIC)
        glm_quat_normalize(out);
}

/* ---- matrices -------------------------------------------------------------------------------- */

/* Composes a matrix that scales, then turns, then moves. */
static void compose(vec4 move, versor turn, vec4 scale, mat4 out)
{
    glm_quat_mat4(turn, out);
    glm_scale(out, scale);
    glm_vec3_copy(move, out[3]);
}

/* Finds each bone's matrix from vertices to the file's space. A clip, if any, moves its nodes. */
static void place_bones(const struct kiln_skin *skin, const struct kiln_skin_clip *clip,
                        float seconds, const struct scratch *scratch)
{
    mat4 *nodes = scratch->nodes;
    for (uint32_t i = 0; i < skin->node_count; i++)
        memcpy(nodes[i], skin->nodes[i].rest, sizeof nodes[i]);
    for (uint32_t i = 0; clip && i < clip->count; i++) {
        const struct kiln_skin_channel *channel = &skin->channels[clip->first + i];
        versor turn = GLM_QUAT_IDENTITY_INIT;
        vec4 move = GLM_VEC4_ZERO_INIT, scale = GLM_VEC4_ONE_INIT;
        read_track(skin, &channel->tracks[KILN_CHANNEL_MOVE], false, seconds, move);
        read_track(skin, &channel->tracks[KILN_CHANNEL_TURN], true, seconds, turn);
        read_track(skin, &channel->tracks[KILN_CHANNEL_SCALE], false, seconds, scale);
        compose(move, turn, scale, nodes[channel->node]);
    }
    for (uint32_t i = 1; i < skin->node_count; i++) {
        mat4 local;
        glm_mat4_copy(nodes[i], local);
        glm_mul(nodes[skin->nodes[i].parent], local, nodes[i]);
    }
    for (uint32_t i = 0; i < skin->bone_count; i++) {
        struct kiln_skin_bone bone = skin->bones[i];
        glm_mul(nodes[bone.node], bone.offset, scratch->bones[i]);
    }
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* Bounds a coordinate that only a faulty file makes too large. */
static float bounded(float x)
{
    return x >= -KILN_SKIN_FARTHEST ? (x <= KILN_SKIN_FARTHEST ? x : KILN_SKIN_FARTHEST)
                                    : -KILN_SKIN_FARTHEST;
}

/* Returns whether a matrix mirrors. */
static bool mirrors(mat4 m)
{
    mat3 linear;
    glm_mat4_pick3(m, linear);
    return glm_mat3_det(linear) < 0.0f;
}

/* Transforms a normal by the cofactors of a matrix. They keep it perpendicular to the surface under
 * any scaling. A mirror reverses its side. */
static void turn_normal(mat4 m, vec3 normal, vec3 out)
{
    mat3 cofactors;
    vec3 n;
    for (int c = 0; c < 3; c++)
        glm_vec3_cross(m[(c + 1) % 3], m[(c + 2) % 3], cofactors[c]);
    glm_mat3_mulv(cofactors, normal, n);
    const float square = glm_vec3_norm2(n);
    if (square > 1e-30f && square < 1e30f)
        glm_vec3_divs(n, mirrors(m) ? -sqrtf(square) : sqrtf(square), out);
    else
        glm_vec3_copy(GLM_YUP, out);
}

static void blend(const struct kiln_skin_weights *weights, mat4 *bones, mat4 out)
{
    glm_mat4_zero(out);
    for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
        const float weight = weights->weights[k];
        for (int c = 0; weight > 0.0f && c < 4; c++)
            glm_vec4_muladds(bones[weights->bones[k]][c], weight, out[c]);
    }
}

/* Reverses the triangles of mirrored parts, which would otherwise show their inside. */
static void turn_mirrored(struct kiln_skin *skin, const struct scratch *scratch)
{
    mat4 m;
    place_bones(skin, NULL, 0.0f, scratch);
    for (uint32_t i = 0; i < skin->mesh->triangle_count; i++) {
        uint32_t *corners = skin->mesh->triangles[i];
        const uint32_t second = corners[1];
        blend(&skin->weights[corners[0]], scratch->bones, m);
        if (mirrors(m)) {
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
}

/* Adds the morph targets to vertices, with the weights of a moment. */
static void morph(const struct kiln_skin *skin, const struct kiln_skin_clip *clip, float seconds,
                  float *weights, float (*vertices)[6])
{
    for (uint32_t i = 0; i < skin->morph_count; i++)
        weights[i] = skin->morphs[i].rest;
    for (uint32_t i = 0; clip && i < clip->morph_count; i++) {
        const struct kiln_skin_morph_channel *channel =
            &skin->morph_channels[clip->first_morph + i];
        vec4 value = {weights[channel->morph]};
        read_track(skin, &channel->track, false, seconds, value);
        weights[channel->morph] = value[0];
    }
    for (uint32_t i = 0; i < skin->morph_count; i++) {
        const struct kiln_skin_delta *deltas = skin->deltas + skin->morphs[i].first;
        for (uint32_t k = 0; weights[i] != 0.0f && k < skin->morphs[i].count; k++) {
            float *v = vertices[deltas[k].vertex];
            for (int c = 0; c < 3; c++) {
                v[c] += weights[i] * deltas[k].position[c];
                v[3 + c] += weights[i] * deltas[k].normal[c];
            }
        }
    }
}

static void pose(const struct kiln_skin *skin, const struct kiln_skin_clip *clip, float seconds,
                 const struct scratch *scratch, float (*vertices)[6])
{
    mat4 m;
    place_bones(skin, clip, seconds, scratch);
    memcpy(vertices, skin->sources, skin->mesh->vertex_count * sizeof *vertices);
    morph(skin, clip, seconds, scratch->morphs, vertices);
    for (uint32_t i = 0; i < skin->mesh->vertex_count; i++) {
        float *v = vertices[i];
        blend(&skin->weights[i], scratch->bones, m);
        glm_mat4_mulv3(m, v, 1.0f, v);
        for (int c = 0; c < 3; c++)
            v[c] = bounded(v[c]);
        turn_normal(m, v + 3, v + 3);
    }
}

void kiln_skin_pose(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    float (*vertices)[6])
{
    pthread_mutex_lock(&skin->scratch->mutex);
    pose(skin, &skin->clips[clip], seconds, skin->scratch, vertices);
    pthread_mutex_unlock(&skin->scratch->mutex);
}

void kiln_skin_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                         struct kiln_mesh *mesh)
{
    kiln_skin_pose(skin, clip, seconds, mesh->vertices);
    kiln_mesh_find_bounds(mesh);
}

/* ---- making a skin --------------------------------------------------------------------------- */

/* Scales quaternions to length 1, and finds the lengths of the clips. */
static void normalize_clip(struct kiln_skin *skin, struct kiln_skin_clip *clip)
{
    for (uint32_t c = 0; c < clip->count * KILN_CHANNEL_TRACKS; c++) {
        const uint32_t kind = c % KILN_CHANNEL_TRACKS;
        const struct kiln_skin_track *track =
            &skin->channels[clip->first + c / KILN_CHANNEL_TRACKS].tracks[kind];
        const uint32_t parts = kiln_skin_parts(track);
        for (uint32_t k = 0; k < track->count; k++) {
            struct kiln_skin_key *key = &skin->keys[track->first + k];
            if (kind == KILN_CHANNEL_TURN && k % parts == parts / 2)
                glm_quat_normalize(key->value);
            clip->length = fmaxf(clip->length, key->seconds);
        }
    }
}

/* Makes weights sum to 1 and quaternions have length 1, up to rounding. */
static void normalize(struct kiln_skin *skin)
{
    for (uint32_t i = 0; i < skin->mesh->vertex_count; i++) {
        float *weights = skin->weights[i].weights;
        const float sum = weights[0] + weights[1] + weights[2] + weights[3];
        for (int k = 0; k < KILN_SKIN_INFLUENCES; k++)
            weights[k] /= sum;
    }
    for (uint32_t i = 0; i < skin->clip_count; i++)
        normalize_clip(skin, &skin->clips[i]);
}

static void *copy_of(struct kiln_skin *skin, const void *from, size_t count, size_t size)
{
    void *copy = calloc(count ? count : 1, size);
    skin->bytes += count * size;
    if (copy && count > 0)
        memcpy(copy, from, count * size);
    return copy;
}

static struct kiln_skin *copy(const struct kiln_skin_result *r, struct kiln_mesh *mesh)
{
    struct kiln_skin *skin = calloc(1, sizeof *skin);
    if (!skin) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    skin->mesh = mesh;
    skin->sources = copy_of(skin, mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    skin->weights = copy_of(skin, r->weights, mesh->vertex_count, sizeof *r->weights);
    skin->channels = copy_of(skin, r->channels, r->channel_count, sizeof *r->channels);
    skin->keys = copy_of(skin, r->keys, r->key_count, sizeof *r->keys);
    skin->nodes = copy_of(skin, r->nodes, r->node_count, sizeof *r->nodes);
    skin->bones = copy_of(skin, r->bones, r->bone_count, sizeof *r->bones);
    skin->clips = copy_of(skin, r->clips, r->clip_count, sizeof *r->clips);
    skin->morphs = copy_of(skin, r->morphs, r->morph_count, sizeof *r->morphs);
    skin->morph_channels =
        copy_of(skin, r->morph_channels, r->morph_channel_count, sizeof *r->morph_channels);
    skin->deltas = copy_of(skin, r->deltas, r->delta_count, sizeof *r->deltas);
    skin->node_count = r->node_count;
    skin->bone_count = r->bone_count;
    skin->clip_count = r->clip_count;
    skin->morph_count = r->morph_count;
    if (!skin->sources || !skin->weights || !skin->channels || !skin->keys || !skin->nodes ||
        !skin->bones || !skin->clips || !skin->morphs || !skin->morph_channels || !skin->deltas)
        kiln_skin_destroy(&skin);
    return skin;
}

uint64_t kiln_skin_bytes(const struct kiln_skin *skin)
{
    return skin->bytes + kiln_mesh_bytes(skin->mesh);
}

static void destroy_scratch(struct scratch *scratch)
{
    if (!scratch)
        return;
    pthread_mutex_destroy(&scratch->mutex);
    free(scratch->nodes);
    free(scratch->bones);
    free(scratch->morphs);
    free(scratch);
}

static struct scratch *create_scratch(const struct kiln_skin *skin)
{
    struct scratch *scratch = calloc(1, sizeof *scratch);
    if (!scratch)
        return NULL;
    if (pthread_mutex_init(&scratch->mutex, NULL) != 0) {
        free(scratch);
        return NULL;
    }
    scratch->nodes = calloc(skin->node_count, sizeof *scratch->nodes);
    scratch->bones = calloc(skin->bone_count, sizeof *scratch->bones);
    scratch->morphs = calloc((size_t)skin->morph_count + 1, sizeof *scratch->morphs);
    if (!scratch->nodes || !scratch->bones || !scratch->morphs) {
        destroy_scratch(scratch);
        return NULL;
    }
    return scratch;
}

/* Names go into messages, so control characters are replaced. */
static void clean_names(struct kiln_skin *skin)
{
    for (uint32_t i = 0; i < skin->clip_count; i++) {
        for (char *c = skin->clips[i].name; *c; c++) {
            if ((unsigned char)*c < ' ' || *c == 127)
                *c = ' ';
        }
    }
}

/* Makes a skin of numbers that were checked. NULL when memory is short. */
static struct kiln_skin *make(const struct kiln_skin_result *r, struct kiln_mesh *mesh)
{
    struct kiln_skin *skin = copy(r, mesh);
    if (!skin)
        return NULL;
    skin->scratch = create_scratch(skin);
    if (!skin->scratch) {
        kiln_skin_destroy(&skin);
        return NULL;
    }
    clean_names(skin);
    normalize(skin);
    turn_mirrored(skin, skin->scratch);
    pose(skin, NULL, 0.0f, skin->scratch, mesh->vertices);
    kiln_mesh_find_bounds(mesh);
    return skin;
}

struct kiln_skin *kiln_skin_take(const char *name, const struct kiln_mesh_result *result,
                                 struct kiln_mesh *mesh, struct kiln_error *error)
{
    if (!kiln_skin_check(name, result, error)) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    struct kiln_skin *skin = make(&result->skin, mesh);
    if (!skin)
        kiln_error_no_memory(error, "reading the mesh of %s", name);
    return skin;
}

void kiln_skin_destroy(struct kiln_skin **skin)
{
    if (!*skin)
        return;
    kiln_mesh_destroy(&(*skin)->mesh);
    free((*skin)->sources);
    free((*skin)->weights);
    free((*skin)->channels);
    free((*skin)->keys);
    free((*skin)->nodes);
    free((*skin)->bones);
    free((*skin)->clips);
    free((*skin)->morphs);
    free((*skin)->morph_channels);
    free((*skin)->deltas);
    destroy_scratch((*skin)->scratch);
    free(*skin);
    *skin = NULL;
}

/* ---- queries --------------------------------------------------------------------------------- */

const struct kiln_mesh *kiln_skin_mesh(const struct kiln_skin *skin)
{
    return skin->mesh;
}

static bool is_number(const char *text)
{
    const char *c = text;
    while (isdigit((unsigned char)*c))
        c++;
    return c > text && *c == '\0' && c - text < 6;
}

bool kiln_skin_find_clip(const struct kiln_skin *skin, const char *clip, const char *name,
                         uint32_t *number, struct kiln_error *error)
{
    char known[256] = "";
    size_t length = 0;
    for (*number = 0; *number < skin->clip_count; ++*number) {
        const char *has = skin->clips[*number].name;
        if (strcmp(has, clip) == 0)
            return true;
        int more =
            snprintf(known + length, sizeof known - length, "%s'%.63s'", length ? ", " : "", has);
        length += more > 0 ? (size_t)more : 0;
        length = length < sizeof known ? length : sizeof known - 1;
    }
    *number = is_number(clip) ? (uint32_t)strtoul(clip, NULL, 10) : skin->clip_count;
    return *number < skin->clip_count ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: no animation is called '%.63s'; the file has %s, by number 0 to %u",
                          name, clip, known, skin->clip_count - 1);
}

uint32_t kiln_skin_bone_count(const struct kiln_skin *skin)
{
    return skin->bone_count;
}

uint32_t kiln_skin_clip_count(const struct kiln_skin *skin)
{
    return skin->clip_count;
}

const char *kiln_skin_clip_name(const struct kiln_skin *skin, uint32_t clip)
{
    return skin->clips[clip].name;
}

float kiln_skin_clip_length(const struct kiln_skin *skin, uint32_t clip)
{
    return skin->clips[clip].length;
}
