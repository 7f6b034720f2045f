/* Implements the option type of items of several kinds, such as `cone: {angle: 8 deg}`: a mapping
 * whose one key names the kind and whose value fills the members of that kind. A kind may have a
 * shortcut, which is the member that a bare value fills: `gravity: [0, -9.81, 0]`. Of several kinds
 * of one name, `wind: {field: baked, cells: 32}` chooses one, and so does `wind: {baked: {cells:
 * 32}}`. A variant that has a member of its own name is chosen by that: `wind: {gas: fire}`. */
#include <string.h>

#include "option/animated.h"
#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"

static size_t kind_names(const struct kiln_option_kind *kinds, const char *names[32])
{
    size_t count = 0;
    for (; kinds->name && count < 32; kinds++) {
        if (count == 0 || strcmp(names[count - 1], kinds->name) != 0)
            names[count++] = kinds->name;
    }
    return count;
}

/* Returns whether a variant has a member of its own name, which then chooses it. */
static bool has_member_of_name(const struct kiln_option_kind *kind)
{
    return kind->variant && kiln_option_find(kind->members, kind->variant);
}

const struct kiln_option_kind *kiln_option_variant_by_member(const struct kiln_option_kind *kinds,
                                                             const char *name,
                                                             const struct kiln_node *node)
{
    for (; kinds->name && node->kind == KILN_NODE_MAP; kinds++) {
        if (strcmp(kinds->name, name) == 0 && has_member_of_name(kinds) &&
            kiln_node_entry(node, kinds->variant))
            return kinds;
    }
    return NULL;
}

const struct kiln_node *kiln_option_variant_inside(const struct kiln_option_kind *kinds,
                                                   const char *name, const struct kiln_node *node)
{
    if (node->kind != KILN_NODE_MAP || node->count != 1)
        return NULL;
    for (; kinds->name; kinds++) {
        if (kinds->variant && !has_member_of_name(kinds) && strcmp(kinds->name, name) == 0 &&
            strcmp(kinds->variant, node->first->key->text) == 0)
            return node->first;
    }
    return NULL;
}

/* Returns the row of a variant, or NULL. */
static const struct kiln_option_kind *find_variant(const struct kiln_option *option,
                                                   const char *name, const char *variant)
{
    for (const struct kiln_option_kind *kind = option->kinds; kind->name; kind++) {
        if (kind->variant && strcmp(kind->name, name) == 0 && strcmp(kind->variant, variant) == 0)
            return kind;
    }
    return NULL;
}

/* Returns the row of the kind that the node's key names. If several kinds have that name, the key
 * `field` chooses the variant, or a key inside of the node. Returns NULL with an error on failure.
 */
static const struct kiln_option_kind *find_kind(struct kiln_reader *reader,
                                                const struct kiln_option *option,
                                                const struct kiln_node *node,
                                                const struct kiln_node *inside)
{
    const char *name = node->key->text;
    const struct kiln_node *field = inside ? inside->key : kiln_node_entry(node, "field");
    const struct kiln_option_kind *by_member =
        field ? NULL : kiln_option_variant_by_member(option->kinds, name, node);
    if (by_member)
        return by_member;
    const struct kiln_option_kind *first = NULL;
    const char *variants[32];
    size_t variant_count = 0;
    for (const struct kiln_option_kind *kind = option->kinds; kind->name; kind++) {
        if (strcmp(kind->name, name) != 0)
            continue;
        first = first ? first : kind;
        if (!kind->variant || !field)
            return first;
        if (kiln_node_is(field, kind->variant))
            return kind;
        variants[variant_count++] = kind->variant;
    }
    kiln_reader_enter(reader, name);
    char suggestion[512], quoted[64];
    if (first) {
        kiln_reader_enter(reader, "field");
        if (field->kind != KILN_NODE_SCALAR) {
            kiln_reader_expected(reader, field, "a word");
            return NULL;
        }
        kiln_node_quote(quoted, field->text);
        kiln_option_suggest(suggestion, sizeof suggestion, field->text, variants, variant_count);
        kiln_reader_error(reader, field, "unknown word '%s'%s", quoted, suggestion);
        return NULL;
    }
    const char *names[32];
    size_t count = kind_names(option->kinds, names);
    kiln_option_suggest(suggestion, sizeof suggestion, name, names, count);
    kiln_reader_error(reader, node->key, "unknown kind%s", suggestion);
    return NULL;
}

/* Refuses two ways to choose a variant in one mapping: keys that stand beside the variant's own
 * mapping, {baked: {...}, attach: n}, and such a mapping beside {field: baked}. */
static bool check_spelling(struct kiln_reader *reader, const struct kiln_option *option,
                           const struct kiln_node *node)
{
    const char *name = node->key->text;
    const struct kiln_option_kind *kind = NULL;
    const struct kiln_node *variant = NULL, *beside = NULL;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        const bool is_map = !kind && entry->kind == KILN_NODE_MAP;
        const struct kiln_option_kind *found =
            is_map ? find_variant(option, name, entry->key->text) : NULL;
        kind = found ? found : kind;
        variant = found ? entry : variant;
        beside = found || beside ? beside : entry;
    }
    if (!variant || !beside)
        return true;
    const bool by_field = kiln_node_entry(node, "field") != NULL;
    const struct kiln_node *wrong = by_field ? variant : beside;
    const char *key = wrong->key->text;
    if (by_field)
        key = variant->first ? variant->first->key->text : kind->members->name;
    else if (!kiln_option_find(kind->members, key))
        key = kind->members->name;
    kiln_reader_enter(reader, name);
    kiln_reader_enter(reader, wrong->key->text);
    return kiln_reader_error(reader, wrong->key,
                             "must not stand beside `%s`, which chooses the kind; its keys stand "
                             "%s, such as %s.%s%s%s",
                             by_field ? "field" : kind->variant,
                             by_field ? "beside it, too" : "inside of it", name,
                             by_field ? "" : kind->variant, by_field ? "" : ".", key);
}

/* Copies a mapping without the key `field`, which only chooses the kind. */
static struct kiln_node *remove_field(struct kiln_reader *reader, const struct kiln_node *node)
{
    struct kiln_node *rest = kiln_arena_alloc(reader->scratch, 1, sizeof *rest);
    if (!rest) {
        kiln_reader_out_of_memory(reader);
        return NULL;
    }
    *rest = *node;
    rest->first = rest->last = NULL;
    rest->count = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        if (strcmp(entry->key->text, "field") == 0)
            continue;
        struct kiln_node *copy = kiln_arena_alloc(reader->scratch, 1, sizeof *copy);
        if (!copy) {
            kiln_reader_out_of_memory(reader);
            return NULL;
        }
        *copy = *entry;
        copy->next = NULL;
        kiln_node_append(rest, copy);
    }
    return rest;
}

/* Returns the mapping {shortcut: value} for a bare value. */
static struct kiln_node *expand_shortcut(struct kiln_reader *reader, const struct kiln_node *node,
                                         const char *shortcut)
{
    struct kiln_node *map = kiln_node_create_map(reader->scratch, node->origin);
    struct kiln_node *key = kiln_arena_alloc(reader->scratch, 1, sizeof *key);
    struct kiln_node *value = kiln_arena_alloc(reader->scratch, 1, sizeof *value);
    if (!map || !key || !value) {
        kiln_reader_out_of_memory(reader);
        return NULL;
    }
    *key = (struct kiln_node){.origin = node->origin, .text = shortcut};
    *value = *node;
    value->key = key;
    value->next = NULL;
    map->line = node->line;
    map->column = node->column;
    kiln_node_append(map, value);
    return map;
}

static bool read_kind(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count == 0)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count > 1) {
        char first[64], second[64];
        kiln_node_quote(first, node->first->key->text);
        kiln_node_quote(second, node->first->next->key->text);
        return kiln_reader_error(reader, node->first->next->key,
                                 "expected one kind, found '%s' and '%s'", first, second);
    }
    const struct kiln_node *value = node->first;
    if (value->kind == KILN_NODE_MAP && !check_spelling(reader, option, value))
        return false;
    const struct kiln_node *inside =
        kiln_option_variant_inside(option->kinds, value->key->text, value);
    const struct kiln_option_kind *kind = find_kind(reader, option, value, inside);
    if (!kind)
        return false;
    memcpy((char *)field + option->kind_offset, &kind->value, sizeof kind->value);
    size_t before = kiln_reader_enter(reader, kind->name);
    if (inside) {
        kiln_reader_enter(reader, kind->variant);
        value = inside;
    }
    if (kind->shortcut && (value->kind != KILN_NODE_MAP || kiln_node_is_animated(value)))
        value = expand_shortcut(reader, value, kind->shortcut);
    else if (kind->variant && kiln_node_entry(value, "field"))
        value = remove_field(reader, value);
    if (!value || !kiln_read_members(reader, kind->members, value, field))
        return false;
    kiln_reader_leave(reader, before);
    return true;
}

static const struct kiln_option_kind *kind_of(const struct kiln_option *option, const void *field)
{
    const struct kiln_option_kind *kind = option->kinds;
    int value;
    memcpy(&value, (const char *)field + option->kind_offset, sizeof value);
    while (kind->value != value)
        kind++;
    return kind;
}

/* Returns whether a kind is printed with `field`, because without it another variant would be
 * read. */
static bool needs_field(const struct kiln_option *option, const struct kiln_option_kind *kind)
{
    if (has_member_of_name(kind))
        return false;
    const struct kiln_option_kind *first = option->kinds;
    while (strcmp(first->name, kind->name) != 0)
        first++;
    return first != kind;
}

static void print_kind(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    const struct kiln_option_kind *kind = kind_of(option, field);
    unsigned before = printer->indent;
    printer->indent += 2;
    if (printer->after_dash) { /* print "- gravity:" in one line */
        printer->after_dash = false;
        kiln_text_add(&printer->text, " %s:\n", kind->name);
    } else {
        kiln_text_add(&printer->text, "\n");
        kiln_print_key(printer, kind->name);
        kiln_text_add(&printer->text, "\n");
    }
    printer->indent += 2;
    if (needs_field(option, kind)) {
        kiln_print_key(printer, "field");
        kiln_text_add(&printer->text, " %s\n", kind->variant);
    }
    kiln_print_members(printer, kind->members, field);
    printer->indent = before;
}

static void describe_kind(const struct kiln_option *option, struct kiln_text *out)
{
    const char *names[32];
    size_t count = kind_names(option->kinds, names);
    for (size_t i = 0; i < count; i++)
        kiln_text_add(out, "%s%s", i == 0 ? "{" : i + 1 < count ? ", " : " or ", names[i]);
    kiln_text_add(out, ": {...}}");
}

/* Appends another way to write a variant: `wind: {grid: {...}}`. */
static void schema_inside(const struct kiln_option_kind *kind, struct kiln_text *out)
{
    static const char object[] = "{\"type\": \"object\", \"additionalProperties\": false, "
                                 "\"required\": [\"%s\"], \"properties\": {\"%s\": ";
    kiln_text_add(out, ", ");
    kiln_text_add(out, object, kind->name, kind->name);
    kiln_text_add(out, object, kind->variant, kind->variant);
    kiln_schema_members(kind->members, NULL, false, out);
    kiln_text_add(out, "}}}}");
}

static void schema_kind(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [");
    const char *before = "";
    for (const struct kiln_option_kind *kind = option->kinds; kind->name; kind++) {
        kiln_text_add(out,
                      "%s{\"type\": \"object\", \"additionalProperties\": false, \"required\": "
                      "[\"%s\"], \"properties\": {\"%s\": ",
                      kind == option->kinds ? "" : ", ", kind->name, kind->name);
        if (kind->shortcut) {
            const struct kiln_option *member = kiln_option_find(kind->members, kind->shortcut);
            kiln_text_add(out, "{\"anyOf\": [");
            member->type->schema(member, out);
            kiln_text_add(out, ", ");
        }
        /* A kind without `field` is its first variant. */
        bool needed = kind->variant && strcmp(before, kind->name) == 0 && !has_member_of_name(kind);
        kiln_schema_members(kind->members, kind->variant, needed, out);
        kiln_text_add(out, kind->shortcut ? "]}}}" : "}}");
        if (kind->variant && !has_member_of_name(kind))
            schema_inside(kind, out);
        before = kind->name;
    }
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_kind = {
    .read = read_kind,
    .print = print_kind,
    .describe = describe_kind,
    .schema = schema_kind,
};
