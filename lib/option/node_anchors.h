/* Keeps the anchors of a text while it is parsed (option/node.c), and merges the mappings of its
 * keys <<. */
#ifndef KILN_OPTION_NODE_ANCHORS_H
#define KILN_OPTION_NODE_ANCHORS_H

#include "option/node_copy.h"

enum { KILN_NODE_MAX_ANCHORS = 256 };

/* A zero-initialised struct has no anchors. */
struct kiln_anchors {
    struct kiln_anchor *entries; /* the first of a list, the latest in front */
    uint32_t count;
};

/* Names a node. A later anchor of a name replaces an earlier one. `name` has a length and is copied
 * into the arena. */
bool kiln_anchors_add(struct kiln_anchors *anchors, struct kiln_arena *arena, const char *name,
                      size_t length, const struct kiln_node *node, struct kiln_error *error);

/* Returns the node of a name; NULL with an error at `at` if there is none. */
const struct kiln_node *kiln_anchors_find(const struct kiln_anchors *anchors,
                                          const struct kiln_node *at, const char *name,
                                          size_t length, struct kiln_error *error);

/* Replaces the key << of a mapping by the entries of its value, a mapping or a list of mappings,
 * whose keys the mapping does not have itself. Of a list, earlier mappings win. */
bool kiln_anchors_merge(struct kiln_node *map, struct kiln_error *error);

#endif
