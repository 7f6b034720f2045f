/* Applies --set key=value to the tree of a scene. It follows the key through the tree and the
 * option tables in parallel. The tables show where the author of a scene chooses names (the entries
 * of a map). Such a name must exist, so that a misspelling does not add an entry. */
#include "option/override.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "option/include.h"
#include "option/merge.h"

enum { MAX_PARTS = 32, MAX_KEY = 256 };

struct override {
    struct kiln_reader *reader;
    const struct kiln_origin *origin;
    const struct kiln_node *value;
    const char *parts[MAX_PARTS]; /* the parts of the key between its dots */
    uint32_t part_count;
    uint32_t set_count; /* places set so far */
    bool has_wildcard;  /* the key has a '*', so a list that the file lacks is skipped */
};

static bool fail(struct override *override, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool fail(struct override *override, const char *format, ...)
{
    char message[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    return kiln_error_set(override->reader->error, KILN_INVALID_INPUT, "%s: %s",
                          override->origin->name, message);
}

/* Copies a tree, so that a later override of one place does not change the other places. */
static struct kiln_node *copy_tree(struct override *override, const struct kiln_node *node)
{
    struct kiln_node *copy = kiln_arena_alloc(override->reader->scratch, 1, sizeof *copy);
    if (!copy) {
        kiln_reader_out_of_memory(override->reader);
        return NULL;
    }
    *copy = *node;
    copy->first = copy->last = copy->next = NULL;
    copy->count = 0;
    for (const struct kiln_node *child = node->first; child; child = child->next) {
        struct kiln_node *child_copy = copy_tree(override, child); /* as deep as
                                                                    * KILN_NODE_MAX_DEPTH */
        if (!child_copy)
            return NULL;
        kiln_node_append(copy, child_copy);
    }
    return copy;
}

/* Replaces the contents of a node, which keeps its key and its neighbours. */
static void replace(struct kiln_node *node, const struct kiln_node *contents)
{
    struct kiln_node *key = node->key, *next = node->next;
    *node = *contents;
    node->key = key;
    node->next = next;
}

static struct kiln_node *add_entry(struct override *override, struct kiln_node *map,
                                   const char *name)
{
    struct kiln_node *key = kiln_arena_alloc(override->reader->scratch, 1, sizeof *key);
    struct kiln_node *entry = kiln_node_create_map(override->reader->scratch, override->origin);
    if (!key || !entry) {
        kiln_reader_out_of_memory(override->reader);
        return NULL;
    }
    *key = (struct kiln_node){.origin = override->origin, .text = name};
    entry->key = key;
    kiln_node_append(map, entry);
    return entry;
}

static bool unknown_name(struct override *override, const struct kiln_node *node, const char *name)
{
    const char *names[64];
    size_t count = 0;
    for (const struct kiln_node *entry = node->first; entry && count < 64; entry = entry->next)
        names[count++] = entry->key->text;
    char suggestion[512];
    kiln_option_suggest(suggestion, sizeof suggestion, name, names, count);
    return fail(override, "there is no key '%s'%s", name, suggestion);
}

/* Describes the keys that are allowed under a node. */
struct allowed_keys {
    const struct kiln_option *members; /* the table of the keys, or NULL if it is not known */
    bool is_fixed;                     /* only keys that the node already has are allowed */
};

static struct allowed_keys allowed_under(const struct kiln_node *node, struct allowed_keys allowed,
                                         const struct kiln_node *child)
{
    if (node->kind == KILN_NODE_LIST) /* the item's one key may be the name of its kind */
        return (struct allowed_keys){.is_fixed = true};
    if (allowed.members &&
        allowed.is_fixed) /* for a named entry, the table is that of its members */
        return (struct allowed_keys){.members = allowed.members};
    const struct kiln_option *option =
        allowed.members ? kiln_option_find(allowed.members, child->key->text) : NULL;
    if (!option)
        return (struct allowed_keys){0};
    return (struct allowed_keys){.members = option->members,
                                 .is_fixed = option->type == &kiln_type_map ||
                                             kiln_merge_is_of_names(option, child)};
}

/* Returns the entry of a list or mapping that a part of the key names; adds it to a mapping that
 * lacks it. Returns NULL with an error on failure. */
static struct kiln_node *find_child(struct override *override, struct kiln_node *node,
                                    struct allowed_keys allowed, const char *name)
{
    if (node->kind == KILN_NODE_LIST) {
        uint64_t index = 0;
        if (!kiln_text_to_uint64(name, &index)) {
            fail(override, "'%s' is not an index into a list", name);
            return NULL;
        }
        if (index >= node->count) {
            fail(override, "there is no entry %s; the list has %u", name, node->count);
            return NULL;
        }
        struct kiln_node *child = node->first;
        while (index--)
            child = child->next;
        return child;
    }
    if (node->kind == KILN_NODE_SCALAR) /* such as "none"; a mapping replaces it */
        replace(node, &(struct kiln_node){.kind = KILN_NODE_MAP, .origin = override->origin});
    struct kiln_node *child = kiln_node_entry(node, name);
    const struct kiln_option *row =
        allowed.members && !allowed.is_fixed ? kiln_option_find(allowed.members, name) : NULL;
    if (child)
        return child;
    if (row && row->instead_of)
        kiln_node_take(node, row->instead_of);
    if (allowed.is_fixed) {
        unknown_name(override, node, name);
        return NULL;
    }
    return add_entry(override, node, name);
}

/* Returns whether `name` is a list by the option table and missing in the file. */
static bool is_missing_list(const struct kiln_node *node, struct allowed_keys allowed,
                            const char *name)
{
    if (!allowed.members || allowed.is_fixed || kiln_node_entry(node, name))
        return false;
    const struct kiln_option *option = kiln_option_find(allowed.members, name);
    return option && option->type == &kiln_type_list;
}

/* Sets all places below node that the key's parts from index `part` on name. */
static bool set_below(struct override *override, struct kiln_node *node,
                      struct allowed_keys allowed, uint32_t part)
{
    if (part == override->part_count) {
        const struct kiln_node *copy = copy_tree(override, override->value);
        if (!copy)
            return false;
        replace(node, copy);
        override->set_count++;
        return true;
    }
    const char *name = override->parts[part];
    if (strcmp(name, "*") != 0) {
        if (is_missing_list(node, allowed, name) && part + 1 < override->part_count)
            return override->has_wildcard ||
                   fail(override, "there is no entry %s; the list is empty",
                        override->parts[part + 1]);
        struct kiln_node *child = find_child(override, node, allowed, name);
        return child && set_below(override, child, allowed_under(node, allowed, child), part + 1);
    }
    for (struct kiln_node *child = node->first; child; child = child->next) {
        struct allowed_keys below = allowed_under(node, allowed, child);
        /* In a list of several kinds, or such a list with names, '*' stands for the entries that
         * have the next part of the key. */
        const bool is_list = node->kind == KILN_NODE_LIST || (allowed.is_fixed && !allowed.members);
        bool fits = !is_list || child->kind != KILN_NODE_MAP || part + 1 == override->part_count ||
                    strcmp(override->parts[part + 1], "*") == 0 ||
                    kiln_node_entry(child, override->parts[part + 1]);
        if (fits && !set_below(override, child, below, part + 1))
            return false;
    }
    return true;
}

/* Splits the key at its dots into override->parts. */
static bool split_key(struct override *override, char *key)
{
    for (char *part = key; part;) {
        if (override->part_count == MAX_PARTS)
            return fail(override, "a key has at most %d parts", MAX_PARTS);
        override->parts[override->part_count++] = part;
        char *dot = strchr(part, '.');
        if (dot)
            *dot = '\0';
        if (*part == '\0')
            return fail(override, "a part of the key is empty");
        override->has_wildcard |= strcmp(part, "*") == 0;
        part = dot ? dot + 1 : NULL;
    }
    return true;
}

/* Returns whether a value is a colour such as #e61e28. In YAML, '#' would begin a comment. */
static bool is_hex_color(const char *value)
{
    return value[0] == '#' && value[1] != '\0' &&
           value[1 + strspn(value + 1, "0123456789abcdefABCDEF")] == '\0';
}

struct kiln_node *kiln_override_value(struct kiln_reader *reader, const char *text,
                                      const struct kiln_origin **origin)
{
    struct kiln_arena *arena = reader->scratch;
    char quoted[64];
    const char *equals = strchr(text, '=');
    bool printable = equals != NULL;
    for (const char *c = text; printable && c < equals; c++)
        printable = *c >= 0x20 && *c <= 0x7e;
    if (!printable || equals == text || equals - text > MAX_KEY) {
        kiln_node_quote(quoted, text);
        kiln_error_set(reader->error, KILN_USAGE, "--set %s: expected KEY=VALUE", quoted);
        return NULL;
    }
    char *name = kiln_arena_format(arena, "--set %.*s", (int)(equals - text), text);
    struct kiln_origin *own = kiln_arena_alloc(arena, 1, sizeof *own);
    char *value = is_hex_color(equals + 1) ? kiln_arena_format(arena, "\"%s\"", equals + 1)
                                           : kiln_arena_text(arena, equals + 1, strlen(equals + 1));
    if (!name || !own || !value) {
        kiln_reader_out_of_memory(reader);
        return NULL;
    }
    *own = (struct kiln_origin){.name = name, .kind = reader->origin->kind};
    *origin = own;
    return kiln_node_parse(arena, value, strlen(value), own, reader->error);
}

bool kiln_override(struct kiln_reader *reader, const struct kiln_option *rows,
                   struct kiln_node *root, const char *text)
{
    struct override override = {.reader = reader};
    override.value = kiln_override_value(reader, text, &override.origin);
    char *key = override.value ? kiln_arena_text(reader->scratch, text, strcspn(text, "=")) : NULL;
    if (override.value && !key)
        return kiln_reader_out_of_memory(reader);
    if (!override.value || !split_key(&override, key) ||
        !set_below(&override, root, (struct allowed_keys){.members = rows}, 0))
        return false;
    return override.set_count > 0 || fail(&override, "no key of the scene has this name");
}
