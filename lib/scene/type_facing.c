/* This file reads, prints and describes how billboards are turned: a word, or the normal of a plane
 * of the world. */
#include "option/schema.h"
#include "scene/options.h"

static bool read_facing(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_look_facing *facing = field;
    *facing = (struct kiln_look_facing){.way = KILN_FACING_NORMAL, .normal.y.constant = 1.0f};
    if (node->kind == KILN_NODE_MAP)
        return kiln_read_members(reader, option->members, node, facing);
    unsigned way = 0;
    if (!kiln_type_choice.read(reader, option, node, &way))
        return false;
    facing->way = way;
    return true;
}

static void print_facing(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_look_facing *facing = field;
    const unsigned way = facing->way;
    if (facing->way != KILN_FACING_NORMAL) {
        kiln_type_choice.print(printer, option, &way);
        return;
    }
    kiln_text_add(&printer->text, "\n");
    printer->indent += 2;
    kiln_print_members(printer, option->members, facing);
    printer->indent -= 2;
}

static void describe_facing(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_choice.describe(option, out);
    kiln_text_add(out, ", or {%s: [x, y, z]}", option->members->name);
}

static void schema_facing(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [");
    kiln_type_choice.schema(option, out);
    kiln_text_add(out, ", ");
    kiln_schema_members(option->members, NULL, false, out);
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_facing = {
    .read = read_facing,
    .print = print_facing,
    .describe = describe_facing,
    .schema = schema_facing,
};
