/* Implements the option types that hold other options: group, switch, map, list. */
#include <string.h>

#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"

/* ---- group ---------------------------------------------------------------------------------- */

static bool read_group(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, void *field)
{
    return kiln_read_members(reader, option->members, node, field);
}

static void print_group(struct kiln_printer *printer, const struct kiln_option *option,
                        const void *field)
{
    kiln_text_add(&printer->text, "\n");
    printer->after_dash = false;
    printer->indent += 2;
    kiln_print_members(printer, option->members, field);
    printer->indent -= 2;
}

static void describe_group(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "a mapping of keys");
}

static void schema_group(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_schema_members(option->members, NULL, false, out);
}

const struct kiln_option_type kiln_type_group = {
    .read = read_group,
    .print = print_group,
    .describe = describe_group,
    .schema = schema_group,
};

/* ---- switch: a group that may be absent ------------------------------------------------------ */

static bool read_switch(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    bool *enabled = (bool *)((char *)field - option->offset + option->count_offset);
    bool none = kiln_node_is(node, "none");
    if (!none && node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    *enabled = !none;
    return kiln_read_members(reader, option->members, none ? NULL : node, field);
}

static void print_switch(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    if (*(const bool *)((const char *)field - option->offset + option->count_offset))
        print_group(printer, option, field);
    else
        kiln_text_add(&printer->text, " none\n");
}

static void describe_switch(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "a mapping of keys, or none");
}

static void schema_switch(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [{\"const\": \"none\"}, ");
    kiln_schema_members(option->members, NULL, false, out);
    kiln_text_add(out, "]}");
}

static void list_switch(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "none");
}

const struct kiln_option_type kiln_type_switch = {
    .read = read_switch,
    .print = print_switch,
    .describe = describe_switch,
    .schema = schema_switch,
    .list_choices = list_switch,
};

/* ---- map: named entries; an entry's struct starts with its name ------------------------------ */

enum { MAX_NAME = 32 };
#define NAME_PATTERN "^[A-Za-z_][A-Za-z0-9_-]{0,%d}$"

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool kiln_option_is_name(const char *text)
{
    size_t length = strlen(text);
    if (length == 0 || length > MAX_NAME || !is_letter(*text))
        return false;
    for (const char *c = text; *c; c++) {
        if (!is_letter(*c) && !(*c >= '0' && *c <= '9') && *c != '-')
            return false;
    }
    return true;
}

/* Returns the counter of entries, which the caller increases after reading each entry, or NULL with
 * an error if the node has too many entries. */
static uint32_t *begin_entries(struct kiln_reader *reader, const struct kiln_option *option,
                               const struct kiln_node *node, void *field)
{
    if (node->count <= option->max_count)
        return kiln_option_count_field(option, field);
    kiln_reader_error(reader, node, "found %u entries; at most %zu are allowed", node->count,
                      option->max_count);
    return NULL;
}

static bool refuse_name(struct kiln_reader *reader, const struct kiln_node *key)
{
    return kiln_reader_error(reader, key,
                             "a name starts with a letter and has at most %d letters, digits, '_' "
                             "and '-'",
                             MAX_NAME);
}

static bool read_map(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, void *field)
{
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    uint32_t *count = begin_entries(reader, option, node, field);
    const uint32_t outer = reader->item;
    if (!count)
        return false;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        void *item = (char *)field + *count * option->item_size;
        const char *name = entry->key->text;
        reader->item = option->is_counted ? *count : outer;
        size_t before = kiln_reader_enter(reader, name);
        if (!kiln_option_is_name(name))
            return refuse_name(reader, entry->key);
        if (!kiln_reader_copy_text(reader, name, item) ||
            !kiln_read_members(reader, option->members, entry, item))
            return false;
        kiln_reader_leave(reader, before);
        ++*count;
    }
    reader->item = outer;
    return true;
}

static void print_map(struct kiln_printer *printer, const struct kiln_option *option,
                      const void *field)
{
    uint32_t count = kiln_option_count(option, field);
    kiln_text_add(&printer->text, count ? "\n" : " {}\n");
    printer->indent += 2;
    for (uint32_t i = 0; i < count; i++) {
        const void *item = (const char *)field + i * option->item_size;
        const char *name;
        memcpy(&name, item, sizeof name);
        kiln_print_key(printer, name);
        print_group(printer, option, item);
    }
    printer->indent -= 2;
}

static void describe_map(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a mapping of up to %zu names to mappings of keys", option->max_count);
}

static void schema_map(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"type\": \"object\", \"maxProperties\": %zu, \"propertyNames\": "
                  "{\"pattern\": \"" NAME_PATTERN "\"}, \"additionalProperties\": ",
                  option->max_count, MAX_NAME - 1);
    kiln_schema_members(option->members, NULL, false, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_map = {
    .read = read_map,
    .print = print_map,
    .describe = describe_map,
    .schema = schema_map,
};

/* ---- list ----------------------------------------------------------------------------------- */

/* Reads the name of an entry of a list that is written as a mapping. */
static bool read_name(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *key, void *item)
{
    if (!kiln_option_is_name(key->text))
        return refuse_name(reader, key);
    return kiln_reader_copy_text(reader, key->text,
                                 (const char **)((char *)item + option->name_offset));
}

static bool read_list(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    const bool of_names = option->is_named && node->kind == KILN_NODE_MAP;
    if (node->kind != KILN_NODE_LIST && !of_names)
        return kiln_reader_mismatch(reader, option, node);
    uint32_t *count = begin_entries(reader, option, node, field);
    const uint32_t outer = reader->item;
    if (!count)
        return false;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        void *item = (char *)field + *count * option->item_size;
        size_t before = of_names ? kiln_reader_enter(reader, entry->key->text)
                                 : kiln_reader_enter_index(reader, *count);
        if (of_names && !read_name(reader, option, entry->key, item))
            return false;
        reader->item = *count;
        if (!option->item->type->read(reader, option->item, entry, item))
            return false;
        kiln_reader_leave(reader, before);
        ++*count;
    }
    reader->item = outer;
    return true;
}

/* Returns the name of an entry of a list that was written as a mapping; otherwise NULL. */
static const char *name_of(const struct kiln_option *option, const void *item)
{
    const char *name = NULL;
    if (option->is_named)
        memcpy(&name, (const char *)item + option->name_offset, sizeof name);
    return name;
}

static void print_list(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    uint32_t count = kiln_option_count(option, field);
    kiln_text_add(&printer->text, count ? "\n" : " []\n");
    printer->indent += 2;
    for (uint32_t i = 0; i < count; i++) {
        const void *item = (const char *)field + i * option->item_size;
        const char *name = name_of(option, item);
        if (!kiln_print_wants(printer, option->item, item))
            continue;
        if (name)
            kiln_print_key(printer, name);
        else
            kiln_text_add(&printer->text, "%*s-", (int)printer->indent, "");
        printer->after_dash = !name;
        option->item->type->print(printer, option->item, item);
    }
    printer->after_dash = false;
    printer->indent -= 2;
}

static void describe_list(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a list of up to %zu%s: ", option->max_count,
                  option->is_named ? ", or a mapping of names to these" : "");
    option->item->type->describe(option->item, out);
}

static void schema_list(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_text item = {0};
    option->item->type->schema(option->item, &item);
    const char *of = item.data ? item.data : "";
    if (option->is_named)
        kiln_text_add(out,
                      "{\"anyOf\": [{\"type\": \"object\", \"maxProperties\": %zu, "
                      "\"propertyNames\": {\"pattern\": \"" NAME_PATTERN
                      "\"}, \"additionalProperties\": {\"anyOf\": [%s, {\"type\": \"object\", "
                      "\"required\": [\"use\"]}]}}, ",
                      option->max_count, MAX_NAME - 1, of);
    kiln_text_add(out, "{\"type\": \"array\", \"maxItems\": %zu, \"items\": %s}%s",
                  option->max_count, of, option->is_named ? "]}" : "");
    out->failed |= item.failed;
    kiln_text_free(&item);
}

const struct kiln_option_type kiln_type_list = {
    .read = read_list,
    .print = print_list,
    .describe = describe_list,
    .schema = schema_list,
};
