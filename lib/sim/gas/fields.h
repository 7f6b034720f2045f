/* Keeps the numbers of a domain of gas in GL, while a technique in GL steps it. The host's are then
 * older (kiln_gas_fetch). */
#ifndef KILN_SIM_GAS_FIELDS_H
#define KILN_SIM_GAS_FIELDS_H

#include "shared/gas_kernel.h"
#include "sim/gas/kernels.h"
#include "sim/gas/solver.h"

/* Lists the fields that are kept in GL, each with its label. Those up to F have a part for each
 * cell, or face, of the window. */
#define GAS_FIELDS(X)                                                                              \
    X(FACES, "faces of gas")                                                                       \
    X(CENTRES, "velocities of gas")                                                                \
    X(NOW, "gas")                                                                                  \
    X(AFTER, "gas after a step")                                                                   \
    X(TRACED, "traced gas")                                                                        \
    X(CHANGES, "changes of gas")                                                                   \
    X(EXPANDED, "expansion of gas")                                                                \
    X(EXTRAS, "extras of gas")                                                                     \
    X(NEXT, "traced extras of gas")                                                                \
    X(P, "pressure of gas")                                                                        \
    X(F, "divergence of gas")                                                                      \
    X(TABLES, "diagonals of pressure")                                                             \
    X(OPEN, "open faces of gas")                                                                   \
    X(WALLED, "rows beside walls")                                                                 \
    X(WALLS, "walls of gas")                                                                       \
    X(BRICKS, "bricks of gas")                                                                     \
    X(LISTED, "more lists of gas")                                                                 \
    X(STIRS, "noise of gas")                                                                       \
    X(LATTICE, "forces of gas")                                                                    \
    X(SENT, "sources of gas")                                                                      \
    X(FOUND, "what is found of gas")                                                               \
    X(FASTEST, "speed of gas")                                                                     \
    X(RESIDUALS, "residuals of gas")                                                               \
    X(PARAMS, "parameters of gas")

enum gas_field {
#define GAS_FIELD_NAME(name, label) GAS_FIELD_##name,
    GAS_FIELDS(GAS_FIELD_NAME)
#undef GAS_FIELD_NAME
        GAS_FIELD_COUNT,
};

/* Says where a list of bricks lies in GAS_BIND_BRICKS. */
struct gas_listed {
    uint32_t first, count;
};

struct gas_fields {
    struct gas_kernels *kernels; /* borrowed */
    struct kiln_gas *gas;
    struct kiln_buffer of[GAS_FIELD_COUNT];
    bool is_filled;  /* with the gas of the window */
    uint8_t *awake;  /* of each brick: whether it was active in the substep before */
    uint32_t *words; /* of GAS_BIND_BRICKS */
    struct gas_listed active, stirred, pushed, idle, walled;
    uint32_t walls_made; /* number of the walls that are in GL */
};

/* Prepares for a solver's gas; the buffers are made with its window. */
void gas_fields_init(struct gas_fields *fields, struct gas_kernels *kernels, struct kiln_gas *gas);
void gas_fields_finish(struct gas_fields *fields);

/* Frees what is for a window. What is only in GL is lost. */
void gas_fields_free_window(struct gas_fields *fields);

/* Brings everything that a substep begins with to GL: the gas, if the window is new, the lists of
 * bricks, the walls, the forces and the constants. */
bool gas_fields_begin(struct gas_fields *fields, const struct gas_job *job);

/* Brings the walls of a pass to GL, unless they are there. */
bool gas_fields_send_walls(struct gas_fields *fields, const struct gas_job *job);

/* Sets a group of what cells carry beside to 0. */
void gas_fields_clear_group(struct gas_fields *fields, uint32_t group);

/* Replaces the first bytes of a field, which gets as large as needed. */
bool gas_fields_send(struct gas_fields *fields, enum gas_field field, const void *bytes,
                     size_t size, struct kiln_error *error);

/* Lets a field have at least so many bytes, whatever they are. */
void gas_fields_reserve(struct gas_fields *fields, enum gas_field field, size_t size);

/* Binds a field to a place of shared/gas_kernel.h. written: the kernel writes it. */
bool gas_fields_bind(struct gas_fields *fields, GLuint at, enum gas_field field, bool written,
                     struct kiln_error *error);

/* Tells the gas that the newest numbers are in GL. */
void gas_fields_are_newer(struct gas_fields *fields);

#endif
