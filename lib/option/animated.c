/* Reads and prints the keys of animated numbers. It computes the slopes and areas of curves once,
 * in IEEE float, so that every technique interpolates with the same bits. */
#include "option/animated.h"

#include <math.h>
#include <string.h>

#include "option/color.h"
#include "option/expression.h"

bool kiln_node_is_animated(const struct kiln_node *node)
{
    return node->kind == KILN_NODE_MAP && node->first &&
           (strcmp(node->first->key->text, "keys") == 0 ||
            strcmp(node->first->key->text, "life") == 0);
}

/* ---- reading -------------------------------------------------------------------------------- */

/* Returns whether a scalar is nothing, a word or a text, such as "redd" or "0xff0000", and no
 * faulty number.
 */
static bool is_word(const struct kiln_node *node)
{
    return *node->text == '\0' || !strchr("+-.0123456789", *node->text) || node->text[1] == 'x';
}

/* Reports that a scalar is no colour: names a similar one, or the forms that a colour has. */
static bool color_error(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node)
{
    const char *names[KILN_COLOR_NAMES];
    for (size_t i = 0; i < KILN_COLOR_NAMES; i++)
        names[i] = kiln_color_name_at(i);
    const char *nearest = kiln_text_nearest(node->text, names, KILN_COLOR_NAMES);
    if (nearest)
        return kiln_reader_error(reader, node, "'%s' is not a colour; did you mean '%s'?",
                                 node->text, nearest);
    if (*node->text == '\0')
        return kiln_reader_error(
            reader, node,
            "found nothing; a colour that begins with '#', which also begins a "
            "comment, is in quotes: \"#e61e28\"");
    return kiln_reader_mismatch(reader, option, node);
}

/* Reads the components of one key or of a constant, which are plain numbers. */
static bool read_plain(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, float *out, unsigned count)
{
    struct kiln_option number = *option; /* the row for errors, which name the expected form */
    number.type = &kiln_type_number;
    number.clocks = 0;
    if (count == 1)
        return kiln_read_float(reader, &number, node, out);
    if (node->kind == KILN_NODE_SCALAR && option->type == &kiln_type_color) {
        if (kiln_color_parse(node->text, out))
            return true;
        if (is_word(node) && !kiln_expression_is(node))
            return color_error(reader, option, node);
        if (!kiln_read_float(reader, &number, node, out))
            return false;
        out[1] = out[2] = out[0];
        return true;
    }
    if (node->kind != KILN_NODE_LIST || node->count != count)
        return kiln_reader_expected(reader, node, "[x, y, z]");
    const struct kiln_node *item = node->first;
    for (unsigned i = 0; i < count; i++, item = item->next) {
        if (!kiln_read_float(reader, &number, item, &out[i]))
            return false;
    }
    return true;
}

/* Describes the curves of `count` components while their keys are read; `points` keys of each are
 * read. */
struct curve {
    struct kiln_value *values;
    unsigned count;
    uint32_t points;
};

/* Makes room for a number of keys. */
static bool reserve_keys(struct kiln_reader *reader, uint32_t count)
{
    if (count <= reader->key_room)
        return true;
    uint32_t room = reader->key_room ? reader->key_room : KILN_BLOCK_KEYS;
    while (room < count)
        room *= 2;
    float4 *keys = kiln_arena_alloc(reader->scratch, room, sizeof *keys);
    if (!keys)
        return false;
    if (reader->keys)
        memcpy(keys, reader->keys, reader->key_count * sizeof *keys);
    reader->keys = keys;
    reader->key_room = room;
    return true;
}

_Static_assert((int)KILN_NODE_MAX_ENTRIES <= VALUE_MAX_KEYS, "the search finds every key");

static bool begin_curve(struct kiln_reader *reader, const struct kiln_node *node,
                        struct curve *curve, uint32_t clock)
{
    if (node->count == 0)
        return kiln_reader_error(reader, node, "found no keys; at least one is needed");
    uint32_t needed = curve->count * node->count; /* node->count <= KILN_NODE_MAX_ENTRIES */
    if (needed > KILN_MAX_VALUE_KEYS - reader->key_count)
        return kiln_reader_error(
            reader, node,
            "%u keys are too many; %s has at most %d, and %u of them are used already", needed,
            reader->origin->kind, KILN_MAX_VALUE_KEYS, reader->key_count);
    if (!reserve_keys(reader, reader->key_count + needed))
        return kiln_reader_out_of_memory(reader);
    for (unsigned i = 0; i < curve->count; i++) {
        uint32_t first = reader->key_count + i * node->count;
        curve->values[i] =
            (struct kiln_value){.first = first, .count = node->count, .clock = clock};
    }
    reader->key_count += needed;
    return true;
}

/* Replaces numbers below 2^-100 by 0, since some stages flush denormals and some do not
 * (shared/exact.h). */
static float flush_denormals(float x)
{
    return fabsf(x) < 0x1p-100f ? 0 : x;
}

static bool add_point(struct kiln_reader *reader, const struct kiln_node *node, struct curve *curve,
                      float x, const float *y)
{
    for (unsigned i = 0; i < curve->count; i++) {
        float4 *key = &reader->keys[curve->values[i].first + curve->points];
        *key = FLOAT4(x, y[i], 0, flush_denormals(x * y[i]));
        if (curve->points == 0)
            continue;
        if (x <= key[-1].x)
            return kiln_reader_error(
                reader, node, "the time of a key must be later than that of the key before it");
        float slope = (y[i] - key[-1].y) / (x - key[-1].x);
        if (!isfinite(slope))
            return kiln_reader_error(reader, node,
                                     "the time of a key is too close to that of the key before it");
        key[-1].z = flush_denormals(slope);
        float area = (x - key[-1].x) * (0.5f * (key[-1].y + y[i]));
        key->w = flush_denormals(key[-1].w + area);
    }
    curve->points++;
    return true;
}

/* Rows that describe the x of a key, one for each clock. */
const struct kiln_option kiln_option_time = {.name = "time",
                                             .type = &kiln_type_number,
                                             .dimension = KILN_SECONDS,
                                             .min = -100000,
                                             .max = 1000000,
                                             .is_of_clip = true};
static const struct kiln_option life_axis = {
    .name = "life", .type = &kiln_type_number, .dimension = KILN_FRACTION, .min = 0, .max = 1};

static bool read_points(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct curve *curve,
                        const struct kiln_option *axis)
{
    uint32_t index = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next, index++) {
        float x = 0, y[3] = {0};
        size_t before = entry->key ? kiln_reader_enter(reader, entry->key->text)
                                   : kiln_reader_enter_index(reader, index);
        if (entry->key && !kiln_read_float(reader, axis, entry->key, &x))
            return false;
        if (!entry->key && node->count > 1) /* entries of a list are spread evenly over the life */
            x = (float)((double)index / (double)(node->count - 1));
        if (!read_plain(reader, option, entry, y, curve->count) ||
            !add_point(reader, entry->key ? entry->key : entry, curve, x, y))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}

static const char *allowed_clocks(const struct kiln_option *option)
{
    switch (option->clocks) {
    case KILN_ALLOW_TIME:
        return "a constant or {keys: {...}} over time";
    case KILN_ALLOW_LIFE:
        return "a constant or {life: ...} over a particle's life";
    case KILN_ALLOW_BOTH:
        return "a constant, {keys: {...}} over time or {life: ...} over a particle's life";
    default:
        return "a constant";
    }
}

static bool read_curve(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, struct kiln_value *values, unsigned count)
{
    if (!kiln_node_is_animated(node) || node->count != 1)
        return kiln_reader_error(reader, node, "expected %s, found a mapping",
                                 allowed_clocks(option));
    const struct kiln_node *keys = node->first;
    bool over_life = strcmp(keys->key->text, "life") == 0;
    uint32_t clock = over_life ? KILN_CLOCK_LIFE : KILN_CLOCK_TIME;
    size_t before = kiln_reader_enter(reader, keys->key->text);
    if (!(option->clocks & 1u << clock))
        return kiln_reader_error(reader, keys->key, "cannot vary over %s here; allowed is %s",
                                 over_life ? "life" : "time", allowed_clocks(option));
    if (!over_life && keys->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, keys, "a mapping {time: value, ...}");
    if (over_life && keys->kind == KILN_NODE_SCALAR)
        return kiln_reader_expected(reader, keys, "[first, ..., last] or {part of life: value}");
    struct curve curve = {.values = values, .count = count};
    struct kiln_option key_option = *option;
    key_option.special_word = NULL; /* a key is a number, never the option's word */
    if (!begin_curve(reader, keys, &curve, clock) ||
        !read_points(reader, &key_option, keys, &curve, over_life ? &life_axis : &kiln_option_time))
        return false;
    kiln_reader_leave(reader, before);
    return true;
}

bool kiln_read_animated(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct kiln_value *values, unsigned count)
{
    if (node->kind == KILN_NODE_MAP)
        return read_curve(reader, option, node, values, count);
    if (count == 3 && node->kind == KILN_NODE_LIST) {
        if (node->count != 3)
            return kiln_reader_mismatch(reader, option, node);
        struct kiln_option component = *option;
        component.type = &kiln_type_value;
        const struct kiln_node *item = node->first;
        for (uint32_t i = 0; i < 3; i++, item = item->next) {
            size_t before = kiln_reader_enter_index(reader, i);
            if (!kiln_read_animated(reader, &component, item, &values[i], 1))
                return false;
            kiln_reader_leave(reader, before);
        }
        return true;
    }
    if (node->kind == KILN_NODE_LIST || (count == 3 && option->type != &kiln_type_color))
        return kiln_reader_mismatch(reader, option, node);
    float constant[3] = {0};
    if (!read_plain(reader, option, node, constant, count))
        return false;
    for (unsigned i = 0; i < count; i++)
        values[i] = (struct kiln_value){.constant = constant[i]};
    return true;
}

/* ---- printing ------------------------------------------------------------------------------- */

void kiln_print_animated(struct kiln_printer *printer, const struct kiln_option *option,
                         const struct kiln_value *value)
{
    char x[48], y[48];
    if (value->count == 0) {
        kiln_unit_print(y, option->dimension, value->constant);
        kiln_text_add(&printer->text, "%s", y);
        return;
    }
    bool over_life = value->clock == KILN_CLOCK_LIFE;
    kiln_text_add(&printer->text, over_life ? "{life: {" : "{keys: {");
    for (uint32_t i = 0; i < value->count; i++) {
        float4 key = printer->keys[value->first + i];
        kiln_unit_print(x, over_life ? KILN_FRACTION : KILN_SECONDS, key.x);
        kiln_unit_print(y, option->dimension, key.y);
        kiln_text_add(&printer->text, "%s%s: %s", i ? ", " : "", x, y);
    }
    kiln_text_add(&printer->text, "}}");
}
