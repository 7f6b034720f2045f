/* Steps a domain of gas without a scene, and measures what is in it, in double precision. */
#include "support/gas_rig.h"

#include <math.h>

#include "support/cmocka.h"

struct kiln_gas_step gas_rig_constants(float cell, float dt)
{
    return (struct kiln_gas_step){.dt = dt,
                                  .cell = cell,
                                  .cells_a_velocity = dt / cell,
                                  .slow = 1.0f,
                                  .ignition = 1e6f,
                                  .flame_fade = 0.0f,
                                  .smoke_left = 1.0f,
                                  .hottest = 1e6f};
}

void gas_rig_start(struct gas_rig *rig, const struct kiln_gas_shape *shape, float dt,
                   enum kiln_simd simd, uint32_t threads)
{
    const struct kiln_gas_place none = {0, 0, 0};
    *rig = (struct gas_rig){.threads = kiln_threads_create(threads),
                            .step = gas_rig_constants(shape->cell, dt),
                            .cycles = 2};
    assert_non_null(rig->threads);
    kiln_gas_init(&rig->gas, shape);
    assert_true(kiln_gas_set_window(&rig->gas, none, shape->cells));
    for (int32_t i = 0; i < rig->gas.bricks.x * rig->gas.bricks.y * rig->gas.bricks.z; i++)
        assert_true(kiln_gas_brick_take(&rig->gas, &rig->gas.brick[i]));
    assert_true(gas_solver_init(&rig->solver, &rig->gas, rig->threads, simd, NULL));
}

void gas_rig_end(struct gas_rig *rig)
{
    gas_solver_finish(&rig->solver);
    kiln_gas_finish(&rig->gas);
    kiln_threads_destroy(&rig->threads);
}

void gas_rig_run(struct gas_rig *rig, uint32_t steps)
{
    const struct kiln_gas_place all = rig->gas.shape.cells;
    const struct gas_region region = {{0, 0, 0},
                                      {all.x / GAS_BRICK, all.y / GAS_BRICK, all.z / GAS_BRICK}};
    const struct gas_hooks hooks = {.add = NULL};
    for (uint32_t i = 0; i < steps; i++) {
        struct kiln_error error = {0};
        struct gas_pass pass = {.gas = &rig->gas, .step = &rig->step};
        assert_int_equal(gas_solver_prepare(&rig->solver, &region, 1, false, false, &error),
                         GAS_STEPPED);
        assert_int_equal(
            gas_solver_step(&rig->solver, &pass, &hooks, rig->cycles, rig->residual, &error),
            GAS_STEPPED);
    }
}

float *gas_cell(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    const size_t brick = kiln_gas_brick_index(gas, x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK);
    float *now = gas->brick[brick].now;
    const int32_t cell = (z % GAS_BRICK * GAS_BRICK + y % GAS_BRICK) * GAS_BRICK + x % GAS_BRICK;
    return now ? now + cell * GAS_CARRIED : NULL;
}

float gas_at(const struct kiln_gas *gas, int quantity, int32_t x, int32_t y, int32_t z)
{
    const struct kiln_gas_place p = {x - gas->at.x, y - gas->at.y, z - gas->at.z};
    if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= gas->cells.x || p.y >= gas->cells.y ||
        p.z >= gas->cells.z)
        return 0.0f;
    const float *cell = gas_cell(gas, p.x, p.y, p.z);
    return cell ? cell[quantity] : 0.0f;
}

/* Adds up a quantity, and the quantity times its place in m. */
static double sum_up(const struct kiln_gas *gas, int quantity, double moment[3])
{
    const double cell = (double)gas->shape.cell;
    double sum = 0.0;
    moment[0] = moment[1] = moment[2] = 0.0;
    for (int32_t z = 0; z < gas->cells.z; z++)
        for (int32_t y = 0; y < gas->cells.y; y++)
            for (int32_t x = 0; x < gas->cells.x; x++) {
                const float *own = gas_cell(gas, x, y, z);
                if (!own)
                    continue;
                const double q = (double)own[quantity];
                sum += q;
                moment[0] +=
                    q * ((double)gas->shape.corner.x + ((double)(gas->at.x + x) + 0.5) * cell);
                moment[1] +=
                    q * ((double)gas->shape.corner.y + ((double)(gas->at.y + y) + 0.5) * cell);
                moment[2] +=
                    q * ((double)gas->shape.corner.z + ((double)(gas->at.z + z) + 0.5) * cell);
            }
    return sum;
}

double gas_sum(const struct kiln_gas *gas, int quantity)
{
    double moment[3];
    return sum_up(gas, quantity, moment);
}

void gas_center(const struct kiln_gas *gas, int quantity, double center[3])
{
    const double sum = sum_up(gas, quantity, center);
    for (int i = 0; i < 3; i++)
        center[i] /= sum;
}

/* Returns the place of a cell of the window in the arrays of faces. */
static ptrdiff_t face_at(const struct kiln_gas *gas, int32_t x, int32_t y, int32_t z)
{
    return z * gas->plane + y * gas->row + x;
}

double gas_energy(const struct kiln_gas *gas)
{
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    double sum = 0.0;
    for (int32_t z = 0; z < gas->cells.z; z++)
        for (int32_t y = 0; y < gas->cells.y; y++)
            for (int32_t x = 0; x < gas->cells.x; x++)
                for (int c = 0; c < 3; c++) {
                    const float *face = gas->faces[c] + face_at(gas, x, y, z);
                    const double u = 0.5 * ((double)face[0] + (double)face[next[c]]);
                    sum += u * u;
                }
    return sum;
}

double gas_fastest(const struct kiln_gas *gas)
{
    double most = 0.0;
    for (int32_t z = 0; z < gas->cells.z; z++)
        for (int32_t y = 0; y < gas->cells.y; y++)
            for (int32_t x = 0; x < gas->cells.x; x++)
                for (int c = 0; c < 3; c++)
                    most = fmax(most, fabs((double)gas->faces[c][face_at(gas, x, y, z)]));
    return most;
}

double gas_divergence(const struct kiln_gas *gas)
{
    const ptrdiff_t next[3] = {1, gas->row, gas->plane};
    const double cells = (double)gas->cells.x * (double)gas->cells.y * (double)gas->cells.z;
    double sum = 0.0;
    for (int32_t z = 0; z < gas->cells.z; z++)
        for (int32_t y = 0; y < gas->cells.y; y++)
            for (int32_t x = 0; x < gas->cells.x; x++) {
                double outflow = 0.0;
                for (int c = 0; c < 3; c++) {
                    const float *face = gas->faces[c] + face_at(gas, x, y, z);
                    outflow += (double)face[next[c]] - (double)face[0];
                }
                sum += outflow * outflow;
            }
    return sqrt(sum / cells) / (double)gas->shape.cell;
}
