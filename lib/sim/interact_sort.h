/* The order of bodies in a grid (shared/interact_staggered.h), on the host. */
#ifndef KILN_SIM_INTERACT_SORT_H
#define KILN_SIM_INTERACT_SORT_H

#include <stddef.h>
#include <stdint.h>

struct kiln_interact_entry {
    uint64_t cell;
    uint32_t what; /* a slot or a body */
    uint32_t unused;
};

/* Sorts by cells; what is in one keeps its order. scratch: as many. */
void kiln_interact_sort(struct kiln_interact_entry *entries, struct kiln_interact_entry *scratch,
                        size_t count);

#endif
