/* This file reads Wavefront OBJ. It passes over the file twice: first it counts and reads the
 * positions, texture coordinates and normals, which a face may name before they stand, then the
 * faces, which it divides into triangles.
 *
 * Faces of one material that follow one another become one mesh of the model, unless only some of
 * them have normals. Objects, groups and smoothing groups say nothing about a surface. Lines,
 * points, curves and free-form surfaces are ignored. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"
#include "looks.h"
#include "model.h"
#include "polygon.h"
#include "words.h"

/* A corner of a face: numbers of a position, a texture coordinate and a normal, from 1. Those of
 * the last two are 0 if there is none. */
struct corner {
    uint32_t numbers[3];
};

enum { POSITION, UV, NORMAL };

enum { MOST_LIBRARIES = 16 }; /* files of materials */

/* Counts what lines of a file have. */
struct counts {
    size_t values[3];                /* positions, texture coordinates and normals */
    size_t faces, materials, others; /* others: points, lines and faces of one or two corners */
};

/* Faces that become one mesh. */
struct run {
    size_t vertex, triangle; /* the first ones */
    uint32_t material;
    bool has_uvs, has_normals;
};

struct reading {
    const struct decode_mesh *wanted;
    struct kiln_error *error;
    struct decode_text text;
    struct counts total, seen; /* of the file, and up to the line at hand */
    float (*positions)[3], (*uvs)[2], (*normals)[3];
    float (*colors)[4]; /* of positions, if materials are wanted */
    bool has_colors;
    struct decode_word libraries[MOST_LIBRARIES]; /* names of files of materials */
    size_t library_count;
    struct decode_word *names; /* of materials, as a hash table */
    uint32_t *materials;       /* their numbers */
    size_t table_size;
    uint32_t material_count, material;
    struct corner *vertices;
    size_t vertex_count, vertex_capacity;
    size_t *latest; /* for each position, the number of the latest vertex that has it, from 1 */
    uint32_t (*triangles)[3]; /* by numbers of vertices in the mesh */
    size_t triangle_count, triangle_capacity;
    struct run *runs;
    size_t run_count, run_capacity;
    struct corner *face;
    size_t face_capacity;
    struct decode_polygon polygon;
};

#define REFUSE(r, ...) kiln_error_set((r)->error, KILN_INVALID_INPUT, __VA_ARGS__)

/* Grows an array such that it has room for one entry more. `array` is the address of a pointer. */
static bool grow(const struct reading *r, void *array, size_t count, size_t *capacity, size_t entry)
{
    void *grown;
    if (count < *capacity)
        return true;
    memcpy(&grown, array, sizeof grown);
    const size_t more = *capacity + *capacity / 2 + 64;
    grown = realloc(grown, more * entry);
    if (!grown)
        return decode_out_of_memory(r->error);
    memcpy(array, &grown, sizeof grown);
    *capacity = more;
    return true;
}

#define GROW(r, array, count, capacity)                                                            \
    grow(r, &(r)->array, count, &(r)->capacity, sizeof *(r)->array)

/* ---- the first pass -------------------------------------------------------------------------- */

/* Takes the next word of a line with numbers. A comment ends the line, also behind a number without
 * a blank between them; "1.#IND" is what some programs print for no number. */
static bool take_word(struct decode_line *line, struct decode_word *word)
{
    if (!decode_line_word(line, word))
        return false;
    const char *comment = memchr(word->start, '#', word->length);
    if (comment && (comment == word->start || comment[-1] != '.')) {
        word->length = (size_t)(comment - word->start);
        line->at = line->end;
    }
    return word->length > 0;
}

/* Returns which of the values a line has, or -1. */
static int value_of(const struct decode_word *word)
{
    static const char *const words[] = {[POSITION] = "v", [UV] = "vt", [NORMAL] = "vn"};
    for (int i = 0; i < 3; i++) {
        if (decode_word_is(word, words[i]))
            return i;
    }
    return -1;
}

static bool is_face(const struct decode_word *word)
{
    return decode_word_is(word, "f") || decode_word_is(word, "fo"); /* "fo" is of old versions */
}

static void count_line(struct counts *counts, const struct decode_word *word)
{
    const int value = value_of(word);
    if (value >= 0)
        counts->values[value]++;
    counts->faces += is_face(word);
    counts->materials += decode_word_is(word, "usemtl");
    counts->others += decode_word_is(word, "l") || decode_word_is(word, "p");
}

static struct decode_text begin(const struct reading *r)
{
    struct decode_text text = decode_text_begin(r->wanted->bytes, r->wanted->size);
    text.joins_lines = true;
    return text;
}

/* Refuses what is no text, and text in an encoding that no OBJ has. */
static bool check_contents(const struct reading *r)
{
    const char *encoding = decode_wide_encoding(r->wanted->bytes, r->wanted->size);
    if (encoding)
        return REFUSE(r, "the mesh file is text in %s; allowed are ASCII and UTF-8", encoding);
    return !memchr(r->wanted->bytes, '\0', r->wanted->size) ||
           REFUSE(r, "the contents of the file are not those of a .obj file");
}

/* Checks the counts before memory is taken for what is counted. */
static bool check_counts(const struct reading *r)
{
    const size_t *values = r->total.values;
    const size_t most_corners = 3 * (size_t)KILN_MAX_MESH_TRIANGLES;
    if (values[POSITION] > KILN_MAX_MESH_VERTICES || r->total.faces > KILN_MAX_MESH_TRIANGLES)
        return REFUSE(r,
                      "the mesh has %zu vertices and %zu faces; allowed are %d vertices and %d "
                      "triangles",
                      values[POSITION], r->total.faces, KILN_MAX_MESH_VERTICES,
                      KILN_MAX_MESH_TRIANGLES);
    if (values[UV] > most_corners || values[NORMAL] > most_corners)
        return REFUSE(r,
                      "the mesh has %zu texture coordinates and %zu normals; allowed are %zu of "
                      "each",
                      values[UV], values[NORMAL], most_corners);
    return true;
}

static bool count_lines(struct reading *r)
{
    struct decode_line line;
    struct decode_word word;
    r->text = begin(r);
    while (decode_text_line(&r->text, &line)) {
        if (decode_line_word(&line, &word))
            count_line(&r->total, &word);
    }
    return check_counts(r);
}

static const struct {
    const char *name;
    int needed, taken;
} kinds[] = {[POSITION] = {"vertex", 3, 3},
             [UV] = {"texture coordinate", 1, 2},
             [NORMAL] = {"normal", 3, 3}};

/* Reads the numbers of a position, texture coordinate or normal. Others may follow: a weight of
 * rational curves, a colour, a third texture coordinate. */
static bool read_value(const struct reading *r, struct decode_line *line, int kind, float *out)
{
    struct decode_word word;
    out[1] = 0;
    for (int i = 0; i < kinds[kind].taken; i++) {
        const bool any = take_word(line, &word);
        if (!any && i >= kinds[kind].needed)
            return true;
        if (!any)
            return REFUSE(r, "line %zu: a %s has %d numbers; needed are %d", r->text.number,
                          kinds[kind].name, i, kinds[kind].needed);
        if (!decode_word_float(&word, &out[i]))
            return REFUSE(r, "line %zu: '%.*s' of a %s is not a number", r->text.number,
                          (int)(word.length < 40 ? word.length : 40), word.start, kinds[kind].name);
    }
    /* Exporters write infinity or no number where a face has no area. */
    for (int i = 0; kind == UV && i < 2; i++)
        out[i] = isfinite(out[i]) ? out[i] : 0.0f;
    return true;
}

/* Reads the colour of a vertex, which is sRGB: three numbers behind its position. */
static void read_color(struct reading *r, struct decode_line *line, float out[4])
{
    struct decode_word word;
    static const float white[3] = {1, 1, 1};
    float color[3] = {1, 1, 1};
    bool has = true;
    for (int c = 0; c < 3; c++)
        has = has && take_word(line, &word) && decode_word_float(&word, &color[c]);
    decode_put_color(has ? color : white, 1, out);
    r->has_colors = r->has_colors || has;
}

static float *place_of(const struct reading *r, int kind, size_t number)
{
    return kind == POSITION ? r->positions[number]
           : kind == UV     ? r->uvs[number]
                            : r->normals[number];
}

static bool read_values(struct reading *r)
{
    const size_t *values = r->total.values;
    struct decode_line line;
    struct decode_word word;
    r->positions = malloc((values[POSITION] + 1) * sizeof *r->positions);
    r->uvs = malloc((values[UV] + 1) * sizeof *r->uvs);
    r->normals = malloc((values[NORMAL] + 1) * sizeof *r->normals);
    if (r->wanted->materials)
        r->colors = malloc((values[POSITION] + 1) * sizeof *r->colors);
    if (!r->positions || !r->uvs || !r->normals || (r->wanted->materials && !r->colors))
        return decode_out_of_memory(r->error);
    r->text = begin(r);
    while (decode_text_line(&r->text, &line)) {
        const int kind = decode_line_word(&line, &word) ? value_of(&word) : -1;
        if (kind < 0)
            continue;
        const size_t number = r->seen.values[kind]++;
        if (!read_value(r, &line, kind, place_of(r, kind, number)))
            return false;
        if (kind == POSITION && r->colors)
            read_color(r, &line, r->colors[number]);
    }
    r->seen = (struct counts){0};
    return true;
}

/* ---- materials ------------------------------------------------------------------------------- */

/* Notes the material of the faces that follow. Materials are numbered in the order in which the
 * file uses them; 0 is for faces before the first one. */
static bool use_material(struct reading *r, struct decode_line *line)
{
    const struct decode_word name = decode_line_rest(line);
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    if (!r->names) {
        r->table_size = 2 * r->total.materials + 1;
        r->names = calloc(r->table_size, sizeof *r->names);
        r->materials = calloc(r->table_size, sizeof *r->materials);
        if (!r->names || !r->materials)
            return decode_out_of_memory(r->error);
    }
    for (size_t i = 0; i < name.length; i++)
        hash = (hash ^ (unsigned char)name.start[i]) * 1099511628211u;
    size_t slot = hash % r->table_size;
    while (r->materials[slot] > 0 && (r->names[slot].length != name.length ||
                                      memcmp(r->names[slot].start, name.start, name.length) != 0))
        slot = (slot + 1) % r->table_size;
    if (r->materials[slot] == 0) {
        r->names[slot] = name;
        r->materials[slot] = ++r->material_count;
    }
    r->material = r->materials[slot];
    return true;
}

/* Returns whether a name ends in .mtl. */
static bool is_whole_name(const struct decode_word *name)
{
    const struct decode_word end = {name->start + name->length - 4, 4};
    return name->length > 4 && decode_word_is_like(&end, ".mtl");
}

/* Notes the files of materials that a line names. Names may have blanks in them, so each is as long
 * as what ends in .mtl. */
static void add_libraries(struct reading *r, struct decode_line *line)
{
    struct decode_word name = {NULL, 0}, word;
    while (decode_line_word(line, &word)) {
        name.start = name.start ? name.start : word.start;
        name.length = (size_t)(word.start + word.length - name.start);
        struct decode_line rest = *line;
        if (!is_whole_name(&name) && decode_line_word(&rest, &word))
            continue;
        if (r->library_count < MOST_LIBRARIES)
            r->libraries[r->library_count] = name;
        r->library_count++;
        name.start = NULL;
    }
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* Reads one of the numbers of a corner. It counts from 1, or backwards from the line at hand if it
 * is negative. */
static bool read_number(const struct reading *r, int kind, const struct decode_word *word,
                        uint32_t *out)
{
    int64_t number = 0;
    const int64_t count = (int64_t)r->total.values[kind];
    if (!decode_word_integer(word, &number))
        return REFUSE(r, "line %zu: '%.*s' in a face is not a number of a %s", r->text.number,
                      (int)(word->length < 40 ? word->length : 40), word->start, kinds[kind].name);
    if (count == 0 && kind != POSITION) { /* some programs number what they do not write */
        *out = 0;
        return true;
    }
    const int64_t at = number < 0 ? (int64_t)r->seen.values[kind] + 1 + number : number;
    if (at < 1 || at > count)
        return REFUSE(r,
                      "line %zu: a face names %s %lld; the file has %lld, and %lld up to this line",
                      r->text.number, kinds[kind].name, (long long)number, (long long)count,
                      (long long)r->seen.values[kind]);
    *out = (uint32_t)at;
    return true;
}

/* Reads a corner, such as 1, 1/2, 1//3 or 1/2/3. */
static bool read_corner(const struct reading *r, const struct decode_word *word, struct corner *out)
{
    const char *at = word->start, *end = word->start + word->length;
    *out = (struct corner){{0}};
    for (int kind = POSITION; kind <= NORMAL && at <= end; kind++) {
        const char *slash = at < end ? memchr(at, '/', (size_t)(end - at)) : NULL;
        const struct decode_word part = {at, (size_t)((slash ? slash : end) - at)};
        if ((part.length > 0 || kind == POSITION) &&
            !read_number(r, kind, &part, &out->numbers[kind]))
            return false;
        at = slash ? slash + 1 : end + 1;
    }
    if (!r->wanted->uvs && !r->wanted->materials)
        out->numbers[UV] = 0;
    return at > end ||
           REFUSE(r, "line %zu: a corner '%.*s' has more than 3 numbers; no more are allowed",
                  r->text.number, (int)(word->length < 40 ? word->length : 40), word->start);
}

/* Begins another mesh if the faces that follow differ in kind. */
static bool begin_run(struct reading *r, bool has_normals)
{
    const struct run *last = r->run_count > 0 ? &r->runs[r->run_count - 1] : NULL;
    if (last && last->material == r->material && last->has_normals == has_normals)
        return true;
    if (!GROW(r, runs, r->run_count, run_capacity))
        return false;
    r->runs[r->run_count++] = (struct run){.vertex = r->vertex_count,
                                           .triangle = r->triangle_count,
                                           .material = r->material,
                                           .has_normals = has_normals};
    return true;
}

/* Finds the vertex of a corner in the present mesh: the latest with its position, if that is equal,
 * or a new one. Equal vertices that are missed so are joined later, by surface.c. */
static bool find_vertex(struct reading *r, const struct corner *corner, uint32_t *out)
{
    struct run *run = &r->runs[r->run_count - 1];
    size_t *latest = &r->latest[corner->numbers[POSITION] - 1];
    if (*latest <= run->vertex || memcmp(&r->vertices[*latest - 1], corner, sizeof *corner) != 0) {
        if (!GROW(r, vertices, r->vertex_count, vertex_capacity))
            return false;
        r->vertices[r->vertex_count++] = *corner;
        *latest = r->vertex_count;
        run->has_uvs = run->has_uvs || corner->numbers[UV] > 0;
    }
    *out = (uint32_t)(*latest - 1 - run->vertex);
    return true;
}

/* Appends the triangles of the face of `count` corners at hand. */
static bool put_face(struct reading *r, size_t count)
{
    bool has_normals = true;
    if (count - 2 > KILN_MAX_MESH_TRIANGLES - r->triangle_count)
        return decode_refuse_size(r->error);
    if (!decode_polygon_resize(&r->polygon, count))
        return decode_out_of_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        has_normals = has_normals && r->face[i].numbers[NORMAL] > 0;
        memcpy(r->polygon.points[i], r->positions[r->face[i].numbers[POSITION] - 1],
               sizeof *r->polygon.points);
    }
    decode_polygon_divide(&r->polygon);
    if (!begin_run(r, has_normals))
        return false;
    for (size_t i = 0; i < count && !has_normals; i++)
        r->face[i].numbers[NORMAL] = 0;
    for (size_t i = 0; i < count - 2; i++) {
        if (!GROW(r, triangles, r->triangle_count, triangle_capacity))
            return false;
        uint32_t *triangle = r->triangles[r->triangle_count++];
        for (int c = 0; c < 3; c++) {
            if (!find_vertex(r, &r->face[r->polygon.triangles[i][c]], &triangle[c]))
                return false;
        }
    }
    return true;
}

static bool read_face(struct reading *r, struct decode_line *line)
{
    struct decode_word word;
    size_t count = 0;
    while (take_word(line, &word)) {
        if (!GROW(r, face, count, face_capacity) || !read_corner(r, &word, &r->face[count++]))
            return false;
    }
    r->total.others += count > 0 && count < 3;
    return count < 3 || put_face(r, count);
}

static bool read_faces(struct reading *r)
{
    struct decode_line line;
    struct decode_word word;
    r->latest = calloc(r->total.values[POSITION] + 1, sizeof *r->latest);
    if (!r->latest)
        return decode_out_of_memory(r->error);
    r->text = begin(r);
    while (decode_text_line(&r->text, &line)) {
        if (!decode_line_word(&line, &word))
            continue;
        count_line(&r->seen, &word);
        if (r->wanted->materials && decode_word_is(&word, "mtllib"))
            add_libraries(r, &line);
        if (is_face(&word) ? !read_face(r, &line)
                           : decode_word_is(&word, "usemtl") && !use_material(r, &line))
            return false;
    }
    return true;
}

/* ---- looks ----------------------------------------------------------------------------------- */

/* Gets a file of materials from kiln, and reads it. Returns whether it could be read. */
static bool read_library(const struct reading *r, const struct decode_word *name,
                         struct decode_model *model, const struct decode_word *names,
                         bool *is_found)
{
    char path[KILN_TEXTURE_PATH_SIZE];
    size_t size = 0;
    if (name->length >= sizeof path || !r->wanted->open)
        return false;
    for (size_t i = 0; i < name->length; i++)
        path[i] = (char)(name->start[i] == '\\' ? '/' : name->start[i]);
    path[name->length] = '\0';
    unsigned char *bytes = r->wanted->open(r->wanted->user, KILN_COMPANION_MATERIALS, path, &size);
    if (bytes)
        decode_mtl(model, bytes, size, names, is_found);
    free(bytes);
    return bytes != NULL;
}

/* Finds the names of the materials of the result by their numbers, which are in ascending order. */
static void find_names(const struct reading *r, const uint32_t *numbers, uint32_t count,
                       struct decode_word *names)
{
    for (size_t slot = 0; slot < r->table_size; slot++) {
        uint32_t low = 0, high = count;
        while (low < high) {
            const uint32_t middle = low + (high - low) / 2;
            if (numbers[middle] < r->materials[slot])
                low = middle + 1;
            else
                high = middle;
        }
        if (r->materials[slot] > 0 && low < count && numbers[low] == r->materials[slot])
            names[low] = r->names[slot];
    }
}

/* Reads the materials that the faces have, if they are wanted. */
static bool put_looks(struct reading *r, struct decode_model *model)
{
    uint32_t numbers[KILN_MAX_MATERIALS];
    struct decode_word names[KILN_MAX_MATERIALS] = {{NULL, 0}};
    bool is_found[KILN_MAX_MATERIALS] = {false}, all_read = true;
    if (!model->looks)
        return true;
    if (!decode_assign_looks(model, 0, numbers, r->error))
        return false;
    const uint32_t count = model->looks->material_count;
    find_names(r, numbers, count, names);
    for (uint32_t i = 0; i < count; i++)
        decode_copy_name(names[i].start, names[i].length, model->looks->materials[i].name);
    if (r->library_count > MOST_LIBRARIES)
        decode_note(model->notes, "the mesh names %zu files of materials; only %d are read",
                    r->library_count, MOST_LIBRARIES);
    for (size_t i = 0; i < r->library_count && i < MOST_LIBRARIES && count > 0; i++)
        all_read = read_library(r, &r->libraries[i], model, names, is_found) && all_read;
    decode_drop_textures(model->looks);
    for (uint32_t i = 0; i < count && all_read; i++) {
        if (!is_found[i])
            decode_note(model->notes, "no file that the mesh names has its material '%s'",
                        model->looks->materials[i].name);
    }
    return true;
}

/* ---- the model ------------------------------------------------------------------------------- */

static bool put_mesh(const struct reading *r, const struct run *run, struct decode_model_mesh *mesh)
{
    static const float none[2] = {0};
    const struct corner *vertices = r->vertices + run->vertex;
    const size_t count = mesh->vertex_count;
    mesh->positions = malloc(count * sizeof *mesh->positions);
    mesh->normals = run->has_normals ? malloc(count * sizeof *mesh->normals) : NULL;
    mesh->uvs = run->has_uvs ? malloc(count * sizeof *mesh->uvs) : NULL;
    mesh->colors = r->has_colors ? malloc(count * sizeof *mesh->colors) : NULL;
    mesh->triangles = malloc(mesh->triangle_count * sizeof *mesh->triangles);
    if (!mesh->positions || !mesh->triangles || (run->has_normals && !mesh->normals) ||
        (run->has_uvs && !mesh->uvs) || (r->has_colors && !mesh->colors))
        return decode_out_of_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *numbers = vertices[i].numbers;
        memcpy(mesh->positions[i], r->positions[numbers[POSITION] - 1], sizeof *mesh->positions);
        if (mesh->normals)
            memcpy(mesh->normals[i], r->normals[numbers[NORMAL] - 1], sizeof *mesh->normals);
        if (mesh->colors)
            memcpy(mesh->colors[i], r->colors[numbers[POSITION] - 1], sizeof *mesh->colors);
        if (mesh->uvs)
            memcpy(mesh->uvs[i], numbers[UV] > 0 ? r->uvs[numbers[UV] - 1] : none,
                   sizeof *mesh->uvs);
    }
    memcpy(mesh->triangles, r->triangles + run->triangle,
           mesh->triangle_count * sizeof *mesh->triangles);
    return true;
}

static bool put_meshes(const struct reading *r, struct decode_model *model)
{
    const size_t count = r->run_count;
    bool ok = decode_model_allocate(model, count) || decode_out_of_memory(r->error);
    for (size_t i = 0; ok && i < count; i++) {
        const struct run *run = &r->runs[i];
        struct decode_model_mesh *mesh = &model->meshes[i];
        const bool is_last = i + 1 == count;
        mesh->material = mesh->source = run->material;
        mesh->vertex_count = (is_last ? r->vertex_count : run[1].vertex) - run->vertex;
        mesh->triangle_count = (is_last ? r->triangle_count : run[1].triangle) - run->triangle;
        ok = put_mesh(r, run, mesh);
    }
    return ok;
}

bool decode_obj(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error)
{
    struct reading r = {.wanted = wanted, .error = error};
    bool ok = check_contents(&r) && count_lines(&r) && read_values(&r) && read_faces(&r);
    if (ok && r.triangle_count == 0)
        ok = REFUSE(&r, "the mesh has no triangles%s",
                    r.total.others > 0 ? ", only points or lines" : "");
    ok = ok && put_meshes(&r, model) && put_looks(&r, model);
    decode_polygon_finish(&r.polygon);
    free(r.positions);
    free(r.uvs);
    free(r.normals);
    free(r.colors);
    free(r.names);
    free(r.materials);
    free(r.vertices);
    free(r.latest);
    free(r.triangles);
    free(r.runs);
    free(r.face);
    return ok;
}
