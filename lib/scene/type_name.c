/* This file reads and describes the types of options that name a part of the scene or of a file of
 * it: a system, a domain of gas, an object, a clip, a node. */
#include "scene/options.h"

/* ---- name: another system ------------------------------------------------------------------- */

static bool read_name(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return kiln_reader_is_text(node) ? kiln_reader_copy_text(reader, node->text, field)
                                     : kiln_reader_mismatch(reader, option, node);
}

static void describe_name(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of another system");
}

static void schema_name(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"minLength\": 1}");
}

const struct kiln_option_type kiln_type_name = {
    .read = read_name,
    .print = kiln_print_text,
    .describe = describe_name,
    .schema = schema_name,
};

/* ---- system, domain: they are found when all of them are read -------------------------------- */

static void describe_system(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of a system");
}

const struct kiln_option_type kiln_type_system = {
    .read = read_name,
    .print = kiln_print_text,
    .describe = describe_system,
    .schema = schema_name,
};

static void describe_domain(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of a domain of gas");
}

const struct kiln_option_type kiln_type_domain = {
    .read = read_name,
    .print = kiln_print_text,
    .describe = describe_domain,
    .schema = schema_name,
};

/* ---- object: it is found when all objects are read ------------------------------------------- */

static bool read_object(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    const char **name = field;
    *name = NULL;
    if (kiln_node_is(node, option->fallback))
        return true;
    return node->kind == KILN_NODE_SCALAR && *node->text
               ? kiln_reader_copy_text(reader, node->text, name)
               : kiln_reader_mismatch(reader, option, node);
}

static void print_object(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    if (*(const char *const *)field)
        kiln_print_text(printer, option, field);
    else
        kiln_text_add(&printer->text, " %s\n", option->fallback);
}

static void describe_object(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "the name of an object of the backdrop, or its number from 0, or %s",
                  option->fallback);
}

static void schema_object(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": [\"string\", \"integer\"]}");
}

const struct kiln_option_type kiln_type_object = {
    .read = read_object,
    .print = print_object,
    .describe = describe_object,
    .schema = schema_object,
};

/* ---- clip: it is found when the mesh file is read -------------------------------------------- */

static bool read_clip(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return node->kind == KILN_NODE_SCALAR && *node->text
               ? kiln_reader_copy_text(reader, node->text, field)
               : kiln_reader_mismatch(reader, option, node);
}

static void describe_clip(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of an animation in the file, or its number from 0");
}

static void schema_clip(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": [\"string\", \"integer\"]}");
}

const struct kiln_option_type kiln_type_clip = {
    .read = read_clip,
    .print = kiln_print_text,
    .describe = describe_clip,
    .schema = schema_clip,
};

/* ---- part: it is looked up when all nodes are read ------------------------------------------- */

static bool read_part(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    const char **name = field;
    *name = NULL;
    return kiln_node_is(node, "none") || read_clip(reader, option, node, field);
}

static void print_part(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    if (*(const char *const *)field)
        kiln_print_text(printer, option, field);
    else
        kiln_text_add(&printer->text, " none\n");
}

static void describe_part(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the name of a node in the file, or its number there from 0, or none");
}

const struct kiln_option_type kiln_type_part = {
    .read = read_part,
    .print = print_part,
    .describe = describe_part,
    .schema = schema_clip,
};
