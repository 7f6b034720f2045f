/* Describes what the passes of a substep of gas share. */
#ifndef KILN_SIM_GAS_PASS_H
#define KILN_SIM_GAS_PASS_H

#include "particles/gas.h"

/* Bits of a cell in a wall. */
#define GAS_SOLID  1u /* the cell's centre lies in a solid */
#define GAS_SHUT_X 2u /* nothing flows through its lower face across x */
#define GAS_SHUT_Y 4u
#define GAS_SHUT_Z 8u

/* Holds what solids do in a brick that they reach. */
struct gas_wall {
    uint8_t cell[GAS_BRICK_CELLS];
    float open[3][GAS_BRICK_CELLS];  /* part of each lower face that no solid covers, 0..1 */
    float speed[3][GAS_BRICK_CELLS]; /* m/s: of the solid, across the face */
};

/* Forces at the points of a lattice over the window, GAS_LATTICE cells apart; the first point is
 * the window's corner. */
enum { GAS_LATTICE = 2 };

struct gas_lattice {
    const float4 *points;    /* acceleration, m/s^2, and pull, 1/s; NULL: there are no forces */
    uint32_t row, plane;     /* points to the next row and plane */
    float twice_spin[3];     /* 1/s: of the domain, for the Coriolis force */
    float least[3], most[3]; /* m/s: of the velocity of air beyond open sides (new_air.h) */
};

/* Noise that stirs gas where it is. */
struct gas_stir {
    float strength; /* m/s of the step; 0: none */
    float scale;    /* places in the domain, in cells, to places of the noise */
    float rise;     /* of the noise, upwards, in its own unit */
    uint32_t octaves, seed;
};

/* Names cells of an active brick that solids take. */
struct gas_emptied {
    size_t brick;                         /* of the window */
    uint32_t cells[GAS_BRICK_CELLS / 32]; /* a bit for each */
};

struct gas_pass {
    struct kiln_gas *gas;
    const struct kiln_gas_step *step;
    bool closed[6];   /* sides of the window: kiln_gas_closed */
    float *expansion; /* of each cell of active bricks, 1/s, in the order of the faces */
    struct gas_wall *const *walls; /* of each brick of the window, or NULL where it has none; NULL:
                                      there are no solids */
    uint32_t walls_made;           /* grows whenever walls change */
    const struct gas_emptied *emptied; /* after walls have moved */
    size_t emptied_count;
    struct gas_lattice forces;
    struct gas_stir stir;
};

/* Returns the closed sides of the window as bits, side i as 1 << i. */
static inline uint32_t gas_closed_bits(const struct gas_pass *pass)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 6; i++)
        bits |= (uint32_t)pass->closed[i] << i;
    return bits;
}

/* Holds a place of a brick in the window. */
typedef struct kiln_gas_place gas_brick_place;

/* Returns the first cell of a brick of the window in the domain. */
static inline struct kiln_gas_place gas_first_cell(const struct kiln_gas *gas, gas_brick_place at)
{
    return (struct kiln_gas_place){gas->at.x + at.x * GAS_BRICK, gas->at.y + at.y * GAS_BRICK,
                                   gas->at.z + at.z * GAS_BRICK};
}

/* Returns the place of a row of a brick in arrays of a float a cell of the brick. */
static inline ptrdiff_t gas_row_of_brick(int32_t y, int32_t z)
{
    return ((ptrdiff_t)z * GAS_BRICK + y) * GAS_BRICK;
}

/* Returns the place of the first cell of a brick's row in the window's arrays. */
static inline ptrdiff_t gas_row_of_window(const struct kiln_gas *gas, gas_brick_place brick,
                                          int32_t y, int32_t z)
{
    return (brick.z * GAS_BRICK + z) * gas->plane + (brick.y * GAS_BRICK + y) * gas->row +
           (ptrdiff_t)brick.x * GAS_BRICK;
}

#endif
