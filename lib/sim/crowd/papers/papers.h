/* Declares the ways to find partners that no scene takes unless it asks for them. They are there to
 * be compared with the papers that describe them. */
#ifndef KILN_SIM_CROWD_PAPERS_H
#define KILN_SIM_CROWD_PAPERS_H

#include "sim/crowd/contact_row.h"

extern const struct kiln_contact_row kiln_contact_staggered_row; /* staggered.c */

#endif
