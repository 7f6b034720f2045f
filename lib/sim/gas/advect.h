/* Declares the passes over bricks of gas, for every level of vectors. */
#ifndef KILN_SIM_GAS_ADVECT_H
#define KILN_SIM_GAS_ADVECT_H

#include "base/simd.h"
#include "sim/gas/pass.h"

enum {
    /* cells along an edge of a block: those of a brick, and as far around it as gas moves in a
     * step; one more, since a value is mixed from a cell and the next */
    GAS_EDGE = 2 * GAS_MOST_CELLS + GAS_BRICK + 1,
    GAS_EDGE_ROW = 16, /* floats of a row of a plane of a block */
    GAS_EDGE_CELLS = GAS_EDGE * GAS_EDGE * GAS_EDGE,
    GAS_BLOCK_FLOATS = (GAS_EDGE_CELLS + GAS_EDGE_ROW - GAS_EDGE) * GAS_TRACED,
    GAS_STIR_EDGE = GAS_BRICK / GAS_LATTICE + 1, /* points of a lattice along a brick */
    GAS_STIR_ROW = 8,
};

/* Holds what a thread needs to work on a brick. */
struct gas_workspace {
    _Alignas(64) float now[GAS_BLOCK_FLOATS];
    _Alignas(64) float traced[GAS_BLOCK_FLOATS];
    _Alignas(64) float velocity[3][GAS_EDGE][GAS_EDGE][GAS_EDGE_ROW];
    _Alignas(64) float way[3][GAS_BRICK][GAS_BRICK][GAS_BRICK];          /* cells in the step */
    _Alignas(64) float spin[GAS_BRICK + 2][GAS_BRICK + 2][GAS_EDGE_ROW]; /* length of vorticity */
    _Alignas(64) float noise[3][GAS_STIR_EDGE][GAS_STIR_EDGE][GAS_STIR_ROW];
    _Alignas(64) float extras[GAS_EDGE_CELLS * GAS_CARRIED];
    uint8_t wall[GAS_EDGE_CELLS];            /* GAS_SOLID, GAS_SHUT_*: of a block */
    uint8_t near_wall[GAS_BRICK][GAS_BRICK]; /* z, y: a bit for each cell of the row */
};

/* Holds points of curl noise, and the noise there. */
struct gas_points {
    uint32_t count;
    _Alignas(64) float place[3][GAS_BRICK_CELLS];
    _Alignas(64) float noise[3][GAS_BRICK_CELLS];
};

/* Says what a brick has at the end of a step. */
struct gas_found {
    bool has_gas;
    bool is_wrong; /* a number is not finite */
    /* sums over the brick's cells: */
    double moved;  /* smoke, after the gas has moved */
    double left;   /* smoke, at the end */
    double growth; /* smoke times the expansion, 1/s */
};

struct gas_advect {
    /* Fills the joined cells of a brick. */
    void (*join)(const struct gas_pass *pass, gas_brick_place at);
    /* Traces a brick's cells back: fills `traced` and `next_extras`. Every active brick must have
     * been joined. */
    void (*trace)(const struct gas_pass *pass, gas_brick_place at, struct gas_workspace *space);
    /* Corrects what `trace` found, burns and pushes: fills `now`, `change` and the expansion. Every
     * active brick must have been traced. */
    struct gas_found (*react)(const struct gas_pass *pass, gas_brick_place at,
                              struct gas_workspace *space);
    /* Fills the change of an idle brick: what forces do to its air. */
    void (*blow)(const struct gas_pass *pass, gas_brick_place at, struct gas_workspace *space);
    /* Computes the noise of points. */
    void (*noise)(struct gas_points *points, uint32_t seed, uint32_t octaves);
};
KILN_SIMD_DECLARE(const struct gas_advect, kiln_gas_advect);

#endif
