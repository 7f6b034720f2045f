/* Makes the procedural flipbooks, which are built into the program and the same on every machine.
 */
#ifndef KILN_ASSET_ATLAS_BUILTIN_H
#define KILN_ASSET_ATLAS_BUILTIN_H

#include "asset/atlas/film.h"

/* The name in "builtin:NAME", or NULL when the source of an atlas is a file. */
const char *kiln_builtin_of(const char *source);

/* "fire", "smoke", "spark"...; true if there is such a flipbook. */
bool kiln_builtin_exists(const char *name);

/* Whether the flipbook of that name is of gas, whose motion from cell to cell is known. */
bool kiln_builtin_flows(const char *name);

/* All names, for messages: NULL past the last. */
const char *kiln_builtin_name(size_t index);

/* A flipbook of cell_count cells. */
struct kiln_builtin {
    const char *name;
    uint32_t cell_count;
    enum kiln_simd simd;    /* that makes it; the bytes are the same */
    struct kiln_film *film; /* its gas, NULL when nothing flows */
};

/* Makes its gas. False for an unknown name, and when memory is short. Threads may open flipbooks
 * side by side. */
bool kiln_builtin_open(struct kiln_builtin *builtin, const char *name, uint32_t cell_count,
                       enum kiln_simd simd);
void kiln_builtin_close(struct kiln_builtin *builtin);

/* What a thread needs to make cells, the one after the other; NULL when memory is short, and freed
 * with free(). */
struct kiln_builtin_room *kiln_builtin_room(void);

/* Fills edge x edge RGBA floats: x and y of the surface normal (-1..1; up is +y), heat (0..1) and
 * density (0..1), rows from the top, +y of the billboard up. The first cell is the particle's
 * birth, the last its death. edge: at most KILN_FLUID_FINEST. */
void kiln_builtin_cell(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                       struct kiln_builtin_room *room, float *pixels);

/* Fills edge x edge pairs: the way from this cell to the next of what is there halfway, in edges of
 * the cell, x to the right and y up. Only for what flows. */
void kiln_builtin_motion(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                         struct kiln_builtin_room *room, float *motion);

#endif
