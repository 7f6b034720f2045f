/* The living particles of the chosen systems, listed on the device in order of (system, serial). */
#ifndef KILN_SORT_ALIVE_H
#define KILN_SORT_ALIVE_H

#include "sort/scan.h"
#include "sort/sort.h"

/* What the pairs of the list hold beside the key. */
enum kiln_alive_pairs {
    KILN_ALIVE_ENTRIES, /* the entry; the list itself is not written */
    KILN_ALIVE_PLACES,  /* the place in the list */
};

struct kiln_alive {
    struct kiln_device *device;
    enum kiln_alive_pairs kind;
    GLuint count_program, list_program, pair_program;
    struct kiln_scan scan;
    struct kiln_buffer counts; /* of blocks of slots */
};

/* kiln_alive_finish frees what there is, also when this fails. */
bool kiln_alive_init(struct kiln_alive *alive, struct kiln_device *device,
                     enum kiln_alive_pairs kind, struct kiln_error *error);
void kiln_alive_finish(struct kiln_alive *alive);

/* Lists the living into `list` (room for the pool's slot_count words) and, when ordering by depth,
 * their pairs into `pairs` (room for as many of two words: key, what the kind says); NULL for what
 * is not written. Reads their number back. */
bool kiln_alive_run(struct kiln_alive *alive, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *list,
                    struct kiln_buffer *pairs, uint32_t *count, struct kiln_error *error);

#endif
