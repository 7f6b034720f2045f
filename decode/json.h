/* Declares a reader of JSON texts, which keeps the place of each value in the text and copies
 * nothing. libfyaml takes a hundred times as much memory for a text of many small values.
 *
 * A value is known by its number. JSON_NONE stands for a value that is missing, and all functions
 * take it: it is no object, no array and no number. */
#ifndef KILN_DECODE_JSON_H
#define KILN_DECODE_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kiln.h"

#define JSON_NONE UINT32_MAX

struct json_value {
    uint32_t start, end; /* the value's part of the text; of a string without its quotes */
    uint32_t next;       /* number of the value after this one and all that it contains */
    uint32_t kind;       /* '{', '[', '"', '0' (a number), or the first letter of a word */
};

struct json {
    const char *text;
    struct json_value *values; /* value 0 is the whole text; a member's key is before its value */
    uint32_t count, capacity;
};

/* Reads a text of at most 4 GiB, which must stay as long as the values are used. KILN_INVALID_INPUT
 * with the line of the first fault. json_finish is also called after a failure. */
bool json_init(struct json *json, const char *text, size_t size, struct kiln_error *error);
void json_finish(struct json *json);

/* Returns the value of an object's member. If a key comes twice, the last one counts, as in
 * JavaScript. */
uint32_t json_member(const struct json *json, uint32_t object, const char *key);

/* Visit the elements of an array or the keys of an object; JSON_NONE after the last. */
uint32_t json_first(const struct json *json, uint32_t list);
uint32_t json_after(const struct json *json, uint32_t list, uint32_t value);

/* Returns how many elements an array has; 0 if it is no array. */
uint32_t json_count(const struct json *json, uint32_t array);

/* Returns the value that belongs to a key that json_first or json_after has given. */
uint32_t json_value_of(uint32_t key);

bool json_is_object(const struct json *json, uint32_t value);
bool json_is_array(const struct json *json, uint32_t value);
bool json_is_true(const struct json *json, uint32_t value);

/* Gets a number; false if the value is none, or is not finite as a double. */
bool json_number(const struct json *json, uint32_t value, double *number);

/* Gets a whole number from 0 to UINT32_MAX - 1; false if the value is none. */
bool json_index(const struct json *json, uint32_t value, uint32_t *number);

/* Returns whether a value is this string. */
bool json_is(const struct json *json, uint32_t value, const char *text);

/* Decodes a string as UTF-8 of at most `size` bytes with a zero at the end. Returns the length that
 * the whole string has, which may be larger; 0 if the value is no string. Zeros become U+FFFD. */
size_t json_text(const struct json *json, uint32_t value, char *text, size_t size);

#endif
