/* Declares what moves a mesh, on its way from kiln-decode: nodes, bones, clips and their keys. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_IN_H
#define KILN_ASSET_GEOMETRY_SKIN_IN_H

#include "asset/geometry/skin.h"
#include "base/matrix.h"

enum { KILN_CHANNEL_MOVE, KILN_CHANNEL_TURN, KILN_CHANNEL_SCALE, KILN_CHANNEL_TRACKS };

struct kiln_skin_key {
    float seconds;
    vec4 value; /* of a turn a quaternion */
};

struct kiln_skin_track {
    uint32_t first, count; /* keys; none: it stays as it is without */
};

/* What a clip does to a node, in place of the transform that it has at rest. */
struct kiln_skin_channel {
    uint32_t node;
    struct kiln_skin_track tracks[KILN_CHANNEL_TRACKS];
};

struct kiln_skin_clip {
    char name[KILN_MAX_CLIP_NAME];
    uint32_t first, count; /* channels */
};

/* The last row of each matrix of nodes and bones is (0, 0, 0, 1). */
struct kiln_skin_node {
    uint32_t parent; /* before it; of the first, itself */
    mat4 rest;       /* to the parent */
};

struct kiln_skin_bone {
    uint32_t node;
    mat4 offset; /* from the vertices to the bone */
};

struct kiln_skin_weights {
    uint16_t bones[KILN_SKIN_INFLUENCES];
    float weights[KILN_SKIN_INFLUENCES];
};

/* Part of struct kiln_mesh_result, and as little to be believed. */
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
