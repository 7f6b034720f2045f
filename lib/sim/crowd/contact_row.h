/* Declares a way to find the partners of bodies that collide: a row of the table in interact.c, one
 * for each enum kiln_contact_mode. */
#ifndef KILN_SIM_CROWD_CONTACT_ROW_H
#define KILN_SIM_CROWD_CONTACT_ROW_H

#include "sim/crowd/interact.h"

struct kiln_interact_crowd; /* sim/crowd/interact_crowd.h */

struct kiln_contact_row {
    /* Whether pairs are found before they meet, so that the velocities of a step decide how far
     * ahead is searched. */
    bool looks_ahead;
    bool uses_cells; /* bodies are sorted into cells, in GL by kiln_interact_gl_into_cells */

    /* On the host. sort fills bodies and count of a crowd. find is a loop of kiln_threads_for over
     * the bodies of the crowd, its context, and calls crowd_note for each. */
    bool (*sort)(struct kiln_interact_crowd *crowd, struct kiln_interact *interact,
                 struct kiln_error *error);
    void (*find)(void *context, size_t begin, size_t end, uint32_t worker);

    /* In GL: the kernels that no other way uses, whose programs are contact_programs of struct
     * kiln_interact. sort_gl sorts the bodies, whose buffers are bound but for entries and order,
     * and sets *find to the program that finds partners. */
    struct kiln_interact_file files[KILN_CONTACT_PROGRAMS];
    bool (*sort_gl)(struct kiln_interact *interact, const struct kiln_interact_params *params,
                    GLuint *find, struct kiln_error *error);
};

/* Returns the row of a mode. */
const struct kiln_contact_row *kiln_contact_row(enum kiln_contact_mode mode);

extern const struct kiln_contact_row kiln_contact_exact_row; /* exact.c */

#endif
