/* Makes the procedural flipbooks, which are built into the program and the same on every machine.
 */
#ifndef KILN_ASSET_ATLAS_BUILTIN_H
#define KILN_ASSET_ATLAS_BUILTIN_H

#include "asset/atlas/film.h"

/* Returns the name in "builtin:NAME", or NULL when the source of an atlas is a file. */
const char *kiln_builtin_name_of(const char *source);

/* Returns whether there is a built-in flipbook of a name such as "fire", "smoke" or "spark". */
bool kiln_builtin_exists(const char *name);

/* Returns whether the flipbook of a name shows gas, whose motion from cell to cell is known. */
bool kiln_builtin_has_motion(const char *name);

/* Returns the names by index, for messages; NULL behind the last. */
const char *kiln_builtin_name_at(size_t index);

/* Returns the bytes of a flipbook that is open; 0 for an unknown name. */
uint64_t kiln_builtin_bytes(const char *name, uint32_t cell_count);

/* Describes a flipbook of cell_count cells. */
struct kiln_builtin {
    const char *name;
    uint32_t cell_count;
    /* level of vectors that makes the cells; the bytes are the same at every level */
    enum kiln_simd simd;
    struct kiln_film *film; /* the gas that the cells show; NULL when there is none */
};

/* Opens a flipbook and makes its gas. False for an unknown name, and when memory is short. Several
 * threads may open flipbooks at once. */
bool kiln_builtin_open(struct kiln_builtin *builtin, const char *name, uint32_t cell_count,
                       enum kiln_simd simd);
void kiln_builtin_close(struct kiln_builtin *builtin);

/* Allocates the memory in which a thread makes cells one after another. NULL when memory is short.
 * The caller frees it with free(). */
struct kiln_builtin_scratch *kiln_builtin_scratch_create(void);

/* Fills edge x edge RGBA floats: x and y of the surface normal (-1..1; up is +y), heat (0..1) and
 * density (0..1), rows from the top, +y of the billboard up. The first cell shows the particle at
 * birth, the last at death. edge: at most KILN_FLUID_FINEST. */
void kiln_builtin_cell(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                       struct kiln_builtin_scratch *scratch, float *pixels);

/* Fills edge x edge pairs with the motion from this cell to the next, in edges of the cell, x to
 * the right and y up. The motion at a place is that of the gas which is there halfway between the
 * two cells. Only for flipbooks of gas. */
void kiln_builtin_motion(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                         struct kiln_builtin_scratch *scratch, float *motion);

#endif
