/* Technique `bitonic` lists the living particles and sorts them with compute shaders by
 * bitonic merges. */
#ifndef KILN_SORT_BITONIC_H
#define KILN_SORT_BITONIC_H

#include "sort/network.h"
#include "sort/row.h"

extern const struct kiln_sort_row kiln_sort_bitonic_row;

struct kiln_bitonic;

/* Returns NULL with an error on failure. */
struct kiln_bitonic *kiln_bitonic_create(struct kiln_device *device, struct kiln_error *error);
void kiln_bitonic_destroy(struct kiln_bitonic **bitonic);

/* Returns the network that lists the living particles and sorts them by bitonic merges. The
 * kiln_bitonic owns it. */
struct kiln_network *kiln_bitonic_network(struct kiln_bitonic *bitonic);

#endif
