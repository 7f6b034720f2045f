/* Keeps the levels of the multigrid and runs its V-cycles. */
#include "sim/gas/multigrid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"

enum {
    LEAST_SWEEPS = 8, /* of the coarsest level, beside one for each cell along its longest edge */
    CELLS_A_PIECE = 1 << 14,
};

/* Returns how many neighbours of a cell on one axis take part: a closed side counts 0, an open one,
 * where p is 0 on the face, half a cell away, 2. */
static float neighbours(int32_t cell, int32_t count, bool closed_below, bool closed_above)
{
    float sum = 2.0f;
    if (cell == 0)
        sum += closed_below ? -1.0f : 1.0f;
    if (cell == count - 1)
        sum += closed_above ? -1.0f : 1.0f;
    return sum;
}

static void fill_diagonals(struct gas_level *level)
{
    const struct kiln_gas_place n = level->cells;
    const bool *closed = level->closed;
    for (int kind = 0; kind < 9; kind++) {
        const int32_t y = kind % 3 == 0 ? 0 : kind % 3 == 1 ? 1 : n.y - 1;
        const int32_t z = kind / 3 == 0 ? 0 : kind / 3 == 1 ? 1 : n.z - 1;
        for (int32_t x = 0; x < n.x; x++) {
            const float d =
                neighbours(x, n.x, closed[0], closed[1]) +
                (n.y == 1 || kind % 3 != 1 ? neighbours(y, n.y, closed[2], closed[3]) : 2.0f) +
                (n.z == 1 || kind / 3 != 1 ? neighbours(z, n.z, closed[4], closed[5]) : 2.0f);
            const ptrdiff_t at = kind * level->row + (x & 1) * level->odd + x / 2;
            level->diagonal[at] = d;
            level->inverse[at] = d > 0.0f ? 1.0f / d : 0.0f;
        }
    }
}

static bool is_last(struct kiln_gas_place n, uint32_t number)
{
    const bool odd = (n.x | n.y | n.z) & 1;
    return odd || n.x <= 4 || n.y <= 4 || n.z <= 4 || number + 1 == GAS_LEVELS;
}

size_t gas_level_floats(const struct gas_level *level)
{
    return (size_t)level->plane * (size_t)(level->cells.z + 2) + 2 * (size_t)KILN_GAS_PAD;
}

size_t gas_level_first(const struct gas_level *level)
{
    return (size_t)(level->plane + level->row) + KILN_GAS_PAD;
}

static size_t rows_of(const struct gas_level *level)
{
    return (size_t)level->cells.y * (size_t)level->cells.z;
}

/* Fills in the sizes of all levels. */
static void measure(struct gas_levels *levels, struct kiln_gas_place cells)
{
    *levels = (struct gas_levels){.count = 0};
    for (struct kiln_gas_place n = cells;; n = (struct kiln_gas_place){n.x / 2, n.y / 2, n.z / 2}) {
        struct gas_level *level = &levels->level[levels->count++];
        level->cells = n;
        level->row = kiln_gas_row(n.x);
        level->odd = level->row / 2;
        level->plane = level->row * (n.y + 2);
        if (is_last(n, levels->count - 1))
            break;
    }
}

/* Returns the floats of a level's p, f and diagonals. The finest one has the p of the gas. */
static size_t level_floats(const struct gas_levels *levels, uint32_t i)
{
    const struct gas_level *level = &levels->level[i];
    return (i > 0 ? 2 : 1) * gas_level_floats(level) + 18 * (size_t)level->row;
}

uint64_t gas_levels_bytes(struct kiln_gas_place cells, bool walls)
{
    struct gas_levels levels;
    uint64_t bytes = 0;
    measure(&levels, cells);
    for (uint32_t i = 0; i < levels.count; i++) {
        bytes += level_floats(&levels, i) * sizeof(float);
        if (walls)
            bytes +=
                3 * gas_level_floats(&levels.level[i]) * sizeof(float) + rows_of(&levels.level[i]);
    }
    return bytes;
}

bool gas_levels_init(struct gas_levels *levels, const struct kiln_gas *gas)
{
    size_t floats = 0;
    measure(levels, gas->cells);
    for (uint32_t i = 0; i < levels->count; i++)
        floats += level_floats(levels, i);
    float *memory = kiln_alloc_pages(floats * sizeof *memory);
    if (!memory)
        return false;
    memset(memory, 0, floats * sizeof *memory);
    levels->memory = memory;
    for (uint32_t i = 0; i < levels->count; i++) {
        struct gas_level *level = &levels->level[i];
        const size_t size = gas_level_floats(level), first = gas_level_first(level);
        level->f = memory + first;
        level->p = i > 0 ? level->f + size : gas->pressure;
        level->diagonal = memory + (i > 0 ? 2 : 1) * size;
        level->inverse = level->diagonal + 9 * level->row;
        memory += level_floats(levels, i);
        kiln_gas_closed(gas, level->closed);
        fill_diagonals(level);
    }
    return true;
}

void gas_levels_finish(struct gas_levels *levels)
{
    free(levels->memory);
    free(levels->wall_memory);
    free(levels->wall_rows);
    *levels = (struct gas_levels){.count = 0};
}

/* ---- solids ---------------------------------------------------------------------------------- */

/* Returns what a face of a cell counts that no solid covers. number: of the face along its axis. */
static float open_face(int32_t number, int32_t count, const bool closed[2])
{
    if (number == 0)
        return closed[0] ? 0.0f : 2.0f;
    if (number == count)
        return closed[1] ? 0.0f : 2.0f;
    return 1.0f;
}

void gas_level_open_all(const struct gas_level *level)
{
    const struct kiln_gas_place n = level->cells;
    for (int32_t z = 0; z <= n.z; z++)
        for (int32_t y = 0; y <= n.y; y++)
            for (int32_t x = 0; x <= n.x; x++) {
                const ptrdiff_t at = gas_level_at(level, x, y, z);
                level->open[0][at] = open_face(x, n.x, level->closed);
                level->open[1][at] = open_face(y, n.y, level->closed + 2);
                level->open[2][at] = open_face(z, n.z, level->closed + 4);
            }
}

bool gas_levels_add_walls(struct gas_levels *levels)
{
    size_t floats = 0, rows = 0;
    for (uint32_t i = 0; i < levels->count; i++) {
        floats += 3 * gas_level_floats(&levels->level[i]);
        rows += rows_of(&levels->level[i]);
    }
    levels->wall_memory = kiln_alloc_pages(floats * sizeof(float));
    levels->wall_rows = calloc(rows, 1);
    if (!levels->wall_memory || !levels->wall_rows)
        return false;
    memset(levels->wall_memory, 0, floats * sizeof(float));
    floats = rows = 0;
    for (uint32_t i = 0; i < levels->count; i++) {
        struct gas_level *level = &levels->level[i];
        for (int axis = 0; axis < 3; axis++, floats += gas_level_floats(level))
            level->open[axis] = levels->wall_memory + floats + gas_level_first(level);
        level->walled = levels->wall_rows + rows;
        rows += rows_of(level);
        gas_level_open_all(level);
    }
    return true;
}

/* Returns the mean of the four faces of a finer level that make up a face of a coarser one. */
static float coarse_face(const struct gas_level *fine, int axis, int32_t x, int32_t y, int32_t z)
{
    const float *open = fine->open[axis];
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    float sum = 0.0f;
    for (int i = 0; i < 4; i++) {
        int32_t at[3] = {x, y, z};
        at[a] += i & 1;
        at[b] += i >> 1;
        sum = sum + open[gas_level_at(fine, at[0], at[1], at[2])];
    }
    return 0.25f * sum;
}

static void coarsen(const struct gas_level *fine, const struct gas_level *coarse, int32_t begin,
                    int32_t end)
{
    const struct kiln_gas_place n = coarse->cells;
    for (int axis = 0; axis < 3; axis++)
        for (int32_t z = begin; z < end + (axis == 2); z++)
            for (int32_t y = 0; y < n.y + (axis == 1); y++)
                for (int32_t x = 0; x < n.x + (axis == 0); x++)
                    coarse->open[axis][gas_level_at(coarse, x, y, z)] =
                        coarse_face(fine, axis, 2 * x, 2 * y, 2 * z);
}

/* Marks the rows of which a cell has a face that is not wholly open. */
static void mark_rows(const struct gas_level *level, int32_t begin, int32_t end)
{
    const struct kiln_gas_place n = level->cells;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < n.y; y++) {
            bool walled = false;
            for (int32_t x = 0; x < n.x && !walled; x++) {
                const ptrdiff_t at = gas_level_at(level, x, y, z);
                walled =
                    level->open[0][at] != open_face(x, n.x, level->closed) ||
                    level->open[0][gas_level_at(level, x + 1, y, z)] !=
                        open_face(x + 1, n.x, level->closed) ||
                    level->open[1][at] != open_face(y, n.y, level->closed + 2) ||
                    level->open[1][at + level->row] != open_face(y + 1, n.y, level->closed + 2) ||
                    level->open[2][at] != open_face(z, n.z, level->closed + 4) ||
                    level->open[2][at + level->plane] != open_face(z + 1, n.z, level->closed + 4);
            }
            level->walled[z * n.y + y] = walled;
        }
}

void gas_levels_coarsen(const struct gas_levels *levels, int32_t begin, int32_t end)
{
    for (uint32_t i = 0; i < levels->count; i++) {
        const struct gas_level *level = &levels->level[i];
        if (i > 0) {
            begin = begin / 2;
            end = (end + 1) / 2 < level->cells.z ? (end + 1) / 2 : level->cells.z;
            coarsen(level - 1, level, begin, end);
        }
        mark_rows(level, begin > 0 ? begin - 1 : 0, end < level->cells.z ? end + 1 : end);
    }
}

/* ---- cycles ---------------------------------------------------------------------------------- */

static int32_t sweeps_of(struct kiln_gas_place n)
{
    const int32_t flat = n.x > n.y ? n.x : n.y;
    return LEAST_SWEEPS + (flat > n.z ? flat : n.z);
}

/* Relaxes a colour of a level. */
static void relax(const struct gas_relaxer *relaxer, const struct gas_level *level, int color)
{
    relaxer->run(relaxer->context,
                 &(struct gas_relaxation){.kind = GAS_RELAX, .level = level, .color = color});
}

static void between(const struct gas_relaxer *relaxer, enum gas_relaxation_kind kind,
                    const struct gas_level *level)
{
    relaxer->run(relaxer->context,
                 &(struct gas_relaxation){.kind = kind, .level = level, .coarse = level + 1});
}

void gas_levels_cycle(const struct gas_levels *levels, const struct gas_relaxer *relaxer,
                      uint32_t cycles)
{
    const uint32_t last = levels->count - 1;
    for (uint32_t cycle = 0; cycle < cycles; cycle++) {
        for (uint32_t i = 0; i < last; i++) {
            const struct gas_level *level = &levels->level[i];
            if (i > 0)
                relaxer->run(relaxer->context,
                             &(struct gas_relaxation){.kind = GAS_BEGIN, .level = level});
            else if (cycle == 0) /* a cycle ends with colour 0 */
                relax(relaxer, level, 0);
            relax(relaxer, level, 1);
            between(relaxer, GAS_RESTRICT, level);
        }
        const struct gas_level *level = &levels->level[last];
        relaxer->run(relaxer->context, &(struct gas_relaxation){.kind = GAS_COARSEST,
                                                                .level = level,
                                                                .sweeps = sweeps_of(level->cells)});
        for (uint32_t i = last; i-- > 0;) {
            level = &levels->level[i];
            between(relaxer, GAS_PROLONG, level);
            relax(relaxer, level, 1);
            relax(relaxer, level, 0);
        }
    }
}

/* Relaxes levels on the host. */
struct host {
    const struct gas_multigrid *rows;
    struct kiln_threads *threads;
};

struct work {
    const struct gas_multigrid *rows;
    const struct gas_relaxation *what;
};

static void work_on(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    const struct gas_relaxation *r = work->what;
    const int32_t a = (int32_t)begin, b = (int32_t)end;
    switch (r->kind) {
    case GAS_RELAX:
        work->rows->relax(r->level, r->color, a, b);
        break;
    case GAS_BEGIN:
        work->rows->begin(r->level, a, b);
        break;
    case GAS_RESTRICT:
        work->rows->restrict_to(r->level, r->coarse, a, b);
        break;
    case GAS_PROLONG:
        work->rows->prolong(r->coarse, r->level, r->color, a, b);
        break;
    case GAS_COARSEST:
        break;
    }
}

static void over_planes(const struct host *host, const struct gas_relaxation *what)
{
    struct work work = {host->rows, what};
    const struct gas_level *planes = what->kind == GAS_RESTRICT ? what->coarse : what->level;
    const struct kiln_gas_place n = planes->cells;
    const int32_t grain = CELLS_A_PIECE / (n.x * n.y) + 1;
    kiln_threads_for(host->threads, (size_t)n.z, (size_t)grain, work_on, &work);
}

static void run_on_host(void *context, const struct gas_relaxation *what)
{
    const struct host *host = context;
    const struct gas_level *level = what->level;
    if (what->kind != GAS_COARSEST) {
        over_planes(host, what);
        return;
    }
    over_planes(host, &(struct gas_relaxation){.kind = GAS_BEGIN, .level = level});
    for (int32_t i = 0; i < what->sweeps; i++)
        for (int color = 1; color >= 0; color--)
            over_planes(
                host, &(struct gas_relaxation){.kind = GAS_RELAX, .level = level, .color = color});
}

void gas_levels_solve(const struct gas_levels *levels, const struct gas_multigrid *rows,
                      struct kiln_threads *threads, uint32_t cycles)
{
    struct host host = {rows, threads};
    gas_levels_cycle(levels, &(struct gas_relaxer){&host, run_on_host}, cycles);
}

double gas_level_length(const struct gas_level *level, const struct gas_multigrid *rows,
                        bool residual)
{
    double sum = 0.0;
    for (int32_t z = 0; z < level->cells.z; z++)
        sum += rows->square(level, residual, z);
    return sqrt(sum);
}

/* Takes the mean off an array of the finest level. */
static void center(const struct gas_level *level, float *numbers)
{
    const struct kiln_gas_place n = level->cells;
    double sum = 0.0, cells = 0.0;
    for (int pass = 0; pass < 2; pass++) {
        const float mean = pass > 0 && cells > 0.0 ? (float)(sum / cells) : 0.0f;
        for (int32_t z = 0; z < n.z; z++)
            for (int32_t y = 0; y < n.y; y++)
                for (int32_t x = 0; x < n.x; x++) {
                    float *number = &numbers[gas_level_at(level, x, y, z)];
                    if (level->open[0] && !gas_level_is_open(level, x, y, z))
                        continue;
                    if (pass == 0) {
                        sum += (double)*number;
                        cells += 1.0;
                    } else {
                        *number = *number - mean;
                    }
                }
    }
}

void gas_level_center(const struct gas_level *level)
{
    center(level, level->f);
    center(level, level->p);
}
