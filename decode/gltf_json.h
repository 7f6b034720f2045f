/* Declares how the reader of glTF files reads JSON, by Jansson.
 *
 * NULL stands for a value that is missing, and all functions take it: it is no object, no array and
 * no number. */
#ifndef KILN_DECODE_GLTF_JSON_H
#define KILN_DECODE_GLTF_JSON_H

#include <jansson.h>

#include "kiln.h"

/* Reads a text. NULL: KILN_INVALID_INPUT with the line of the first fault. */
json_t *gltf_json_read(const char *text, size_t size, struct kiln_error *error);
void gltf_json_free(json_t **root);

/* Returns the value of an object's member. If a key comes twice, the last one counts, as in
 * JavaScript. */
const json_t *gltf_member(const json_t *object, const char *key);

/* Returns the number of elements of an array; 0 if the value is none. */
uint32_t gltf_size(const json_t *array);

/* Returns an element of an array; NULL behind the last. */
const json_t *gltf_item(const json_t *array, size_t number);

/* Gets a number; false if the value is none. */
bool gltf_number(const json_t *value, double *number);

/* Gets a whole number from 0 to UINT32_MAX - 1; false if the value is none. */
bool gltf_index(const json_t *value, uint32_t *number);

/* Returns whether a value is this string. */
bool gltf_is(const json_t *value, const char *text);

/* Returns a string, up to its first NUL; NULL if the value is none. */
const char *gltf_string(const json_t *value);

/* Copies a string of at most `size` bytes with the NUL at its end. Returns the length that the
 * whole string has, which may be larger; 0 if the value is no string. */
size_t gltf_text(const json_t *value, char *text, size_t size);

#endif
