/* A kiln_alive lists the living particles of the chosen systems on the device, in order of (system,
 * serial). */
#ifndef KILN_SORT_ALIVE_H
#define KILN_SORT_ALIVE_H

#include "sort/scan.h"
#include "sort/sort.h"

/* Names the second word of each pair of the list, beside the key. */
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

/* Returns false with an error; kiln_alive_finish frees what was made, also then. */
bool kiln_alive_init(struct kiln_alive *alive, struct kiln_device *device,
                     enum kiln_alive_pairs kind, struct kiln_error *error);
void kiln_alive_finish(struct kiln_alive *alive);

/* Writes the living into `list` (room for the pool's slot_count words) and, when ordering by depth,
 * their pairs into `pairs` (room for as many pairs of two words: the key and what the kind says);
 * NULL for a buffer that is not written. Reads the number of the living back. */
bool kiln_alive_run(struct kiln_alive *alive, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *list,
                    struct kiln_buffer *pairs, uint32_t *count, struct kiln_error *error);

#endif
