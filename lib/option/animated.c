/* Reads values: constants, and mappings with a clock, its keys, and what stands beside it. */
#include "option/animated.h"

#include <float.h>
#include <string.h>

#include "option/color.h"
#include "option/expression.h"
#include "option/value_curve.h"

/* ---- constants ------------------------------------------------------------------------------ */

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

bool kiln_read_plain(struct kiln_reader *reader, const struct kiln_option *option,
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

/* ---- mappings ------------------------------------------------------------------------------- */

/* Returns the number of a draw: of the row, the entry of a list, the component of a vector that
 * varies in each component, and the part of the value; or one that the file gives. A row's number
 * is below 128, so that the bit above it is free for the entries of a list from the 129th on. */
static uint32_t draw_of(const struct kiln_reader *reader, const struct kiln_curve *curve,
                        unsigned component, unsigned part, const uint32_t *seed)
{
    const uint32_t clock = curve->clock->clock;
    if (clock != KILN_CLOCK_RANDOM && clock != KILN_CLOCK_NOISE)
        return 0;
    if (seed)
        return 1u << (VALUE_DRAW_BITS - 1) | *seed;
    const uint32_t item = (reader->item & 128u) << 11 | (reader->item & 127u) << 4;
    return (curve->option->draws & 127u) << 11 | item | component << 2 | part;
}

/* The entries of a mapping that is a value. */
struct form {
    const struct kiln_node *node;  /* the mapping */
    const struct kiln_node *curve; /* its clock */
    const struct kiln_value_clock *clock;
    const struct kiln_node *beside[KILN_VALUE_BESIDES]; /* NULL: missing */
};

static bool no_value(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node)
{
    struct kiln_text allowed = {0};
    kiln_value_describe_clocks(option, &allowed);
    kiln_reader_error(reader, node, "expected %s, found a mapping",
                      allowed.data ? allowed.data : "");
    kiln_text_free(&allowed);
    return false;
}

static bool unknown_entry(struct kiln_reader *reader, const struct kiln_node *entry)
{
    const char *names[KILN_VALUE_BESIDES + KILN_VALUE_CLOCKS];
    size_t count = 0;
    char suggestion[512];
    for (size_t i = 0; i < KILN_VALUE_BESIDES; i++)
        names[count++] = kiln_value_besides[i].name;
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++)
        names[count++] = kiln_value_clocks[i].name;
    kiln_option_suggest(suggestion, sizeof suggestion, entry->key->text, names, count);
    kiln_reader_enter(reader, entry->key->text);
    return kiln_reader_error(reader, entry->key, "unknown key%s", suggestion);
}

static bool take_entry(struct kiln_reader *reader, struct form *form, const struct kiln_node *entry)
{
    const char *name = entry->key->text;
    const struct kiln_value_clock *clock = kiln_value_clock_named(name);
    if (clock && form->clock)
        return kiln_reader_error(reader, entry->key, "expected one clock, found '%s' and '%s'",
                                 form->clock->name, name);
    if (clock) {
        form->clock = clock;
        form->curve = entry;
        return true;
    }
    for (size_t i = 0; i < KILN_VALUE_BESIDES; i++) {
        if (strcmp(name, kiln_value_besides[i].name) == 0) {
            form->beside[i] = entry;
            return true;
        }
    }
    return unknown_entry(reader, entry);
}

/* Returns whether the row takes the clock and all that stands beside it. */
static bool check_form(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct form *form)
{
    const char *clock = form->clock->name;
    if (!(option->clocks & form->clock->allowed)) {
        struct kiln_text allowed = {0};
        kiln_value_describe_clocks(option, &allowed);
        kiln_reader_enter(reader, clock);
        kiln_reader_error(reader, form->curve->key, "cannot vary over %s here; allowed is %s",
                          strcmp(clock, "keys") == 0 ? "time" : clock,
                          allowed.data ? allowed.data : "");
        kiln_text_free(&allowed);
        return false;
    }
    for (size_t i = 0; i < KILN_VALUE_BESIDES; i++) {
        const struct kiln_node *entry = form->beside[i];
        const bool is_known = (kiln_value_besides[i].clocks & 1u << form->clock->clock) != 0 &&
                              (i != KILN_BESIDE_WEIGHTS || form->clock->only_list) &&
                              (i != KILN_BESIDE_EASE || !form->clock->only_list);
        if (entry && !is_known)
            return kiln_reader_error(reader, entry->key, "'%s' does not go with '%s'",
                                     kiln_value_besides[i].name, clock);
        if (entry && !kiln_value_takes_beside(option, i))
            return kiln_reader_error(reader, entry->key, "'%s' is not possible here",
                                     kiln_value_besides[i].name);
    }
    return true;
}

static bool read_form(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, struct form *form)
{
    *form = (struct form){.node = node};
    bool any = false;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next)
        any = any || kiln_value_clock_named(entry->key->text);
    if (!any)
        return no_value(reader, option, node);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        if (!take_entry(reader, form, entry))
            return false;
    }
    return check_form(reader, option, form);
}

/* Reads a word of a table, or leaves *value as it is where there is none. */
static bool read_word(struct kiln_reader *reader, const struct kiln_node *entry,
                      const char *const *words, uint32_t *value)
{
    if (!entry)
        return true;
    const struct kiln_option row = {.type = &kiln_type_choice, .choices = words};
    unsigned word = 0;
    size_t before = kiln_reader_enter(reader, entry->key->text);
    if (!row.type->read(reader, &row, entry, &word))
        return false;
    kiln_reader_leave(reader, before);
    *value = word;
    return true;
}

static bool read_whole(struct kiln_reader *reader, const struct kiln_node *entry,
                       const struct kiln_option *row, uint32_t *value)
{
    size_t before = entry ? kiln_reader_enter(reader, row->name) : 0;
    if (!entry)
        return true;
    if (!kiln_read_whole(reader, row, entry, value))
        return false;
    kiln_reader_leave(reader, before);
    return true;
}

/* ---- keys ----------------------------------------------------------------------------------- */

static bool read_points(struct kiln_reader *reader, const struct kiln_node *node,
                        struct kiln_curve *curve, const double *places)
{
    struct kiln_option option = *curve->option;
    option.special_word = NULL; /* a key is a number, never the option's word */
    uint32_t index = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next, index++) {
        float x = 0, y[3] = {0};
        size_t before = entry->key ? kiln_reader_enter(reader, entry->key->text)
                                   : kiln_reader_enter_index(reader, index);
        if (entry->key && !kiln_read_float(reader, &curve->clock->axis, entry->key, &x))
            return false;
        if (!entry->key && places)
            x = (float)places[index];
        else if (!entry->key && node->count > 1) /* at equal distances */
            x = (float)((double)index / (double)(node->count - 1));
        if (!kiln_read_plain(reader, &option, entry, y, curve->count))
            return false;
        if (!(places && places[index] < 0) &&
            !kiln_curve_add(reader, entry->key ? entry->key : entry, curve, x, y))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}

/* Reads the weights of a choice, and finds at which part of all of them each entry begins: below 0
 * for one without weight. Sets how many have a weight. */
static bool read_weights(struct kiln_reader *reader, const struct form *form, double *places,
                         uint32_t *weighed)
{
    const struct kiln_node *weights = form->beside[KILN_BESIDE_WEIGHTS],
                           *entry = weights ? weights->first : NULL;
    const uint32_t count = form->curve->count;
    double sum = 0;
    size_t before = weights ? kiln_reader_enter(reader, "weights") : reader->path_length;
    if (weights && (weights->kind != KILN_NODE_LIST || weights->count != count))
        return kiln_reader_error(reader, weights,
                                 "expected a list of %u weights, one for each of "
                                 "what is chosen from",
                                 count);
    for (uint32_t i = 0; i < count; i++) {
        double weight = 1;
        if (entry && !kiln_read_number(reader, &kiln_value_weight, entry, &weight))
            return false;
        places[i] = weight > 0 ? sum : -1;
        sum += weight;
        entry = entry ? entry->next : NULL;
        *weighed += weight > 0 ? 1 : 0;
    }
    if (*weighed == 0)
        return kiln_reader_error(reader, weights, "one weight at least must be above 0");
    for (uint32_t i = 0; i < count; i++)
        places[i] /= sum;
    kiln_reader_leave(reader, before);
    return true;
}

/* Reads the keys of a value's clock. */
static bool read_keys(struct kiln_reader *reader, const struct form *form, struct kiln_curve *curve,
                      uint32_t how)
{
    const struct kiln_node *keys = form->curve;
    const struct kiln_value_clock *clock = form->clock;
    double places[KILN_NODE_MAX_ENTRIES];
    uint32_t count = clock->only_list ? 0 : keys->count;
    size_t before = kiln_reader_enter(reader, clock->name);
    if (!clock->takes_list && keys->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, keys,
                                    clock->clock == KILN_CLOCK_TIME ? "a mapping {time: value, ...}"
                                                                    : "a mapping {x: value, ...}");
    if (clock->only_list && keys->kind != KILN_NODE_LIST)
        return kiln_reader_expected(reader, keys, "a list of what is chosen from");
    if (keys->kind == KILN_NODE_SCALAR)
        return kiln_reader_expected(reader, keys,
                                    clock->clock == KILN_CLOCK_LIFE
                                        ? "[first, ..., last] or {part of life: value}"
                                        : "[least, ..., most] or {part: value}");
    const bool chooses = clock->only_list;
    kiln_reader_leave(reader, before);
    if (chooses && keys->count > 0 && keys->count <= KILN_NODE_MAX_ENTRIES &&
        !read_weights(reader, form, places, &count))
        return false;
    before = kiln_reader_enter(reader, clock->name);
    if (!kiln_curve_begin(reader, keys, curve, count, how) ||
        !read_points(reader, keys, curve, chooses ? places : NULL))
        return false;
    kiln_reader_leave(reader, before);
    return true;
}

/* ---- values --------------------------------------------------------------------------------- */

/* Where a value stands in another one. */
struct standing {
    unsigned component; /* of a vector that varies in each component, from 1; 0: it is a whole */
    unsigned part;      /* of the value (value_part) */
};

static bool read_value(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, struct kiln_value *values, unsigned count,
                       struct standing at);

/* What multiplies a value, and what is added to it. */
struct parts {
    struct kiln_value times, plus[3];
};

static bool read_parts(struct kiln_reader *reader, const struct form *form,
                       const struct kiln_curve *curve, struct standing at, struct parts *parts)
{
    const struct kiln_node *times = form->beside[KILN_BESIDE_TIMES],
                           *plus = form->beside[KILN_BESIDE_PLUS];
    struct kiln_option times_row = kiln_value_times_row(curve->option);
    struct kiln_option plus_row = kiln_value_plus_row(curve->option);
    size_t before = times ? kiln_reader_enter(reader, "times") : reader->path_length;
    at.part = 1;
    if (times && !read_value(reader, &times_row, times, &parts->times, 1, at))
        return false;
    kiln_reader_leave(reader, before);
    before = plus ? kiln_reader_enter(reader, "plus") : reader->path_length;
    at.part = 2;
    if (plus && !read_value(reader, &plus_row, plus, parts->plus, curve->count, at))
        return false;
    kiln_reader_leave(reader, before);
    return true;
}

/* Reads how a value's noise varies. */
static bool read_noise(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct form *form, float4 *entry, uint32_t *how)
{
    uint32_t octaves = 1, whose = option->clocks & KILN_ALLOW_OWN_NOISE ? 1 : 0;
    float period_s = 1;
    const struct kiln_node *period = form->beside[KILN_BESIDE_PERIOD];
    size_t before = period ? kiln_reader_enter(reader, "period") : reader->path_length;
    if (period && !kiln_read_float(reader, &kiln_value_period, period, &period_s))
        return false;
    kiln_reader_leave(reader, before);
    if (!read_whole(reader, form->beside[KILN_BESIDE_OCTAVES], &kiln_value_octaves, &octaves) ||
        !read_word(reader, form->beside[KILN_BESIDE_PER], kiln_value_whose, &whose))
        return false;
    if (whose == 1 && !(option->clocks & KILN_ALLOW_OWN_NOISE))
        return kiln_reader_error(reader, form->beside[KILN_BESIDE_PER],
                                 "a noise of each particle is not possible here; allowed is "
                                 "per: system");
    entry->z = period_s;
    entry->w = (float)octaves;
    *how |= whose == 1 ? VALUE_OF_PARTICLE : 0;
    return true;
}

/* Refuses a value that is summed up over life and may get out of the row's limits, since its sum
 * could not be kept within them. */
static bool check_sums(struct kiln_reader *reader, const struct kiln_curve *curve,
                       const struct form *form)
{
    const struct kiln_option *option = curve->option;
    if (option->clocks & KILN_ALLOW_FORMS ||
        (!form->beside[KILN_BESIDE_TIMES] && !form->beside[KILN_BESIDE_PLUS]))
        return true;
    char reached[48];
    for (unsigned i = 0; i < curve->count; i++) {
        const float least = kiln_value_least(reader->keys, &curve->values[i]);
        const float most = kiln_value_most(reader->keys, &curve->values[i]);
        const bool is_low = (double)least < option->min;
        if (!is_low && !((double)most > option->max))
            continue;
        struct kiln_text limits = {0};
        kiln_option_describe_limits(option, &limits);
        kiln_unit_print(reached, option->dimension, is_low ? least : most);
        kiln_reader_error(reader, form->node, "may reach %s; allowed is a number%s", reached,
                          limits.data ? limits.data : "");
        kiln_text_free(&limits);
        return false;
    }
    return true;
}

/* Writes the entries before the first key of each component. */
static void finish_entries(struct kiln_reader *reader, const struct kiln_curve *curve,
                           const struct parts *parts, float4 noise)
{
    const bool is_limited = (curve->option->clocks & KILN_ALLOW_FORMS) != 0;
    const float low = is_limited ? (float)curve->option->min : -FLT_MAX;
    const float high = is_limited ? (float)curve->option->max : FLT_MAX;
    for (unsigned i = 0; i < curve->count; i++) {
        float4 *first = &reader->keys[curve->values[i].first];
        if (curve->entries > 0)
            first[-1] = FLOAT4(low, high, noise.z, noise.w);
        if (curve->values[i].how & VALUE_TIMES)
            first[-2] = kiln_curve_pack(&parts->times);
        if (curve->values[i].how & VALUE_PLUS)
            first[-3] = kiln_curve_pack(&parts->plus[i]);
    }
}

/* Reads a mapping. */
static bool read_curve(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, struct kiln_value *values, unsigned count,
                       struct standing at)
{
    struct form form;
    struct parts parts = {.times = {.constant = 1}};
    struct kiln_curve curve = {.option = option, .values = values, .count = count};
    float4 noise = FLOAT4(0, 0, 0, 0);
    uint32_t repeat = 0, seed = 0, how = 0;
    if (!read_form(reader, option, node, &form))
        return false;
    curve.clock = form.clock;
    curve.ease = form.clock->only_list ? VALUE_STEP : VALUE_LINEAR;
    if (!read_word(reader, form.beside[KILN_BESIDE_EASE], kiln_value_eases, &curve.ease) ||
        !read_word(reader, form.beside[KILN_BESIDE_REPEAT], kiln_value_repeats, &repeat) ||
        !read_whole(reader, form.beside[KILN_BESIDE_SEED], &kiln_value_seed, &seed) ||
        !read_parts(reader, &form, &curve, at, &parts))
        return false;
    if (curve.ease >= VALUE_SMOOTH && !(option->clocks & KILN_ALLOW_FORMS))
        return kiln_reader_error(reader, form.beside[KILN_BESIDE_EASE],
                                 "ease: '%s' is not possible here; allowed is linear or step",
                                 kiln_value_eases[curve.ease]);
    if (form.clock->clock == KILN_CLOCK_NOISE && !read_noise(reader, option, &form, &noise, &how))
        return false;
    how |= form.clock->clock | curve.ease << VALUE_EASE_SHIFT | repeat << VALUE_REPEAT_SHIFT;
    how |= form.beside[KILN_BESIDE_TIMES] ? VALUE_TIMES : 0;
    how |= form.beside[KILN_BESIDE_PLUS] ? VALUE_PLUS : 0;
    curve.entries = kiln_value_entries(how);
    const uint32_t draw = draw_of(reader, &curve, at.component, at.part,
                                  form.beside[KILN_BESIDE_SEED] ? &seed : NULL);
    if (!read_keys(reader, &form, &curve, how | draw << VALUE_DRAW_SHIFT))
        return false;
    finish_entries(reader, &curve, &parts, noise);
    return check_sums(reader, &curve, &form);
}

/* Reads a vector in each component. */
static bool read_components(struct kiln_reader *reader, const struct kiln_option *option,
                            const struct kiln_node *node, struct kiln_value *values,
                            struct standing at)
{
    struct kiln_option component = *option;
    if (node->count != 3)
        return kiln_reader_mismatch(reader, option, node);
    component.type = &kiln_type_value;
    component.special_word = NULL; /* it stands for the whole vector */
    const struct kiln_node *item = node->first;
    for (uint32_t i = 0; i < 3; i++, item = item->next) {
        size_t before = kiln_reader_enter_index(reader, i);
        at.component = i + 1;
        if (!read_value(reader, &component, item, &values[i], 1, at))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}

static bool read_value(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, struct kiln_value *values, unsigned count,
                       struct standing at)
{
    if (node->kind == KILN_NODE_MAP)
        return read_curve(reader, option, node, values, count, at);
    if (count == 3 && node->kind == KILN_NODE_LIST)
        return read_components(reader, option, node, values, at);
    if (node->kind == KILN_NODE_LIST || (count == 3 && option->type != &kiln_type_color))
        return kiln_reader_mismatch(reader, option, node);
    float constant[3] = {0};
    if (!kiln_read_plain(reader, option, node, constant, count))
        return false;
    for (unsigned i = 0; i < count; i++)
        values[i] = (struct kiln_value){.constant = constant[i]};
    return true;
}

bool kiln_read_animated(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, struct kiln_value *values, unsigned count)
{
    return read_value(reader, option, node, values, count, (struct standing){0});
}
