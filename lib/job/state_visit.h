/* Declares how the tables of a saved state are visited, and the part of a state that gas has. */
#ifndef KILN_JOB_STATE_VISIT_H
#define KILN_JOB_STATE_VISIT_H

#include "job/pack.h"
#include "particles/gas.h"

/* A visitor is called with each table of a state in the order of the file. It writes, reads or only
 * checks the table. The words of a table are NULL where it is only checked. */
struct kiln_state_visitor {
    bool (*visit)(const struct kiln_state_visitor *visitor, const struct kiln_table *table,
                  struct kiln_error *error);
    struct kiln_threads *threads;
    struct kiln_temporary *out; /* NULL unless tables are written */
    int file;
    const char *path;
};

/* Describes the gas of a domain in the head of a state. Floats are the bits of numbers. */
struct kiln_state_gas {
    uint32_t at[3], cells[3]; /* of the window; all 0: there is none */
    uint32_t groups;          /* of extra floats that cells carry */
    uint32_t bricks;          /* that are active */
    uint32_t fastest, kept;
    uint64_t smoke, growth, due;
};

/* Bytes of such a part of the head. */
enum { KILN_STATE_GAS_HEAD = 10 * 4 + 3 * 8 };

/* Describes a gas. */
struct kiln_state_gas kiln_state_gas_of(const struct kiln_gas *gas);

/* Returns whether a window can be that of a domain. */
bool kiln_state_gas_is_plausible(const struct kiln_state_gas *head);

/* Gives a gas the window that a head describes. Fails with KILN_INVALID_INPUT if the gas is of
 * another domain, or KILN_DEVICE_FAILED when memory is short. */
bool kiln_state_gas_shape(struct kiln_gas *gas, const struct kiln_state_gas *head, const char *path,
                          struct kiln_error *error);

/* Visits the tables of a gas, which is NULL where they are only checked. */
bool kiln_state_gas_visit(const struct kiln_state_visitor *visitor,
                          const struct kiln_state_gas *head, struct kiln_gas *gas,
                          struct kiln_error *error);

#endif
