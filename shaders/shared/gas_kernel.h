/* Defines what the kernels of gas (shaders/sim/gas) get from the host, and where: binding points,
 * locations of uniforms and a block of parameters.
 *
 * Arrays over cells have the cells of a brick one after another, and bricks in the order of the
 * window: cell c of brick b is at b * GAS_BRICK_CELLS + c. Faces, pressure and its right side lie
 * as on the host (lib/particles/gas.h, lib/sim/gas/multigrid.h). */
#ifndef KILN_SHARED_GAS_KERNEL_H
#define KILN_SHARED_GAS_KERNEL_H

#include "shared/gas_layout.h"

/* Invocations of a work group. */
#define GAS_GROUP_SIZE     64
#define GAS_COARSEST_GROUP 128

/* A uniform block. */
#define GAS_BIND_PARAMS 0

/* Storage blocks. Some share a place, since no kernel needs both. */
#define GAS_BIND_BRICKS   0 /* flags of each brick of the window, then lists of bricks */
#define GAS_BIND_FACES    1
#define GAS_BIND_CENTRES  2 /* velocity of each cell */
#define GAS_BIND_NOW      3 /* what each cell carries */
#define GAS_BIND_TRACED   4 /* two words a cell: velocity and GAS_NEAR_*; what it carries */
#define GAS_BIND_CHANGES  5 /* of each cell's velocity, and the smoke that it had after it moved */
#define GAS_BIND_EXTRAS   6 /* GAS_CARRIED floats of each group of a brick's cells */
#define GAS_BIND_NEXT     7 /* extras at the end of the step */
#define GAS_BIND_WALLS    8
#define GAS_BIND_STIRS    9  /* spins and noise of the bricks that are stirred */
#define GAS_BIND_LATTICE  10 /* of forces */
#define GAS_BIND_SENT     10 /* from the host: velocities and parts of sources; cells to empty */
#define GAS_BIND_FOUND    11 /* to the host */
#define GAS_BIND_EXPANDED 12 /* expansion of each cell */
#define GAS_BIND_P        4
#define GAS_BIND_F        5
#define GAS_BIND_TABLES   6 /* the diagonals of pressure, and their inverses */
#define GAS_BIND_OPEN     7 /* open parts of faces, of all levels */
#define GAS_BIND_WALLED   9 /* rows of cells beside walls, of all levels */
#define GAS_BINDINGS      13

/* Locations of uniforms. */
#define GAS_AT_FIRST 0 /* entry of the list of bricks that a dispatch begins with */
#define GAS_AT_COUNT 1 /* invocations, or bricks, that it has */
#define GAS_AT_SOURCE                                                                              \
    2 /* two words: what a source brings: fuel, temperature, smoke, part; and its                  \
         colour, and 1 if it blows */
#define GAS_AT_FOUND  2 /* place of the first result */
#define GAS_AT_LEVEL  2 /* four words: struct level of pressure.glsl */
#define GAS_AT_OTHER  6 /* four words: the coarser level */
#define GAS_AT_COLOR  10
#define GAS_AT_SWEEPS 11

/* Flags of a brick; the number of its wall, from 1, lies above them, 0: it has none. */
#define GAS_IS_ACTIVE  1u
#define GAS_HAS_CHANGE 2u /* it is active, or forces act in it */
#define GAS_WALL_SHIFT 2u

/* A list of bricks has two words for each: the number of the brick in the window, and another
 * number: in the lists of active and of stirred bricks that of its spins and noise, from 1, 0: it
 * is not stirred; in the list of bricks that a source reaches, where its part of GAS_BIND_SENT
 * begins. */

/* A wall has a word of bits for each cell (GAS_SOLID and so on of lib/sim/gas/pass.h), then, for
 * each axis, the open parts of the cells' lower faces, then the speeds across them. */
#define GAS_WALL_WORDS (7 * GAS_BRICK_CELLS)
#define GAS_WALL_SOLID 1u
#define GAS_WALL_SHUT  2u /* << axis */

/* In the fourth float of a traced velocity: how gas beside walls is treated. */
#define GAS_NEAR_WALL 1.0f
#define GAS_IN_WALL   2.0f

/* The lengths of vorticity of a stirred brick and one cell around it, and its lattice of noise. */
#define GAS_SPIN_EDGE    10
#define GAS_SPINS        1000
#define GAS_NOISE_EDGE   5
#define GAS_NOISE_POINTS 125
#define GAS_NOISE_FLOATS 375
#define GAS_STIR_FLOATS  1375

/* A column of a brick, its cells of one x, has four words of results: a sum of these flags, the
 * smoke after it moved, the smoke at the end, and the smoke times its expansion. */
#define GAS_FOUND_GAS   1u
#define GAS_FOUND_WRONG 2u

/* The most cells of the coarsest level of pressure that one work group relaxes. */
#define GAS_COARSEST_CELLS 2048

struct kiln_gas_kernel {
    S(kiln_gas_step) step;
    float4 turn;        /* 1/s: twice the spin of the domain; w: strength of the noise, m/s */
    float4 stir;        /* of the noise: scale, rise; its octaves and its seed are below */
    float4 least, most; /* m/s: of the velocity of air beyond open sides */
    uint bricks_x, bricks_y, bricks_z, groups;
    uint at_x, at_y, at_z, first_way; /* cells: of the window; group that the ways begin with */
    uint row, plane, face, faces; /* of arrays of faces: strides, the first cell, a whole array */
    uint closed;                  /* a bit for each side */
    uint has_forces, lattice_row, lattice_plane;
    uint octaves, seed, unused_a, unused_b;
};

#endif
