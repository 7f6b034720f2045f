/* This file makes the signed distance field of a closed mesh. Distances come from a tree of the
 * triangles. The sign of a sample comes from its winding number, counted along rows: planes between
 * samples cut the triangles in closed curves. The ends of the curves' pieces meet exactly, since
 * both triangles at an edge compute them alike. */
#include "asset/geometry/field.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/closed.h"
#include "asset/geometry/grid_in.h"
#include "asset/geometry/nearest.h"
#include "base/cache.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/thread.h"
#include "shared/exact.h"

enum {
    VERSION = 2, /* version of the algorithm, part of a cached field's name */
    NAME_SIZE = 72,
    MARGIN = 2, /* cells around the bounding box, in addition to the reach */
};

static size_t sample_count(const struct kiln_field *field)
{
    return (size_t)field->size[0] * field->size[1] * field->size[2];
}

static double coordinate(const struct kiln_field *field, int axis, uint32_t i)
{
    return (double)field->origin[axis] + (double)i * (double)field->spacing;
}

/* ---- sign ------------------------------------------------------------------------------------ */

struct cut {
    double x, y;
};

/* Finds where an edge passes the plane z; the result is the same for both directions of the edge.
 */
static struct cut cut_edge(const float *a, const float *b, double z)
{
    bool swap = a[2] != b[2] ? a[2] > b[2] : a[1] != b[1] ? a[1] > b[1] : a[0] > b[0];
    const float *low = swap ? b : a, *high = swap ? a : b;
    const double part = (z - (double)low[2]) / ((double)high[2] - (double)low[2]);
    return (struct cut){(double)low[0] + part * ((double)high[0] - (double)low[0]),
                        (double)low[1] + part * ((double)high[1] - (double)low[1])};
}

/* Adds the direction of a piece of a curve to all samples before it in the rows that it crosses. */
static void wind(const struct kiln_field *field, struct cut from, struct cut to, int32_t *turns)
{
    if (from.y == to.y)
        return;
    const int32_t way = from.y < to.y ? 1 : -1;
    const struct cut low = way > 0 ? from : to, high = way > 0 ? to : from;
    for (uint32_t j = 0; j < field->size[1]; j++) {
        const double y = coordinate(field, 1, j);
        if (!(low.y <= y && y < high.y))
            continue;
        const double x = low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x);
        uint32_t before = 0;
        const double along = (x - (double)field->origin[0]) / (double)field->spacing;
        if (along > 0.0)
            before = along < (double)field->size[0] ? (uint32_t)along + 1 : field->size[0];
        int32_t *row = turns + (size_t)j * (field->size[0] + 1);
        row[0] += way;
        row[before] -= way;
    }
}

/* Computes the winding numbers of a layer, as differences along its rows. */
static void wind_layer(const struct kiln_field *field, const struct kiln_mesh *mesh, double z,
                       int32_t *turns)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct cut up = {0}, down = {0};
        int cuts = 0;
        for (int c = 0; c < 3; c++) {
            const float *a = mesh->vertices[mesh->triangles[i][c]];
            const float *b = mesh->vertices[mesh->triangles[i][(c + 1) % 3]];
            const bool from_above = (double)a[2] > z, to_above = (double)b[2] > z;
            if (from_above == to_above)
                continue;
            *(to_above ? &up : &down) = cut_edge(a, b, z);
            cuts++;
        }
        if (cuts == 2)
            wind(field, up, down, turns);
    }
}

/* Returns whether a sample of this layer is inside. */
static bool reaches_inside(const struct kiln_field *field, const struct kiln_mesh *mesh, uint32_t z,
                           int32_t *turns, size_t turns_size)
{
    int32_t turn = 0;
    memset(turns, 0, turns_size * sizeof *turns);
    wind_layer(field, mesh, coordinate(field, 2, z), turns);
    for (size_t i = 0; i < turns_size; i++) {
        turn = i % (field->size[0] + 1) == 0 ? turns[i] : turn + turns[i];
        if (turn != 0 && i % (field->size[0] + 1) < field->size[0])
            return true;
    }
    return false;
}

/* Checks that some sample is inside. Layers are tried from the middle outwards, since the middle
 * one nearly always has some. */
static bool check_inside(const struct kiln_field *field, const struct kiln_mesh *mesh,
                         const char *name, uint32_t cells, struct kiln_error *error)
{
    const size_t turns_size = (size_t)(field->size[0] + 1) * field->size[1];
    const uint32_t layers = field->size[2];
    int32_t *turns = malloc(turns_size * sizeof *turns);
    if (!turns)
        return kiln_error_no_memory(error, "%s", name);
    bool inside = false;
    for (uint32_t i = 0; i < layers && !inside; i++) {
        const uint32_t z = i % 2 == 0 ? layers / 2 + i / 2 : layers / 2 - (i + 1) / 2;
        inside = reaches_inside(field, mesh, z, turns, turns_size);
    }
    free(turns);
    return inside ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the mesh is thinner than one of %u cells everywhere, so particles "
                          "would not collide with it; at most %d cells are allowed",
                          name, cells, KILN_MAX_FIELD_CELLS);
}

/* ---- samples --------------------------------------------------------------------------------- */

struct making {
    struct kiln_field *field;
    const struct kiln_mesh *mesh;
    const struct kiln_nearest *nearest;
    int32_t *turns; /* for each thread: a layer of winding numbers, with one more in each row */
    size_t turns_size;
};

static void make_row(const struct making *making, uint32_t y, uint32_t z, const int32_t *turns)
{
    struct kiln_field *field = making->field;
    const double spacing = (double)field->spacing;
    float(*row)[4] = field->samples + ((size_t)z * field->size[1] + y) * field->size[0];
    double p[3] = {0, coordinate(field, 1, y), coordinate(field, 2, z)}, most = 1e300;
    int32_t turn = 0;
    for (uint32_t x = 0; x < field->size[0]; x++) {
        p[0] = coordinate(field, 0, x);
        const double square = kiln_nearest_square(making->nearest, p, most);
        const float distance = exact_sqrt((float)square);
        /* the largest distance that the next sample can have */
        const double reach = (double)distance + 1.01 * spacing;
        most = reach * reach;
        turn += turns[x];
        row[x][3] = turn != 0 ? -distance : distance;
    }
}

static void make_layers(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct making *making = context;
    const struct kiln_field *field = making->field;
    int32_t *turns = making->turns + worker * making->turns_size;
    for (size_t z = begin; z < end; z++) {
        memset(turns, 0, making->turns_size * sizeof *turns);
        wind_layer(field, making->mesh, coordinate(field, 2, (uint32_t)z), turns);
        for (uint32_t y = 0; y < field->size[1]; y++)
            make_row(making, y, (uint32_t)z, turns + (size_t)y * (field->size[0] + 1));
    }
}

/* Computes gradients: between both neighbours, or at the edges to the only neighbour. */
static void find_growth(struct kiln_field *field)
{
    const size_t steps[3] = {1, field->size[0], (size_t)field->size[0] * field->size[1]};
    const size_t count = sample_count(field);
    for (size_t i = 0; i < count; i++) {
        const uint32_t at[3] = {(uint32_t)(i % steps[1]), (uint32_t)(i / steps[1] % field->size[1]),
                                (uint32_t)(i / steps[2])};
        for (int c = 0; c < 3; c++) {
            const size_t before = at[c] > 0 ? i - steps[c] : i;
            const size_t after = at[c] + 1 < field->size[c] ? i + steps[c] : i;
            const float way = after - before > steps[c] ? 2.0f : 1.0f;
            const float change = field->samples[after][3] - field->samples[before][3];
            field->samples[i][c] = exact_canon(change / (way * field->spacing));
        }
        field->samples[i][3] = exact_canon(field->samples[i][3]);
    }
}

static bool make(struct kiln_field *field, const struct kiln_mesh *mesh, const char *name,
                 struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_nearest *nearest = kiln_nearest_create(mesh);
    struct making making = {.field = field,
                            .mesh = mesh,
                            .nearest = nearest,
                            .turns_size = (size_t)(field->size[0] + 1) * field->size[1]};
    making.turns = malloc(making.turns_size * kiln_threads_count(threads) * sizeof *making.turns);
    field->samples = malloc(sample_count(field) * sizeof *field->samples);
    const bool ok = nearest && making.turns && field->samples;
    if (ok) {
        kiln_threads_for(threads, field->size[2], 1, make_layers, &making);
        find_growth(field);
    } else {
        kiln_error_no_memory(error, "%s", name);
    }
    kiln_nearest_destroy(&nearest);
    free(making.turns);
    return ok;
}

/* ---- cache ----------------------------------------------------------------------------------- */

/* Names the field in the cache by the mesh's vertices and triangles, the cells and the margin. */
static bool find_name(char name[NAME_SIZE], const struct kiln_mesh *mesh, uint32_t cells,
                      const struct kiln_field *field)
{
    const size_t triangles = mesh->triangle_count * sizeof *mesh->triangles;
    const uint32_t head[5] = {VERSION, cells, field->size[0], mesh->vertex_count,
                              mesh->triangle_count};
    const size_t place_bytes = 3 * sizeof(float);
    const size_t size = sizeof head + triangles + mesh->vertex_count * place_bytes;
    unsigned char *bytes = malloc(size), *end = bytes;
    if (!bytes)
        return false;
    memcpy(end, head, sizeof head);
    end += sizeof head;
    memcpy(end, mesh->triangles, triangles);
    end += triangles;
    for (uint32_t i = 0; i < mesh->vertex_count; i++, end += place_bytes)
        memcpy(end, mesh->vertices[i], place_bytes);
    char hash[65];
    kiln_hash_sha256(bytes, size, hash);
    free(bytes);
    snprintf(name, NAME_SIZE, "%s.field", hash);
    return true;
}

/* ---- making the field ------------------------------------------------------------------------ */

/* Returns the number of cells around the mesh's bounding box. */
static uint32_t find_margin(float spacing, uint32_t cells, float reach, const char *name,
                            struct kiln_error *error)
{
    const float along = reach / spacing;
    if (!(along <= (float)KILN_MAX_FIELD_CELLS)) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: balls with a radius of %.3g units of the file reach %.0f cells beyond "
                       "the mesh, which has %u along its longest side; at most %d are allowed",
                       name, (double)reach, (double)along, cells, KILN_MAX_FIELD_CELLS);
        return 0;
    }
    const uint32_t whole = (uint32_t)along;
    return MARGIN + whole + ((float)whole < along ? 1 : 0);
}

/* Fills all members of a field except its samples. */
static bool place(struct kiln_field *field, const struct kiln_mesh *mesh, const char *name,
                  uint32_t cells, float reach, struct kiln_error *error)
{
    float longest = 1e-6f;
    for (int c = 0; c < 3; c++)
        longest = exact_max(longest, mesh->max[c] - mesh->min[c]);
    field->spacing = longest / (float)cells;
    const uint32_t margin = find_margin(field->spacing, cells, reach, name, error);
    if (margin == 0)
        return false;
    for (int c = 0; c < 3; c++) {
        const float along = (mesh->max[c] - mesh->min[c]) / field->spacing;
        const uint32_t whole = (uint32_t)along;
        field->size[c] = whole + ((float)whole < along ? 1 : 0) + 1 + 2 * margin;
        field->origin[c] = exact_canon(mesh->min[c] - (float)margin * field->spacing);
    }
    if (sample_count(field) > KILN_MAX_GRID_SAMPLES)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: %u cells and balls with a radius of %.3g units of the file need "
                              "%zu samples in and around the mesh; at most %d are allowed",
                              name, cells, (double)reach, sample_count(field),
                              KILN_MAX_GRID_SAMPLES);
    return true;
}

bool kiln_field_check(const struct kiln_mesh *mesh, const char *name, uint32_t cells, float reach,
                      size_t *count, struct kiln_error *error)
{
    struct kiln_field field = {.samples = NULL};
    if (!kiln_mesh_check_closed(mesh, name, error) ||
        !place(&field, mesh, name, cells, reach, error) ||
        !check_inside(&field, mesh, name, cells, error))
        return false;
    *count = sample_count(&field);
    return true;
}

struct kiln_field *kiln_field_create(const struct kiln_mesh *mesh, const char *name, uint32_t cells,
                                     float reach, const char *cache, struct kiln_threads *threads,
                                     struct kiln_error *error)
{
    struct kiln_field *field = calloc(1, sizeof *field);
    if (!field) {
        kiln_error_no_memory(error, "%s", name);
        return NULL;
    }
    bool ok = place(field, mesh, name, cells, reach, error);
    const size_t bytes = sample_count(field) * sizeof *field->samples;
    char cached_name[NAME_SIZE];
    const bool cached = ok && cache && find_name(cached_name, mesh, cells, field);
    field->samples = cached ? kiln_cache_read(cache, cached_name, bytes) : NULL;
    if (ok && !field->samples) {
        ok = make(field, mesh, name, threads, error);
        if (ok && cached)
            kiln_cache_write(cache, cached_name, field->samples, bytes);
    }
    if (!ok)
        kiln_field_destroy(&field);
    return field;
}

void kiln_field_destroy(struct kiln_field **field)
{
    if (!*field)
        return;
    free((*field)->samples);
    free(*field);
    *field = NULL;
}
