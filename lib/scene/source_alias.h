/* Fills the table of Walker's alias method, by which one of many cells is chosen in one step. */
#ifndef KILN_SCENE_SOURCE_ALIAS_H
#define KILN_SCENE_SOURCE_ALIAS_H

#include <stdbool.h>
#include <stdint.h>

/* One cell of the table: it is taken in its share of its turns, and `other` in the rest. */
struct kiln_alias {
    float share; /* 0 to 1 */
    uint32_t other;
};

/* The bytes that filling takes for a cell, the table and the weights included. */
enum { KILN_ALIAS_BYTES = 28 };

/* Fills the table for weights that are finite and not negative, whose sum is above 0. A cell of
 * weight 0 is never taken. Returns false when memory is short. */
bool kiln_alias_fill(const double *weights, uint32_t count, struct kiln_alias *table);

#endif
