/* This file makes cells out of the triangles of a mesh, by their areas, or out of its vertices. A
 * triangle faces the side that the normals of its vertices point to, since files differ in which
 * winding is the front. */
#include "scene/source_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/source_alias.h"
#include "shared/exact.h"
#include "shared/source.h"

/* How a mesh lies in the frame of its emitter. */
struct placing {
    const float (*rotation)[3]; /* columns */
    float scale;
};

/* Computes in doubles, so that every machine rounds alike. */
void kiln_source_place(const float from[3], const float rotation[3][3], float scale, float to[3])
{
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int k = 0; k < 3; k++)
            sum += (double)rotation[k][c] * (double)from[k];
        to[c] = exact_canon((float)(sum * (double)scale));
    }
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double kiln_source_triangle(const struct kiln_mesh *mesh, uint32_t triangle, uint32_t corners[3])
{
    double edges[2][3], mean[3] = {0}, normal[3];
    memcpy(corners, mesh->triangles[triangle], sizeof *mesh->triangles);
    for (int c = 0; c < 3; c++) {
        const double first = (double)mesh->vertices[corners[0]][c];
        edges[0][c] = (double)mesh->vertices[corners[1]][c] - first;
        edges[1][c] = (double)mesh->vertices[corners[2]][c] - first;
        for (int k = 0; k < 3; k++)
            mean[c] += (double)mesh->vertices[corners[k]][3 + c];
    }
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1) % 3, e = (c + 2) % 3;
        normal[c] = edges[0][d] * edges[1][e] - edges[0][e] * edges[1][d];
    }
    if (dot3(normal, mean) < 0) {
        const uint32_t second = corners[1];
        corners[1] = corners[2];
        corners[2] = second;
    }
    return 0.5 * sqrt(dot3(normal, normal));
}

static void write_triangle(float4 *words, const struct placing *at, const struct kiln_mesh *mesh,
                           uint32_t triangle, const struct kiln_alias *alias)
{
    uint32_t corners[3];
    float v[3][3];
    kiln_source_triangle(mesh, triangle, corners);
    for (int k = 0; k < 3; k++)
        kiln_source_place(mesh->vertices[corners[k]], at->rotation, at->scale, v[k]);
    words[0] = FLOAT4(v[0][0], v[0][1], v[0][2], alias->share);
    words[1] = FLOAT4(exact_canon(v[1][0] - v[0][0]), exact_canon(v[1][1] - v[0][1]),
                      exact_canon(v[1][2] - v[0][2]), (float)alias->other);
    words[2] = FLOAT4(exact_canon(v[2][0] - v[0][0]), exact_canon(v[2][1] - v[0][1]),
                      exact_canon(v[2][2] - v[0][2]), 0.0f);
}

static bool fill_triangles(const struct kiln_mesh *mesh, const struct placing *at,
                           struct kiln_source *source, bool *has_area)
{
    const uint32_t count = mesh->triangle_count;
    double *areas = malloc(count * sizeof *areas), sum = 0;
    struct kiln_alias *table = malloc(count * sizeof *table);
    bool ok = areas && table;
    for (uint32_t i = 0; ok && i < count; i++) {
        uint32_t corners[3];
        areas[i] = kiln_source_triangle(mesh, i, corners);
        sum += areas[i];
    }
    source->making = (uint64_t)count * KILN_ALIAS_BYTES;
    *has_area = !ok || (sum > 0 && isfinite(sum));
    ok = ok && *has_area && kiln_alias_fill(areas, count, table);
    for (uint32_t i = 0; ok && i < count; i++)
        write_triangle(source->words + (size_t)i * source->words_of_cell, at, mesh, i, &table[i]);
    for (uint32_t i = 0; ok && source->corners && i < count; i++)
        kiln_source_triangle(mesh, i, source->corners[i]);
    free(areas);
    free(table);
    return ok;
}

static void fill_vertices(const struct kiln_mesh *mesh, const struct placing *at,
                          struct kiln_source *source)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        float place[3], normal[3];
        kiln_source_place(mesh->vertices[i], at->rotation, at->scale, place);
        kiln_source_place(mesh->vertices[i] + 3, at->rotation, 1.0f, normal);
        source->words[(size_t)i * SOURCE_VERTEX_WORDS] = FLOAT4(place[0], place[1], place[2], 1.0f);
        source->words[(size_t)i * SOURCE_VERTEX_WORDS + 1] =
            FLOAT4(normal[0], normal[1], normal[2], (float)i);
    }
}

bool kiln_source_fill_mesh(struct kiln_arena *arena, const struct kiln_mesh *mesh,
                           enum kiln_source_on on, const float rotation[3][3], float scale,
                           bool posed, struct kiln_source *source, bool *has_area)
{
    const bool vertices = on == KILN_ON_VERTICES;
    const struct placing at = {rotation, scale};
    *has_area = true;
    source->cells = vertices ? mesh->vertex_count : mesh->triangle_count;
    source->words_of_cell = vertices ? SOURCE_VERTEX_WORDS
                            : posed  ? SOURCE_POSED_WORDS
                                     : SOURCE_TRIANGLE_WORDS;
    source->word_count = source->cells * source->words_of_cell;
    if (posed)
        source->corners = kiln_arena_alloc(arena, source->cells, sizeof *source->corners);
    source->words = kiln_arena_alloc(arena, source->word_count, sizeof *source->words);
    memcpy(source->hash, mesh->hash, sizeof source->hash);
    if (!source->words || (posed && !source->corners))
        return false;
    if (!vertices)
        return fill_triangles(mesh, &at, source, has_area);
    fill_vertices(mesh, &at, source);
    return true;
}
