/* Declares the data by which a mesh moves, as kiln-decode sends it: nodes, bones, clips and their
 * keys. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_IN_H
#define KILN_ASSET_GEOMETRY_SKIN_IN_H

#include "asset/geometry/skin.h"
#include "base/matrix.h"

enum { KILN_CHANNEL_MOVE, KILN_CHANNEL_TURN, KILN_CHANNEL_SCALE, KILN_CHANNEL_TRACKS };

struct kiln_skin_key {
    float seconds;
    vec4 value; /* of a rotation: a quaternion */
};

struct kiln_skin_track {
    uint32_t first, count; /* range of keys; count 0: the node's own value stays */
};

/* The tracks of a node in a clip, which replace its transform at rest. */
struct kiln_skin_channel {
    uint32_t node;
    struct kiln_skin_track tracks[KILN_CHANNEL_TRACKS];
};

struct kiln_skin_clip {
    char name[KILN_MAX_CLIP_NAME];
    uint32_t first, count; /* range of channels */
};

/* Nodes and bones. The last row of each of their matrices is (0, 0, 0, 1). */
struct kiln_skin_node {
    uint32_t parent; /* a node before this one; the first node is its own parent */
    mat4 rest;       /* transform to the parent's space */
};

struct kiln_skin_bone {
    uint32_t node;
    mat4 offset; /* transform from the vertices' space to the bone's */
};

struct kiln_skin_weights {
    uint16_t bones[KILN_SKIN_INFLUENCES];
    float weights[KILN_SKIN_INFLUENCES];
};

/* The part of struct kiln_mesh_result for meshes that move. Nothing in it may be trusted before it
 * is checked. */
struct kiln_skin_result {
    bool has_normals;
    uint32_t node_count, bone_count, clip_count, channel_count, key_count;
    struct kiln_skin_node nodes[KILN_MAX_SKIN_NODES];
    struct kiln_skin_bone bones[KILN_MAX_SKIN_BONES];
    struct kiln_skin_clip clips[KILN_MAX_CLIPS];
    struct kiln_skin_channel channels[KILN_MAX_CLIP_CHANNELS];
    struct kiln_skin_key keys[KILN_MAX_CLIP_KEYS];
    struct kiln_skin_weights weights[KILN_MAX_MESH_VERTICES];
};

#endif
