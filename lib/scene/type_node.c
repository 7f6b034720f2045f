/* This file reads, prints and describes the types of options of nodes: the name of a node, a
 * position, the points of a path, a box that may lie in a node. */
#include <string.h>

#include "option/animated.h"
#include "option/schema.h"
#include "scene/options.h"

/* ---- attach: its node is looked up when all nodes are read ----------------------------------- */

static bool read_attach(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_attach *attach = field;
    *attach = (struct kiln_attach){.name = NULL};
    if (kiln_node_is(node, option->special_word))
        return true;
    return kiln_reader_is_text(node) ? kiln_reader_copy_text(reader, node->text, &attach->name)
                                     : kiln_reader_mismatch(reader, option, node);
}

static void print_attach(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_attach *attach = field;
    if (attach->name)
        kiln_print_text(printer, option, &attach->name);
    else
        kiln_text_add(&printer->text, " %s\n", option->special_word);
}

static void describe_attach(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "the name of a node, or %s", option->special_word);
}

static void schema_attach(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"minLength\": 1}");
}

const struct kiln_option_type kiln_type_attach = {
    .read = read_attach,
    .print = print_attach,
    .describe = describe_attach,
    .schema = schema_attach,
};

/* ---- demitter: bounds, and perhaps `attach` -------------------------------------------------- */

/* Copies a mapping without one of its keys. */
static const struct kiln_node *without(struct kiln_reader *reader, const struct kiln_node *node,
                                       const char *key)
{
    struct kiln_node *rest = kiln_node_create_map(reader->scratch, node->origin);
    bool ok = rest != NULL;
    for (const struct kiln_node *entry = node->first; ok && entry; entry = entry->next) {
        if (strcmp(entry->key->text, key) == 0)
            continue;
        struct kiln_node *copy = kiln_arena_alloc(reader->scratch, 1, sizeof *copy);
        ok = copy != NULL;
        if (!ok)
            break;
        *copy = *entry;
        copy->next = NULL;
        kiln_node_append(rest, copy);
    }
    if (!ok) {
        kiln_reader_out_of_memory(reader);
        return NULL;
    }
    rest->line = node->line;
    rest->column = node->column;
    rest->via = node->via;
    return rest;
}

static bool read_demitter(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, void *field)
{
    struct kiln_demitter *demitter = field;
    const struct kiln_option attach = {.type = &kiln_type_attach, .special_word = "none"};
    const struct kiln_node *name = kiln_node_entry(node, "attach");
    *demitter = (struct kiln_demitter){.attach = {.name = NULL}};
    if (name) {
        const size_t before = kiln_reader_enter(reader, "attach");
        if (!attach.type->read(reader, &attach, name, &demitter->attach))
            return false;
        kiln_reader_leave(reader, before);
        node = without(reader, node, "attach");
    }
    return node && kiln_type_bounds.read(reader, option, node, &demitter->box);
}

static void print_demitter(struct kiln_printer *printer, const struct kiln_option *option,
                           const void *field)
{
    const struct kiln_demitter *demitter = field;
    struct kiln_printer box = {.indent = 0};
    if (!demitter->attach.name) {
        kiln_type_bounds.print(printer, option, &demitter->box);
        return;
    }
    kiln_type_bounds.print(&box, option, &demitter->box);
    kiln_text_add(&printer->text, " {attach: ");
    kiln_print_quoted(printer, demitter->attach.name);
    kiln_text_add(&printer->text, ", %s", box.text.data ? box.text.data + strlen(" {") : "");
    printer->text.failed |= box.text.failed;
    kiln_text_free(&box.text);
}

static void describe_demitter(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_bounds.describe(option, out);
}

static void schema_demitter(const struct kiln_option *option, struct kiln_text *out)
{
    static const char corner[] = "\"%s\": {\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, "
                                 "\"items\": %s}, ";
    struct kiln_text number = {0};
    kiln_schema_number(option, &number);
    kiln_text_add(out, "{\"type\": \"object\", \"required\": [\"min\", \"max\"], "
                       "\"additionalProperties\": false, \"properties\": {");
    kiln_text_add(out, corner, "min", number.data ? number.data : "");
    kiln_text_add(out, corner, "max", number.data ? number.data : "");
    kiln_text_add(out, "\"attach\": {\"type\": \"string\", \"minLength\": 1}}}");
    out->failed |= number.failed;
    kiln_text_free(&number);
}

const struct kiln_option_type kiln_type_demitter = {
    .read = read_demitter,
    .print = print_demitter,
    .describe = describe_demitter,
    .schema = schema_demitter,
};

/* ---- place: a vector that may vary, or a mapping with a path --------------------------------- */

static bool read_place(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, void *field)
{
    struct kiln_node_position *position = field;
    *position = (struct kiln_node_position){.path = {.points = {.count = 0}}};
    if (node->kind == KILN_NODE_MAP && kiln_node_entry(node, option->members->name))
        return kiln_read_members(reader, option->members, node, position);
    if (node->kind == KILN_NODE_MAP && kiln_node_entry(node, "points"))
        return kiln_reader_error(reader, node,
                                 "a curve through points is written {%s: {points: "
                                 "[...], over: [...]}}",
                                 option->members->name);
    return kiln_type_vector.read(reader, option, node, &position->value);
}

static void print_place(struct kiln_printer *printer, const struct kiln_option *option,
                        const void *field)
{
    const struct kiln_node_position *position = field;
    if (position->path.points.count == 0) {
        kiln_type_vector.print(printer, option, &position->value);
        return;
    }
    kiln_text_add(&printer->text, "\n");
    printer->indent += 2;
    kiln_print_members(printer, option->members, position);
    printer->indent -= 2;
}

static void describe_place(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_vector.describe(option, out);
    kiln_text_add(out, ", or {%s: {...}}", option->members->name);
}

static void schema_place(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [");
    kiln_type_vector.schema(option, out);
    kiln_text_add(out, ", ");
    kiln_schema_members(option->members, NULL, false, out);
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_place = {
    .read = read_place,
    .print = print_place,
    .describe = describe_place,
    .schema = schema_place,
};

/* ---- points ---------------------------------------------------------------------------------- */

static bool read_points(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_path_points *points = field;
    uint32_t count = 0;
    if (node->kind != KILN_NODE_LIST)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count < 2 || node->count > KILN_MAX_PATH_POINTS)
        return kiln_reader_error(reader, node, "found %u point%s; allowed is from 2 to %d",
                                 node->count, node->count == 1 ? "" : "s", KILN_MAX_PATH_POINTS);
    float(*at)[3] = kiln_arena_alloc(reader->arena, node->count, sizeof *at);
    if (!at)
        return kiln_reader_out_of_memory(reader);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        size_t before = kiln_reader_enter_index(reader, count);
        struct kiln_option point = *option;
        point.type = &kiln_type_vector;
        if (entry->kind != KILN_NODE_LIST)
            return kiln_reader_mismatch(reader, &point, entry);
        if (!kiln_read_plain(reader, &point, entry, at[count], 3))
            return false;
        if (count > 0 && memcmp(at[count], at[count - 1], sizeof *at) == 0)
            return kiln_reader_error(reader, entry, "must not be the point before it");
        kiln_reader_leave(reader, before);
        count++;
    }
    *points = (struct kiln_path_points){(const float(*)[3])at, count};
    return true;
}

static void print_points(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_path_points *points = field;
    kiln_text_add(&printer->text, " [");
    for (uint32_t i = 0; i < points->count; i++) {
        const float *at = points->at[i];
        const struct kiln_value3 point = {
            .x = {.constant = at[0]}, .y = {.constant = at[1]}, .z = {.constant = at[2]}};
        kiln_text_add(&printer->text, "%s", i ? ", " : "");
        kiln_print_vector(printer, option, &point);
    }
    kiln_text_add(&printer->text, "]\n");
}

static void describe_points(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a list of 2 to %d points: ", KILN_MAX_PATH_POINTS);
    kiln_type_vector.describe(option, out);
}

static void schema_points(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"type\": \"array\", \"minItems\": 2, \"maxItems\": %d, \"items\": ",
                  KILN_MAX_PATH_POINTS);
    kiln_text_add(out, "{\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": ");
    kiln_schema_number(option, out);
    kiln_text_add(out, "}}");
}

const struct kiln_option_type kiln_type_points = {
    .read = read_points,
    .print = print_points,
    .describe = describe_points,
    .schema = schema_points,
};
