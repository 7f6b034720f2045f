/* This file checks the nodes and clips of glTF files that kiln-decode sends, keeps them as a rig,
 * and finds nodes and clips by their names. kiln-decode reads untrusted files, so rig_pose.c uses
 * nothing that was not checked here. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "asset/geometry/rig_kept.h"
#include "base/error.h"

/* ---- checking and making --------------------------------------------------------------------- */

static bool are_near(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(values[i]) <= (double)KILN_SKIN_FARTHEST))
            return false;
    }
    return true;
}

static bool is_node_sound(const struct kiln_rig_node *node, uint32_t i)
{
    return node->parent <= i && node->is_joint <= 1 && node->camera <= KILN_RIG_ORTHOGRAPHIC &&
           memchr(node->name, '\0', sizeof node->name);
}

static bool check(const char *name, const struct kiln_mesh_result *result, struct kiln_error *error)
{
    const struct kiln_rig_result *rig = &result->rig;
    bool sound = rig->node_count >= 1 && rig->node_count <= KILN_MAX_RIG_NODES, near = true;
    for (uint32_t i = 0; sound && i < rig->node_count; i++) {
        const struct kiln_rig_node *node = &rig->nodes[i];
        sound = is_node_sound(node, i);
        near = near && are_near(node->local[0], 12) && are_near(node->move, 3) &&
               are_near(node->turn, 4) && are_near(node->scale, 3) && are_near(&node->fov, 1);
    }
    if (!sound)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the nodes are broken: the importer returned inconsistent data",
                              name);
    if (!near)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: a node has numbers beyond -%g and %g",
                              name, (double)KILN_SKIN_FARTHEST, (double)KILN_SKIN_FARTHEST);
    return kiln_clips_check(name, result, rig->node_count, error);
}

static void *copy_of(struct kiln_rig *rig, const void *from, size_t count, size_t size)
{
    void *copy = calloc(count ? count : 1, size);
    rig->bytes += count * size;
    if (copy && count > 0)
        memcpy(copy, from, count * size);
    return copy;
}

/* Names go into messages, so control characters are replaced. */
static void clean_name(char *name)
{
    for (char *c = name; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = ' ';
    }
}

void kiln_rig_make_unit(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int c = 0; c < 4; c++)
        q[c] = length > 1e-12 ? q[c] / length : c == 3;
}

int kiln_rig_by_node(const void *a, const void *b)
{
    const struct kiln_skin_channel *x = a, *y = b;
    return x->node < y->node ? -1 : x->node > y->node;
}

static float length_of_clip(const struct kiln_rig *rig, const struct kiln_skin_clip *clip)
{
    float length = clip->length;
    for (uint32_t i = 0; i < clip->count; i++) {
        for (int k = 0; k < KILN_CHANNEL_TRACKS; k++) {
            const struct kiln_skin_track *track = &rig->channels[clip->first + i].tracks[k];
            if (track->count > 0)
                length = fmaxf(length, rig->keys[track->first + track->count - 1].seconds);
        }
    }
    return length;
}

/* Makes a rig of numbers that were checked. NULL: memory is short. */
static struct kiln_rig *make(const struct kiln_mesh_result *result, const char hash[65])
{
    const struct kiln_skin_result *clips = &result->skin;
    struct kiln_rig *rig = calloc(1, sizeof *rig);
    if (!rig)
        return NULL;
    memcpy(rig->hash, hash, sizeof rig->hash);
    rig->node_count = result->rig.node_count;
    rig->clip_count = clips->clip_count;
    rig->nodes = copy_of(rig, result->rig.nodes, rig->node_count, sizeof *rig->nodes);
    rig->clips = copy_of(rig, clips->clips, rig->clip_count, sizeof *rig->clips);
    rig->channels = copy_of(rig, clips->channels, clips->channel_count, sizeof *rig->channels);
    rig->keys = copy_of(rig, clips->keys, clips->key_count, sizeof *rig->keys);
    if (!rig->nodes || !rig->clips || !rig->channels || !rig->keys) {
        kiln_rig_destroy(&rig);
        return NULL;
    }
    for (uint32_t i = 0; i < rig->node_count; i++) {
        clean_name(rig->nodes[i].name);
        kiln_rig_make_unit(rig->nodes[i].turn);
    }
    for (uint32_t i = 0; i < rig->clip_count; i++) {
        struct kiln_skin_clip *clip = &rig->clips[i];
        clean_name(clip->name);
        clip->length = length_of_clip(rig, clip);
        qsort(rig->channels + clip->first, clip->count, sizeof *rig->channels, kiln_rig_by_node);
    }
    return rig;
}

struct kiln_rig *kiln_rig_take(const char *name, const struct kiln_mesh_result *result,
                               const char hash[65], struct kiln_error *error)
{
    if (!check(name, result, error))
        return NULL;
    struct kiln_rig *rig = make(result, hash);
    if (!rig)
        kiln_error_no_memory(error, "reading the nodes of %s", name);
    return rig;
}

void kiln_rig_destroy(struct kiln_rig **rig)
{
    if (!*rig)
        return;
    free((*rig)->nodes);
    free((*rig)->clips);
    free((*rig)->channels);
    free((*rig)->keys);
    free(*rig);
    *rig = NULL;
}

uint64_t kiln_rig_bytes(const struct kiln_rig *rig)
{
    return rig->bytes;
}

const char *kiln_rig_hash(const struct kiln_rig *rig)
{
    return rig->hash;
}

/* ---- names ----------------------------------------------------------------------------------- */

/* A list of names for a message. */
struct known {
    char text[256];
    size_t length;
    uint32_t left_out;
};

static void add_known(struct known *known, const char *name)
{
    const size_t room = sizeof known->text - known->length;
    if (!*name || known->left_out > 0 || strlen(name) + 8 > room) {
        known->left_out += *name != '\0';
        return;
    }
    known->length += (size_t)snprintf(known->text + known->length, room, "%s'%s'",
                                      known->length ? ", " : "", name);
}

static bool is_number(const char *text, uint32_t *number)
{
    const char *c = text;
    while (isdigit((unsigned char)*c))
        c++;
    if (c == text || *c != '\0' || c - text > 7)
        return false;
    *number = (uint32_t)strtoul(text, NULL, 10);
    return true;
}

static bool refuse_node(const struct kiln_rig *rig, const char *node, bool joint, const char *name,
                        struct kiln_error *error)
{
    struct known known = {.length = 0};
    bool any_joint = false;
    uint32_t least = UINT32_MAX, most = 0;
    for (uint32_t i = 0; i < rig->node_count; i++) {
        any_joint = any_joint || rig->nodes[i].is_joint;
        least = rig->nodes[i].number < least ? rig->nodes[i].number : least;
        most = rig->nodes[i].number > most ? rig->nodes[i].number : most;
    }
    /* Nodes of other scenes of the file have numbers, too, and are not in the rig. */
    const bool has_gaps = most - least + 1 != rig->node_count;
    for (uint32_t i = 0; i < rig->node_count; i++) {
        if (!(joint && any_joint) || rig->nodes[i].is_joint)
            add_known(&known, rig->nodes[i].name);
    }
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: no %s is called '%.63s' or has this number; the file has %s%s, "
                          "by %s %u to %u",
                          name, joint ? "joint" : "node", node,
                          known.length ? known.text : "none with a name",
                          known.left_out ? " and others" : "",
                          has_gaps ? "some of the numbers" : "number", least, most);
}

static uint32_t depth_of(const struct kiln_rig *rig, uint32_t node)
{
    uint32_t depth = 1;
    for (; rig->nodes[node].parent != node; node = rig->nodes[node].parent)
        depth++;
    return depth;
}

static bool check_depth(const struct kiln_rig *rig, uint32_t node, const char *name,
                        struct kiln_error *error)
{
    const uint32_t depth = depth_of(rig, node);
    return depth <= KILN_MAX_RIG_DEPTH ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: node %u lies below %u others; allowed are at most %d", name,
                          rig->nodes[node].number, depth - 1, KILN_MAX_RIG_DEPTH - 1);
}

bool kiln_rig_find_node(const struct kiln_rig *rig, const char *node, bool joint, const char *name,
                        uint32_t *number, struct kiln_error *error)
{
    uint32_t found[2] = {0, 0}, count = 0, joints = 0, of_file = 0;
    for (uint32_t i = 0; i < rig->node_count; i++)
        joints += joint && rig->nodes[i].is_joint && strcmp(rig->nodes[i].name, node) == 0;
    for (uint32_t i = 0; i < rig->node_count; i++) {
        if (strcmp(rig->nodes[i].name, node) != 0 || (joints > 0 && !rig->nodes[i].is_joint))
            continue;
        if (count < 2)
            found[count] = i;
        count++;
    }
    if (count > 1 && *node)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: %u nodes are called '%.63s', of the numbers %u and %u%s; a "
                              "number says which is meant",
                              name, count, node, rig->nodes[found[0]].number,
                              rig->nodes[found[1]].number, count > 2 ? " and others" : "");
    *number = found[0];
    if (count == 1 && *node)
        return check_depth(rig, *number, name, error);
    for (uint32_t i = 0; is_number(node, &of_file) && i < rig->node_count; i++) {
        *number = i;
        if (rig->nodes[i].number == of_file)
            return check_depth(rig, i, name, error);
    }
    return refuse_node(rig, node, joint, name, error);
}

bool kiln_rig_find_clip(const struct kiln_rig *rig, const char *clip, const char *name,
                        uint32_t *number, struct kiln_error *error)
{
    struct known known = {.length = 0};
    for (*number = 0; *number < rig->clip_count; ++*number) {
        if (strcmp(rig->clips[*number].name, clip) == 0)
            return true;
        add_known(&known, rig->clips[*number].name);
    }
    if (is_number(clip, number) && *number < rig->clip_count)
        return true;
    if (rig->clip_count == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file has no animation", name);
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: no animation is called '%.63s'; the file has %s%s, by number 0 to "
                          "%u",
                          name, clip, known.length ? known.text : "none with a name",
                          known.left_out ? " and others" : "", rig->clip_count - 1);
}

uint32_t kiln_rig_clip_count(const struct kiln_rig *rig)
{
    return rig->clip_count;
}

float kiln_rig_clip_length(const struct kiln_rig *rig, uint32_t clip)
{
    return rig->clips[clip].length;
}

enum kiln_rig_camera kiln_rig_camera_of(const struct kiln_rig *rig, uint32_t node, double *fov_rad)
{
    *fov_rad = rig->nodes[node].fov;
    return (enum kiln_rig_camera)rig->nodes[node].camera;
}
