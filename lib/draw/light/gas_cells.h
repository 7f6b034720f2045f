/* A kiln_gas_cells holds the gas of a moment in large cells, in which it throws shadows and sheds
 * light on what is around: how much each cell hides, and what its flames emit. */
#ifndef KILN_DRAW_LIGHT_GAS_CELLS_H
#define KILN_DRAW_LIGHT_GAS_CELLS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/flame_colors.h"
#include "draw/moment/moment.h"

enum {
    KILN_GAS_CELL = 4,  /* cells of gas along an edge of a large cell at level 0 */
    KILN_GAS_LEVELS = 5 /* of cells, each twice as large as those of the level before */
};

/* Holds the light that the flames of a large cell emit. */
struct kiln_gas_glow {
    float rgb[3]; /* radiance a metre, without intensity, summed over the cells of gas */
    float at[3];  /* sum of their places times the sum of their rgb: from the large cell's lowest
                   * corner, in cells of gas */
};

/* Holds sums over flames, in cells of gas of the window. */
struct kiln_gas_sums {
    double color[3];
    double energy; /* sum of the channels of color; the weight of the members below */
    double at[3], squares[3];
};

/* Holds the large cells of a domain, rows along x, then y, then z. */
struct kiln_gas_block {
    uint32_t domain;
    float corner[3];   /* m: the window's lowest corner in the world */
    float edges[3][3]; /* m: from a cell of gas to the next one along each axis of the window */
    float cell_m;      /* length of these edges */
    struct kiln_gas_place cells[KILN_GAS_LEVELS]; /* of each level; all 0: there is no gas */
    float *extinction[KILN_GAS_LEVELS];           /* 1/m: means */
    struct kiln_gas_glow *glow;                   /* of the cells of level 0; NULL: no light */
    float *leaving;                               /* scratch: of the same cells */
    struct kiln_gas_sums *layers; /* scratch: KILN_GAS_LIGHTS of each layer of them */
    float intensity;              /* radiance a metre of whole flame, times look.light */
    float low[3], high[3]; /* bounds of what hides something, in cells of gas of the window */
    bool shadow;           /* whether it throws shadows */
};

struct kiln_gas_cells {
    struct kiln_gas_block blocks[KILN_MAX_GAS];
    uint32_t count;
    struct kiln_flame_colors colors[KILN_MAX_GAS];
    struct kiln_observer observer;
    bool observes; /* whether `observer` is filled */
    void *memory[KILN_MAX_GAS];
    size_t room[KILN_MAX_GAS]; /* bytes */
};

/* Gathers the gas of all domains that throw shadows or shed light, at the time of the moment. gas:
 * the pool that has it. `cells` starts as zeros and can be gathered into again. Returns false with
 * an error: no memory. */
bool kiln_gas_cells_gather(struct kiln_gas_cells *cells, const struct kiln_moment *moment,
                           const struct kiln_pool *gas, struct kiln_threads *threads,
                           struct kiln_error *error);
void kiln_gas_cells_finish(struct kiln_gas_cells *cells);

/* Adds the memory of the cells. */
void kiln_gas_cells_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Says how a grid of the world reads the cells of a block at a level: the place of a point of the
 * grid, in cells of the level from the middle of the first one, is a sum of multiples of these. */
struct kiln_gas_reader {
    const float *extinction;
    struct kiln_gas_place cells;
    float origin[3], steps[3][3]; /* of the grid's first point; to the next one along each axis */
};

/* Prepares to read a block at points of a grid: the world place of point (0, 0, 0), and the ways to
 * the next point along each axis, m. Large steps read large cells, so that no gas is missed. */
struct kiln_gas_reader kiln_gas_reader_of(const struct kiln_gas_block *block, const float origin[3],
                                          const float steps[3][3]);

/* Adds the extinction at `count` points of row (y, z) of the grid. */
void kiln_gas_reader_add(const struct kiln_gas_reader *reader, int y, int z, int count,
                         float *extinction);

#endif
