/* This file checks whether a mesh is closed, so that it has an inside: at each edge, as many
 * triangles must run one way as the other. Vertices at one place may differ in their normals, so
 * places are numbered first. */
#include "asset/geometry/closed.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"

struct place {
    float at[3];
    uint32_t vertex;
};

struct edge {
    uint32_t low, high; /* the two places that it joins */
    int32_t way;        /* 1: from low to high; -1: from high to low */
};

static int by_place(const void *left, const void *right)
{
    const struct place *a = left, *b = right;
    for (int c = 0; c < 3; c++) {
        if (a->at[c] != b->at[c])
            return a->at[c] < b->at[c] ? -1 : 1;
    }
    return 0;
}

static int by_ends(const void *left, const void *right)
{
    const struct edge *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return 0;
}

/* Numbers the places of vertices: finds the place of each vertex, and a vertex of each place. */
static bool number_places(const struct kiln_mesh *mesh, uint32_t *place_of, uint32_t *vertex_of)
{
    struct place *places = malloc(mesh->vertex_count * sizeof *places);
    if (!places)
        return false;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *v = mesh->vertices[i];
        places[i] = (struct place){{v[0], v[1], v[2]}, i};
    }
    qsort(places, mesh->vertex_count, sizeof *places, by_place);
    uint32_t number = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        number += i > 0 && by_place(&places[i - 1], &places[i]) != 0;
        place_of[places[i].vertex] = number;
        vertex_of[number] = places[i].vertex;
    }
    free(places);
    return true;
}

/* Visits the edges of a mesh whose ends are two places. With `edges`, stores each behind the last
 * one of its lower place, whose end is ends[low]; else only counts them there. */
static void visit_edges(const struct kiln_mesh *mesh, const uint32_t *place_of, uint32_t *ends,
                        struct edge *edges)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int c = 0; c < 3; c++) {
            const uint32_t a = place_of[mesh->triangles[i][c]];
            const uint32_t b = place_of[mesh->triangles[i][(c + 1) % 3]];
            if (a == b)
                continue;
            const struct edge edge = a < b ? (struct edge){a, b, 1} : (struct edge){b, a, -1};
            const uint32_t at = ends[edge.low]++;
            if (edges)
                edges[at] = edge;
        }
    }
}

/* Lists the edges in the order of their ends. ends: zeros, one for each place. Most places have few
 * edges, so putting edges at their lower places leaves little to sort. */
static size_t list_edges(const struct kiln_mesh *mesh, const uint32_t *place_of, uint32_t *ends,
                         struct edge *edges)
{
    uint32_t count = 0;
    visit_edges(mesh, place_of, ends, NULL);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const uint32_t own = ends[i];
        ends[i] = count;
        count += own;
    }
    visit_edges(mesh, place_of, ends, edges);
    for (uint32_t i = 0, first = 0; i < mesh->vertex_count; i++) {
        if (ends[i] - first > 1)
            qsort(edges + first, ends[i] - first, sizeof *edges, by_ends);
        first = ends[i];
    }
    return count;
}

static void find_opening(const struct kiln_mesh *mesh, const struct edge *edges, size_t count,
                         const uint32_t *vertex_of, struct kiln_opening *opening)
{
    for (size_t first = 0, next; first < count; first = next) {
        int32_t sum = 0;
        for (next = first; next < count && by_ends(&edges[first], &edges[next]) == 0; next++)
            sum += edges[next].way;
        if (sum == 0)
            continue;
        const float *a = mesh->vertices[vertex_of[edges[first].low]];
        const float *b = mesh->vertices[vertex_of[edges[first].high]];
        snprintf(
            opening->text, sizeof opening->text, "%zu %s at the edge from %g %g %g to %g %g %g%s",
            next - first, next - first == 1 ? "triangle is" : "triangles are", (double)a[0],
            (double)a[1], (double)a[2], (double)b[0], (double)b[1], (double)b[2],
            next - first == 1 ? ", where there must be two" : ", and do not face the same side");
        return;
    }
}

bool kiln_mesh_find_opening(const struct kiln_mesh *mesh, struct kiln_opening *opening)
{
    uint32_t *place_of = malloc(mesh->vertex_count * sizeof *place_of);
    uint32_t *vertex_of = malloc(mesh->vertex_count * sizeof *vertex_of);
    uint32_t *ends = calloc(mesh->vertex_count, sizeof *ends);
    struct edge *edges = malloc((size_t)mesh->triangle_count * 3 * sizeof *edges);
    const bool ok =
        place_of && vertex_of && ends && edges && number_places(mesh, place_of, vertex_of);
    opening->text[0] = '\0';
    if (ok)
        find_opening(mesh, edges, list_edges(mesh, place_of, ends, edges), vertex_of, opening);
    free(place_of);
    free(vertex_of);
    free(ends);
    free(edges);
    return ok;
}

bool kiln_mesh_check_closed(const struct kiln_mesh *mesh, const char *name,
                            struct kiln_error *error)
{
    struct kiln_opening opening;
    if (!kiln_mesh_find_opening(mesh, &opening))
        return kiln_error_no_memory(error, "%s", name);
    return !*opening.text || kiln_error_set(error, KILN_INVALID_INPUT,
                                            "%s: the mesh is not closed, so it has no inside: %s",
                                            name, opening.text);
}
