/* Copies trees of nodes. Each node of a copy gets a link to the place that asked for it, in front
 * of the links that the original has, so that an error in the copy can show the whole way. */
#include "option/node_copy.h"

#include "base/error.h"

static struct kiln_node *copy_one(const struct kiln_copying *copying, const struct kiln_node *node)
{
    struct kiln_node *copy = NULL;
    if (++copying->counts->copied > KILN_NODE_MAX_COPIES) {
        kiln_node_error(copying->at, copying->error,
                        "aliases, uses and parameters copy more than the %d nodes that are allowed",
                        KILN_NODE_MAX_COPIES);
        return NULL;
    }
    struct kiln_node_link *link = kiln_arena_alloc(copying->arena, 1, sizeof *link);
    if (link)
        copy = kiln_arena_alloc(copying->arena, 1, sizeof *copy);
    if (!copy) {
        kiln_error_no_memory(copying->error, "reading %s", node->origin->kind);
        return NULL;
    }
    *link = (struct kiln_node_link){copying->words, copying->at, node->via};
    *copy = *node;
    copy->via = link;
    copy->first = copy->last = copy->next = NULL;
    copy->count = 0;
    return copy;
}

struct kiln_node *kiln_node_copy(const struct kiln_copying *copying, const struct kiln_node *node,
                                 uint32_t depth)
{
    if (depth > KILN_NODE_MAX_DEPTH || (depth == KILN_NODE_MAX_DEPTH && node->first)) {
        kiln_node_error(copying->at, copying->error,
                        "nested deeper than the %d levels that are allowed", KILN_NODE_MAX_DEPTH);
        return NULL;
    }
    struct kiln_node *copy = copy_one(copying, node);
    if (!copy)
        return NULL;
    if (node->key && !(copy->key = copy_one(copying, node->key)))
        return NULL;
    for (const struct kiln_node *child = node->first; child; child = child->next) {
        struct kiln_node *child_copy = kiln_node_copy(copying, child, depth + 1);
        if (!child_copy)
            return NULL;
        kiln_node_append(copy, child_copy);
    }
    return copy;
}
