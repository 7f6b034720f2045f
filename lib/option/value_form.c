/* This file has the tables of how a file may write a value that varies: the clocks, and what may
 * stand beside them. */
#include "option/value_form.h"

#include <string.h>

#include "option/animated.h"
#include "option/schema.h"

/* The longest distance and the highest speed that a key may have, in metres and m/s. */
#define FARTHEST 1000000

#define AXIS(name_, dimension_, min_, max_)                                                        \
    {                                                                                              \
        .name = name_, .type = &kiln_type_number, .dimension = dimension_, .min = min_,            \
        .max = max_                                                                                \
    }

/* A time, which may also be a part of the clip. */
#define TIME_AXIS                                                                                  \
    {                                                                                              \
        .name = "time", .type = &kiln_type_number, .dimension = KILN_SECONDS, .min = -100000,      \
        .max = 1000000, .is_of_clip = true                                                         \
    }

const struct kiln_option kiln_option_time = TIME_AXIS;

const struct kiln_value_clock kiln_value_clocks[KILN_VALUE_CLOCKS] = {
    {.name = "keys",
     .clock = KILN_CLOCK_TIME,
     .allowed = KILN_ALLOW_TIME,
     .axis = TIME_AXIS,
     .is_short = true},
    {.name = "life",
     .clock = KILN_CLOCK_LIFE,
     .allowed = KILN_ALLOW_LIFE,
     .axis = AXIS("life", KILN_FRACTION, 0, 1),
     .takes_list = true,
     .is_short = true},
    {.name = "age",
     .clock = KILN_CLOCK_AGE,
     .allowed = KILN_ALLOW_AGE,
     .axis = AXIS("age", KILN_SECONDS, 0, 1000000),
     .is_short = true},
    {.name = "speed",
     .clock = KILN_CLOCK_SPEED,
     .allowed = KILN_ALLOW_SPEED,
     .axis = AXIS("speed", KILN_SPEED, 0, FARTHEST)},
    {.name = "height",
     .clock = KILN_CLOCK_HEIGHT,
     .allowed = KILN_ALLOW_HEIGHT,
     .axis = AXIS("height", KILN_METRES, -FARTHEST, FARTHEST)},
    {.name = "distance",
     .clock = KILN_CLOCK_DISTANCE,
     .allowed = KILN_ALLOW_DISTANCE,
     .axis = AXIS("distance", KILN_METRES, 0, FARTHEST)},
    {.name = "random",
     .clock = KILN_CLOCK_RANDOM,
     .allowed = KILN_ALLOW_RANDOM,
     .axis = AXIS("quantile", KILN_FRACTION, 0, 1),
     .takes_list = true,
     .is_short = true},
    {.name = "choose",
     .clock = KILN_CLOCK_RANDOM,
     .allowed = KILN_ALLOW_RANDOM,
     .axis = AXIS("quantile", KILN_FRACTION, 0, 1),
     .takes_list = true,
     .only_list = true,
     .is_short = true},
    {.name = "noise",
     .clock = KILN_CLOCK_NOISE,
     .allowed = KILN_ALLOW_NOISE,
     .axis = AXIS("noise", KILN_FRACTION, 0, 1),
     .takes_list = true,
     .is_short = true},
};

const char *const kiln_value_eases[] = {
    [VALUE_LINEAR] = "linear", [VALUE_STEP] = "step", [VALUE_SMOOTH] = "smooth",
    [VALUE_IN] = "in",         [VALUE_OUT] = "out",   NULL,
};

const char *const kiln_value_repeats[] = {
    [VALUE_HOLDS] = "none",
    [VALUE_LOOPS] = "loop",
    [VALUE_MIRRORS] = "mirror",
    NULL,
};

const char *const kiln_value_whose[] = {"system", "particle", NULL};

#define ANY_ROW       ~0u
#define RANDOM_CLOCKS (1u << KILN_CLOCK_RANDOM)
#define NOISE_CLOCKS  (1u << KILN_CLOCK_NOISE)

const struct kiln_value_beside kiln_value_besides[KILN_VALUE_BESIDES] = {
    [KILN_BESIDE_EASE] = {"ease", ~0u, ANY_ROW},
    [KILN_BESIDE_REPEAT] = {"repeat", 1u << KILN_CLOCK_TIME | 1u << KILN_CLOCK_AGE,
                            KILN_ALLOW_FORMS},
    [KILN_BESIDE_TIMES] = {"times", ~0u, KILN_ALLOW_PARTS},
    [KILN_BESIDE_PLUS] = {"plus", ~0u, KILN_ALLOW_PARTS},
    [KILN_BESIDE_SEED] = {"seed", RANDOM_CLOCKS | NOISE_CLOCKS,
                          KILN_ALLOW_RANDOM | KILN_ALLOW_NOISE},
    [KILN_BESIDE_WEIGHTS] = {"weights", RANDOM_CLOCKS, KILN_ALLOW_RANDOM},
    [KILN_BESIDE_PERIOD] = {"period", NOISE_CLOCKS, KILN_ALLOW_NOISE},
    [KILN_BESIDE_OCTAVES] = {"octaves", NOISE_CLOCKS, KILN_ALLOW_NOISE},
    [KILN_BESIDE_PER] = {"per", NOISE_CLOCKS, KILN_ALLOW_NOISE},
};

bool kiln_value_takes_beside(const struct kiln_option *option, size_t beside)
{
    return (option->clocks & kiln_value_besides[beside].rows) != 0;
}

const struct kiln_option kiln_value_period = AXIS("period", KILN_SECONDS, 0.001, 1000000);
const struct kiln_option kiln_value_octaves = {
    .name = "octaves", .type = &kiln_type_integer, .min = 1, .max = VALUE_NOISE_OCTAVES};
const struct kiln_option kiln_value_seed = {
    .name = "seed", .type = &kiln_type_integer, .min = 0, .max = 65535};
const struct kiln_option kiln_value_weight = AXIS("weight", KILN_PLAIN, 0, 1000000);

/* Returns the clocks that the parts of a value may have. Those of a value that is summed up over
 * life are the same for the whole life. */
static unsigned clocks_of_parts(const struct kiln_option *option)
{
    const unsigned clocks = option->clocks & ~(unsigned)KILN_ALLOW_PARTS;
    return option->clocks & KILN_ALLOW_FORMS ? clocks : clocks & (unsigned)KILN_ALLOW_RANDOM;
}

struct kiln_option kiln_value_times_row(const struct kiln_option *option)
{
    return (struct kiln_option){.name = "times",
                                .type = &kiln_type_value,
                                .min = -1000000,
                                .max = 1000000,
                                .clocks = clocks_of_parts(option),
                                .draws = option->draws};
}

struct kiln_option kiln_value_plus_row(const struct kiln_option *option)
{
    struct kiln_option row = *option;
    row.special_word = NULL;
    row.max = option->max - option->min;
    row.min = -row.max;
    row.clocks = clocks_of_parts(option);
    return row;
}

const struct kiln_value_clock *kiln_value_clock_named(const char *name)
{
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++) {
        if (strcmp(kiln_value_clocks[i].name, name) == 0)
            return &kiln_value_clocks[i];
    }
    return NULL;
}

bool kiln_node_is_animated(const struct kiln_node *node)
{
    for (const struct kiln_node *entry = node->first; node->kind == KILN_NODE_MAP && entry;
         entry = entry->next) {
        const struct kiln_value_clock *clock = kiln_value_clock_named(entry->key->text);
        if (clock && clock->is_short)
            return true;
    }
    return false;
}

void kiln_value_describe_clocks(const struct kiln_option *option, struct kiln_text *out)
{
    const char *names[KILN_VALUE_CLOCKS];
    size_t count = 0;
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++) {
        if (option->clocks & kiln_value_clocks[i].allowed)
            names[count++] = kiln_value_clocks[i].name;
    }
    kiln_text_add(out, "a constant");
    for (size_t i = 0; i < count; i++)
        kiln_text_add(out, "%s%s",
                      i == 0           ? " or a mapping with "
                      : i + 1 == count ? " or "
                                       : ", ",
                      names[i]);
}

/* Appends the schema of the keys of a clock, whatever their values are. */
static void define_clock(const struct kiln_value_clock *clock, struct kiln_text *out)
{
    const char *list = "{\"type\": \"array\", \"minItems\": 1}";
    kiln_text_add(out, "\"over_%s\": {\"anyOf\": [%s%s", clock->name, clock->takes_list ? list : "",
                  clock->takes_list && !clock->only_list ? ", " : "");
    if (!clock->only_list) {
        kiln_text_add(out, "{\"type\": \"object\", \"minProperties\": 1, "
                           "\"propertyNames\": {\"pattern\": ");
        kiln_schema_number_pattern(clock->axis.dimension, out);
        kiln_text_add(out, "}}");
    }
    kiln_text_add(out, "]}");
}

static void define_words(const char *name, const char *const *words, struct kiln_text *out)
{
    kiln_text_add(out, ",\n\"beside_%s\": {\"enum\": [", name);
    for (size_t i = 0; words[i]; i++)
        kiln_text_add(out, "%s\"%s\"", i ? ", " : "", words[i]);
    kiln_text_add(out, "]}");
}

static void define_whole(const struct kiln_option *row, struct kiln_text *out)
{
    kiln_text_add(out,
                  ",\n\"beside_%s\": {\"type\": \"integer\", \"minimum\": %d, \"maximum\": %d}",
                  row->name, (int)row->min, (int)row->max);
}

/* Appends the schema of a mapping with a clock, whatever the values of its keys are. */
static void define_mapping(unsigned clocks, struct kiln_text *out)
{
    const struct kiln_option row = {.clocks = clocks};
    const char *separator = "";
    kiln_text_add(out, ",\n\"varies_%u\": {\"type\": \"object\", \"oneOf\": [", clocks);
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++) {
        if (clocks & kiln_value_clocks[i].allowed) {
            kiln_text_add(out, "%s{\"required\": [\"%s\"]}", separator, kiln_value_clocks[i].name);
            separator = ", ";
        }
    }
    kiln_text_add(out, "], \"additionalProperties\": false, \"properties\": {");
    separator = "";
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++) {
        if (clocks & kiln_value_clocks[i].allowed) {
            kiln_text_add(out, "%s\"%s\": {\"$ref\": \"#/definitions/over_%s\"}", separator,
                          kiln_value_clocks[i].name, kiln_value_clocks[i].name);
            separator = ", ";
        }
    }
    for (size_t i = 0; i < KILN_VALUE_BESIDES; i++) {
        if (kiln_value_takes_beside(&row, i))
            kiln_text_add(out, ", \"%s\": {\"$ref\": \"#/definitions/beside_%s\"}",
                          kiln_value_besides[i].name, kiln_value_besides[i].name);
    }
    kiln_text_add(out, "}}");
}

void kiln_value_schema_definitions(struct kiln_text *out)
{
    for (size_t i = 0; i < KILN_VALUE_CLOCKS; i++) {
        kiln_text_add(out, "%s", i ? ",\n" : "");
        define_clock(&kiln_value_clocks[i], out);
    }
    define_words("ease", kiln_value_eases, out);
    define_words("repeat", kiln_value_repeats, out);
    define_words("per", kiln_value_whose, out);
    define_whole(&kiln_value_seed, out);
    define_whole(&kiln_value_octaves, out);
    kiln_text_add(out, ",\n\"beside_period\": ");
    kiln_schema_number(&kiln_value_period, out);
    kiln_text_add(out, ",\n\"beside_weights\": {\"type\": \"array\", \"minItems\": 1, \"items\": ");
    kiln_schema_number(&kiln_value_weight, out);
    kiln_text_add(out,
                  "},\n\"beside_times\": {\"type\": [\"number\", \"string\", \"object\"]},\n"
                  "\"beside_plus\": {\"type\": [\"number\", \"string\", \"object\", \"array\"]}");
    static const unsigned rows[] = {KILN_OVER_TIME, KILN_AT_BIRTH, KILN_OVER_LIFE, KILN_WHEN_DRAWN,
                                    KILN_SUMMED_UP};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        define_mapping(rows[i], out);
}
