/* Resolves `include`. Files are followed depth first: an included file is complete, with its own
 * includes, before it is laid under the file that asked for it. So the order of names is that of
 * the file itself, then that of its includes. Of two includes, the first one wins; but a name, such
 * as that of a system, must be defined by one of them alone, since nothing says which one is meant.
 */
#include "option/include.h"

#include <string.h>

#include "option/merge.h"

struct seen {
    uint64_t device, inode;
    bool is_open; /* whether the file is being resolved, so that to include it again is a cycle */
};

struct including {
    struct kiln_reader *reader;
    const struct kiln_option *rows;
    const struct kiln_include_loader *loader;
    struct seen seen[KILN_INCLUDE_MAX_FILES + 1];
    uint32_t seen_count;
};

struct kiln_node *kiln_node_take(struct kiln_node *map, const char *key)
{
    struct kiln_node *before = NULL;
    for (struct kiln_node *entry = map->first; entry; before = entry, entry = entry->next) {
        if (strcmp(entry->key->text, key) != 0)
            continue;
        if (before)
            before->next = entry->next;
        else
            map->first = entry->next;
        if (map->last == entry)
            map->last = before;
        map->count--;
        entry->next = NULL;
        return entry;
    }
    return NULL;
}

static bool refuse_name(struct including *including, const struct kiln_node *name,
                        const struct kiln_node *other)
{
    char place[KILN_PATH_SIZE];
    kiln_node_place(other, place, sizeof place);
    kiln_reader_enter(including->reader, name->text);
    return kiln_reader_error(including->reader, name,
                             "two includes define this name; the other one is at %s", place);
}

/* Checks that no name of `later` is one of `earlier`, at any depth. */
static bool check_names(struct including *including, const struct kiln_node *earlier,
                        const struct kiln_node *later, const struct kiln_option *rows)
{
    for (const struct kiln_option *row = rows; row->name; row++) {
        const struct kiln_node *a = kiln_node_entry(earlier, row->name);
        const struct kiln_node *b = kiln_node_entry(later, row->name);
        if (!a || !b)
            continue;
        const size_t before = kiln_reader_enter(including->reader, row->name);
        const bool of_names = kiln_merge_is_of_names(row, a) && kiln_merge_is_of_names(row, b);
        for (const struct kiln_node *entry = of_names ? b->first : NULL; entry;
             entry = entry->next) {
            const struct kiln_node *other = kiln_node_entry(a, entry->key->text);
            if (other)
                return refuse_name(including, entry->key, other->key);
        }
        if (row->type == &kiln_type_group && !check_names(including, a, b, row->members))
            return false;
        kiln_reader_leave(including->reader, before);
    }
    return true;
}

static bool refuse_count(struct kiln_reader *reader, const struct kiln_node *node)
{
    return kiln_reader_error(reader, node, "more than the %d included files that are allowed",
                             KILN_INCLUDE_MAX_FILES);
}

static bool resolve(struct including *including, struct kiln_node *root, uint32_t depth);

/* Reads and resolves the file that a scalar names. *root becomes NULL if it was included before. */
static bool read_file(struct including *including, const struct kiln_node *path, uint32_t depth,
                      struct kiln_node **root)
{
    struct kiln_reader *reader = including->reader;
    struct kiln_included file = {0};
    struct kiln_node_link *link = kiln_arena_alloc(reader->scratch, 1, sizeof *link);
    if (!link)
        return kiln_reader_out_of_memory(reader);
    *link = (struct kiln_node_link){"included from", path, path->origin->via};
    if (depth == KILN_INCLUDE_MAX_DEPTH)
        return kiln_reader_error(reader, path, "files are included through more than %d files",
                                 KILN_INCLUDE_MAX_DEPTH);
    if (!including->loader->read(including->loader->user, path, link, &file))
        return false;
    for (uint32_t i = 0; i < including->seen_count; i++) {
        const struct seen *seen = &including->seen[i];
        if (seen->device != file.device || seen->inode != file.inode)
            continue;
        *root = NULL;
        return !seen->is_open || kiln_reader_error(reader, path, "this file includes itself");
    }
    if (including->seen_count > KILN_INCLUDE_MAX_FILES)
        return refuse_count(reader, path);
    const uint32_t index = including->seen_count++;
    including->seen[index] = (struct seen){file.device, file.inode, true};
    *root = kiln_node_parse(reader->scratch, file.text, file.size, file.origin, reader->error);
    if (!*root)
        return false;
    kiln_reader_leave(reader, 0);
    if ((*root)->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, *root, "a mapping of keys");
    if (including->loader->check && !including->loader->check(including->loader->user, *root))
        return false;
    const bool ok = resolve(including, *root, depth + 1);
    including->seen[index].is_open = false;
    return ok;
}

/* Takes `include` out of a mapping and lays its files under the mapping. */
static bool resolve(struct including *including, struct kiln_node *root, uint32_t depth)
{
    struct kiln_reader *reader = including->reader;
    struct kiln_node *include = kiln_node_take(root, "include");
    if (!include)
        return true;
    kiln_reader_leave(reader, 0);
    kiln_reader_enter(reader, "include");
    struct kiln_node *all = kiln_node_create_map(reader->scratch, root->origin);
    if (!all)
        return kiln_reader_out_of_memory(reader);
    const bool is_list = include->kind == KILN_NODE_LIST;
    if (include->count > KILN_INCLUDE_MAX_FILES)
        return refuse_count(reader, include);
    for (const struct kiln_node *path = is_list ? include->first : include; path;
         path = path->next) {
        struct kiln_node *file = NULL;
        kiln_reader_leave(reader, 0);
        kiln_reader_enter(reader, "include");
        if (!kiln_reader_is_text(path))
            return kiln_reader_expected(reader, path, "the path of a file or a list of these");
        if (!read_file(including, path, depth, &file))
            return false;
        kiln_reader_leave(reader, 0);
        if (file && (!check_names(including, all, file, including->rows) ||
                     !kiln_merge_members(all, file, including->rows, reader->error)))
            return false;
    }
    kiln_reader_leave(reader, 0);
    return kiln_merge_members(root, all, including->rows, reader->error);
}

bool kiln_include(struct kiln_reader *reader, const struct kiln_option *rows,
                  struct kiln_node *root, const struct kiln_included *own,
                  const struct kiln_include_loader *loader)
{
    struct including including = {.reader = reader, .rows = rows, .loader = loader};
    including.seen[including.seen_count++] = (struct seen){own->device, own->inode, true};
    return resolve(&including, root, 0);
}
