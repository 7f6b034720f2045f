/* Converts numbers between units by a table with a row for each unit. Conversions are IEEE products
 * and quotients in double, so that a file gives the same floats on every machine. */
#include "option/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "kiln_program.h"

struct unit {
    enum kiln_dimension dimension;
    const char *name;
    double multiply, divide; /* x / 100 is rounded correctly, which x * 0.01 is not */
};

/* The units. The first unit of each dimension is its SI unit. */
static const struct unit units[] = {
    {KILN_FRACTION, "%", 1, 100},
    {KILN_SECONDS, "s", 1, 1},
    {KILN_SECONDS, "ms", 1, 1000},
    {KILN_SECONDS, "min", 60, 1},
    {KILN_SECONDS, "h", 3600, 1},
    {KILN_ANGLE, "rad", 1, 1},
    {KILN_ANGLE, "deg", KILN_PI / 180, 1},
    {KILN_ANGULAR_SPEED, "rad/s", 1, 1},
    {KILN_ANGULAR_SPEED, "deg/s", KILN_PI / 180, 1},
    {KILN_METRES, "m", 1, 1},
    {KILN_METRES, "cm", 1, 100},
    {KILN_METRES, "mm", 1, 1000},
    {KILN_SPEED, "m/s", 1, 1},
    {KILN_SPEED, "cm/s", 1, 100},
    {KILN_ACCELERATION, "m/s^2", 1, 1},
    {KILN_PER_SECOND, "1/s", 1, 1},
    {KILN_PER_METRE, "1/m", 1, 1},
    {KILN_KELVIN, "K", 1, 1},
    {KILN_PIXELS, "px", 1, 1},
    {KILN_STOPS, "stops", 1, 1},
};

enum { UNIT_COUNT = sizeof units / sizeof *units };

static const char *const choices[KILN_DIMENSION_COUNT] = {
    [KILN_PLAIN] = "",
    [KILN_FRACTION] = "none or %",
    [KILN_SECONDS] = "s, ms, min or h",
    [KILN_ANGLE] = "deg or rad",
    [KILN_ANGULAR_SPEED] = "deg/s or rad/s",
    [KILN_METRES] = "m, cm or mm",
    [KILN_SPEED] = "m/s or cm/s",
    [KILN_ACCELERATION] = "m/s^2",
    [KILN_PER_SECOND] = "1/s",
    [KILN_PER_METRE] = "1/m",
    [KILN_KELVIN] = "K",
    [KILN_PIXELS] = "px",
    [KILN_STOPS] = "stops",
};

const char *kiln_unit_name(enum kiln_dimension dimension)
{
    if (dimension == KILN_FRACTION)
        return "";
    for (size_t i = 0; i < UNIT_COUNT; i++) {
        if (units[i].dimension == dimension)
            return units[i].name;
    }
    return "";
}

const char *kiln_unit_choices(enum kiln_dimension dimension)
{
    return choices[dimension];
}

bool kiln_unit_is_required(enum kiln_dimension dimension)
{
    return dimension == KILN_ANGLE || dimension == KILN_ANGULAR_SPEED;
}

void kiln_unit_reduce(uint64_t *num, uint64_t *den)
{
    uint64_t divisor = *num, rest = *den;
    while (rest) {
        uint64_t next = divisor % rest;
        divisor = rest;
        rest = next;
    }
    *num /= divisor;
    *den /= divisor;
}

/* Returns the length of the decimal number at the start of a text, or 0. */
static size_t number_length(const char *text)
{
    static const char digits[] = "0123456789";
    size_t length = *text == '+' || *text == '-' ? 1 : 0;
    size_t whole = strspn(text + length, digits);
    length += whole;
    if (text[length] == '.') {
        size_t part = strspn(text + length + 1, digits);
        if (whole + part == 0)
            return 0;
        length += 1 + part;
    } else if (whole == 0) {
        return 0;
    }
    if (text[length] == 'e' || text[length] == 'E') {
        size_t sign = text[length + 1] == '+' || text[length + 1] == '-' ? 1 : 0;
        size_t exponent = strspn(text + length + 1 + sign, digits);
        if (exponent > 0)
            length += 1 + sign + exponent;
    }
    return length;
}

bool kiln_unit_split(const char *text, double *number, const char **unit)
{
    char digits[128];
    size_t length = number_length(text);
    if (length == 0 || length >= sizeof digits)
        return false;
    memcpy(digits, text, length);
    digits[length] = '\0';
    *unit = text + length + strspn(text + length, " ");
    return kiln_text_to_double(digits, number);
}

bool kiln_unit_to_si(enum kiln_dimension dimension, const char *unit, double *number)
{
    for (size_t i = 0; i < UNIT_COUNT; i++) {
        if (units[i].dimension == dimension && strcmp(units[i].name, unit) == 0) {
            *number = *number * units[i].multiply / units[i].divide;
            return true;
        }
    }
    return false;
}

static bool is_letter_or_digit(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* Returns the row of the longest unit that a text begins with, or NULL. */
static const struct unit *find_unit(const char *text)
{
    const struct unit *found = NULL;
    size_t longest = 0;
    for (size_t i = 0; i < UNIT_COUNT; i++) {
        const size_t length = strlen(units[i].name);
        if (length <= longest || strncmp(text, units[i].name, length) != 0 ||
            (text[length - 1] != '%' && is_letter_or_digit(text[length])))
            continue;
        found = &units[i];
        longest = length;
    }
    return found;
}

size_t kiln_unit_find(const char *text, enum kiln_dimension *dimension)
{
    const struct unit *unit = find_unit(text);
    if (unit)
        *dimension = unit->dimension;
    return unit ? strlen(unit->name) : 0;
}

bool kiln_unit_to_si_of(const char *text, size_t length, double *number)
{
    const struct unit *unit = find_unit(text);
    if (!unit || strlen(unit->name) != length)
        return false;
    *number = *number * unit->multiply / unit->divide;
    return true;
}

bool kiln_text_to_seconds(const char *text, double *seconds)
{
    const char *unit;
    return kiln_unit_split(text, seconds, &unit) &&
           (!*unit || kiln_unit_to_si(KILN_SECONDS, unit, seconds));
}

void kiln_unit_print_number(char out[32], double value)
{
    if (fabs(value) < 1e9 && floor(value) == value)
        snprintf(out, 32, "%.0f", value + 0.0); /* + 0.0 turns -0 into 0 */
    else
        kiln_text_from_double(out, value);
}

static void print_float(char out[32], float value)
{
    if (fabsf(value) < 1e9f && floorf(value) == value)
        kiln_unit_print_number(out, (double)value);
    else
        kiln_text_from_float(out, value);
}

static void add_unit(char out[48], const char *number, const char *unit)
{
    snprintf(out, 48, *unit ? "%s %s" : "%s%s", number, unit);
}

void kiln_unit_print(char out[48], enum kiln_dimension dimension, float value)
{
    char number[32];
    if (kiln_unit_is_required(dimension)) {
        print_float(number, (float)((double)value * (180 / KILN_PI)));
        double back = 0;
        if (kiln_text_to_double(number, &back) && (float)KILN_DEG(back) == value) {
            add_unit(out, number, dimension == KILN_ANGLE ? "deg" : "deg/s");
            return;
        }
    }
    print_float(number, value);
    add_unit(out, number, kiln_unit_name(dimension));
}

void kiln_unit_print_double(char out[48], enum kiln_dimension dimension, double value)
{
    char number[32];
    if (kiln_unit_is_required(dimension)) {
        kiln_unit_print(out, dimension, (float)value);
        return;
    }
    kiln_unit_print_number(number, value);
    add_unit(out, number, kiln_unit_name(dimension));
}

void kiln_unit_pattern(char out[64], enum kiln_dimension dimension)
{
    out[0] = '\0';
    size_t length = 0;
    for (size_t i = 0; i < UNIT_COUNT; i++) {
        if (units[i].dimension != dimension)
            continue;
        length += (size_t)snprintf(out + length, 64 - length, "%s", length ? "|" : " *(");
        for (const char *c = units[i].name; *c; c++)
            length += (size_t)snprintf(out + length, 64 - length, *c == '^' ? "\\%c" : "%c", *c);
    }
    if (length)
        snprintf(out + length, 64 - length, ")");
}

/* The rates of broadcast, which are written rounded: thousands of frames in 1001 seconds. */
static const struct {
    const char *text;
    uint64_t thousands;
} BROADCAST[] = {{"23.976", 24}, {"23.98", 24}, {"29.97", 30},  {"47.952", 48},
                 {"47.95", 48},  {"59.94", 60}, {"119.88", 120}};

bool kiln_unit_parse_rational(const char *text, uint64_t *num, uint64_t *den)
{
    char part[24];
    size_t length = strcspn(text, "/.");
    for (size_t i = 0; i < sizeof BROADCAST / sizeof *BROADCAST; i++) {
        if (strcmp(text, BROADCAST[i].text) != 0)
            continue;
        *num = 1000 * BROADCAST[i].thousands;
        *den = 1001;
        kiln_unit_reduce(num, den);
        return true;
    }
    if (length >= sizeof part || length == 0)
        return false;
    memcpy(part, text, length);
    part[length] = '\0';
    if (!kiln_text_to_uint64(part, num) || *num > UINT32_MAX)
        return false;
    *den = 1;
    const char *rest = text + length;
    uint64_t decimals = 0;
    if (*rest == '/') {
        if (!kiln_text_to_uint64(rest + 1, den))
            return false;
    } else if (*rest == '.') {
        if (strlen(rest + 1) > 6 || !kiln_text_to_uint64(rest + 1, &decimals))
            return false;
        for (size_t i = 0; i < strlen(rest + 1); i++)
            *den *= 10;
        *num = *num * *den + decimals;
    }
    if (*num == 0 || *den == 0)
        return false;
    kiln_unit_reduce(num, den);
    return *num <= UINT32_MAX && *den <= 1000000;
}
