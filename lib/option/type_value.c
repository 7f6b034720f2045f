/* Implements the option types of animated numbers: value, vector, colour, range. */
#include <math.h>
#include <string.h>

#include "option/animated.h"
#include "option/schema.h"
#include "option/value_form.h"

/* ---- value ---------------------------------------------------------------------------------- */

static bool read_value(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, void *field)
{
    if (option->special_word && kiln_node_is(node, option->special_word)) {
        *(struct kiln_value *)field = (struct kiln_value){.constant = KILN_VALUE_BY_WORD};
        return true;
    }
    return kiln_read_animated(reader, option, node, field, 1);
}

static void print_value(struct kiln_printer *printer, const struct kiln_option *option,
                        const void *field)
{
    const struct kiln_value *value = field;
    kiln_text_add(&printer->text, " ");
    if (option->special_word && value->count == 0 && value->constant < 0.0f)
        kiln_text_add(&printer->text, "%s", option->special_word);
    else
        kiln_print_value(printer, option, value);
    kiln_text_add(&printer->text, "\n");
}

static void describe_value(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a number");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

/* Appends the schema of a mapping with a clock. What may stand in it is a definition of the whole
 * schema; plain: the schema of a key's value. */
static void schema_clocks(const struct kiln_option *option, const char *plain,
                          struct kiln_text *out)
{
    if (!option->clocks)
        return;
    kiln_text_add(out,
                  ", {\"allOf\": [{\"$ref\": \"#/definitions/varies_%u\"}, {\"type\": "
                  "\"object\", \"patternProperties\": {\"^(",
                  option->clocks);
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++)
        kiln_text_add(out, "%s%s", i ? "|" : "", kiln_value_clocks[i].name);
    kiln_text_add(out,
                  ")$\": {\"anyOf\": [{\"type\": \"array\", \"items\": %s}, "
                  "{\"type\": \"object\", \"additionalProperties\": %s}]}}}]}",
                  plain, plain);
}

static void schema_value(const struct kiln_option *option, struct kiln_text *out)
{
    if (!option->clocks) {
        kiln_schema_number(option, out);
        return;
    }
    struct kiln_text plain = {0};
    kiln_schema_number(option, &plain);
    kiln_text_add(out, "{\"anyOf\": [%s", plain.data ? plain.data : "");
    schema_clocks(option, plain.data ? plain.data : "", out);
    if (option->special_word)
        kiln_text_add(out, ", {\"const\": \"%s\"}", option->special_word);
    kiln_text_add(out, "]}");
    out->failed |= plain.failed;
    kiln_text_free(&plain);
}

const struct kiln_option_type kiln_type_value = {
    .read = read_value,
    .print = print_value,
    .describe = describe_value,
    .schema = schema_value,
};

/* ---- vector and colour ---------------------------------------------------------------------- */

/* Returns the components of a vector for which the file has the option's word. */
static float word_of(const struct kiln_option *option)
{
    return option->min < 0 ? NAN : KILN_VALUE_BY_WORD;
}

static bool is_by_word(const struct kiln_option *option, const struct kiln_value *first)
{
    return option->special_word && first->count == 0 &&
           (option->min < 0 ? isnan(first->constant) : first->constant == KILN_VALUE_BY_WORD);
}

static bool read_vector(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_value values[3];
    if (option->special_word && kiln_node_is(node, option->special_word)) {
        const struct kiln_value by_word = {.constant = word_of(option)};
        *(struct kiln_value3 *)field = (struct kiln_value3){by_word, by_word, by_word};
        return true;
    }
    if (!kiln_read_animated(reader, option, node, values, 3))
        return false;
    *(struct kiln_value3 *)field = (struct kiln_value3){values[0], values[1], values[2]};
    return true;
}

static void print_vector(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_value *first = &((const struct kiln_value3 *)field)->x;
    kiln_text_add(&printer->text, " ");
    if (is_by_word(option, first))
        kiln_text_add(&printer->text, "%s", option->special_word);
    else
        kiln_print_vector(printer, option, field);
    kiln_text_add(&printer->text, "\n");
}

static void describe_vector(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "[x, y, z], each");
    kiln_option_describe_limits(option, out);
}

static void describe_color(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "[red, green, blue] or one number for grey, linear, each");
    kiln_option_describe_limits(option, out);
    kiln_text_add(out, ", or in sRGB \"#e61e28\", \"#abc\" or a name of CSS");
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

/* The schema of a colour in sRGB. Names are not listed, since each row of colours would list them.
 */
static const char SRGB[] = "{\"type\": \"string\", \"pattern\": "
                           "\"^(#[0-9A-Fa-f]{3}([0-9A-Fa-f]{3})?|[A-Za-z]+)$\"}";

static void schema_vector(const struct kiln_option *option, struct kiln_text *out)
{
    bool grey = option->type == &kiln_type_color;
    struct kiln_text number = {0}, component = {0}, plain = {0};
    struct kiln_option part = *option;
    part.special_word = NULL; /* it stands for the whole, never for a component */
    kiln_schema_number(option, &number);
    schema_value(&part, &component);
    const char *item = number.data ? number.data : "";
    const char *animated = component.data ? component.data : "";
    const char *array = "{\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": %s}";
    kiln_text_add(&plain, "%s", grey ? "{\"anyOf\": [" : "");
    kiln_text_add(&plain, array, item);
    if (grey)
        kiln_text_add(&plain, ", %s, %s]}", item, SRGB);
    kiln_text_add(out, "{\"anyOf\": [");
    kiln_text_add(out, array, animated);
    if (grey)
        kiln_text_add(out, ", %s, %s", item, SRGB);
    schema_clocks(option, plain.data ? plain.data : "", out);
    kiln_text_add(out, "]}");
    out->failed |= number.failed || component.failed || plain.failed;
    kiln_text_free(&number);
    kiln_text_free(&component);
    kiln_text_free(&plain);
}

const struct kiln_option_type kiln_type_vector = {
    .read = read_vector,
    .print = print_vector,
    .describe = describe_vector,
    .schema = schema_vector,
};
const struct kiln_option_type kiln_type_color = {
    .read = read_vector,
    .print = print_vector,
    .describe = describe_color,
    .schema = schema_vector,
};

/* ---- range ---------------------------------------------------------------------------------- */

/* Returns whether min <= max everywhere. Both are linear between their keys and have the same
 * clock, so it is enough to compare them at every key. */
static bool is_ordered(const float4 *keys, const struct kiln_range *range)
{
    const struct kiln_value *bounds[2] = {&range->min, &range->max};
    for (unsigned e = 0; e < 2; e++) {
        for (uint32_t i = 0; i < bounds[e]->count || i == 0; i++) {
            struct value_clocks clocks =
                value_clocks_at(bounds[e]->count ? keys[bounds[e]->first + i].x : 0, 0, 0);
            clocks.life = clocks.time_s;
            if (value_at(keys, range->min, clocks) > value_at(keys, range->max, clocks))
                return false;
        }
    }
    return true;
}

static bool read_range(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, void *field)
{
    struct kiln_range *range = field;
    if (option->special_word && kiln_node_is(node, option->special_word)) {
        *range = KILN_RANGE_BY_WORD;
        return true;
    }
    if (node->kind != KILN_NODE_LIST) {
        if (!kiln_read_animated(reader, option, node, &range->min, 1))
            return false;
        range->max = range->min;
        return true;
    }
    if (node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    struct kiln_option end = *option;
    end.clocks &= KILN_ALLOW_TIME | KILN_ALLOW_LIFE;
    end.special_word = NULL; /* it stands for the range, never for one of its ends */
    if (!kiln_read_animated(reader, &end, node->first, &range->min, 1) ||
        !kiln_read_animated(reader, &end, node->first->next, &range->max, 1))
        return false;
    if (range->min.count > 0 && range->max.count > 0 &&
        VALUE_CLOCK(range->min.how) != VALUE_CLOCK(range->max.how))
        return kiln_reader_error(reader, node, "both must vary over time, or both over life");
    if (!is_ordered(reader->keys, range))
        return kiln_reader_error(reader, node, "the first must not be above the second");
    return true;
}

static void print_range(struct kiln_printer *printer, const struct kiln_option *option,
                        const void *field)
{
    const struct kiln_range *range = field;
    if (option->special_word && kiln_range_is_by_word(range)) {
        kiln_text_add(&printer->text, " %s\n", option->special_word);
        return;
    }
    if (memcmp(&range->min, &range->max, sizeof range->min) == 0) {
        kiln_text_add(&printer->text, " ");
        kiln_print_value(printer, option, &range->min);
        kiln_text_add(&printer->text, "\n");
        return;
    }
    kiln_text_add(&printer->text, " [");
    kiln_print_value(printer, option, &range->min);
    kiln_text_add(&printer->text, ", ");
    kiln_print_value(printer, option, &range->max);
    kiln_text_add(&printer->text, "]\n");
}

static void describe_range(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "[min, max] or one number,");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

static void schema_range(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_text value = {0};
    struct kiln_option number = *option;
    number.special_word = NULL; /* no end of a range has it */
    schema_value(&number, &value);
    const char *item = value.data ? value.data : "";
    kiln_text_add(out,
                  "{\"anyOf\": [%s, {\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, "
                  "\"items\": %s}",
                  item, item);
    if (option->special_word)
        kiln_text_add(out, ", {\"const\": \"%s\"}", option->special_word);
    kiln_text_add(out, "]}");
    out->failed |= value.failed;
    kiln_text_free(&value);
}

const struct kiln_option_type kiln_type_range = {
    .read = read_range,
    .print = print_range,
    .describe = describe_range,
    .schema = schema_range,
};
