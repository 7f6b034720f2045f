/* Lists the keys that differ between two scenes. Both scenes become ordered lists of dotted keys,
 * which are merged side by side. The scene as it is has behind each line the file and line that it
 * comes from (kiln_scene_print_origins), which says where to look for a change. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/options.h"
#include "suite/test_case.h"

struct entry {
    const char *key, *value;
    uint32_t line; /* of the value in its text */
};

struct flattening {
    struct kiln_arena *arena;
    struct entry *entries;
    size_t count, capacity;
    bool failed;
};

static bool is_plain_list(const struct kiln_node *node)
{
    for (const struct kiln_node *child = node->first; child; child = child->next) {
        if (child->kind != KILN_NODE_SCALAR)
            return false;
    }
    return true;
}

/* Returns the text of a scalar, a list of scalars, or an empty list or map, as a scene would say
 * it. */
static const char *value_text(struct kiln_arena *arena, const struct kiln_node *node)
{
    if (node->kind == KILN_NODE_SCALAR)
        return node->text;
    struct kiln_text text = {0};
    kiln_text_add(&text, node->kind == KILN_NODE_LIST ? "[" : "{");
    for (const struct kiln_node *child = node->first; child; child = child->next)
        kiln_text_add(&text, "%s%s", child == node->first ? "" : ", ", child->text);
    kiln_text_add(&text, node->kind == KILN_NODE_LIST ? "]" : "}");
    const char *copy = text.failed ? NULL : kiln_arena_text(arena, text.data, text.length);
    kiln_text_free(&text);
    return copy;
}

static void add_entry(struct flattening *f, const char *key, const struct kiln_node *node)
{
    const char *value = value_text(f->arena, node);
    if (f->count == f->capacity) {
        size_t capacity = f->capacity ? 2 * f->capacity : 256;
        struct entry *entries = realloc(f->entries, capacity * sizeof *entries);
        f->failed = f->failed || !entries;
        if (!entries)
            return;
        f->entries = entries;
        f->capacity = capacity;
    }
    f->failed = f->failed || !value;
    f->entries[f->count++] = (struct entry){key, value ? value : "", node->line};
}

static const char *join(struct kiln_arena *arena, const char *path, const char *name)
{
    size_t length = strlen(path), rest = strlen(name);
    char *key = kiln_arena_alloc(arena, length + rest + 2, 1);
    if (key)
        snprintf(key, length + rest + 2, "%s%s%s", path, length ? "." : "", name);
    return key;
}

/* Adds entries for all keys below a node. The parser limits the depth of nodes, and with it the
 * recursion. */
static void flatten(struct flattening *f, const char *path, const struct kiln_node *node)
{
    if (node->kind == KILN_NODE_SCALAR || !node->first ||
        (node->kind == KILN_NODE_LIST && is_plain_list(node))) {
        add_entry(f, path, node);
        return;
    }
    size_t index = 0;
    for (const struct kiln_node *child = node->first; child; child = child->next, index++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", index);
        const char *key = join(f->arena, path, child->key ? child->key->text : number);
        f->failed = f->failed || !key;
        if (f->failed)
            return;
        flatten(f, key, child);
    }
}

static int compare_entries(const void *a, const void *b)
{
    return strcmp(((const struct entry *)a)->key, ((const struct entry *)b)->key);
}

static bool read_entries(struct flattening *f, const char *text, const char *name,
                         struct kiln_error *error)
{
    struct kiln_origin *origin = kiln_arena_alloc(f->arena, 1, sizeof *origin);
    if (!origin)
        return kiln_error_no_memory(error, "%s", name);
    *origin = kiln_scene_origin(name);
    const struct kiln_node *root = kiln_node_parse(f->arena, text, strlen(text), origin, error);
    if (!root)
        return false;
    flatten(f, "", root);
    if (f->failed)
        return kiln_error_no_memory(error, "%s", name);
    if (f->count > 0)
        qsort(f->entries, f->count, sizeof *f->entries, compare_entries);
    return true;
}

/* Returns the comment at the end of a line of a text, which says where the line comes from, or
 * "". */
static const char *comment_of(struct kiln_arena *arena, const char *text, uint32_t line)
{
    static const char sign[] = "  # ";
    while (line-- > 1)
        text += strcspn(text, "\n") + 1;
    const size_t length = strcspn(text, "\n");
    const char *found = NULL;
    for (const char *at = text; (at = strstr(at, sign)) && at < text + length; at++)
        found = at + sizeof sign - 1;
    const char *place =
        found ? kiln_arena_text(arena, found, (size_t)(text + length - found)) : NULL;
    return place ? place : "";
}

/* `text` is the one that `after` was read from. */
static size_t merge(const struct flattening *before, const struct flattening *after,
                    const char *text, struct kiln_result_change *changes)
{
    size_t i = 0, k = 0, count = 0;
    while (i < before->count || k < after->count) {
        const struct entry *a = i < before->count ? &before->entries[i] : NULL;
        const struct entry *b = k < after->count ? &after->entries[k] : NULL;
        int order = !a ? 1 : !b ? -1 : strcmp(a->key, b->key);
        i += order <= 0;
        k += order >= 0;
        if (order == 0 && strcmp(a->value, b->value) == 0)
            continue;
        changes[count++] = (struct kiln_result_change){
            .key = order <= 0 ? a->key : b->key,
            .before = order <= 0 ? a->value : "",
            .after = order >= 0 ? b->value : "",
            .place = order >= 0 ? comment_of(after->arena, text, b->line) : ""};
    }
    return count;
}

bool kiln_scene_diff(struct kiln_arena *arena, const char *before, const char *name,
                     const char *after, struct kiln_result_change **changes, size_t *count,
                     struct kiln_error *error)
{
    struct flattening a = {.arena = arena}, b = {.arena = arena};
    bool ok = read_entries(&a, before, name, error) &&
              read_entries(&b, after, "the scene as it is", error);
    if (ok) {
        *changes = kiln_arena_alloc(arena, a.count + b.count + 1, sizeof **changes);
        ok = *changes != NULL;
        if (ok)
            *count = merge(&a, &b, after, *changes);
        else
            kiln_error_no_memory(error, "%s", name);
    }
    free(a.entries);
    free(b.entries);
    return ok;
}
