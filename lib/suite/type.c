/* Reads the values of options that test files and expect.yaml alone have: overrides, techniques,
 * devices, sizes, frames, limits and masks. */
#include "suite/type.h"

#include <stdlib.h>
#include <string.h>

#include "compare/metric.h"
#include "frame/technique.h"
#include "option/rows.h"
#include "suite/golden.h"

static bool is_keyword(const struct kiln_node *node, const char *keyword)
{
    return !node->quoted && kiln_node_is(node, keyword);
}

/* ---- texts ---------------------------------------------------------------------------------- */

static bool read_override(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, void *field)
{
    if (!kiln_type_text.read(reader, option, node, field))
        return false;
    const char *const *text = field;
    const char *equals = strchr(*text, '=');
    return (equals && equals != *text) || kiln_reader_mismatch(reader, option, node);
}

static void describe_override(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "key=value, as for --set");
}

static void schema_override(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"pattern\": \"^[^=]+=\"}");
}

const struct kiln_option_type kiln_type_override = {
    .read = read_override, .describe = describe_override, .schema = schema_override};

static bool read_technique(struct kiln_reader *reader, const struct kiln_option *option,
                           const struct kiln_node *node, void *field)
{
    if (!kiln_type_text.read(reader, option, node, field))
        return false;
    static const struct kiln_device_info any_device = {.gl = true, .exact = true};
    const char *const *text = field;
    struct kiln_techniques techniques;
    struct kiln_error error = {0};
    if (kiln_techniques_choose(&any_device, text, 1, &techniques, &error))
        return true;
    static const char prefix[] = "technique: ";
    bool has_prefix = strncmp(error.message, prefix, sizeof prefix - 1) == 0;
    return kiln_reader_error(reader, node, "%s",
                             error.message + (has_prefix ? sizeof prefix - 1 : 0));
}

static void describe_technique(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "stage=name, as 'kiln help techniques' lists them");
}

const struct kiln_option_type kiln_type_technique = {.read = read_technique,
                                                     .describe = describe_technique};

static bool read_device(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    char name[KILN_DEVICE_NAME_SIZE];
    if (!kiln_type_text.read(reader, option, node, field))
        return false;
    kiln_device_name(*(const char *const *)field, name);
    return *name || kiln_reader_mismatch(reader, option, node);
}

static void describe_device(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "software, a part of a device's name, or its number");
}

const struct kiln_option_type kiln_type_device = {.read = read_device, .describe = describe_device};

/* ---- size ----------------------------------------------------------------------------------- */

static bool read_size(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    uint32_t *size = field;
    if (is_keyword(node, "scene")) {
        size[0] = size[1] = 0;
        return true;
    }
    if (node->kind != KILN_NODE_LIST || node->count != 2)
        return kiln_reader_mismatch(reader, option, node);
    return kiln_read_whole(reader, option, node->first, &size[0]) &&
           kiln_read_whole(reader, option, node->first->next, &size[1]);
}

static void describe_size(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "[width, height], each");
    kiln_option_describe_limits(option, out);
    kiln_text_add(out, ", or scene");
}

const struct kiln_option_type kiln_type_size = {.read = read_size, .describe = describe_size};

/* ---- frames --------------------------------------------------------------------------------- */

static bool read_frame_number(const char **text, uint32_t *frame)
{
    char digits[8] = "";
    size_t length = strspn(*text, "0123456789");
    uint64_t number = 0;
    if (length == 0 || length >= sizeof digits)
        return false;
    memcpy(digits, *text, length);
    if (!kiln_text_to_uint64(digits, &number) || number > KILN_TEST_MAX_FRAME)
        return false;
    *frame = (uint32_t)number;
    *text += length;
    return true;
}

/* Adds the frames of a text to `frames`. The text is "24", "0-23" or several of these with commas
 * between them. */
static bool add_frames(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, uint32_t *frames, uint32_t *count)
{
    const char *text = node->kind == KILN_NODE_SCALAR ? node->text : "";
    for (;;) {
        uint32_t first = 0, last = 0;
        text += strspn(text, " ");
        if (!read_frame_number(&text, &first))
            return kiln_reader_mismatch(reader, option, node);
        last = first;
        if (*text == '-') {
            text++;
            if (!read_frame_number(&text, &last) || last < first)
                return kiln_reader_mismatch(reader, option, node);
        }
        if (last - first >= option->max_count - *count)
            return kiln_reader_error(reader, node, "more than %zu frames; no more are allowed",
                                     option->max_count);
        for (uint32_t frame = first; frame <= last; frame++)
            frames[(*count)++] = frame;
        text += strspn(text, " ");
        if (*text == '\0')
            return true;
        if (*text++ != ',')
            return kiln_reader_mismatch(reader, option, node);
    }
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static bool read_frames(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    uint32_t *frames = field, *count = kiln_option_count_field(option, field), unique_count = 0;
    *count = 0;
    if (is_keyword(node, "auto"))
        return true;
    const struct kiln_node *first = node->kind == KILN_NODE_LIST ? node->first : node;
    if (!first)
        return kiln_reader_mismatch(reader, option, node);
    for (const struct kiln_node *entry = first; entry; entry = entry->next) {
        if (!add_frames(reader, option, entry, frames, count))
            return false;
        if (entry == node)
            break;
    }
    qsort(frames, *count, sizeof *frames, compare_numbers);
    for (uint32_t i = 0; i < *count; i++) {
        if (i == 0 || frames[i] != frames[i - 1])
            frames[unique_count++] = frames[i];
    }
    *count = unique_count;
    return true;
}

static void describe_frames(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "up to %zu frames as [24, 96] or \"0-23,40\", or auto", option->max_count);
}

const struct kiln_option_type kiln_type_frames = {.read = read_frames, .describe = describe_frames};

/* ---- limits --------------------------------------------------------------------------------- */

static bool read_limit(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, struct kiln_expect_value *value)
{
    const char *name = node->key->text;
    char limit[64];
    int length = node->kind == KILN_NODE_SCALAR
                     ? snprintf(limit, sizeof limit, "%s=%s", name, node->text)
                     : -1;
    /* Neither the name nor the number may contain a second limit. */
    if (length < 0 || (size_t)length >= sizeof limit || name[strcspn(name, ",=")] != '\0' ||
        !kiln_text_to_double(node->text, &value->value))
        return kiln_reader_mismatch(reader, option, node);
    const char *text = limit;
    struct kiln_metric_set set;
    struct kiln_error error = {0};
    if (!kiln_metric_set_make(&set, &text, 1, &error)) {
        const char *message = strstr(error.message, "': "); /* after "limit '...'" */
        return kiln_reader_error(reader, node->key, "%s", message ? message + 3 : error.message);
    }
    return kiln_reader_copy_text(reader, name, &value->metric);
}

static bool read_limits(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_expect_value *values = field;
    uint32_t *count = kiln_option_count_field(option, field);
    *count = 0;
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count > option->max_count)
        return kiln_reader_error(reader, node, "%u entries are too many; at most %zu are allowed",
                                 node->count, option->max_count);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        size_t before = kiln_reader_enter(reader, entry->key->text);
        if (!read_limit(reader, option, entry, &values[*count]))
            return false;
        kiln_reader_leave(reader, before);
        ++*count;
    }
    return true;
}

static void describe_limits(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{metric: number, ...}, as 'kiln help metrics' lists them");
}

const struct kiln_option_type kiln_type_limits = {.read = read_limits, .describe = describe_limits};

/* ---- masks ---------------------------------------------------------------------------------- */

static bool read_rectangle(struct kiln_reader *reader, const struct kiln_option *option,
                           const struct kiln_node *node, void *field)
{
    uint32_t *rect = field;
    if (is_keyword(node, "none")) {
        memset(rect, 0, 4 * sizeof *rect);
        return true;
    }
    if (node->kind != KILN_NODE_LIST || node->count != 4)
        return kiln_reader_mismatch(reader, option, node);
    const struct kiln_node *item = node->first;
    for (unsigned i = 0; i < 4; i++, item = item->next) {
        if (!kiln_read_whole(reader, option, item, &rect[i]))
            return false;
        if (i >= 2 && rect[i] == 0)
            return kiln_reader_error(reader, item,
                                     "the rectangle has no area; both edges must be above 0");
    }
    return true;
}

static void describe_rectangle(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "[x, y, width, height] in pixels from the upper left, each");
    kiln_option_describe_limits(option, out);
}

const struct kiln_option_type kiln_type_rectangle = {.read = read_rectangle,
                                                     .describe = describe_rectangle};

static bool read_mask(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    struct kiln_test_mask *mask = field;
    if (!kiln_read_members(reader, option->members, node, mask))
        return false;
    if (!*mask->picture)
        mask->picture = NULL;
    bool has_rect = mask->rect[2] > 0;
    return has_rect != (mask->picture != NULL) ||
           kiln_reader_error(reader, node, "expected either rect or picture, found %s",
                             has_rect ? "both" : "neither");
}

static void describe_mask(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{rect: [x, y, width, height]} or {picture: a file}, with a reason");
}

const struct kiln_option_type kiln_type_mask = {.read = read_mask, .describe = describe_mask};

#define FILLS struct kiln_test_mask

TABLE(mask_members) = {
    {ROW(NO_PART, "rect", rectangle, rect, "none", "Parts of the pictures that are not judged."),
     LIMITS(KILN_PLAIN, 0, 16384)},
    {ROW(NO_PART, "picture", text, picture, "\"\"",
         "A picture of the same size. Places where it is black are not judged."),
     LIMITS(KILN_PLAIN, 0, 4000)},
    {ROW(NO_PART, "reason", text, reason, "\"\"", "Why not."), LIMITS(KILN_PLAIN, 0, 4000)},
    END,
};

const struct kiln_option kiln_mask_item = {.type = &kiln_type_mask, MEMBERS(mask_members)};
