/* Steps a domain of gas (Heinz 2019, 2.3.2). Air and what it carries are moved along, burn and rise
 * (advect.h); the change of the velocity goes to the faces of cells (faces.h); pressure makes it
 * flow out of each cell as much as burning expands it (multigrid.h).
 *
 * All bits are the same at every level of vectors and for any number of threads. */
#ifndef KILN_SIM_GAS_SOLVER_H
#define KILN_SIM_GAS_SOLVER_H

#include "sim/gas/advect.h"
#include "sim/gas/faces.h"
#include "sim/gas/multigrid.h"
#include "sim/gas/new_air.h"
#include "sim/gas/passes.h"

struct gas_list {
    gas_brick_place *brick;
    uint32_t count;
};

/* Holds bricks of the domain from `low` to before `high` on each axis. */
struct gas_region {
    struct kiln_gas_place low, high;
};

/* Returns whether a region has a brick of the window. */
static inline bool gas_region_has(const struct gas_region *region, const struct kiln_gas *gas,
                                  gas_brick_place at)
{
    const struct kiln_gas_place b = {gas->at.x / GAS_BRICK + at.x, gas->at.y / GAS_BRICK + at.y,
                                     gas->at.z / GAS_BRICK + at.z};
    return b.x >= region->low.x && b.x < region->high.x && b.y >= region->low.y &&
           b.y < region->high.y && b.z >= region->low.z && b.z < region->high.z;
}

/* Describes a source: the values that it brings to a cell that lies wholly in it. */
struct gas_brought {
    struct gas_region region; /* bricks of the domain that it reaches */
    float fuel, temperature, smoke;
    float taken; /* part of these that gas takes in a substep */
    float color[3];
    bool blows;
};

/* Works on active bricks between two passes of a step. */
struct gas_hooks {
    void *context;
    /* Adds sources to `now` and `change` of a brick. Returns whether any reaches a cell. NULL:
     * there are none. */
    bool (*add)(void *context, const struct gas_pass *pass, gas_brick_place at);
    /* Describes a source, for passes in GL. False: there are no more. NULL: there are none. */
    bool (*brings)(void *context, uint32_t source, struct gas_brought *brought);
    /* Fills in, for each cell of a brick, the velocity that a source blows with, m/s, and how far
     * the cell lies in it, 0 to 1. Returns whether any does. */
    bool (*reach)(void *context, const struct gas_pass *pass, uint32_t source, gas_brick_place at,
                  float4 *cells);
    /* Moves the walls to the end of the substep, and fills `open` of the finest level. NULL: there
     * are none. False when memory is short. */
    bool (*move_walls)(void *context, struct gas_pass *pass, const struct gas_levels *levels);
};

struct gas_kernels;
struct gas_fields;

struct gas_solver {
    struct kiln_gas *gas;
    struct kiln_threads *threads;
    const struct gas_passes *passes;
    uint32_t window; /* of the gas, that the following are for */
    struct gas_levels levels;
    struct gas_list active, pushed; /* bricks of the window; of the latter, also their neighbours */
    struct gas_found *found;        /* of each active brick */
    bool *sourced;                  /* of each active brick: whether a source reaches a cell */
    bool has_walls, blows;          /* as gas_solver_prepare was told */
    struct gas_rest rest;           /* of the air that a window did not have before */
    bool reached; /* gas_solver_prepare has moved the window: it was `old_cells` at `old_at` */
    struct kiln_gas_place old_at, old_cells; /* old_cells all 0: there was none */
    bool measures;                           /* times are taken */
    double seconds[GAS_TIMERS];              /* of processors */
    double left_over; /* part of the divergence that the last step left, if one was asked for */
    /* The following are for passes on the host. */
    const struct gas_advect *advect;
    const struct gas_faces *faces;
    const struct gas_multigrid *multigrid;
    float *fastest;               /* of each plane */
    struct gas_workspace *spaces; /* of each thread */
    float *idle_changes;          /* memory of the changes of idle bricks; NULL: there are none */
    /* The following are for passes in GL (fields.h). */
    struct gas_kernels *kernels; /* borrowed; NULL: passes run on the host */
    struct gas_fields *fields;
};

enum {
    GAS_IDLE_PLANES = 3,
    GAS_MOST_CYCLES = 4, /* times those that were asked for */
};

/* Initialises a solver for a gas, which is borrowed, as the threads are, and the kernels. kernels:
 * NULL: passes run on the host. False: memory is short. */
bool gas_solver_init(struct gas_solver *solver, struct kiln_gas *gas, struct kiln_threads *threads,
                     enum kiln_simd simd, struct gas_kernels *kernels);
void gas_solver_finish(struct gas_solver *solver);

/* Returns the bytes that solving a window of cells takes, beside the gas itself. */
uint64_t gas_solver_bytes(struct kiln_gas_place cells, bool has_walls, bool blows);

/* Moves the window, and wakes the bricks that have gas, are beside such a brick, or lie in one of
 * the regions. blows: forces also act where there is no gas. */
enum gas_failure gas_solver_prepare(struct gas_solver *solver, const struct gas_region *regions,
                                    uint32_t region_count, bool has_walls, bool blows,
                                    struct kiln_error *error);

/* Lets the groups of ways whose turn comes between two clip times begin anew: what cells carry then
 * came from where it is. */
void gas_solver_begin_ways(struct gas_solver *solver, float start_s, float end_s);

/* Frees what is for the window. */
void gas_solver_free_window(struct gas_solver *solver);

/* Runs a substep. cycles: of the multigrid. residual: part of the divergence that may be left,
 * which takes up to four times as many cycles; 0: as it comes. */
enum gas_failure gas_solver_step(struct gas_solver *solver, struct gas_pass *pass,
                                 const struct gas_hooks *hooks, uint32_t cycles, double residual,
                                 struct kiln_error *error);

/* Finds a cell of the domain with a number that is not finite. False: there is none. */
bool gas_solver_find_wrong(const struct gas_solver *solver, struct kiln_gas_place *cell);

#endif
