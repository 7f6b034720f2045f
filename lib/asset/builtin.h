/* Procedural flipbooks, made by the program itself and the same on every machine. */
#ifndef KILN_ASSET_BUILTIN_H
#define KILN_ASSET_BUILTIN_H

#include "asset/film.h"
#include "base/thread.h"

/* The name in "builtin:NAME", or NULL when the source of an atlas is a file. */
const char *kiln_builtin_of(const char *source);

/* "fire", "smoke", "spark"...; true if there is such a flipbook. */
bool kiln_builtin_exists(const char *name);

/* All names, for messages: NULL past the last. */
const char *kiln_builtin_name(size_t index);

/* The gas of a flipbook, which the caller frees: *film stays NULL for one in which nothing flows.
 * False when memory is short. Threads may make films side by side: they are the slow part. */
bool kiln_builtin_film(const char *name, uint32_t cell_count, struct kiln_film **film);

/* Fills cell_count cells of edge x edge RGBA floats: x and y of the surface normal (-1..1; up is
 * +y), heat (0..1) and density (0..1), rows from the top, +y of the billboard up. The first cell is
 * the particle's birth, the last its death. film: of this name and count. */
void kiln_builtin_generate(const char *name, uint32_t cell_count, uint32_t edge,
                           const struct kiln_film *film, float *cells,
                           struct kiln_threads *threads);

/* Fills as many cells of edge x edge pairs: the way from this cell to the next of what is there
 * halfway, in edges of the cell, x to the right and y up. */
void kiln_builtin_motion(const struct kiln_film *film, uint32_t edge, float *motion);

#endif
