/* Writes OpenVDB files: the layout that openvdb/io/Archive.cc, tree/ and math/Maps.h of OpenVDB 10
 * read. The writer is kiln's own. OpenVDB as a library is a helper of C++ with Boost, TBB, Blosc
 * and Imath, 30 MB of packages that few jobs need, whose files differ by its version and carry a
 * random number; the part of the format that gas needs is this file, and its bytes are the same on
 * every machine.
 *
 * Values are packed by the masks of active voxels (COMPRESS_ACTIVE_MASK) and not by zlib. Zlib made
 * files of fire and smoke 7 to 9 % smaller and took three times as long to write them, since the
 * lower bits of smooth fields are noise; its bytes also depend on its version.
 *
 * A tree has the shape of OpenVDB's standard tree: a root, one internal node of 32^3 (UPPER), those
 * of 16^3 below it (LOWER), and the leaves. Without zlib all sizes are known beforehand, so the
 * file is written from its start to its end. Integers and floats are little-endian. */
#include "output/vdb.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "output/half.h"

enum {
    FILE_VERSION = 224,
    LIBRARY_MAJOR = 10, /* the version of OpenVDB whose files these are like */
    LIBRARY_MINOR = 0,
    COMPRESS_ACTIVE_MASK = 2,
    NO_MASK_OR_INACTIVE_VALUES = 0, /* inactive voxels have the background */
    UPPER_CHILDREN = 32 * 32 * 32,
    LOWER_CHILDREN = 16 * 16 * 16,
    MASK_BYTES = KILN_VDB_LEAF_VOXELS / 8,
    ROUND = 256, /* leaves that are packed together */
    LEAF_ROOM = MASK_BYTES + 1 + KILN_VDB_LEAF_VOXELS * KILN_VDB_MOST_COMPONENTS * 4,
};

/* ---- Bytes ----------------------------------------------------------------------------------- */

/* Collects bytes in front of the file. A write that fails is remembered by the file. */
struct stream {
    struct kiln_temporary *file;
    uint64_t at; /* bytes before the buffer */
    size_t used;
    uint8_t buffer[1 << 16];
};

static void flush(struct stream *s)
{
    if (s->used > 0)
        kiln_temporary_write(s->file, s->buffer, s->used);
    s->at += s->used;
    s->used = 0;
}

static void put(struct stream *s, const void *bytes, size_t size)
{
    if (s->used + size > sizeof s->buffer)
        flush(s);
    if (size > sizeof s->buffer) {
        kiln_temporary_write(s->file, bytes, size);
        s->at += size;
        return;
    }
    memcpy(s->buffer + s->used, bytes, size);
    s->used += size;
}

static void put_byte(struct stream *s, uint8_t value)
{
    put(s, &value, 1);
}

static void put_u32(struct stream *s, uint32_t value)
{
    const uint32_t little = htole32(value);
    put(s, &little, sizeof little);
}

static void put_u64(struct stream *s, uint64_t value)
{
    const uint64_t little = htole64(value);
    put(s, &little, sizeof little);
}

static void put_double(struct stream *s, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(s, bits);
}

static void put_float(struct stream *s, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(s, bits);
}

static void put_text(struct stream *s, const char *text)
{
    const size_t length = strlen(text);
    put_u32(s, (uint32_t)length);
    put(s, text, length);
}

static void put_words(struct stream *s, const uint64_t *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        put_u64(s, words[i]);
}

/* ---- Metadata -------------------------------------------------------------------------------- */

static void put_string_meta(struct stream *s, const char *name, const char *text)
{
    put_text(s, name);
    put_text(s, "string");
    put_text(s, text);
}

static void put_metas(struct stream *s, const struct kiln_vdb_meta *metas, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct kiln_vdb_meta *meta = &metas[i];
        if (meta->type == KILN_VDB_STRING) {
            put_string_meta(s, meta->name, meta->text);
        } else if (meta->type == KILN_VDB_INT32) {
            put_text(s, meta->name);
            put_text(s, "int32");
            put_u32(s, sizeof meta->integer);
            put_u32(s, (uint32_t)meta->integer);
        } else if (meta->type == KILN_VDB_DOUBLE) {
            put_text(s, meta->name);
            put_text(s, "double");
            put_u32(s, sizeof meta->number);
            put_double(s, meta->number);
        } else {
            put_text(s, meta->name);
            put_text(s, "vec3s");
            put_u32(s, sizeof meta->vector);
            for (int k = 0; k < 3; k++)
                put_float(s, meta->vector[k]);
        }
    }
}

static void put_corner_meta(struct stream *s, const char *name, const int32_t corner[3])
{
    put_text(s, name);
    put_text(s, "vec3i");
    put_u32(s, 3 * sizeof *corner);
    for (int i = 0; i < 3; i++)
        put_u32(s, (uint32_t)corner[i]);
}

/* What OpenVDB calls statistics: programs show them before they read the values. */
struct statistics {
    int32_t least[3], most[3]; /* bounding box of the active voxels */
    uint64_t voxels;           /* active ones */
};

/* Adds the active voxels of a leaf. */
static void add_leaf(struct statistics *stats, const struct kiln_vdb_leaf *leaf)
{
    int32_t least[3] = {KILN_VDB_LEAF, 0, 0}, most[3] = {0, 0, 0};
    uint64_t any = 0; /* of each y and z */
    for (int32_t x = 0; x < KILN_VDB_LEAF; x++) {
        if (!leaf->mask[x])
            continue;
        least[0] = x < least[0] ? x : least[0];
        most[0] = x;
        any |= leaf->mask[x];
        stats->voxels += (uint64_t)__builtin_popcountll(leaf->mask[x]);
    }
    least[1] = __builtin_ctzll(any) / 8;
    most[1] = (63 - __builtin_clzll(any)) / 8;
    any |= any >> 32;
    any |= any >> 16;
    any = (any | any >> 8) & 0xff; /* of each z */
    least[2] = __builtin_ctzll(any);
    most[2] = 63 - __builtin_clzll(any);
    for (int i = 0; i < 3; i++) {
        const int32_t at = leaf->at[i] * KILN_VDB_LEAF;
        stats->least[i] = at + least[i] < stats->least[i] ? at + least[i] : stats->least[i];
        stats->most[i] = at + most[i] > stats->most[i] ? at + most[i] : stats->most[i];
    }
}

static struct statistics statistics_of(const struct kiln_vdb_grid *grid)
{
    struct statistics stats = {{INT32_MAX, INT32_MAX, INT32_MAX}, {-1, -1, -1}, 0};
    for (size_t i = 0; i < grid->leaf_count; i++)
        add_leaf(&stats, &grid->leaves[i]);
    return stats;
}

static void put_grid_metas(struct stream *s, const struct kiln_vdb *vdb,
                           const struct kiln_vdb_grid *grid, const struct statistics *stats)
{
    const bool empty = stats->voxels == 0;
    put_u32(s, (uint32_t)(grid->meta_count + 3 + (vdb->half ? 1 : 0) + (empty ? 0 : 2)));
    put_string_meta(s, "name", grid->name);
    put_metas(s, grid->metas, grid->meta_count);
    if (vdb->half) {
        put_text(s, "is_saved_as_half_float");
        put_text(s, "bool");
        put_u32(s, 1);
        put_byte(s, 1);
    }
    put_string_meta(s, "file_compression", "active values");
    put_text(s, "file_voxel_count");
    put_text(s, "int64");
    put_u32(s, sizeof stats->voxels);
    put_u64(s, stats->voxels);
    if (!empty) {
        put_corner_meta(s, "file_bbox_min", stats->least);
        put_corner_meta(s, "file_bbox_max", stats->most);
    }
}

/* ---- The map --------------------------------------------------------------------------------- */

static bool is_uniform(const struct kiln_vdb_map *map)
{
    const double scale = map->axes[0][0];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (map->axes[i][k] != (i == k ? scale : 0.0))
                return false;
    return scale > 0;
}

static void put_three(struct stream *s, double value)
{
    for (int i = 0; i < 3; i++)
        put_double(s, value);
}

/* Writes the simplest map that holds all: readers are fastest with cubic voxels along the axes. */
static void put_map(struct stream *s, const struct kiln_vdb_map *map)
{
    const double scale = map->axes[0][0];
    if (is_uniform(map)) {
        put_text(s, "UniformScaleTranslateMap");
        for (int i = 0; i < 3; i++)
            put_double(s, map->origin[i]);
        put_three(s, scale);                 /* scale values */
        put_three(s, scale);                 /* voxel size */
        put_three(s, 1.0 / scale);           /* inverse of the scale */
        put_three(s, 1.0 / (scale * scale)); /* its square */
        put_three(s, 0.5 / scale);           /* its half */
        return;
    }
    put_text(s, "AffineMap"); /* a 4x4 matrix for rows of vectors */
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            put_double(s, map->axes[i][k]);
        put_double(s, 0);
    }
    for (int k = 0; k < 3; k++)
        put_double(s, map->origin[k]);
    put_double(s, 1);
}

/* ---- The tree -------------------------------------------------------------------------------- */

/* Returns the number of the LOWER node that has a leaf, among the children of UPPER. */
static uint32_t upper_child(const struct kiln_vdb_leaf *leaf)
{
    return (uint32_t)(leaf->at[0] >> 4 << 10 | leaf->at[1] >> 4 << 5 | leaf->at[2] >> 4);
}

/* Returns the number of a leaf among the children of its LOWER node. */
static uint32_t lower_child(const struct kiln_vdb_leaf *leaf)
{
    return (uint32_t)((leaf->at[0] & 15) << 8 | (leaf->at[1] & 15) << 4 | (leaf->at[2] & 15));
}

/* Orders leaves as they lie in the file: nodes by their numbers, from the root down. */
static int compare_leaves(const void *a, const void *b)
{
    const struct kiln_vdb_leaf *x = a, *y = b;
    const uint32_t i = upper_child(x) * LOWER_CHILDREN + lower_child(x);
    const uint32_t k = upper_child(y) * LOWER_CHILDREN + lower_child(y);
    return (i > k) - (i < k);
}

/* Returns the end of the leaves that lie in the same LOWER node as the first of them. */
static size_t lower_end(const struct kiln_vdb_grid *grid, size_t first)
{
    size_t end = first + 1;
    while (end < grid->leaf_count &&
           upper_child(&grid->leaves[end]) == upper_child(&grid->leaves[first]))
        end++;
    return end;
}

/* Writes the masks and the values of an internal node, none of whose children are tiles. */
static void put_node(struct stream *s, const uint64_t *children, size_t count)
{
    put_words(s, children, count / 64);
    for (size_t i = 0; i < count / 64; i++)
        put_u64(s, 0);
    put_byte(s, NO_MASK_OR_INACTIVE_VALUES);
}

static void put_upper(struct stream *s, const struct kiln_vdb_grid *grid)
{
    uint64_t children[UPPER_CHILDREN / 64] = {0};
    for (size_t i = 0; i < grid->leaf_count; i++) {
        const uint32_t child = upper_child(&grid->leaves[i]);
        children[child / 64] |= UINT64_C(1) << child % 64;
    }
    for (int i = 0; i < 3; i++)
        put_u32(s, 0); /* the origin */
    put_node(s, children, UPPER_CHILDREN);
}

static void put_lower(struct stream *s, const struct kiln_vdb_leaf *leaves, size_t count)
{
    uint64_t children[LOWER_CHILDREN / 64] = {0};
    for (size_t i = 0; i < count; i++) {
        const uint32_t child = lower_child(&leaves[i]);
        children[child / 64] |= UINT64_C(1) << child % 64;
    }
    put_node(s, children, LOWER_CHILDREN);
    for (size_t i = 0; i < count; i++)
        put_words(s, leaves[i].mask, KILN_VDB_LEAF);
}

static void put_topology(struct stream *s, const struct kiln_vdb_grid *grid)
{
    put_u32(s, 1); /* buffers of a leaf */
    for (uint32_t i = 0; i < grid->components; i++)
        put_u32(s, 0); /* the background */
    put_u32(s, 0);     /* tiles of the root */
    put_u32(s, grid->leaf_count > 0);
    if (grid->leaf_count == 0)
        return;
    put_upper(s, grid);
    for (size_t i = 0; i < grid->leaf_count;) {
        const size_t end = lower_end(grid, i);
        put_lower(s, grid->leaves + i, end - i);
        i = end;
    }
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* Leaves that are packed together, on several threads. */
struct round {
    const struct kiln_vdb_grid *grid;
    bool half;
    const struct kiln_vdb_leaf *leaves;
    uint8_t *bytes; /* LEAF_ROOM for each leaf */
    size_t sizes[ROUND];
};

static uint8_t *store_half(uint8_t *to, float value)
{
    const uint16_t little = htole16(kiln_half(value));
    memcpy(to, &little, sizeof little);
    return to + sizeof little;
}

static uint8_t *store_float(uint8_t *to, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = htole32(bits);
    memcpy(to, &bits, sizeof bits);
    return to + sizeof bits;
}

/* Packs a leaf: its mask, and the values of its active voxels. Returns the number of bytes. */
static size_t pack_leaf(const struct round *round, const struct kiln_vdb_leaf *leaf, uint8_t *bytes)
{
    const struct kiln_vdb_grid *grid = round->grid;
    const uint32_t components = grid->components;
    float values[KILN_VDB_LEAF_VOXELS * KILN_VDB_MOST_COMPONENTS];
    uint8_t *to = bytes;
    grid->fill(grid->source, leaf, values);
    for (int x = 0; x < KILN_VDB_LEAF; x++) {
        const uint64_t little = htole64(leaf->mask[x]);
        memcpy(to, &little, sizeof little);
        to += sizeof little;
    }
    *to++ = NO_MASK_OR_INACTIVE_VALUES;
    for (uint32_t x = 0; x < KILN_VDB_LEAF; x++)
        for (uint64_t left = leaf->mask[x]; left; left &= left - 1) {
            const size_t n = 64 * x + (uint32_t)__builtin_ctzll(left);
            const float *value = values + n * components;
            for (uint32_t c = 0; c < components; c++)
                to = round->half ? store_half(to, value[c]) : store_float(to, value[c]);
        }
    return (size_t)(to - bytes);
}

static void pack_leaves(void *context, size_t begin, size_t end, uint32_t worker)
{
    struct round *round = context;
    (void)worker;
    for (size_t i = begin; i < end; i++)
        round->sizes[i] = pack_leaf(round, &round->leaves[i], round->bytes + i * LEAF_ROOM);
}

static bool put_values(struct stream *s, struct round *round, struct kiln_threads *threads,
                       const struct kiln_caller *caller, struct kiln_error *error)
{
    const struct kiln_vdb_grid *grid = round->grid;
    for (size_t first = 0; first < grid->leaf_count; first += ROUND) {
        const size_t left = grid->leaf_count - first;
        const size_t count = left < ROUND ? left : ROUND;
        if (!kiln_may_go_on(caller, error))
            return false;
        round->leaves = grid->leaves + first;
        if (threads)
            kiln_threads_for(threads, count, 8, pack_leaves, round);
        else
            pack_leaves(round, 0, count, 0);
        for (size_t i = 0; i < count; i++)
            put(s, round->bytes + i * LEAF_ROOM, round->sizes[i]);
        if (s->file->failure)
            return kiln_temporary_fail(s->file, error);
    }
    return true;
}

/* ---- Grids ----------------------------------------------------------------------------------- */

static uint64_t topology_bytes(const struct kiln_vdb_grid *grid)
{
    const uint64_t root = 4 + 4 * grid->components + 4 + 4;
    const uint64_t upper = 12 + 2 * UPPER_CHILDREN / 8 + 1, lower = 2 * LOWER_CHILDREN / 8 + 1;
    uint64_t lowers = 0;
    for (size_t i = 0; i < grid->leaf_count; i = lower_end(grid, i))
        lowers++;
    return root + (lowers > 0 ? upper : 0) + lowers * lower + grid->leaf_count * MASK_BYTES;
}

static uint64_t value_bytes(const struct kiln_vdb *vdb, const struct kiln_vdb_grid *grid,
                            uint64_t voxels)
{
    return grid->leaf_count * (MASK_BYTES + 1) + voxels * grid->components * (vdb->half ? 2 : 4);
}

static void put_descriptor(struct stream *s, const struct kiln_vdb *vdb,
                           const struct kiln_vdb_grid *grid)
{
    const bool is_vector = grid->components == 3;
    put_text(s, grid->name);
    if (vdb->half)
        put_text(s, is_vector ? "Tree_vec3s_5_4_3_HalfFloat" : "Tree_float_5_4_3_HalfFloat");
    else
        put_text(s, is_vector ? "Tree_vec3s_5_4_3" : "Tree_float_5_4_3");
    put_text(s, ""); /* the grid whose tree it shares: none */
}

/* Puts offsets of the file at a place that is still in the buffer. */
static void set_offsets(struct stream *s, size_t place, const uint64_t offsets[3])
{
    for (size_t i = 0; i < 3; i++) {
        const uint64_t little = htole64(offsets[i]);
        memcpy(s->buffer + place + i * sizeof little, &little, sizeof little);
    }
}

/* Writes a grid: its head, which has the offsets of the parts, then metadata, map and tree. */
static bool put_grid(struct stream *s, const struct kiln_vdb *vdb, struct round *round,
                     struct kiln_threads *threads, const struct kiln_caller *caller,
                     struct kiln_error *error)
{
    const struct kiln_vdb_grid *grid = round->grid;
    const struct statistics stats = statistics_of(grid);
    uint64_t offsets[3] = {0};
    put_descriptor(s, vdb, grid);
    flush(s);
    const size_t place = s->used;
    for (int i = 0; i < 3; i++)
        put_u64(s, 0);
    offsets[0] = s->at + s->used; /* of the grid */
    put_u32(s, COMPRESS_ACTIVE_MASK);
    put_grid_metas(s, vdb, grid, &stats);
    put_map(s, &vdb->map);
    offsets[1] = s->at + s->used + topology_bytes(grid); /* of the values */
    offsets[2] = offsets[1] + value_bytes(vdb, grid, stats.voxels);
    set_offsets(s, place, offsets);
    put_topology(s, grid);
    return put_values(s, round, threads, caller, error);
}

static void put_head(struct stream *s, const struct kiln_vdb *vdb)
{
    put_u64(s, 0x56444220); /* "VDB " */
    put_u32(s, FILE_VERSION);
    put_u32(s, LIBRARY_MAJOR);
    put_u32(s, LIBRARY_MINOR);
    put_byte(s, 1); /* grids have offsets */
    put(s, vdb->uuid, sizeof vdb->uuid - 1);
    put_u32(s, (uint32_t)vdb->meta_count);
    put_metas(s, vdb->metas, vdb->meta_count);
    put_u32(s, (uint32_t)vdb->grid_count);
}

bool kiln_vdb_write(struct kiln_vdb *vdb, struct kiln_temporary *file, struct kiln_threads *threads,
                    const struct kiln_caller *caller, struct kiln_error *error)
{
    struct stream *s = malloc(sizeof *s);
    struct round round = {.half = vdb->half, .bytes = malloc((size_t)ROUND * LEAF_ROOM)};
    bool ok = s && round.bytes;
    if (!ok) {
        kiln_error_no_memory(error, "%s", file->target);
    } else {
        s->file = file;
        s->at = s->used = 0;
        put_head(s, vdb);
    }
    for (size_t i = 0; ok && i < vdb->grid_count; i++) {
        round.grid = &vdb->grids[i];
        qsort(vdb->grids[i].leaves, vdb->grids[i].leaf_count, sizeof *vdb->grids[i].leaves,
              compare_leaves);
        ok = put_grid(s, vdb, &round, threads, caller, error);
    }
    if (ok) {
        flush(s);
        ok = !file->failure || kiln_temporary_fail(file, error);
    }
    free(round.bytes);
    free(s);
    return ok;
}
