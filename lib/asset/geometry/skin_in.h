/* Declares the nodes, bones, clips and key frames by which a mesh moves, as kiln-decode sends them.
 * decode/skin.c fills them, mesh_in.h's arrays carry them, and kiln_skin_take (skin.c) checks and
 * copies them. skin.c then keeps these same structs to pose the mesh.
 *
 * Numbers cross the socket as they lie in memory, so these structs hold no pointers. */
#ifndef KILN_ASSET_GEOMETRY_SKIN_IN_H
#define KILN_ASSET_GEOMETRY_SKIN_IN_H

#include "asset/geometry/skin.h"
#include "base/matrix.h"

/* The tracks of a channel. KILN_CHANNEL_TRACKS is how many there are. */
enum { KILN_CHANNEL_MOVE, KILN_CHANNEL_TURN, KILN_CHANNEL_SCALE, KILN_CHANNEL_TRACKS };

/* A key frame. Between two keys of a track, skin.c interpolates: turns spherically, else linearly.
 */
struct kiln_skin_key {
    float seconds; /* from 0; greater than that of the key before in the track */
    vec4 value;    /* of KILN_CHANNEL_TURN a unit quaternion, else x, y and z */
};

struct kiln_skin_track {
    uint32_t first, count; /* range of keys; count 0: no translation, no turn, or a scale of 1 */
};

/* The tracks of a node in a clip. Together they replace the node's transform at rest. */
struct kiln_skin_channel {
    uint32_t node;
    struct kiln_skin_track tracks[KILN_CHANNEL_TRACKS];
};

struct kiln_skin_clip {
    char name[KILN_MAX_CLIP_NAME];
    uint32_t first, count; /* range of channels */
};

/* A node. The last row of its matrix, and of a bone's, is (0, 0, 0, 1): decode/skin.c refuses
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

/* The part of struct kiln_mesh_result for meshes that move. What the comments here say of its
 * numbers holds only after kiln_skin_take has checked them. The ranges of clips follow one another
 * without gaps or overlaps, and so do those of tracks that have keys. */
struct kiln_skin_result {
    bool has_normals; /* the file has them; else skin.c computes them */
    uint32_t node_count, bone_count, clip_count, channel_count, key_count;
    struct kiln_skin_node nodes[KILN_MAX_SKIN_NODES];
    struct kiln_skin_bone bones[KILN_MAX_SKIN_BONES];
    struct kiln_skin_clip clips[KILN_MAX_CLIPS];
    struct kiln_skin_channel channels[KILN_MAX_CLIP_CHANNELS];
    struct kiln_skin_key keys[KILN_MAX_CLIP_KEYS];
    struct kiln_skin_weights weights[KILN_MAX_MESH_VERTICES];
};

#endif
