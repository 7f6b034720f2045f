/* Declares functions that write numbers and build texts of any length. The library writes JSON,
 * YAML and reports with them. Functions that read numbers are in kiln_program.h, since the program
 * calls them, too. */
#ifndef KILN_BASE_TEXT_H
#define KILN_BASE_TEXT_H

#include "kiln_program.h"

/* Write the shortest decimal text that reads back as the same float or double. Infinities and NaN
 * are written as by printf. The decimal point is a point in every locale. */
void kiln_text_from_float(char out[32], float value);
void kiln_text_from_double(char out[32], double value);

/* Writes a double, rounded to `digits` significant digits: 1 to 17. */
void kiln_text_from_rounded(char out[32], double value, int digits);

/* Holds a text that grows. A zero-initialised text is empty. Once memory was short, `failed` stays
 * true and nothing more is added. The owner frees `data` with kiln_text_free. */
struct kiln_text {
    char *data; /* zero-terminated; NULL until something is added */
    size_t length, capacity;
    bool failed;
};
void kiln_text_add(struct kiln_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void kiln_text_free(struct kiln_text *text);

/* Returns the number of bytes of the first character of a zero-terminated text: 1 to 4, or 0 where
 * the text does not begin with valid UTF-8. It is 1 for the empty text, whose zero counts. */
size_t kiln_text_character_length(const char *text);

/* Adds a JSON string literal, quotes included. Invalid UTF-8 becomes U+FFFD. */
void kiln_text_add_json(struct kiln_text *text, const char *string);

/* Adds a word, in quotes where it needs them, so that a POSIX shell reads it as one word. A word
 * with characters that a terminal acts on, or that nobody sees, is written as $'...' in ASCII. */
void kiln_text_add_shell_word(struct kiln_text *text, const char *word);

#endif
