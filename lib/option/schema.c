/* Writes a JSON schema (draft-07) from the option tables. The schema is as strict as the loader
 * about keys, words, forms and units. It checks limits only for numbers without a unit. Only the
 * loader checks the order of values and the files that a text names. */
#include "option/schema.h"

#include "option/value_form.h"

#define NUMBER_PATTERN "[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?"

void kiln_schema_number(const struct kiln_option *option, struct kiln_text *out)
{
    char units[64], min[32], max[32];
    kiln_unit_pattern(units, option->dimension);
    kiln_unit_print_number(min, option->min);
    kiln_unit_print_number(max, option->max);
    if (kiln_unit_is_required(option->dimension)) {
        min[0] = max[0] = '0';
        min[1] = max[1] = '\0';
    }
    if (*units == '\0') {
        kiln_text_add(out, "{\"type\": \"number\", \"minimum\": %s, \"maximum\": %s}", min, max);
        return;
    }
    kiln_text_add(out,
                  "{\"type\": [\"number\", \"string\"], \"minimum\": %s, \"maximum\": %s, "
                  "\"pattern\": ",
                  min, max);
    struct kiln_text pattern = {0};
    kiln_text_add(&pattern, "^" NUMBER_PATTERN "%s$", units);
    kiln_text_add_json(out, pattern.data ? pattern.data : "");
    kiln_text_add(out, "}");
    out->failed |= pattern.failed;
    kiln_text_free(&pattern);
}

void kiln_schema_number_pattern(enum kiln_dimension dimension, struct kiln_text *out)
{
    char units[64];
    struct kiln_text pattern = {0};
    kiln_unit_pattern(units, dimension);
    kiln_text_add(&pattern, "^" NUMBER_PATTERN "(%s)?$", units);
    kiln_text_add_json(out, pattern.data ? pattern.data : "");
    out->failed |= pattern.failed;
    kiln_text_free(&pattern);
}

/* Appends the schema of the row's type, with the row's help as its description. */
static void add_property(const struct kiln_option *row, struct kiln_text *out)
{
    struct kiln_text schema = {0};
    row->type->schema(row, &schema);
    kiln_text_add_json(out, row->name);
    kiln_text_add(out, ": {\"description\": ");
    kiln_text_add_json(out, row->help);
    /* The type wrote one JSON object; the description goes in front of its members. */
    kiln_text_add(out, ", %s", schema.data ? schema.data + 1 : "");
    out->failed |= schema.failed;
    kiln_text_free(&schema);
}

void kiln_schema_members(const struct kiln_option *members, const char *variant,
                         bool variant_required, struct kiln_text *out)
{
    kiln_text_add(out, "{\"type\": \"object\", \"additionalProperties\": false, \"required\": [");
    const char *separator = "";
    for (const struct kiln_option *row = members; row->name; row++) {
        if (row->fallback)
            continue;
        kiln_text_add(out, "%s\"%s\"", separator, row->name);
        separator = ", ";
    }
    if (variant_required)
        kiln_text_add(out, "%s\"field\"", separator);
    kiln_text_add(out, "], \"properties\": {");
    separator = "\n";
    for (const struct kiln_option *row = members; row->name; row++) {
        kiln_text_add(out, "%s", separator);
        add_property(row, out);
        separator = ",\n";
    }
    if (variant)
        kiln_text_add(out, "%s\"field\": {\"const\": \"%s\"}", separator, variant);
    kiln_text_add(out, "}}");
}

bool kiln_schema_write(FILE *out, const char *title, const struct kiln_option *rows)
{
    struct kiln_text text = {0}, root = {0};
    kiln_schema_members(rows, NULL, false, &root);
    kiln_text_add(&text,
                  "{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
                  "\"title\": \"%s\",\n\"definitions\": {",
                  title);
    kiln_value_schema_definitions(&text);
    kiln_text_add(&text, "},\n%s\n", root.data ? root.data + 1 : "");
    bool ok = !text.failed && !root.failed && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&root);
    kiln_text_free(&text);
    return ok;
}
