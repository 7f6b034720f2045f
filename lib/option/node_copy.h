/* Copies trees of nodes within a budget, so that a short text cannot stand for a tree without end.
 * Aliases, `use` and parameters copy. */
#ifndef KILN_OPTION_NODE_COPY_H
#define KILN_OPTION_NODE_COPY_H

#include "option/node.h"

/* The nodes that a scene may copy, all its files together. */
enum { KILN_NODE_MAX_COPIES = 100000 };

/* Describes where copies go, and why. */
struct kiln_copying {
    struct kiln_arena *arena;
    struct kiln_error *error;
    struct kiln_node_counts *counts; /* of the nodes copied so far */
    const char *words;               /* for errors in the copy: "used at" */
    const struct kiln_node *at;      /* where the copy was asked for; must outlive the copy */
};

/* Returns a copy of a tree, which lies in a tree below `depth` lists and mappings. Every copied
 * node has a link to copying->at. NULL with an error at that node when the copy would be over the
 * budget or nested too deeply, or when memory is short. */
struct kiln_node *kiln_node_copy(const struct kiln_copying *copying, const struct kiln_node *node,
                                 uint32_t depth);

#endif
