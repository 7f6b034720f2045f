/* This file poses meshes that move: it finds the pose of the nodes from keys, then matrices, then
 * vertices. It uses + - * / and square roots alone, so that every machine gives the same bits. It
 * also checks the animation that kiln-decode sends. */
#include "asset/geometry/skin.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "base/error.h"

/* limit of coordinates in keys, matrices and vertices, in units of the file */
static const float FARTHEST = 1e6f;

struct kiln_skin {
    struct kiln_mesh *mesh; /* the mesh at rest */
    float (*sources)[6];    /* vertices before nodes and bones are applied; normals of any length */
    struct kiln_skin_weights *weights;
    uint32_t node_count, bone_count, clip_count;
    struct kiln_skin_node nodes[KILN_MAX_SKIN_NODES];
    struct kiln_skin_bone bones[KILN_MAX_SKIN_BONES];
    struct kiln_skin_clip clips[KILN_MAX_CLIPS];
    float lengths[KILN_MAX_CLIPS]; /* lengths of the clips, s */
    struct kiln_skin_channel *channels;
    struct kiln_skin_key *keys;
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

/* Reads a track at a moment; a track without keys does not change the value. */
static void read_track(const struct kiln_skin *skin, const struct kiln_skin_track *track,
                       bool turns, float seconds, vec4 out)
{
    if (track->count == 0)
        return;
    struct kiln_skin_key *keys = skin->keys + track->first;
    /* the last key at or before the moment is in low .. high - 1 */
    uint32_t low = 0, high = track->count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        *(keys[middle].seconds <= seconds ? &low : &high) = middle;
    }
    struct kiln_skin_key *a = &keys[low], *b = &keys[low + 1 < track->count ? low + 1 : low];
    float t =
        seconds > a->seconds && b > a ? (seconds - a->seconds) / (b->seconds - a->seconds) : 0.0f;
    if (turns && t > 0.0f) {
        turn_between(a->value, b->value, t, out);
        return;
    }
    glm_vec4_lerp(a->value, b->value, t, out);
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
                        float seconds, mat4 *bones)
{
    mat4 local[KILN_MAX_SKIN_NODES], nodes[KILN_MAX_SKIN_NODES];
    memcpy(local[0], skin->nodes[0].rest, sizeof local[0]); /* node 0 always exists */
    for (uint32_t i = 1; i < skin->node_count; i++)
        memcpy(local[i], skin->nodes[i].rest, sizeof local[i]);
    for (uint32_t i = 0; clip && i < clip->count; i++) {
        const struct kiln_skin_channel *channel = &skin->channels[clip->first + i];
        versor turn = GLM_QUAT_IDENTITY_INIT;
        vec4 move = GLM_VEC4_ZERO_INIT, scale = GLM_VEC4_ONE_INIT;
        read_track(skin, &channel->tracks[KILN_CHANNEL_MOVE], false, seconds, move);
        read_track(skin, &channel->tracks[KILN_CHANNEL_TURN], true, seconds, turn);
        read_track(skin, &channel->tracks[KILN_CHANNEL_SCALE], false, seconds, scale);
        compose(move, turn, scale, local[channel->node]);
    }
    glm_mat4_copy(local[0], nodes[0]);
    for (uint32_t i = 1; i < skin->node_count; i++)
        glm_mul(nodes[skin->nodes[i].parent], local[i], nodes[i]);
    for (uint32_t i = 0; i < skin->bone_count; i++) {
        struct kiln_skin_bone bone = skin->bones[i];
        glm_mul(nodes[bone.node], bone.offset, bones[i]);
    }
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* Bounds a coordinate that only a faulty file makes too large. */
static float bounded(float x)
{
    return x >= -FARTHEST ? (x <= FARTHEST ? x : FARTHEST) : -FARTHEST;
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
static void turn_mirrored(struct kiln_skin *skin)
{
    mat4 bones[KILN_MAX_SKIN_BONES], m;
    place_bones(skin, NULL, 0.0f, bones);
    for (uint32_t i = 0; i < skin->mesh->triangle_count; i++) {
        uint32_t *corners = skin->mesh->triangles[i];
        const uint32_t second = corners[1];
        blend(&skin->weights[corners[0]], bones, m);
        if (mirrors(m)) {
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
}

static void pose(const struct kiln_skin *skin, const struct kiln_skin_clip *clip, float seconds,
                 float (*vertices)[6])
{
    mat4 bones[KILN_MAX_SKIN_BONES], m;
    place_bones(skin, clip, seconds, bones);
    for (uint32_t i = 0; i < skin->mesh->vertex_count; i++) {
        float *v = skin->sources[i];
        blend(&skin->weights[i], bones, m);
        glm_mat4_mulv3(m, v, 1.0f, vertices[i]);
        for (int c = 0; c < 3; c++)
            vertices[i][c] = bounded(vertices[i][c]);
        turn_normal(m, v + 3, vertices[i] + 3);
    }
}

void kiln_skin_pose(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    float (*vertices)[6])
{
    pose(skin, &skin->clips[clip], seconds, vertices);
}

void kiln_skin_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                         struct kiln_mesh *mesh)
{
    kiln_skin_pose(skin, clip, seconds, mesh->vertices);
    kiln_mesh_find_bounds(mesh);
}

/* ---- checking what kiln-decode sent ---------------------------------------------------------- */

struct check {
    const char *name;
    const struct kiln_mesh_result *result;
    struct kiln_error *error;
};

static bool is_near(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabsf(values[i]) <= FARTHEST))
            return false;
    }
    return true;
}

static bool check_counts(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    bool good = r->node_count >= 1 && r->node_count <= KILN_MAX_SKIN_NODES && r->bone_count >= 1 &&
                r->bone_count <= KILN_MAX_SKIN_BONES && r->clip_count >= 1 &&
                r->clip_count <= KILN_MAX_CLIPS && r->channel_count <= KILN_MAX_CLIP_CHANNELS &&
                r->key_count <= KILN_MAX_CLIP_KEYS;
    for (uint32_t i = 1; good && i < r->node_count; i++)
        good = r->nodes[i].parent < i;
    for (uint32_t i = 0; good && i < r->bone_count; i++)
        good = r->bones[i].node < r->node_count;
    /* Ranges must follow one another, since overlapping ranges could make work without end. */
    uint32_t channels = 0, keys = 0;
    for (uint32_t i = 0; good && i < r->clip_count; i++) {
        good = r->clips[i].first == channels && r->clips[i].count <= r->channel_count - channels &&
               memchr(r->clips[i].name, '\0', KILN_MAX_CLIP_NAME);
        channels += r->clips[i].count;
    }
    for (uint32_t i = 0; good && i < r->channel_count; i++) {
        good = r->channels[i].node < r->node_count;
        for (int k = 0; good && k < KILN_CHANNEL_TRACKS; k++) {
            const struct kiln_skin_track *track = &r->channels[i].tracks[k];
            good = track->count <= r->key_count - keys &&
                   (track->count == 0 ? track->first <= keys : track->first == keys);
            keys += track->count;
        }
    }
    return good ||
           kiln_error_set(check->error, KILN_INVALID_INPUT,
                          "%s: the animation is broken: the importer returned inconsistent data",
                          check->name);
}

static bool check_matrices(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    bool good = true;
    for (uint32_t i = 0; i < r->node_count; i++)
        good &= is_near(&r->nodes[i].rest[0][0], 16);
    for (uint32_t i = 0; i < r->bone_count; i++)
        good &= is_near(&r->bones[i].offset[0][0], 16);
    return good || kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a matrix has numbers beyond -%g and %g", check->name,
                                  (double)FARTHEST, (double)FARTHEST);
}

static bool check_track(const struct check *check, const struct kiln_skin_track *track, bool turns)
{
    const struct kiln_skin_key *keys = check->result->skin.keys + track->first;
    for (uint32_t i = 0; i < track->count; i++) {
        struct kiln_skin_key key = keys[i];
        const float seconds = key.seconds;
        if (!(seconds >= 0.0f && seconds <= FARTHEST) ||
            (i > 0 && !(seconds > keys[i - 1].seconds)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a key lies at %g s; allowed are times from 0 s to %g s, "
                                  "each later than the time of the key before it",
                                  check->name, (double)seconds, (double)FARTHEST);
        const float square = glm_quat_dot(key.value, key.value);
        if (!is_near(key.value, 4) || (turns && !(square > 0.25f && square < 4.0f)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: the key at %g s has the value %g %g %g %g; allowed are "
                                  "numbers within -%g and %g, and unit quaternions for rotations",
                                  check->name, (double)seconds, (double)key.value[0],
                                  (double)key.value[1], (double)key.value[2], (double)key.value[3],
                                  (double)FARTHEST, (double)FARTHEST);
    }
    return true;
}

static bool check_tracks(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    for (uint32_t i = 0; i < r->channel_count; i++) {
        for (int k = 0; k < KILN_CHANNEL_TRACKS; k++) {
            if (!check_track(check, &r->channels[i].tracks[k], k == KILN_CHANNEL_TURN))
                return false;
        }
    }
    return true;
}

static bool check_weights(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    for (uint32_t i = 0; i < check->result->vertex_count; i++) {
        float sum = 0.0f;
        bool good = true;
        for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
            good &= r->weights[i].weights[k] >= 0.0f && r->weights[i].bones[k] < r->bone_count;
            sum += r->weights[i].weights[k];
        }
        if (!good || !(fabsf(sum - 1.0f) <= 0.01f))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: the weights of vertex %u sum to %g; allowed are numbers of "
                                  "at least 0 that sum to 1, as floats",
                                  check->name, i, (double)sum);
    }
    return true;
}

/* ---- making a skin --------------------------------------------------------------------------- */

/* Adds normals where a file has none, as sums of the triangles' area vectors. */
static void add_normals(struct kiln_skin *skin)
{
    const struct kiln_mesh *mesh = skin->mesh;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        memset(skin->sources[i] + 3, 0, 3 * sizeof(float));
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corners = mesh->triangles[i];
        const float *a = skin->sources[corners[0]], *b = skin->sources[corners[1]];
        const float *c = skin->sources[corners[2]];
        for (int n = 0; n < 3; n++) {
            const int p = (n + 1) % 3, q = (n + 2) % 3;
            const float area = (b[p] - a[p]) * (c[q] - a[q]) - (b[q] - a[q]) * (c[p] - a[p]);
            for (int k = 0; k < 3; k++)
                skin->sources[corners[k]][3 + n] += area;
        }
    }
    /* The sums are scaled to length 1, since squares of small areas would underflow. */
    mat4 same = GLM_MAT4_IDENTITY_INIT;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        turn_normal(same, skin->sources[i] + 3, skin->sources[i] + 3);
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
    for (uint32_t i = 0; i < skin->clip_count; i++) {
        const struct kiln_skin_clip *clip = &skin->clips[i];
        for (uint32_t c = 0; c < clip->count * KILN_CHANNEL_TRACKS; c++) {
            const uint32_t kind = c % KILN_CHANNEL_TRACKS;
            const struct kiln_skin_track *track =
                &skin->channels[clip->first + c / KILN_CHANNEL_TRACKS].tracks[kind];
            for (uint32_t k = track->first; k < track->first + track->count; k++) {
                struct kiln_skin_key *key = &skin->keys[k];
                if (kind == KILN_CHANNEL_TURN)
                    glm_quat_normalize(key->value);
                skin->lengths[i] = fmaxf(skin->lengths[i], key->seconds);
            }
        }
    }
}

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = calloc(count ? count : 1, size);
    return copy ? memcpy(copy, from, count * size) : NULL;
}

static struct kiln_skin *copy(const struct kiln_skin_result *r, struct kiln_mesh *mesh)
{
    struct kiln_skin *skin = calloc(1, sizeof *skin);
    if (!skin) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    skin->mesh = mesh;
    skin->sources = copy_of(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    skin->weights = copy_of(r->weights, mesh->vertex_count, sizeof *r->weights);
    skin->channels = copy_of(r->channels, r->channel_count, sizeof *r->channels);
    skin->keys = copy_of(r->keys, r->key_count, sizeof *r->keys);
    skin->node_count = r->node_count;
    skin->bone_count = r->bone_count;
    skin->clip_count = r->clip_count;
    memcpy(skin->nodes, r->nodes, sizeof skin->nodes);
    memcpy(skin->bones, r->bones, sizeof skin->bones);
    memcpy(skin->clips, r->clips, sizeof skin->clips);
    for (uint32_t i = 0; i < skin->clip_count; i++) {
        /* names go into messages, so control characters are replaced */
        for (char *c = skin->clips[i].name; *c; c++) {
            if ((unsigned char)*c < ' ' || *c == 127)
                *c = ' ';
        }
    }
    if (!skin->sources || !skin->weights || !skin->channels || !skin->keys) {
        kiln_skin_destroy(&skin);
        return NULL;
    }
    if (!r->has_normals)
        add_normals(skin);
    normalize(skin);
    turn_mirrored(skin);
    pose(skin, NULL, 0.0f, mesh->vertices);
    kiln_mesh_find_bounds(mesh);
    return skin;
}

struct kiln_skin *kiln_skin_take(const char *name, const struct kiln_mesh_result *result,
                                 struct kiln_mesh *mesh, struct kiln_error *error)
{
    const struct check check = {name, result, error};
    if (!check_counts(&check) || !check_matrices(&check) || !check_tracks(&check) ||
        !check_weights(&check)) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    struct kiln_skin *skin = copy(&result->skin, mesh);
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
    return skin->lengths[clip];
}
