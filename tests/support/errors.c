/* Compares error codes and messages with expected ones for tests of error handling, and prints both
 * where they differ. */
#include "support/errors.h"

#include <stdio.h>
#include <string.h>

#include "base/simd.h"

/* Prints an error, and the code and message that were expected instead. more: a text to print after
 * the expected message. Returns false. */
static bool print_both(const struct kiln_error *error, enum kiln_code code, const char *expected,
                       const char *more)
{
    print_error("found:    code %d: %s\nexpected: code %d: %s%s\n", (int)error->code,
                error->message, (int)code, expected, more);
    return false;
}

/* Returns whether a text starts with `start`, ends with `end`, and has at least one character
 * between them. */
static bool surrounds(const char *text, const char *start, const char *end)
{
    const size_t length = strlen(text), before = strlen(start), after = strlen(end);
    return length > before + after && memcmp(text, start, before) == 0 &&
           strcmp(text + length - after, end) == 0;
}

bool is_error(const struct kiln_error *error, enum kiln_code code, const char *format, ...)
{
    char expected[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(expected, sizeof expected, format, args);
    va_end(args);
    return (error->code == code && strcmp(error->message, expected) == 0) ||
           print_both(error, code, expected, "");
}

bool is_error_around(const struct kiln_error *error, enum kiln_code code, const char *end,
                     const char *format, ...)
{
    char more[64], expected[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(expected, sizeof expected, format, args);
    va_end(args);
    snprintf(more, sizeof more, "...%s", end);
    return (error->code == code && surrounds(error->message, expected, end)) ||
           print_both(error, code, expected, more);
}

bool is_error_decoding(const struct kiln_error *error, enum kiln_code code, const char *format, ...)
{
    char expected[KILN_MESSAGE_SIZE], start[KILN_MESSAGE_SIZE + 2];
    va_list args;
    va_start(args, format);
    vsnprintf(expected, sizeof expected, format, args);
    va_end(args);
    snprintf(start, sizeof start, "%s (", expected);
    return (error->code == code &&
            (strcmp(error->message, expected) == 0 || surrounds(error->message, start, ")"))) ||
           print_both(error, code, expected, ", and perhaps (...)");
}

bool is_error_simd(const struct kiln_error *error, const char *value)
{
    char levels[64] = "";
    for (enum kiln_simd level = 0; level < KILN_SIMD_COUNT; level++) {
        const size_t length = strlen(levels);
        if (kiln_simd_has(level))
            snprintf(levels + length, sizeof levels - length, "%s%s", length ? ", " : "",
                     kiln_simd_name(level));
    }
    return is_error(error, KILN_USAGE, "KILN_SIMD is '%s'; this machine has %s", value, levels);
}

bool is_message(const char *found, const char *format, ...)
{
    char expected[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(expected, sizeof expected, format, args);
    va_end(args);
    if (strcmp(found, expected) == 0)
        return true;
    print_error("found:    %s\nexpected: %s\n", found, expected);
    return false;
}
