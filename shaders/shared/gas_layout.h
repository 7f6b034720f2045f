/* Defines what a domain of gas has in memory, for C and GLSL.
 *
 * A domain is a box of cubic cells. Its units of activity are bricks of 8^3 cells. A face between
 * two cells has the velocity across it; a cell carries quantities, in groups of four floats. */
#ifndef KILN_SHARED_GAS_LAYOUT_H
#define KILN_SHARED_GAS_LAYOUT_H

#include "shared/platform.h"

#define GAS_BRICK       8   /* cells along an edge of a brick */
#define GAS_BRICK_CELLS 512 /* GAS_BRICK^3 */

/* What every cell carries. */
#define GAS_SMOKE       0 /* density, of any unit: the look has its extinction per metre */
#define GAS_TEMPERATURE 1 /* 0: that of the air; 1: the hottest that the look shows */
#define GAS_FUEL        2 /* part of the cell that is unburnt fuel */
#define GAS_FLAME       3 /* 1 where fuel has just burnt, 0 after the life of a flame */
#define GAS_CARRIED     4

/* What cells carry beside, in groups of four floats, each of a domain that uses it. */
#define GAS_COLOR     0 /* linear red, green and blue times an amount, and the amount */
#define GAS_CAME_FROM 1 /* two groups: way in metres from where the gas was, and 0 */

/* Seconds after which a group of GAS_CAME_FROM begins anew, since ways tangle. */
#define GAS_CAME_FROM_PERIOD 0.8f

#define GAS_TRACED     8 /* floats of a traced cell: velocity, 0, and what it carries */
#define GAS_CARRIED_AT 4 /* place of the latter */
#define GAS_CHANGE     3 /* planes of a brick's change of velocity */
#define GAS_ROW_CELLS  9 /* cells of a row of joined or traced cells, one of the next brick */

/* Gas moves at most this many cells in a step along each axis, so that a step of a brick reads its
 * nearest neighbours only. */
#define GAS_MOST_CELLS 2

/* A brick has gas if it has more than this anywhere. */
#define GAS_LEAST_SMOKE 0.002f
#define GAS_LEAST_HEAT  0.01f

/* Holds the constants of one step. Times are in seconds, lengths in cells where a comment says so,
 * else in metres. */
struct kiln_gas_step {
    float dt;               /* s */
    float cell;             /* m: edge of a cell */
    float cells_a_velocity; /* dt / cell: cells that a velocity of 1 m/s moves in the step */
    float4 rise;            /* m/s of the step at temperature 1, in the axes of the domain */
    float4 sink;            /* m/s of the step at smoke 1 */
    float slow;             /* factor of velocities: what drag leaves of them */
    float ignition;         /* temperature above which fuel burns */
    float burnt;            /* part of the fuel that burns in the step */
    float heat;             /* temperature that burning all of a cell's fuel adds */
    float soot;             /* smoke that it adds */
    float expand;           /* volumes of gas that it adds */
    float expansion;        /* expand / dt */
    float flame_fade;       /* flame that goes out in the step */
    float flame_gain;       /* flame for each part of fuel that burns in the step */
    float smoke_left;       /* factor of smoke in the step */
    float smoke_burnt;      /* part of the smoke that a flame of 1 burns in the step */
    float cool;             /* dt times the rate of cooling by radiation, at temperature 1 */
    float cool_even;        /* temperature that is lost in the step, at any temperature */
    float hottest;          /* greatest temperature */
    float confinement;      /* m/s of the step for each 1/s of vorticity */
    float smoothing;        /* part of the velocity's Laplacian that is added */
    uint keep_velocity;     /* 1: a corrected velocity that overshoots is given up; 0: clamped */
};

#endif
