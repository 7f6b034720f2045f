/* Declares the techniques of the sort stage that `auto` never takes. They are there to be compared
 * with the papers that describe them. */
#ifndef KILN_SORT_PAPERS_H
#define KILN_SORT_PAPERS_H

#include "sort/row.h"

extern const struct kiln_sort_row kiln_sort_oddeven_row; /* odd-even merges: oddeven.c */
extern const struct kiln_sort_row kiln_sort_spread_row;  /* the same over frames: spread.c */

#endif
