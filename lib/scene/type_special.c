/* Types with a form of their own: pair, name, bounds, bursts. */
#include <math.h>
#include <string.h>

#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"

/* ---- pair ----------------------------------------------------------------------------------- */

static bool read_pair(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    uint32_t *pair = field;
    if (node->kind != KILN_NODE_LIST || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    return kiln_read_whole(reader, option, node->first, &pair[0]) &&
           kiln_read_whole(reader, option, node->first->next, &pair[1]);
}

static void print_pair(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    (void)option;
    const uint32_t *pair = field;
    kiln_text_add(&printer->text, " [%u, %u]\n", pair[0], pair[1]);
}

static void describe_pair(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "two whole numbers [a, b], each");
    kiln_option_describe_limits(option, out);
}

static void schema_pair(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": ");
    kiln_schema_number(option, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_pair = {read_pair, print_pair, describe_pair, schema_pair};

/* ---- name: which systems there are is known when all are read ----------------------------------
 */

static bool keep_text(struct kiln_reader *reader, const struct kiln_node *node, void *field)
{
    const char *copy = kiln_arena_text(reader->arena, node->text, strlen(node->text));
    if (!copy)
        return kiln_reader_out_of_memory(reader);
    memcpy(field, &copy, sizeof copy);
    return true;
}

static bool read_name(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return kiln_reader_is_text(node) ? keep_text(reader, node, field)
                                     : kiln_reader_mismatch(reader, option, node);
}

static void print_name(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    (void)option;
    kiln_text_add(&printer->text, " ");
    kiln_text_add_json(&printer->text, *(const char *const *)field);
    kiln_text_add(&printer->text, "\n");
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

const struct kiln_option_type kiln_type_name = {read_name, print_name, describe_name, schema_name};

/* ---- clip: which ones there are, its file knows ------------------------------------------------
 */

static bool read_clip(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return node->kind == KILN_NODE_SCALAR && *node->text
               ? keep_text(reader, node, field)
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

const struct kiln_option_type kiln_type_clip = {read_clip, print_name, describe_clip, schema_clip};

/* ---- bounds --------------------------------------------------------------------------------- */

static bool read_corner(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, const char *name, float corner[3])
{
    const struct kiln_node *list = kiln_node_entry(node, name);
    if (!list || list->kind != KILN_NODE_LIST || list->count != 3)
        return kiln_reader_mismatch(reader, option, list ? list : node);
    const struct kiln_node *item = list->first;
    for (unsigned i = 0; i < 3; i++, item = item->next) {
        if (!kiln_read_float(reader, option, item, &corner[i]))
            return false;
    }
    return true;
}

static bool read_bounds(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_bounds *bounds = field;
    *bounds = (struct kiln_bounds){0};
    if (option->word && node->kind == KILN_NODE_SCALAR && strcmp(node->text, option->word) == 0)
        return true;
    if (node->kind != KILN_NODE_MAP || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    if (!read_corner(reader, option, node, "min", bounds->min) ||
        !read_corner(reader, option, node, "max", bounds->max))
        return false;
    for (unsigned i = 0; i < 3; i++) {
        if (!(bounds->min[i] < bounds->max[i]))
            return kiln_reader_error(reader, node, "min must be below max in x, y and z");
    }
    bounds->enabled = true;
    return true;
}

static void print_bounds(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_bounds *bounds = field;
    if (!bounds->enabled) {
        kiln_text_add(&printer->text, " %s\n", option->word);
        return;
    }
    char text[6][48];
    for (unsigned i = 0; i < 3; i++) {
        kiln_unit_print(text[i], KILN_PLAIN, bounds->min[i]);
        kiln_unit_print(text[3 + i], KILN_PLAIN, bounds->max[i]);
    }
    kiln_text_add(&printer->text, " {min: [%s, %s, %s], max: [%s, %s, %s]}\n", text[0], text[1],
                  text[2], text[3], text[4], text[5]);
}

static void describe_bounds(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{min: [x, y, z], max: [x, y, z]}, each number");
    kiln_option_describe_limits(option, out);
    if (option->word)
        kiln_text_add(out, ", or %s", option->word);
}

static void schema_bounds(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_text number = {0};
    kiln_schema_number(option, &number);
    const char *item = number.data ? number.data : "";
    const char *corner = "{\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": %s}";
    kiln_text_add(out, "{\"anyOf\": [");
    if (option->word)
        kiln_text_add(out, "{\"const\": \"%s\"}, ", option->word);
    kiln_text_add(out, "{\"type\": \"object\", \"required\": [\"min\", \"max\"], "
                       "\"additionalProperties\": false, \"properties\": {\"min\": ");
    kiln_text_add(out, corner, item);
    kiln_text_add(out, ", \"max\": ");
    kiln_text_add(out, corner, item);
    kiln_text_add(out, "}}]}");
    out->failed |= number.failed;
    kiln_text_free(&number);
}

const struct kiln_option_type kiln_type_bounds = {read_bounds, print_bounds, describe_bounds,
                                                  schema_bounds};

/* ---- bursts --------------------------------------------------------------------------------- */

static const struct kiln_option burst_time = {.name = "time",
                                              .type = &kiln_type_number,
                                              .dimension = KILN_SECONDS,
                                              .min = -100000,
                                              .max = 1000000};

static bool read_bursts(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_burst *bursts = field;
    uint32_t *count = (uint32_t *)((char *)field - option->offset + option->count_offset);
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count > option->max_count)
        return kiln_reader_error(reader, node, "%u bursts are too many; at most %zu", node->count,
                                 option->max_count);
    *count = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        struct kiln_burst *burst = &bursts[*count];
        size_t before = kiln_reader_enter(reader, entry->key->text);
        if (!kiln_read_number(reader, &burst_time, entry->key, &burst->time_s) ||
            !kiln_read_whole(reader, option, entry, &burst->count))
            return false;
        if (*count > 0 && burst->time_s <= burst[-1].time_s)
            return kiln_reader_error(reader, entry->key,
                                     "bursts must ascend, each after the one before");
        kiln_reader_leave(reader, before);
        ++*count;
    }
    return true;
}

static void print_bursts(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_burst *bursts = field;
    uint32_t count =
        *(const uint32_t *)((const char *)field - option->offset + option->count_offset);
    kiln_text_add(&printer->text, " {");
    for (uint32_t i = 0; i < count; i++) {
        char time[48];
        kiln_unit_print_double(time, KILN_SECONDS, bursts[i].time_s);
        kiln_text_add(&printer->text, "%s%s: %u", i ? ", " : "", time, bursts[i].count);
    }
    kiln_text_add(&printer->text, "}\n");
}

static void describe_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{time: particles, ...}, each a whole number");
    kiln_option_describe_limits(option, out);
}

static void schema_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"type\": \"object\", \"maxProperties\": %zu, \"propertyNames\": "
                  "{\"pattern\": ",
                  option->max_count);
    kiln_schema_number_pattern(KILN_SECONDS, out);
    kiln_text_add(out, "}, \"additionalProperties\": ");
    kiln_type_integer.schema(option, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_bursts = {read_bursts, print_bursts, describe_bursts,
                                                  schema_bursts};
