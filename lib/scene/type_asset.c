/* This file reads, prints and describes the types of options that name textures: assets (one, or a
 * list from which each particle gets one), motion, and the scale of motion. */
#include <string.h>

#include "asset/atlas/builtin.h"
#include "asset/image/image.h"
#include "option/schema.h"
#include "scene/asset_path.h"

/* ---- assets --------------------------------------------------------------------------------- */

static bool read_assets(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    const char **assets = field;
    uint32_t *count = kiln_option_count_field(option, field);
    const struct kiln_node *item = node;
    *count = 1;
    if (node->kind == KILN_NODE_LIST) {
        if (node->count < 1 || node->count > option->max_count)
            return kiln_reader_mismatch(reader, option, node);
        *count = (uint32_t)node->count;
        item = node->first;
    }
    for (uint32_t i = 0; i < *count; i++, item = item->next) {
        if (!kiln_reader_is_text(item))
            return kiln_reader_mismatch(reader, option, item);
        if (!kiln_read_asset(reader, item, &assets[i]))
            return false;
    }
    return true;
}

static void print_assets(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const char *const *assets = field;
    uint32_t count = kiln_option_count(option, field);
    kiln_text_add(&printer->text, count > 1 ? " [" : " ");
    for (uint32_t i = 0; i < count; i++) {
        kiln_text_add(&printer->text, "%s", i ? ", " : "");
        kiln_print_quoted(printer, kiln_asset_name(kiln_printer_scene(printer), assets[i]));
    }
    kiln_text_add(&printer->text, count > 1 ? "]\n" : "\n");
}

static void describe_assets(const struct kiln_option *option, struct kiln_text *out)
{
    for (size_t i = 0; kiln_builtin_name_at(i); i++)
        kiln_text_add(out, "\"builtin:%s\", ", kiln_builtin_name_at(i));
    kiln_text_add(out,
                  "or the path of an image or video file, from the scene's folder and inside it; "
                  "or a list of 1 to %zu of these",
                  option->max_count);
}

static void schema_assets(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_text one = {0};
    kiln_text_add(&one, "{\"type\": \"string\", \"pattern\": \"^(builtin:(");
    for (size_t i = 0; kiln_builtin_name_at(i); i++)
        kiln_text_add(&one, "%s%s", i ? "|" : "", kiln_builtin_name_at(i));
    kiln_text_add(&one, ")|(?!builtin:|/).+)$\"}");
    const char *item = one.data ? one.data : "";
    kiln_text_add(out,
                  "{\"anyOf\": [%s, {\"type\": \"array\", \"minItems\": 1, \"maxItems\": %zu, "
                  "\"items\": %s}]}",
                  item, option->max_count, item);
    out->failed |= one.failed;
    kiln_text_free(&one);
}

static void list_assets(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    for (size_t i = 0; kiln_builtin_name_at(i); i++)
        kiln_text_add(out, "%sbuiltin:%s", i ? "|" : "", kiln_builtin_name_at(i));
}

const struct kiln_option_type kiln_type_assets = {
    .read = read_assets,
    .print = print_assets,
    .describe = describe_assets,
    .schema = schema_assets,
    .list_choices = list_assets,
};

/* ---- motion --------------------------------------------------------------------------------- */

static bool read_motion(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    const char **motion = field;
    if (!kiln_reader_is_text(node) || kiln_builtin_name_of(node->text))
        return kiln_reader_mismatch(reader, option, node);
    for (const char *const *word = option->choices; *word; word++) {
        if (strcmp(node->text, *word) == 0) {
            *motion = *word;
            return true;
        }
    }
    return kiln_read_file_asset(reader, node, kiln_asset_sheet_check, motion);
}

static void print_motion(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    (void)option;
    const char *motion = *(const char *const *)field;
    kiln_text_add(&printer->text, " ");
    if (motion[0] == '/')
        kiln_print_quoted(printer, kiln_asset_name(kiln_printer_scene(printer), motion));
    else
        kiln_text_add(&printer->text, "%s", motion);
    kiln_text_add(&printer->text, "\n");
}

static void describe_motion(const struct kiln_option *option, struct kiln_text *out)
{
    for (const char *const *word = option->choices; *word; word++)
        kiln_text_add(out, "%s, ", *word);
    kiln_text_add(out, "or the path of an image file, from the scene's folder and inside it");
}

static void schema_motion(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"pattern\": \"^(?!builtin:|/).+$\"}");
}

const struct kiln_option_type kiln_type_motion = {
    .read = read_motion,
    .print = print_motion,
    .describe = describe_motion,
    .schema = schema_motion,
};

/* ---- the scale of motion --------------------------------------------------------------------- */

static bool read_motion_scale(struct kiln_reader *reader, const struct kiln_option *option,
                              const struct kiln_node *node, void *field)
{
    struct kiln_motion_scale *scale = field;
    *scale = (struct kiln_motion_scale){.given = !kiln_node_is(node, "auto")};
    if (!scale->given)
        return true;
    if (node->kind == KILN_NODE_MAP || (node->kind == KILN_NODE_LIST && node->count != 2))
        return kiln_reader_mismatch(reader, option, node);
    const bool pair = node->kind == KILN_NODE_LIST;
    return kiln_read_number(reader, option, pair ? node->first : node, &scale->right) &&
           kiln_read_number(reader, option, pair ? node->last : node, &scale->up);
}

static void print_motion_scale(struct kiln_printer *printer, const struct kiln_option *option,
                               const void *field)
{
    const struct kiln_motion_scale *scale = field;
    char right[48], up[48];
    kiln_unit_print_double(right, option->dimension, scale->right);
    kiln_unit_print_double(up, option->dimension, scale->up);
    if (!scale->given)
        kiln_text_add(&printer->text, " auto\n");
    else if (scale->right == scale->up)
        kiln_text_add(&printer->text, " %s\n", right);
    else
        kiln_text_add(&printer->text, " [%s, %s]\n", right, up);
}

static void describe_motion_scale(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "auto, a number");
    kiln_option_describe_limits(option, out);
    kiln_text_add(out, ", or two of these, [right, up]");
}

static void schema_motion_scale(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [{\"const\": \"auto\"}, ");
    kiln_schema_number(option, out);
    kiln_text_add(out, ", {\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": ");
    kiln_schema_number(option, out);
    kiln_text_add(out, "}]}");
}

static void list_motion_scale(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "auto");
}

const struct kiln_option_type kiln_type_motion_scale = {
    .read = read_motion_scale,
    .print = print_motion_scale,
    .describe = describe_motion_scale,
    .schema = schema_motion_scale,
    .list_choices = list_motion_scale,
};
