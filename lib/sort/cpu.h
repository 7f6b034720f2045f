/* Technique `cpu` lists and sorts the living particles in host threads. */
#ifndef KILN_SORT_CPU_H
#define KILN_SORT_CPU_H

#include "sort/row.h"

extern const struct kiln_sort_row kiln_sort_cpu_row;

#endif
