/* Declares the dimensions of numbers, and the units that a file may write them in. */
#ifndef KILN_OPTION_UNIT_H
#define KILN_OPTION_UNIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Names what a number measures. In memory, a number is always in the SI unit given here. */
enum kiln_dimension {
    KILN_PLAIN,         /* no unit */
    KILN_FRACTION,      /* a part of a whole; may be written as "50 %" */
    KILN_SECONDS,       /* s */
    KILN_ANGLE,         /* rad; a bare number other than 0 is refused */
    KILN_ANGULAR_SPEED, /* rad/s; a bare number other than 0 is refused */
    KILN_METRES,        /* m */
    KILN_SPEED,         /* m/s */
    KILN_ACCELERATION,  /* m/s^2 */
    KILN_PER_SECOND,    /* 1/s */
    KILN_PER_METRE,     /* 1/m */
    KILN_KELVIN,        /* K */
    KILN_PIXELS,        /* px */
    KILN_STOPS,         /* exposure in powers of two */
    KILN_DIMENSION_COUNT
};

/* Converts degrees to radians for the limits of an option table, with the loader's rounding. */
#define KILN_PI     3.14159265358979323846
#define KILN_DEG(x) ((x) * (KILN_PI / 180))

/* Returns a list of all units of a dimension, such as "m, cm or mm", or "" if it has none. */
const char *kiln_unit_choices(enum kiln_dimension dimension);

/* Returns whether a number other than 0 must have a unit. */
bool kiln_unit_is_required(enum kiln_dimension dimension);

/* Reduces a fraction of two positive numbers. */
void kiln_unit_reduce(uint64_t *num, uint64_t *den);

/* Reads "30", "12.5" or "30000/1001" as a positive fraction in its lowest terms, whose denominator
 * is at most a million. The rounded rates of broadcast, such as "29.97", are those that they stand
 * for: 30000/1001. */
bool kiln_unit_parse_rational(const char *text, uint64_t *num, uint64_t *den);

/* Splits "2.5 cm" into its number and its unit, which points into text. Returns false if text does
 * not start with a number. Blanks between number and unit are optional. */
bool kiln_unit_split(const char *text, double *number, const char **unit);

/* Converts a number in a unit to SI. Returns false if the unit is not of this dimension. */
bool kiln_unit_to_si(enum kiln_dimension dimension, const char *unit, double *number);

/* Returns the length of the longest unit that a text begins with, and the dimension of that unit; 0
 * if it begins with none. A unit ends where no letter or digit follows. */
size_t kiln_unit_find(const char *text, enum kiln_dimension *dimension);

/* Converts a number in the unit that a text begins with, of a length that kiln_unit_find returned,
 * to SI. */
bool kiln_unit_to_si_of(const char *text, size_t length, double *number);

/* Returns the unit that numbers of a dimension are printed with, or "" if there is none. */
const char *kiln_unit_name(enum kiln_dimension dimension);

/* Writes a number in SI with its unit, so that reading the text gives the same float. Angles are
 * written in degrees if that is exact, otherwise in radians. */
void kiln_unit_print(char out[48], enum kiln_dimension dimension, float value);

/* Writes a limit or a double in SI with its unit, like kiln_unit_print. */
void kiln_unit_print_double(char out[48], enum kiln_dimension dimension, double value);

/* Writes a number without a unit. Whole numbers below 10^9 have no exponent. */
void kiln_unit_print_number(char out[32], double value);

/* Writes the units of a dimension as a regular expression for a JSON schema, with optional blanks
 * before the unit: " *(m|cm|mm)". Writes "" if there are none. */
void kiln_unit_pattern(char out[64], enum kiln_dimension dimension);

#endif
