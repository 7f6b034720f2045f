/* Writes a JSON schema (draft-07) from the option tables. The schema is as strict as the loader
 * about keys, words, forms and units. It checks limits only for numbers without a unit. Only the
 * loader checks the order of values and the files that a text names. */
#include "option/schema.h"

#include <string.h>

#include "option/schema_share.h"
#include "option/value_form.h"

/* The texts that stand for a value of any kind in a scene: a parameter, or arithmetic. */
#define NAMED_PATTERN  "^[$][A-Za-z_][A-Za-z0-9_]*$|^="
#define NUMBER_PATTERN "[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?"

void kiln_schema_number(const struct kiln_option *option, struct kiln_text *out)
{
    char units[64], min[32], max[32];
    kiln_unit_pattern(units, option->dimension);
    if (option->is_of_clip) /* "%" is one more unit */
        snprintf(units + strlen(units) - 1, sizeof units - strlen(units) + 1, "|%%)");
    kiln_unit_print_number(min, option->min);
    kiln_unit_print_number(max, option->max);
    if (kiln_unit_is_required(option->dimension)) {
        min[0] = max[0] = '0';
        min[1] = max[1] = '\0';
    }
    if (*units == '\0' && !option->parts) {
        kiln_text_add(out, "{\"type\": \"number\", \"minimum\": %s, \"maximum\": %s}", min, max);
        return;
    }
    kiln_text_add(out,
                  "{\"type\": [\"number\", \"string\"], \"minimum\": %s, \"maximum\": %s, "
                  "\"pattern\": ",
                  min, max);
    struct kiln_text pattern = {0};
    if (option->parts && *units)
        kiln_text_add(&pattern, "^(" NUMBER_PATTERN "(%s%s))$|" NAMED_PATTERN, units,
                      option->is_of_clip ? "| *%" : "");
    else if (option->parts)
        kiln_text_add(&pattern, NAMED_PATTERN);
    else
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
    kiln_text_add(&pattern, "^" NUMBER_PATTERN "(%s%s)?$|" NAMED_PATTERN, units,
                  dimension == KILN_SECONDS ? "| *%" : "");
    kiln_text_add_json(out, pattern.data ? pattern.data : "");
    out->failed |= pattern.failed;
    kiln_text_free(&pattern);
}

/* Returns whether a value may be a parameter or arithmetic: whether the row is one of a scene,
 * whose rows have parts, and stands for a value. */
static bool may_be_named(const struct kiln_option *row)
{
    return row->parts && row->type != &kiln_type_group && row->type != &kiln_type_map &&
           row->type != &kiln_type_include && row->type != &kiln_type_params;
}

/* Appends the schema of the row's type, with the row's help as its description. */
static void add_property(const struct kiln_option *row, struct kiln_text *out)
{
    struct kiln_text schema = {0};
    if (may_be_named(row))
        kiln_text_add(&schema, "{\"anyOf\": [{\"type\": \"string\", \"pattern\": "
                               "\"" NAMED_PATTERN "\"}, ");
    row->type->schema(row, &schema);
    if (may_be_named(row))
        kiln_text_add(&schema, "]}");
    kiln_text_add_json(out, row->name);
    kiln_text_add(out, ": {\"description\": ");
    kiln_text_add_json(out, row->help);
    /* The type wrote one JSON object; the description goes in front of its members. */
    kiln_text_add(out, ", %s", schema.data ? schema.data + 1 : "");
    out->failed |= schema.failed;
    kiln_text_free(&schema);
}

static void add_members(const struct kiln_option *members, const char *variant,
                        bool variant_required, bool is_root, struct kiln_text *out)
{
    kiln_text_add(out, "{\"type\": \"object\", \"additionalProperties\": false, \"required\": [");
    const char *separator = "";
    for (const struct kiln_option *row = members; row->name; row++) {
        /* In a scene, what must be given may be in another file or entry, but for its version. */
        if (row->fallback || (row->parts && !is_root))
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

void kiln_schema_members(const struct kiln_option *members, const char *variant,
                         bool variant_required, struct kiln_text *out)
{
    add_members(members, variant, variant_required, false, out);
}

bool kiln_schema_write(FILE *out, const char *title, const struct kiln_option *rows)
{
    struct kiln_text text = {0}, whole = {0}, root = {0}, shared = {0};
    add_members(rows, NULL, false, true, &whole);
    if (!whole.failed)
        kiln_schema_share(whole.data, &root, &shared);
    kiln_text_add(&text,
                  "{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
                  "\"title\": \"%s\",\n\"definitions\": {",
                  title);
    kiln_value_schema_definitions(&text);
    kiln_text_add(&text, "%s},\n%s\n", shared.data ? shared.data : "",
                  root.data ? root.data + 1 : "");
    const bool made = !text.failed && !whole.failed && !root.failed && !shared.failed;
    const bool ok = made && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&shared);
    kiln_text_free(&root);
    kiln_text_free(&whole);
    kiln_text_free(&text);
    return ok;
}
