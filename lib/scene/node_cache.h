/* Declares a memory of the frames of a scene's nodes. Many parts of a scene may lie in one node,
 * and ask for its frame at the same moment. */
#ifndef KILN_SCENE_NODE_CACHE_H
#define KILN_SCENE_NODE_CACHE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

struct kiln_node_cache;
struct kiln_node_frame;

/* Which frame of a node is meant. */
enum kiln_node_frame_kind {
    KILN_NODE_FRAME_OWN,   /* in its parent */
    KILN_NODE_FRAME_WORLD, /* in the world */
};

/* Returns a memory for this number of nodes, or NULL when memory is short. It lies in the arena;
 * finish it before that is destroyed. */
struct kiln_node_cache *kiln_node_cache_create(struct kiln_arena *arena, uint32_t node_count);
/* cache: may be NULL. */
void kiln_node_cache_finish(struct kiln_node_cache *cache);

/* Looks up the frame of a node at a time, with its rates at another time. Returns whether it is
 * known. Any thread may call these. */
bool kiln_node_cache_find(struct kiln_node_cache *cache, enum kiln_node_frame_kind kind,
                          uint32_t node, float time_s, float rate_s, struct kiln_node_frame *frame);

/* Remembers a frame, which is the same whenever it is computed. */
void kiln_node_cache_keep(struct kiln_node_cache *cache, enum kiln_node_frame_kind kind,
                          uint32_t node, float time_s, float rate_s,
                          const struct kiln_node_frame *frame);

#endif
