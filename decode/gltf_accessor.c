/* This file reads the numbers of a glTF document: accessors of any component type, normalised or
 * not, interleaved or not, sparse or not, in a view or without one, as zeros. Every offset is
 * checked before a byte is read. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gltf.h"

/* ---- component types ------------------------------------------------------------------------- */

static const struct component {
    uint32_t number; /* in the file */
    uint32_t size;
    bool is_signed;
    double most; /* that a normalised integer is divided by; 0: it is no integer */
} components[] = {
    {5120, 1, true, 127.0},    {5121, 1, false, 255.0},       {5122, 2, true, 32767.0},
    {5123, 2, false, 65535.0}, {5124, 4, true, 2147483647.0}, {5125, 4, false, 4294967295.0},
    {5126, 4, true, 0.0},
};

static uint32_t word_at(const unsigned char *b)
{
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double component_at(const struct component *type, const unsigned char *at)
{
    if (type->most == 0.0) {
        const uint32_t bits = word_at(at);
        float value;
        memcpy(&value, &bits, sizeof value);
        return (double)value;
    }
    if (type->size == 1)
        return type->is_signed ? (double)(int8_t)at[0] : (double)at[0];
    if (type->size == 2) {
        const uint16_t value = (uint16_t)(at[0] | at[1] << 8);
        return type->is_signed ? (double)(int16_t)value : (double)value;
    }
    return type->is_signed ? (double)(int32_t)word_at(at) : (double)word_at(at);
}

/* The types of elements. A matrix has its columns one after the other, each of which begins at a
 * multiple of four bytes. */
static const struct shape {
    const char *name;
    uint32_t columns, rows;
} shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
              {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

static uint32_t column_size(const struct component *type, const struct shape *shape)
{
    const uint32_t size = type->size * shape->rows;
    return shape->columns > 1 ? (size + 3) / 4 * 4 : size;
}

/* ---- accessors ------------------------------------------------------------------------------- */

struct accessor {
    const json_t *json;
    uint32_t number, count;
    const struct component *type;
    const struct shape *shape;
    bool is_normalized;
    struct gltf_view view; /* from the first element on; without bytes: all elements are 0 */
};

static const struct component *find_component(const json_t *value)
{
    uint32_t number = 0;
    if (!gltf_index(value, &number))
        return NULL;
    for (size_t i = 0; i < sizeof components / sizeof *components; i++) {
        if (components[i].number == number)
            return &components[i];
    }
    return NULL;
}

static const struct shape *find_shape(const json_t *value)
{
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        if (gltf_is(value, shapes[i].name))
            return &shapes[i];
    }
    return NULL;
}

/* Gets the bytes of elements: the view from an offset on, which must have `count` elements. */
static bool find_elements(struct gltf *g, const struct accessor *a, const json_t *json,
                          uint32_t view, uint64_t count, uint64_t size, struct gltf_view *out)
{
    uint32_t offset = 0;
    const json_t *said = gltf_member(json, "byteOffset");
    if (said && !gltf_index(said, &offset))
        return GLTF_SET(g, "the byteOffset of accessor %u is no offset", a->number);
    if (!gltf_find_view(g, view, out))
        return false;
    if (out->stride == 0)
        out->stride = size;
    const uint64_t needed =
        count > 0 ? (uint64_t)offset + (count - 1) * (uint64_t)out->stride + size : 0;
    if (needed > out->size)
        return GLTF_SET(g, "accessor %u ends at byte %llu of a buffer view of %zu", a->number,
                        (unsigned long long)needed, out->size);
    out->bytes += count > 0 ? offset : 0;
    return true;
}

static bool open_accessor(struct gltf *g, uint32_t number, struct accessor *a)
{
    const json_t *json = gltf_element(g, GLTF_ACCESSORS, number);
    uint32_t view = 0;
    *a = (struct accessor){.json = json, .number = number};
    a->type = find_component(gltf_member(json, "componentType"));
    a->shape = find_shape(gltf_member(json, "type"));
    a->is_normalized = json_is_true(gltf_member(json, "normalized"));
    if (!a->type || !a->shape || !gltf_index(gltf_member(json, "count"), &a->count))
        return GLTF_SET(g,
                        "accessor %u has a componentType, a type or a count that glTF does not "
                        "have",
                        number);
    if (!gltf_reference(g, json, "bufferView", GLTF_VIEWS, &view))
        return false;
    const uint64_t size = (uint64_t)column_size(a->type, a->shape) * a->shape->columns;
    return view == GLTF_NONE || find_elements(g, a, json, view, a->count, size, &a->view);
}

bool gltf_count(struct gltf *g, uint32_t accessor, uint32_t most, const char *what, uint32_t *count)
{
    const json_t *json = gltf_element(g, GLTF_ACCESSORS, accessor);
    *count = 0;
    if (!gltf_index(gltf_member(json, "count"), count))
        return GLTF_SET(g, "accessor %u has no count", accessor);
    return *count <= most || GLTF_SET(g, "accessor %u has %u %s; allowed are at most %u", accessor,
                                      *count, what, most);
}

/* Reads an element's components into doubles, rows of a column after one another. */
static void read_element(const struct accessor *a, const unsigned char *at, double out[16])
{
    const uint32_t step = column_size(a->type, a->shape);
    for (uint32_t column = 0; column < a->shape->columns; column++) {
        for (uint32_t row = 0; row < a->shape->rows; row++) {
            double value =
                component_at(a->type, at + (size_t)column * step + (size_t)row * a->type->size);
            if (a->is_normalized && a->type->most > 0.0) {
                value /= a->type->most;
                value = value < -1.0 ? -1.0 : value;
            }
            *out++ = value;
        }
    }
}

/* ---- sparse accessors ------------------------------------------------------------------------ */

struct sparse {
    uint32_t count;
    const struct component *index_type;
    struct gltf_view indices, values;
};

static bool open_sparse(struct gltf *g, const struct accessor *a, const json_t *json,
                        struct sparse *s)
{
    const json_t *indices = gltf_member(json, "indices");
    const json_t *values = gltf_member(json, "values");
    uint32_t index_view = 0, value_view = 0;
    s->index_type = find_component(gltf_member(indices, "componentType"));
    if (!gltf_index(gltf_member(json, "count"), &s->count) || !s->index_type ||
        s->index_type->is_signed || s->count > a->count)
        return GLTF_SET(g,
                        "the sparse accessor %u has a componentType of indices or a count that "
                        "glTF does not have",
                        a->number);
    const uint64_t size = (uint64_t)column_size(a->type, a->shape) * a->shape->columns;
    return gltf_reference(g, indices, "bufferView", GLTF_VIEWS, &index_view) &&
           gltf_reference(g, values, "bufferView", GLTF_VIEWS, &value_view) &&
           ((index_view != GLTF_NONE && value_view != GLTF_NONE) ||
            GLTF_SET(g, "the sparse accessor %u has no bufferView", a->number)) &&
           find_elements(g, a, indices, index_view, s->count, s->index_type->size, &s->indices) &&
           find_elements(g, a, values, value_view, s->count, size, &s->values);
}

typedef void put_element(void *out, size_t element, const double *values, uint32_t count);

/* Replaces elements by those of the sparse part. */
static bool put_sparse(struct gltf *g, const struct accessor *a, struct gltf_range range,
                       put_element *put, void *out)
{
    const json_t *json = gltf_member(a->json, "sparse");
    const uint32_t components_of_one = a->shape->columns * a->shape->rows;
    struct sparse s = {.count = 0};
    if (!json)
        return true;
    if (!open_sparse(g, a, json, &s))
        return false;
    for (uint32_t i = 0; i < s.count; i++) {
        double element[16];
        const double index = component_at(s.index_type, s.indices.bytes + i * s.indices.stride);
        if (index >= (double)a->count)
            return GLTF_SET(g, "the sparse accessor %u has the index %.0f of %u elements",
                            a->number, index, a->count);
        const uint32_t at = (uint32_t)index;
        if (at < range.first || at - range.first >= range.count)
            continue;
        read_element(a, s.values.bytes + i * s.values.stride, element);
        put(out, at - range.first, element, components_of_one);
    }
    return true;
}

/* ---- reading --------------------------------------------------------------------------------- */

static void put_floats(void *out, size_t element, const double *values, uint32_t count)
{
    float *to = (float *)out + element * count;
    for (uint32_t i = 0; i < count; i++)
        to[i] = (float)values[i];
}

static void put_integers(void *out, size_t element, const double *values, uint32_t count)
{
    uint32_t *to = (uint32_t *)out + element * count;
    for (uint32_t i = 0; i < count; i++)
        to[i] = values[i] > 0.0 ? (uint32_t)values[i] : 0;
}

/* Reads elements into `out`, whose components have 4 bytes each. */
static bool read_all(struct gltf *g, const struct accessor *a, struct gltf_range range,
                     put_element *put, void *out)
{
    const uint32_t components_of_one = a->shape->columns * a->shape->rows;
    double element[16] = {0};
    for (uint32_t i = 0; i < range.count; i++) {
        if (a->view.bytes)
            read_element(a, a->view.bytes + ((size_t)range.first + i) * a->view.stride, element);
        put(out, i, element, components_of_one);
    }
    return put_sparse(g, a, range, put, out);
}

static void *read_range(struct gltf *g, uint32_t number, const char *type, struct gltf_range range,
                        bool integers)
{
    struct accessor a;
    if (!open_accessor(g, number, &a))
        return NULL;
    if (strcmp(a.shape->name, type) != 0 || (integers && a.type->is_signed)) {
        GLTF_SET(g, "accessor %u has elements of type %s; allowed are %s%s", number, a.shape->name,
                 integers ? "unsigned integers of type " : "", type);
        return NULL;
    }
    if (range.first > a.count || range.count > a.count - range.first) {
        GLTF_SET(g, "accessor %u has %u elements; at least %llu are needed", number, a.count,
                 (unsigned long long)range.first + range.count);
        return NULL;
    }
    const size_t of_one = (size_t)a.shape->columns * a.shape->rows * sizeof(float);
    void *out = malloc(range.count * of_one + 1);
    if (!out) {
        decode_out_of_memory(g->error);
        return NULL;
    }
    a.is_normalized = a.is_normalized && !integers;
    if (!read_all(g, &a, range, integers ? put_integers : put_floats, out)) {
        free(out);
        return NULL;
    }
    return out;
}

float *gltf_read(struct gltf *g, uint32_t accessor, const char *type, struct gltf_range range)
{
    return read_range(g, accessor, type, range, false);
}

uint32_t *gltf_read_integers(struct gltf *g, uint32_t accessor, const char *type,
                             struct gltf_range range)
{
    return read_range(g, accessor, type, range, true);
}
