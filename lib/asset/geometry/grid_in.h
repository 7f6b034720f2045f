/* Grids of vectors in files: wind. The format is kiln's own. Five lines of text,
 *
 *     kiln-grid 1
 *     size 32 16 32
 *     origin -4 0 -4
 *     spacing 0.25 0.25 0.25
 *     data
 *
 * (samples along x, y and z; where the first lies, and how far apart they are, in metres), are
 * followed by x, y and z of each sample as 32-bit floats, little end first: neighbours along x
 * follow one another, then rows along y, then layers along z.
 */
#ifndef KILN_ASSET_GEOMETRY_GRID_IN_H
#define KILN_ASSET_GEOMETRY_GRID_IN_H

#include <stddef.h>
#include <stdint.h>

#include "asset/loader/loader.h"

enum {
    KILN_MAX_GRID_SAMPLES = 1 << 22, /* of a grid, and of all in a scene */
    KILN_MAX_GRID_EDGE = 1024,       /* samples along an axis */
};

struct kiln_grid_file {
    uint32_t size[3]; /* at least 2 */
    float origin[3];  /* m, within 1e5 */
    float spacing[3]; /* m, 1e-3 to 1e5 */
    float (*samples)[3];
};

/* NULL with an error: KILN_IO when the file cannot be read, KILN_INVALID_INPUT with the line and
 * what was found and is allowed when it is no grid, beyond these limits, cut short or longer than
 * it should be, or a sample is not finite or beyond 1e4; KILN_DEVICE_FAILED when memory is short.
 * The caller destroys it. */
struct kiln_grid_file *kiln_grid_load(struct kiln_loader *loader, const char *path,
                                      struct kiln_error *error);

/* The same from bytes in memory; name stands for the file. */
struct kiln_grid_file *kiln_grid_parse(const void *bytes, size_t size, const char *name,
                                       struct kiln_error *error);
void kiln_grid_destroy(struct kiln_grid_file **grid);

#endif
