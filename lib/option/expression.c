/* Computes arithmetic by recursive descent over a text. Each value carries the powers of its base
 * units, so that only what fits is added. Sums, products, quotients and square roots are IEEE's and
 * sines are our own (option/sine.h), so that all machines compute the same bits. A text has a
 * length and a depth of brackets that it cannot exceed. */
#include "option/expression.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "option/params.h"
#include "option/sine.h"

enum { MOST_BYTES = 1000, MOST_DEPTH = 32, MOST_POWER = 100 };

enum { S, M, RAD, K, PX, STOPS };

static const int powers_of[KILN_DIMENSION_COUNT][KILN_BASE_UNITS] = {
    [KILN_SECONDS] = {[S] = 1},
    [KILN_ANGLE] = {[RAD] = 1},
    [KILN_ANGULAR_SPEED] = {[RAD] = 1, [S] = -1},
    [KILN_METRES] = {[M] = 1},
    [KILN_SPEED] = {[M] = 1, [S] = -1},
    [KILN_ACCELERATION] = {[M] = 1, [S] = -2},
    [KILN_PER_SECOND] = {[S] = -1},
    [KILN_PER_METRE] = {[M] = -1},
    [KILN_KELVIN] = {[K] = 1},
    [KILN_PIXELS] = {[PX] = 1},
    [KILN_STOPS] = {[STOPS] = 1},
};

/* ---- quantities ------------------------------------------------------------------------------ */

struct kiln_quantity kiln_quantity_of(enum kiln_dimension dimension, double value)
{
    struct kiln_quantity quantity = {.value = value};
    memcpy(quantity.powers, powers_of[dimension], sizeof quantity.powers);
    return quantity;
}

bool kiln_quantity_fits(const struct kiln_quantity *a, const struct kiln_quantity *b)
{
    return memcmp(a->powers, b->powers, sizeof a->powers) == 0;
}

bool kiln_quantity_dimension(const struct kiln_quantity *quantity, enum kiln_dimension *dimension)
{
    for (int i = 0; i < KILN_DIMENSION_COUNT; i++) {
        if (memcmp(quantity->powers, powers_of[i], sizeof powers_of[i]) != 0)
            continue;
        *dimension = (enum kiln_dimension)i;
        return true;
    }
    return false;
}

static bool is_plain(const struct kiln_quantity *quantity)
{
    return kiln_quantity_fits(quantity, &(struct kiln_quantity){0});
}

/* Writes the units of a quantity for messages: "m/s", "s^2 m", "no unit". */
static void describe(char out[64], const struct kiln_quantity *quantity)
{
    static const char *const names[KILN_BASE_UNITS] = {"s", "m", "rad", "K", "px", "stops"};
    enum kiln_dimension dimension = KILN_PLAIN;
    size_t length = 0;
    out[0] = '\0';
    if (is_plain(quantity) || kiln_quantity_dimension(quantity, &dimension)) {
        snprintf(out, 64, "%s", is_plain(quantity) ? "no unit" : kiln_unit_name(dimension));
        return;
    }
    for (int i = 0; i < KILN_BASE_UNITS; i++) {
        const int power = quantity->powers[i];
        if (power == 0 || length >= 48)
            continue;
        length += (size_t)snprintf(out + length, 64 - length, "%s%s", length ? " " : "", names[i]);
        if (power != 1)
            length += (size_t)snprintf(out + length, 64 - length, "^%d", power);
    }
}

/* ---- the parser ------------------------------------------------------------------------------ */

struct parser {
    struct kiln_reader *reader;
    const struct kiln_node *node;
    const char *at;  /* the rest of the text */
    bool is_of_clip; /* whether "%" is a part of the clip, as in the row that is read */
    int depth;       /* of brackets and signs */
};

static bool fail(struct parser *parser, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool fail(struct parser *parser, const char *format, ...)
{
    char message[KILN_MESSAGE_SIZE], quoted[64];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    kiln_node_quote(quoted, parser->node->text);
    return kiln_reader_error(parser->reader, parser->node, "\"%s\": %s", quoted, message);
}

static void skip_blanks(struct parser *parser)
{
    parser->at += strspn(parser->at, " \t\r\n");
}

static bool accept(struct parser *parser, char c)
{
    skip_blanks(parser);
    if (*parser->at != c)
        return false;
    parser->at++;
    return true;
}

/* Reports the text at the present place, in which `wanted` was expected. */
static bool fail_at(struct parser *parser, const char *wanted)
{
    char quoted[64];
    skip_blanks(parser);
    if (*parser->at == '\0')
        return fail(parser, "expected %s, found the end", wanted);
    kiln_node_quote(quoted, parser->at);
    return fail(parser, "expected %s, found '%s'", wanted, quoted);
}

static bool expect(struct parser *parser, char c)
{
    const char wanted[] = {'\'', c, '\'', '\0'};
    return accept(parser, c) || fail_at(parser, wanted);
}

static bool check(struct parser *parser, const struct kiln_quantity *result)
{
    return isfinite(result->value) || fail(parser, "the result is not a finite number");
}

static bool read_sum(struct parser *parser, struct kiln_quantity *result);

static bool read_number(struct parser *parser, struct kiln_quantity *result)
{
    const char *unit;
    enum kiln_dimension dimension = KILN_PLAIN;
    double value = 0;
    if (!kiln_unit_split(parser->at, &value, &unit))
        return fail_at(parser, "a number, a $name, a function or '('");
    const size_t length = kiln_unit_find(unit, &dimension);
    if (length > 0 && !kiln_unit_to_si_of(unit, length, &value))
        return fail_at(parser, "a number with a unit");
    parser->at = unit + length;
    if (dimension == KILN_FRACTION && parser->is_of_clip) {
        if (parser->reader->clip_s <= 0)
            return fail(parser, "the length of the clip is not known here");
        dimension = KILN_SECONDS;
        value *= parser->reader->clip_s;
    }
    *result = kiln_quantity_of(dimension, value);
    return check(parser, result);
}

static bool is_of_name(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static size_t name_length(const char *text)
{
    size_t length = 0;
    while (is_of_name(text[length]))
        length++;
    return length;
}

static bool read_parameter(struct parser *parser, struct kiln_quantity *result)
{
    char name[64];
    const size_t length = name_length(++parser->at);
    if (length == 0 || length >= sizeof name)
        return fail_at(parser, "the name of a parameter");
    memcpy(name, parser->at, length);
    name[length] = '\0';
    parser->at += length;
    return kiln_params_quantity(parser->reader, parser->node, name, result);
}

/* ---- functions ------------------------------------------------------------------------------- */

enum function { MIN, MAX, SIN, COS, SQRT, FLOOR, FUNCTION_COUNT };

static const char *const function_names[FUNCTION_COUNT] = {
    [MIN] = "min", [MAX] = "max", [SIN] = "sin", [COS] = "cos", [SQRT] = "sqrt", [FLOOR] = "floor"};

static bool apply_sine(struct parser *parser, enum function function, struct kiln_quantity *value)
{
    const struct kiln_quantity angle = kiln_quantity_of(KILN_ANGLE, 0);
    const char *name = function_names[function];
    char units[64];
    describe(units, value);
    if (!kiln_quantity_fits(value, &angle))
        return fail(parser, "%s takes an angle, in deg or rad, and found %s", name, units);
    if (!(fabs(value->value) <= KILN_SINE_MOST))
        return fail(parser, "%s takes at most %.0f rad", name, KILN_SINE_MOST);
    *value = kiln_quantity_of(KILN_PLAIN, function == SIN ? kiln_sine(value->value)
                                                          : kiln_cosine(value->value));
    return true;
}

static bool apply_root(struct parser *parser, struct kiln_quantity *value)
{
    char units[64];
    describe(units, value);
    if (value->value < 0)
        return fail(parser, "sqrt takes a number of at least 0");
    for (int i = 0; i < KILN_BASE_UNITS; i++) {
        if (value->powers[i] % 2 != 0)
            return fail(parser, "sqrt takes squares of units, and found %s", units);
        value->powers[i] /= 2;
    }
    value->value = sqrt(value->value);
    return true;
}

static bool apply(struct parser *parser, enum function function, struct kiln_quantity *value)
{
    switch (function) {
    case SIN:
    case COS:
        return apply_sine(parser, function, value);
    case SQRT:
        return apply_root(parser, value);
    case FLOOR:
        value->value = floor(value->value);
        return true;
    default:
        return true;
    }
}

/* Reads the further values of min or max. */
static bool read_more(struct parser *parser, enum function function, struct kiln_quantity *result)
{
    while (accept(parser, ',')) {
        struct kiln_quantity next;
        char a[64], b[64];
        if (!read_sum(parser, &next))
            return false;
        describe(a, result);
        describe(b, &next);
        if (!kiln_quantity_fits(result, &next))
            return fail(parser, "%s of %s and %s", function_names[function], a, b);
        if (function == MIN ? next.value < result->value : next.value > result->value)
            result->value = next.value;
    }
    return true;
}

static bool read_function(struct parser *parser, struct kiln_quantity *result)
{
    const size_t length = name_length(parser->at);
    for (int i = 0; i < FUNCTION_COUNT; i++) {
        const enum function function = (enum function)i;
        if (strlen(function_names[i]) != length ||
            strncmp(parser->at, function_names[i], length) != 0)
            continue;
        parser->at += length;
        if (!expect(parser, '(') || !read_sum(parser, result))
            return false;
        if ((function == MIN || function == MAX) && !read_more(parser, function, result))
            return false;
        return expect(parser, ')') && apply(parser, function, result);
    }
    return fail_at(parser, "a number, a $name, min, max, sin, cos, sqrt or floor");
}

/* ---- operators ------------------------------------------------------------------------------- */

static bool read_factor(struct parser *parser, struct kiln_quantity *result)
{
    if (++parser->depth > MOST_DEPTH)
        return fail(parser, "nested deeper than the %d levels that are allowed", MOST_DEPTH);
    bool ok;
    skip_blanks(parser);
    const char c = *parser->at;
    if (c == '(') {
        parser->at++;
        ok = read_sum(parser, result) && expect(parser, ')');
    } else if (c == '-' || c == '+') {
        parser->at++;
        ok = read_factor(parser, result);
        result->value = c == '-' ? -result->value : result->value;
    } else if (c == '$') {
        ok = read_parameter(parser, result);
    } else if ((c >= '0' && c <= '9') || c == '.') {
        ok = read_number(parser, result);
    } else {
        ok = read_function(parser, result);
    }
    parser->depth--;
    return ok;
}

static bool multiply(struct parser *parser, struct kiln_quantity *result,
                     const struct kiln_quantity *factor, bool divide)
{
    if (divide && factor->value == 0)
        return fail(parser, "division by 0");
    for (int i = 0; i < KILN_BASE_UNITS; i++) {
        const int power = result->powers[i] + (divide ? -factor->powers[i] : factor->powers[i]);
        if (power < -MOST_POWER || power > MOST_POWER)
            return fail(parser, "a unit has a power above %d", MOST_POWER);
        result->powers[i] = power;
    }
    result->value = divide ? result->value / factor->value : result->value * factor->value;
    return check(parser, result);
}

static bool read_product(struct parser *parser, struct kiln_quantity *result)
{
    if (!read_factor(parser, result))
        return false;
    for (;;) {
        struct kiln_quantity factor;
        const bool divide = accept(parser, '/');
        if (!divide && !accept(parser, '*'))
            return true;
        if (!read_factor(parser, &factor) || !multiply(parser, result, &factor, divide))
            return false;
    }
}

static bool read_sum(struct parser *parser, struct kiln_quantity *result)
{
    if (!read_product(parser, result))
        return false;
    for (;;) {
        struct kiln_quantity term;
        char a[64], b[64];
        const bool minus = accept(parser, '-');
        if (!minus && !accept(parser, '+'))
            return true;
        if (!read_product(parser, &term))
            return false;
        describe(a, result);
        describe(b, &term);
        if (!kiln_quantity_fits(result, &term))
            return fail(parser, "%s %s %s: both need the same unit", a, minus ? "-" : "+", b);
        result->value = minus ? result->value - term.value : result->value + term.value;
        if (!check(parser, result))
            return false;
    }
}

/* ---- use ------------------------------------------------------------------------------------- */

bool kiln_expression_is(const struct kiln_node *node)
{
    return node->kind == KILN_NODE_SCALAR && !node->literal && node->text[0] == '=';
}

static bool compute(struct kiln_reader *reader, const struct kiln_node *node, bool is_of_clip,
                    struct kiln_quantity *quantity)
{
    struct parser parser = {
        .reader = reader, .node = node, .at = node->text + 1, .is_of_clip = is_of_clip};
    const size_t length = strlen(node->text);
    if (length > MOST_BYTES)
        return kiln_reader_error(reader, node, "arithmetic of %zu bytes; at most %d are allowed",
                                 length, MOST_BYTES);
    if (!read_sum(&parser, quantity))
        return false;
    skip_blanks(&parser);
    return *parser.at == '\0' || fail_at(&parser, "+, -, * or /");
}

bool kiln_expression_compute(struct kiln_reader *reader, const struct kiln_node *node,
                             struct kiln_quantity *quantity)
{
    return compute(reader, node, false, quantity);
}

bool kiln_expression_read(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, double *value)
{
    struct parser parser = {.reader = reader, .node = node};
    struct kiln_quantity result;
    char units[64];
    if (!compute(reader, node, option->is_of_clip, &result))
        return false;
    const struct kiln_quantity wanted = kiln_quantity_of(option->dimension, 0);
    const bool is_bare =
        is_plain(&result) && (!kiln_unit_is_required(option->dimension) || result.value == 0);
    describe(units, &result);
    if (!is_bare && !kiln_quantity_fits(&result, &wanted)) {
        const char *allowed = kiln_unit_choices(option->dimension);
        return *allowed ? fail(&parser, "the result has %s; allowed is %s", units, allowed)
                        : fail(&parser, "the result is in %s; this number takes no unit", units);
    }
    *value = result.value;
    return true;
}
