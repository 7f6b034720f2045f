/* Small text helpers: numbers without locale, the nearest of known names, growing buffers. */
#ifndef KILN_BASE_TEXT_H
#define KILN_BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads a whole text as a decimal number with '.' as its point in any locale. False when something
 * is left over, or it is not finite. */
bool kiln_text_to_double(const char *text, double *value);
bool kiln_text_to_uint64(const char *text, uint64_t *value);

/* The shortest decimal text that reads back as the same float or double. */
void kiln_text_from_float(char out[32], float value);
void kiln_text_from_double(char out[32], double value);

/* The candidate nearest to name by edit distance (swapped neighbours count once), or NULL when
 * none is near enough to be a misspelling. */
const char *kiln_text_nearest(const char *name, const char *const *candidates, size_t count);

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

/* Adds a JSON string literal, quotes included. Invalid UTF-8 becomes U+FFFD. */
void kiln_text_add_json(struct kiln_text *text, const char *string);

#endif
