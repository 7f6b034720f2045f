/* Declares what rig.c keeps of the nodes of a glTF file for rig_pose.c. */
#ifndef KILN_ASSET_GEOMETRY_RIG_KEPT_H
#define KILN_ASSET_GEOMETRY_RIG_KEPT_H

#include "asset/geometry/rig_in.h"
#include "asset/geometry/skin_in.h"

struct kiln_rig {
    char hash[65];
    uint32_t node_count, clip_count;
    struct kiln_rig_node *nodes;
    struct kiln_skin_clip *clips;
    struct kiln_skin_channel *channels; /* those of a clip are in the order of their nodes */
    struct kiln_skin_key *keys;
    uint64_t bytes;
};

/* Makes a quaternion one of length 1; one of length 0 becomes one that does not turn. */
void kiln_rig_make_unit(double q[4]);

/* Orders two struct kiln_skin_channel by their nodes. */
int kiln_rig_by_node(const void *a, const void *b);

#endif
