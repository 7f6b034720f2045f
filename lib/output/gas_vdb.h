/* Writes a domain of gas as an OpenVDB file (output/vdb.h) of these grids:
 *   density      smoke, as in the domain
 *   temperature  kelvin by the look of the domain, or from 0 to 1
 *   flame        0 to 1
 *   vel          m/s in the axes of the file, at the middle of voxels, in voxels with one of the
 *                others and in those beside them
 *   Cd           the linear colour of the smoke, where there is density; only of a domain whose
 * smoke has colours of its own Voxels are the cells of the domain, and a brick is a leaf. Indices
 * count from the domain's lowest corner, so that they do not change while its window moves. */
#ifndef KILN_OUTPUT_GAS_VDB_H
#define KILN_OUTPUT_GAS_VDB_H

#include "output/vdb.h"
#include "particles/gas.h"
#include "scene/node.h"

/* What is written of a domain at a moment. */
struct kiln_gas_vdb {
    const struct kiln_gas *gas;
    const struct kiln_gas_shape *shape;  /* of the domain */
    const struct kiln_node_frame *frame; /* of the node that has the domain; NULL: the world */
    bool z_up;          /* the axes of the file are x, -z, y of the world, else x, y, z */
    bool half;          /* values are halves, else floats */
    bool kelvin;        /* temperatures are in kelvin */
    float kelvin_of[2]; /* K: at temperature 0 and 1 */
    float cutoff;       /* a voxel with less density, temperature (0 to 1) or flame has none */
    double extinction;  /* 1/m at density 1, for the metadata */
    float albedo[3];    /* of smoke without a colour of its own, linear */
    const struct kiln_vdb_meta *metas; /* of the file */
    size_t meta_count;
    char uuid[37];
};

/* Writes the file; the caller commits it. A domain without gas gives a file with empty grids.
 * *voxels becomes the number of active voxels of the density. Errors are those of
 * kiln_vdb_write. */
bool kiln_gas_vdb_write(const struct kiln_gas_vdb *params, struct kiln_temporary *file,
                        struct kiln_threads *threads, const struct kiln_caller *caller,
                        uint64_t *voxels, struct kiln_error *error);

#endif
