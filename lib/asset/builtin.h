/* Procedural flipbooks, made by the program itself and the same on every run. */
#ifndef KILN_ASSET_BUILTIN_H
#define KILN_ASSET_BUILTIN_H

#include "base/thread.h"

enum { KILN_BUILTIN_CELLS = 64 }; /* 8x8 */

/* The name in "builtin:NAME", or NULL when the source of an atlas is a file. */
const char *kiln_builtin_of(const char *source);

/* "fire", "smoke", "spark"; true if there is such a flipbook. */
bool kiln_builtin_exists(const char *name);

/* All names, for messages: NULL past the last. */
const char *kiln_builtin_name(size_t index);

/* Fills KILN_BUILTIN_CELLS cells of edge x edge RGBA floats: x and y of the surface normal (-1..1;
 * up is +y), heat (0..1) and density (0..1), rows from the top, +y of the billboard up. */
void kiln_builtin_generate(const char *name, uint32_t edge, float *cells,
                           struct kiln_threads *threads);

#endif
