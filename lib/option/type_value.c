/* Implements the option types of animated numbers: value, vector, colour, range. */
#include <string.h>

#include "option/animated.h"
#include "option/schema.h"

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
        kiln_print_animated(printer, option, value);
    kiln_text_add(&printer->text, "\n");
}

static void describe_value(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a number");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

/* Appends the schemas of {"keys": {...}} and {"life": ...}, with `plain` as the schema of each
 * key's value. */
static void schema_curves(const struct kiln_option *option, const char *plain,
                          struct kiln_text *out)
{
    if (option->clocks & KILN_ALLOW_TIME) {
        kiln_text_add(out, ", {\"type\": \"object\", \"required\": [\"keys\"], "
                           "\"additionalProperties\": false, \"properties\": {\"keys\": "
                           "{\"type\": \"object\", \"minProperties\": 1, "
                           "\"propertyNames\": {\"pattern\": ");
        kiln_schema_number_pattern(KILN_SECONDS, out);
        kiln_text_add(out, "}, \"additionalProperties\": %s}}}", plain);
    }
    if (option->clocks & KILN_ALLOW_LIFE) {
        kiln_text_add(out,
                      ", {\"type\": \"object\", \"required\": [\"life\"], "
                      "\"additionalProperties\": false, \"properties\": {\"life\": "
                      "{\"anyOf\": [{\"type\": \"array\", \"minItems\": 1, \"items\": %s}, "
                      "{\"type\": \"object\", \"minProperties\": 1, "
                      "\"propertyNames\": {\"pattern\": ",
                      plain);
        kiln_schema_number_pattern(KILN_FRACTION, out);
        kiln_text_add(out, "}, \"additionalProperties\": %s}]}}}", plain);
    }
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
    schema_curves(option, plain.data ? plain.data : "", out);
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

static bool read_vector(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_value values[3];
    if (!kiln_read_animated(reader, option, node, values, 3))
        return false;
    *(struct kiln_value3 *)field = (struct kiln_value3){values[0], values[1], values[2]};
    return true;
}

/* Returns whether the three curves can be written as one curve of [x, y, z]. */
static bool share_keys(const float4 *keys, const struct kiln_value3 *v)
{
    if (v->x.count == 0 || v->y.count != v->x.count || v->z.count != v->x.count ||
        v->y.clock != v->x.clock || v->z.clock != v->x.clock ||
        v->y.first != v->x.first + v->x.count || v->z.first != v->y.first + v->y.count)
        return false;
    for (uint32_t i = 0; i < v->x.count; i++) {
        float x = keys[v->x.first + i].x;
        if (keys[v->y.first + i].x != x || keys[v->z.first + i].x != x)
            return false;
    }
    return true;
}

static void print_shared_keys(struct kiln_printer *printer, const struct kiln_option *option,
                              const struct kiln_value3 *v)
{
    const float4 *keys = printer->keys;
    bool over_life = v->x.clock == KILN_CLOCK_LIFE;
    kiln_text_add(&printer->text, over_life ? " {life: {" : " {keys: {");
    for (uint32_t i = 0; i < v->x.count; i++) {
        char text[4][48];
        kiln_unit_print(text[0], over_life ? KILN_FRACTION : KILN_SECONDS, keys[v->x.first + i].x);
        kiln_unit_print(text[1], option->dimension, keys[v->x.first + i].y);
        kiln_unit_print(text[2], option->dimension, keys[v->y.first + i].y);
        kiln_unit_print(text[3], option->dimension, keys[v->z.first + i].y);
        kiln_text_add(&printer->text, "%s%s: [%s, %s, %s]", i ? ", " : "", text[0], text[1],
                      text[2], text[3]);
    }
    kiln_text_add(&printer->text, "}}\n");
}

static void print_vector(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_value3 *v = field;
    struct kiln_option unitless =
        *option; /* without units, since three in a row are hard to read */
    if (!kiln_unit_is_required(option->dimension))
        unitless.dimension = KILN_PLAIN;
    if (share_keys(printer->keys, v)) {
        print_shared_keys(printer, &unitless, v);
        return;
    }
    kiln_text_add(&printer->text, " [");
    kiln_print_animated(printer, &unitless, &v->x);
    kiln_text_add(&printer->text, ", ");
    kiln_print_animated(printer, &unitless, &v->y);
    kiln_text_add(&printer->text, ", ");
    kiln_print_animated(printer, &unitless, &v->z);
    kiln_text_add(&printer->text, "]\n");
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
}

/* The schema of a colour in sRGB. Names are not listed, since each row of colours would list them.
 */
static const char SRGB[] = "{\"type\": \"string\", \"pattern\": "
                           "\"^(#[0-9A-Fa-f]{3}([0-9A-Fa-f]{3})?|[A-Za-z]+)$\"}";

static void schema_vector(const struct kiln_option *option, struct kiln_text *out)
{
    bool grey = option->type == &kiln_type_color;
    struct kiln_text number = {0}, component = {0}, plain = {0};
    kiln_schema_number(option, &number);
    schema_value(option, &component);
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
    schema_curves(option, plain.data ? plain.data : "", out);
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
            float x = bounds[e]->count ? keys[bounds[e]->first + i].x : 0;
            if (value_at(keys, range->min, x, x) > value_at(keys, range->max, x, x))
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
    end.special_word = NULL; /* it stands for the range, never for one of its ends */
    if (!kiln_read_animated(reader, &end, node->first, &range->min, 1) ||
        !kiln_read_animated(reader, &end, node->first->next, &range->max, 1))
        return false;
    if (range->min.count > 0 && range->max.count > 0 && range->min.clock != range->max.clock)
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
        kiln_print_animated(printer, option, &range->min);
        kiln_text_add(&printer->text, "\n");
        return;
    }
    kiln_text_add(&printer->text, " [");
    kiln_print_animated(printer, option, &range->min);
    kiln_text_add(&printer->text, ", ");
    kiln_print_animated(printer, option, &range->max);
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
