/* Writes OpenVDB files of version 224, the format of OpenVDB 6.2 to 12. Words are those of OpenVDB:
 * a grid is a sparse field, whose tree has leaves of 8^3 voxels; the active voxels of a leaf have
 * values, all others have the background, 0; the map takes voxel indices to places in the world. */
#ifndef KILN_OUTPUT_VDB_H
#define KILN_OUTPUT_VDB_H

#include "base/temporary.h"
#include "base/thread.h"

enum {
    KILN_VDB_LEAF = 8,          /* voxels along an edge of a leaf */
    KILN_VDB_LEAF_VOXELS = 512, /* voxels of a leaf */
    KILN_VDB_LEAVES = 512,      /* leaves along an axis that a grid may have */
    KILN_VDB_MOST_COMPONENTS = 3,
};

/* A leaf. Voxel (x, y, z) of a leaf has the number x * 64 + y * 8 + z. */
struct kiln_vdb_leaf {
    uint16_t at[3];   /* index of the lowest voxel / 8: below KILN_VDB_LEAVES */
    uint32_t item;    /* number of the caller's */
    uint64_t mask[8]; /* bit n % 64 of word n / 64 says whether voxel n is active; not all are 0 */
};

enum kiln_vdb_type { KILN_VDB_STRING, KILN_VDB_INT32, KILN_VDB_DOUBLE, KILN_VDB_VEC3S };

/* An entry of the metadata of a file or grid. */
struct kiln_vdb_meta {
    const char *name;
    enum kiln_vdb_type type;
    const char *text; /* string */
    int32_t integer;  /* int32 */
    double number;    /* double */
    float vector[3];  /* vec3s */
};

struct kiln_vdb_grid {
    const char *name;
    uint32_t components;               /* 1: float; 3: vec3s */
    const struct kiln_vdb_meta *metas; /* at most 32 KiB in all */
    size_t meta_count;
    struct kiln_vdb_leaf *leaves; /* in any order, each place once; kiln_vdb_write sorts them */
    size_t leaf_count;
    /* Fills in the values of all voxels of a leaf, the components of a voxel together. It is called
     * on any thread, on several at once. */
    void (*fill)(const void *source, const struct kiln_vdb_leaf *leaf, float *values);
    const void *source;
};

/* The map of all grids of a file: an index (x, y, z) lies at x * axes[0] + y * axes[1] + z *
 * axes[2]
 * + origin. Values stand at whole indices. */
struct kiln_vdb_map {
    double axes[3][3];
    double origin[3];
};

struct kiln_vdb {
    char uuid[37]; /* of the file, in the form of RFC 9562 */
    const struct kiln_vdb_meta *metas;
    size_t meta_count;
    struct kiln_vdb_map map;
    bool half; /* values are written as halves (output/half.h), else as floats */
    struct kiln_vdb_grid *grids;
    size_t grid_count;
};

/* Writes a file; the caller commits it. The same content gives the same bytes, for any number of
 * threads (NULL: the calling thread alone). Asks the caller (which may be NULL) now and then
 * whether to go on. KILN_DEVICE_FAILED when memory is short; KILN_IO, KILN_OVER_LIMIT. */
bool kiln_vdb_write(struct kiln_vdb *vdb, struct kiln_temporary *file, struct kiln_threads *threads,
                    const struct kiln_caller *caller, struct kiln_error *error);

#endif
