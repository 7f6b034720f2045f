/* This file prints values as a file writes them, so that reading the text gives the same bits. */
#include "option/animated.h"
#include "option/value_form.h"

/* ---- keys ----------------------------------------------------------------------------------- */

static const struct kiln_value_clock *clock_of(const struct kiln_value *value)
{
    const struct kiln_value_clock *clock = kiln_value_clocks;
    while (clock->clock != VALUE_CLOCK(value->how))
        clock++;
    return clock;
}

/* Returns whether the keys of a random value are where `choose` has them without weights. */
static bool chooses(const float4 *keys, const struct kiln_value *value)
{
    bool even =
        VALUE_CLOCK(value->how) == KILN_CLOCK_RANDOM && VALUE_EASE(value->how) == VALUE_STEP;
    for (uint32_t i = 0; i < value->count; i++)
        even = even && keys[value->first + i].x == (float)((double)i / (double)value->count);
    return even;
}

static void add_number(struct kiln_text *text, enum kiln_dimension dimension, float number)
{
    char out[48];
    kiln_unit_print(out, dimension, number);
    kiln_text_add(text, "%s", out);
}

/* Appends the values of key i of some components. */
static void add_key(struct kiln_printer *printer, enum kiln_dimension dimension,
                    const struct kiln_value *values, unsigned count, uint32_t i)
{
    kiln_text_add(&printer->text, count > 1 ? "[" : "");
    for (unsigned k = 0; k < count; k++) {
        kiln_text_add(&printer->text, k ? ", " : "");
        add_number(&printer->text, dimension, printer->keys[values[k].first + i].y);
    }
    kiln_text_add(&printer->text, count > 1 ? "]" : "");
}

static void add_keys(struct kiln_printer *printer, enum kiln_dimension dimension,
                     const struct kiln_value *values, unsigned count)
{
    const struct kiln_value_clock *clock = clock_of(values);
    const bool is_list = chooses(printer->keys, values);
    kiln_text_add(&printer->text, "{%s: %s", is_list ? "choose" : clock->name, is_list ? "[" : "{");
    for (uint32_t i = 0; i < values->count; i++) {
        kiln_text_add(&printer->text, i ? ", " : "");
        if (!is_list) {
            add_number(&printer->text, clock->axis.dimension, printer->keys[values->first + i].x);
            kiln_text_add(&printer->text, ": ");
        }
        add_key(printer, dimension, values, count, i);
    }
    kiln_text_add(&printer->text, is_list ? "]" : "}");
    if (VALUE_EASE(values->how) != VALUE_LINEAR && !is_list)
        kiln_text_add(&printer->text, ", ease: %s", kiln_value_eases[VALUE_EASE(values->how)]);
}

/* ---- values --------------------------------------------------------------------------------- */

static void add_value(struct kiln_printer *printer, const struct kiln_option *option,
                      const struct kiln_value *values, unsigned count);

/* Appends what stands beside the clock. */
static void add_besides(struct kiln_printer *printer, const struct kiln_option *option,
                        const struct kiln_value *values, unsigned count)
{
    const uint32_t how = values->how, draw = VALUE_DRAW(how), shared = 1u << (VALUE_DRAW_BITS - 1);
    const struct kiln_option times_row = kiln_value_times_row(option);
    const struct kiln_option plus_row = kiln_value_plus_row(option);
    struct kiln_value parts[3] = {0};
    if (VALUE_REPEAT(how) != VALUE_HOLDS)
        kiln_text_add(&printer->text, ", repeat: %s", kiln_value_repeats[VALUE_REPEAT(how)]);
    if (draw & shared)
        kiln_text_add(&printer->text, ", seed: %u", draw & ~shared);
    if (VALUE_CLOCK(how) == KILN_CLOCK_NOISE) {
        const float4 entry = printer->keys[values->first - 1];
        kiln_text_add(&printer->text, ", period: ");
        add_number(&printer->text, KILN_SECONDS, entry.z);
        kiln_text_add(&printer->text, ", octaves: %u, per: %s", (unsigned)entry.w,
                      how & VALUE_OF_PARTICLE ? "particle" : "system");
    }
    if (how & VALUE_TIMES) {
        parts[0] = value_part(printer->keys, *values, 1);
        kiln_text_add(&printer->text, ", times: ");
        add_value(printer, &times_row, parts, 1);
    }
    if (how & VALUE_PLUS) {
        for (unsigned i = 0; i < count; i++)
            parts[i] = value_part(printer->keys, values[i], 2);
        kiln_text_add(&printer->text, ", plus: ");
        add_value(printer, &plus_row, parts, count);
    }
}

/* Returns whether the values of components can be written as one. */
static bool are_whole(const float4 *keys, const struct kiln_value *values)
{
    return kiln_value3_is_whole(keys, &(struct kiln_value3){values[0], values[1], values[2]});
}

/* Appends a value of 1 or 3 components. */
static void add_value(struct kiln_printer *printer, const struct kiln_option *option,
                      const struct kiln_value *values, unsigned count)
{
    struct kiln_option unitless = *option; /* three units in a row are hard to read */
    if (count > 1 && !kiln_unit_is_required(option->dimension))
        unitless.dimension = KILN_PLAIN;
    if (count > 1 && !are_whole(printer->keys, values)) {
        for (unsigned i = 0; i < count; i++) {
            kiln_text_add(&printer->text, i ? ", " : "[");
            add_value(printer, &unitless, &values[i], 1);
        }
        kiln_text_add(&printer->text, "]");
        return;
    }
    if (values->count == 0) {
        add_number(&printer->text, option->dimension, values->constant);
        return;
    }
    add_keys(printer, unitless.dimension, values, count);
    add_besides(printer, option, values, count);
    kiln_text_add(&printer->text, "}");
}

void kiln_print_value(struct kiln_printer *printer, const struct kiln_option *option,
                      const struct kiln_value *value)
{
    add_value(printer, option, value, 1);
}

void kiln_print_vector(struct kiln_printer *printer, const struct kiln_option *option,
                       const struct kiln_value3 *vector)
{
    const struct kiln_value values[3] = {vector->x, vector->y, vector->z};
    add_value(printer, option, values, 3);
}
