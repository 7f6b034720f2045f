/* Compares the messages of errors with the whole text that a test expects. A test that looked for
 * only a few words of a message would pass even if the rest of the message were wrong. */
#ifndef KILN_TESTS_ERRORS_H
#define KILN_TESTS_ERRORS_H

#include "kiln.h"
#include "support/cmocka.h"

/* Returns whether an error has this code and this message, which is formatted as by printf. If not,
 * prints what was found and, below it, what was expected. */
bool is_error(const struct kiln_error *error, enum kiln_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Does what is_error does for a message that quotes words which kiln does not choose, such as those
 * of a driver's compiler. The message must start with the formatted text and end with `end`, which
 * may be "". Between the two there must be at least one character; these characters are not
 * compared. */
bool is_error_around(const struct kiln_error *error, enum kiln_code code, const char *end,
                     const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Does what is_error does for a message about a file that a library decodes. After the formatted
 * text the message may have the library's own words in parentheses, which are not compared. */
bool is_error_decoding(const struct kiln_error *error, enum kiln_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Returns whether an error says that the environment variable KILN_SIMD has the value `value`,
 * which names no SIMD level of this machine. If not, prints both texts. */
bool is_error_simd(const struct kiln_error *error, const char *value);

/* Does what is_error does for a text that has no error code, such as a warning or a summary. */
bool is_message(const char *found, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Each macro expect_NAME fails the test, at the line of the macro's caller, unless the function
 * is_NAME returns true. */
#define errors_expect(is_same)         ((is_same) ? (void)0 : _fail(__FILE__, __LINE__))
#define expect_error(error, code, ...) errors_expect(is_error(error, code, __VA_ARGS__))
#define expect_error_around(error, code, ...)                                                      \
    errors_expect(is_error_around(error, code, __VA_ARGS__))
#define expect_error_decoding(error, code, ...)                                                    \
    errors_expect(is_error_decoding(error, code, __VA_ARGS__))
#define expect_error_simd(error, value) errors_expect(is_error_simd(error, value))
#define expect_message(found, ...)      errors_expect(is_message(found, __VA_ARGS__))

#endif
