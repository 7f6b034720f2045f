/* Declares small text helpers beside those of kiln_program.h: writing numbers, growing buffers. */
#ifndef KILN_BASE_TEXT_H
#define KILN_BASE_TEXT_H

#include "kiln_program.h"

/* The shortest decimal text that reads back as the same float or double. */
void kiln_text_from_float(char out[32], float value);
void kiln_text_from_double(char out[32], double value);

/* A double, rounded to so many significant digits: 17 at most. */
void kiln_text_from_rounded(char out[32], double value, int digits);

/* A growing text. Zero-initialised is empty; after memory ran short, `failed` stays true and
 * nothing more is added. The owner frees `data` with kiln_text_free. */
struct kiln_text {
    char *data; /* always ends in a zero once something was added */
    size_t length, capacity;
    bool failed;
};
void kiln_text_add(struct kiln_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void kiln_text_free(struct kiln_text *text);

/* The length of the valid UTF-8 sequence that starts a zero-terminated text, or 0. */
size_t kiln_text_utf8_length(const char *text);

/* Adds a JSON string literal, quotes included. Invalid UTF-8 becomes U+FFFD. */
void kiln_text_add_json(struct kiln_text *text, const char *string);

/* Adds a word so that a shell takes it as one. */
void kiln_text_add_shell_word(struct kiln_text *text, const char *word);

#endif
