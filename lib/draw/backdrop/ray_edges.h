/* This header lists the pixels at edges in a strip of the backdrop's picture. */
#ifndef KILN_DRAW_BACKDROP_RAY_EDGES_H
#define KILN_DRAW_BACKDROP_RAY_EDGES_H

#include "base/lane_math.h"
#include "draw/backdrop/backdrop_rows.h"

enum {
    TILE = KILN_EDGE_TILE,
    STRIP = 64,             /* px; rays of a strip test the same objects */
    EDGE_STRIP = 4 * STRIP, /* px; pixels of such a strip at edges share vectors */
    EDGE_ROOM = EDGE_STRIP * TILE + LANES,
};

/* Returns the end of the rows of a strip from row y on. */
static uint32_t rows_from(const struct kiln_backdrop_picture *p, uint32_t y)
{
    return y + TILE < p->height ? y + TILE : p->height;
}

static inline int32_t within(int32_t x, uint32_t size)
{
    return x < 0 ? 0 : x < (int32_t)size ? x : (int32_t)size - 1;
}

static inline const float *surface_row(const struct kiln_backdrop_picture *p, int32_t y)
{
    return p->surfaces + (size_t)within(y, p->height) * p->width;
}

/* Holds the numbers of a strip's pixels and of those around it, which repeat at the picture's
 * border. */
struct around {
    float rows[TILE + 2][STRIP + 2]; /* from (x - 1, y - 1) on */
};

static void look_around(const struct kiln_backdrop_picture *p, int32_t x, int32_t y,
                        struct around *around)
{
    for (int32_t j = 0; j < TILE + 2; j++) {
        const float *from = surface_row(p, y - 1 + j);
        if (x >= 1 && x + STRIP + 1 <= (int32_t)p->width) {
            memcpy(around->rows[j], from + x - 1, sizeof around->rows[j]);
            continue;
        }
        for (int32_t i = 0; i < STRIP + 2; i++)
            around->rows[j][i] = from[within(x - 1 + i, p->width)];
    }
}

/* Returns the lanes whose number is marked. */
SIMD vi is_marked(vf number)
{
    return number >= 0.5f * KILN_EDGE_MARK;
}

SIMD vf without_mark(vf number)
{
    return number - vf_where(is_marked(number), vf_all(KILN_EDGE_MARK));
}

/* Returns which of LANES pixels are at edges: those that are marked, and those that differ from one
 * of the eight pixels around them. A straight edge that parts a pixel's area parts its middle from
 * one of theirs. i, j: of the first pixel, in the strip. */
SIMD vi find_edges(const struct around *around, int i, int j)
{
    const vf number = vf_load(&around->rows[j + 1][i + 1]), own = without_mark(number);
    vi edge = is_marked(number);
    for (int k = 0; k < 9; k++) {
        const vf other = without_mark(vf_load(&around->rows[j + k / 3][i + k % 3]));
        edge |= vf_abs(other - own) > KILN_EDGE_THRESHOLD;
    }
    return edge;
}

/* Adds the pixels of a strip at edges to a list. Returns its new length. at: columns, then rows.
 * The list goes down columns of LANES pixels, so that pixels that share vectors are near each
 * other; its order changes no pixel. */
static int list_edges(const struct kiln_backdrop_picture *p, uint32_t x, uint32_t y, int count,
                      int32_t at[2][EDGE_ROOM])
{
    struct around around;
    look_around(p, (int32_t)x, (int32_t)y, &around);
    const int columns = x + STRIP < p->width ? STRIP : (int)(p->width - x);
    for (int first = 0; first < columns; first += LANES) {
        for (int j = 0; j < (int)(rows_from(p, y) - y); j++) {
            const vi edge = find_edges(&around, first, j) & (vi_count() < columns - first);
            if (!any(edge))
                continue;
            for (int i = 0; i < LANES; i++) {
                at[0][count] = (int32_t)x + first + i;
                at[1][count] = (int32_t)y + j;
                count += edge[i] != 0;
            }
        }
    }
    return count;
}

#endif
