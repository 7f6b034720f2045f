/* This file makes cells out of the inside of a closed mesh. Upright lines through a lattice of
 * squares, MOST_COLUMNS along the longer edge of the mesh's base, are cut at its triangles.
 * Each piece of a line that is inside is a cell: a column as wide as its square, chosen by its
 * length. So a birth is at most 0.71 edges of a square, level, from a place inside of the mesh;
 * what is thinner than a square may be missed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/source_alias.h"
#include "scene/source_mesh.h"
#include "shared/exact.h"
#include "shared/source.h"

enum {
    MOST_COLUMNS = 256,
    LEAST_COLUMNS = 16,
    MOST_CUTS = 1 << 22, /* lines that may pass through triangles, of all triangles together */
};

/* A point at which an upright line passes through a triangle. */
struct crossing {
    uint32_t line;
    int turns; /* 1: upwards into the mesh, -1: out of it */
    double y;
};

struct crossings {
    struct crossing *items;
    size_t count, room;
};

struct lattice {
    double low[2], edge; /* m: x and z */
    uint32_t columns[2];
};

/* A piece of a line inside of the mesh. */
struct piece {
    double x, y, z, length;
};

static bool add(struct crossings *all, struct crossing one)
{
    if (all->count == all->room) {
        const size_t room = all->room ? 2 * all->room : 4096;
        struct crossing *items = realloc(all->items, room * sizeof *items);
        if (!items)
            return false;
        all->items = items;
        all->room = room;
    }
    all->items[all->count++] = one;
    return true;
}

/* Returns on which side of the edge from a to b a point is, seen from above. The edge is taken in
 * one order of its ends, so that two triangles never both count a line on their edge. */
static int side_of(const double a[3], const double b[3], double x, double z)
{
    const bool swapped = a[0] > b[0] || (a[0] >= b[0] && a[2] > b[2]);
    const double *from = swapped ? b : a, *to = swapped ? a : b;
    const double across = (to[0] - from[0]) * (z - from[2]) - (to[2] - from[2]) * (x - from[0]);
    const int side = across >= 0 ? 1 : -1;
    return swapped ? -side : side;
}

/* Finds the lines that may pass through a triangle, by its bounding box. */
static void find_lines(const struct lattice *at, const double v[3][3], uint32_t first[2],
                       uint32_t last[2])
{
    for (size_t k = 0; k < 2; k++) {
        const double low = fmin(v[0][2 * k], fmin(v[1][2 * k], v[2][2 * k]));
        const double high = fmax(v[0][2 * k], fmax(v[1][2 * k], v[2][2 * k]));
        const double end = at->columns[k] - 1;
        first[k] = (uint32_t)fmin(fmax(floor((low - at->low[k]) / at->edge - 0.5), 0), end);
        last[k] = (uint32_t)fmin(fmax(ceil((high - at->low[k]) / at->edge - 0.5), 0), end);
    }
}

/* Finds the lines through a triangle. */
static bool cut(const struct lattice *at, const double v[3][3], struct crossings *all)
{
    uint32_t first[2], last[2];
    const double area =
        (v[1][0] - v[0][0]) * (v[2][2] - v[0][2]) - (v[1][2] - v[0][2]) * (v[2][0] - v[0][0]);
    if (area >= 0 && area <= 0)
        return true;
    find_lines(at, v, first, last);
    for (uint32_t j = first[1]; j <= last[1]; j++) {
        for (uint32_t i = first[0]; i <= last[0]; i++) {
            const double x = at->low[0] + (i + 0.5) * at->edge;
            const double z = at->low[1] + (j + 0.5) * at->edge;
            const int side = side_of(v[0], v[1], x, z);
            if (side_of(v[1], v[2], x, z) != side || side_of(v[2], v[0], x, z) != side)
                continue;
            const double s =
                ((x - v[0][0]) * (v[2][2] - v[0][2]) - (z - v[0][2]) * (v[2][0] - v[0][0])) / area;
            const double t =
                ((v[1][0] - v[0][0]) * (z - v[0][2]) - (v[1][2] - v[0][2]) * (x - v[0][0])) / area;
            const double y = v[0][1] + s * (v[1][1] - v[0][1]) + t * (v[2][1] - v[0][1]);
            if (!add(all, (struct crossing){j * at->columns[0] + i, side, y}))
                return false;
        }
    }
    return true;
}

static int by_line(const void *a, const void *b)
{
    const struct crossing *x = a, *y = b;
    if (x->line != y->line)
        return x->line < y->line ? -1 : 1;
    if (x->y < y->y || x->y > y->y)
        return x->y < y->y ? -1 : 1;
    return x->turns - y->turns;
}

/* Finds the pieces of lines around which the mesh turns. Returns their number. */
static uint32_t find_pieces(const struct lattice *at, const struct crossings *all,
                            struct piece *pieces)
{
    uint32_t count = 0;
    int turns = 0;
    for (size_t i = 0; i + 1 < all->count; i++) {
        const struct crossing *from = &all->items[i], *to = from + 1;
        turns = i > 0 && from[-1].line == from->line ? turns + from->turns : from->turns;
        if (turns == 0 || to->line != from->line || !(to->y > from->y))
            continue;
        const double x = at->low[0] + (from->line % at->columns[0] + 0.5) * at->edge;
        const double z = at->low[1] + (double)(from->line / at->columns[0]) * at->edge;
        pieces[count++] = (struct piece){x, from->y, z + 0.5 * at->edge, to->y - from->y};
    }
    return count;
}

static void corners_of(const struct kiln_mesh *mesh, double (*vertices)[3], uint32_t triangle,
                       double v[3][3])
{
    for (int k = 0; k < 3; k++)
        memcpy(v[k], vertices[mesh->triangles[triangle][k]], sizeof v[k]);
}

static void find_lattice(const struct kiln_mesh *mesh, double (*vertices)[3], uint32_t columns,
                         struct lattice *at)
{
    double high[2];
    for (size_t k = 0; k < 2; k++) {
        at->low[k] = high[k] = vertices[0][2 * k];
        for (uint32_t i = 1; i < mesh->vertex_count; i++) {
            at->low[k] = fmin(at->low[k], vertices[i][2 * k]);
            high[k] = fmax(high[k], vertices[i][2 * k]);
        }
    }
    at->edge = fmax(high[0] - at->low[0], high[1] - at->low[1]) / columns;
    for (int k = 0; k < 2; k++) {
        const double fit = at->edge > 0 ? ceil((high[k] - at->low[k]) / at->edge - 1e-6) : 1;
        at->columns[k] = fit > 1 ? (uint32_t)fit : 1;
    }
}

/* Finds a lattice for a mesh. It has fewer columns for a mesh of very many triangles that cover
 * each other, which would take long to cut. Returns false where even the fewest are too many. */
static bool choose_lattice(const struct kiln_mesh *mesh, double (*vertices)[3], struct lattice *at)
{
    uint64_t cuts = MOST_CUTS + 1;
    for (uint32_t columns = MOST_COLUMNS; columns >= LEAST_COLUMNS && cuts > MOST_CUTS;
         columns /= 2) {
        find_lattice(mesh, vertices, columns, at);
        cuts = 0;
        for (uint32_t i = 0; i < mesh->triangle_count && at->edge > 0; i++) {
            uint32_t first[2], last[2];
            double v[3][3];
            corners_of(mesh, vertices, i, v);
            find_lines(at, (const double(*)[3])v, first, last);
            cuts += (uint64_t)(last[0] - first[0] + 1) * (last[1] - first[1] + 1);
        }
    }
    return cuts <= MOST_CUTS;
}

/* Writes the words of the pieces, chosen by their lengths. */
static bool write_pieces(struct kiln_arena *arena, const struct piece *pieces,
                         struct kiln_source *source)
{
    const uint32_t count = source->cells;
    double *lengths = malloc(count * sizeof *lengths);
    struct kiln_alias *table = malloc(count * sizeof *table);
    source->words_of_cell = SOURCE_COLUMN_WORDS;
    source->word_count = count * SOURCE_COLUMN_WORDS;
    source->words = kiln_arena_alloc(arena, source->word_count, sizeof *source->words);
    bool ok = lengths && table && source->words;
    for (uint32_t i = 0; ok && i < count; i++)
        lengths[i] = pieces[i].length;
    ok = ok && kiln_alias_fill(lengths, count, table);
    for (uint32_t i = 0; ok && i < count; i++) {
        const struct piece *p = &pieces[i];
        source->words[2 * (size_t)i] = FLOAT4(exact_canon((float)p->x), exact_canon((float)p->y),
                                              exact_canon((float)p->z), table[i].share);
        source->words[2 * (size_t)i + 1] =
            FLOAT4(exact_canon((float)p->length), (float)table[i].other, 0.0f, 0.0f);
    }
    free(lengths);
    free(table);
    return ok;
}

bool kiln_source_fill_volume(struct kiln_arena *arena, const struct kiln_mesh *mesh,
                             const float rotation[3][3], float scale, struct kiln_source *source,
                             float *edge, bool *fits)
{
    double(*vertices)[3] = malloc(mesh->vertex_count * sizeof *vertices);
    struct crossings all = {.items = NULL};
    struct lattice lattice;
    bool ok = vertices != NULL;
    for (uint32_t i = 0; ok && i < mesh->vertex_count; i++) {
        float placed[3];
        kiln_source_place(mesh->vertices[i], rotation, scale, placed);
        for (int c = 0; c < 3; c++)
            vertices[i][c] = (double)placed[c];
    }
    *fits = !ok || choose_lattice(mesh, vertices, &lattice);
    ok = ok && *fits;
    for (uint32_t i = 0; ok && lattice.edge > 0 && i < mesh->triangle_count; i++) {
        double v[3][3];
        corners_of(mesh, vertices, i, v);
        ok = cut(&lattice, (const double(*)[3])v, &all);
    }
    if (ok && all.count > 0)
        qsort(all.items, all.count, sizeof *all.items, by_line);
    struct piece *pieces = ok ? malloc((all.count + 1) * sizeof *pieces) : NULL;
    ok = ok && pieces;
    memcpy(source->hash, mesh->hash, sizeof source->hash);
    if (ok) {
        source->cells = find_pieces(&lattice, &all, pieces);
        *edge = (float)lattice.edge;
        ok = source->cells == 0 || write_pieces(arena, pieces, source);
    }
    source->making = mesh->vertex_count * sizeof *vertices + all.room * sizeof *all.items +
                     (all.count + 1) * sizeof *pieces + (uint64_t)source->cells * KILN_ALIAS_BYTES;
    free(pieces);
    free(all.items);
    free(vertices);
    return ok;
}
