/* This file fills in the clips of a glTF mesh that moves: key frames of the nodes' transforms and
 * of the weights of morph targets. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

/* ---- channels -------------------------------------------------------------------------------- */

/* Returns the node that a channel moves; GLTF_NONE: it moves something else. */
static uint32_t node_of(const struct gltf *g, const json_t *channel)
{
    const json_t *target = gltf_member(channel, "target");
    uint32_t node = 0;
    return gltf_index(gltf_member(target, "node"), &node) && node < g->lists[GLTF_NODES].count
               ? node
               : GLTF_NONE;
}

static bool has_path(const json_t *channel, const char *path)
{
    const json_t *target = gltf_member(channel, "target");
    return gltf_is(gltf_member(target, "path"), path);
}

bool gltf_morphs_move(const struct gltf *g, uint32_t node)
{
    for (uint32_t i = 0; i < g->lists[GLTF_ANIMATIONS].count; i++) {
        const json_t *list = gltf_member(gltf_element(g, GLTF_ANIMATIONS, i), "channels");
        size_t c_at = 0;
        for (const json_t *c; (c = gltf_item(list, c_at)); c_at++) {
            if (node_of(g, c) == node && has_path(c, "weights"))
                return true;
        }
    }
    return false;
}

/* ---- samplers -------------------------------------------------------------------------------- */

struct sampler {
    float *times, *values;
    uint32_t count;
    enum kiln_skin_interpolation interpolation;
    uint32_t output; /* the accessor of the values */
};

struct clips {
    struct gltf *g;
    const struct gltf_moved *moved;
    struct kiln_skin_result *skin;
    /* the channel, from 1, that each node of the result has in the clip at hand */
    uint32_t *channels;
    uint32_t *morph_channels; /* of the morphs, in the same way */
    size_t node_count;        /* the most nodes of the result */
    const json_t *samplers;   /* of the clip at hand */
};

static bool get_interpolation(struct gltf *g, const json_t *json, struct sampler *sampler)
{
    const json_t *said = gltf_member(json, "interpolation");
    char text[40];
    sampler->interpolation = KILN_SKIN_LINEAR;
    if (!said || gltf_is(said, "LINEAR"))
        return true;
    sampler->interpolation = KILN_SKIN_STEP;
    if (gltf_is(said, "STEP"))
        return true;
    sampler->interpolation = KILN_SKIN_CUBIC;
    gltf_text(said, text, sizeof text);
    return gltf_is(said, "CUBICSPLINE") ||
           GLTF_SET(g,
                    "a sampler's interpolation is '%s'; allowed are LINEAR, STEP and "
                    "CUBICSPLINE",
                    text);
}

/* Reads the times of a channel's sampler, and how to interpolate. The caller frees the arrays, also
 * after a failure. */
static bool read_sampler(struct clips *c, const json_t *channel, struct sampler *sampler)
{
    struct gltf *g = c->g;
    uint32_t number = 0, input = 0;
    *sampler = (struct sampler){.count = 0};
    const json_t *json = gltf_index(gltf_member(channel, "sampler"), &number)
                             ? gltf_item(c->samplers, number)
                             : NULL;
    if (!json)
        return GLTF_SET(g, "a channel of an animation has no sampler");
    if (!gltf_reference(g, json, "input", GLTF_ACCESSORS, &input) ||
        !gltf_reference(g, json, "output", GLTF_ACCESSORS, &sampler->output) ||
        !get_interpolation(g, json, sampler))
        return false;
    if (input == GLTF_NONE || sampler->output == GLTF_NONE)
        return GLTF_SET(g, "a sampler of an animation has no input or no output");
    if (!gltf_count(g, input, KILN_MAX_CLIP_KEYS, "keys", &sampler->count))
        return false;
    sampler->times = gltf_read(g, input, "SCALAR", (struct gltf_range){0, sampler->count});
    return sampler->times != NULL;
}

/* Reads the values of a sampler, `of_one` elements for each key, or three times as many. */
static bool read_values(struct clips *c, struct sampler *sampler, const char *type, uint32_t of_one)
{
    const uint64_t parts = sampler->interpolation == KILN_SKIN_CUBIC ? 3 : 1;
    const uint64_t count = (uint64_t)sampler->count * of_one * parts;
    if (count > 3ull * KILN_MAX_CLIP_KEYS)
        return GLTF_SET(c->g, "more than %d keys; no more are allowed", KILN_MAX_CLIP_KEYS);
    sampler->values =
        gltf_read(c->g, sampler->output, type, (struct gltf_range){0, (uint32_t)count});
    return sampler->values != NULL;
}

/* ---- tracks ---------------------------------------------------------------------------------- */

/* Adds the keys of a track. of_one, offset: which of the elements of a key are taken. Keys between
 * which cubic splines run are three: the tangent before, the value, and the tangent after. */
static bool put_track(struct clips *c, const struct sampler *sampler, uint32_t components,
                      uint32_t of_one, uint32_t offset, struct kiln_skin_track *track)
{
    struct kiln_skin_result *skin = c->skin;
    const uint32_t parts = sampler->interpolation == KILN_SKIN_CUBIC ? 3 : 1;
    if ((uint64_t)sampler->count * parts > KILN_MAX_CLIP_KEYS - skin->key_count)
        return GLTF_SET(c->g, "more than %d keys; no more are allowed", KILN_MAX_CLIP_KEYS);
    *track = (struct kiln_skin_track){skin->key_count, sampler->count * parts,
                                      (uint32_t)sampler->interpolation};
    for (uint32_t i = 0; i < track->count; i++) {
        struct kiln_skin_key *key = &skin->keys[skin->key_count++];
        const float *from = sampler->values + ((size_t)i * of_one + offset) * components;
        *key = (struct kiln_skin_key){.seconds = sampler->times[i / parts]};
        memcpy(key->value, from, components * sizeof *from);
    }
    return true;
}

/* Adds the value at rest of what the clip does not move of a node that it moves. */
static bool put_rest(struct clips *c, const double *value, uint32_t components, double plain,
                     struct kiln_skin_track *track)
{
    struct kiln_skin_result *skin = c->skin;
    bool is_plain = true;
    for (uint32_t i = 0; i < components; i++)
        is_plain = is_plain && value[i] == (components == 4 ? (i == 3) : plain);
    if (is_plain || track->count > 0)
        return true;
    if (skin->key_count == KILN_MAX_CLIP_KEYS)
        return GLTF_SET(c->g, "more than %d keys; no more are allowed", KILN_MAX_CLIP_KEYS);
    *track = (struct kiln_skin_track){skin->key_count, 1, KILN_SKIN_LINEAR};
    struct kiln_skin_key *key = &skin->keys[skin->key_count++];
    *key = (struct kiln_skin_key){.seconds = 0.0f};
    for (uint32_t i = 0; i < components; i++)
        key->value[i] = (float)value[i];
    return true;
}

static struct kiln_skin_channel *find_channel(struct clips *c, struct kiln_skin_clip *clip,
                                              uint32_t node)
{
    struct kiln_skin_result *skin = c->skin;
    if (c->channels[node] == 0) {
        if (skin->channel_count == KILN_MAX_CLIP_CHANNELS) {
            GLTF_SET(c->g, "animations move more than %d nodes; no more are allowed",
                     KILN_MAX_CLIP_CHANNELS);
            return NULL;
        }
        skin->channels[skin->channel_count++] = (struct kiln_skin_channel){.node = node};
        clip->count++;
        c->channels[node] = skin->channel_count;
    }
    return &skin->channels[c->channels[node] - 1];
}

/* The tracks of nodes, by the names of glTF. */
static const struct {
    const char *path, *type;
    uint32_t components;
} paths[KILN_CHANNEL_TRACKS] = {[KILN_CHANNEL_MOVE] = {"translation", "VEC3", 3},
                                [KILN_CHANNEL_TURN] = {"rotation", "VEC4", 4},
                                [KILN_CHANNEL_SCALE] = {"scale", "VEC3", 3}};

static bool put_node_channel(struct clips *c, struct kiln_skin_clip *clip, const json_t *json,
                             uint32_t node, struct sampler *sampler)
{
    int kind = 0;
    while (kind < KILN_CHANNEL_TRACKS && !has_path(json, paths[kind].path))
        kind++;
    if (kind == KILN_CHANNEL_TRACKS || node == GLTF_NONE)
        return true;
    struct kiln_skin_channel *channel = find_channel(c, clip, node);
    if (!channel)
        return false;
    if (channel->tracks[kind].count > 0)
        return GLTF_SET(c->g, "two channels of an animation move the %s of a node",
                        paths[kind].path);
    return read_values(c, sampler, paths[kind].type, 1) &&
           put_track(c, sampler, paths[kind].components, 1, 0, &channel->tracks[kind]);
}

static bool put_weights(struct clips *c, struct kiln_skin_clip *clip,
                        const struct gltf_moved *moved, struct sampler *sampler)
{
    struct kiln_skin_result *skin = c->skin;
    const uint32_t all = moved->target_count * moved->part_count;
    if (all == 0)
        return true;
    if (!read_values(c, sampler, "SCALAR", moved->target_count))
        return false;
    for (uint32_t i = 0; i < all; i++) {
        const uint32_t morph = moved->first_morph + i;
        if (c->morph_channels[morph] > 0)
            return GLTF_SET(c->g, "two channels of an animation move the weights of a node");
        if (skin->morph_channel_count == KILN_MAX_CLIP_MORPHS)
            return GLTF_SET(c->g, "animations move more than %d morph targets; no more are allowed",
                            KILN_MAX_CLIP_MORPHS);
        struct kiln_skin_morph_channel *channel =
            &skin->morph_channels[skin->morph_channel_count++];
        *channel = (struct kiln_skin_morph_channel){.morph = morph};
        c->morph_channels[morph] = 1;
        clip->morph_count++;
        if (!put_track(c, sampler, 1, moved->target_count, i % moved->target_count,
                       &channel->track))
            return false;
    }
    return true;
}

/* ---- clips ----------------------------------------------------------------------------------- */

static bool put_channel(struct clips *c, struct kiln_skin_clip *clip, const json_t *json)
{
    const uint32_t node = node_of(c->g, json);
    struct sampler sampler;
    if (node == GLTF_NONE)
        return true;
    const struct gltf_moved *moved = &c->moved[node];
    bool ok = read_sampler(c, json, &sampler);
    if (ok && sampler.count > 0 && sampler.times[sampler.count - 1] > clip->length)
        clip->length = sampler.times[sampler.count - 1];
    if (ok)
        ok = has_path(json, "weights") ? put_weights(c, clip, moved, &sampler)
                                       : put_node_channel(c, clip, json, moved->node, &sampler);
    free(sampler.times);
    free(sampler.values);
    return ok;
}

/* Adds what the channels of a clip leave at rest. */
static bool fill_channels(struct clips *c, const struct kiln_skin_clip *clip,
                          const uint32_t *numbers)
{
    for (uint32_t i = 0; i < clip->count; i++) {
        struct kiln_skin_channel *channel = &c->skin->channels[clip->first + i];
        const struct gltf_pose *pose = &c->g->nodes[numbers[channel->node]].pose;
        if (!put_rest(c, pose->move, 3, 0.0, &channel->tracks[KILN_CHANNEL_MOVE]) ||
            !put_rest(c, pose->turn, 4, 0.0, &channel->tracks[KILN_CHANNEL_TURN]) ||
            !put_rest(c, pose->scale, 3, 1.0, &channel->tracks[KILN_CHANNEL_SCALE]))
            return false;
    }
    return true;
}

static bool put_clip(struct clips *c, const json_t *animation, const uint32_t *numbers)
{
    struct kiln_skin_result *skin = c->skin;
    struct gltf *g = c->g;
    if (skin->clip_count == KILN_MAX_CLIPS)
        return GLTF_SET(g, "more than %d animations; no more are allowed", KILN_MAX_CLIPS);
    struct kiln_skin_clip *clip = &skin->clips[skin->clip_count++];
    *clip = (struct kiln_skin_clip){.first = skin->channel_count,
                                    .first_morph = skin->morph_channel_count};
    if (gltf_text(gltf_member(animation, "name"), clip->name, sizeof clip->name) >=
        sizeof clip->name)
        return GLTF_SET(g, "the name of an animation is longer than %d bytes",
                        KILN_MAX_CLIP_NAME - 1);
    memset(c->channels, 0, c->node_count * sizeof *c->channels);
    memset(c->morph_channels, 0, KILN_MAX_SKIN_MORPHS * sizeof *c->morph_channels);
    c->samplers = gltf_member(animation, "samplers");
    bool ok = true;
    const json_t *list = gltf_member(animation, "channels");
    size_t i_at = 0;
    for (const json_t *i; ok && (i = gltf_item(list, i_at)); i_at++)
        ok = put_channel(c, clip, i);
    return ok && (g->wanted->rig || fill_channels(c, clip, numbers));
}

/* Keys must follow one another in the order of the channels, and a node's channels may come in any
 * order, so that all keys are copied once. */
static bool order_keys(struct clips *c)
{
    struct kiln_skin_result *skin = c->skin;
    struct kiln_skin_key *keys = malloc(((size_t)skin->key_count + 1) * sizeof *keys);
    uint32_t count = 0;
    if (!keys)
        return decode_out_of_memory(c->g->error);
    for (uint32_t i = 0; i < skin->channel_count + skin->morph_channel_count; i++) {
        const uint32_t morph = i - skin->channel_count;
        const bool is_node = i < skin->channel_count;
        for (int k = 0; k < (is_node ? KILN_CHANNEL_TRACKS : 1); k++) {
            struct kiln_skin_track *track =
                is_node ? &skin->channels[i].tracks[k] : &skin->morph_channels[morph].track;
            memcpy(keys + count, skin->keys + track->first, track->count * sizeof *keys);
            track->first = count;
            count += track->count;
        }
    }
    memcpy(skin->keys, keys, count * sizeof *keys);
    free(keys);
    return true;
}

bool gltf_put_clips(struct gltf *g, const struct gltf_moved *moved, struct kiln_mesh_result *result)
{
    struct clips c = {.g = g, .moved = moved, .skin = &result->skin};
    c.node_count = g->wanted->rig ? KILN_MAX_RIG_NODES : KILN_MAX_SKIN_NODES;
    uint32_t *numbers = calloc(c.node_count, sizeof *numbers);
    c.channels = malloc(c.node_count * sizeof *c.channels);
    c.morph_channels = malloc(KILN_MAX_SKIN_MORPHS * sizeof *c.morph_channels);
    bool ok = numbers && c.channels && c.morph_channels;
    if (!ok)
        decode_out_of_memory(g->error);
    for (uint32_t i = 0; ok && i < g->lists[GLTF_NODES].count; i++) {
        if (moved[i].node != GLTF_NONE)
            numbers[moved[i].node] = i;
    }
    for (uint32_t i = 0; ok && i < g->lists[GLTF_ANIMATIONS].count; i++)
        ok = put_clip(&c, gltf_element(g, GLTF_ANIMATIONS, i), numbers);
    ok = ok && order_keys(&c);
    free(numbers);
    free(c.channels);
    free(c.morph_channels);
    return ok && (g->wanted->rig || result->skin.clip_count > 0 ||
                  GLTF_SET(g, "the file has no animation"));
}
