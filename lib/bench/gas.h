/* Declares what the files of the suite `gas` of `kiln bench` share. */
#ifndef KILN_BENCH_GAS_H
#define KILN_BENCH_GAS_H

#include "bench/suite.h"
#include "draw/volume/volume.h"
#include "sim/gas/kernels.h"
#include "sim/gas/solver.h"

enum { KILN_GAS_SIZES = 2, KILN_GAS_TURNS = 5 };

/* The boxes of the suite: cells along their edges. */
struct kiln_gas_sizes {
    const struct kiln_bench_run *run;
    int32_t edges[KILN_GAS_SIZES];
    uint32_t count;
    struct gas_kernels *kernels; /* NULL: technique `cpu` steps the gas */
    enum kiln_march_technique march;
};

/* Adds a row to the last part, whose x is the edge of a size. */
bool kiln_bench_add_gas(const struct kiln_gas_sizes *sizes, uint32_t size, const char *measure,
                        const char *technique, const double *values, size_t count,
                        struct kiln_error *error);

/* The names of the passes of a step. */
extern const char *const kiln_gas_pass_names[GAS_TIMERS];

/* Add the parts about steps of boxes and their memory (gas_box.c). */
bool kiln_bench_gas_boxes(const struct kiln_gas_sizes *sizes, struct kiln_error *error);

/* Holds what drawing a fire has taken, in turns: with each kiln_gas_resolution, or for march=gl
 * with the first one, as it has a ray for each pixel. */
struct kiln_gas_drawing {
    enum kiln_march_technique march;
    struct kiln_volume_costs costs[2][KILN_GAS_TURNS];
    uint32_t turns;
};

/* Draws the gas of a fire at a step, on the host but for the march. The scene's resolution of gas
 * changes. */
bool kiln_bench_draw_gas(const struct kiln_bench_run *run, struct kiln_scene *scene,
                         struct kiln_pool *pool, uint32_t step, struct kiln_threads *threads,
                         struct kiln_gas_drawing *to, struct kiln_error *error);

/* Adds the part about drawing, of a fire of each size. */
bool kiln_bench_add_drawings(const struct kiln_gas_sizes *sizes,
                             const struct kiln_gas_drawing drawings[], struct kiln_error *error);

#endif
