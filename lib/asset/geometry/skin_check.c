/* This file checks the animation that kiln-decode sends: counts, ranges, and numbers. kiln-decode
 * reads untrusted files, so skin.c uses nothing that was not checked here. */
#include <math.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "base/error.h"

struct check {
    const char *name;
    const struct kiln_mesh_result *result;
    struct kiln_error *error;
};

static bool is_near(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabsf(values[i]) <= KILN_SKIN_FARTHEST))
            return false;
    }
    return true;
}

static bool is_track(const struct kiln_skin_track *track, uint32_t key_count, uint32_t *keys)
{
    const bool good = track->interpolation <= KILN_SKIN_CUBIC &&
                      track->count <= key_count - *keys &&
                      track->count % kiln_skin_parts(track) == 0 &&
                      (track->count == 0 ? track->first <= *keys : track->first == *keys);
    *keys += good ? track->count : 0;
    return good;
}

static bool is_clip(const struct kiln_skin_result *r, const struct kiln_skin_clip *clip,
                    uint32_t *channels, uint32_t *morphs)
{
    const bool good = clip->first == *channels && clip->count <= r->channel_count - *channels &&
                      clip->first_morph == *morphs &&
                      clip->morph_count <= r->morph_channel_count - *morphs &&
                      clip->length >= 0.0f && clip->length <= KILN_SKIN_FARTHEST &&
                      memchr(clip->name, '\0', KILN_MAX_CLIP_NAME);
    *channels += good ? clip->count : 0;
    *morphs += good ? clip->morph_count : 0;
    return good;
}

/* Checks the ranges of clips, channels and keys. They must follow one another, since overlapping
 * ranges could make work without end. */
static bool are_clips_sound(const struct kiln_skin_result *r, uint32_t node_count,
                            uint32_t morph_count)
{
    uint32_t channels = 0, morphs = 0, keys = 0;
    bool good = true;
    for (uint32_t i = 0; good && i < r->clip_count; i++)
        good = is_clip(r, &r->clips[i], &channels, &morphs);
    for (uint32_t i = 0; good && i < r->channel_count; i++) {
        good = r->channels[i].node < node_count;
        for (int k = 0; good && k < KILN_CHANNEL_TRACKS; k++)
            good = is_track(&r->channels[i].tracks[k], r->key_count, &keys);
    }
    for (uint32_t i = 0; good && i < r->morph_channel_count; i++)
        good = r->morph_channels[i].morph < morph_count &&
               is_track(&r->morph_channels[i].track, r->key_count, &keys);
    return good;
}

static bool are_morphs_sound(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    uint32_t deltas = 0;
    for (uint32_t i = 0; i < r->morph_count; i++) {
        if (r->morphs[i].first != deltas || r->morphs[i].count > r->delta_count - deltas)
            return false;
        deltas += r->morphs[i].count;
    }
    for (uint32_t i = 0; i < r->delta_count; i++) {
        if (r->deltas[i].vertex >= check->result->vertex_count)
            return false;
    }
    return true;
}

static bool refuse_data(const struct check *check)
{
    return kiln_error_set(check->error, KILN_INVALID_INPUT,
                          "%s: the animation is broken: the importer returned inconsistent data",
                          check->name);
}

static bool check_counts(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    bool good = r->node_count >= 1 && r->node_count <= KILN_MAX_SKIN_NODES && r->bone_count >= 1 &&
                r->bone_count <= KILN_MAX_SKIN_BONES && r->clip_count >= 1 &&
                r->clip_count <= KILN_MAX_CLIPS && r->channel_count <= KILN_MAX_CLIP_CHANNELS &&
                r->key_count <= KILN_MAX_CLIP_KEYS && r->morph_count <= KILN_MAX_SKIN_MORPHS &&
                r->morph_channel_count <= KILN_MAX_CLIP_MORPHS &&
                r->delta_count <= KILN_MAX_SKIN_DELTAS;
    for (uint32_t i = 1; good && i < r->node_count; i++)
        good = r->nodes[i].parent < i;
    for (uint32_t i = 0; good && i < r->bone_count; i++)
        good = r->bones[i].node < r->node_count;
    good = good && are_clips_sound(r, r->node_count, r->morph_count) && are_morphs_sound(check);
    return good || refuse_data(check);
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
                                  (double)KILN_SKIN_FARTHEST, (double)KILN_SKIN_FARTHEST);
}

static bool check_times(const struct check *check, const struct kiln_skin_track *track)
{
    const struct kiln_skin_key *keys = check->result->skin.keys + track->first;
    const uint32_t parts = kiln_skin_parts(track);
    for (uint32_t i = 0; i < track->count; i++) {
        const float seconds = keys[i].seconds;
        if (!(seconds >= 0.0f && seconds <= KILN_SKIN_FARTHEST) ||
            (i % parts > 0 && seconds != keys[i - 1].seconds) ||
            (i % parts == 0 && i > 0 && !(seconds > keys[i - 1].seconds)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a key lies at %g s; allowed are times from 0 s to %g s, "
                                  "each later than the time of the key before it",
                                  check->name, (double)seconds, (double)KILN_SKIN_FARTHEST);
    }
    return true;
}

static bool check_track(const struct check *check, const struct kiln_skin_track *track, bool turns)
{
    const struct kiln_skin_key *keys = check->result->skin.keys + track->first;
    const uint32_t parts = kiln_skin_parts(track);
    if (!check_times(check, track))
        return false;
    for (uint32_t i = 0; i < track->count; i++) {
        struct kiln_skin_key key = keys[i];
        const bool is_turn = turns && i % parts == parts / 2; /* and no tangent */
        if (!is_near(key.value, 4) || (is_turn && !(glm_quat_dot(key.value, key.value) > 1e-10f)))
            return kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: the key at %g s has the value %g %g %g %g; allowed are "
                                  "numbers within -%g and %g, and quaternions other than 0 for "
                                  "rotations",
                                  check->name, (double)key.seconds, (double)key.value[0],
                                  (double)key.value[1], (double)key.value[2], (double)key.value[3],
                                  (double)KILN_SKIN_FARTHEST, (double)KILN_SKIN_FARTHEST);
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
    for (uint32_t i = 0; i < r->morph_channel_count; i++) {
        if (!check_track(check, &r->morph_channels[i].track, false))
            return false;
    }
    return true;
}

static bool check_morphs(const struct check *check)
{
    const struct kiln_skin_result *r = &check->result->skin;
    bool good = true;
    for (uint32_t i = 0; i < r->morph_count; i++)
        good &= is_near(&r->morphs[i].rest, 1);
    for (uint32_t i = 0; i < r->delta_count; i++)
        good &= is_near(r->deltas[i].position, 3) && is_near(r->deltas[i].normal, 3);
    return good || kiln_error_set(check->error, KILN_INVALID_INPUT,
                                  "%s: a morph target has numbers beyond -%g and %g", check->name,
                                  (double)KILN_SKIN_FARTHEST, (double)KILN_SKIN_FARTHEST);
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

bool kiln_clips_check(const char *name, const struct kiln_mesh_result *result, uint32_t node_count,
                      struct kiln_error *error)
{
    const struct check check = {name, result, error};
    const struct kiln_skin_result *r = &result->skin;
    const bool good =
        r->clip_count <= KILN_MAX_CLIPS && r->channel_count <= KILN_MAX_CLIP_CHANNELS &&
        r->key_count <= KILN_MAX_CLIP_KEYS && r->morph_channel_count <= KILN_MAX_CLIP_MORPHS &&
        are_clips_sound(r, node_count, 0);
    return good ? check_tracks(&check) : refuse_data(&check);
}

bool kiln_skin_check(const char *name, const struct kiln_mesh_result *result,
                     struct kiln_error *error)
{
    const struct check check = {name, result, error};
    return check_counts(&check) && check_matrices(&check) && check_tracks(&check) &&
           check_weights(&check) && check_morphs(&check);
}
