/* Keeps anchors by their names, and merges mappings as the key << of YAML 1.1 does. The number of
 * anchors is limited, so that the search for a name is short whatever a text holds. */
#include "option/node_anchors.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"

struct kiln_anchor {
    const char *name;
    const struct kiln_node *node;
    struct kiln_anchor *next;
};

static struct kiln_anchor *find(const struct kiln_anchors *anchors, const char *name, size_t length)
{
    struct kiln_anchor *entry = anchors->entries;
    while (entry && (strncmp(entry->name, name, length) != 0 || entry->name[length] != '\0'))
        entry = entry->next;
    return entry;
}

bool kiln_anchors_add(struct kiln_anchors *anchors, struct kiln_arena *arena, const char *name,
                      size_t length, const struct kiln_node *node, struct kiln_error *error)
{
    struct kiln_anchor *known = find(anchors, name, length);
    if (known) {
        known->node = node;
        return true;
    }
    if (anchors->count == KILN_NODE_MAX_ANCHORS)
        return kiln_node_error(node, error, "more than the %d anchors that are allowed",
                               KILN_NODE_MAX_ANCHORS);
    struct kiln_anchor *added = kiln_arena_alloc(arena, 1, sizeof *added);
    const char *copy = kiln_arena_text(arena, name, length);
    if (!added || !copy)
        return kiln_error_no_memory(error, "reading %s", node->origin->kind);
    *added = (struct kiln_anchor){copy, node, anchors->entries};
    anchors->entries = added;
    anchors->count++;
    return true;
}

const struct kiln_node *kiln_anchors_find(const struct kiln_anchors *anchors,
                                          const struct kiln_node *at, const char *name,
                                          size_t length, struct kiln_error *error)
{
    const struct kiln_anchor *entry = find(anchors, name, length);
    if (entry)
        return entry->node;
    char text[64], quoted[64];
    snprintf(text, sizeof text, "%.*s", length < sizeof text ? (int)length : 60, name);
    kiln_node_quote(quoted, text);
    kiln_node_error(at, error, "there is no anchor '%s' above", quoted);
    return NULL;
}

/* Removes the entries of a mapping whose keys another one has. */
static void remove_known(struct kiln_node *source, const struct kiln_node *own)
{
    struct kiln_node rest = {.kind = KILN_NODE_MAP};
    for (struct kiln_node *entry = source->first, *next; entry; entry = next) {
        next = entry->next;
        entry->next = NULL;
        if (!kiln_node_entry(own, entry->key->text))
            kiln_node_append(&rest, entry);
    }
    source->first = rest.first;
    source->last = rest.last;
    source->count = rest.count;
}

/* Moves the entries of a mapping to another one, but for those of keys that it has. */
static bool move_entries(struct kiln_node *merged, struct kiln_node *source,
                         struct kiln_error *error)
{
    for (struct kiln_node *entry = source->first, *next; entry; entry = next) {
        next = entry->next;
        entry->next = NULL;
        if (kiln_node_entry(merged, entry->key->text))
            continue;
        if (merged->count == KILN_NODE_MAX_ENTRIES)
            return kiln_node_error(
                source, error, "more than %d entries in one list or mapping; no more are allowed",
                KILN_NODE_MAX_ENTRIES);
        kiln_node_append(merged, entry);
    }
    return true;
}

static bool is_merge(const struct kiln_node *entry)
{
    return strcmp(entry->key->text, "<<") == 0;
}

/* Calls a function for each mapping that the value of a key << is or lists. */
static bool visit_sources(struct kiln_node *value,
                          bool (*visit)(struct kiln_node *map, struct kiln_node *source,
                                        struct kiln_error *error),
                          struct kiln_node *map, struct kiln_error *error)
{
    if (value->kind == KILN_NODE_MAP)
        return visit(map, value, error);
    for (struct kiln_node *source = value->first; source; source = source->next) {
        if (!visit(map, source, error))
            return false;
    }
    return value->kind == KILN_NODE_LIST ||
           kiln_node_error(value, error, "<<: expected a mapping or a list of mappings");
}

static bool prepare(struct kiln_node *map, struct kiln_node *source, struct kiln_error *error)
{
    if (source->kind != KILN_NODE_MAP)
        return kiln_node_error(source, error, "<<: expected a mapping or a list of mappings");
    remove_known(source, map);
    return true;
}

bool kiln_anchors_merge(struct kiln_node *map, struct kiln_error *error)
{
    struct kiln_node merged = {.kind = KILN_NODE_MAP};
    for (struct kiln_node *entry = map->first; entry; entry = entry->next) {
        if (is_merge(entry) && !visit_sources(entry, prepare, map, error))
            return false;
    }
    for (struct kiln_node *entry = map->first, *next; entry; entry = next) {
        next = entry->next;
        entry->next = NULL;
        if (!is_merge(entry))
            kiln_node_append(&merged, entry);
        else if (!visit_sources(entry, move_entries, &merged, error))
            return false;
    }
    map->first = merged.first;
    map->last = merged.last;
    map->count = merged.count;
    return true;
}
