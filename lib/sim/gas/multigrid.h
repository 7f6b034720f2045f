/* Solves for the pressure that makes the velocity of gas flow out of each cell as much as burning
 * expands it: sum(p of the 6 cells around) - d p = f, by multigrid (Briggs, Henson, McCormick: A
 * Multigrid Tutorial, 2nd ed., chapter 3). Where solids are, the cells around count by the part of
 * the face that is open.
 *
 * A row of a level keeps its cells of even x apart from those of odd x, since Gauss-Seidel's two
 * colours then are whole rows: first the even ones, KILN_GAS_PAD floats of zeros, the odd ones,
 * KILN_GAS_PAD floats of zeros. */
#ifndef KILN_SIM_GAS_MULTIGRID_H
#define KILN_SIM_GAS_MULTIGRID_H

#include "base/simd.h"
#include "base/thread.h"
#include "particles/gas.h"

enum { GAS_LEVELS = 10 };

struct gas_level {
    struct kiln_gas_place cells;
    ptrdiff_t row, plane, odd; /* floats to the next row, the next plane, from even to odd cells */
    float *p, *f;              /* of the first cell; rows and planes around the level are zeros */
    float *diagonal, *inverse; /* d and 1 / d by place in a row, for each of the 9 kinds of rows */
    bool closed[6];
    /* Part of each cell's lower face that is open, 2 on open sides of the level, in the order of p;
     * NULL: there are no solids. */
    float *open[3];
    uint8_t *walled; /* rows of cells, y first, of which a face is not wholly open */
};

/* Returns the place of a cell in p and f. */
static inline ptrdiff_t gas_level_at(const struct gas_level *level, int32_t x, int32_t y, int32_t z)
{
    return z * level->plane + y * level->row + (x & 1) * level->odd + x / 2;
}

/* Returns whether anything flows through a face of a cell, of a level with solids. */
static inline bool gas_level_is_open(const struct gas_level *level, int32_t x, int32_t y, int32_t z)
{
    const ptrdiff_t at = gas_level_at(level, x, y, z);
    return level->open[0][at] > 0.0f || level->open[0][gas_level_at(level, x + 1, y, z)] > 0.0f ||
           level->open[1][at] > 0.0f || level->open[1][at + level->row] > 0.0f ||
           level->open[2][at] > 0.0f || level->open[2][at + level->plane] > 0.0f;
}

struct gas_levels {
    uint32_t count;
    struct gas_level level[GAS_LEVELS];
    float *memory, *wall_memory;
    uint8_t *wall_rows;
};

struct gas_multigrid {
    /* Relaxes the cells of a colour, 0 or 1, of planes [begin, end). */
    void (*relax)(const struct gas_level *level, int color, int32_t begin, int32_t end);
    /* Relaxes colour 0 where p is zero everywhere, whatever p holds. */
    void (*begin)(const struct gas_level *level, int32_t begin, int32_t end);
    /* Fills f of planes [begin, end) of the coarser level with the residuals of the finer one,
     * whose colour 1 was relaxed last and has none. */
    void (*restrict_to)(const struct gas_level *fine, const struct gas_level *coarse, int32_t begin,
                        int32_t end);
    /* Adds the coarser level's p to the cells of a colour. */
    void (*prolong)(const struct gas_level *coarse, const struct gas_level *fine, int color,
                    int32_t begin, int32_t end);
    /* Returns the sum of squares of f, or of residuals, of a plane. */
    double (*square)(const struct gas_level *level, bool residual, int32_t plane);
};
KILN_SIMD_DECLARE(const struct gas_multigrid, kiln_gas_multigrid);

/* Makes the levels for the window of a gas, whose pressure is p of the finest one. Returns false
 * when memory is short. gas_levels_finish frees everything, also after a failure. */
bool gas_levels_init(struct gas_levels *levels, const struct kiln_gas *gas);
void gas_levels_finish(struct gas_levels *levels);

/* Returns the bytes that the levels of a window take beside its pressure; walls: with solids. */
uint64_t gas_levels_bytes(struct kiln_gas_place cells, bool walls);

/* Gives the levels memory for open parts of faces, all of which are open. */
bool gas_levels_add_walls(struct gas_levels *levels);

/* Opens all faces of a level again. */
void gas_level_open_all(const struct gas_level *level);

/* Fills `open` of the coarser levels, and the rows with walls of all levels, from planes [begin,
 * end) of the finest level's `open`. */
void gas_levels_coarsen(const struct gas_levels *levels, int32_t begin, int32_t end);

/* Return the floats of an array of a level, such as p, and the place of the first cell in it. */
size_t gas_level_floats(const struct gas_level *level);
size_t gas_level_first(const struct gas_level *level);

/* Names the parts of a V-cycle. */
enum gas_relaxation_kind {
    GAS_RELAX,    /* the cells of a colour of a level */
    GAS_BEGIN,    /* those of colour 0, where p is zero everywhere, whatever p holds */
    GAS_RESTRICT, /* fills f of the coarser level with residuals */
    GAS_PROLONG,  /* adds the coarser level's p to the cells of a colour */
    GAS_COARSEST, /* GAS_BEGIN, and then `sweeps` over colour 1 and colour 0 */
};

struct gas_relaxation {
    enum gas_relaxation_kind kind;
    const struct gas_level *level, *coarse;
    int color;
    int32_t sweeps;
};

/* Runs the parts of V-cycles, on the host or in GL. */
struct gas_relaxer {
    void *context;
    void (*run)(void *context, const struct gas_relaxation *what);
};

/* Improves p of the finest level by `cycles` V-cycles. */
void gas_levels_cycle(const struct gas_levels *levels, const struct gas_relaxer *relaxer,
                      uint32_t cycles);

/* Does so on the host. */
void gas_levels_solve(const struct gas_levels *levels, const struct gas_multigrid *rows,
                      struct kiln_threads *threads, uint32_t cycles);

/* Returns the length of f of a level, or of its residual. Sums are in a fixed order. */
double gas_level_length(const struct gas_level *level, const struct gas_multigrid *rows,
                        bool residual);

/* Where nothing can flow out of the window, the equation has no solution unless f sums up to 0, and
 * then any pressure may be added: takes the means off f and p of the finest level. */
void gas_level_center(const struct gas_level *level);

#endif
