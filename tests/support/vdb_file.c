/* Reads OpenVDB files byte by byte, in the order in which OpenVDB's own reader does
 * (openvdb/io/File.cc, tree/RootNode.h, InternalNode.h, LeafNode.h). */
#include "support/vdb_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"

struct bytes {
    const uint8_t *all;
    size_t at, size;
};

static const uint8_t *take(struct bytes *b, size_t size)
{
    assert_true(size <= b->size - b->at);
    b->at += size;
    return b->all + b->at - size;
}

static uint64_t number(struct bytes *b, size_t size)
{
    const uint8_t *from = take(b, size);
    uint64_t value = 0;
    for (size_t i = size; i-- > 0;)
        value = value << 8 | from[i];
    return value;
}

static double take_double(struct bytes *b)
{
    const uint64_t bits = number(b, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void take_text(struct bytes *b, char *text, size_t room)
{
    const size_t size = number(b, 4);
    assert_true(size < room);
    memcpy(text, take(b, size), size);
    text[size] = '\0';
}

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns the float that has the value of a half, by its definition. */
static float float_of_half(uint32_t half)
{
    const int exponent = (int)(half >> 10 & 31);
    const float sign = half & 0x8000 ? -1.0f : 1.0f, part = (float)(half & 1023);
    float value = exponent == 0 ? part / 1024.0f : 1.0f + part / 1024.0f;
    assert_true(exponent < 31);
    for (int i = exponent ? exponent : 1; i < 15; i++)
        value *= 0.5f;
    for (int i = 15; i < exponent; i++)
        value *= 2.0f;
    return sign * value;
}

static void take_corner(struct bytes *b, char *text, size_t room)
{
    int32_t at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (int32_t)number(b, 4);
    snprintf(text, room, "%d %d %d", (int)at[0], (int)at[1], (int)at[2]);
}

static void take_vector(struct bytes *b, char *text, size_t room)
{
    float v[3];
    for (int i = 0; i < 3; i++)
        v[i] = float_of((uint32_t)number(b, 4));
    snprintf(text, room, "%g %g %g", (double)v[0], (double)v[1], (double)v[2]);
}

/* Reads metadata as "name=value;". */
static void take_metas(struct bytes *b, char *out, size_t room)
{
    char name[64], type[64], text[512];
    size_t used = 0;
    out[0] = '\0';
    for (uint64_t left = number(b, 4); left > 0; left--) {
        take_text(b, name, sizeof name);
        take_text(b, type, sizeof type);
        if (strcmp(type, "string") == 0) {
            take_text(b, text, sizeof text);
        } else {
            const size_t size = number(b, 4);
            struct bytes inner = {b->all, b->at, b->at + size};
            take(b, size);
            if (strcmp(type, "double") == 0)
                snprintf(text, sizeof text, "%.9g", take_double(&inner));
            else if (strcmp(type, "vec3s") == 0)
                take_vector(&inner, text, sizeof text);
            else if (strcmp(type, "vec3i") == 0)
                take_corner(&inner, text, sizeof text);
            else
                snprintf(text, sizeof text, "%lld", (long long)number(&inner, size));
            assert_true(inner.at == inner.size);
        }
        used += (size_t)snprintf(out + used, room - used, "%s=%s;", name, text);
        assert_true(used < room);
    }
}

static void take_map(struct bytes *b, struct vdb_grid *grid)
{
    take_text(b, grid->map, sizeof grid->map);
    if (strcmp(grid->map, "UniformScaleTranslateMap") == 0) {
        double v[6][3];
        for (int i = 0; i < 18; i++)
            v[i / 3][i % 3] = take_double(b);
        for (int i = 0; i < 3; i++) {
            grid->origin[i] = v[0][i];
            grid->axes[i][i] = v[1][i];
            assert_true(v[1][i] == v[2][i] && v[3][i] == 1 / v[1][i] &&
                        v[4][i] == 1 / (v[1][i] * v[1][i]) && v[5][i] == 0.5 / v[1][i]);
        }
        return;
    }
    assert_string_equal(grid->map, "AffineMap");
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            *(i < 3 ? &grid->axes[i][k] : &grid->origin[k]) = take_double(b);
        assert_true(take_double(b) == (i == 3));
    }
}

/* Reads the masks of a node of edge^3 children, of which none is a tile, and returns those of its
 * children, which the caller frees. */
static uint64_t *take_children(struct bytes *b, uint32_t edge)
{
    const uint32_t words = edge * edge * edge / 64;
    uint64_t *children = calloc(words, sizeof *children);
    for (uint32_t i = 0; i < words; i++)
        children[i] = number(b, 8);
    for (uint32_t i = 0; i < words; i++)
        assert_true(number(b, 8) == 0);
    assert_true(number(b, 1) == 0);
    return children;
}

static void take_leaves(struct bytes *b, struct vdb_grid *grid, const int32_t at[3])
{
    uint64_t *children = take_children(b, 16);
    for (int32_t i = 0; i < 4096; i++) {
        if (!(children[i / 64] >> i % 64 & 1))
            continue;
        grid->leaves = realloc(grid->leaves, (grid->leaf_count + 1) * sizeof *grid->leaves);
        struct vdb_leaf *leaf = &grid->leaves[grid->leaf_count++];
        *leaf = (struct vdb_leaf){
            .at = {at[0] + (i >> 8) * 8, at[1] + (i >> 4 & 15) * 8, at[2] + (i & 15) * 8}};
        for (int w = 0; w < 8; w++)
            leaf->mask[w] = number(b, 8);
    }
    free(children);
}

static void take_topology(struct bytes *b, struct vdb_grid *grid)
{
    assert_true(number(b, 4) == 1);
    for (uint32_t i = 0; i < grid->components + 1; i++)
        assert_true(number(b, 4) == 0); /* the background, and no tiles of the root */
    if (number(b, 4) == 0)
        return;
    for (int i = 0; i < 3; i++)
        assert_true(number(b, 4) == 0);
    uint64_t *children = take_children(b, 32);
    for (int32_t i = 0; i < 32768; i++)
        if (children[i / 64] >> i % 64 & 1)
            take_leaves(b, grid, (int32_t[]){(i >> 10) * 128, (i >> 5 & 31) * 128, (i & 31) * 128});
    free(children);
}

static void take_values(struct bytes *b, struct vdb_grid *grid)
{
    for (size_t i = 0; i < grid->leaf_count; i++) {
        struct vdb_leaf *leaf = &grid->leaves[i];
        size_t count = 0;
        for (int w = 0; w < 8; w++) {
            assert_true(number(b, 8) == leaf->mask[w]);
            count += (size_t)__builtin_popcountll(leaf->mask[w]);
        }
        assert_true(number(b, 1) == 0);
        grid->voxels += count;
        count *= grid->components;
        leaf->values = malloc((count + 1) * sizeof *leaf->values);
        for (size_t k = 0; k < count; k++)
            leaf->values[k] = grid->half ? float_of_half((uint32_t)number(b, 2))
                                         : float_of((uint32_t)number(b, 4));
    }
}

static void take_grid(struct bytes *b, struct vdb_grid *grid)
{
    char shared[8];
    take_text(b, grid->name, sizeof grid->name);
    take_text(b, grid->type, sizeof grid->type);
    take_text(b, shared, sizeof shared);
    assert_string_equal(shared, "");
    grid->components = strstr(grid->type, "vec3s") ? 3 : 1;
    grid->half = strstr(grid->type, "_HalfFloat") != NULL;
    const uint64_t head = number(b, 8), values = number(b, 8), end = number(b, 8);
    assert_true(b->at == head);
    assert_true(number(b, 4) == 2); /* values are packed by masks */
    take_metas(b, grid->metas, sizeof grid->metas);
    take_map(b, grid);
    take_topology(b, grid);
    assert_true(b->at == values);
    take_values(b, grid);
    assert_true(b->at == end);
}

void vdb_file_read(struct vdb_file *vdb, const char *path)
{
    FILE *file = fopen(path, "rb");
    *vdb = (struct vdb_file){.grid_count = 0};
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    struct bytes b = {.size = (size_t)ftell(file)};
    uint8_t *all = malloc(b.size);
    rewind(file);
    assert_true(fread(all, 1, b.size, file) == b.size);
    fclose(file);
    b.all = all;
    assert_memory_equal(take(&b, 8), " BDV\0\0\0\0", 8);
    assert_true(number(&b, 4) == 224); /* versions of the format and of the library */
    assert_true(number(&b, 4) == 10);
    assert_true(number(&b, 4) == 0);
    assert_true(number(&b, 1) == 1); /* grids have offsets */
    memcpy(vdb->uuid, take(&b, 36), 36);
    take_metas(&b, vdb->metas, sizeof vdb->metas);
    vdb->grid_count = (uint32_t)number(&b, 4);
    assert_true(vdb->grid_count <= VDB_MOST_GRIDS);
    for (uint32_t i = 0; i < vdb->grid_count; i++)
        take_grid(&b, &vdb->grids[i]);
    assert_true(b.at == b.size);
    free(all);
}

void vdb_file_free(struct vdb_file *vdb)
{
    for (uint32_t i = 0; i < vdb->grid_count; i++) {
        for (size_t k = 0; k < vdb->grids[i].leaf_count; k++)
            free(vdb->grids[i].leaves[k].values);
        free(vdb->grids[i].leaves);
    }
}

const struct vdb_grid *vdb_file_grid(const struct vdb_file *vdb, const char *name)
{
    for (uint32_t i = 0; i < vdb->grid_count; i++)
        if (strcmp(vdb->grids[i].name, name) == 0)
            return &vdb->grids[i];
    fail_msg("there is no grid %s", name);
    return NULL;
}

const float *vdb_grid_at(const struct vdb_grid *grid, int32_t x, int32_t y, int32_t z)
{
    const int32_t in = (x & 7) * 64 + (y & 7) * 8 + (z & 7);
    for (size_t i = 0; i < grid->leaf_count; i++) {
        const struct vdb_leaf *leaf = &grid->leaves[i];
        size_t before = 0;
        if (leaf->at[0] != (x & ~7) || leaf->at[1] != (y & ~7) || leaf->at[2] != (z & ~7))
            continue;
        if (!(leaf->mask[in / 64] >> in % 64 & 1))
            return NULL;
        for (int32_t k = 0; k < in; k++)
            before += leaf->mask[k / 64] >> k % 64 & 1;
        return leaf->values + before * grid->components;
    }
    return NULL;
}
