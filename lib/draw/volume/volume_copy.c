/* This file copies gas from the bricks of a domain's state to blocks. Smoke, flames and colours are
 * filtered on the way, by 3/16, 10/16, 3/16 along each axis, which is close to how a cubic B-spline
 * spreads the cells (Sigg and Hadwiger, "Fast Third-Order Texture Filtering", 2005). Straight lines
 * between raw cells would show thin sheets of flames and smoke as columns of cells. */
#include "draw/volume/volume_copy.h"

#include <math.h>
#include <string.h>

#include "shared/exact.h"

/* The cells on each side of a block that its values are made from, and along an edge with them. */
enum { BORDER = 2, AROUND = VOLUME_EDGE + 2 * BORDER };

/* Numbers the values that are filtered. */
enum { SMOKE, FLAME, HEAT, RED, GREEN, BLUE, FILTERED };

/* Counts the axes of the ways of both groups of GAS_CAME_FROM. */
enum { WAYS = 6 };

/* How much ways may stretch gas until it counts as sheared: the root of the mean square of how long
 * unit vectors become. Turning them leaves it at 1. */
#define CALM_UNTIL 1.4f
#define SHEARED_AT 2.4f

typedef float around[AROUND][AROUND][AROUND];

struct copy_job {
    const struct kiln_volume_field *field;
    const struct kiln_volume_seen *seen;
};

/* Holds the cells of the window along an axis that lie around a block: their bricks, and their
 * places in them. */
struct along {
    int32_t brick[AROUND], cell[AROUND];
};

/* Beyond the end of the window lies its last cell again. count: cells of the window. */
static struct along along_of(int32_t brick, int32_t count)
{
    struct along along;
    for (int32_t i = 0; i < AROUND; i++) {
        const int32_t at = brick * GAS_BRICK - BORDER + i;
        const int32_t in = at < 0 ? 0 : at < count ? at : count - 1;
        along.brick[i] = in / GAS_BRICK;
        along.cell[i] = in % GAS_BRICK;
    }
    return along;
}

struct block_cells {
    struct along x, y, z;
};

static struct block_cells cells_around(const struct kiln_volume_field *field, uint32_t block)
{
    const struct kiln_gas_place brick = kiln_volume_place(field, block);
    return (struct block_cells){along_of(brick.x, field->cells.x),
                                along_of(brick.y, field->cells.y),
                                along_of(brick.z, field->cells.z)};
}

/* Returns the bricks of a row of cells, from the first one of the window on. */
static const struct kiln_gas_brick *bricks_of_row(const struct kiln_volume_field *field,
                                                  const struct block_cells *cells, int32_t y,
                                                  int32_t z)
{
    return field->gas->brick +
           kiln_gas_brick_index(field->gas, 0, cells->y.brick[y], cells->z.brick[z]);
}

/* Returns where the numbers of a cell begin among those of a brick. */
static ptrdiff_t place_in_brick(const struct block_cells *cells, int32_t x, int32_t y, int32_t z)
{
    const ptrdiff_t row = cells->z.cell[z] * GAS_BRICK + cells->y.cell[y];
    return (row * GAS_BRICK + cells->x.cell[x]) * GAS_CARRIED;
}

/* Returns the floats of a brick's extras: group number `i` of a kind. */
static const float *group_of(const struct kiln_gas *gas, const float *extras, uint32_t kind,
                             uint32_t i)
{
    const size_t group = kiln_gas_group(&gas->shape, kind) + i;
    return extras + group * GAS_BRICK_CELLS * GAS_CARRIED;
}

/* Finds what the smoke of a cell scatters: its amount times its albedo. color: GAS_COLOR. */
static void find_tint(const float *color, float smoke, const float albedo[3], float tint[3])
{
    const float amount = color[3], part = amount < smoke ? amount : smoke;
    for (int c = 0; c < 3; c++)
        tint[c] = amount > 1e-6f ? (smoke - part) * albedo[c] + part / amount * color[c]
                                 : smoke * albedo[c];
}

/* Gathers what is filtered of a row. Temperatures are weighed by the flames. */
static void gather_row(const struct copy_job *job, const struct block_cells *cells, int32_t y,
                       int32_t z, around values[FILTERED])
{
    const struct kiln_gas *gas = job->field->gas;
    const struct kiln_gas_brick *bricks = bricks_of_row(job->field, cells, y, z);
    for (int32_t x = 0; x < AROUND; x++) {
        const struct kiln_gas_brick *brick = &bricks[cells->x.brick[x]];
        const ptrdiff_t at = place_in_brick(cells, x, y, z);
        const float *now = brick->now ? brick->now + at : NULL;
        values[SMOKE][z][y][x] = now ? now[GAS_SMOKE] : 0.0f;
        values[FLAME][z][y][x] = now ? now[GAS_FLAME] : 0.0f;
        values[HEAT][z][y][x] = now ? now[GAS_FLAME] * now[GAS_TEMPERATURE] : 0.0f;
        if (!gas->shape.colored)
            continue;
        float tint[3] = {0.0f, 0.0f, 0.0f};
        if (now)
            find_tint(group_of(gas, brick->extras, GAS_COLOR, 0) + at, now[GAS_SMOKE],
                      job->seen->albedo, tint);
        for (int c = 0; c < 3; c++)
            values[RED + c][z][y][x] = tint[c];
    }
}

static float filtered(float before, float here, float behind)
{
    return 0.625f * here + 0.1875f * (before + behind);
}

/* Filters values, but for those of the outermost cells. */
static void filter(around v)
{
    around w;
    const int last = AROUND - 1;
    for (int z = 0; z <= last; z++)
        for (int y = 0; y <= last; y++)
            for (int x = 1; x < last; x++)
                w[z][y][x] = filtered(v[z][y][x - 1], v[z][y][x], v[z][y][x + 1]);
    for (int z = 0; z <= last; z++)
        for (int y = 1; y < last; y++)
            for (int x = 1; x < last; x++)
                v[z][y][x] = filtered(w[z][y - 1][x], w[z][y][x], w[z][y + 1][x]);
    for (int z = 1; z < last; z++)
        for (int y = 1; y < last; y++)
            for (int x = 1; x < last; x++)
                w[z][y][x] = filtered(v[z - 1][y][x], v[z][y][x], v[z + 1][y][x]);
    for (int z = 1; z < last; z++)
        for (int y = 1; y < last; y++)
            memcpy(&v[z][y][1], &w[z][y][1], (AROUND - 2) * sizeof(float));
}

/* Calls BODY for each cell of a block; x, y, z count from the outermost cell around it. */
#define EACH_CELL(BODY)                                                                            \
    for (int32_t z = BORDER; z < BORDER + VOLUME_EDGE; z++)                                        \
        for (int32_t y = BORDER; y < BORDER + VOLUME_EDGE; y++)                                    \
            for (int32_t x = BORDER; x < BORDER + VOLUME_EDGE; x++)                                \
    BODY

static void write_gas(around values[FILTERED], float *cell)
{
    EACH_CELL({
        const float flame = values[FLAME][z][y][x];
        const float heat = values[HEAT][z][y][x];
        memset(cell, 0, VOLUME_CELL * sizeof *cell);
        cell[VOLUME_SMOKE] = values[SMOKE][z][y][x];
        cell[VOLUME_FLAME] = flame;
        cell[VOLUME_TEMPERATURE] = flame > 1e-12f ? heat / flame : 0.0f;
        cell += VOLUME_CELL;
    })
}

/* Returns whether samples in a cube see gas. first: its first cell, as EACH_CELL counts. */
static bool cube_is_seen(around values[FILTERED], const struct kiln_volume_seen *seen,
                         const int32_t first[3])
{
    for (int32_t z = first[2]; z <= first[2] + VOLUME_CUBE; z++)
        for (int32_t y = first[1]; y <= first[1] + VOLUME_CUBE; y++)
            for (int32_t x = first[0]; x <= first[0] + VOLUME_CUBE; x++)
                if (values[SMOKE][z][y][x] > seen->least_smoke ||
                    values[FLAME][z][y][x] > seen->least_flame)
                    return true;
    return false;
}

/* Finds the cubes of a block in which gas is seen. Returns a bit for each of them: 1 and 2 for the
 * first two along x, then those above them along y and z. */
static uint32_t find_cubes(const struct copy_job *job, uint32_t block, around values[FILTERED])
{
    const struct kiln_volume_field *field = job->field;
    const struct kiln_gas_place brick = kiln_volume_place(field, block), n = field->bricks;
    uint32_t found = 0;
    for (int32_t i = 0; i < VOLUME_CUBES; i++) {
        const int32_t at[3] = {i & 1, i >> 1 & 1, i >> 2};
        int32_t first[3];
        for (int k = 0; k < 3; k++)
            first[k] = BORDER + at[k] * VOLUME_CUBE;
        if (!cube_is_seen(values, job->seen, first))
            continue;
        const int32_t x = 2 * brick.x + at[0], y = 2 * brick.y + at[1], z = 2 * brick.z + at[2];
        field->cube_of[((ptrdiff_t)z * 2 * n.y + y) * 2 * n.x + x] = (int32_t)block;
        found |= 1u << i;
    }
    return found;
}

static void write_tints(around values[FILTERED], float *tint)
{
    EACH_CELL({
        for (int c = 0; c < 3; c++)
            tint[c] = values[RED + c][z][y][x];
        tint[3] = 0.0f;
        tint += VOLUME_FOUR;
    })
}

/* Returns how values change at a cell along the axes, for a cell of way. */
static float3 slope_at(around v, int32_t x, int32_t y, int32_t z)
{
    return (float3){0.5f * (v[z][y][x + 1] - v[z][y][x - 1]),
                    0.5f * (v[z][y + 1][x] - v[z][y - 1][x]),
                    0.5f * (v[z + 1][y][x] - v[z - 1][y][x])};
}

/* Returns the amount of gas by its slope, cells, which grows from 0 at the edge of gas inwards. */
static float thickness_at(around v, int32_t x, int32_t y, int32_t z)
{
    const float here = v[z][y][x];
    const float slope = float3_length(slope_at(v, x, y, z));
    if (here < 1e-6f)
        return 0.0f;
    return here < VOLUME_THICKEST * slope ? here / slope : VOLUME_THICKEST;
}

/* Returns how calm the ways of a group are at a cell (VOLUME_CALM). ways: its three axes. */
static float calm_at(around ways[3], float cell, int32_t x, int32_t y, int32_t z)
{
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        float3 row = float3_scale(slope_at(ways[i], x, y, z), 1.0f / cell);
        row.x += i == 0 ? 1.0f : 0.0f;
        row.y += i == 1 ? 1.0f : 0.0f;
        row.z += i == 2 ? 1.0f : 0.0f;
        sum += float3_dot(row, row);
    }
    const float stretch = sqrtf(sum * (1.0f / 3.0f));
    const float calm = (SHEARED_AT - stretch) * (1.0f / (SHEARED_AT - CALM_UNTIL));
    return calm < 0.0f ? 0.0f : calm < 1.0f ? calm : 1.0f;
}

/* Gathers where the gas of a row came from, which is no amount and is not filtered. */
static void gather_ways(const struct kiln_volume_field *field, const struct block_cells *cells,
                        int32_t y, int32_t z, around ways[WAYS])
{
    const struct kiln_gas_brick *bricks = bricks_of_row(field, cells, y, z);
    for (int32_t x = 0; x < AROUND; x++) {
        const float *extras = bricks[cells->x.brick[x]].extras;
        const ptrdiff_t at = place_in_brick(cells, x, y, z);
        for (uint32_t i = 0; i < WAYS; i++)
            ways[i][z][y][x] =
                extras ? group_of(field->gas, extras, GAS_CAME_FROM, i / 3)[at + i % 3] : 0.0f;
    }
}

/* Returns the bits of find_cubes for cubes whose samples read a cell. x, y, z: as EACH_CELL counts.
 */
static uint32_t cubes_at(int32_t x, int32_t y, int32_t z)
{
    const int32_t at[3] = {x, y, z}, middle = BORDER + VOLUME_CUBE;
    static const uint32_t lower[3] = {0x55, 0x33, 0x0f};
    uint32_t cubes = 0xff;
    for (int i = 0; i < 3; i++)
        cubes &= at[i] < middle ? lower[i] : at[i] > middle ? ~lower[i] : 0xff;
    return cubes;
}

/* Writes what a block is drawn finer by, at cells that samples in some of its cubes read. */
static void write_finer(const struct kiln_volume_field *field, uint32_t block, uint32_t cubes,
                        around values[FILTERED], around ways[WAYS])
{
    const float cell = field->gas->shape.cell;
    float *way = field->ways + (size_t)block * VOLUME_BLOCK;
    float *edge = field->edges + (size_t)block * VOLUME_FOURS;
    EACH_CELL({
        if (cubes_at(x, y, z) & cubes) {
            for (int i = 0; i < VOLUME_CELL; i++)
                way[i] = i % 4 < 3 ? ways[i / 4 * 3 + i % 4][z][y][x] : 0.0f;
            edge[VOLUME_SMOKE_THICKNESS] = thickness_at(values[SMOKE], x, y, z);
            edge[VOLUME_FLAME_THICKNESS] = thickness_at(values[FLAME], x, y, z);
            edge[VOLUME_CALM] = calm_at(ways, cell, x, y, z);
            edge[VOLUME_CALM + 1] = calm_at(ways + 3, cell, x, y, z);
        }
        way += VOLUME_CELL;
        edge += VOLUME_FOUR;
    })
}

static void copy_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct copy_job *job = context;
    const struct kiln_volume_field *field = job->field;
    const bool colored = field->gas->shape.colored, detail = job->seen->detail;
    around values[FILTERED], ways[WAYS];
    for (size_t i = begin; i < end; i++) {
        const uint32_t block = (uint32_t)i;
        const struct block_cells cells = cells_around(field, block);
        for (int32_t z = 0; z < AROUND; z++)
            for (int32_t y = 0; y < AROUND; y++) {
                gather_row(job, &cells, y, z, values);
                if (detail)
                    gather_ways(field, &cells, y, z, ways);
            }
        for (int k = 0; k < (colored ? FILTERED : RED); k++)
            filter(values[k]);
        write_gas(values, kiln_volume_block(field, block));
        const uint32_t cubes = find_cubes(job, block, values);
        if (colored)
            write_tints(values, field->tints + i * VOLUME_FOURS);
        if (detail)
            write_finer(field, block, cubes, values, ways);
    }
}

void kiln_volume_copy(const struct kiln_volume_field *field, const struct kiln_volume_seen *seen,
                      struct kiln_threads *threads)
{
    struct copy_job job = {field, seen};
    kiln_threads_for(threads, field->count, 8, copy_blocks, &job);
}
