/* The pose of nodes from keys, then matrices, then vertices: + - * / and square roots alone. */
#include "asset/geometry/skin.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_import.h"
#include "base/error.h"

static const float FARTHEST = 1e6f; /* units of the file: keys, matrices, vertices */

struct kiln_skin {
    struct kiln_mesh *mesh; /* at rest */
    float (*sources)[6];    /* its vertices before nodes and bones, and normals of any length */
    struct kiln_skin_weights *weights;
    uint32_t node_count, bone_count, clip_count;
    struct kiln_skin_node nodes[KILN_MAX_SKIN_NODES];
    struct kiln_skin_bone bones[KILN_MAX_SKIN_BONES];
    struct kiln_skin_clip clips[KILN_MAX_CLIPS];
    float lengths[KILN_MAX_CLIPS]; /* s */
    struct kiln_skin_channel *channels;
    struct kiln_skin_key *keys;
};

/* ---- between keys ---------------------------------------------------------------------------- */

static float dot4(const float a[4], const float b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* sin(t angle) / sin(angle) by the cosine of an angle of at most a quarter turn, as a series in
 * (cosine - 1) whose coefficients are polynomials of t (Eberly 2011, A Fast and Accurate Algorithm
 * for Computing SLERP). A term is at most half of the one before. */
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

/* Along the shorter way, at constant speed. */
static void turn_between(const float a[4], const float b[4], float t, float out[4])
{
    const float cosine = dot4(a, b), sign = cosine < 0.0f ? -1.0f : 1.0f;
    const float from = part_of_turn(1.0f - t, sign * cosine);
    const float to = sign * part_of_turn(t, sign * cosine);
    for (int c = 0; c < 4; c++)
        out[c] = from * a[c] + to * b[c];
    const float length = sqrtf(dot4(out, out)); /* 1 but for rounding */
    for (int c = 0; c < 4; c++)
        out[c] /= length;
}

/* At a moment; what is there without keys stays. */
static void read_track(const struct kiln_skin *skin, const struct kiln_skin_track *track,
                       bool turns, float seconds, float out[4])
{
    if (track->count == 0)
        return;
    const struct kiln_skin_key *keys = skin->keys + track->first;
    uint32_t low = 0, high = track->count; /* the last key at or before the moment is in there */
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        *(keys[middle].seconds <= seconds ? &low : &high) = middle;
    }
    const struct kiln_skin_key *a = &keys[low], *b = &keys[low + 1 < track->count ? low + 1 : low];
    float t =
        seconds > a->seconds && b > a ? (seconds - a->seconds) / (b->seconds - a->seconds) : 0.0f;
    if (turns && t > 0.0f) {
        turn_between(a->value, b->value, t, out);
        return;
    }
    for (int c = 0; c < 4; c++)
        out[c] = a->value[c] + (b->value[c] - a->value[c]) * t;
}

/* ---- matrices -------------------------------------------------------------------------------- */

/* Turned, after being scaled, and then moved. */
static void compose(const float move[4], const float turn[4], const float scale[4], kiln_affine out)
{
    const float x = turn[0], y = turn[1], z = turn[2], w = turn[3];
    const float rows[3][3] = {
        {1.0f - 2.0f * (y * y + z * z), 2.0f * (x * y - z * w), 2.0f * (x * z + y * w)},
        {2.0f * (x * y + z * w), 1.0f - 2.0f * (x * x + z * z), 2.0f * (y * z - x * w)},
        {2.0f * (x * z - y * w), 2.0f * (y * z + x * w), 1.0f - 2.0f * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++)
            out[i][c] = rows[i][c] * scale[c];
        out[i][3] = move[i];
    }
}

/* The second first; out may be neither. */
static void multiply(const kiln_affine a, const kiln_affine b, kiln_affine out)
{
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 4; c++)
            out[i][c] = a[i][0] * b[0][c] + a[i][1] * b[1][c] + a[i][2] * b[2][c] +
                        (c == 3 ? a[i][3] : 0.0f);
    }
}

/* From vertices to the file's space, for each bone. A clip moves its nodes, if there is one. */
static void place_bones(const struct kiln_skin *skin, const struct kiln_skin_clip *clip,
                        float seconds, kiln_affine *bones)
{
    kiln_affine local[KILN_MAX_SKIN_NODES], nodes[KILN_MAX_SKIN_NODES];
    memcpy(local[0], skin->nodes[0].rest, sizeof local[0]); /* there is one */
    for (uint32_t i = 1; i < skin->node_count; i++)
        memcpy(local[i], skin->nodes[i].rest, sizeof local[i]);
    for (uint32_t i = 0; clip && i < clip->count; i++) {
        const struct kiln_skin_channel *channel = &skin->channels[clip->first + i];
        float move[4] = {0}, turn[4] = {0.0f, 0.0f, 0.0f, 1.0f}, scale[4] = {1.0f, 1.0f, 1.0f};
        read_track(skin, &channel->tracks[KILN_CHANNEL_MOVE], false, seconds, move);
        read_track(skin, &channel->tracks[KILN_CHANNEL_TURN], true, seconds, turn);
        read_track(skin, &channel->tracks[KILN_CHANNEL_SCALE], false, seconds, scale);
        compose(move, turn, scale, local[channel->node]);
    }
    memcpy(nodes[0], local[0], sizeof nodes[0]);
    for (uint32_t i = 1; i < skin->node_count; i++)
        multiply(nodes[skin->nodes[i].parent], local[i], nodes[i]);
    for (uint32_t i = 0; i < skin->bone_count; i++)
        multiply(nodes[skin->bones[i].node], skin->bones[i].offset, bones[i]);
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* What no sound file leads to, but some may. */
static float bounded(float x)
{
    return x >= -FARTHEST ? (x <= FARTHEST ? x : FARTHEST) : -FARTHEST;
}

/* Does it turn left into right? */
static bool mirrors(const kiln_affine m)
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
               m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
           0.0f;
}

/* A normal goes by the cofactors, which keep it across the surface however that is stretched, and
 * on its side unless it is mirrored. */
static void turn_normal(const kiln_affine m, const float normal[3], float out[3])
{
    float n[3], square = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float *p = m[(i + 1) % 3], *q = m[(i + 2) % 3];
        n[i] = (p[1] * q[2] - p[2] * q[1]) * normal[0] + (p[2] * q[0] - p[0] * q[2]) * normal[1] +
               (p[0] * q[1] - p[1] * q[0]) * normal[2];
        square += n[i] * n[i];
    }
    const bool flat = !(square > 1e-30f && square < 1e30f);
    const float length = mirrors(m) ? -sqrtf(square) : sqrtf(square);
    for (int i = 0; i < 3; i++)
        out[i] = flat ? (i == 1 ? 1.0f : 0.0f) : n[i] / length;
}

static void blend(const struct kiln_skin_weights *weights, const kiln_affine *bones,
                  kiln_affine out)
{
    memset(out, 0, sizeof(kiln_affine));
    for (int k = 0; k < KILN_SKIN_INFLUENCES; k++) {
        const float weight = weights->weights[k], *from = &bones[weights->bones[k]][0][0];
        for (int c = 0; weight > 0.0f && c < 12; c++)
            out[c / 4][c % 4] += weight * from[c];
    }
}

/* What is mirrored at rest would show its inside: its triangles go around the other way. */
static void turn_mirrored(struct kiln_skin *skin)
{
    kiln_affine bones[KILN_MAX_SKIN_BONES], m;
    place_bones(skin, NULL, 0.0f, bones);
    for (uint32_t i = 0; i < skin->mesh->triangle_count; i++) {
        uint32_t *corners = skin->mesh->triangles[i];
        const uint32_t second = corners[1];
        blend(&skin->weights[corners[0]], (const kiln_affine *)bones, m);
        if (mirrors((const float(*)[4])m)) {
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
}

static void pose(const struct kiln_skin *skin, const struct kiln_skin_clip *clip, float seconds,
                 float (*vertices)[6])
{
    kiln_affine bones[KILN_MAX_SKIN_BONES], m;
    place_bones(skin, clip, seconds, bones);
    for (uint32_t i = 0; i < skin->mesh->vertex_count; i++) {
        const float *v = skin->sources[i];
        blend(&skin->weights[i], (const kiln_affine *)bones, m);
        for (int c = 0; c < 3; c++)
            vertices[i][c] = bounded(m[c][0] * v[0] + m[c][1] * v[1] + m[c][2] * v[2] + m[c][3]);
        turn_normal((const float(*)[4])m, v + 3, vertices[i] + 3);
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
    kiln_mesh_bound(mesh);
}

/* ---- what came ------------------------------------------------------------------------------- */

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
    for (uint32_t i = 0; good && i < r->clip_count; i++)
        good = r->clips[i].first <= r->channel_count &&
               r->clips[i].count <= r->channel_count - r->clips[i].first &&
               memchr(r->clips[i].name, '\0', KILN_MAX_CLIP_NAME);
    for (uint32_t i = 0; good && i < r->channel_count; i++) {
        good = r->channels[i].node < r->node_count;
        for (int k = 0; good && k < KILN_CHANNEL_TRACKS; k++) {
            const struct kiln_skin_track *track = &r->channels[i].tracks[k];
            good = track->first <= r->key_count && track->count <= r->key_count - track->first;
        }
    }
    return good || kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: the animation is broken: the importer made nonsense of it",
                                  check->name);
}

static bool check_matrices(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    bool good = true;
    for (uint32_t i = 0; i < r->node_count; i++)
        good &= is_near(&r->nodes[i].rest[0][0], 12);
    for (uint32_t i = 0; i < r->bone_count; i++)
        good &= is_near(&r->bones[i].offset[0][0], 12);
    return good || kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a matrix has numbers beyond -%g and %g", check->name,
                                  (double)FARTHEST, (double)FARTHEST);
}

static bool check_track(const struct check *check, const struct kiln_skin_track *track, bool turns)
{
    const struct kiln_skin_key *keys = check->result->skin.keys + track->first;
    for (uint32_t i = 0; i < track->count; i++) {
        const float seconds = keys[i].seconds;
        if (!(seconds >= 0.0f && seconds <= FARTHEST) ||
            (i > 0 && !(seconds > keys[i - 1].seconds)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a key lies at %g s; allowed are times from 0 s to %g s, "
                                  "each later than the one before",
                                  check->name, (double)seconds, (double)FARTHEST);
        const float square = dot4(keys[i].value, keys[i].value);
        if (!is_near(keys[i].value, 4) || (turns && !(square > 0.25f && square < 4.0f)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: the key at %g s has the value %g %g %g %g; allowed are "
                                  "numbers within -%g and %g, of turns unit quaternions",
                                  check->name, (double)seconds, (double)keys[i].value[0],
                                  (double)keys[i].value[1], (double)keys[i].value[2],
                                  (double)keys[i].value[3], (double)FARTHEST, (double)FARTHEST);
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

/* ---- making ---------------------------------------------------------------------------------- */

/* Sums of the triangles' areas, where a file has no normals. */
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
    /* Of length 1, since the square of a small area would be nothing. */
    static const kiln_affine same = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float normal[3];
        turn_normal(same, skin->sources[i] + 3, normal);
        memcpy(skin->sources[i] + 3, normal, sizeof normal);
    }
}

/* So that they sum to 1 and quaternions have that length, as exactly as floats can. */
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
                const float length = sqrtf(dot4(key->value, key->value));
                for (int v = 0; kind == KILN_CHANNEL_TURN && v < 4; v++)
                    key->value[v] /= length;
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
        for (char *c = skin->clips[i].name; *c; c++) { /* they come into messages */
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
    kiln_mesh_bound(mesh);
    return skin;
}

struct kiln_skin *kiln_skin_take(const struct kiln_mesh_request *request,
                                 const struct kiln_mesh_result *result, struct kiln_mesh *mesh,
                                 struct kiln_error *error)
{
    const struct check check = {request->name, result, error};
    if (!check_counts(&check) || !check_matrices(&check) || !check_tracks(&check) ||
        !check_weights(&check)) {
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    struct kiln_skin *skin = copy(&result->skin, mesh);
    if (!skin)
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory while reading the mesh",
                       request->name);
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

/* ---- asking ---------------------------------------------------------------------------------- */

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
                          "%s: no animation is called '%.63s'; there are %s, by number 0 to %u",
                          name, clip, known, skin->clip_count - 1);
}

float kiln_skin_clip_length(const struct kiln_skin *skin, uint32_t clip)
{
    return skin->lengths[clip];
}
