/* Reads grids of vectors, such as wind, from files in kiln's own format. A file starts with five
 * lines of text,
 *
 *     kiln-grid 1
 *     size 32 16 32
 *     origin -4 0 -4
 *     spacing 0.25 0.25 0.25
 *     data
 *
 * which are the number of samples along x, y and z, the place of the first sample, and the distance
 * between samples, in metres. Then follow x, y and z of each sample as little-endian 32-bit floats:
 * neighbours along x follow one another, then rows along y, then layers along z. */
#ifndef KILN_ASSET_GEOMETRY_GRID_IN_H
#define KILN_ASSET_GEOMETRY_GRID_IN_H

#include <stddef.h>
#include <stdint.h>

#include "asset/loader/loader.h"

enum {
    KILN_MAX_GRID_SAMPLES = 1 << 22, /* samples of a grid, and of all grids in a scene */
    KILN_MAX_GRID_EDGE = 1024,       /* samples along an axis */
};

struct kiln_grid_file {
    uint32_t size[3]; /* samples along x, y and z; at least 2 */
    float origin[3];  /* m, within 1e5 */
    float spacing[3]; /* m, 1e-3 to 1e5 */
    float (*samples)[3];
};

/* Reads a grid. NULL with an error: KILN_IO when the file cannot be read; KILN_INVALID_INPUT, with
 * the line, what was found and what is allowed, when it is no grid, is beyond the limits, cut short
 * or too long, or a sample is not finite or beyond 1e4; KILN_DEVICE_FAILED when memory is short.
 * The caller destroys the grid. */
struct kiln_grid_file *kiln_grid_load(struct kiln_loader *loader, const char *path,
                                      struct kiln_error *error);

/* Reads a grid from bytes in memory; name stands for the file in messages. */
struct kiln_grid_file *kiln_grid_parse(const void *bytes, size_t size, const char *name,
                                       struct kiln_error *error);
void kiln_grid_destroy(struct kiln_grid_file **grid);

#endif
