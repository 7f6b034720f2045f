/* Finds the cells of a brick and those around it, so that the eight cells around any point near the
 * brick are read at once. Only advect_simd.c includes this header.
 *
 * A block is a brick with GAS_MOST_CELLS cells around it, and one more above it. Where its bricks
 * are active, a table points to the rows of their own cells; rows of which a part is idle, or lies
 * beyond the window, are first brought together in the thread's workspace. */
#ifndef KILN_SIM_GAS_BLOCK_H
#define KILN_SIM_GAS_BLOCK_H

#include "shared/exact.h"
#include "sim/gas/advect.h"
#include "sim/gas/gas_lanes.h"

enum {
    BELOW = GAS_MOST_CELLS, /* cells of a block below its brick, on each axis */
    ROW = GAS_EDGE * GAS_TRACED,
    PLANE = GAS_EDGE * ROW,
    UP = 3, /* entries of a table to the next row, and to the next plane of rows */
    ON = 3 * GAS_EDGE,
};

typedef float velocities[GAS_EDGE][GAS_EDGE][GAS_EDGE_ROW];
typedef float four __attribute__((vector_size(16), aligned(4), may_alias));

/* Says where the cells along one axis of a block lie. A cell beyond the window is its nearest one.
 */
struct axis {
    int32_t window[GAS_EDGE]; /* number of the cell in the window */
    int8_t brick[GAS_EDGE];   /* 0, 1, 2: the brick below, the brick itself, the one above */
    int8_t cell[GAS_EDGE];    /* in that brick */
    bool open[GAS_EDGE];      /* beyond an open side, from where no gas comes */
    bool inside;              /* no cell is beyond the window */
};

static struct axis axis_of(int32_t brick, int32_t count, bool closed_below, bool closed_above)
{
    struct axis axis = {.inside = brick > 0 && brick + 1 < count};
    for (int32_t i = 0; i < GAS_EDGE; i++) {
        int32_t cell = i - BELOW;
        const bool below = cell < 0 && brick == 0;
        const bool above = cell >= GAS_BRICK && brick + 1 == count;
        if (below)
            cell = 0;
        if (above)
            cell = GAS_BRICK - 1;
        axis.window[i] = brick * GAS_BRICK + cell;
        axis.brick[i] = (int8_t)((cell + GAS_BRICK) / GAS_BRICK);
        axis.cell[i] = (int8_t)((cell + GAS_BRICK) % GAS_BRICK);
        axis.open[i] = (below && !closed_below) || (above && !closed_above);
    }
    return axis;
}

/* Holds the bricks around a brick, and where the cells of its block lie. */
struct around {
    struct axis x, y, z;
    const struct kiln_gas_brick *brick[3][3][3]; /* NULL beyond the window */
    const struct gas_wall *wall[3][3][3];        /* NULL where no solid is */
    bool walls;                                  /* solids reach one of them */
};

static void around_of(struct around *around, const struct gas_pass *pass, gas_brick_place at)
{
    const struct kiln_gas *gas = pass->gas;
    const struct kiln_gas_place count = gas->bricks;
    const bool *closed = pass->closed;
    around->x = axis_of(at.x, count.x, closed[0], closed[1]);
    around->y = axis_of(at.y, count.y, closed[2], closed[3]);
    around->z = axis_of(at.z, count.z, closed[4], closed[5]);
    around->walls = false;
    for (int32_t z = 0; z < 3; z++)
        for (int32_t y = 0; y < 3; y++)
            for (int32_t x = 0; x < 3; x++) {
                const struct kiln_gas_place b = {at.x + x - 1, at.y + y - 1, at.z + z - 1};
                const bool inside = b.x >= 0 && b.y >= 0 && b.z >= 0 && b.x < count.x &&
                                    b.y < count.y && b.z < count.z;
                const size_t i = inside ? kiln_gas_brick_index(gas, b.x, b.y, b.z) : 0;
                around->brick[z][y][x] = inside ? &gas->brick[i] : NULL;
                around->wall[z][y][x] = inside && pass->walls ? pass->walls[i] : NULL;
                around->walls = around->walls || around->wall[z][y][x];
            }
}

/* ---- velocities at the centres of cells ------------------------------------------------------ */

/* Computes a row of velocities at the centres of cells from those of their faces. at: of the row's
 * first cell in the window's arrays. */
SIMD void velocities_of(const struct kiln_gas *gas, const struct axis *along, ptrdiff_t at,
                        float *const to[3])
{
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    for (int c = 0; c < 3; c++) {
        const float *from = gas->faces[c] + at;
        for (int32_t x = 0; x < GAS_EDGE_ROW; x += LANES)
            vf_store(to[c] + x, 0.5f * (vf_load(from + x) + vf_load(from + x + next[c])));
        if (along->inside)
            continue;
        for (int32_t x = 0; x < GAS_EDGE; x++) /* beyond the window, those of the nearest cell */
            if (along->window[x] != along->window[BELOW] + x - BELOW)
                to[c][x] = to[c][x < BELOW ? BELOW : BELOW + GAS_BRICK - 1];
    }
}

/* Computes the velocities of a row of a block into its planes. */
SIMD void find_velocities(const struct kiln_gas *gas, const struct around *around,
                          struct gas_workspace *space, int32_t y, int32_t z)
{
    float *const planes[3] = {space->velocity[0][z][y], space->velocity[1][z][y],
                              space->velocity[2][z][y]};
    const ptrdiff_t at = around->z.window[z] * gas->plane + around->y.window[y] * gas->row +
                         around->x.window[BELOW] - BELOW;
    velocities_of(gas, &around->x, at, planes);
}

static bool has_flow(int32_t i, int32_t cells)
{
    return i >= BELOW - cells && i < BELOW + GAS_BRICK + cells;
}

/* Computes the velocities of a brick and of some cells around it. */
static void find_flow(const struct kiln_gas *gas, const struct around *around,
                      struct gas_workspace *space, int32_t cells)
{
    for (int32_t z = BELOW - cells; has_flow(z, cells); z++)
        for (int32_t y = BELOW - cells; has_flow(y, cells); y++)
            find_velocities(gas, around, space, y, z);
}

/* ---- joined cells ---------------------------------------------------------------------------- */

SIMD void copy_four(float *to, const float *from)
{
    *(four *)to = *(const four *)from;
}

SIMD void copy_eight(float *to, const float *from)
{
    eight_store(to, eight_load(from));
}

/* Makes a cell one of the air beyond an open side, from where no gas comes. It has the velocity of
 * the nearest cell, as far as the air there may have it. */
static void make_outer(const struct gas_lattice *forces, float *cell)
{
    static const float none[GAS_CARRIED];
    for (int c = 0; c < 3; c++)
        cell[c] = exact_clamp(cell[c], forces->least[c], forces->most[c]);
    copy_four(cell + GAS_CARRIED_AT, none);
}

/* Stores the velocities of LANES cells, and what they carry, which lies cell by cell. */
SIMD void join_cells(float *cells, vf u, vf v, vf w, const float *carried)
{
    const struct columns each = columns_transpose(u, v, w, vf_all(0.0f));
    for (ptrdiff_t k = 0; k < 4; k++) {
#if LANES == 8
        const __m256 velocity = (__m256)each.c[k];
        _mm256_storeu_ps(cells + k * GAS_TRACED,
                         _mm256_insertf128_ps(velocity, _mm_loadu_ps(carried + 4 * k), 1));
        _mm256_storeu_ps(
            cells + (4 + k) * GAS_TRACED,
            _mm256_permute2f128_ps(
                velocity, _mm256_castps128_ps256(_mm_loadu_ps(carried + 4 * (4 + k))), 0x21));
#else
        vf_store(cells + k * GAS_TRACED, each.c[k]);
        vf_store(cells + k * GAS_TRACED + GAS_CARRIED_AT, vf_load(carried + 4 * k));
#endif
    }
}

/* Returns the place of a row, the z * GAS_BRICK + y-th of a brick, in joined and traced cells. */
SIMD ptrdiff_t traced_row(ptrdiff_t row)
{
    return row * GAS_ROW_CELLS * GAS_TRACED;
}

/* Fills a brick's joined cells. A row has one more cell, the first of the next brick. */
static void join_brick(const struct gas_pass *pass, gas_brick_place at)
{
    static const float none[GAS_CARRIED];
    const struct kiln_gas *gas = pass->gas;
    const struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(gas, at.x, at.y, at.z)];
    const bool last = at.x + 1 == gas->bricks.x;
    const struct kiln_gas_brick *right = last ? NULL : brick + 1;
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    for (int32_t row = 0; row < GAS_BRICK * GAS_BRICK; row++) {
        const int32_t y = row % GAS_BRICK, z = row / GAS_BRICK;
        const ptrdiff_t face = gas_row_of_window(gas, at, y, z);
        float *cells = brick->joined + traced_row(row);
        const ptrdiff_t carried_at = (ptrdiff_t)row * GAS_BRICK * GAS_CARRIED;
        const float *carried = brick->now + carried_at;
        const float *const f[3] = {gas->faces[0] + face, gas->faces[1] + face,
                                   gas->faces[2] + face};
        for (ptrdiff_t x = 0; x < GAS_BRICK; x += LANES) {
            vf u[3];
            for (int c = 0; c < 3; c++)
                u[c] = 0.5f * (vf_load(f[c] + x) + vf_load(f[c] + x + next[c]));
            join_cells(cells + x * GAS_TRACED, u[0], u[1], u[2], carried + x * GAS_CARRIED);
        }
        float *end = cells + (ptrdiff_t)GAS_BRICK * GAS_TRACED;
        if (last) { /* the nearest cell */
            copy_eight(end, end - GAS_TRACED);
            if (!pass->closed[1])
                make_outer(&pass->forces, end);
            continue;
        }
        for (int c = 0; c < 3; c++)
            end[c] = 0.5f * (f[c][GAS_BRICK] + f[c][GAS_BRICK + next[c]]);
        end[3] = 0.0f;
        copy_four(end + GAS_CARRIED_AT, right->now ? right->now + carried_at : none);
    }
}

/* ---- tables of rows -------------------------------------------------------------------------- */

/* Says how far around its brick the cells of a block are needed: cells below it on each axis, and
 * one more above it. */
struct reach {
    int32_t x, y, z;
};

/* Points to the cells of each row of a block that lie in the brick to the left, in the brick
 * itself, and in the one to the right: to its cell 0. */
struct rows {
    const float *of[GAS_EDGE * GAS_EDGE * 3];
};

/* Says which bricks a row of a block goes through, and where it lies in them. */
struct row {
    const struct kiln_gas_brick *const *brick; /* three; NULL beyond the window */
    ptrdiff_t cells;                           /* place of the row in joined and traced cells */
    ptrdiff_t faces;                           /* and in the window's arrays */
    bool open;                                 /* it lies beyond an open side */
};

static struct row row_of(const struct kiln_gas *gas, const struct around *around, int32_t y,
                         int32_t z)
{
    const int32_t row = around->z.cell[z] * GAS_BRICK + around->y.cell[y];
    return (struct row){
        .brick = around->brick[around->z.brick[z]][around->y.brick[y]],
        .cells = traced_row(row),
        .faces = around->z.window[z] * gas->plane + around->y.window[y] * gas->row,
        .open = around->z.open[z] || around->y.open[y],
    };
}

/* Brings cells [begin, end) of a row of a block together. Idle cells carry nothing, and traced they
 * are as they were: as in `now`. */
static void gather_cells(const struct gas_pass *pass, const struct around *around,
                         const struct row *row, bool traced, const float *now, int32_t begin,
                         int32_t end, float *to)
{
    static const float none[GAS_CARRIED];
    const struct kiln_gas *gas = pass->gas;
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    for (int32_t x = begin; x < end; x++) {
        const struct kiln_gas_brick *from = row->brick[around->x.brick[x]];
        const ptrdiff_t cell = row->cells + (ptrdiff_t)around->x.cell[x] * GAS_TRACED;
        const ptrdiff_t place = (ptrdiff_t)x * GAS_TRACED;
        float *own = to + place;
        if (from->joined) {
            copy_eight(own, (traced ? from->traced : from->joined) + cell);
        } else if (traced) {
            copy_eight(own, now + place);
        } else {
            const ptrdiff_t at = row->faces + around->x.window[x];
            for (int c = 0; c < 3; c++)
                own[c] = 0.5f * (gas->faces[c][at] + gas->faces[c][at + next[c]]);
            own[3] = 0.0f;
            copy_four(own + GAS_CARRIED_AT, none);
        }
        if (row->open || around->x.open[x])
            make_outer(&pass->forces, own);
    }
}

/* Fills the table of a block's joined cells, or of its traced ones, whose table needs that of the
 * former. */
static void find_rows(const struct gas_pass *pass, const struct around *around, bool traced,
                      struct gas_workspace *space, struct reach reach, struct rows *rows)
{
    /* cells of a block in each brick, and the first one of the next brick */
    static const int32_t begin[3] = {0, BELOW, BELOW + GAS_BRICK};
    static const int32_t end[3] = {BELOW + 1, BELOW + GAS_BRICK + 1, GAS_EDGE};
    float *block = traced ? space->traced : space->now;
    for (int32_t z = BELOW - reach.z; z <= BELOW + GAS_BRICK + reach.z; z++)
        for (int32_t y = BELOW - reach.y; y <= BELOW + GAS_BRICK + reach.y; y++) {
            const struct row row = row_of(pass->gas, around, y, z);
            const ptrdiff_t at = (ptrdiff_t)z * PLANE + (ptrdiff_t)y * ROW;
            const float **entry = &rows->of[z * ON + y * UP];
            for (int i = 0; i < 3; i++) {
                const struct kiln_gas_brick *brick = row.brick[i];
                if (brick && brick->joined && !row.open) {
                    entry[i] = (traced ? brick->traced : brick->joined) + row.cells;
                    continue;
                }
                gather_cells(pass, around, &row, traced, space->now + at, begin[i], end[i],
                             block + at);
                entry[i] = block + at + (BELOW + (ptrdiff_t)(i - 1) * GAS_BRICK) * GAS_TRACED;
            }
        }
}

#endif
