/* Counts births by the metre of the ways of emitters. */
#ifndef KILN_SCENE_EMIT_WAY_H
#define KILN_SCENE_EMIT_WAY_H

#include <stdbool.h>

/* The most steps of the ways of all emitters that have births by the metre. */
enum { KILN_MAX_WAY_STEPS = 1 << 24 };

struct kiln_reader;
struct kiln_node;

/* Fills in emit.by_way of all systems with births by the metre, for all steps of the run. Nodes and
 * the clock must have been settled. root is the tree, for the places of errors. */
bool kiln_emit_ways_settle(struct kiln_reader *reader, const struct kiln_node *root);

#endif
