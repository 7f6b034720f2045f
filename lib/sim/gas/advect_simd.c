/* Moves gas along its velocity by MacCormack's scheme, and lets it burn and rise, brick by brick.
 *
 * A value is traced back from each cell's centre over one step (semi-Lagrangian, into `traced`),
 * and then forth again; half of what the way there and back changed is taken off as the error of
 * the scheme (Selle et al., "An Unconditionally Stable MacCormack Method", 2008). Where the
 * corrected value leaves the range of the cells that it came from, a limiter takes the correction
 * back: wholly, in part or down to the range, by quantity. */
#include "sim/gas/advect.h"
#include "sim/gas/extras.h"
#include "sim/gas/stir.h"
#include "sim/gas/walls.h"

/* Holds the velocity of a vector of cells, and its differences over two cells along each axis. */
struct flow {
    vf u[3], change[3][3];
};

SIMD struct flow flow_at(velocities *velocity, int32_t x, int32_t y, int32_t z)
{
    struct flow flow;
    for (int c = 0; c < 3; c++) {
        const velocities *of = &velocity[c];
        flow.u[c] = vf_load(&(*of)[z][y][x]);
        flow.change[c][0] = vf_load(&(*of)[z][y][x + 1]) - vf_load(&(*of)[z][y][x - 1]);
        flow.change[c][1] = vf_load(&(*of)[z][y + 1][x]) - vf_load(&(*of)[z][y - 1][x]);
        flow.change[c][2] = vf_load(&(*of)[z + 1][y][x]) - vf_load(&(*of)[z - 1][y][x]);
    }
    return flow;
}

/* Computes the way of cells in a step, in cells. scale: of velocities to cells a step. */
SIMD void way_of(const struct flow *flow, float scale, vf way[3])
{
    const vf *u = flow->u;
    for (int c = 0; c < 3; c++) {
        const vf *by = flow->change[c];
        way[c] = gas_way(u[c], u[0], u[1], u[2], by[0], by[1], by[2], scale);
    }
}

/* Finds the ways of a brick's cells, after find_flow, and how far around it they lead. */
static struct reach find_ways(const struct kiln_gas_step *step, struct gas_workspace *space)
{
    vf most[3] = {0};
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++)
            for (int32_t x = 0; x < GAS_BRICK; x += LANES) {
                const struct flow flow = flow_at(space->velocity, x + BELOW, y + BELOW, z + BELOW);
                vf way[3];
                way_of(&flow, step->cells_a_velocity, way);
                for (int c = 0; c < 3; c++) {
                    const vf forth = gas_way_forth(flow.u[c] * step->cells_a_velocity, way[c]);
                    most[c] = vf_max(most[c], vf_max(vf_abs(way[c]), vf_abs(forth)));
                    vf_store(&space->way[c][z][y][x], way[c]);
                }
            }
    return (struct reach){any(most[0] > 1.0f) ? 2 : 1, any(most[1] > 1.0f) ? 2 : 1,
                          any(most[2] > 1.0f) ? 2 : 1};
}

/* Traces the cells of a brick that are near walls. */
static void trace_beside_walls(const struct gas_workspace *space, const struct rows *rows,
                               float *traced)
{
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++)
            for (int32_t x = 0; space->near_wall[z][y] >> x; x++)
                if (is_near_wall(space, x, y, z)) {
                    const struct wall_mix mix = wall_mix_of(space, x, y, z);
                    mix_beside_walls(rows, &mix,
                                     traced + traced_row(z * GAS_BRICK + y) +
                                         (ptrdiff_t)x * GAS_TRACED);
                }
}

/* Gives the first traced cell of each row to the brick to the left, whose rows end with it. A brick
 * whose neighbour to the right has none takes it as it was. */
static void share_ends(const struct gas_pass *pass, gas_brick_place at,
                       const struct kiln_gas_brick *brick)
{
    const bool last = at.x + 1 == pass->gas->bricks.x;
    const bool left = at.x > 0 && brick[-1].joined, right = !last && brick[1].joined;
    const ptrdiff_t to_end = (ptrdiff_t)GAS_BRICK * GAS_TRACED;
    for (int32_t row = 0; row < GAS_BRICK * GAS_BRICK; row++) {
        const ptrdiff_t at_row = traced_row(row), at_end = at_row + to_end;
        float *cells = brick->traced + at_row, *end = cells + to_end;
        if (left)
            copy_eight(brick[-1].traced + at_end, cells);
        if (last) {
            copy_eight(end, end - GAS_TRACED);
            if (!pass->closed[1])
                make_outer(&pass->forces, end);
        } else if (!right) {
            copy_eight(end, brick->joined + at_end);
        }
    }
}

static void trace_brick(const struct gas_pass *pass, gas_brick_place at,
                        struct gas_workspace *space)
{
    const struct kiln_gas *gas = pass->gas;
    struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(gas, at.x, at.y, at.z)];
    struct around around;
    struct rows rows;
    around_of(&around, pass, at);
    find_flow(gas, &around, space, 1);
    const struct reach reach = find_ways(pass->step, space);
    find_rows(pass, &around, false, space, reach, &rows);
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            float *to = brick->traced + traced_row(z * GAS_BRICK + y);
            struct places p;
            places_from(&p, space, y, z);
            for (int i = 0; i < GAS_BRICK; i++, to += GAS_TRACED)
                eight_store(to, mixed(rows.of + p.row[i], p.at[i], &p.x[i], &p.y[i], &p.z[i]));
        }
    if (around.walls) {
        gather_walls(&around, space);
        trace_beside_walls(space, &rows, brick->traced);
    }
    share_ends(pass, at, brick);
    if (brick->extras)
        trace_extras(pass, &around, brick, space);
}

/* Holds which floats of a cell a limiter is for: all bits of those are set. */
struct limits {
    struct eight clamped, kept;
};

static struct limits limits_of(const struct kiln_gas_step *step)
{
    int32_t clamped[GAS_TRACED] = {0}, kept[GAS_TRACED] = {0};
    for (int c = 0; c < 3; c++)
        (step->keep_velocity ? kept : clamped)[c] = -1;
    clamped[GAS_CARRIED_AT + GAS_SMOKE] = -1;
    struct limits limits;
    memcpy(&limits.clamped, clamped, sizeof clamped);
    memcpy(&limits.kept, kept, sizeof kept);
    return limits;
}

/* Returns the corrected value of a cell. own: the cell before the step; traced: after it was
 * traced; row, x: the lowest of the eight cells from which it came, as for `mixed`; forth: the
 * traced value at the place that the cell goes to. A quantity that neither is clamped nor kept gets
 * less of its correction the less room it has. */
SIMD struct eight corrected(const float *own, const float *traced, const float *const *row,
                            int32_t x, struct eight forth, const struct limits *limits)
{
    struct eight result;
    const float *a = row[0] + x, *b = row[UP] + x, *c = row[ON] + x, *d = row[ON + UP] + x;
    EIGHT_EACH(k)
    {
        const int o = k * LANES;
        const vf now = vf_load(own + o), base = vf_load(traced + o);
#define PAIR_OF(of, q) of(vf_load((q) + o), vf_load((q) + o + GAS_TRACED))
#define CORNER(of)     of(of(PAIR_OF(of, a), PAIR_OF(of, b)), of(PAIR_OF(of, c), PAIR_OF(of, d)))
        const vf low = CORNER(vf_min), high = CORNER(vf_max);
        const vf error = gas_error(now, forth.part[k]);
        const vf value = vf_select((vi)limits->clamped.part[k], gas_clamped(base, error, low, high),
                                   gas_softly(base, error, low, high));
        result.part[k] =
            vf_select((vi)limits->kept.part[k], gas_kept(base, error, low, high), value);
    }
    return result;
}

/* Returns the differences that make up the vorticity. */
SIMD void spin_of(const struct flow *flow, vf spin[3])
{
    spin[0] = flow->change[2][1] - flow->change[1][2];
    spin[1] = flow->change[0][2] - flow->change[2][0];
    spin[2] = flow->change[1][0] - flow->change[0][1];
}

/* Computes the length of the vorticity in m/s over two cells, for a brick and one cell around it.
 */
static void spins(struct gas_workspace *space)
{
    for (int32_t z = 0; z < GAS_BRICK + 2; z++)
        for (int32_t y = 0; y < GAS_BRICK + 2; y++)
            for (int32_t x = 0; x < GAS_BRICK + 2; x += LANES) {
                const struct flow flow = flow_at(space->velocity, x + 1, y + 1, z + 1);
                vf spin[3];
                spin_of(&flow, spin);
                vf_store(&space->spin[z][y][x], gas_spin(spin[0], spin[1], spin[2]));
            }
}

/* Adds the push of vorticity confinement, towards where vorticity is greatest. */
SIMD void confine(const struct gas_workspace *space, const struct flow *flow, float push, int lane,
                  int32_t y, int32_t z, vf u[3])
{
    vf spin[3];
    spin_of(flow, spin);
    const float *l = &space->spin[z + 1][y + 1][lane + 1];
    const ptrdiff_t up = GAS_EDGE_ROW, on = (GAS_BRICK + 2) * up;
    const vf gx = vf_load(l + 1) - vf_load(l - 1);
    const vf gy = vf_load(l + up) - vf_load(l - up);
    const vf gz = vf_load(l + on) - vf_load(l - on);
    const vf scale = gas_confinement(gx, gy, gz, push);
    u[0] = gas_confined(u[0], scale, gy, spin[2], gz, spin[1]);
    u[1] = gas_confined(u[1], scale, gz, spin[0], gx, spin[2]);
    u[2] = gas_confined(u[2], scale, gx, spin[1], gy, spin[0]);
}

/* Adds a part of the velocity's Laplacian. */
SIMD void smooth(velocities *velocity, float part, int lane, int32_t y, int32_t z, vf u[3])
{
    for (int c = 0; c < 3; c++) {
        const float *p = &velocity[c][z + BELOW][y + BELOW][lane + BELOW];
        const ptrdiff_t up = GAS_EDGE_ROW, on = GAS_EDGE * up;
        const vf around = gas_around(vf_load(p - 1), vf_load(p + 1), vf_load(p - up),
                                     vf_load(p + up), vf_load(p - on), vf_load(p + on));
        u[c] = gas_smoothed(u[c], vf_load(p), around, part);
    }
}

/* Holds what pushes the gas of a row of cells. */
struct pushes {
    struct eight noise[3], forces[4];
};

static void find_pushes(const struct gas_pass *pass, gas_brick_place at,
                        const struct gas_workspace *space, int32_t y, int32_t z,
                        struct pushes *pushes)
{
    if (pass->stir.strength > 0.0f)
        for (int c = 0; c < 3; c++)
            pushes->noise[c] = noise_of_row(space, c, y, z);
    if (pass->forces.points)
        forces_of_row(pass, at, y, z, pushes->forces);
}

/* Applies forces over a step. */
SIMD void apply_forces(const struct gas_pass *pass, const struct pushes *pushes, int k, vf u[3])
{
    const float dt = pass->step->dt, *turn = pass->forces.twice_spin;
    const vf slower = gas_slowed(pushes->forces[3].part[k], dt), x = u[0], y = u[1], z = u[2];
    u[0] = gas_forced(x, pushes->forces[0].part[k], y, turn[2], z, turn[1], dt, slower);
    u[1] = gas_forced(y, pushes->forces[1].part[k], z, turn[0], x, turn[2], dt, slower);
    u[2] = gas_forced(z, pushes->forces[2].part[k], x, turn[1], y, turn[0], dt, slower);
}

/* Pushes LANES cells of a row. */
SIMD void push_cells(const struct gas_pass *pass, struct gas_workspace *space,
                     const struct flow *flow, const struct gas_carried *gas,
                     const struct pushes *pushes, int k, int32_t y, int32_t z, vf u[3])
{
    const struct kiln_gas_step *step = pass->step;
    const vf hot = gas->temperature, smoke = gas->smoke;
    if (step->smoothing > 0.0f)
        smooth(space->velocity, step->smoothing, k * LANES, y, z, u);
    u[0] = gas_buoyant(u[0], hot, smoke, step->rise.x, step->sink.x);
    u[1] = gas_buoyant(u[1], hot, smoke, step->rise.y, step->sink.y);
    u[2] = gas_buoyant(u[2], hot, smoke, step->rise.z, step->sink.z);
    if (step->confinement > 0.0f)
        confine(space, flow, step->confinement, k * LANES, y, z, u);
    if (pass->stir.strength > 0.0f) {
        const vf there = gas_stirred(smoke, hot, gas->flame, pass->stir.strength);
        for (int c = 0; c < 3; c++)
            u[c] = u[c] + there * pushes->noise[c].part[k];
    }
    if (pass->forces.points)
        apply_forces(pass, pushes, k, u);
    for (int c = 0; c < 3; c++)
        u[c] = u[c] * step->slow;
}

/* Finds the corrected values of a row of cells, eight floats each. */
SIMD void correct_row(const struct gas_workspace *space, const struct rows *now,
                      const struct rows *traced, const struct kiln_gas_brick *brick,
                      const struct limits *limits, float scale, int32_t y, int32_t z,
                      float cells[GAS_BRICK * GAS_TRACED])
{
    struct places forth, back;
    places_from(&back, space, y, z);
    places_to(&forth, space, scale, y, z);
    const ptrdiff_t own = traced_row(z * GAS_BRICK + y);
    for (int i = 0; i < GAS_BRICK; i++) {
        const ptrdiff_t to = (ptrdiff_t)i * GAS_TRACED, cell = own + to;
        const struct eight there =
            mixed(traced->of + forth.row[i], forth.at[i], &forth.x[i], &forth.y[i], &forth.z[i]);
        eight_store(cells + to, corrected(brick->joined + cell, brick->traced + cell,
                                          now->of + back.row[i], back.at[i], there, limits));
    }
}

/* Beside walls the scheme is not corrected, and nothing is in a solid. Returns a bit for each cell
 * of the row that is in one. */
static uint32_t keep_beside_walls(const struct gas_workspace *space,
                                  const struct kiln_gas_brick *brick, int32_t y, int32_t z,
                                  float cells[GAS_BRICK * GAS_TRACED])
{
    const float *traced = brick->traced + traced_row(z * GAS_BRICK + y);
    uint32_t solid = 0;
    for (int32_t x = 0; space->near_wall[z][y] >> x; x++) {
        if (!is_near_wall(space, x, y, z))
            continue;
        const ptrdiff_t place = (ptrdiff_t)x * GAS_TRACED;
        float *cell = cells + place;
        copy_eight(cell, traced + place);
        if (!(space->wall[wall_at(x, y, z)] & GAS_SOLID))
            continue;
        solid |= 1u << x;
        memset(cell + GAS_CARRIED_AT, 0, GAS_CARRIED * sizeof *cell);
    }
    return solid;
}

/* No force acts in a solid, and nothing burns there. */
static void hold_solids(struct kiln_gas_brick *brick, uint32_t solid, ptrdiff_t row,
                        float *expansions)
{
    for (int32_t x = 0; x < GAS_BRICK; x++) {
        if (!(solid >> x & 1))
            continue;
        for (int c = 0; c < GAS_CHANGE; c++)
            brick->change[(ptrdiff_t)c * GAS_BRICK_CELLS + row + x] = 0.0f;
        expansions[x] = 0.0f;
    }
}

/* Sums up what a brick has. The order of the sums is the same at every level of vectors. */
struct sums {
    struct eight moved, left, growth;
    vf most[GAS_CARRIED];
    vf wrong; /* 0, or NaN */
};

static double sum_of_eight(struct eight x)
{
    float numbers[8];
    double sum = 0.0;
    eight_store(numbers, x);
    for (int i = 0; i < 8; i++)
        sum += (double)numbers[i];
    return sum;
}

SIMD void store_carried(float *to, const struct gas_carried *gas, struct sums *sums)
{
    const vf after[GAS_CARRIED] = {gas->smoke, gas->temperature, gas->fuel, gas->flame};
    for (int c = 0; c < GAS_CARRIED; c++) {
        sums->most[c] = vf_max(sums->most[c], after[c]);
        sums->wrong = sums->wrong + after[c] * 0.0f;
    }
    const struct columns each = columns_transpose(after[0], after[1], after[2], after[3]);
    for (ptrdiff_t part = 0; part < LANES / 4; part++)
        for (int i = 0; i < 4; i++)
            memcpy(to + (4 * part + i) * GAS_CARRIED, (const char *)&each.c[i] + 16 * part, 16);
}

/* Burns and pushes a row of cells. cells: their corrected values. */
SIMD void react_row(const struct gas_pass *pass, struct gas_workspace *space,
                    struct kiln_gas_brick *brick, float *expansions, const float *cells,
                    const struct pushes *pushes, int32_t y, int32_t z, struct sums *sums)
{
    const ptrdiff_t row = gas_row_of_brick(y, z);
    struct eight columns[GAS_TRACED];
    eight_columns(cells, columns);
    EIGHT_EACH(k)
    {
        const int lane = k * LANES;
        const struct eight *carried = columns + GAS_CARRIED_AT;
        float *change = brick->change + row + lane;
        const struct flow flow = flow_at(space->velocity, lane + BELOW, y + BELOW, z + BELOW);
        sums->moved.part[k] = sums->moved.part[k] + carried[GAS_SMOKE].part[k];
        struct gas_carried gas = {carried[GAS_SMOKE].part[k], carried[GAS_TEMPERATURE].part[k],
                                  carried[GAS_FUEL].part[k], carried[GAS_FLAME].part[k],
                                  vf_all(0.0f)};
        gas = gas_burn(gas, *pass->step);
        vf u[3] = {columns[0].part[k], columns[1].part[k], columns[2].part[k]};
        push_cells(pass, space, &flow, &gas, pushes, k, y, z, u);
        for (int c = 0; c < 3; c++) {
            vf_store(change + (ptrdiff_t)c * GAS_BRICK_CELLS, u[c] - flow.u[c]);
            sums->wrong = sums->wrong + u[c] * 0.0f;
        }
        const vf expansion = gas.burnt * pass->step->expansion;
        vf_store(expansions + lane, expansion);
        sums->left.part[k] = sums->left.part[k] + gas.smoke;
        sums->growth.part[k] = sums->growth.part[k] + gas.smoke * expansion;
        store_carried(brick->now + (row + lane) * GAS_CARRIED, &gas, sums);
    }
}

static struct gas_found react(const struct gas_pass *pass, gas_brick_place at,
                              struct gas_workspace *space)
{
    const struct kiln_gas *gas = pass->gas;
    struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(gas, at.x, at.y, at.z)];
    const bool confined = pass->step->confinement > 0.0f;
    const int32_t cells_around = confined ? 2 : 1;
    struct around around;
    struct rows now, traced;
    around_of(&around, pass, at);
    find_flow(gas, &around, space, cells_around);
    const struct reach reach = find_ways(pass->step, space);
    find_rows(pass, &around, false, space, reach, &now);
    find_rows(pass, &around, true, space, reach, &traced);
    if (around.walls)
        gather_walls(&around, space);
    if (confined)
        spins(space);
    if (pass->stir.strength > 0.0f)
        find_noise(&pass->stir, gas_first_cell(gas, at), space);
    const struct limits limits = limits_of(pass->step);
    struct sums sums = {.wrong = vf_all(0.0f)};
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            _Alignas(32) float cells[GAS_BRICK * GAS_TRACED];
            struct pushes pushes;
            float *expansions = pass->expansion + gas_row_of_window(gas, at, y, z);
            correct_row(space, &now, &traced, brick, &limits, pass->step->cells_a_velocity, y, z,
                        cells);
            const uint32_t solid = around.walls ? keep_beside_walls(space, brick, y, z, cells) : 0;
            find_pushes(pass, at, space, y, z, &pushes);
            react_row(pass, space, brick, expansions, cells, &pushes, y, z, &sums);
            if (solid)
                hold_solids(brick, solid, gas_row_of_brick(y, z), expansions);
        }
    const vi some =
        (sums.most[GAS_SMOKE] > GAS_LEAST_SMOKE) | (sums.most[GAS_FUEL] > GAS_LEAST_SMOKE) |
        (sums.most[GAS_TEMPERATURE] > GAS_LEAST_HEAT) | (sums.most[GAS_FLAME] > GAS_LEAST_HEAT);
    return (struct gas_found){.has_gas = any(some),
                              .is_wrong = has_nan(sums.wrong),
                              .moved = sum_of_eight(sums.moved),
                              .left = sum_of_eight(sums.left),
                              .growth = sum_of_eight(sums.growth)};
}

/* Only gas is stirred, and has its eddies kept: not the air in the bricks around it. */
static struct gas_found react_brick(const struct gas_pass *pass, gas_brick_place at,
                                    struct gas_workspace *space)
{
    const struct kiln_gas *gas = pass->gas;
    if (gas->has_gas[kiln_gas_brick_index(gas, at.x, at.y, at.z)])
        return react(pass, at, space);
    struct kiln_gas_step step = *pass->step;
    struct gas_pass calm = *pass;
    step.confinement = 0.0f;
    calm.step = &step;
    calm.stir.strength = 0.0f;
    return react(&calm, at, space);
}

static void blow_brick(const struct gas_pass *pass, gas_brick_place at, struct gas_workspace *space)
{
    const struct kiln_gas *gas = pass->gas;
    float *change = gas->brick[kiln_gas_brick_index(gas, at.x, at.y, at.z)].change;
    struct around around;
    around_of(&around, pass, at);
    find_flow(gas, &around, space, 0);
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            float *row = change + gas_row_of_brick(y, z);
            struct pushes pushes;
            forces_of_row(pass, at, y, z, pushes.forces);
            EIGHT_EACH(k)
            {
                vf u[3], before[3];
                for (int c = 0; c < 3; c++)
                    u[c] = before[c] =
                        vf_load(&space->velocity[c][z + BELOW][y + BELOW][k * LANES + BELOW]);
                apply_forces(pass, &pushes, k, u);
                for (int c = 0; c < 3; c++)
                    vf_store(row + (ptrdiff_t)c * GAS_BRICK_CELLS + (ptrdiff_t)k * LANES,
                             u[c] - before[c]);
            }
        }
}

const struct gas_advect KILN_SIMD_NAME(kiln_gas_advect) = {
    .join = join_brick,
    .trace = trace_brick,
    .react = react_brick,
    .blow = blow_brick,
    .noise = noise_of_points,
};
