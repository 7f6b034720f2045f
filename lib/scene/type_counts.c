/* Reads, prints and describes the option type of a number of particles that may be drawn: a whole
 * number, or the least and the greatest one, such as [20, 30]. */
#include "option/printer.h"
#include "option/schema.h"
#include "scene/options.h"

static bool read_counts(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    uint32_t *counts = field;
    if (node->kind == KILN_NODE_SCALAR) {
        if (!kiln_read_whole(reader, option, node, &counts[0]))
            return false;
        counts[1] = counts[0];
        return true;
    }
    if (node->kind != KILN_NODE_LIST || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    if (!kiln_read_whole(reader, option, node->first, &counts[0]) ||
        !kiln_read_whole(reader, option, node->first->next, &counts[1]))
        return false;
    return counts[0] <= counts[1] ||
           kiln_reader_error(reader, node, "%u is above %u; the least number comes first",
                             counts[0], counts[1]);
}

static void print_counts(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    (void)option;
    const uint32_t *counts = field;
    if (counts[0] == counts[1])
        kiln_text_add(&printer->text, " %u\n", counts[0]);
    else
        kiln_text_add(&printer->text, " [%u, %u]\n", counts[0], counts[1]);
}

static void describe_counts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a whole number");
    kiln_option_describe_limits(option, out);
    kiln_text_add(out, ", or the least and the greatest of those that are drawn, [a, b]");
}

static void schema_counts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [");
    kiln_type_integer.schema(option, out);
    kiln_text_add(out, ", {\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": ");
    kiln_type_integer.schema(option, out);
    kiln_text_add(out, "}]}");
}

const struct kiln_option_type kiln_type_counts = {
    .read = read_counts,
    .print = print_counts,
    .describe = describe_counts,
    .schema = schema_counts,
};
