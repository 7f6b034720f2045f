/* This file rasterises the triangles of a mesh in texture space, to find where each texel lies on
 * the mesh. Corners are rounded to 256ths of a texel. From there on integers decide which triangle
 * a texel's centre lies in, and quotients of integers in double where it is on that triangle. An
 * edge that two triangles share belongs to exactly one of them. */
#include "asset/geometry/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

enum {
    SUBTEXELS = 256,
    /* rows of all triangles together; a mesh without overlaps has about as many as its texels */
    MOST_ROWS = 1 << 24,
};

/* Error of a texture coordinate of 0 or 1 that a program wrote rounded. */
static const float SLACK = 1e-5f;

static const float NOWHERE = 1e15f;

/* Holds a texel until blocks are made. */
struct texel {
    float place[3], normal[3];
};

struct making {
    const struct kiln_mesh *mesh;
    const char *name;
    uint32_t edge;
    uint32_t *owners; /* 1 + the triangle of each texel; 0: none */
    struct texel *texels;
    int64_t rows; /* rows of the triangles so far */
};

/* ---- triangles ------------------------------------------------------------------------------- */

/* A triangle in texture space, its corners counterclockwise. */
struct flat {
    int64_t x[3], y[3];
    uint32_t corners[3]; /* vertices of the mesh */
    int64_t area;        /* twice the area */
};

static bool place_corners(const struct making *m, uint32_t number, struct flat *flat,
                          struct kiln_error *error)
{
    const uint32_t *corners = m->mesh->triangles[number];
    for (int k = 0; k < 3; k++) {
        const float *uv = m->mesh->uvs[corners[k]];
        if (!(uv[0] >= -SLACK && uv[0] <= 1.0f + SLACK && uv[1] >= -SLACK &&
              uv[1] <= 1.0f + SLACK)) {
            kiln_error_set(error, KILN_INVALID_INPUT,
                           "%s: triangle %u has a corner at the texture coordinates %g %g; for "
                           "paint, all are from 0 to 1",
                           m->name, number, (double)uv[0], (double)uv[1]);
            return false;
        }
        const double scale = (double)m->edge * SUBTEXELS;
        flat->x[k] = (int64_t)floor((double)uv[0] * scale + 0.5);
        flat->y[k] = (int64_t)floor((double)uv[1] * scale + 0.5);
        flat->corners[k] = corners[k];
    }
    flat->area = (flat->x[1] - flat->x[0]) * (flat->y[2] - flat->y[0]) -
                 (flat->y[1] - flat->y[0]) * (flat->x[2] - flat->x[0]);
    if (flat->area < 0) { /* mirrored: two corners are exchanged */
        const int64_t x = flat->x[1], y = flat->y[1];
        const uint32_t corner = flat->corners[1];
        flat->x[1] = flat->x[2];
        flat->y[1] = flat->y[2];
        flat->corners[1] = flat->corners[2];
        flat->x[2] = x;
        flat->y[2] = y;
        flat->corners[2] = corner;
        flat->area = -flat->area;
    }
    return true;
}

static int64_t floor_of(int64_t a, int64_t b) /* a / b rounded down, b > 0 */
{
    return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/* Finds the rows from .. to in which the triangle may have texels. */
static void find_rows(const struct making *m, const struct flat *flat, int64_t *from, int64_t *to)
{
    int64_t low = flat->y[0], high = flat->y[0];
    for (int k = 1; k < 3; k++) {
        low = flat->y[k] < low ? flat->y[k] : low;
        high = flat->y[k] > high ? flat->y[k] : high;
    }
    const int64_t last = (int64_t)m->edge - 1;
    *from = floor_of(low, SUBTEXELS);
    *to = floor_of(high, SUBTEXELS);
    *from = *from < 0 ? 0 : *from;
    *to = *to > last ? last : *to;
}

/* Returns twice the area between a place and the edge opposite to a corner. */
static int64_t part_of(const struct flat *flat, int corner, int64_t x, int64_t y)
{
    const int a = (corner + 1) % 3, b = (corner + 2) % 3;
    return (flat->x[b] - flat->x[a]) * (y - flat->y[a]) -
           (flat->y[b] - flat->y[a]) * (x - flat->x[a]);
}

/* Finds the columns from .. to of a row whose centres lie inside the triangle. */
static void find_span(const struct flat *flat, int64_t y, int64_t *from, int64_t *to)
{
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const int64_t dx = flat->x[b] - flat->x[a], dy = flat->y[b] - flat->y[a];
        /* A centre on an edge belongs to one of the two triangles that share it. */
        const int64_t least = dy > 0 || (dy == 0 && dx > 0) ? 0 : 1;
        const int64_t room = part_of(flat, k, SUBTEXELS / 2, y) - least;
        int64_t limit;
        if (dy > 0) {
            limit = floor_of(room, dy * SUBTEXELS);
            *to = limit < *to ? limit : *to;
        } else if (dy < 0) {
            limit = -floor_of(room, -dy * SUBTEXELS);
            *from = limit > *from ? limit : *from;
        } else if (room < 0) {
            *to = *from - 1;
        }
    }
}

static void place_texel(const struct making *m, const struct flat *flat, int64_t x, int64_t y,
                        struct texel *texel)
{
    double place[3] = {0.0, 0.0, 0.0}, normal[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        const double part = (double)part_of(flat, k, x, y) / (double)flat->area;
        const float *vertex = m->mesh->vertices[flat->corners[k]];
        for (int c = 0; c < 3; c++) {
            place[c] += part * (double)vertex[c];
            normal[c] += part * (double)vertex[c + 3];
        }
    }
    double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int c = 0; c < 3; c++) {
        texel->place[c] = (float)place[c];
        texel->normal[c] = length > 1e-6 ? (float)(normal[c] / length) : (c == 1 ? 1.0f : 0.0f);
    }
}

static void find_middle(const struct kiln_mesh *mesh, uint32_t triangle, double middle[3])
{
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.0;
        for (int k = 0; k < 3; k++)
            middle[c] += (double)mesh->vertices[mesh->triangles[triangle][k]][c] / 3.0;
    }
}

static void refuse_overlap(const struct making *m, uint32_t a, uint32_t b, size_t texel,
                           struct kiln_error *error)
{
    double at[3], other[3];
    find_middle(m->mesh, a, at);
    find_middle(m->mesh, b, other);
    kiln_error_set(
        error, KILN_INVALID_INPUT,
        "%s: the triangles %u (around %.4g %.4g %.4g) and %u (around %.4g %.4g %.4g) both lie at "
        "the texture coordinates %.4g %.4g; for paint, triangles must not overlap there",
        m->name, a, at[0], at[1], at[2], b, other[0], other[1], other[2],
        ((double)(texel % m->edge) + 0.5) / m->edge, ((double)(texel / m->edge) + 0.5) / m->edge);
}

static bool add_triangle(struct making *m, uint32_t number, struct kiln_error *error)
{
    struct flat flat;
    if (!place_corners(m, number, &flat, error))
        return false;
    if (flat.area == 0)
        return true;
    const int64_t last = (int64_t)m->edge - 1;
    int64_t row, end;
    find_rows(m, &flat, &row, &end);
    m->rows += row <= end ? end - row + 1 : 0;
    if (m->rows > MOST_ROWS) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the triangles lie in more than %d rows of texels altogether; for "
                       "paint, unwrap the mesh into less narrow triangles, or set a smaller size",
                       m->name, MOST_ROWS);
        return false;
    }
    for (; row <= end; row++) {
        const int64_t y = row * SUBTEXELS + SUBTEXELS / 2;
        int64_t from = 0, to = last;
        find_span(&flat, y, &from, &to);
        for (int64_t column = from; column <= to; column++) {
            const size_t i = (size_t)row * m->edge + (size_t)column;
            if (m->owners[i] != 0) {
                refuse_overlap(m, m->owners[i] - 1, number, i, error);
                return false;
            }
            m->owners[i] = number + 1;
            place_texel(m, &flat, column * SUBTEXELS + SUBTEXELS / 2, y, &m->texels[i]);
        }
    }
    return true;
}

/* ---- the border ------------------------------------------------------------------------------ */

/* Finds a neighbour that has an owner in an earlier ring; neighbours across an edge come first. */
static bool find_neighbour(const struct making *m, const uint8_t *on, uint32_t x, uint32_t y,
                           size_t *neighbour)
{
    static const int32_t ways[8][2] = {{-1, 0},  {1, 0},  {0, -1}, {0, 1},
                                       {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const int32_t edge = (int32_t)m->edge;
    for (int k = 0; k < 8; k++) {
        const int32_t column = (int32_t)x + ways[k][0], row = (int32_t)y + ways[k][1];
        if (column < 0 || row < 0 || column >= edge || row >= edge)
            continue;
        *neighbour = (size_t)row * m->edge + (size_t)column;
        if (on[*neighbour])
            return true;
    }
    return false;
}

/* Gives texels beside a triangle the places of their neighbours in it, so that filtering across a
 * seam finds the same paint. */
static void add_border(struct making *m, uint8_t *on, uint8_t *ring)
{
    const size_t count = (size_t)m->edge * m->edge;
    for (size_t i = 0; i < count; i++)
        on[i] = m->owners[i] != 0;
    for (int n = 0; n < KILN_CHART_BORDER; n++) {
        memset(ring, 0, count);
        for (uint32_t y = 0; y < m->edge; y++) {
            for (uint32_t x = 0; x < m->edge; x++) {
                const size_t i = (size_t)y * m->edge + x;
                size_t neighbour;
                if (!on[i] && find_neighbour(m, on, x, y, &neighbour)) {
                    m->texels[i] = m->texels[neighbour];
                    ring[i] = 1;
                }
            }
        }
        for (size_t i = 0; i < count; i++)
            on[i] |= ring[i];
    }
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/* Maps floats to integers that sort as their values do. */
static uint32_t ordered(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

static uint64_t middle_of(uint64_t a, uint64_t b, uint64_t c)
{
    const uint64_t low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

/* Brings the least `count` of distinct keys to the front. */
static void select_least(uint64_t *keys, size_t size, size_t count)
{
    size_t first = 0, end = size; /* keys outside of first to end are already in place */
    while (end - first > 1) {
        const uint64_t pivot =
            middle_of(keys[first], keys[first + (end - first) / 2], keys[end - 1]);
        size_t i = first, k = end - 1;
        while (i <= k) {
            while (keys[i] < pivot)
                i++;
            while (keys[k] > pivot)
                k--;
            if (i > k)
                break;
            const uint64_t swapped = keys[i];
            keys[i++] = keys[k];
            keys[k] = swapped;
            if (k == 0)
                break;
            k--;
        }
        if (count <= k)
            end = k + 1;
        else if (count >= i)
            first = i;
        else
            return;
    }
}

/* Halves the texels across their longer side until they are blocks, which are then small in space.
 * The lower half of a key is the texel, the upper half is scratch. */
static void sort_texels(const struct making *m, uint64_t *keys, size_t count)
{
    while (count > KILN_CHART_BLOCK) {
        float low[3] = {0}, high[3] = {0};
        for (size_t i = 0; i < count; i++) {
            const float *place = m->texels[(uint32_t)keys[i]].place;
            for (int c = 0; c < 3; c++) {
                low[c] = i == 0 || place[c] < low[c] ? place[c] : low[c];
                high[c] = i == 0 || place[c] > high[c] ? place[c] : high[c];
            }
        }
        int axis = high[1] - low[1] > high[0] - low[0] ? 1 : 0;
        axis = high[2] - low[2] > high[axis] - low[axis] ? 2 : axis;
        for (size_t i = 0; i < count; i++) {
            const uint32_t texel = (uint32_t)keys[i];
            keys[i] = (uint64_t)ordered(m->texels[texel].place[axis]) << 32 | texel;
        }
        const size_t blocks = (count + KILN_CHART_BLOCK - 1) / KILN_CHART_BLOCK;
        const size_t half = blocks / 2 * KILN_CHART_BLOCK; /* all blocks but the last are full */
        select_least(keys, count, half);
        sort_texels(m, keys, half);
        keys += half;
        count -= half;
    }
}

static bool allocate(struct kiln_chart *chart)
{
    const size_t count = (size_t)chart->block_count * KILN_CHART_BLOCK;
    bool ok = true;
    chart->texels = malloc(count * sizeof *chart->texels);
    for (int c = 0; c < 3; c++) {
        chart->place[c] = malloc(count * sizeof(float));
        chart->normal[c] = malloc(count * sizeof(float));
        ok = ok && chart->place[c] && chart->normal[c];
    }
    chart->low = malloc(chart->block_count * sizeof *chart->low);
    chart->high = malloc(chart->block_count * sizeof *chart->high);
    return ok && chart->texels && chart->low && chart->high;
}

static void fill_texel(const struct making *m, struct kiln_chart *chart, size_t i, uint32_t texel)
{
    chart->texels[i] = texel;
    for (int c = 0; c < 3; c++) {
        chart->place[c][i] = m->texels[texel].place[c];
        chart->normal[c][i] = m->texels[texel].normal[c];
    }
}

static void fill_nowhere(struct kiln_chart *chart, size_t i)
{
    chart->texels[i] = KILN_CHART_NOWHERE;
    for (int c = 0; c < 3; c++) {
        chart->place[c][i] = NOWHERE;
        chart->normal[c][i] = 0.0f;
    }
}

/* Finds the bounds of a block's texels, which are `first` and those after it. */
static void bound(struct kiln_chart *chart, uint32_t block, size_t first, size_t end)
{
    for (int c = 0; c < 3; c++) {
        const float *place = chart->place[c];
        float low = place[first], high = place[first];
        for (size_t i = first + 1; i < end; i++) {
            low = place[i] < low ? place[i] : low;
            high = place[i] > high ? place[i] : high;
        }
        chart->low[block][c] = low;
        chart->high[block][c] = high;
        chart->min[c] = block == 0 || low < chart->min[c] ? low : chart->min[c];
        chart->max[c] = block == 0 || high > chart->max[c] ? high : chart->max[c];
    }
}

static void fill_blocks(const struct making *m, struct kiln_chart *chart, const uint64_t *keys)
{
    for (uint32_t block = 0; block < chart->block_count; block++) {
        const size_t first = (size_t)block * KILN_CHART_BLOCK, full = first + KILN_CHART_BLOCK;
        const size_t end = full < chart->count ? full : chart->count;
        for (size_t i = first; i < end; i++)
            fill_texel(m, chart, i, (uint32_t)keys[i]);
        for (size_t i = end; i < full; i++)
            fill_nowhere(chart, i);
        bound(chart, block, first, end);
    }
}

static bool fill(const struct making *m, struct kiln_chart *chart, struct kiln_error *error)
{
    for (size_t i = 0; i < (size_t)m->edge * m->edge; i++)
        chart->count += chart->on[i];
    if (chart->count == 0) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: no triangle has a texel in it by its texture coordinates, with "
                       "%u texels along an edge",
                       m->name, m->edge);
        return false;
    }
    chart->block_count = (chart->count + KILN_CHART_BLOCK - 1) / KILN_CHART_BLOCK;
    uint64_t *keys = calloc(chart->count, sizeof *keys);
    if (!keys || !allocate(chart)) {
        free(keys);
        kiln_error_no_memory(error, "the paint of %s", m->name);
        return false;
    }
    size_t found = 0;
    for (size_t i = 0; i < (size_t)m->edge * m->edge; i++) {
        if (chart->on[i])
            keys[found++] = i;
    }
    sort_texels(m, keys, found);
    fill_blocks(m, chart, keys);
    free(keys);
    return true;
}

/* ---- making the chart ------------------------------------------------------------------------ */

static bool make(struct making *m, struct kiln_chart *chart, struct kiln_error *error)
{
    const size_t count = (size_t)m->edge * m->edge;
    chart->on = calloc(count, 1);
    uint8_t *ring = malloc(count);
    bool ok = m->owners && m->texels && chart->on && ring;
    if (!ok)
        kiln_error_no_memory(error, "the paint of %s", m->name);
    for (uint32_t i = 0; ok && i < m->mesh->triangle_count; i++)
        ok = add_triangle(m, i, error);
    if (ok)
        add_border(m, chart->on, ring);
    free(ring);
    return ok && fill(m, chart, error);
}

struct kiln_chart *kiln_chart_create(const struct kiln_mesh *mesh, uint32_t edge, const char *name,
                                     struct kiln_error *error)
{
    struct kiln_chart *chart = calloc(1, sizeof *chart);
    if (!chart) {
        kiln_error_no_memory(error, "the paint of %s", name);
        return NULL;
    }
    const size_t count = (size_t)edge * edge;
    chart->edge = edge;
    struct making making = {.mesh = mesh,
                            .name = name,
                            .edge = edge,
                            .owners = calloc(count, sizeof *making.owners),
                            .texels = malloc(count * sizeof *making.texels)};
    if (!make(&making, chart, error))
        kiln_chart_destroy(&chart);
    free(making.owners);
    free(making.texels);
    return chart;
}

void kiln_chart_destroy(struct kiln_chart **chart)
{
    struct kiln_chart *c = *chart;
    if (!c)
        return;
    free(c->texels);
    for (int k = 0; k < 3; k++) {
        free(c->place[k]);
        free(c->normal[k]);
    }
    free(c->low);
    free(c->high);
    free(c->on);
    free(c);
    *chart = NULL;
}

uint64_t kiln_chart_bytes(uint32_t edge)
{
    const struct kiln_chart *c = NULL;
    const uint64_t texels = (uint64_t)edge * edge;
    const uint64_t blocks = (texels + KILN_CHART_BLOCK - 1) / KILN_CHART_BLOCK;
    return texels * (sizeof *c->texels + 6 * sizeof(float) + sizeof *c->on) +
           blocks * (sizeof *c->low + sizeof *c->high);
}

uint64_t kiln_chart_making_bytes(uint32_t edge)
{
    const struct making *m = NULL;
    const uint64_t ring_and_key = sizeof(uint8_t) + sizeof(uint64_t);
    return (uint64_t)edge * edge * (sizeof *m->owners + sizeof *m->texels + ring_and_key);
}
