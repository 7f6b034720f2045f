/* Makes the grids of a domain of gas. First the masks of all bricks of the window are found, of
 * density, temperature and flame; the mask of velocities is their union, grown by a voxel in every
 * direction, which is what a renderer needs to interpolate velocities wherever there is gas. Then
 * leaves are listed, and output/vdb.c asks for their values.
 *
 * Files that are z up have the axes x, -z, y of the world, a rotation: nothing is mirrored. A
 * domain has whole bricks along z, so the bricks of the file are those of the domain in any case.
 */
#include "output/gas_vdb.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "scene/double3.h"

/* The grids. CD has the mask of DENSITY. */
enum { DENSITY, TEMPERATURE, FLAME, SCALARS, VEL = SCALARS, MASKS, CD = MASKS, GRIDS };

static const uint32_t carried[SCALARS] = {GAS_SMOKE, GAS_TEMPERATURE, GAS_FLAME};

/* The active voxels of a leaf, as in struct kiln_vdb_leaf. */
struct mask {
    uint64_t of[KILN_VDB_LEAF];
};

/* How velocities of cells become those of the file: own * v + around * p + drift, where v is that
 * of a cell, m/s in the node, and p the cell's middle in the node. */
struct motion {
    double own[3][3], around[3][3], drift[3]; /* matrices by rows */
};

struct grids {
    const struct kiln_gas_vdb *params;
    const struct kiln_gas *gas;
    struct kiln_gas_place leaves;         /* of the window, in the axes of the file */
    uint16_t first[3];                    /* the window's lowest leaf in the file */
    uint16_t cells[KILN_VDB_LEAF_VOXELS]; /* of each voxel of a leaf: its cell in the brick */
    struct motion motion;
    struct mask *masks[MASKS]; /* of each leaf of the window, z fastest */
    struct kiln_vdb_leaf *listed[GRIDS];
    size_t counts[GRIDS];
};

static size_t leaf_count(const struct grids *g)
{
    return (size_t)g->leaves.x * (size_t)g->leaves.y * (size_t)g->leaves.z;
}

/* ---- Axes ------------------------------------------------------------------------------------ */

/* Turns a vector of the world, or of a node, into the axes of the file. */
static void to_file(const struct kiln_gas_vdb *params, const double v[3], double out[3])
{
    const double turned[3] = {v[0], params->z_up ? 0 - v[2] : v[1], params->z_up ? v[1] : v[2]};
    memcpy(out, turned, sizeof turned);
}

static void set_axes(struct grids *g)
{
    const struct kiln_gas *gas = g->gas;
    const struct kiln_gas_place n = gas->bricks;
    const int32_t all = g->params->shape->cells.z / GAS_BRICK;
    const int32_t x = gas->at.x / GAS_BRICK, y = gas->at.y / GAS_BRICK, z = gas->at.z / GAS_BRICK;
    const bool z_up = g->params->z_up;
    g->leaves = z_up ? (struct kiln_gas_place){n.x, n.z, n.y} : n;
    g->first[0] = (uint16_t)x;
    g->first[1] = (uint16_t)(z_up ? all - z - n.z : y);
    g->first[2] = (uint16_t)(z_up ? y : z);
    for (uint32_t i = 0; i < KILN_VDB_LEAF_VOXELS; i++) {
        const uint32_t a = i >> 6, b = i >> 3 & 7, c = i & 7;
        g->cells[i] = (uint16_t)(z_up ? (7 - b) * 64 + c * 8 + a : c * 64 + b * 8 + a);
    }
}

/* Returns the brick of the window at a leaf, which counts from the window. */
static struct kiln_gas_place brick_at(const struct grids *g, size_t leaf)
{
    const int32_t z = (int32_t)(leaf % (size_t)g->leaves.z);
    const int32_t y = (int32_t)(leaf / (size_t)g->leaves.z % (size_t)g->leaves.y);
    const int32_t x = (int32_t)(leaf / (size_t)g->leaves.z / (size_t)g->leaves.y);
    return g->params->z_up ? (struct kiln_gas_place){x, z, g->leaves.y - 1 - y}
                           : (struct kiln_gas_place){x, y, z};
}

/* Makes the map of the file: from indices to the node, from there to the world, and to the file. */
static struct kiln_vdb_map map_of(const struct kiln_gas_vdb *params)
{
    const struct kiln_gas_shape *shape = params->shape;
    const struct kiln_node_frame *frame = params->frame;
    const double cell = (double)shape->cell, half = 0.5 * cell;
    const double deep = params->z_up ? cell * (shape->cells.z - 1) : 0; /* index 0 is the last z */
    double origin[3] = {(double)shape->corner.x + half, (double)shape->corner.y + half,
                        (double)shape->corner.z + half + deep};
    double axes[3][3] = {{cell, 0, 0}, {0, cell, 0}, {0, 0, cell}};
    struct kiln_vdb_map map;
    if (params->z_up) {
        const double turned[3][3] = {{cell, 0, 0}, {0, 0, -cell}, {0, cell, 0}};
        memcpy(axes, turned, sizeof axes);
    }
    for (int i = 0; frame && i < 3; i++) {
        double v[3];
        double3_rotate(v, frame->turn, axes[i]);
        for (int k = 0; k < 3; k++)
            axes[i][k] = frame->scale * v[k];
    }
    if (frame) {
        double v[3];
        double3_rotate(v, frame->turn, origin);
        for (int k = 0; k < 3; k++)
            origin[k] = frame->at[k] + frame->scale * v[k];
    }
    for (int i = 0; i < 3; i++)
        to_file(params, axes[i], map.axes[i]);
    to_file(params, origin, map.origin);
    return map;
}

/* Finds the motion: a node moves its gas, and turns and scales what the gas does by itself. */
static void set_motion(struct grids *g)
{
    const struct kiln_node_frame *frame = g->params->frame;
    struct motion *m = &g->motion;
    *m = (struct motion){.drift = {0}};
    for (int i = 0; i < 3; i++) {
        double axis[3] = {i == 0, i == 1, i == 2}, own[3], around[3] = {0};
        memcpy(own, axis, sizeof own);
        if (frame) {
            double turned[3];
            double3_rotate(turned, frame->turn, axis);
            double3_cross(around, frame->spin, turned);
            for (int k = 0; k < 3; k++) {
                own[k] = frame->scale * turned[k];
                around[k] = frame->scale * around[k] + frame->growth * turned[k];
            }
        }
        to_file(g->params, own, own);
        to_file(g->params, around, around);
        for (int k = 0; k < 3; k++) {
            m->own[k][i] = own[k];
            m->around[k][i] = around[k];
        }
    }
    if (frame)
        to_file(g->params, frame->velocity, m->drift);
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* Returns the brick of a leaf that is listed. */
static struct kiln_gas_place brick_of(const struct grids *g, const struct kiln_vdb_leaf *leaf)
{
    return brick_at(g, leaf->item);
}

static const struct kiln_gas_brick *find_brick(const struct grids *g, struct kiln_gas_place at)
{
    return &g->gas->brick[kiln_gas_brick_index(g->gas, at.x, at.y, at.z)];
}

static void fill_scalar(const struct grids *g, const struct kiln_vdb_leaf *leaf, uint32_t quantity,
                        float *values)
{
    const float *now = find_brick(g, brick_of(g, leaf))->now;
    for (uint32_t i = 0; i < KILN_VDB_LEAF_VOXELS; i++)
        values[i] = now[g->cells[i] * GAS_CARRIED + quantity];
}

static void fill_density(const void *source, const struct kiln_vdb_leaf *leaf, float *values)
{
    fill_scalar(source, leaf, GAS_SMOKE, values);
}

static void fill_temperature(const void *source, const struct kiln_vdb_leaf *leaf, float *values)
{
    const struct kiln_gas_vdb *params = ((const struct grids *)source)->params;
    const float cold = params->kelvin_of[0], more = params->kelvin_of[1] - cold;
    fill_scalar(source, leaf, GAS_TEMPERATURE, values);
    for (uint32_t i = 0; params->kelvin && i < KILN_VDB_LEAF_VOXELS; i++)
        values[i] = cold + more * values[i];
}

static void fill_flame(const void *source, const struct kiln_vdb_leaf *leaf, float *values)
{
    fill_scalar(source, leaf, GAS_FLAME, values);
}

/* Writes the colour of a cell's smoke: of its amount that has a colour, and of the rest the albedo.
 */
static void color_at(const float albedo[3], float smoke, const float *color, float *value)
{
    const float amount = color[3], part = amount < smoke ? amount : smoke;
    for (int c = 0; c < 3; c++)
        value[c] = amount > 1e-6f && smoke > 0
                       ? ((smoke - part) * albedo[c] + part / amount * color[c]) / smoke
                       : albedo[c];
}

static void fill_color(const void *source, const struct kiln_vdb_leaf *leaf, float *values)
{
    const struct grids *g = source;
    const struct kiln_gas_brick *brick = find_brick(g, brick_of(g, leaf));
    const size_t group = kiln_gas_group(&g->gas->shape, GAS_COLOR);
    const float *colors = brick->extras + group * GAS_BRICK_CELLS * GAS_CARRIED;
    for (size_t i = 0; i < KILN_VDB_LEAF_VOXELS; i++) {
        const size_t cell = (size_t)g->cells[i] * GAS_CARRIED;
        color_at(g->params->albedo, brick->now[cell + GAS_SMOKE], colors + cell, values + 3 * i);
    }
}

/* Writes the velocity of a cell, of which x, y and z are its place in the window. */
static void velocity_at(const struct grids *g, const int32_t place[3], float *value)
{
    const struct kiln_gas *gas = g->gas;
    const struct kiln_gas_shape *shape = g->params->shape;
    const struct motion *m = &g->motion;
    const ptrdiff_t i = place[2] * gas->plane + place[1] * gas->row + place[0];
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    const int32_t at[3] = {gas->at.x, gas->at.y, gas->at.z};
    const float corner[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    double v[3], p[3];
    for (int k = 0; k < 3; k++) {
        v[k] = 0.5 * ((double)gas->faces[k][i] + (double)gas->faces[k][i + next[k]]);
        p[k] = (double)corner[k] + (at[k] + place[k] + 0.5) * (double)shape->cell;
    }
    for (int k = 0; k < 3; k++) {
        double sum = m->drift[k];
        for (int c = 0; c < 3; c++)
            sum += m->own[k][c] * v[c] + m->around[k][c] * p[c];
        value[k] = (float)sum;
    }
}

static void fill_vel(const void *source, const struct kiln_vdb_leaf *leaf, float *values)
{
    const struct grids *g = source;
    const struct kiln_gas_place brick = brick_of(g, leaf);
    for (uint32_t i = 0; i < KILN_VDB_LEAF_VOXELS; i++) {
        const int32_t cell = g->cells[i];
        const int32_t place[3] = {brick.x * GAS_BRICK + (cell & 7),
                                  brick.y * GAS_BRICK + (cell >> 3 & 7),
                                  brick.z * GAS_BRICK + (cell >> 6)};
        velocity_at(g, place, values + 3 * (size_t)i);
    }
}

/* ---- Masks ----------------------------------------------------------------------------------- */

/* Finds the masks of the scalars of leaves, and their union. */
static void find_masks(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct grids *g = context;
    (void)worker;
    for (size_t leaf = begin; leaf < end; leaf++) {
        const float *now = find_brick(g, brick_at(g, leaf))->now;
        for (uint32_t i = 0; now && i < KILN_VDB_LEAF_VOXELS; i++) {
            const float *cell = now + (size_t)g->cells[i] * GAS_CARRIED;
            const uint64_t bit = UINT64_C(1) << i % 64;
            for (int s = 0; s < SCALARS; s++)
                if (cell[carried[s]] > 0 && cell[carried[s]] >= g->params->cutoff) {
                    g->masks[s][leaf].of[i / 64] |= bit;
                    g->masks[VEL][leaf].of[i / 64] |= bit;
                }
        }
    }
}

/* Returns the mask of the leaf beside another one along an axis of the file; no voxels beyond the
 * window. */
static struct mask beside(const struct grids *g, const struct mask *masks, size_t leaf, int axis,
                          int way)
{
    const size_t n[3] = {(size_t)g->leaves.x, (size_t)g->leaves.y, (size_t)g->leaves.z};
    const size_t stride = axis == 0 ? n[1] * n[2] : axis == 1 ? n[2] : 1;
    const size_t place = leaf / stride % n[axis];
    if (way < 0 ? place == 0 : place + 1 == n[axis])
        return (struct mask){{0}};
    return masks[way < 0 ? leaf - stride : leaf + stride];
}

/* Returns a mask grown by a voxel along an axis of the file. */
static struct mask grown(const struct grids *g, const struct mask *masks, size_t leaf, int axis)
{
    const struct mask below = beside(g, masks, leaf, axis, -1);
    const struct mask above = beside(g, masks, leaf, axis, 1);
    const struct mask *own = &masks[leaf];
    const uint64_t first = UINT64_C(0x0101010101010101), last = first << 7;
    struct mask out;
    for (int x = 0; x < KILN_VDB_LEAF; x++) {
        const uint64_t m = own->of[x], b = below.of[x], a = above.of[x];
        if (axis == 0)
            out.of[x] =
                m | (x > 0 ? own->of[x - 1] : below.of[7]) | (x < 7 ? own->of[x + 1] : above.of[0]);
        else if (axis == 1)
            out.of[x] = m | m << 8 | b >> 56 | m >> 8 | a << 56;
        else
            out.of[x] =
                m | (m << 1 & ~first) | (b >> 7 & first) | (m >> 1 & ~last) | (a << 7 & last);
    }
    return out;
}

/* Grows the mask of velocities along each axis in turn, so in all directions. */
static bool grow(struct grids *g)
{
    const size_t count = leaf_count(g);
    struct mask *to = malloc(count * sizeof *to);
    for (int axis = 0; to && axis < 3; axis++) {
        for (size_t leaf = 0; leaf < count; leaf++)
            to[leaf] = grown(g, g->masks[VEL], leaf, axis);
        struct mask *from = g->masks[VEL];
        g->masks[VEL] = to;
        to = from;
    }
    const bool ok = to != NULL;
    free(to);
    return ok;
}

static bool is_empty(const struct mask *mask)
{
    uint64_t any = 0;
    for (int x = 0; x < KILN_VDB_LEAF; x++)
        any |= mask->of[x];
    return any == 0;
}

/* Lists the leaves of a grid that have active voxels. */
static bool list_leaves(struct grids *g, int grid)
{
    const struct mask *masks = g->masks[grid == CD ? DENSITY : grid];
    const size_t count = leaf_count(g);
    size_t used = 0;
    for (size_t i = 0; i < count; i++)
        used += !is_empty(&masks[i]);
    struct kiln_vdb_leaf *leaf = malloc((used + 1) * sizeof *leaf);
    g->listed[grid] = leaf;
    g->counts[grid] = used;
    for (size_t i = 0; leaf && i < count; i++) {
        if (is_empty(&masks[i]))
            continue;
        const size_t z = i % (size_t)g->leaves.z, row = i / (size_t)g->leaves.z;
        const size_t y = row % (size_t)g->leaves.y, x = row / (size_t)g->leaves.y;
        *leaf =
            (struct kiln_vdb_leaf){.at = {(uint16_t)(g->first[0] + x), (uint16_t)(g->first[1] + y),
                                          (uint16_t)(g->first[2] + z)},
                                   .item = (uint32_t)i};
        memcpy(leaf->mask, masks[i].of, sizeof leaf->mask);
        leaf++;
    }
    return g->listed[grid] != NULL;
}

/* Returns the number of grids: the last one is of smoke with colours of its own. */
static int grid_count(const struct grids *g)
{
    return g->params->shape->colored ? GRIDS : GRIDS - 1;
}

static bool fail(const struct kiln_temporary *file, struct kiln_error *error)
{
    return kiln_error_no_memory(error, "%s", file->target);
}

static bool find_leaves(struct grids *g, const struct kiln_temporary *file,
                        struct kiln_threads *threads, struct kiln_error *error)
{
    const size_t count = leaf_count(g);
    for (int i = 0; i < MASKS; i++)
        if (!(g->masks[i] = calloc(count + 1, sizeof *g->masks[i])))
            return fail(file, error);
    if (!threads)
        find_masks(g, 0, count, 0);
    else if (!kiln_threads_try(threads, count, 16, find_masks, g, error))
        return false;
    if (count > 0 && !grow(g))
        return fail(file, error);
    for (int i = 0; i < grid_count(g); i++)
        if (!list_leaves(g, i))
            return fail(file, error);
    return true;
}

/* ---- The interface --------------------------------------------------------------------------- */

/* Says what is written of each grid, beside its metadata. */
static const struct {
    const char *name;
    uint32_t components;
    size_t meta_count;
    void (*fill)(const void *source, const struct kiln_vdb_leaf *leaf, float *values);
} kinds[GRIDS] = {
    [DENSITY] = {"density", 1, 3, fill_density},
    [TEMPERATURE] = {"temperature", 1, 2, fill_temperature},
    [FLAME] = {"flame", 1, 2, fill_flame},
    [VEL] = {"vel", 3, 2, fill_vel},
    [CD] = {"Cd", 3, 1, fill_color},
};

static bool write_grids(struct grids *g, struct kiln_temporary *file, struct kiln_threads *threads,
                        const struct kiln_caller *caller, struct kiln_error *error)
{
    const struct kiln_gas_vdb *params = g->params;
    const struct kiln_vdb_meta density[] = {
        {.name = "class", .text = "fog volume"},
        {.name = "extinction", .type = KILN_VDB_DOUBLE, .number = params->extinction},
        {.name = "albedo",
         .type = KILN_VDB_VEC3S,
         .vector = {params->albedo[0], params->albedo[1], params->albedo[2]}},
    };
    const struct kiln_vdb_meta temperature[] = {
        {.name = "class", .text = "fog volume"},
        {.name = "units", .text = params->kelvin ? "K" : "1"},
    };
    const struct kiln_vdb_meta flame[] = {
        {.name = "class", .text = "fog volume"},
        {.name = "units", .text = "1"},
    };
    const struct kiln_vdb_meta vel[] = {
        {.name = "vector_type", .text = "contravariant relative"},
        {.name = "units", .text = "m/s"},
    };
    const struct kiln_vdb_meta color[] = {{.name = "vector_type", .text = "invariant"}};
    const struct kiln_vdb_meta *const metas[GRIDS] = {density, temperature, flame, vel, color};
    struct kiln_vdb_grid grids[GRIDS];
    for (int i = 0; i < GRIDS; i++)
        grids[i] = (struct kiln_vdb_grid){.name = kinds[i].name,
                                          .components = kinds[i].components,
                                          .metas = metas[i],
                                          .meta_count = kinds[i].meta_count,
                                          .leaves = g->listed[i],
                                          .leaf_count = g->counts[i],
                                          .fill = kinds[i].fill,
                                          .source = g};
    struct kiln_vdb vdb = {.metas = params->metas,
                           .meta_count = params->meta_count,
                           .map = map_of(params),
                           .half = params->half,
                           .grids = grids,
                           .grid_count = (size_t)grid_count(g)};
    memcpy(vdb.uuid, params->uuid, sizeof vdb.uuid);
    return kiln_vdb_write(&vdb, file, threads, caller, error);
}

bool kiln_gas_vdb_write(const struct kiln_gas_vdb *params, struct kiln_temporary *file,
                        struct kiln_threads *threads, const struct kiln_caller *caller,
                        uint64_t *voxels, struct kiln_error *error)
{
    struct grids g = {.params = params, .gas = params->gas};
    set_axes(&g);
    set_motion(&g);
    const bool ok =
        find_leaves(&g, file, threads, error) && write_grids(&g, file, threads, caller, error);
    *voxels = 0;
    for (size_t i = 0; ok && i < g.counts[DENSITY]; i++)
        for (int x = 0; x < KILN_VDB_LEAF; x++)
            *voxels += (uint64_t)__builtin_popcountll(g.listed[DENSITY][i].mask[x]);
    for (int i = 0; i < MASKS; i++)
        free(g.masks[i]);
    for (int i = 0; i < GRIDS; i++)
        free(g.listed[i]);
    return ok;
}
