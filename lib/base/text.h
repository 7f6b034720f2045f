/* Declares text functions beside those of kiln_program.h. They write numbers, add to text buffers
 * that grow, and check UTF-8. */
#ifndef KILN_BASE_TEXT_H
#define KILN_BASE_TEXT_H

#include "kiln_program.h"

/* Writes the shortest decimal text that reads back as the same float or double, which is finite. */
void kiln_text_from_float(char out[32], float value);
void kiln_text_from_double(char out[32], double value);

/* Writes a double rounded to so many significant digits: 17 at most. */
void kiln_text_from_rounded(char out[32], double value, int digits);

/* A text buffer that grows; a zero-initialised one is empty. After memory ran short, `failed` stays
 * true and nothing more is added. The owner frees `data` with kiln_text_free. */
struct kiln_text {
    char *data; /* always ends in a zero once something was added */
    size_t length, capacity;
    bool failed;
};

/* Adds formatted text. The arguments may not point into text->data. */
void kiln_text_add(struct kiln_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void kiln_text_free(struct kiln_text *text);

/* Returns the number of bytes of the character at the start of a zero-terminated text: 1 to 4, or 0
 * if they are not valid UTF-8. It is 1 at the end of the text. */
size_t kiln_text_character_length(const char *text);

/* Adds a JSON string literal, quotes included. Invalid UTF-8 becomes U+FFFD. */
void kiln_text_add_json(struct kiln_text *text, const char *string);

/* Adds a word so that a shell takes it as one. */
void kiln_text_add_shell_word(struct kiln_text *text, const char *word);

#endif
