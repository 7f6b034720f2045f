/* Declares the nodes and cameras of a glTF file as kiln-decode sends them. decode/gltf_rig.c fills
 * them, mesh_in.h's arrays carry them, and kiln_rig_take (rig.c) checks and copies them. The clips
 * that move the nodes cross as those of a mesh that moves (skin_in.h).
 *
 * Numbers cross the socket as they lie in memory, so the elements of arrays hold no pointers. */
#ifndef KILN_ASSET_GEOMETRY_RIG_IN_H
#define KILN_ASSET_GEOMETRY_RIG_IN_H

#include "asset/geometry/rig.h"

/* A node. Numbers are those of the file at rest, in double precision as JSON has them. */
struct kiln_rig_node {
    char name[KILN_MAX_NODE_NAME]; /* "": none, or one that is too long */
    uint32_t number;               /* in the file */
    uint32_t parent;               /* a node before this one; a root is its own parent */
    uint32_t is_joint;             /* of a skin of the file */
    uint32_t camera;               /* enum kiln_rig_camera */
    double fov;                    /* rad, vertical, of a perspective camera */
    double local[3][4];            /* rows of the transform to the parent's space */
    /* The parts of that transform. A clip replaces the translation, the rotation (a quaternion of
     * any length) and the scale one by one. */
    double move[3], turn[4], scale[3];
};

struct kiln_rig_result {
    uint32_t node_count;
    struct kiln_rig_node nodes[KILN_MAX_RIG_NODES];
};

#endif
