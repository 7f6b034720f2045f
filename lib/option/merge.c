/* Lays one tree under another along the option tables. The tables say what a mapping is: keys and
 * names merge one by one, while a curve, such as {keys: {...}}, is one value. */
#include "option/merge.h"

#include <string.h>

#include "option/animated.h"
#include "option/params.h"

static bool append(struct kiln_node *own, struct kiln_node *entry, struct kiln_error *error)
{
    if (own->count == KILN_NODE_MAX_ENTRIES)
        return kiln_node_error(entry, error,
                               "more than %d entries in one list or mapping; no more are allowed",
                               KILN_NODE_MAX_ENTRIES);
    entry->next = NULL;
    kiln_node_append(own, entry);
    return true;
}

bool kiln_merge_is_of_names(const struct kiln_option *row, const struct kiln_node *node)
{
    return node->kind == KILN_NODE_MAP &&
           (row->type == &kiln_type_map || row->type == &kiln_type_params ||
            (row->type == &kiln_type_list && row->is_named));
}

/* Merges two mappings whose one key names a kind. Another kind, a kind of several variants, and a
 * value that is not a mapping stay whole. */
static bool merge_kinds(struct kiln_node *own, struct kiln_node *under,
                        const struct kiln_option_kind *kinds, struct kiln_error *error)
{
    if (own->count == 0 && under->first)
        return append(own, under->first, error);
    struct kiln_node *a = own->first, *b = under->first;
    if (own->count != 1 || under->count != 1 || strcmp(a->key->text, b->key->text) != 0 ||
        a->kind != KILN_NODE_MAP || b->kind != KILN_NODE_MAP || kiln_node_is_animated(a) ||
        kiln_node_is_animated(b))
        return true;
    while (kinds->name && strcmp(kinds->name, a->key->text) != 0)
        kinds++;
    return !kinds->name || kinds->variant || kiln_merge_members(a, b, kinds->members, error);
}

/* Merges two declarations of a parameter, unless they are of different kinds. */
static bool merge_declarations(struct kiln_node *own, struct kiln_node *under,
                               struct kiln_error *error)
{
    const char *kind = kiln_params_kind_of(own), *other = kiln_params_kind_of(under);
    if (kind && other && strcmp(kind, other) != 0)
        return true;
    for (struct kiln_node *entry = under->first, *next; entry; entry = next) {
        next = entry->next;
        if (!kiln_node_entry(own, entry->key->text) && !append(own, entry, error))
            return false;
    }
    return true;
}

bool kiln_merge_entry(struct kiln_node *own, struct kiln_node *under, const struct kiln_option *row,
                      struct kiln_error *error)
{
    if (own->kind != KILN_NODE_MAP || under->kind != KILN_NODE_MAP)
        return true;
    if (row->type == &kiln_type_params)
        return merge_declarations(own, under, error);
    if (row->type == &kiln_type_list)
        return !row->item->kinds || merge_kinds(own, under, row->item->kinds, error);
    return kiln_merge_members(own, under, row->members, error);
}

static bool merge_names(struct kiln_node *own, struct kiln_node *under,
                        const struct kiln_option *row, struct kiln_error *error)
{
    for (struct kiln_node *entry = under->first, *next; entry; entry = next) {
        next = entry->next;
        struct kiln_node *known = kiln_node_entry(own, entry->key->text);
        if (!(known ? kiln_merge_entry(known, entry, row, error) : append(own, entry, error)))
            return false;
    }
    return true;
}

static bool merge_value(struct kiln_node *own, struct kiln_node *under,
                        const struct kiln_option *row, struct kiln_error *error)
{
    if (own->kind != KILN_NODE_MAP || under->kind != KILN_NODE_MAP)
        return true;
    if (kiln_merge_is_of_names(row, own))
        return merge_names(own, under, row, error);
    if (row->type == &kiln_type_kind)
        return merge_kinds(own, under, row->kinds, error);
    if (row->type == &kiln_type_group || row->type == &kiln_type_switch)
        return kiln_merge_members(own, under, row->members, error);
    return true;
}

bool kiln_merge_members(struct kiln_node *own, struct kiln_node *under,
                        const struct kiln_option *rows, struct kiln_error *error)
{
    for (struct kiln_node *entry = under->first, *next; entry; entry = next) {
        next = entry->next;
        const struct kiln_option *row = kiln_option_find(rows, entry->key->text);
        struct kiln_node *known = kiln_node_entry(own, entry->key->text);
        const bool is_decided = row && row->instead_of && kiln_node_entry(own, row->instead_of);
        if (known ? row && !merge_value(known, entry, row, error)
                  : !is_decided && !append(own, entry, error))
            return false;
    }
    return true;
}
