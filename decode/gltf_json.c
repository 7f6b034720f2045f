/* This file reads JSON by Jansson. Numbers become doubles, as in JavaScript: all numbers of glTF
 * are smaller than the integers that doubles hold. */
#include "gltf_json.h"

#include <string.h>

#include "base/error.h"
#include "base/library.h"
#include "decode.h"

static struct {
    KILN_LIBRARY_POINTER(json_loadb)
    KILN_LIBRARY_POINTER(json_delete)
    KILN_LIBRARY_POINTER(json_object_get)
    KILN_LIBRARY_POINTER(json_array_size)
    KILN_LIBRARY_POINTER(json_array_get)
    KILN_LIBRARY_POINTER(json_real_value)
    KILN_LIBRARY_POINTER(json_string_value)
} jansson;

/* Why the library is not there. */
static struct kiln_error missing;

void decode_mesh_begin(void)
{
    static const struct kiln_library_function functions[] = {
        {"json_loadb", &jansson.json_loadb},
        {"json_delete", &jansson.json_delete},
        {"json_object_get", &jansson.json_object_get},
        {"json_array_size", &jansson.json_array_size},
        {"json_array_get", &jansson.json_array_get},
        {"json_real_value", &jansson.json_real_value},
        {"json_string_value", &jansson.json_string_value},
    };
    kiln_library_open("libjansson.so.4", "libjansson4", functions,
                      sizeof functions / sizeof *functions, &missing);
}

json_t *gltf_json_read(const char *text, size_t size, struct kiln_error *error)
{
    static const char mark[] = "\xef\xbb\xbf"; /* a byte order mark, which readers may ignore */
    const size_t skipped = size >= 3 && memcmp(text, mark, 3) == 0 ? 3 : 0;
    json_error_t fault;
    if (missing.code != KILN_OK || !jansson.json_loadb) {
        kiln_error_set(error, missing.code, "%s", missing.message);
        return NULL;
    }
    json_t *root = jansson.json_loadb(text + skipped, size - skipped,
                                      JSON_DECODE_INT_AS_REAL | JSON_ALLOW_NUL, &fault);
    if (root)
        return root;
    if (json_error_code(&fault) == json_error_out_of_memory)
        decode_out_of_memory(error);
    else if (json_error_code(&fault) == json_error_premature_end_of_input)
        kiln_error_set(error, KILN_INVALID_INPUT, "the JSON is cut short");
    else
        kiln_error_set(error, KILN_INVALID_INPUT, "line %d of the JSON is broken: %s", fault.line,
                       fault.text);
    return NULL;
}

void gltf_json_free(json_t **root)
{
    if (*root && (*root)->refcount != SIZE_MAX && --(*root)->refcount == 0)
        jansson.json_delete(*root);
    *root = NULL;
}

const json_t *gltf_member(const json_t *object, const char *key)
{
    return jansson.json_object_get(object, key);
}

uint32_t gltf_size(const json_t *array)
{
    return (uint32_t)jansson.json_array_size(array);
}

const json_t *gltf_item(const json_t *array, size_t number)
{
    return jansson.json_array_get(array, number);
}

bool gltf_number(const json_t *value, double *number)
{
    if (!value || !json_is_real(value))
        return false;
    *number = jansson.json_real_value(value);
    return true;
}

bool gltf_index(const json_t *value, uint32_t *number)
{
    double read = 0.0;
    if (!gltf_number(value, &read) || !(read >= 0.0 && read < (double)UINT32_MAX))
        return false;
    *number = (uint32_t)read;
    return (double)*number == read;
}

const char *gltf_string(const json_t *value)
{
    return jansson.json_string_value(value);
}

bool gltf_is(const json_t *value, const char *text)
{
    const char *found = gltf_string(value);
    return found && strcmp(found, text) == 0;
}

size_t gltf_text(const json_t *value, char *text, size_t size)
{
    const char *found = gltf_string(value);
    snprintf(text, size, "%s", found ? found : "");
    return found ? strlen(found) : 0;
}
