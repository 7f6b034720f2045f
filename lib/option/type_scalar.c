/* Implements the option types that hold one plain value: boolean, integer, rational, number,
 * choice, text. */
#include <inttypes.h>
#include <string.h>

#include "option/expression.h"
#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"

/* ---- boolean -------------------------------------------------------------------------------- */

static bool read_boolean(struct kiln_reader *reader, const struct kiln_option *option,
                         const struct kiln_node *node, void *field)
{
    bool yes = kiln_node_is(node, "true");
    if (node->quoted || (!yes && !kiln_node_is(node, "false")))
        return kiln_reader_mismatch(reader, option, node);
    *(bool *)field = yes;
    return true;
}

static void print_boolean(struct kiln_printer *printer, const struct kiln_option *option,
                          const void *field)
{
    (void)option;
    kiln_text_add(&printer->text, " %s\n", *(const bool *)field ? "true" : "false");
}

static void describe_boolean(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "true or false");
}

static void schema_boolean(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"boolean\"}");
}

static void list_boolean(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "true|false");
}

const struct kiln_option_type kiln_type_boolean = {
    .read = read_boolean,
    .print = print_boolean,
    .describe = describe_boolean,
    .schema = schema_boolean,
    .list_choices = list_boolean,
};

/* ---- integer -------------------------------------------------------------------------------- */

static bool read_integer(struct kiln_reader *reader, const struct kiln_option *option,
                         const struct kiln_node *node, void *field)
{
    if (option->special_word && kiln_node_is(node, option->special_word)) {
        *(uint32_t *)field = KILN_INTEGER_BY_WORD;
        return true;
    }
    return kiln_read_whole(reader, option, node, field);
}

static void print_integer(struct kiln_printer *printer, const struct kiln_option *option,
                          const void *field)
{
    const uint32_t number = *(const uint32_t *)field;
    if (option->special_word && number == KILN_INTEGER_BY_WORD)
        kiln_text_add(&printer->text, " %s\n", option->special_word);
    else
        kiln_text_add(&printer->text, " %" PRIu32 "\n", number);
}

static void describe_integer(const struct kiln_option *option, struct kiln_text *out)
{
    if (option->min == option->max)
        kiln_text_add(out, "the number %.0f", option->min);
    else
        kiln_text_add(out, "a whole number from %.0f to %.0f", option->min, option->max);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

static void schema_integer(const struct kiln_option *option, struct kiln_text *out)
{
    const char *word = option->special_word;
    kiln_text_add(out, "%s{\"type\": \"integer\", \"minimum\": %.0f, \"maximum\": %.0f}",
                  word ? "{\"anyOf\": [" : "", option->min, option->max);
    if (word)
        kiln_text_add(out, ", {\"const\": \"%s\"}]}", word);
}

const struct kiln_option_type kiln_type_integer = {
    .read = read_integer,
    .print = print_integer,
    .describe = describe_integer,
    .schema = schema_integer,
};

/* ---- rational ------------------------------------------------------------------------------- */

/* Reads a rate that arithmetic gives, which must have few decimal places, such as 12.5. */
static bool read_computed_rational(struct kiln_reader *reader, const struct kiln_option *option,
                                   const struct kiln_node *node, struct kiln_rational *rational)
{
    char text[32];
    double value = 0;
    uint64_t num = 0, den = 1;
    if (!kiln_read_number(reader, option, node, &value))
        return false;
    kiln_unit_print_number(text, value);
    if (!kiln_unit_parse_rational(text, &num, &den))
        return kiln_reader_mismatch(reader, option, node);
    *rational = (struct kiln_rational){(uint32_t)num, (uint32_t)den};
    return true;
}

static bool read_rational(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, void *field)
{
    struct kiln_rational *rational = field;
    if (node->kind != KILN_NODE_SCALAR)
        return kiln_reader_mismatch(reader, option, node);
    if (option->special_word && kiln_node_is(node, option->special_word)) {
        *rational = (struct kiln_rational){0, 1};
        return true;
    }
    uint64_t num = 0, den = 1;
    if (kiln_expression_is(node))
        return read_computed_rational(reader, option, node, rational);
    bool is_text = node->quoted && !strchr(node->text, '/');
    if (is_text || !kiln_unit_parse_rational(node->text, &num, &den))
        return kiln_reader_mismatch(reader, option, node);
    double value = (double)num / (double)den;
    if (value < option->min || value > option->max)
        return kiln_reader_mismatch(reader, option, node);
    *rational = (struct kiln_rational){(uint32_t)num, (uint32_t)den};
    return true;
}

static void print_rational(struct kiln_printer *printer, const struct kiln_option *option,
                           const void *field)
{
    const struct kiln_rational *rational = field;
    if (option->special_word && rational->num == 0)
        kiln_text_add(&printer->text, " %s\n", option->special_word);
    else
        kiln_text_add(&printer->text, rational->den == 1 ? " %u\n" : " %u/%u\n", rational->num,
                      rational->den);
}

static void describe_rational(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a rate like 30, 29.97 or 30000/1001");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

static void schema_rational(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"type\": [\"number\", \"string\"], \"minimum\": %.0f, \"maximum\": %.0f, "
                  "\"pattern\": \"^([0-9]+/[0-9]+%s%s)$\"}",
                  option->min, option->max, option->special_word ? "|" : "",
                  option->special_word ? option->special_word : "");
}

const struct kiln_option_type kiln_type_rational = {
    .read = read_rational,
    .print = print_rational,
    .describe = describe_rational,
    .schema = schema_rational,
};

/* ---- number --------------------------------------------------------------------------------- */

static bool read_number(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    double value = 0;
    if (!kiln_read_number(reader, option, node, &value))
        return false;
    *(double *)field = value;
    return true;
}

static void print_number(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    char number[48];
    kiln_unit_print_double(number, option->dimension, *(const double *)field);
    kiln_text_add(&printer->text, " %s\n", number);
}

static void describe_number(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a number");
    kiln_option_describe_limits(option, out);
    if (option->special_word)
        kiln_text_add(out, ", or %s", option->special_word);
}

const struct kiln_option_type kiln_type_number = {
    .read = read_number,
    .print = print_number,
    .describe = describe_number,
    .schema = kiln_schema_number,
};

/* ---- choice --------------------------------------------------------------------------------- */

static bool read_choice(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    if (node->kind != KILN_NODE_SCALAR)
        return kiln_reader_mismatch(reader, option, node);
    size_t count = 0;
    for (; option->choices[count]; count++) {
        if (strcmp(option->choices[count], node->text) == 0) {
            unsigned value = (unsigned)count; /* enumerations of this library are 4 bytes */
            memcpy(field, &value, sizeof value);
            return true;
        }
    }
    const char *nearest = kiln_text_nearest(node->text, option->choices, count);
    if (!nearest)
        return kiln_reader_mismatch(reader, option, node);
    char quoted[64];
    kiln_node_quote(quoted, node->text);
    return kiln_reader_error(reader, node, "unknown word '%s' (did you mean '%s'?)", quoted,
                             nearest);
}

static void print_choice(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    unsigned value;
    memcpy(&value, field, sizeof value);
    kiln_text_add(&printer->text, " %s\n", option->choices[value]);
}

static void describe_choice(const struct kiln_option *option, struct kiln_text *out)
{
    for (size_t i = 0; option->choices[i]; i++)
        kiln_text_add(out, "%s%s",
                      i == 0                   ? ""
                      : option->choices[i + 1] ? ", "
                                               : " or ",
                      option->choices[i]);
}

static void schema_choice(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"enum\": [");
    for (size_t i = 0; option->choices[i]; i++)
        kiln_text_add(out, "%s\"%s\"", i ? ", " : "", option->choices[i]);
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_choice = {
    .read = read_choice,
    .print = print_choice,
    .describe = describe_choice,
    .schema = schema_choice,
};

/* ---- text ----------------------------------------------------------------------------------- */

static bool read_text(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    if (node->kind != KILN_NODE_SCALAR || (*node->text == '\0' && !node->quoted))
        return kiln_reader_mismatch(reader, option, node);
    size_t length = strlen(node->text);
    if ((double)length < option->min)
        return kiln_reader_error(reader, node, "must not be empty");
    if ((double)length > option->max)
        return kiln_reader_error(reader, node, "the text has %zu bytes; at most %.0f are allowed",
                                 length, option->max);
    return kiln_reader_copy_text(reader, node->text, field);
}

static void describe_text(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "a text");
}

/* Appends the schema of a text, which a file may also write as a number or a boolean. A schema
 * limits characters and the option limits bytes. The schema never refuses an allowed text, since a
 * text has at most as many characters as bytes; its lower limit only refuses the empty text. */
static void schema_text(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"type\": [\"string\", \"number\", \"boolean\"], \"minLength\": %d, "
                  "\"maxLength\": %.0f}",
                  option->min > 0, option->max);
}

const struct kiln_option_type kiln_type_text = {
    .read = read_text,
    .print = kiln_print_text,
    .describe = describe_text,
    .schema = schema_text,
};
