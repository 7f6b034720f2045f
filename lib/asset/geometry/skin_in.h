/* Declares the nodes, bones, clips and key frames by which a mesh moves, as kiln-decode sends them.
 * decode/gltf_moving.c fills them, mesh_in.h's arrays carry them, and kiln_skin_take (skin.c)
 * checks and copies them. skin.c then keeps these same structs to pose the mesh.
 *
 * Numbers cross the socket as they lie in memory, so the elements of arrays hold no pointers. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_IN_H
#define KILN_ASSET_GEOMETRY_SKIN_IN_H

#include "asset/geometry/skin.h"
#include "base/matrix.h"

/* The limit of coordinates in keys, matrices and vertices, in units of the file. */
#define KILN_SKIN_FARTHEST 1e6f

/* The tracks of a channel. KILN_CHANNEL_TRACKS is how many there are. */
enum { KILN_CHANNEL_MOVE, KILN_CHANNEL_TURN, KILN_CHANNEL_SCALE, KILN_CHANNEL_TRACKS };

/* How a track goes from one key to the next: it keeps the value of the first, it goes straight (a
 * rotation at constant speed), or along a cubic Hermite spline. */
enum kiln_skin_interpolation { KILN_SKIN_LINEAR, KILN_SKIN_STEP, KILN_SKIN_CUBIC };

/* A key frame, or one of the three parts that it has with cubic splines: the tangent before it, its
 * value, and the tangent after it, all of one time. */
struct kiln_skin_key {
    float seconds; /* from 0; greater than that of the key before in the track */
    vec4 value; /* of KILN_CHANNEL_TURN a quaternion, of a morph target its weight, else x, y, z */
};

/* A range of keys. count 0: no translation, no turn, or a scale of 1. */
struct kiln_skin_track {
    uint32_t first, count;
    uint32_t interpolation; /* enum kiln_skin_interpolation */
};

/* Returns how many of struct kiln_skin_key a key frame of a track has. */
static inline uint32_t kiln_skin_parts(const struct kiln_skin_track *track)
{
    return track->interpolation == KILN_SKIN_CUBIC ? 3 : 1;
}

/* The tracks of a node in a clip. Together they replace the node's transform at rest. */
struct kiln_skin_channel {
    uint32_t node;
    struct kiln_skin_track tracks[KILN_CHANNEL_TRACKS];
};

/* The weight of a morph target in a clip. */
struct kiln_skin_morph_channel {
    uint32_t morph;
    struct kiln_skin_track track;
};

struct kiln_skin_clip {
    char name[KILN_MAX_CLIP_NAME];
    uint32_t first, count;             /* range of channels */
    uint32_t first_morph, morph_count; /* range of morph channels */
    float length; /* s; may be longer than the channels, which are those of what is shown */
};

/* A node. The last row of its matrix, and of a bone's, is (0, 0, 0, 1): kiln-decode refuses
 * others, and skin.c multiplies them as matrices of that form. */
struct kiln_skin_node {
    uint32_t parent; /* a node before this one; the first node is its own parent */
    mat4 rest;       /* transform to the parent's space */
};

/* A bone moves vertices as its node moves. */
struct kiln_skin_bone {
    uint32_t node;
    mat4 offset; /* transform from the vertices' space to the bone's */
};

/* The bones that move a vertex, and by how much each. The weights of a vertex sum to one. */
struct kiln_skin_weights {
    uint16_t bones[KILN_SKIN_INFLUENCES];
    float weights[KILN_SKIN_INFLUENCES];
};

/* What a morph target of weight 1 adds to a vertex, before nodes and bones move it. */
struct kiln_skin_delta {
    uint32_t vertex;
    float position[3], normal[3];
};

/* A morph target whose weight a clip moves. */
struct kiln_skin_morph {
    uint32_t first, count; /* range of deltas */
    float rest;            /* weight where no clip moves it */
};

/* The part of struct kiln_mesh_result for meshes that move. What the comments here say of its
 * numbers holds only after kiln_skin_take has checked them. The ranges of clips follow one another
 * without gaps or overlaps, and so do those of morphs, and those of tracks that have keys: first
 * those of all channels, then those of all morph channels. */
struct kiln_skin_result {
    uint32_t node_count, bone_count, clip_count, channel_count, key_count;
    uint32_t morph_count, morph_channel_count, delta_count;
    struct kiln_skin_node nodes[KILN_MAX_SKIN_NODES];
    struct kiln_skin_bone bones[KILN_MAX_SKIN_BONES];
    struct kiln_skin_clip clips[KILN_MAX_CLIPS];
    struct kiln_skin_channel channels[KILN_MAX_CLIP_CHANNELS];
    struct kiln_skin_key keys[KILN_MAX_CLIP_KEYS];
    struct kiln_skin_morph morphs[KILN_MAX_SKIN_MORPHS];
    struct kiln_skin_morph_channel morph_channels[KILN_MAX_CLIP_MORPHS];
    struct kiln_skin_delta *deltas; /* allocated for delta_count; its owner frees it */
    struct kiln_skin_weights weights[KILN_MAX_MESH_VERTICES];
};

#endif
