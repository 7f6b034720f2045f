/* A kiln_alive lists the living particles of the chosen systems on the device, in order of (system,
 * serial). */
#ifndef KILN_SORT_ALIVE_H
#define KILN_SORT_ALIVE_H

#include "sort/scan.h"
#include "sort/sort.h"

/* Selects the second word of each pair. The first word is the key. */
enum kiln_alive_pairs {
    KILN_ALIVE_ENTRIES, /* the draw entry; the list itself is not written */
    KILN_ALIVE_INDICES, /* the index of the draw entry in the list */
};

struct kiln_alive {
    struct kiln_device *device;
    enum kiln_alive_pairs kind;
    GLuint count_program, list_program, pair_program;
    struct kiln_scan scan;
    struct kiln_buffer counts; /* living particles of each block of slots */
};

/* Returns false with an error on failure. kiln_alive_finish frees all resources, also after a
 * failure. */
bool kiln_alive_init(struct kiln_alive *alive, struct kiln_device *device,
                     enum kiln_alive_pairs kind, struct kiln_error *error);
void kiln_alive_finish(struct kiln_alive *alive);

/* Writes the draw entries of the living particles to `list` (room for the pool's slot_count words)
 * and, for an order by depth, their pairs to `pairs` (room for slot_count pairs of two words: the
 * key and the word that the kind selects). A buffer that is NULL is not written. Reads the number
 * of living particles back into count. */
bool kiln_alive_run(struct kiln_alive *alive, struct kiln_pool *pool,
                    const struct kiln_sort_params *params, struct kiln_buffer *list,
                    struct kiln_buffer *pairs, uint32_t *count, struct kiln_error *error);

#endif
