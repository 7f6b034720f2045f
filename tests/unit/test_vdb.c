/* lib/output/vdb.c and gas_vdb.c: the OpenVDB files of gas. If this fails, other programs
 * read other values, in other places, than the simulation has, or cannot read the files. The files
 * are read by a reader of the tests' own (support/vdb_file.h); tests/vdb has OpenVDB's tools read
 * such files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "output/gas_vdb.h"
#include "output/half.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/gas_fixture.h"
#include "support/vdb_file.h"

#define CUTOFF 0.01f

/* Returns the number that a half stands for, without its sign. */
static float float_of_half(uint32_t half)
{
    const uint32_t exponent = half >> 10, part = half & 1023;
    return exponent ? ldexpf((float)(1024 + part), (int)exponent - 25) : ldexpf((float)part, -24);
}

/* ---- Gas ------------------------------------------------------------------------------------- */

/* Returns the number of a cell in its brick. */
static size_t in_brick(int32_t x, int32_t y, int32_t z)
{
    return (size_t)((z % 8 * 8 + y % 8) * 8 + x % 8);
}

/* Returns what a cell of the window carries; NULL where its brick is idle. */
static const float *cell_at(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    const float *now = gas->brick[kiln_gas_brick_index(gas, x / 8, y / 8, z / 8)].now;
    return now ? now + in_brick(x, y, z) * GAS_CARRIED : NULL;
}

/* Makes a ball in 32^3 cells whose quantities and velocities differ from cell to cell and from axis
 * to axis, so that no two axes can be exchanged. */
static void make_ball(struct kiln_gas *gas)
{
    gas_fixture_ball(gas, 32, 0.125f, 0.3f, 0.5f, 0.25f);
    for (int32_t z = 0; z <= 32; z++)
        for (int32_t y = 0; y <= 32; y++)
            for (int32_t x = 0; x <= 32; x++) {
                const ptrdiff_t i = z * gas->plane + y * gas->row + x;
                const bool inside[3] = {y < 32 && z < 32, x < 32 && z < 32, x < 32 && y < 32};
                for (int k = 0; k < 3; k++)
                    if (inside[k])
                        gas->faces[k][i] = 0.25f * (float)x * (float)(k + 1) -
                                           0.5f * (float)y * (float)(3 - k) + 0.125f * (float)z;
                if (x == 32 || y == 32 || z == 32)
                    continue;
                float *q = gas->brick[kiln_gas_brick_index(gas, x / 8, y / 8, z / 8)].now;
                if (!q)
                    continue;
                q += in_brick(x, y, z) * GAS_CARRIED;
                q[GAS_SMOKE] *= 1.0f + 0.01f * (float)x + 0.02f * (float)y + 0.03f * (float)z;
                q[GAS_FLAME] *= x < 16 ? 0.5f : 0.0f;
            }
    float *corner = gas->brick[kiln_gas_brick_index(gas, 1, 2, 1)].now;
    assert_non_null(corner);
    corner[in_brick(8, 16, 8) * GAS_CARRIED + GAS_SMOKE] = 0.9f; /* a cell that grows to others */
}

static struct kiln_gas_vdb params_of(const struct kiln_gas *gas)
{
    return (struct kiln_gas_vdb){
        .gas = gas,
        .shape = &gas->shape,
        .cutoff = CUTOFF,
        .kelvin_of = {300, 1300},
        .extinction = 4,
        .albedo = {0.5f, 0.25f, 0.125f},
        .uuid = "12345678-1234-8234-8234-123456789abc",
    };
}

/* Writes a file; `threads` 0: without threads. */
static bool write_to(const char *path, const struct kiln_gas_vdb *params, uint32_t threads,
                     const struct kiln_caller *caller, uint64_t *voxels, struct kiln_error *error)
{
    struct kiln_temporary file = {.target = NULL};
    struct kiln_threads *pool = threads ? kiln_threads_create(threads) : NULL;
    assert_true(kiln_temporary_open(&file, path, error));
    const bool ok = kiln_gas_vdb_write(params, &file, pool, caller, voxels, error);
    kiln_threads_destroy(&pool);
    if (ok)
        return kiln_temporary_commit(&file, true, error);
    kiln_temporary_discard(&file);
    return false;
}

static uint64_t write_to_or_fail(const struct kiln_gas_vdb *params)
{
    struct kiln_error error = kiln_error_empty();
    uint64_t voxels = 0;
    if (!write_to("gas.vdb", params, 2, NULL, &voxels, &error))
        fail_msg("%s", error.message);
    return voxels;
}

static void write_and_read(const struct kiln_gas_vdb *params, struct vdb_file *vdb)
{
    const uint64_t voxels = write_to_or_fail(params);
    vdb_file_read(vdb, "gas.vdb");
    assert_int_equal(vdb->grid_count, 4);
    assert_true(vdb_file_grid(vdb, "density")->voxels == voxels);
}

static bool has_gas(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    const int32_t n[3] = {gas->cells.x, gas->cells.y, gas->cells.z};
    if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2])
        return false;
    const float *q = cell_at(gas, x, y, z);
    return q && (q[GAS_SMOKE] >= CUTOFF || q[GAS_TEMPERATURE] >= CUTOFF || q[GAS_FLAME] >= CUTOFF);
}

/* Returns whether a cell or one of its 26 neighbours has gas. */
static bool is_near_gas(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    bool near = false;
    for (int i = 0; i < 27; i++)
        near |= has_gas(gas, x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1);
    return near;
}

/* Returns the mean of the faces of a cell on an axis. */
static float mean_at(const struct kiln_gas *gas, int axis, int32_t x, int32_t y, int32_t z)
{
    const ptrdiff_t i = z * gas->plane + y * gas->row + x;
    const ptrdiff_t next = axis == 0 ? 1 : axis == 1 ? gas->row : gas->plane;
    return 0.5f * (gas->faces[axis][i] + gas->faces[axis][i + next]);
}

static float as_written(const struct kiln_gas_vdb *params, float value)
{
    return params->half ? copysignf(float_of_half(kiln_half(value) & 0x7fff), value) : value;
}

/* Checks a voxel of a scalar grid, and counts it if it is active. */
static void check_scalar(const struct vdb_grid *grid, const int32_t at[3], const float *q,
                         uint32_t quantity, float written, uint64_t *count)
{
    const float *found = vdb_grid_at(grid, at[0], at[1], at[2]);
    const bool active = q && q[quantity] >= CUTOFF;
    assert_true(active == (found != NULL));
    *count += active;
    if (found)
        assert_true(*found == written);
}

/* Compares the file with every cell of the window. */
static void check_all(const struct kiln_gas_vdb *params, const struct vdb_file *vdb)
{
    static const char *const names[] = {"density", "temperature", "flame"};
    static const uint32_t quantities[] = {GAS_SMOKE, GAS_TEMPERATURE, GAS_FLAME};
    const struct kiln_gas *gas = params->gas;
    const struct vdb_grid *vel = vdb_file_grid(vdb, "vel");
    uint64_t counts[4] = {0};
    for (int32_t i = 0; i < gas->cells.x * gas->cells.y * gas->cells.z; i++) {
        const int32_t x = i % gas->cells.x, y = i / gas->cells.x % gas->cells.y;
        const int32_t z = i / gas->cells.x / gas->cells.y;
        const int32_t a[3] = {x + gas->at.x, y + gas->at.y, z + gas->at.z};
        const int32_t up_z[3] = {a[0], params->shape->cells.z - 1 - a[2], a[1]};
        const int32_t *at = params->z_up ? up_z : a;
        const float *q = cell_at(gas, x, y, z);
        for (int k = 0; k < 3; k++) {
            float value = q ? q[quantities[k]] : 0;
            if (k == 1 && params->kelvin)
                value = 300.0f + 1000.0f * value;
            check_scalar(vdb_file_grid(vdb, names[k]), at, q, quantities[k],
                         as_written(params, value), &counts[k]);
        }
        const float *found = vdb_grid_at(vel, at[0], at[1], at[2]);
        assert_true(is_near_gas(gas, x, y, z) == (found != NULL));
        counts[3] += found != NULL;
        for (int k = 0; k < 3 && found; k++) {
            const int axis = params->z_up ? (int[]){0, 2, 1}[k] : k;
            const float mean = mean_at(gas, axis, x, y, z);
            assert_true(found[k] == as_written(params, params->z_up && k == 1 ? -mean : mean));
        }
    }
    for (int k = 0; k < 3; k++)
        assert_true(counts[k] > 0 && vdb_file_grid(vdb, names[k])->voxels == counts[k]);
    assert_true(vel->voxels == counts[3]);
}

static void every_cell_is_a_voxel(void **state)
{
    (void)state;
    struct kiln_gas gas;
    make_ball(&gas);
    for (int i = 0; i < 8; i++) {
        struct kiln_gas_vdb params = params_of(&gas);
        struct vdb_file vdb;
        params.half = i & 1;
        params.z_up = i & 2;
        params.kelvin = i & 4;
        write_and_read(&params, &vdb);
        check_all(&params, &vdb);
        vdb_file_free(&vdb);
    }
    kiln_gas_finish(&gas);
}

/* A window that is not the whole domain: indices count from the domain. */
static void indices_do_not_follow_the_window(void **state)
{
    (void)state;
    struct kiln_gas gas;
    struct kiln_gas_vdb params;
    struct vdb_file vdb;
    make_ball(&gas);
    gas.shape.cells = (struct kiln_gas_place){64, 96, 80};
    gas.at = (struct kiln_gas_place){16, 64, 32};
    for (int up = 0; up < 2; up++) {
        params = params_of(&gas);
        params.z_up = up;
        write_and_read(&params, &vdb);
        check_all(&params, &vdb);
        vdb_file_free(&vdb);
    }
    kiln_gas_finish(&gas);
}

/* A cell of a ball of coloured smoke, as the drawing of smoke takes it: the amount that has a
 * colour, and for the rest the albedo. */
static void set_color(struct kiln_gas *gas, const int32_t at[3], float amount)
{
    struct kiln_gas_brick *brick =
        &gas->brick[kiln_gas_brick_index(gas, at[0] / 8, at[1] / 8, at[2] / 8)];
    const size_t cell = in_brick(at[0], at[1], at[2]) * GAS_CARRIED;
    const float color[4] = {1.0f * amount, 0.5f * amount, 0.0f, amount};
    assert_true(brick->now[cell + GAS_SMOKE] >= CUTOFF);
    brick->now[cell + GAS_SMOKE] = 0.5f;
    memcpy(brick->extras + cell, color, sizeof color);
}

static void colored_smoke_has_a_grid_of_colors(void **state)
{
    (void)state;
    static const int32_t cells[3][3] = {{4, 5, 9}, {9, 6, 8}, {7, 11, 6}};
    static const float expected[3][3] = {
        {1, 0.5f, 0}, {0.75f, 0.375f, 0.0625f}, {0.5f, 0.25f, 0.125f}};
    struct kiln_gas gas, plain;
    struct vdb_file vdb;
    gas_fixture_ball(&plain, 16, 0.125f, 0.4f, 0.5f, 0.25f);
    struct kiln_gas_shape shape = plain.shape;
    shape.colored = true;
    kiln_gas_init(&gas, &shape);
    assert_true(kiln_gas_set_window(&gas, plain.at, plain.cells));
    for (size_t i = 0; i < 8; i++) {
        assert_true(kiln_gas_brick_take(&gas, &gas.brick[i]));
        memcpy(gas.brick[i].now, plain.brick[i].now, sizeof(float) * GAS_CARRIED * GAS_BRICK_CELLS);
    }
    set_color(&gas, cells[0], 0.5f);
    set_color(&gas, cells[1], 0.25f);
    set_color(&gas, cells[2], 0.0f);
    struct kiln_gas_vdb params = params_of(&gas);
    for (int up = 0; up < 2; up++) {
        params.z_up = up;
        write_to_or_fail(&params);
        vdb_file_read(&vdb, "gas.vdb");
        assert_int_equal(vdb.grid_count, 5);
        const struct vdb_grid *grid = vdb_file_grid(&vdb, "Cd");
        assert_true(grid->voxels == vdb_file_grid(&vdb, "density")->voxels);
        assert_non_null(strstr(grid->metas, "vector_type=invariant;"));
        for (int i = 0; i < 3; i++) {
            const int32_t *c = cells[i];
            const float *found = vdb_grid_at(grid, c[0], up ? 15 - c[2] : c[1], up ? c[1] : c[2]);
            assert_non_null(found);
            assert_memory_equal(found, expected[i], sizeof expected[i]);
        }
        vdb_file_free(&vdb);
    }
    kiln_gas_finish(&gas);
    kiln_gas_finish(&plain);
}

/* ---- Heads ----------------------------------------------------------------------------------- */

static void grids_say_what_they_are(void **state)
{
    (void)state;
    static const struct kiln_vdb_meta metas[] = {
        {.name = "creator", .text = "kiln"},
        {.name = "frame", .type = KILN_VDB_INT32, .integer = -7},
        {.name = "time", .type = KILN_VDB_DOUBLE, .number = 0.25},
    };
    struct kiln_gas gas;
    struct vdb_file vdb;
    make_ball(&gas);
    struct kiln_gas_vdb params = params_of(&gas);
    params.metas = metas;
    params.meta_count = 3;
    params.half = params.kelvin = true;
    write_and_read(&params, &vdb);
    assert_string_equal(vdb.uuid, params.uuid);
    assert_string_equal(vdb.metas, "creator=kiln;frame=4294967289;time=0.25;");
    assert_string_equal(
        vdb_file_grid(&vdb, "density")->metas,
        "name=density;class=fog volume;extinction=4;albedo=0.5 0.25 0.125;is_saved_as_half_float=1;"
        "file_compression=active values;file_voxel_count=4897;"
        "file_bbox_min=5 5 5;file_bbox_max=26 26 26;");
    assert_string_equal(vdb_file_grid(&vdb, "temperature")->metas,
                        "name=temperature;class=fog volume;units=K;is_saved_as_half_float=1;"
                        "file_compression=active values;file_voxel_count=2388;"
                        "file_bbox_min=6 16 6;file_bbox_max=25 25 25;");
    assert_string_equal(vdb_file_grid(&vdb, "flame")->metas,
                        "name=flame;class=fog volume;units=1;is_saved_as_half_float=1;"
                        "file_compression=active values;file_voxel_count=1194;"
                        "file_bbox_min=6 16 6;file_bbox_max=15 25 25;");
    assert_string_equal(vdb_file_grid(&vdb, "vel")->type, "Tree_vec3s_5_4_3_HalfFloat");
    assert_string_equal(vdb_file_grid(&vdb, "flame")->type, "Tree_float_5_4_3_HalfFloat");
    vdb_file_free(&vdb);
    params.half = params.kelvin = false;
    write_and_read(&params, &vdb);
    assert_string_equal(vdb_file_grid(&vdb, "vel")->type, "Tree_vec3s_5_4_3");
    assert_string_equal(vdb_file_grid(&vdb, "flame")->type, "Tree_float_5_4_3");
    assert_non_null(strstr(vdb_file_grid(&vdb, "temperature")->metas, "units=1;file"));
    assert_non_null(
        strstr(vdb_file_grid(&vdb, "vel")->metas, "vector_type=contravariant relative;units=m/s;"));
    vdb_file_free(&vdb);
    kiln_gas_finish(&gas);
}

/* Frames before the fire, and behind it. */
static void without_gas_grids_are_empty(void **state)
{
    (void)state;
    const struct kiln_gas_shape shape = {.cells = {32, 32, 32}, .cell = 0.5f};
    struct kiln_gas gas;
    struct vdb_file vdb;
    kiln_gas_init(&gas, &shape);
    struct kiln_gas_vdb params = params_of(&gas);
    for (int half = 0; half < 2; half++) {
        params.half = half;
        write_and_read(&params, &vdb);
        for (uint32_t i = 0; i < 4; i++) {
            assert_true(vdb.grids[i].leaf_count == 0 && vdb.grids[i].voxels == 0);
            assert_null(strstr(vdb.grids[i].metas, "bbox"));
            assert_true(vdb.grids[i].axes[2][2] == 0.5 && vdb.grids[i].origin[2] == 0.25);
        }
        vdb_file_free(&vdb);
    }
    assert_true(kiln_gas_set_window(&gas, (struct kiln_gas_place){0, 0, 0}, shape.cells));
    write_and_read(&params, &vdb); /* a window of air */
    for (uint32_t i = 0; i < 4; i++)
        assert_true(vdb.grids[i].leaf_count == 0);
    vdb_file_free(&vdb);
    kiln_gas_finish(&gas);
}

/* Gas below the cutoff is left out, and air is, also with cutoff 0. */
static void the_cutoff_decides_what_is_active(void **state)
{
    (void)state;
    struct kiln_gas gas;
    struct vdb_file vdb;
    gas_fixture_ball(&gas, 16, 1.0f, 0.3f, 0.5f, 0.25f);
    struct kiln_gas_vdb params = params_of(&gas);
    static const float cutoffs[] = {0, 0.5f, 0.51f};
    uint64_t found[3];
    for (int i = 0; i < 3; i++) {
        params.cutoff = cutoffs[i];
        write_and_read(&params, &vdb);
        found[i] = vdb_file_grid(&vdb, "density")->voxels;
        vdb_file_free(&vdb);
    }
    uint64_t some = 0, whole = 0;
    for (int32_t i = 0; i < 16 * 16 * 16; i++) {
        const float *q = cell_at(&gas, i % 16, i / 16 % 16, i / 256);
        some += q && q[GAS_SMOKE] > 0;
        whole += q && q[GAS_SMOKE] >= 0.5f;
    }
    assert_true(found[0] == some && found[1] == whole && found[2] == 0 && whole > 0);
    kiln_gas_finish(&gas);
}

/* ---- Places ---------------------------------------------------------------------------------- */

/* Rotates v by a unit quaternion, by its matrix. */
static void rotate(const double q[4], const double v[3], double out[3])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

/* Returns where the middle of a cell lies in the axes of the file. frame: NULL for the world. */
static void place_of_cell(const struct kiln_gas_vdb *params, const int32_t cell[3], double out[3])
{
    const struct kiln_gas_shape *shape = params->shape;
    const struct kiln_node_frame *frame = params->frame;
    double p[3] = {(double)shape->corner.x + (cell[0] + 0.5) * (double)shape->cell,
                   (double)shape->corner.y + (cell[1] + 0.5) * (double)shape->cell,
                   (double)shape->corner.z + (cell[2] + 0.5) * (double)shape->cell};
    if (frame) {
        double turned[3];
        rotate(frame->turn, p, turned);
        for (int k = 0; k < 3; k++)
            p[k] = frame->at[k] + frame->scale * turned[k];
    }
    out[0] = p[0];
    out[1] = params->z_up ? -p[2] : p[1];
    out[2] = params->z_up ? p[1] : p[2];
}

static void check_places(const struct kiln_gas_vdb *params, const struct vdb_grid *grid)
{
    static const int32_t cells[][3] = {{0, 0, 0}, {31, 0, 0}, {0, 31, 0}, {0, 0, 31}, {9, 14, 22}};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        const int32_t *c = cells[i];
        const double index[3] = {c[0], params->z_up ? 31 - c[2] : c[1], params->z_up ? c[1] : c[2]};
        double expected[3];
        place_of_cell(params, c, expected);
        for (int k = 0; k < 3; k++) {
            const double found = grid->origin[k] + index[0] * grid->axes[0][k] +
                                 index[1] * grid->axes[1][k] + index[2] * grid->axes[2][k];
            assert_true(fabs(found - expected[k]) < 1e-12);
        }
    }
}

static void the_map_leads_to_the_world(void **state)
{
    (void)state;
    struct kiln_gas gas;
    struct vdb_file vdb;
    make_ball(&gas);
    gas.shape.corner = FLOAT3(-3.0f, 1.5f, 7.0f);
    struct kiln_gas_vdb params = params_of(&gas);
    for (int up = 0; up < 2; up++) {
        params.z_up = up;
        write_and_read(&params, &vdb);
        for (uint32_t i = 0; i < 4; i++) {
            assert_string_equal(vdb.grids[i].map, "UniformScaleTranslateMap");
            check_places(&params, &vdb.grids[i]);
        }
        vdb_file_free(&vdb);
    }
    kiln_gas_finish(&gas);
}

/* A domain in a node that is turned and grows, and flies on a curve. A point p of the node, where
 * the gas moves by v, moves by velocity + scale * (turned v + spin x turned p) + growth * turned p.
 */
static void a_node_carries_map_and_velocities(void **state)
{
    (void)state;
    const struct kiln_node_frame frame = {.at = {1, -2, 3},
                                          .turn = {0.1, -0.5, 0.7, 0.5},
                                          .scale = 2.5,
                                          .velocity = {10, 20, -30},
                                          .spin = {0.5, -1.5, 2},
                                          .growth = 0.75};
    struct kiln_gas gas;
    struct vdb_file vdb;
    make_ball(&gas);
    struct kiln_gas_vdb params = params_of(&gas);
    params.frame = &frame;
    for (int up = 0; up < 2; up++) {
        params.z_up = up;
        write_and_read(&params, &vdb);
        const struct vdb_grid *vel = vdb_file_grid(&vdb, "vel");
        assert_string_equal(vel->map, "AffineMap");
        check_places(&params, vel);
        const int32_t c[3] = {12, 19, 14};
        const float *found = vdb_grid_at(vel, c[0], up ? 31 - c[2] : c[1], up ? c[1] : c[2]);
        assert_non_null(found);
        double v[3], p[3], turned_v[3], turned_p[3], world[3];
        const float corner[3] = {gas.shape.corner.x, gas.shape.corner.y, gas.shape.corner.z};
        for (int k = 0; k < 3; k++) {
            v[k] = (double)mean_at(&gas, k, c[0], c[1], c[2]);
            p[k] = (double)corner[k] + (c[k] + 0.5) * 0.125;
        }
        rotate(frame.turn, v, turned_v);
        rotate(frame.turn, p, turned_p);
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            const double across = frame.spin[a] * turned_p[b] - frame.spin[b] * turned_p[a];
            world[k] = frame.velocity[k] + frame.scale * (turned_v[k] + across) +
                       frame.growth * turned_p[k];
        }
        const double expected[3] = {world[0], up ? -world[2] : world[1], up ? world[1] : world[2]};
        for (int k = 0; k < 3; k++)
            assert_true(fabs((double)found[k] - expected[k]) < 1e-5);
        vdb_file_free(&vdb);
    }
    kiln_gas_finish(&gas);
}

/* ---- Writing --------------------------------------------------------------------------------- */

static char *read_all(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size);
    assert_true(fread(bytes, 1, *size, file) == *size);
    fclose(file);
    return bytes;
}

static void threads_change_no_byte(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct kiln_gas gas;
    gas_fixture_ball(&gas, 80, 0.1f, 0.45f, 0.5f, 0.25f); /* more leaves than are packed together */
    const struct kiln_gas_vdb params = params_of(&gas);
    uint64_t voxels;
    size_t size, other_size;
    assert_true(write_to("alone.vdb", &params, 0, NULL, &voxels, &error));
    char *alone = read_all("alone.vdb", &size);
    for (uint32_t threads = 1; threads <= 3; threads++) {
        assert_true(write_to("more.vdb", &params, threads, NULL, &voxels, &error));
        char *more = read_all("more.vdb", &other_size);
        assert_true(size == other_size);
        assert_memory_equal(alone, more, size);
        free(more);
    }
    free(alone);
    kiln_gas_finish(&gas);
}

static bool never(void *user, struct kiln_error *error)
{
    int *left = user;
    return (*left)-- > 0 || kiln_error_set(error, KILN_INTERRUPTED, "stopped");
}

/* A file that is given up leaves nothing behind. */
static void a_caller_ends_a_file(void **state)
{
    (void)state;
    struct kiln_error error = kiln_error_empty();
    struct kiln_gas gas;
    uint64_t voxels;
    make_ball(&gas);
    const struct kiln_gas_vdb params = params_of(&gas);
    for (int asks = 0; asks < 4; asks++) { /* each grid asks once */
        int left = asks;
        const struct kiln_caller caller = {never, &left};
        assert_false(write_to("ended.vdb", &params, 2, &caller, &voxels, &error));
        expect_error(&error, KILN_INTERRUPTED, "stopped");
        assert_int_equal(access("ended.vdb", F_OK), -1);
    }
    kiln_gas_finish(&gas);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
        IN_FOLDER(every_cell_is_a_voxel),
        IN_FOLDER(indices_do_not_follow_the_window),
        IN_FOLDER(colored_smoke_has_a_grid_of_colors),
        IN_FOLDER(grids_say_what_they_are),
        IN_FOLDER(without_gas_grids_are_empty),
        IN_FOLDER(the_cutoff_decides_what_is_active),
        IN_FOLDER(the_map_leads_to_the_world),
        IN_FOLDER(a_node_carries_map_and_velocities),
        IN_FOLDER(threads_change_no_byte),
        IN_FOLDER(a_caller_ends_a_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
