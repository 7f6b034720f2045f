/* Implements the types of the keys that are resolved before the rows of a table are read: include,
 * use and params. The reader takes these keys out of the tree, so the types read nothing; they
 * describe the keys for people and editors. */
#include <string.h>

#include "option/params.h"
#include "option/printer.h"
#include "option/schema.h"

/* Returns whether a scalar needs quotes in a list or mapping of one line. */
static bool needs_quotes(const struct kiln_node *node, bool is_inside)
{
    return node->quoted || *node->text == '\0' || (is_inside && strpbrk(node->text, ",[]{}"));
}

static void write_node(const struct kiln_node *node, bool is_inside, struct kiln_text *out)
{
    if (node->kind == KILN_NODE_SCALAR && needs_quotes(node, is_inside)) {
        kiln_text_add_json(out, node->text);
        return;
    }
    if (node->kind == KILN_NODE_SCALAR) {
        kiln_text_add(out, "%s", node->text);
        return;
    }
    kiln_text_add(out, "%s", node->kind == KILN_NODE_LIST ? "[" : "{");
    for (const struct kiln_node *child = node->first; child; child = child->next) {
        kiln_text_add(out, "%s", child == node->first ? "" : ", ");
        if (child->key)
            kiln_text_add(out, "%s: ", child->key->text);
        write_node(child, true, out);
    }
    kiln_text_add(out, "%s", node->kind == KILN_NODE_LIST ? "]" : "}");
}

void kiln_node_write(const struct kiln_node *node, struct kiln_text *out)
{
    write_node(node, false, out);
}

/* Refuses a key that --set gives: when it is read, all such keys have been resolved. */
static bool read_resolved(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, void *field)
{
    (void)field;
    return kiln_node_is(node, option->fallback) ||
           kiln_reader_error(reader, node, "this key must stand in the file");
}

static void print_nothing(struct kiln_printer *printer, const struct kiln_option *option,
                          const void *field)
{
    (void)printer;
    (void)option;
    (void)field;
}

static void describe_params(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out,
                  "a mapping of up to %d names to {KIND: DEFAULT, min: , max: , of: [], help: }, "
                  "where KIND is number, integer, color, vector, choice, switch, text or file",
                  KILN_MAX_PARAMS);
}

static void schema_params(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out,
                  "{\"type\": \"object\", \"maxProperties\": %d, \"propertyNames\": {\"pattern\": "
                  "\"^[A-Za-z_][A-Za-z0-9_]{0,31}$\"}, \"additionalProperties\": {\"type\": "
                  "\"object\", \"additionalProperties\": false, \"properties\": {",
                  KILN_MAX_PARAMS);
    for (unsigned i = 0; i < KILN_PARAM_KINDS; i++)
        kiln_text_add(out, "\"%s\": {}, ", kiln_params_kind_name((enum kiln_param_kind)i));
    kiln_text_add(out, "\"min\": {}, \"max\": {}, \"of\": {\"type\": \"array\", \"minItems\": 1}, "
                       "\"help\": {\"type\": \"string\"}}}}");
}

const struct kiln_option_type kiln_type_params = {
    .read = read_resolved,
    .print = print_nothing,
    .describe = describe_params,
    .schema = schema_params,
};

static void describe_include(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the path of a scene file, from the scene's folder and inside it, or a list "
                       "of these");
}

static void schema_include(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"anyOf\": [{\"type\": \"string\", \"pattern\": \"^(?!/).+$\"}, "
                       "{\"type\": \"array\", \"items\": {\"type\": \"string\", "
                       "\"pattern\": \"^(?!/).+$\"}}]}");
}

const struct kiln_option_type kiln_type_include = {
    .read = read_resolved,
    .print = print_nothing,
    .describe = describe_include,
    .schema = schema_include,
};

static void describe_use(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of another entry of the mapping");
}

static void schema_use(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"minLength\": 1}");
}

const struct kiln_option_type kiln_type_use = {
    .read = read_resolved,
    .print = print_nothing,
    .describe = describe_use,
    .schema = schema_use,
};
