/* Resolves `use`. An entry is complete, with what it uses itself, before it is copied; so the order
 * of the entries does not matter, and an entry that is reached again on the way uses itself. */
#include "option/use.h"

#include <string.h>

#include "option/include.h"
#include "option/merge.h"
#include "option/node_copy.h"

/* Entries that use each other one after another. So the recursion is limited. */
enum { MOST_DEPTH = 64 };

/* An entry that is being resolved, and the one that uses it. */
struct user {
    const struct kiln_node *entry;
    const struct user *of;
    int depth;
};

static bool unknown_name(struct kiln_reader *reader, const struct kiln_node *map,
                         const struct kiln_node *use)
{
    const char *names[64];
    size_t count = 0;
    char suggestion[512], quoted[64];
    for (const struct kiln_node *entry = map->first; entry && count < 64; entry = entry->next)
        names[count++] = entry->key->text;
    kiln_node_quote(quoted, use->text);
    kiln_option_suggest(suggestion, sizeof suggestion, use->text, names, count);
    return kiln_reader_error(reader, use, "there is no entry '%s'%s", quoted, suggestion);
}

/* The mapping whose entries are being resolved. */
struct using
{
    struct kiln_reader *reader;
    const struct kiln_option *row;
    struct kiln_node *map;
    size_t path; /* length of the reader's path up to the mapping */
};

static bool resolve(const struct using *using, struct kiln_node *entry, const struct user *of)
{
    struct kiln_reader *reader = using->reader;
    const struct user user = {entry, of, of ? of->depth + 1 : 1};
    struct kiln_node *use = kiln_node_entry(entry, "use");
    if (!use)
        return true;
    kiln_reader_leave(reader, using->path);
    kiln_reader_enter(reader, entry->key->text);
    kiln_reader_enter(reader, "use");
    if (!kiln_reader_is_text(use))
        return kiln_reader_expected(reader, use, "the name of another entry");
    struct kiln_node *other = kiln_node_entry(using->map, use->text);
    if (!other)
        return unknown_name(reader, using->map, use);
    for (const struct user *known = &user; known; known = known->of) {
        if (known->entry == other)
            return kiln_reader_error(reader, use, "this entry uses itself");
    }
    if (user.depth > MOST_DEPTH)
        return kiln_reader_error(reader, use, "more than %d entries use each other", MOST_DEPTH);
    if (!resolve(using, other, &user))
        return false;
    kiln_node_take(entry, "use");
    const struct kiln_copying copying = {reader->scratch, reader->error, reader->counts, "used at",
                                         use};
    struct kiln_node *copy = kiln_node_copy(&copying, other, 0);
    if (!copy)
        return false;
    if (copy->kind == KILN_NODE_MAP)
        kiln_node_take(copy, "enabled");
    return kiln_merge_entry(entry, copy, using->row, reader->error);
}

bool kiln_use(struct kiln_reader *reader, const struct kiln_option *rows, struct kiln_node *root)
{
    for (const struct kiln_option *row = rows; row->name; row++) {
        struct kiln_node *map = kiln_node_entry(root, row->name);
        if (!map || row->type == &kiln_type_params)
            continue;
        const size_t before = kiln_reader_enter(reader, row->name);
        const struct using using = {reader, row, map, reader->path_length};
        struct kiln_node *entry = kiln_merge_is_of_names(row, map) ? map->first : NULL;
        for (; entry; entry = entry->next) {
            if (!resolve(&using, entry, NULL))
                return false;
        }
        if (row->type == &kiln_type_group && !kiln_use(reader, row->members, map))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}
