/* This file reads and describes the types of options that name a part of the scene or of a file of
 * it: a system, a clip. */
#include "scene/options.h"

/* ---- name: its system is found when all systems are read ------------------------------------- */

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
