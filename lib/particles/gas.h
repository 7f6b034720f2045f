/* A kiln_gas holds the state of a domain of gas: a box of cubic cells through which smoke and fire
 * flow (Heinz 2019, 2.3.2). sim/gas steps it, draw/volume draws it.
 *
 * The cells that are simulated are those of a window in the domain, which follows the gas. Pressure
 * and velocities lie in arrays over the window. What cells carry lies in chunks of a brick of 8^3
 * cells, which only active bricks have: those with gas, and those around them, which it may reach
 * in a step. */
#ifndef KILN_PARTICLES_GAS_H
#define KILN_PARTICLES_GAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/footprint.h"
#include "kiln.h"
#include "shared/gas_layout.h"
#include "shared/platform.h"

enum {
    KILN_MAX_GAS = 4,         /* domains of a scene */
    KILN_MAX_GAS_EDGE = 1024, /* cells along an edge of a domain */
    KILN_GAS_PAD = 8,         /* floats of zeros before and behind the halves of a row */
    KILN_GAS_STRIDE = 16,     /* windows and domains have whole multiples of these cells */
};

struct kiln_gas_place {
    int32_t x, y, z;
};

/* Describes a domain; kiln_scene_gas_shape makes it from a scene. Lengths are in metres of the node
 * that the domain is attached to. */
struct kiln_gas_shape {
    struct kiln_gas_place cells; /* multiples of KILN_GAS_STRIDE */
    float cell;                  /* m: edge of a cell */
    float3 corner;               /* m: the domain's lowest corner */
    bool closed[6];              /* sides through which nothing flows: -x +x -y +y -z +z */
    bool colored;                /* smoke has colours of its own: GAS_COLOR */
    bool detailed;               /* cells carry where their gas came from: GAS_CAME_FROM */
};

/* Holds the chunk of an active brick; NULL for idle ones. Cells follow each other along x, then y,
 * then z. */
struct kiln_gas_brick {
    float *now;    /* GAS_CARRIED floats a cell: the state */
    float *extras; /* the groups of the shape, each with GAS_BRICK_CELLS * 4 floats; or NULL */
    /* The following are for the step that is being computed. */
    float *next_extras;
    float *joined; /* GAS_TRACED floats a cell, in rows of GAS_ROW_CELLS: velocity and `now` */
    float *traced; /* the same, moved along the velocity */
    /* GAS_CHANGE planes of GAS_BRICK_CELLS floats: what forces and the way did to the velocity,
     * m/s. An idle brick has them where forces act. */
    float *change;
    float *chunk; /* holds all of them */
};

/* Says where the newest numbers of the state are, if a technique keeps them beside the host. */
struct kiln_gas_away {
    bool is_newer; /* faces, pressure and what cells carry are as they were some steps ago */
    /* Brings them here. False with KILN_DEVICE_FAILED. */
    bool (*fetch)(void *context, struct kiln_error *error);
    void *context;
};

/* Cell (0, 0, 0) of each array is at its pointer; rows of cells follow each other along x, then y,
 * then z. The value of a face belongs to the cell above it on its axis. The upper faces of the
 * window lie behind its rows. */
struct kiln_gas {
    struct kiln_gas_shape shape;
    struct kiln_gas_place at;     /* the window's lowest cell in the domain; multiples of 16 */
    struct kiln_gas_place cells;  /* of the window; all 0: there is no gas */
    struct kiln_gas_place bricks; /* cells / 8 */
    ptrdiff_t row, plane;         /* floats to the next row and the next plane */
    float *faces[3];              /* m/s: velocity across the lower x, y and z face of each cell */
    float *pressure;              /* of even and odd cells apart: sim/gas/multigrid.h */
    struct kiln_gas_brick *brick; /* of each brick of the window, x fastest */
    uint8_t *has_gas;             /* of each brick */
    uint32_t window;              /* counts the windows that there have been */
    float fastest;                /* m/s: largest velocity across a face, along any axis */
    /* what kiln_gas_keep_smoke needs: the sum of all smoke, and that of smoke times expansion, 1/s,
     * at the end of the step, the sum that should be, and the factor that the next step has on
     * smoke
     */
    double smoke, growth, due;
    float kept;
    struct kiln_gas_away away;
    /* the following are memory */
    float *arrays;      /* of faces, and of pressure */
    float *free_chunks; /* linked by their first words */
    float **slabs;      /* that chunks were cut from */
    uint32_t slab_count;
};

/* Returns the floats from a row of a window, or of a coarser level, to the next. A row keeps pads
 * of zeros, for pressure, whose cells of even x lie before those of odd x. */
static inline ptrdiff_t kiln_gas_row(int32_t cells)
{
    return 2 * (((ptrdiff_t)cells + 15) / 16 * 8 + KILN_GAS_PAD);
}

/* Says which sides of the window nothing flows through: those that are closed sides of the domain.
 * Beyond the others, the pressure is that of the air. */
void kiln_gas_closed(const struct kiln_gas *gas, bool closed[6]);

/* Returns the number of the brick at a place in the window. */
static inline size_t kiln_gas_brick_index(const struct kiln_gas *gas, int32_t x, int32_t y,
                                          int32_t z)
{
    return ((size_t)z * (size_t)gas->bricks.y + (size_t)y) * (size_t)gas->bricks.x + (size_t)x;
}

/* Returns the groups of extra floats that cells carry. */
static inline uint32_t kiln_gas_groups(const struct kiln_gas_shape *shape)
{
    return (shape->colored ? 1u : 0u) + (shape->detailed ? 2u : 0u);
}

/* Returns the number of the group of a kind, GAS_COLOR or GAS_CAME_FROM and the one after it. */
static inline uint32_t kiln_gas_group(const struct kiln_gas_shape *shape, uint32_t kind)
{
    return kind == GAS_CAME_FROM && shape->colored ? 1 : 0;
}

/* Returns the part of its period that a group of GAS_CAME_FROM, 0 or 1, has gone through at a clip
 * time. The step in which this falls sets the ways of the group to 0 before gas moves. */
static inline float kiln_gas_way_phase(uint32_t group, float time_s)
{
    const float periods = time_s * (1.0f / GAS_CAME_FROM_PERIOD) + (group == 0 ? 0.0f : 0.5f);
    return periods - FLOOR(periods);
}

/* Initialises a domain without gas. */
void kiln_gas_init(struct kiln_gas *gas, const struct kiln_gas_shape *shape);
void kiln_gas_finish(struct kiln_gas *gas);

/* Sees to it that the state is on the host. Whoever reads faces, pressure, or what cells carry
 * calls it before: a technique in GL keeps them there. */
bool kiln_gas_fetch(struct kiln_gas *gas, struct kiln_error *error);

/* Moves the window, or makes the first one. What lies in the old window and in the new one is kept;
 * what is new is at rest. The state is then on the host. False when memory is short: the gas then
 * is as before. */
bool kiln_gas_set_window(struct kiln_gas *gas, struct kiln_gas_place at,
                         struct kiln_gas_place cells);

/* Gives a brick of the window a chunk without gas, or takes it back. Taking false: memory is
 * short. A brick that has one keeps it. */
bool kiln_gas_brick_take(struct kiln_gas *gas, struct kiln_gas_brick *brick);
void kiln_gas_brick_free(struct kiln_gas *gas, struct kiln_gas_brick *brick);

/* Returns whether gas can leave the window through a side of a brick, or come near one. */
bool kiln_gas_is_at_opening(const struct kiln_gas *gas, struct kiln_gas_place brick);

/* Interpolation neither keeps the sum of smoke nor loses much of it. Where no smoke leaves, this
 * takes note of the sum that should be, and sets the factor of the next step so that the sum comes
 * to it if interpolation then changes it as much as in this step. Sums are over all cells:
 * moved, after gas has moved; smoke, at the end of the step; growth, of smoke times its expansion.
 */
void kiln_gas_keep_smoke(struct kiln_gas *gas, double moved, double smoke, double growth, float dt,
                         bool leaves);

/* Copies the state, which is on the host, to a domain of the same shape. */
bool kiln_gas_copy(struct kiln_gas *to, const struct kiln_gas *from);

/* Adds the state, which is on the host, to the sums of a state hash. A domain without gas and
 * motion adds nothing. */
void kiln_gas_hash(const struct kiln_gas *gas, uint32_t number, struct kiln_state_hash *hash);

/* Returns the bytes of a window without its chunks, and those of an active brick. */
uint64_t kiln_gas_window_bytes(struct kiln_gas_place cells);
uint64_t kiln_gas_brick_bytes(const struct kiln_gas_shape *shape);

#endif
