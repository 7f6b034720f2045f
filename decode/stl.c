/* This file reads STL, ASCII and binary. Each facet is a triangle with corners of its own, so
 * surface.c joins equal corners. The normals in the file are ignored: by its specification they
 * follow from the order of the corners, and many programs write zeros. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "bytes.h"
#include "decode.h"
#include "model.h"
#include "words.h"

enum {
    HEADER = 80,
    COUNT_END = HEADER + 4,
    FACET = 50, /* bytes: a normal, three corners, and two that most programs leave zero */
    NORMAL = 12,
    CORNER = 12,
};

static bool refuse_count(size_t count, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT, "the mesh has %zu triangles; allowed are %d",
                          count, KILN_MAX_MESH_TRIANGLES);
}

/* Takes memory for the triangles of the one mesh of a model. */
static struct decode_model_mesh *allocate(struct decode_model *model, size_t triangles,
                                          struct kiln_error *error)
{
    if (!decode_model_allocate(model, 1)) {
        decode_out_of_memory(error);
        return NULL;
    }
    struct decode_model_mesh *mesh = &model->meshes[0];
    mesh->positions = malloc((3 * triangles + 1) * sizeof *mesh->positions);
    mesh->triangles = malloc((triangles + 1) * sizeof *mesh->triangles);
    if (!mesh->positions || !mesh->triangles) {
        decode_out_of_memory(error);
        return NULL;
    }
    mesh->vertex_count = 3 * triangles;
    mesh->triangle_count = triangles;
    for (size_t i = 0; i < 3 * triangles; i++)
        mesh->triangles[i / 3][i % 3] = (uint32_t)i;
    return mesh;
}

/* ---- binary ---------------------------------------------------------------------------------- */

static bool read_binary(const struct decode_mesh *wanted, struct decode_model *model,
                        struct kiln_error *error)
{
    const unsigned char *bytes = wanted->bytes;
    const size_t count = decode_unsigned(bytes + HEADER, 4, false);
    const size_t needed = COUNT_END + count * FACET;
    if (needed > wanted->size)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the file has %zu bytes; its %zu triangles take %zu", wanted->size,
                              count, needed);
    if (count > KILN_MAX_MESH_TRIANGLES)
        return refuse_count(count, error);
    struct decode_model_mesh *mesh = allocate(model, count, error);
    for (size_t i = 0; mesh && i < 3 * count; i++) {
        const unsigned char *facet = bytes + COUNT_END + i / 3 * FACET;
        for (size_t c = 0; c < 3; c++)
            mesh->positions[i][c] =
                decode_float_of(facet + NORMAL + i % 3 * CORNER + c * sizeof(float), false);
    }
    return mesh != NULL;
}

/* ---- ASCII ----------------------------------------------------------------------------------- */

struct reading {
    struct decode_text text;
    struct kiln_error *error;
    struct decode_model_mesh *mesh;
    size_t corners; /* that were read */
    size_t corner;  /* of the present facet */
    int number;     /* the next coordinate of the present corner; 3: no corner is read */
};

static size_t count_corners(const struct decode_mesh *wanted)
{
    struct decode_text text = decode_text_begin(wanted->bytes, wanted->size);
    struct decode_line line;
    struct decode_word word;
    size_t count = 0;
    while (decode_text_line(&text, &line)) {
        while (decode_line_word(&line, &word))
            count += decode_word_is_like(&word, "vertex");
    }
    return count;
}

#define REFUSE(r, format, ...)                                                                     \
    kiln_error_set((r)->error, KILN_INVALID_INPUT, "line %zu: " format, (r)->text.number,          \
                   __VA_ARGS__)

static bool read_word(struct reading *r, const struct decode_word *word)
{
    float *out = r->mesh->positions[r->corners];
    if (r->number < 3) {
        if (!decode_word_float(word, &out[r->number]))
            return REFUSE(r, "'%.*s' of a vertex is not a number",
                          (int)(word->length < 40 ? word->length : 40), word->start);
        r->corners += ++r->number == 3;
    } else if (decode_word_is_like(word, "vertex")) {
        r->corner++;
        r->number = 0;
    } else if (decode_word_is_like(word, "endfacet")) {
        if (r->corner != 3)
            return REFUSE(r, "a facet has %zu vertices; allowed are 3", r->corner);
        r->corner = 0;
    }
    return true;
}

/* Reads the words of a line, of which those behind "solid" and "endsolid" are a name. */
static bool read_line(struct reading *r, struct decode_line *line)
{
    struct decode_word word;
    while (decode_line_word(line, &word)) {
        if (r->number == 3 &&
            (decode_word_is_like(&word, "solid") || decode_word_is_like(&word, "endsolid")))
            return true;
        if (!read_word(r, &word))
            return false;
    }
    return true;
}

static bool read_ascii(const struct decode_mesh *wanted, struct decode_model *model,
                       struct kiln_error *error)
{
    const size_t most = count_corners(wanted); /* names may have the word, too */
    struct reading r = {.error = error, .number = 3};
    struct decode_line line;
    if (most / 3 > KILN_MAX_MESH_TRIANGLES)
        return refuse_count(most / 3, error);
    r.mesh = allocate(model, most / 3 + 1, error);
    if (!r.mesh)
        return false;
    r.text = decode_text_begin(wanted->bytes, wanted->size);
    while (decode_text_line(&r.text, &line)) {
        if (!read_line(&r, &line))
            return false;
    }
    if (r.corner > 0 || r.number < 3)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the file ends within a facet");
    r.mesh->triangle_count = r.corners / 3;
    r.mesh->vertex_count = r.corners;
    return true;
}

/* ---- which of both --------------------------------------------------------------------------- */

/* Returns whether a file is ASCII. Some programs begin binary files with "solid", too, but their
 * size then is that of their triangles, or they have zeros. */
static bool is_ascii(const struct decode_mesh *wanted)
{
    struct decode_text text = decode_text_begin(wanted->bytes, wanted->size);
    struct decode_line line;
    struct decode_word word;
    const unsigned char *bytes = wanted->bytes;
    if (wanted->size >= COUNT_END &&
        wanted->size == COUNT_END + (size_t)decode_unsigned(bytes + HEADER, 4, false) * FACET)
        return false;
    while (decode_text_line(&text, &line)) {
        if (decode_line_word(&line, &word))
            return decode_word_is_like(&word, "solid") && !memchr(bytes, '\0', wanted->size);
    }
    return false;
}

bool decode_stl(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error)
{
    const bool ascii = is_ascii(wanted);
    if (!ascii && wanted->size < COUNT_END)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the file has %zu bytes and does not begin with 'solid'; allowed are "
                              "at least %d bytes, or text",
                              wanted->size, COUNT_END);
    return ascii ? read_ascii(wanted, model, error) : read_binary(wanted, model, error);
}
