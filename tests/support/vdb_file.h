/* Reads OpenVDB files of the kind that kiln writes (version 224, without zlib), by code of its own,
 * so that tests can compare all of their content. What does not have the form of such a file fails
 * the test. */
#ifndef KILN_TESTS_VDB_FILE_H
#define KILN_TESTS_VDB_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { VDB_MOST_GRIDS = 8 };

struct vdb_leaf {
    int32_t at[3]; /* its lowest voxel */
    uint64_t mask[8];
    float *values; /* of the active voxels in their order, the components of one together */
};

struct vdb_grid {
    char name[64], type[64], map[64];
    char metas[1024]; /* each as "name=value;", in the order of the file */
    uint32_t components;
    bool half;
    double axes[3][3],
        origin[3]; /* of the map: what an index step adds, and the place of index 0 */
    struct vdb_leaf *leaves;
    size_t leaf_count;
    uint64_t voxels; /* active ones */
};

struct vdb_file {
    char uuid[37], metas[1024];
    struct vdb_grid grids[VDB_MOST_GRIDS];
    uint32_t grid_count;
};

void vdb_file_read(struct vdb_file *vdb, const char *path);
void vdb_file_free(struct vdb_file *vdb);

/* Returns the grid of a name, which must be there. */
const struct vdb_grid *vdb_file_grid(const struct vdb_file *vdb, const char *name);

/* Returns the values of an active voxel, or NULL for one that is not active. */
const float *vdb_grid_at(const struct vdb_grid *grid, int32_t x, int32_t y, int32_t z);

#endif
