/* Implements the option types that hold several plain numbers: pair, bounds. */
#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"

/* ---- pair ----------------------------------------------------------------------------------- */

static bool read_pair(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    uint32_t *pair = field;
    if (node->kind != KILN_NODE_LIST || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    return kiln_read_whole(reader, option, node->first, &pair[0]) &&
           kiln_read_whole(reader, option, node->first->next, &pair[1]);
}

static void print_pair(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    (void)option;
    const uint32_t *pair = field;
    kiln_text_add(&printer->text, " [%u, %u]\n", pair[0], pair[1]);
}

static void describe_pair(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "two whole numbers [a, b], each");
    kiln_option_describe_limits(option, out);
}

static void schema_pair(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": ");
    kiln_schema_number(option, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_pair = {
    .read = read_pair,
    .print = print_pair,
    .describe = describe_pair,
    .schema = schema_pair,
};

/* ---- bounds --------------------------------------------------------------------------------- */

static bool read_corner(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, const char *name, float corner[3])
{
    const struct kiln_node *list = kiln_node_entry(node, name);
    if (!list || list->kind != KILN_NODE_LIST || list->count != 3)
        return kiln_reader_mismatch(reader, option, list ? list : node);
    const struct kiln_node *item = list->first;
    for (unsigned i = 0; i < 3; i++, item = item->next) {
        if (!kiln_read_float(reader, option, item, &corner[i]))
            return false;
    }
    return true;
}

static bool read_bounds(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_bounds *bounds = field;
    *bounds = (struct kiln_bounds){0};
    if (option->special_word && kiln_node_is(node, option->special_word))
        return true;
    if (node->kind != KILN_NODE_MAP || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    if (!read_corner(reader, option, node, "min", bounds->min) ||
        !read_corner(reader, option, node, "max", bounds->max))
        return false;
    for (unsigned i = 0; i < 3; i++) {
        if (!(bounds->min[i] < bounds->max[i]))
            return kiln_reader_error(reader, node, "min must be below max in x, y and z");
    }
    bounds->enabled = true;
    return true;
}

static void print_bounds(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_bounds *bounds = field;
    if (!bounds->enabled) {
        kiln_text_add(&printer->text, " %s\n", option->special_word);
        return;
    }
    char text[6][48];
    for (unsigned i = 0; i < 3; i++) {
        kiln_unit_print(text[i], KILN_PLAIN, bounds->min[i]);
        kiln_unit_print(text[3 + i], KILN_PLAIN, bounds->max[i]);
    }
    kiln_text_add(&printer->text, " {min: [%s, %s, %s], max: [%s, %s, %s]}\n", text[0], text[1],
                  text[2], text[3], text[4], text[5]);
}

static void describe_bounds(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{min: [x, y, z], max: [x, y, z]}, each number");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

static void schema_bounds(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_text number = {0};
    kiln_schema_number(option, &number);
    const char *item = number.data ? number.data : "";
    const char *corner = "{\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": %s}";
    kiln_text_add(out, "{\"anyOf\": [");
    if (option->special_word)
        kiln_text_add(out, "{\"const\": \"%s\"}, ", option->special_word);
    kiln_text_add(out, "{\"type\": \"object\", \"required\": [\"min\", \"max\"], "
                       "\"additionalProperties\": false, \"properties\": {\"min\": ");
    kiln_text_add(out, corner, item);
    kiln_text_add(out, ", \"max\": ");
    kiln_text_add(out, corner, item);
    kiln_text_add(out, "}}]}");
    out->failed |= number.failed;
    kiln_text_free(&number);
}

const struct kiln_option_type kiln_type_bounds = {
    .read = read_bounds,
    .print = print_bounds,
    .describe = describe_bounds,
    .schema = schema_bounds,
};
