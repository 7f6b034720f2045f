/* Holds the helpers that the readers of all types share: they keep the path for errors, parse
 * defaults and numbers, and fill a struct. */
#include "option/reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/log.h"
#include "option/expression.h"

/* ---- path and errors ------------------------------------------------------------------------- */

size_t kiln_reader_enter(struct kiln_reader *reader, const char *name)
{
    size_t before = reader->path_length;
    char quoted[64];
    kiln_node_quote(quoted, name);
    int added = snprintf(reader->path + before, sizeof reader->path - before, "%s%s",
                         before ? "." : "", quoted);
    size_t length = before + (added > 0 ? (size_t)added : 0);
    reader->path_length = length < sizeof reader->path ? length : sizeof reader->path - 1;
    return before;
}

size_t kiln_reader_enter_index(struct kiln_reader *reader, uint32_t index)
{
    char name[16];
    snprintf(name, sizeof name, "%u", index);
    return kiln_reader_enter(reader, name);
}

void kiln_reader_leave(struct kiln_reader *reader, size_t length)
{
    reader->path_length = length;
    reader->path[length] = '\0';
}

/* Appends a path of names that are known to be short, such as "emit.rate". */
static void enter_rest(struct kiln_reader *reader, const char *path)
{
    const size_t before = reader->path_length;
    snprintf(reader->path + before, sizeof reader->path - before, "%s%s", before ? "." : "", path);
    reader->path_length = strlen(reader->path);
}

bool kiln_reader_error(struct kiln_reader *reader, const struct kiln_node *node, const char *format,
                       ...)
{
    char message[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    /* The path is left out if the origin's name ends with it, as in "--set camera.fov: ...". */
    const char *name = node->origin->name;
    size_t name_length = strlen(name);
    bool path_is_in_name = !node->origin->has_lines && name_length >= reader->path_length &&
                           strcmp(name + name_length - reader->path_length, reader->path) == 0;
    if (path_is_in_name || reader->path_length == 0)
        return kiln_node_error(node, reader->error, "%s", message);
    return kiln_node_error(node, reader->error, "%s: %s", reader->path, message);
}

/* Returns the entry with this number, or NULL if the name is no number or there are too few. */
static const struct kiln_node *entry_of_number(const struct kiln_node *list, const char *name)
{
    const struct kiln_node *entry = list->first;
    if (*name == '\0' || name[strspn(name, "0123456789")] != '\0')
        return NULL;
    for (unsigned long i = strtoul(name, NULL, 10); i > 0 && entry; i--)
        entry = entry->next;
    return entry;
}

/* Returns the entry of a list or mapping that a part of a path names. Entries of a mapping that
 * stands for a list (rows.h, NAMED_LIST) have numbers, too; *name then becomes the entry's name. */
static const struct kiln_node *find_part(const struct kiln_node *node, const char **name)
{
    if (node->kind == KILN_NODE_LIST)
        return entry_of_number(node, *name);
    const struct kiln_node *found = kiln_node_entry(node, *name);
    if (!found && node->kind == KILN_NODE_MAP && (found = entry_of_number(node, *name)))
        *name = found->key->text;
    return found;
}

/* Returns the one entry of a mapping that is an entry of a list: an entry of kinds has one key, and
 * a kind may have several names. *name then becomes the one that the file has. */
static const struct kiln_node *find_other_name(const struct kiln_node *node, const char **name)
{
    if (node->kind != KILN_NODE_MAP || node->count != 1)
        return NULL;
    *name = node->first->key->text;
    return node->first;
}

/* Returns the entry of a mapping that has the name a level deeper: a path names `wind.cells` also
 * where the file has `wind: {baked: {cells: 32}}`. Otherwise returns NULL. */
static const struct kiln_node *find_between(const struct kiln_node *node, const char *name)
{
    const bool single = node->kind == KILN_NODE_MAP && node->count == 1;
    const bool deeper = single && node->first->kind == KILN_NODE_MAP &&
                        !kiln_node_entry(node, name) && kiln_node_entry(node->first, name);
    return deeper ? node->first : NULL;
}

/* Sets the error to a message about the node that a path leads to, or about the last one on the way
 * that exists. */
static void set_error_at(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                         const char *format, va_list args)
{
    char message[KILN_MESSAGE_SIZE], part[64];
    vsnprintf(message, sizeof message, format, args);
    const struct kiln_node *node = root;
    bool is_numbered = false;
    kiln_reader_leave(reader, 0);
    while (*path) {
        size_t length = strcspn(path, ".");
        snprintf(part, sizeof part, "%.*s", (int)length, path);
        const char *name = part;
        const struct kiln_node *between = find_between(node, part);
        if (between) {
            kiln_reader_enter(reader, between->key->text);
            node = between;
        }
        const struct kiln_node *next = find_part(node, &name);
        if (!next && is_numbered)
            next = find_other_name(node, &name);
        if (!next)
            break;
        is_numbered = part[strspn(part, "0123456789")] == '\0';
        node = next;
        kiln_reader_enter(reader, name);
        path += length + (path[length] == '.');
    }
    if (*path)
        enter_rest(reader, path);
    kiln_reader_error(reader, node, "%s", message);
}

bool kiln_reader_error_at(struct kiln_reader *reader, const struct kiln_node *root,
                          const char *path, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    set_error_at(reader, root, path, format, args);
    va_end(args);
    return false;
}

void kiln_reader_warn_at(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                         const char *format, ...)
{
    struct kiln_error found = {0}, *kept = reader->error;
    va_list args;
    reader->error = &found;
    va_start(args, format);
    set_error_at(reader, root, path, format, args);
    va_end(args);
    reader->error = kept;
    kiln_log_write(reader->log, KILN_LOG_WARNING, "%s", found.message);
}

bool kiln_reader_out_of_memory(struct kiln_reader *reader)
{
    return kiln_error_no_memory(reader->error, "reading %s", reader->origin->kind);
}

bool kiln_reader_copy_text(struct kiln_reader *reader, const char *text, const char **copy)
{
    *copy = kiln_arena_text(reader->arena, text, strlen(text));
    return *copy || kiln_reader_out_of_memory(reader);
}

bool kiln_reader_expected(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *expected)
{
    if (node->kind == KILN_NODE_LIST)
        return kiln_reader_error(reader, node, "expected %s, found a list", expected);
    if (node->kind == KILN_NODE_MAP)
        return kiln_reader_error(reader, node, "expected %s, found a mapping", expected);
    if (*node->text == '\0' && !node->quoted)
        return kiln_reader_error(reader, node, "expected %s, found nothing", expected);
    char quoted[64];
    kiln_node_quote(quoted, node->text);
    if (node->quoted)
        return kiln_reader_error(reader, node, "expected %s, found the text \"%s\"", expected,
                                 quoted);
    return kiln_reader_error(reader, node, "expected %s, found '%s'", expected, quoted);
}

bool kiln_reader_mismatch(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node)
{
    struct kiln_text expected = {0};
    option->type->describe(option, &expected);
    if (option->clocks & KILN_ALLOW_TIME)
        kiln_text_add(&expected, ", or {keys: {time: value}}");
    if (option->clocks & KILN_ALLOW_LIFE)
        kiln_text_add(&expected, ", or {life: [...]}");
    if (expected.failed || !expected.data)
        kiln_reader_out_of_memory(reader);
    else
        kiln_reader_expected(reader, node, expected.data);
    kiln_text_free(&expected);
    return false;
}

/* ---- defaults -------------------------------------------------------------------------------- */

/* Holds the tree of a default. A reader parses each default only once, however many entries of a
 * map or list use it. */
struct kiln_default {
    struct kiln_default *next;
    const struct kiln_option *option;
    const struct kiln_node *node;
};

static const struct kiln_node *parse_default(struct kiln_reader *reader,
                                             const struct kiln_option *option)
{
    static const struct kiln_origin origin = {.name = "(default)", .kind = "a default"};
    for (struct kiln_default *cached = reader->defaults; cached; cached = cached->next) {
        if (cached->option == option)
            return cached->node;
    }
    struct kiln_default *added = kiln_arena_alloc(reader->scratch, 1, sizeof *added);
    if (!added) {
        kiln_reader_out_of_memory(reader);
        return NULL;
    }
    added->option = option;
    added->node = kiln_node_parse(reader->scratch, option->fallback, strlen(option->fallback),
                                  &origin, reader->error);
    added->next = reader->defaults;
    reader->defaults = added;
    return added->node;
}

/* ---- structs -------------------------------------------------------------------------------- */

static bool check_keys(struct kiln_reader *reader, const struct kiln_option *members,
                       const struct kiln_node *node)
{
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        const struct kiln_option *row = kiln_option_find(members, entry->key->text);
        if (row && row->instead_of && kiln_node_entry(node, row->instead_of)) {
            kiln_reader_enter(reader, entry->key->text);
            return kiln_reader_error(reader, entry->key, "cannot be given together with `%s`",
                                     row->instead_of);
        }
        if (row)
            continue;
        const char *names[64];
        size_t count = 0;
        for (row = members; row->name && count < 64; row++)
            names[count++] = row->name;
        char suggestion[512];
        kiln_option_suggest(suggestion, sizeof suggestion, entry->key->text, names, count);
        kiln_reader_enter(reader, entry->key->text);
        return kiln_reader_error(reader, entry->key, "unknown key%s", suggestion);
    }
    return true;
}

/* Returns the tree of the option's default. If there is no default, returns NULL, with an error
 * unless the whole group is absent ("none"; group is NULL). */
static const struct kiln_node *default_of(struct kiln_reader *reader,
                                          const struct kiln_option *option,
                                          const struct kiln_node *group)
{
    if (option->fallback)
        return parse_default(reader, option);
    if (group)
        kiln_reader_error(reader, group, "the key is missing and must be given");
    return NULL;
}

bool kiln_reader_is_text(const struct kiln_node *node)
{
    static const char *const non_text_words[] = {"true", "false", "null", "~"};
    double number;
    if (node->kind != KILN_NODE_SCALAR || *node->text == '\0')
        return false;
    bool is_other = kiln_text_to_double(node->text, &number);
    for (size_t i = 0; i < sizeof non_text_words / sizeof *non_text_words; i++)
        is_other |= strcmp(node->text, non_text_words[i]) == 0;
    return node->quoted || !is_other;
}

bool kiln_read_members(struct kiln_reader *reader, const struct kiln_option *members,
                       const struct kiln_node *node, void *base)
{
    if (node && node->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, node, "a mapping of keys");
    if (node && !check_keys(reader, members, node))
        return false;
    for (const struct kiln_option *row = members; row->name; row++) {
        const struct kiln_node *value = node ? kiln_node_entry(node, row->name) : NULL;
        size_t before = kiln_reader_enter(reader, row->name);
        if (!value)
            value = default_of(reader, row, node);
        if (!value && (node || row->fallback))
            return false;
        if (value && !row->type->read(reader, row, value, (char *)base + row->offset))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}

bool kiln_read_document(struct kiln_reader *reader, const struct kiln_option *rows,
                        const char *text, size_t size)
{
    const struct kiln_node *root =
        kiln_node_parse(reader->scratch, text, size, reader->origin, reader->error);
    return root && kiln_read_members(reader, rows, root, reader->target);
}

/* ---- numbers -------------------------------------------------------------------------------- */

static bool is_named_number(const char *text)
{
    static const char *const names[] = {"nan", "inf", "infinity"};
    text += *text == '-' || *text == '+';
    text += *text == '.';
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcasecmp(text, names[i]) == 0)
            return true;
    }
    return false;
}

static bool unit_error(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, const char *unit)
{
    char quoted[64];
    kiln_node_quote(quoted, unit);
    if (option->dimension == KILN_PLAIN)
        return kiln_reader_error(reader, node, "unit '%s' is wrong; this number takes no unit",
                                 quoted);
    return kiln_reader_error(reader, node, "unit '%s' is wrong; allowed is %s", quoted,
                             kiln_unit_choices(option->dimension));
}

static bool limit_error(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, double value)
{
    char quoted[64], result[48], computed[64] = "";
    kiln_node_quote(quoted, node->text);
    struct kiln_text limits = {0};
    kiln_option_describe_limits(option, &limits);
    if (kiln_expression_is(node)) {
        kiln_unit_print_double(result, option->dimension, value);
        snprintf(computed, sizeof computed, ", which is %s,", result);
    }
    kiln_reader_error(reader, node, "%s%s is out of range; allowed is%s", quoted, computed,
                      limits.data ? limits.data : "");
    kiln_text_free(&limits);
    return false;
}

/* Converts a part of the clip, such as "50 %", to seconds. */
static bool read_part_of_clip(struct kiln_reader *reader, const struct kiln_node *node,
                              double *value)
{
    if (reader->clip_s <= 0)
        return kiln_reader_error(reader, node, "the length of the clip is not known here");
    *value = *value / 100 * reader->clip_s;
    return true;
}

/* Reads a number without checking its limits. */
static bool read_si(struct kiln_reader *reader, const struct kiln_option *option,
                    const struct kiln_node *node, double *value)
{
    const char *unit = "";
    if (node->kind != KILN_NODE_SCALAR)
        return kiln_reader_mismatch(reader, option, node);
    if (kiln_expression_is(node))
        return kiln_expression_read(reader, option, node, value);
    if (!node->quoted && is_named_number(node->text))
        return kiln_reader_error(reader, node, "%s is not a finite number", node->text);
    if (!kiln_unit_split(node->text, value, &unit))
        return kiln_reader_mismatch(reader, option, node);
    if (*unit == '\0') {
        if (node->quoted)
            return kiln_reader_mismatch(reader, option, node);
        if (!kiln_unit_is_required(option->dimension) || *value == 0)
            return true;
        const char *rate = option->dimension == KILN_ANGLE ? "" : "/s";
        return kiln_reader_error(reader, node, "an angle needs its unit: %s deg%s or %s rad%s",
                                 node->text, rate, node->text, rate);
    }
    if (option->is_of_clip && strcmp(unit, "%") == 0)
        return read_part_of_clip(reader, node, value);
    if (!kiln_unit_to_si(option->dimension, unit, value))
        return unit_error(reader, option, node, unit);
    return true;
}

bool kiln_read_number(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, double *value)
{
    if (!read_si(reader, option, node, value))
        return false;
    if (!(*value >= option->min && *value <= option->max))
        return limit_error(reader, option, node, *value);
    return true;
}

bool kiln_read_float(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, float *value)
{
    double number = 0;
    if (!read_si(reader, option, node, &number))
        return false;
    /* The comparison uses floats, so that a limit that was printed as a float is within the limits.
     * The first test makes the conversion to float defined. */
    if (!(fabs(number) <= 1e30) || (float)number < (float)option->min ||
        (float)number > (float)option->max)
        return limit_error(reader, option, node, number);
    /* Some stages flush denormals and some do not (shared/exact.h), so no value is a denormal. */
    *value = fabs(number) < 0x1p-100 ? 0.0f : (float)number;
    return true;
}

bool kiln_read_whole(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, uint32_t *value)
{
    double number = 0;
    if (!kiln_read_number(reader, option, node, &number))
        return false;
    if (floor(number) != number)
        return kiln_reader_mismatch(reader, option, node);
    *value = (uint32_t)number;
    return true;
}
