/* This file reads PLY, in ASCII and in both binary orders of bytes: positions, normals and texture
 * coordinates of vertices, faces of any number of corners, and strips of triangles. The header
 * describes all elements and properties, so those that mean nothing to kiln are skipped by their
 * types. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "bytes.h"
#include "decode.h"
#include "looks.h"
#include "model.h"
#include "polygon.h"
#include "words.h"

enum {
    MOST_ELEMENTS = 64,
    MOST_PROPERTIES = 512, /* of all elements */
    TEXT = 40,             /* how much of a word an error quotes */
};

enum type { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, TYPE_COUNT };

static const struct {
    const char *name, *name_of_size;
    size_t size;
    bool is_signed;
} types[TYPE_COUNT] = {
    [INT8] = {"char", "int8", 1, true},        [UINT8] = {"uchar", "uint8", 1, false},
    [INT16] = {"short", "int16", 2, true},     [UINT16] = {"ushort", "uint16", 2, false},
    [INT32] = {"int", "int32", 4, true},       [UINT32] = {"uint", "uint32", 4, false},
    [FLOAT32] = {"float", "float32", 4, true}, [FLOAT64] = {"double", "float64", 8, true},
};

/* The enum lists the numbers of a vertex that kiln reads, in the order in which they are kept. */
enum role {
    X,
    Y,
    Z,
    NORMAL_X,
    NORMAL_Y,
    NORMAL_Z,
    U,
    V,
    RED,
    GREEN,
    BLUE,
    ALPHA,
    ROLE_COUNT,
    NO_ROLE
};

/* Common names of properties. There is no standard for those of texture coordinates. */
static const struct {
    const char *name;
    enum role role;
} roles[] = {{"x", X},
             {"y", Y},
             {"z", Z},
             {"nx", NORMAL_X},
             {"ny", NORMAL_Y},
             {"nz", NORMAL_Z},
             {"s", U},
             {"t", V},
             {"u", U},
             {"v", V},
             {"texture_u", U},
             {"texture_v", V},
             {"red", RED},
             {"green", GREEN},
             {"blue", BLUE},
             {"diffuse_red", RED},
             {"diffuse_green", GREEN},
             {"diffuse_blue", BLUE},
             {"alpha", ALPHA}};

struct property {
    enum type type, count_type;
    bool is_list;
    enum role role;  /* of a number of a vertex */
    bool is_corners; /* a list of the corners of a face or strip */
};

enum kind { VERTEX, FACE, STRIP, OTHER };

struct element {
    enum kind kind;
    struct decode_word name;
    uint64_t count;
    size_t first, property_count;
};

enum coding { ASCII, LITTLE_ENDIAN_BYTES, BIG_ENDIAN_BYTES };

struct reading {
    const struct decode_mesh *wanted;
    struct kiln_error *error;
    enum coding coding;
    bool has_coding;
    struct decode_text text; /* its place is that of the bytes, too */
    struct decode_line line; /* of the numbers in ASCII */
    struct element elements[MOST_ELEMENTS];
    size_t element_count;
    struct property properties[MOST_PROPERTIES];
    size_t property_count;
    const struct element *element; /* at hand */
    struct decode_model_mesh *mesh;
    size_t triangle_capacity;
    bool has_vertices, has_faces;
    uint32_t *corners; /* of the face at hand */
    size_t corner_capacity;
    struct decode_polygon polygon;
};

#define REFUSE(r, ...) kiln_error_set((r)->error, KILN_INVALID_INPUT, __VA_ARGS__)

static int quoted(const struct decode_word *word)
{
    return (int)(word->length < TEXT ? word->length : TEXT);
}

/* ---- the header ------------------------------------------------------------------------------ */

static bool refuse_word(const struct reading *r, const struct decode_word *word,
                        const char *allowed)
{
    return REFUSE(r, "line %zu: '%.*s'; allowed is %s", r->text.number, quoted(word), word->start,
                  allowed);
}

/* Takes the next word of a line of the header, or an empty one. */
static struct decode_word take(struct decode_line *line)
{
    struct decode_word word = {line->end, 0};
    (void)decode_line_word(line, &word);
    return word;
}

static bool read_type(const struct reading *r, const struct decode_word *word, enum type *type)
{
    for (int i = 0; i < TYPE_COUNT; i++) {
        if (decode_word_is(word, types[i].name) || decode_word_is(word, types[i].name_of_size)) {
            *type = (enum type)i;
            return true;
        }
    }
    return refuse_word(r, word,
                       "a type: char, uchar, short, ushort, int, uint, float, double, int8, uint8, "
                       "int16, uint16, int32, uint32, float32 or float64");
}

static bool read_format(struct reading *r, struct decode_line *line)
{
    static const char *const words[] = {[ASCII] = "ascii",
                                        [LITTLE_ENDIAN_BYTES] = "binary_little_endian",
                                        [BIG_ENDIAN_BYTES] = "binary_big_endian"};
    const struct decode_word word = take(line);
    for (int i = ASCII; i <= BIG_ENDIAN_BYTES; i++) {
        if (decode_word_is(&word, words[i])) {
            r->coding = (enum coding)i;
            r->has_coding = true;
            return true;
        }
    }
    return refuse_word(r, &word, "a format: ascii, binary_little_endian or binary_big_endian");
}

static bool read_element(struct reading *r, struct decode_line *line)
{
    const struct decode_word name = take(line), number = take(line);
    int64_t count = 0;
    if (r->element_count == MOST_ELEMENTS)
        return REFUSE(r, "line %zu: more than %d elements; no more are allowed", r->text.number,
                      MOST_ELEMENTS);
    if (!decode_word_integer(&number, &count) || count < 0)
        return refuse_word(r, &number, "how many there are of an element");
    const enum kind kind = decode_word_is(&name, "vertex")      ? VERTEX
                           : decode_word_is(&name, "face")      ? FACE
                           : decode_word_is(&name, "tristrips") ? STRIP
                                                                : OTHER;
    r->elements[r->element_count++] = (struct element){
        .kind = kind, .name = name, .count = (uint64_t)count, .first = r->property_count};
    return true;
}

/* Finds what a property means in its element. */
static void find_meaning(const struct element *element, const struct decode_word *name,
                         struct property *property)
{
    property->role = NO_ROLE;
    property->is_corners =
        property->is_list && (element->kind == FACE || element->kind == STRIP) &&
        (decode_word_is(name, "vertex_indices") || decode_word_is(name, "vertex_index"));
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        if (element->kind == VERTEX && !property->is_list && decode_word_is(name, roles[i].name))
            property->role = roles[i].role;
    }
}

static bool read_property(struct reading *r, struct decode_line *line)
{
    struct decode_word word = take(line);
    struct property *property = &r->properties[r->property_count];
    if (r->element_count == 0)
        return REFUSE(r, "line %zu: a property stands before the first element", r->text.number);
    if (r->property_count == MOST_PROPERTIES)
        return REFUSE(r, "line %zu: more than %d properties; no more are allowed", r->text.number,
                      MOST_PROPERTIES);
    *property = (struct property){.is_list = decode_word_is(&word, "list")};
    if (property->is_list) {
        word = take(line);
        if (!read_type(r, &word, &property->count_type))
            return false;
        if (property->count_type >= FLOAT32)
            return refuse_word(r, &word, "a type of integers, for the length of a list");
        word = take(line);
    }
    if (!read_type(r, &word, &property->type))
        return false;
    struct element *element = &r->elements[r->element_count - 1];
    word = take(line);
    find_meaning(element, &word, property);
    element->property_count++;
    r->property_count++;
    return true;
}

/* Reads a line of the header. Comments are ignored, as are lines with any other first word: some
 * versions of Blender wrote comments without the word "comment". */
static bool read_header_line(struct reading *r, const struct decode_word *word,
                             struct decode_line *line)
{
    if (decode_word_is(word, "format"))
        return read_format(r, line);
    if (decode_word_is(word, "element"))
        return read_element(r, line);
    return !decode_word_is(word, "property") || read_property(r, line);
}

static bool read_header(struct reading *r)
{
    const char *bytes = r->wanted->bytes;
    struct decode_line line;
    struct decode_word word;
    r->text = (struct decode_text){.at = bytes, .end = bytes + r->wanted->size, .line_end = '\n'};
    /* the numbers may have the byte '\n' where lines end with '\r' */
    if (r->wanted->size > 4 && bytes[3] == '\r' && bytes[4] != '\n')
        r->text.line_end = '\r';
    if (!decode_text_line(&r->text, &line) || !decode_line_word(&line, &word) ||
        !decode_word_is(&word, "ply"))
        return REFUSE(r, "the contents of the file are not those of a .ply file");
    while (decode_text_line(&r->text, &line)) {
        if (!decode_line_word(&line, &word))
            continue;
        if (decode_word_is(&word, "end_header"))
            return r->has_coding || REFUSE(r, "the header does not say the format");
        if (!read_header_line(r, &word, &line))
            return false;
    }
    return REFUSE(r, "the header has no end_header");
}

/* ---- numbers --------------------------------------------------------------------------------- */

static bool refuse_end(const struct reading *r)
{
    return REFUSE(r, "the file ends within the element '%.*s'", quoted(&r->element->name),
                  r->element->name.start);
}

static bool read_word(struct reading *r, enum type type, double *out)
{
    struct decode_word word;
    int64_t integer = 0;
    float value = 0;
    while (!decode_line_word(&r->line, &word)) {
        if (!decode_text_line(&r->text, &r->line))
            return refuse_end(r);
    }
    if (type < FLOAT32 && decode_word_integer(&word, &integer)) {
        *out = (double)integer;
        return true;
    }
    if (!decode_word_float(&word, &value))
        return REFUSE(r, "line %zu: '%.*s' is not a number", r->text.number, quoted(&word),
                      word.start);
    *out = (double)value;
    return true;
}

static bool read_bytes(struct reading *r, enum type type, double *out)
{
    const size_t size = types[type].size;
    const bool big_endian = r->coding == BIG_ENDIAN_BYTES;
    const unsigned char *bytes = (const unsigned char *)r->text.at;
    if ((size_t)(r->text.end - r->text.at) < size)
        return refuse_end(r);
    r->text.at += size;
    if (type == FLOAT32) {
        *out = (double)decode_float_of(bytes, big_endian);
    } else if (type == FLOAT64) {
        *out = decode_double_of(bytes, big_endian);
    } else {
        const int64_t number = (int64_t)decode_unsigned(bytes, size, big_endian);
        const int64_t half = (int64_t)1 << (8 * size - 1);
        *out = (double)(types[type].is_signed && number >= half ? number - 2 * half : number);
    }
    return true;
}

static bool read_number(struct reading *r, enum type type, double *out)
{
    return r->coding == ASCII ? read_word(r, type, out) : read_bytes(r, type, out);
}

/* Reads the length of a list. Each number of it takes at least a byte. */
static bool read_length(struct reading *r, const struct property *property, size_t *length)
{
    double number = 0;
    if (!read_number(r, property->count_type, &number))
        return false;
    const double left = (double)(r->text.end - r->text.at) + (double)(r->line.end - r->line.at);
    if (!(number >= 0 && number <= left))
        return REFUSE(r, "a list of the element '%.*s' has %.0f numbers, which the file has not",
                      quoted(&r->element->name), r->element->name.start, number);
    *length = (size_t)number;
    return true;
}

/* Skips a number, or a list of them. */
static bool skip(struct reading *r, const struct property *property)
{
    size_t length = 1;
    double number;
    if (property->is_list && !read_length(r, property, &length))
        return false;
    for (size_t i = 0; i < length; i++) {
        if (!read_number(r, property->type, &number))
            return false;
    }
    return true;
}

/* ---- vertices -------------------------------------------------------------------------------- */

static bool has_roles(const struct reading *r, enum role first, enum role last)
{
    unsigned found = 0;
    for (size_t i = 0; i < r->element->property_count; i++) {
        const enum role role = r->properties[r->element->first + i].role;
        if (role >= first && role <= last)
            found |= 1u << (role - first);
    }
    return found == (1u << (last - first + 1)) - 1;
}

static bool allocate_vertices(struct reading *r)
{
    struct decode_model_mesh *mesh = r->mesh;
    const size_t count = (size_t)r->element->count;
    mesh->vertex_count = count;
    mesh->positions = malloc((count + 1) * sizeof *mesh->positions);
    if (has_roles(r, NORMAL_X, NORMAL_Z))
        mesh->normals = malloc((count + 1) * sizeof *mesh->normals);
    const bool uvs = (r->wanted->uvs || r->wanted->materials) && has_roles(r, U, V);
    const bool colors = r->wanted->materials && has_roles(r, RED, BLUE);
    if (uvs)
        mesh->uvs = malloc((count + 1) * sizeof *mesh->uvs);
    if (colors)
        mesh->colors = malloc((count + 1) * sizeof *mesh->colors);
    return (mesh->positions && (mesh->normals || !has_roles(r, NORMAL_X, NORMAL_Z)) &&
            (mesh->uvs || !uvs) && (mesh->colors || !colors)) ||
           decode_out_of_memory(r->error);
}

/* Makes a number of a colour one from 0 to 1: integers are parts of their largest value. */
static double part_of(const struct property *property, double number)
{
    const size_t bits = 8 * types[property->type].size - types[property->type].is_signed;
    return property->type < FLOAT32 ? number / (double)(((uint64_t)1 << bits) - 1) : number;
}

static bool read_vertex(struct reading *r, size_t i)
{
    float values[ROLE_COUNT] = {[ALPHA] = 1};
    for (size_t k = 0; k < r->element->property_count; k++) {
        const struct property *property = &r->properties[r->element->first + k];
        double number = 0;
        if (property->role == NO_ROLE) {
            if (!skip(r, property))
                return false;
            continue;
        }
        if (!read_number(r, property->type, &number))
            return false;
        values[property->role] =
            (float)(property->role >= RED ? part_of(property, number) : number);
    }
    memcpy(r->mesh->positions[i], values + X, sizeof *r->mesh->positions);
    if (r->mesh->normals)
        memcpy(r->mesh->normals[i], values + NORMAL_X, sizeof *r->mesh->normals);
    if (r->mesh->colors)
        decode_put_color(values + RED, values[ALPHA], r->mesh->colors[i]);
    for (int c = 0; r->mesh->uvs && c < 2; c++)
        r->mesh->uvs[i][c] = isfinite(values[U + c]) ? values[U + c] : 0.0f;
    return true;
}

static bool read_vertices(struct reading *r)
{
    if (r->has_vertices)
        return REFUSE(r, "the file has two elements 'vertex'; allowed is one");
    if (!has_roles(r, X, Z))
        return REFUSE(r, "the vertices lack a property x, y or z");
    r->has_vertices = true;
    if (!allocate_vertices(r))
        return false;
    for (size_t i = 0; i < r->mesh->vertex_count; i++) {
        if (!read_vertex(r, i))
            return false;
    }
    return true;
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* Appends a triangle. */
static bool put_triangle(struct reading *r, uint32_t a, uint32_t b, uint32_t c)
{
    struct decode_model_mesh *mesh = r->mesh;
    const uint32_t triangle[3] = {a, b, c};
    if (mesh->triangle_count == KILN_MAX_MESH_TRIANGLES)
        return decode_refuse_size(r->error);
    if (mesh->triangle_count == r->triangle_capacity) {
        const size_t capacity = r->triangle_capacity + r->triangle_capacity / 2 + 64;
        void *more = realloc(mesh->triangles, capacity * sizeof *mesh->triangles);
        if (!more)
            return decode_out_of_memory(r->error);
        mesh->triangles = more;
        r->triangle_capacity = capacity;
    }
    memcpy(mesh->triangles[mesh->triangle_count++], triangle, sizeof triangle);
    return true;
}

static bool put_face(struct reading *r, size_t count)
{
    if (count < 3)
        return true;
    if (count - 2 > KILN_MAX_MESH_TRIANGLES - r->mesh->triangle_count)
        return decode_refuse_size(r->error);
    if (!decode_polygon_resize(&r->polygon, count))
        return decode_out_of_memory(r->error);
    for (size_t i = 0; i < count; i++)
        memcpy(r->polygon.points[i], r->mesh->positions[r->corners[i]], sizeof(float[3]));
    decode_polygon_divide(&r->polygon);
    for (size_t i = 0; i < count - 2; i++) {
        const uint32_t *t = r->polygon.triangles[i];
        if (!put_triangle(r, r->corners[t[0]], r->corners[t[1]], r->corners[t[2]]))
            return false;
    }
    return true;
}

/* Appends the triangles of strips. UINT32_MAX, or -1 in the file, ends a strip; every second
 * triangle of a strip has its corners in the other order. Triangles with two equal corners only
 * lead on. */
static bool put_strips(struct reading *r, size_t count)
{
    size_t start = 0;
    for (size_t i = 0; i < count; i++) {
        if (r->corners[i] == UINT32_MAX)
            start = i + 1;
        if (i < start + 2)
            continue;
        const uint32_t *t = &r->corners[i - 2];
        if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2])
            continue;
        const bool turned = (i - start) % 2 == 1;
        if (!put_triangle(r, t[turned ? 1 : 0], t[turned ? 0 : 1], t[2]))
            return false;
    }
    return true;
}

static bool read_corners(struct reading *r, const struct property *property)
{
    const bool strips = r->element->kind == STRIP;
    size_t count = 0;
    if (!read_length(r, property, &count))
        return false;
    if (count > 3 * (size_t)KILN_MAX_MESH_TRIANGLES)
        return decode_refuse_size(r->error);
    if (count > r->corner_capacity) {
        free(r->corners);
        r->corner_capacity = 2 * count;
        r->corners = malloc(r->corner_capacity * sizeof *r->corners);
        if (!r->corners) {
            r->corner_capacity = 0;
            return decode_out_of_memory(r->error);
        }
    }
    for (size_t i = 0; i < count; i++) {
        double number = 0;
        if (!read_number(r, property->type, &number))
            return false;
        const bool ends = strips && (number == -1 || number == UINT32_MAX);
        if (!ends && !(number >= 0 && number < (double)r->mesh->vertex_count))
            return REFUSE(r, "a face names vertex %.0f; allowed are 0 to %lld", number,
                          (long long)r->mesh->vertex_count - 1);
        r->corners[i] = ends ? UINT32_MAX : (uint32_t)number;
    }
    return strips ? put_strips(r, count) : put_face(r, count);
}

static bool read_faces(struct reading *r)
{
    if (!r->has_vertices)
        return REFUSE(r, "the element '%.*s' stands before 'vertex'; allowed is behind it",
                      quoted(&r->element->name), r->element->name.start);
    r->has_faces = r->has_faces || r->element->count > 0;
    for (uint64_t i = 0; i < r->element->count; i++) {
        for (size_t k = 0; k < r->element->property_count; k++) {
            const struct property *property = &r->properties[r->element->first + k];
            if (!(property->is_corners ? read_corners(r, property) : skip(r, property)))
                return false;
        }
    }
    return true;
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool skip_element(struct reading *r)
{
    for (uint64_t i = 0; i < r->element->count; i++) {
        for (size_t k = 0; k < r->element->property_count; k++) {
            if (!skip(r, &r->properties[r->element->first + k]))
                return false;
        }
    }
    return true;
}

/* Checks the counts before memory is taken for what is counted. */
static bool check_counts(const struct reading *r)
{
    for (size_t i = 0; i < r->element_count; i++) {
        const struct element *element = &r->elements[i];
        const int most = element->kind == VERTEX ? KILN_MAX_MESH_VERTICES : KILN_MAX_MESH_TRIANGLES;
        if (element->kind != OTHER && element->count > (uint64_t)most)
            return REFUSE(r, "the mesh has %llu of the element '%.*s'; allowed are %d",
                          (unsigned long long)element->count, quoted(&element->name),
                          element->name.start, most);
    }
    return true;
}

static bool read_elements(struct reading *r)
{
    bool ok = true;
    r->line = (struct decode_line){r->text.at, r->text.at};
    for (size_t i = 0; ok && i < r->element_count; i++) {
        r->element = &r->elements[i];
        if (r->element->property_count == 0)
            continue; /* nothing is stored, however many there are */
        ok = r->element->kind == VERTEX  ? read_vertices(r)
             : r->element->kind == OTHER ? skip_element(r)
                                         : read_faces(r);
    }
    return ok;
}

bool decode_ply(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error)
{
    struct reading *r = calloc(1, sizeof *r);
    if (!r || !decode_model_allocate(model, 1)) {
        free(r);
        return decode_out_of_memory(error);
    }
    r->wanted = wanted;
    r->error = error;
    r->mesh = &model->meshes[0];
    bool ok = read_header(r) && check_counts(r) && read_elements(r);
    if (ok && r->mesh->triangle_count == 0)
        ok = REFUSE(r, "the mesh has no triangles%s",
                    r->has_faces || r->has_vertices ? ", only points or lines" : "");
    decode_polygon_finish(&r->polygon);
    free(r->corners);
    free(r);
    return ok;
}
