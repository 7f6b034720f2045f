/* This file puts triangles that move during a step into a lattice of cells, and keeps in each cell
 * the most important triangle that touches it (Drone 2007, 7.5.2.3).
 *
 * A triangle touches a cell unless they do not overlap along some axis (the separating axis test).
 * The axes are the box's edges, the triangle's normal, and the cross products of their edges. For a
 * triangle that moves they are taken at both ends of the step, and all six corners must lie on one
 * side. In a row of cells along x each axis leaves an interval of cells.
 *
 * Threads share out the layers in slabs. Each looks at all triangles, and the order of triangles in
 * a cell is total, so the result does not depend on the threads. */
#include "sim/world/voxels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "shared/exact.h"
#include "sim/world/voxel_plane.h"

enum {
    UNIT_BITS = 10, /* corners are rounded to this power of two of a cell */
    UNITS = 1 << UNIT_BITS,
    MARGIN = 2,         /* units by which cells are enlarged on every side */
    SLAB_LAYERS = 2,    /* layers of one piece of work */
    TRIANGLES = 512,    /* triangles of one piece of work */
    MOST_AXES = 20,     /* separating axes of a triangle at two times */
    MOST_CLEARANCE = 7, /* in cells */
};

/* A triangle that touches a cell, and its rank there; a cell keeps the triangle of lowest order. */
struct claim {
    uint32_t order;
    uint32_t triangle;
};
static const uint32_t NOBODY = UINT32_MAX;

struct kiln_voxels_scratch {
    int32_t (*before)[3], (*after)[3]; /* vertices in units from the origin */
    uint8_t (*layers)[2];              /* first and last layer of each triangle; 1, 0: in none */
    size_t vertex_capacity, triangle_capacity, cell_capacity, plane_capacity;
    struct claim *claims; /* one a cell */
    uint8_t *near;        /* one a cell: 1 where a plane is near */
    uint8_t *nearer;
    /* number of planes before each slab */
    uint32_t slab_planes[KILN_MAX_VOXEL_EDGE / SLAB_LAYERS + 1];
};

struct work {
    struct kiln_voxels *voxels;
    const struct kiln_voxels_input *in;
    int32_t heading[3]; /* heading as integers, 1024 long */
    _Atomic uint64_t visits;
};

/* ---- the lattice ----------------------------------------------------------------------------- */

static void bound(const struct kiln_voxels_input *in, double low[3], double high[3])
{
    for (int c = 0; c < 3; c++) {
        low[c] = high[c] = (double)in->before[0][c];
        for (uint32_t i = 0; i < in->vertex_count; i++) {
            const double a = (double)in->before[i][c], b = (double)in->after[i][c];
            const double less = a < b ? a : b, more = a < b ? b : a;
            low[c] = less < low[c] ? less : low[c];
            high[c] = more > high[c] ? more : high[c];
        }
    }
}

/* Places the lattice around the triangles. It starts a whole number of cells from the world's
 * origin, so that the cells stay in place while a mesh moves through them. */
static void place_lattice(struct kiln_voxels *v, const struct kiln_voxels_input *in)
{
    double low[3], high[3];
    bound(in, low, high);
    double spacing = 0.5 * (double)in->spacing, cells, longest;
    do {
        spacing *= 2;
        cells = 1;
        longest = 0;
        for (int c = 0; c < 3; c++) {
            const double first = floor(low[c] / spacing) - 1, last = floor(high[c] / spacing) + 1;
            const double count = last - first + 1;
            cells *= count;
            longest = count > longest ? count : longest;
            v->origin[c] = exact_canon((float)(first * spacing));
            v->size[c] = count < 1e9 ? (uint32_t)count : 0;
        }
    } while (longest > KILN_MAX_VOXEL_EDGE || cells > KILN_MAX_VOXEL_CELLS);
    v->spacing = (float)spacing;
    v->per_metre = 1.0f / v->spacing;
}

static size_t cell_count(const struct kiln_voxels *v)
{
    return (size_t)v->size[0] * v->size[1] * v->size[2];
}

/* ---- memory ---------------------------------------------------------------------------------- */

static bool grow(void **block, size_t count, size_t each, struct kiln_error *error)
{
    free(*block);
    *block = calloc(count, each);
    if (!*block)
        return kiln_error_no_memory(error, "%zu times %zu bytes of a volume", count, each);
    return true;
}

static bool reserve(struct kiln_voxels *v, const struct kiln_voxels_input *in,
                    struct kiln_error *error)
{
    if (!v->scratch)
        v->scratch = calloc(1, sizeof *v->scratch);
    if (!v->scratch)
        return kiln_error_no_memory(error, "the volume");
    struct kiln_voxels_scratch *s = v->scratch;
    if (s->vertex_capacity < in->vertex_count) {
        s->vertex_capacity = in->vertex_count;
        if (!grow((void **)&s->before, in->vertex_count, sizeof *s->before, error) ||
            !grow((void **)&s->after, in->vertex_count, sizeof *s->after, error))
            return false;
    }
    if (s->triangle_capacity < in->triangle_count) {
        s->triangle_capacity = in->triangle_count;
        if (!grow((void **)&s->layers, in->triangle_count, sizeof *s->layers, error))
            return false;
    }
    const size_t cells = cell_count(v);
    if (s->cell_capacity < cells) {
        s->cell_capacity = cells;
        return grow((void **)&s->claims, cells, sizeof *s->claims, error) &&
               grow((void **)&s->near, cells, 1, error) &&
               grow((void **)&s->nearer, cells, 1, error) &&
               grow((void **)&v->marks, cells, sizeof *v->marks, error);
    }
    return true;
}

static bool reserve_planes(struct kiln_voxels *v, struct kiln_error *error)
{
    struct kiln_voxels_scratch *s = v->scratch;
    if (s->plane_capacity >= v->plane_count)
        return true;
    s->plane_capacity = (size_t)v->plane_count + v->plane_count / 2;
    return grow((void **)&v->planes, s->plane_capacity, sizeof *v->planes, error);
}

void kiln_voxels_footprint(uint64_t vertices, uint64_t triangles, uint64_t cells, uint64_t planes,
                           struct kiln_footprint *footprint)
{
    const struct kiln_voxels_scratch *s = NULL;
    const struct kiln_voxels *v = NULL;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, vertices,
                       sizeof *s->before + sizeof *s->after);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, triangles, sizeof *s->layers);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, cells,
                       sizeof *s->claims + sizeof *s->near + sizeof *s->nearer + sizeof *v->marks);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, planes + planes / 2, sizeof *v->planes);
}

void kiln_voxels_finish(struct kiln_voxels *voxels)
{
    struct kiln_voxels_scratch *s = voxels->scratch;
    if (s) {
        free(s->before);
        free(s->after);
        free(s->layers);
        free(s->claims);
        free(s->near);
        free(s->nearer);
        free(s);
    }
    free(voxels->marks);
    free(voxels->planes);
    *voxels = (struct kiln_voxels){.plane_count = 0};
}

/* ---- corners --------------------------------------------------------------------------------- */

static void round_corner(const struct kiln_voxels *v, const float metres[3], int32_t units[3])
{
    for (int c = 0; c < 3; c++) {
        const double cells =
            ((double)metres[c] - (double)v->origin[c]) * (double)v->per_metre * UNITS;
        const double most = (double)v->size[c] * UNITS;
        const double inside = cells < 0 ? 0 : cells > most ? most : cells;
        units[c] = (int32_t)(inside + 0.5);
    }
}

static void round_corners(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    const struct kiln_voxels_scratch *s = work->voxels->scratch;
    for (size_t i = begin; i < end; i++) {
        round_corner(work->voxels, work->in->before[i], s->before[i]);
        round_corner(work->voxels, work->in->after[i], s->after[i]);
    }
}

/* ---- cells of a triangle --------------------------------------------------------------------- */

struct axis {
    int64_t x, y, z;   /* axis, with x at least 0 */
    int64_t low, high; /* a cell overlaps if its middle projects between these */
};

struct sweep {
    int32_t corners[6][3]; /* corners at the end, then at the start of the step */
    uint32_t corner_count; /* 3 if the triangle does not move */
    int64_t normal[3];     /* normal at the end, twice the area long */
    int32_t first[3], last[3];
    struct axis axes[MOST_AXES];
    uint32_t axis_count;
};

static void find_normal(const int32_t (*p)[3], int64_t normal[3])
{
    for (int c = 0; c < 3; c++) {
        const int u = (c + 1) % 3, w = (c + 2) % 3;
        normal[c] = (int64_t)(p[1][u] - p[0][u]) * (p[2][w] - p[0][w]) -
                    (int64_t)(p[1][w] - p[0][w]) * (p[2][u] - p[0][u]);
    }
}

static void find_corners(struct sweep *t, const struct work *work, uint32_t triangle)
{
    const struct kiln_voxels_scratch *s = work->voxels->scratch;
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = work->in->triangles[triangle][k];
        memcpy(t->corners[k], s->after[vertex], sizeof t->corners[k]);
        memcpy(t->corners[3 + k], s->before[vertex], sizeof t->corners[k]);
    }
    const bool moves = memcmp(t->corners, t->corners + 3, 3 * sizeof t->corners[0]) != 0;
    t->corner_count = moves ? 6 : 3;
}

/* Finds the range of cells around the triangle and its way through the step. */
static void find_range(struct sweep *t, const uint32_t size[3])
{
    for (int c = 0; c < 3; c++) {
        int32_t low = t->corners[0][c], high = low;
        for (uint32_t k = 1; k < t->corner_count; k++) {
            low = t->corners[k][c] < low ? t->corners[k][c] : low;
            high = t->corners[k][c] > high ? t->corners[k][c] : high;
        }
        low = low > MARGIN ? low - MARGIN : 0;
        t->first[c] = low >> UNIT_BITS;
        const int32_t last = (high + MARGIN) >> UNIT_BITS;
        t->last[c] = last < (int32_t)size[c] ? last : (int32_t)size[c] - 1;
    }
}

static void add_axis(struct sweep *t, int64_t x, int64_t y, int64_t z)
{
    if (x == 0 && y == 0 && z == 0)
        return;
    const int64_t sign = x < 0 ? -1 : 1;
    struct axis *axis = &t->axes[t->axis_count++];
    *axis = (struct axis){.x = sign * x, .y = sign * y, .z = sign * z};
    for (uint32_t k = 0; k < t->corner_count; k++) {
        const int32_t *p = t->corners[k];
        const int64_t at = axis->x * p[0] + axis->y * p[1] + axis->z * p[2];
        axis->low = k == 0 || at < axis->low ? at : axis->low;
        axis->high = k == 0 || at > axis->high ? at : axis->high;
    }
    const int64_t reach =
        (axis->x + llabs(axis->y) + llabs(axis->z)) * (int64_t)(UNITS / 2 + MARGIN);
    axis->low -= reach;
    axis->high += reach;
}

static void add_axes(struct sweep *t, const int32_t (*p)[3])
{
    int64_t normal[3];
    find_normal(p, normal);
    add_axis(t, normal[0], normal[1], normal[2]);
    for (int k = 0; k < 3; k++) {
        const int32_t *a = p[k], *b = p[(k + 1) % 3];
        const int64_t x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
        add_axis(t, 0, z, -y);
        add_axis(t, -z, 0, x);
        add_axis(t, y, -x, 0);
    }
}

static int64_t floor_div(int64_t a, int64_t b)
{
    const int64_t q = a / b;
    return q * b > a ? q - 1 : q;
}

/* Narrows the cells first to last, in a row along x, to those that no axis separates from the
 * triangle. False: no cell remains. */
static bool find_row(const struct sweep *t, int32_t y, int32_t z, int32_t *first, int32_t *last)
{
    const int64_t middle_y = (int64_t)y * UNITS + UNITS / 2;
    const int64_t middle_z = (int64_t)z * UNITS + UNITS / 2;
    for (uint32_t i = 0; i < t->axis_count; i++) {
        const struct axis *axis = &t->axes[i];
        const int64_t at = axis->y * middle_y + axis->z * middle_z + axis->x * (UNITS / 2);
        const int64_t low = axis->low - at, high = axis->high - at, cell = axis->x * UNITS;
        if (cell * *first < low) {
            if (cell == 0)
                return false;
            *first = (int32_t)floor_div(low - 1, cell) + 1;
        }
        if (cell * *last > high) {
            if (cell == 0)
                return false;
            *last = (int32_t)floor_div(high, cell);
        }
        if (*first > *last)
            return false;
    }
    return true;
}

static void find_layers(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct work *work = context;
    struct sweep t;
    uint64_t visits = 0;
    for (size_t i = begin; i < end; i++) {
        uint8_t *layers = work->voxels->scratch->layers[i];
        find_corners(&t, work, (uint32_t)i);
        find_normal((const int32_t(*)[3])t.corners, t.normal);
        find_range(&t, work->voxels->size);
        const bool flat = t.normal[0] == 0 && t.normal[1] == 0 && t.normal[2] == 0;
        layers[0] = flat ? 1 : (uint8_t)t.first[2];
        layers[1] = flat ? 0 : (uint8_t)t.last[2];
        uint64_t cells = flat ? 0 : 1;
        for (int c = 0; c < 3; c++)
            cells *= (uint64_t)(t.last[c] - t.first[c] + 1);
        visits += cells;
    }
    work->visits += visits;
}

/* ---- rank of a triangle in a cell (Drone 2007, 7.5.2.3) -------------------------------------- */

/* The values by which triangles are ranked, in the units of their normals. */
struct rank {
    int64_t facing;  /* component of the normal along the heading */
    int64_t at;      /* distance of the plane from the origin along the normal */
    uint32_t before; /* its class, which is compared first; lower is better */
};

enum { RANK_BITS = 24 };

static struct rank find_rank(const struct sweep *t, const struct work *work)
{
    const int64_t *n = t->normal;
    const int32_t *h = work->heading, *p = t->corners[0];
    struct rank rank = {.facing = (n[0] * h[0] + n[1] * h[1] + n[2] * h[2]) / UNITS,
                        .at = n[0] * p[0] + n[1] * p[1] + n[2] * p[2],
                        .before = 1};
    if (rank.facing != 0)
        rank.before = rank.facing < 0 || work->in->two_sided ? 0 : 2;
    return rank;
}

/* Returns whether the line along the heading through the middle of a cell meets the triangle inside
 * the cell, `depth` units from the middle. It meets the triangle if it is on the same side of all
 * edges. */
static bool meets_line(const struct sweep *t, const int32_t heading[3], const int64_t middle[3],
                       int64_t depth)
{
    bool left = true, right = true, within = true;
    for (int k = 0; k < 3; k++) {
        const int32_t *a = t->corners[k], *b = t->corners[(k + 1) % 3];
        int64_t side = 0;
        for (int c = 0; c < 3; c++) {
            const int u = (c + 1) % 3, w = (c + 2) % 3;
            const int64_t across =
                (int64_t)(b[u] - a[u]) * heading[w] - (int64_t)(b[w] - a[w]) * heading[u];
            side += across * (middle[c] - a[c]);
        }
        left = left && side >= 0;
        right = right && side <= 0;
    }
    for (int c = 0; c < 3; c++)
        within = within && llabs(depth * heading[c] / UNITS) <= UNITS / 2 + MARGIN;
    return (left || right) && within;
}

/* Returns the order of a triangle in a cell: its class, whether the line along the heading meets it
 * there, then how far along the heading its plane is from the middle of the cell, in units. */
static uint32_t order_in(const struct sweep *t, const struct rank *rank, const int32_t heading[3],
                         int32_t x, int32_t y, int32_t z)
{
    const int64_t *n = t->normal, most = (1 << (RANK_BITS - 1)) - 1;
    const int64_t middle[3] = {(int64_t)x * UNITS + UNITS / 2, (int64_t)y * UNITS + UNITS / 2,
                               (int64_t)z * UNITS + UNITS / 2};
    int64_t depth = 0;
    bool met = false;
    if (rank->facing != 0) {
        depth = (rank->at - n[0] * middle[0] - n[1] * middle[1] - n[2] * middle[2]) / rank->facing;
        depth = depth > most ? most : depth < -most ? -most : depth;
        met = meets_line(t, heading, middle, depth);
    }
    return ((2 * rank->before + (met ? 0 : 1)) << RANK_BITS) + (uint32_t)(depth + most);
}

static void claim_cells(const struct work *work, const struct sweep *t, uint32_t triangle,
                        int32_t first_z, int32_t last_z)
{
    const struct kiln_voxels *v = work->voxels;
    const struct rank rank = find_rank(t, work);
    for (int32_t z = first_z; z <= last_z; z++) {
        for (int32_t y = t->first[1]; y <= t->last[1]; y++) {
            int32_t first = t->first[0], last = t->last[0];
            if (!find_row(t, y, z, &first, &last))
                continue;
            struct claim *row =
                v->scratch->claims + ((size_t)z * v->size[1] + (size_t)y) * v->size[0];
            for (int32_t x = first; x <= last; x++) {
                const uint32_t order = order_in(t, &rank, work->heading, x, y, z);
                /* Triangles come in ascending order of their numbers; among equal ranks the first
                 * stays. */
                if (row[x].triangle == NOBODY || order < row[x].order)
                    row[x] = (struct claim){order, triangle};
            }
        }
    }
}

static void claim_slabs(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    const struct kiln_voxels *v = work->voxels;
    const size_t layer = (size_t)v->size[0] * v->size[1];
    for (size_t slab = begin; slab < end; slab++) {
        const int32_t first_z = (int32_t)slab * SLAB_LAYERS, most = (int32_t)v->size[2] - 1;
        const int32_t last_z = first_z + SLAB_LAYERS - 1 < most ? first_z + SLAB_LAYERS - 1 : most;
        struct claim *claims = v->scratch->claims + (size_t)first_z * layer;
        const size_t count = (size_t)(last_z - first_z + 1) * layer;
        memset(claims, 0xff, count * sizeof *claims);
        for (uint32_t i = 0; i < work->in->triangle_count; i++) {
            const uint8_t *layers = v->scratch->layers[i];
            if (layers[0] > layers[1] || layers[0] > last_z || layers[1] < first_z)
                continue;
            struct sweep t = {.axis_count = 0};
            find_corners(&t, work, i);
            find_normal((const int32_t(*)[3])t.corners, t.normal);
            find_range(&t, v->size);
            if (memcmp(t.first, t.last, sizeof t.first) != 0) /* otherwise the triangle is in one
                                                               * cell */
                add_axes(&t, (const int32_t(*)[3])t.corners);
            if (t.axis_count > 0 && t.corner_count > 3)
                add_axes(&t, (const int32_t(*)[3])t.corners + 3);
            claim_cells(work, &t, i, t.first[2] > first_z ? t.first[2] : first_z,
                        t.last[2] < last_z ? t.last[2] : last_z);
        }
        uint32_t planes = 0;
        for (size_t i = 0; i < count; i++)
            planes += claims[i].triangle != NOBODY;
        v->scratch->slab_planes[slab + 1] = planes;
    }
}

/* ---- planes ---------------------------------------------------------------------------------- */

static void fill_slabs(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    struct kiln_voxels *v = work->voxels;
    for (size_t slab = begin; slab < end; slab++) {
        uint32_t number = v->scratch->slab_planes[slab];
        size_t i = slab * SLAB_LAYERS * v->size[1] * v->size[0];
        const size_t last_z = (slab + 1) * SLAB_LAYERS;
        for (size_t z = slab * SLAB_LAYERS; z < last_z && z < v->size[2]; z++) {
            for (size_t y = 0; y < v->size[1]; y++) {
                for (size_t x = 0; x < v->size[0]; x++, i++) {
                    const uint32_t triangle = v->scratch->claims[i].triangle;
                    v->scratch->near[i] = triangle != NOBODY;
                    v->marks[i] = 0.0f;
                    if (triangle == NOBODY)
                        continue;
                    const double at[3] = {(double)x + 0.5, (double)y + 0.5, (double)z + 0.5};
                    double middle[3];
                    for (int c = 0; c < 3; c++)
                        middle[c] = (double)v->origin[c] + at[c] * (double)v->spacing;
                    v->planes[number] = kiln_voxel_plane(work->in, triangle, middle);
                    v->marks[i] = (float)++number;
                }
            }
        }
    }
}

/* ---- distance to the next plane -------------------------------------------------------------- */

/* Sets each element of `to` if it or a neighbour is set in `from`: the elements `apart` before and
 * after it, in rows of `row` elements. */
static void spread(uint8_t *restrict to, const uint8_t *restrict from, size_t count, size_t apart,
                   size_t row)
{
    for (size_t start = 0; start < count; start += row) {
        const uint8_t *a = from + start;
        uint8_t *b = to + start;
        memcpy(b, a, row);
        for (size_t i = apart; i < row; i++)
            b[i] |= a[i - apart];
        for (size_t i = 0; i + apart < row; i++)
            b[i] |= a[i + apart];
    }
}

static void find_clearance(struct kiln_voxels *v)
{
    const size_t count = cell_count(v), row = v->size[0], layer = row * v->size[1];
    uint8_t *near = v->scratch->near, *other = v->scratch->nearer;
    for (int distance = 1; distance <= MOST_CLEARANCE; distance++) {
        spread(other, near, count, 1, row);
        spread(near, other, count, row, layer);
        spread(other, near, count, layer, count);
        for (size_t i = 0; i < count; i++)
            v->marks[i] -= other[i] ? 0.0f : 1.0f;
        uint8_t *swap = near;
        near = other;
        other = swap;
    }
}

/* ---- building -------------------------------------------------------------------------------- */

bool kiln_voxels_build(struct kiln_voxels *voxels, const struct kiln_voxels_input *input,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_voxels *v = voxels;
    const float3 h = input->heading;
    struct work work = {.voxels = v,
                        .in = input,
                        .heading = {(int32_t)FLOOR(h.x * UNITS + 0.5f),
                                    (int32_t)FLOOR(h.y * UNITS + 0.5f),
                                    (int32_t)FLOOR(h.z * UNITS + 0.5f)}};
    place_lattice(v, input);
    if (!reserve(v, input, error))
        return false;
    const size_t slabs = (v->size[2] + SLAB_LAYERS - 1) / SLAB_LAYERS;
    kiln_threads_for(threads, input->vertex_count, TRIANGLES, round_corners, &work);
    kiln_threads_for(threads, input->triangle_count, TRIANGLES, find_layers, &work);
    if (work.visits > KILN_MAX_VOXEL_VISITS)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "the %u triangles of a volume lie in %llu cells altogether in a "
                              "step; at most %d are allowed: set fewer cells",
                              input->triangle_count, (unsigned long long)work.visits,
                              KILN_MAX_VOXEL_VISITS);
    kiln_threads_for(threads, slabs, 1, claim_slabs, &work);
    v->scratch->slab_planes[0] = 0;
    for (size_t slab = 0; slab < slabs; slab++)
        v->scratch->slab_planes[slab + 1] += v->scratch->slab_planes[slab];
    v->plane_count = v->scratch->slab_planes[slabs];
    if (!reserve_planes(v, error))
        return false;
    kiln_threads_for(threads, slabs, 1, fill_slabs, &work);
    find_clearance(v);
    return true;
}
