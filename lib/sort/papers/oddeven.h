/* Technique `oddeven` lists the living particles and sorts them in compute by odd-even merges, all
 * at once. spread.c divides the passes over frames. */
#ifndef KILN_SORT_PAPERS_ODDEVEN_H
#define KILN_SORT_PAPERS_ODDEVEN_H

#include "sort/network.h"

struct kiln_oddeven;

/* Returns NULL with an error on failure. */
struct kiln_oddeven *kiln_oddeven_create(struct kiln_device *device, struct kiln_error *error);
void kiln_oddeven_destroy(struct kiln_oddeven **oddeven);

/* Returns the network that lists the living particles and sorts them all at once. The kiln_oddeven
 * owns it. */
struct kiln_network *kiln_oddeven_network(struct kiln_oddeven *oddeven);

/* Returns the number of passes that sort `padded` pairs, a power of two. */
uint32_t kiln_oddeven_passes(uint32_t padded);

/* Runs the passes with the numbers first .. end - 1 over the pairs bound to SORT_BIND_PAIRS. */
void kiln_oddeven_run_passes(struct kiln_oddeven *oddeven, uint32_t padded, uint32_t first,
                             uint32_t end);

#endif
