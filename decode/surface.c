/* This file makes one surface of a mesh file that does not move: it places the parts where the
 * file's nodes put them, adds normals where the file has none, and joins equal vertices. Assimp
 * could do that, but its sums are rounded differently on different processors. Here, sums are in
 * double, and no multiplication is fused with an addition. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"
#include "model.h"

/* The cosine of 50 degrees, up to which an edge between triangles is smooth. Where more than
 * MOST_CREASED triangles meet, all edges are smooth. */
static const double CREASE = 0.6427876096865394;
enum { MOST_CREASED = 64 };

/* A hash table of numbers from 1. A slot with 0 is empty. */
struct table {
    uint32_t *slots;
    size_t size; /* a power of two */
};

/* Makes an empty table that entries, of which there are `most` or fewer, fill by half; where the
 * corners have more places than a mesh may have vertices, it is fuller. */
static bool make_table(struct table *table, size_t most)
{
    table->size = 64;
    while (table->size < 2 * most && table->size < (size_t)4 * KILN_MAX_MESH_VERTICES)
        table->size *= 2;
    table->slots = calloc(table->size, sizeof *table->slots);
    return table->slots != NULL;
}

struct part {
    const struct decode_model_mesh *mesh;
    size_t order; /* position in the file */
    const double (*rows)[4];
};

/* The struct holds what a corner has besides if materials are wanted. It is kept apart, since
 * corners are many. */
struct extra {
    float color[4], second_uv[2];
};

struct surface {
    const struct decode_mesh *wanted;
    struct kiln_mesh_result *result;
    struct kiln_error *error;
    struct part *parts; /* in the order of their materials */
    size_t part_count;
    struct decode_corner *corners; /* three a triangle */
    size_t corner_count;
    struct kiln_looks_result *looks; /* NULL: materials are not wanted */
    struct extra *extras;            /* of the corners, if they are */
    double (*faces)[3];              /* unit normals of triangles, or 0 */
    double *angles;                  /* of triangles at their corners, radians */
};

/* ---- parts ----------------------------------------------------------------------------------- */

/* Finds the parts that have triangles, and counts the corners. */
static bool find_parts(struct surface *s, const struct decode_model *model)
{
    s->parts = malloc((model->part_count + 1) * sizeof *s->parts);
    if (!s->parts)
        return decode_out_of_memory(s->error);
    for (size_t i = 0; i < model->part_count; i++) {
        const struct decode_model_part *from = &model->parts[i];
        const struct decode_model_mesh *mesh = &model->meshes[from->mesh];
        if (mesh->triangle_count == 0)
            continue;
        if (mesh->triangle_count > KILN_MAX_MESH_TRIANGLES - s->corner_count / 3)
            return decode_refuse_size(s->error);
        s->corner_count += 3 * mesh->triangle_count;
        s->parts[s->part_count++] = (struct part){.mesh = mesh, .order = i, .rows = from->rows};
    }
    return true;
}

/* Orders parts by material, then by their position in the file. */
static int by_material(const void *a, const void *b)
{
    const struct part *x = a, *y = b;
    const uint32_t first = x->mesh->material, second = y->mesh->material;
    return first != second ? (first > second) - (first < second)
                           : (x->order > y->order) - (x->order < y->order);
}

/* ---- corners --------------------------------------------------------------------------------- */

/* Finds the cofactors of a matrix, which transform normals such that they stay perpendicular to a
 * scaled surface. Those of a mirroring matrix are negated, since they would turn normals inwards.
 * Returns whether the matrix mirrors. */
static bool find_cofactors(const double rows[3][4], double out[3][3])
{
    for (int row = 0; row < 3; row++) {
        const double *a = rows[(row + 1) % 3], *b = rows[(row + 2) % 3];
        for (int c = 0; c < 3; c++)
            out[row][c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    }
    const double determinant =
        rows[0][0] * out[0][0] + rows[0][1] * out[0][1] + rows[0][2] * out[0][2];
    for (int i = 0; i < 9 && determinant < 0; i++)
        out[i / 3][i % 3] = -out[i / 3][i % 3];
    return determinant < 0;
}

/* Scales a vector to length 1, or to 0 where it has no direction. */
static void normalize(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const bool good = length > 1e-30 && length < 1e30;
    for (int c = 0; c < 3; c++)
        v[c] = good ? v[c] / length : 0;
}

/* Stores a corner's normal; one without a direction points upwards. */
static void keep_normal(struct decode_corner *corner, double normal[3])
{
    normalize(normal);
    const bool none = normal[0] == 0 && normal[1] == 0 && normal[2] == 0;
    for (int c = 0; c < 3; c++)
        corner->normal[c] = none ? (c == 1 ? 1.0f : 0.0f) : (float)normal[c] + 0.0f;
}

static void put_corner(const struct part *part, const double cofactors[3][3], uint32_t vertex,
                       struct decode_corner *corner)
{
    const struct decode_model_mesh *mesh = part->mesh;
    const float *p = mesh->positions[vertex];
    for (int row = 0; row < 3; row++) {
        const double *m = part->rows[row];
        corner->position[row] =
            (float)(m[0] * (double)p[0] + m[1] * (double)p[1] + m[2] * (double)p[2] + m[3]) + 0.0f;
    }
    corner->has_normal = mesh->normals != NULL;
    if (corner->has_normal) {
        const float *n = mesh->normals[vertex];
        double turned[3];
        for (int row = 0; row < 3; row++) {
            const double *m = cofactors[row];
            turned[row] = m[0] * (double)n[0] + m[1] * (double)n[1] + m[2] * (double)n[2];
        }
        keep_normal(corner, turned);
    }
    corner->uv[0] = mesh->uvs ? mesh->uvs[vertex][0] : 0.0f;
    corner->uv[1] = mesh->uvs ? mesh->uvs[vertex][1] : 0.0f;
}

/* Stores colour and second texture coordinates of a vertex. */
static void put_extra(const struct decode_model_mesh *mesh, uint32_t vertex, struct extra *extra)
{
    static const float white[4] = {1, 1, 1, 1}, none[2] = {0};
    memcpy(extra->color, mesh->colors ? mesh->colors[vertex] : white, sizeof white);
    memcpy(extra->second_uv, mesh->second_uvs ? mesh->second_uvs[vertex] : none, sizeof none);
}

/* Stores what the corners of a part's triangle have besides. triangle: its number in the surface.
 */
static void put_extras(struct surface *s, const struct part *part, size_t triangle,
                       const uint32_t corners[3])
{
    if (!s->extras)
        return;
    for (size_t c = 0; c < 3; c++)
        put_extra(part->mesh, corners[c], &s->extras[3 * triangle + c]);
    s->looks->of_triangles[triangle] =
        s->looks->material_count > 0 ? part->mesh->look : KILN_NO_MATERIAL;
}

/* Finds which attributes some vertices have. */
static void find_attributes(struct surface *s)
{
    for (size_t i = 0; s->looks && i < s->part_count; i++) {
        const struct decode_model_mesh *mesh = s->parts[i].mesh;
        s->looks->has_uvs = s->looks->has_uvs || mesh->uvs != NULL;
        s->looks->has_second_uvs = s->looks->has_second_uvs || mesh->second_uvs != NULL;
        s->looks->has_colors = s->looks->has_colors || mesh->colors != NULL;
    }
}

static void put_corners(struct surface *s)
{
    struct decode_corner *corner = s->corners;
    for (size_t i = 0; i < s->part_count; i++) {
        const struct part *part = &s->parts[i];
        double cofactors[3][3];
        /* the corners of a mirrored triangle take another order, so that its front stays in front
         */
        const int second = find_cofactors(part->rows, cofactors) ? 2 : 1;
        for (size_t k = 0; k < part->mesh->triangle_count; k++) {
            const uint32_t *triangle = part->mesh->triangles[k];
            const uint32_t turned[3] = {triangle[0], triangle[second], triangle[3 - second]};
            put_extras(s, part, (size_t)(corner - s->corners) / 3, turned);
            for (int c = 0; c < 3; c++)
                put_corner(part, cofactors, turned[c], corner++);
        }
    }
}

/* ---- normals --------------------------------------------------------------------------------- */

/* Returns the angle of a cosine, in radians, within 7e-5 (Abramowitz and Stegun 1964, 4.4.45). Its
 * operations round alike everywhere, which a library's acos does not. */
static double angle_of(double cosine)
{
    const double x = fabs(cosine) < 1 ? fabs(cosine) : 1;
    const double angle =
        sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - x * 0.0187293)));
    return cosine < 0 ? 3.14159265358979 - angle : angle;
}

/* Finds two edges of a triangle, from one of its corners to the next one and to the one before. */
static void find_edges(const struct decode_corner triangle[3], int corner, double a[3], double b[3])
{
    const float *at = triangle[corner].position;
    for (int c = 0; c < 3; c++) {
        a[c] = (double)triangle[(corner + 1) % 3].position[c] - (double)at[c];
        b[c] = (double)triangle[(corner + 2) % 3].position[c] - (double)at[c];
    }
}

static void find_faces(struct surface *s)
{
    for (size_t i = 0; i < s->corner_count; i++) {
        double a[3], b[3], *normal = s->faces[i / 3];
        find_edges(&s->corners[i / 3 * 3], (int)(i % 3), a, b);
        for (int c = 0; c < 3 && i % 3 == 0; c++)
            normal[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
        if (i % 3 == 0)
            normalize(normal);
        normalize(a);
        normalize(b);
        s->angles[i] = angle_of(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
}

static uint32_t hash_of(const void *bytes, size_t size)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 16777619u;
    return hash ^ hash >> 15;
}

/* Adds up the normals of all triangles at a place or, with `own`, of those without a crease between
 * them and `own`. A normal is weighted by its triangle's angle there, so that the sum does not
 * depend on how a surface is divided into triangles (Thuermer and Wuethrich 1998). */
static void add_up(const struct surface *s, const uint32_t *next, uint32_t first, const double *own,
                   double sum[3])
{
    memset(sum, 0, 3 * sizeof *sum);
    for (uint32_t i = first; i != UINT32_MAX; i = next[i]) {
        const double *other = s->faces[i / 3];
        if (own && own[0] * other[0] + own[1] * other[1] + own[2] * other[2] < CREASE)
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += s->angles[i] * other[c];
    }
}

/* Computes the normals of the corners at a place that have none in the file. */
static void smooth(struct surface *s, const uint32_t *next, uint32_t first)
{
    double together[3], sum[3];
    size_t count = 0;
    for (uint32_t i = first; i != UINT32_MAX; i = next[i])
        count++;
    add_up(s, next, first, NULL, together);
    for (uint32_t i = first; i != UINT32_MAX; i = next[i]) {
        if (s->corners[i].has_normal)
            continue;
        memcpy(sum, together, sizeof sum);
        if (count <= MOST_CREASED)
            add_up(s, next, first, s->faces[i / 3], sum);
        keep_normal(&s->corners[i], sum);
    }
}

/* Links the corners at each place to a list, in their order. first[] has the first corner of each
 * list, and next[] the one after each corner. Returns the number of lists. */
static size_t chain(const struct surface *s, struct table *table, uint32_t *next, uint32_t *first)
{
    size_t count = 0;
    for (size_t n = s->corner_count; n-- > 0;) {
        const float *position = s->corners[n].position;
        const size_t bytes = sizeof s->corners[n].position;
        size_t slot = hash_of(position, bytes) % table->size;
        while (table->slots[slot] > 0 &&
               memcmp(s->corners[first[table->slots[slot] - 1]].position, position, bytes) != 0)
            slot = (slot + 1) % table->size;
        if (table->slots[slot] == 0) {
            table->slots[slot] = (uint32_t)++count;
            first[count - 1] = UINT32_MAX;
        }
        next[n] = first[table->slots[slot] - 1];
        first[table->slots[slot] - 1] = (uint32_t)n;
    }
    return count;
}

static bool find_normals(struct surface *s)
{
    bool is_needed = false;
    for (size_t i = 0; !is_needed && i < s->corner_count; i++)
        is_needed = !s->corners[i].has_normal;
    if (!is_needed)
        return true;
    struct table table = {.size = 0};
    const bool made = make_table(&table, s->corner_count);
    uint32_t *next = malloc(s->corner_count * sizeof *next);
    uint32_t *first = malloc(s->corner_count * sizeof *first);
    s->faces = malloc(s->corner_count / 3 * sizeof *s->faces);
    s->angles = malloc(s->corner_count * sizeof *s->angles);
    const bool ok = made && next && first && s->faces && s->angles;
    if (ok) {
        find_faces(s);
        const size_t count = chain(s, &table, next, first);
        for (size_t i = 0; i < count; i++)
            smooth(s, next, first[i]);
    }
    free(table.slots);
    free(next);
    free(first);
    free(s->faces);
    free(s->angles);
    return ok || decode_out_of_memory(s->error);
}

bool decode_find_normals(struct decode_corner *corners, size_t count, struct kiln_error *error)
{
    struct surface s = {.corners = corners, .corner_count = count, .error = error};
    return find_normals(&s);
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* Returns whether a vertex has the colour and second texture coordinates of a corner. */
static bool has_extra(const struct surface *s, uint32_t vertex, const struct extra *extra)
{
    return memcmp(s->looks->colors[vertex], extra->color, sizeof extra->color) == 0 &&
           memcmp(s->looks->second_uvs[vertex], extra->second_uv, sizeof extra->second_uv) == 0;
}

/* Finds the number of a corner's vertex, which is an equal vertex or a new one. extra: NULL if
 * materials are not wanted. */
static bool join(struct surface *s, struct table *table, const struct decode_corner *corner,
                 const struct extra *extra, uint32_t *number)
{
    struct kiln_mesh_result *result = s->result;
    const bool uvs = s->wanted->uvs || extra;
    float key[8] = {0};
    memcpy(key, corner->position, sizeof corner->position);
    memcpy(key + 3, corner->normal, sizeof corner->normal);
    if (uvs)
        memcpy(key + 6, corner->uv, sizeof corner->uv);
    uint32_t hash = hash_of(key, sizeof key);
    if (extra)
        hash ^= hash_of(extra, sizeof *extra) * 31;
    size_t slot = hash % table->size;
    for (; table->slots[slot] > 0; slot = (slot + 1) % table->size) {
        *number = table->slots[slot] - 1;
        if (memcmp(result->vertices[*number], key, sizeof *result->vertices) == 0 &&
            (!uvs || memcmp(result->uvs[*number], key + 6, sizeof *result->uvs) == 0) &&
            (!extra || has_extra(s, *number, extra)))
            return true;
    }
    if (result->vertex_count == KILN_MAX_MESH_VERTICES)
        return decode_refuse_size(s->error);
    *number = result->vertex_count++;
    table->slots[slot] = *number + 1;
    memcpy(result->vertices[*number], key, sizeof *result->vertices);
    if (uvs)
        memcpy(result->uvs[*number], key + 6, sizeof *result->uvs);
    if (extra) {
        memcpy(s->looks->colors[*number], extra->color, sizeof extra->color);
        memcpy(s->looks->second_uvs[*number], extra->second_uv, sizeof extra->second_uv);
    }
    return true;
}

static bool put_triangles(struct surface *s)
{
    struct kiln_mesh_result *result = s->result;
    struct table table = {.size = 0};
    const size_t most =
        s->corner_count < KILN_MAX_MESH_VERTICES ? s->corner_count : KILN_MAX_MESH_VERTICES;
    bool ok = make_table(&table, most);
    if (!ok)
        decode_out_of_memory(s->error);
    for (size_t i = 0; ok && i < s->corner_count; i++)
        ok = join(s, &table, &s->corners[i], s->extras ? &s->extras[i] : NULL,
                  &result->triangles[i / 3][i % 3]);
    result->triangle_count = (uint32_t)(s->corner_count / 3);
    free(table.slots);
    return ok;
}

/* ---- all of it ------------------------------------------------------------------------------- */

static bool check_uvs(const struct surface *s)
{
    for (size_t i = 0; s->wanted->uvs && i < s->part_count; i++) {
        if (!s->parts[i].mesh->uvs)
            return kiln_error_set(
                s->error, KILN_INVALID_INPUT,
                "the mesh, or a part of it, has no texture coordinates, which paint needs");
    }
    return true;
}

/* Takes memory for the corners, and puts them there. */
static bool make_corners(struct surface *s)
{
    s->corners = malloc(s->corner_count * sizeof *s->corners);
    s->extras = s->looks ? malloc(s->corner_count * sizeof *s->extras) : NULL;
    if (!s->corners || (s->looks && !s->extras))
        return decode_out_of_memory(s->error);
    put_corners(s);
    return true;
}

bool decode_surface(const struct decode_mesh *wanted, struct decode_model *model,
                    struct kiln_mesh_result *result, struct kiln_error *error)
{
    struct surface s = {.wanted = wanted, .result = result, .error = error, .looks = model->looks};
    bool ok = find_parts(&s, model) && check_uvs(&s);
    if (ok && s.corner_count > 0) {
        qsort(s.parts, s.part_count, sizeof *s.parts, by_material);
        find_attributes(&s);
        ok = make_corners(&s);
        decode_model_finish(model);
        ok = ok && find_normals(&s) && put_triangles(&s);
    }
    free(s.extras);
    free(s.corners);
    free(s.parts);
    return ok;
}
