/* Takes the change of velocity from the cells of gas to the faces between them, and what the
 * pressure leaves of it back to the cells.
 *
 * Velocities are moved along at the centres of cells, and projected on faces, where the compact
 * Laplacian makes them flow out of each cell exactly as much as they should. Centres then take the
 * mean of their faces. Projected at centres, velocities keep waves of two cells, which show as
 * combs within a second. */
#include <math.h>

#include "sim/gas/faces.h"
#include "sim/gas/gas_lanes.h"

enum { MOST_ROW = 8192 + 2 * KILN_GAS_PAD };

static const struct kiln_gas_brick *brick_at(const struct kiln_gas *gas, int32_t x, int32_t y,
                                             int32_t z)
{
    if (x < 0 || y < 0 || z < 0 || x >= gas->bricks.x || y >= gas->bricks.y || z >= gas->bricks.z)
        return NULL;
    return &gas->brick[kiln_gas_brick_index(gas, x, y, z)];
}

/* Returns a row of a plane of a brick's changes: zeros where the brick is idle. */
static const float *change_of(const struct kiln_gas_brick *brick, int plane, int32_t y, int32_t z)
{
    static const float none[GAS_BRICK];
    if (!brick || !brick->change)
        return none;
    return brick->change + (ptrdiff_t)plane * GAS_BRICK_CELLS + gas_row_of_brick(y, z);
}

SIMD void add_means(float *faces, const float *a, const float *b)
{
    for (int32_t x = 0; x < GAS_BRICK; x += LANES)
        vf_store(faces + x, vf_load(faces + x) + 0.5f * (vf_load(a + x) + vf_load(b + x)));
}

/* Gives faces on solids the velocity of the solid, in a row of a brick's cells. */
static void hold_row(const struct gas_wall *wall, ptrdiff_t row, float *const faces[3])
{
    for (int axis = 0; axis < 3; axis++)
        for (int32_t x = 0; x < GAS_BRICK; x++)
            if (wall->open[axis][row + x] == 0.0f)
                faces[axis][x] = wall->speed[axis][row + x];
}

/* Holds a brick and those below it on each axis, NULL beyond the window, and the brick's wall. */
struct pushed {
    gas_brick_place at;
    const struct kiln_gas_brick *own, *left, *below, *behind;
    const struct gas_wall *wall; /* or NULL */
};

/* Pushes the upper faces of the window in a row of a brick. row: the changes of the cells. */
static void push_last(const struct kiln_gas *gas, const bool *closed, const struct pushed *brick,
                      int32_t y, int32_t z, const float *const row[3], float *const faces[3])
{
    const struct kiln_gas_place n = gas->bricks;
    const bool top = brick->at.y + 1 == n.y && y + 1 == GAS_BRICK;
    const bool end = brick->at.z + 1 == n.z && z + 1 == GAS_BRICK;
    if (top && !closed[3])
        add_means(faces[1] + gas->row, row[1], row[1]);
    if (end && !closed[5])
        add_means(faces[2] + gas->plane, row[2], row[2]);
    if (brick->at.x + 1 == n.x && !closed[1])
        faces[0][GAS_BRICK] += row[0][GAS_BRICK - 1];
}

/* Pushes the faces of a row of a brick's cells. */
static void push_row(const struct kiln_gas *gas, const bool *closed, const struct pushed *brick,
                     int32_t y, int32_t z)
{
    const struct kiln_gas_brick *own = brick->own, *left = brick->left;
    const ptrdiff_t cell = gas_row_of_window(gas, brick->at, y, z);
    float *u = gas->faces[0] + cell, *v = gas->faces[1] + cell, *w = gas->faces[2] + cell;
    float *const faces[3] = {u, v, w};
    const float *const row[3] = {change_of(own, 0, y, z), change_of(own, 1, y, z),
                                 change_of(own, 2, y, z)};
    /* beyond an open side, the velocity changes as it does before it */
    float before[GAS_BRICK];
    before[0] = left ? change_of(left, 0, y, z)[GAS_BRICK - 1] : row[0][0];
    memcpy(before + 1, row[0], (GAS_BRICK - 1) * sizeof *before);
    const float *under = y > 0          ? change_of(own, 1, y - 1, z)
                         : brick->below ? change_of(brick->below, 1, GAS_BRICK - 1, z)
                                        : row[1];
    const float *back = z > 0           ? change_of(own, 2, y, z - 1)
                        : brick->behind ? change_of(brick->behind, 2, y, GAS_BRICK - 1)
                                        : row[2];
    const float first = u[0];
    add_means(u, before, row[0]);
    if (!left && closed[0])
        u[0] = first;
    if (under != row[1] || !closed[2])
        add_means(v, under, row[1]);
    if (back != row[2] || !closed[4])
        add_means(w, back, row[2]);
    push_last(gas, closed, brick, y, z, row, faces);
    if (brick->wall)
        hold_row(brick->wall, gas_row_of_brick(y, z), faces);
}

static void push(const struct gas_pass *pass, const struct gas_level *level, gas_brick_place at)
{
    const struct kiln_gas *gas = pass->gas;
    const struct pushed brick = {
        .at = at,
        .own = brick_at(gas, at.x, at.y, at.z),
        .left = brick_at(gas, at.x - 1, at.y, at.z),
        .below = brick_at(gas, at.x, at.y - 1, at.z),
        .behind = brick_at(gas, at.x, at.y, at.z - 1),
        .wall = pass->walls ? pass->walls[kiln_gas_brick_index(gas, at.x, at.y, at.z)] : NULL,
    };
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++)
            push_row(gas, level->closed, &brick, y, z);
}

/* Stores the cells of a row of even and odd x apart. */
SIMD void store_apart(float *even, float *odd, const float *row)
{
#if LANES == 8
    const __m256 a = _mm256_loadu_ps(row), b = _mm256_loadu_ps(row + 8);
    const __m256 e = _mm256_shuffle_ps(a, b, 0x88), o = _mm256_shuffle_ps(a, b, 0xdd);
    vf_store(even, (vf)_mm256_permute4x64_pd((__m256d)e, 0xd8));
    vf_store(odd, (vf)_mm256_permute4x64_pd((__m256d)o, 0xd8));
#else
    const vf a = vf_load(row), b = vf_load(row + 4);
    vf_store(even, __builtin_shufflevector(a, b, 0, 2, 4, 6));
    vf_store(odd, __builtin_shufflevector(a, b, 1, 3, 5, 7));
#endif
}

/* Puts the cells of a row of even and odd x in turn. */
SIMD void joined_of(vf even, vf odd, vf joined[2])
{
#if LANES == 8
    const __m256 low = _mm256_unpacklo_ps((__m256)even, (__m256)odd);
    const __m256 high = _mm256_unpackhi_ps((__m256)even, (__m256)odd);
    joined[0] = (vf)_mm256_permute2f128_ps(low, high, 0x20);
    joined[1] = (vf)_mm256_permute2f128_ps(low, high, 0x31);
#else
    joined[0] = __builtin_shufflevector(even, odd, 0, 4, 1, 5);
    joined[1] = __builtin_shufflevector(even, odd, 2, 6, 3, 7);
#endif
}

/* Returns what flows through a face of a cell beside solids: gas through its open part, and the
 * solid itself through the rest. */
static float flow_through(const struct gas_wall *wall, int axis, int32_t cell, float velocity)
{
    const float open = wall->open[axis][cell];
    return open * velocity + (1.0f - open) * wall->speed[axis][cell];
}

/* Returns what flows out of a cell along an axis, in a brick that is beside solids. faces: of the
 * axis, from the cell's lower one on; next: to its upper one. */
static float flow_along(const struct gas_pass *pass, gas_brick_place b, const int32_t place[3],
                        int axis, const float *faces, ptrdiff_t next)
{
    const struct kiln_gas *gas = pass->gas;
    const struct gas_wall *wall = pass->walls[kiln_gas_brick_index(gas, b.x, b.y, b.z)];
    const bool in_next = place[axis] + 1 == GAS_BRICK;
    const int32_t stride = axis == 0 ? 1 : axis == 1 ? GAS_BRICK : GAS_BRICK * GAS_BRICK;
    const int32_t cell = (place[2] * GAS_BRICK + place[1]) * GAS_BRICK + place[0];
    const int32_t above = in_next ? cell - (GAS_BRICK - 1) * stride : cell + stride;
    const gas_brick_place c = {b.x + (in_next && axis == 0), b.y + (in_next && axis == 1),
                               b.z + (in_next && axis == 2)};
    const bool inside = c.x < gas->bricks.x && c.y < gas->bricks.y && c.z < gas->bricks.z;
    const struct gas_wall *next_wall =
        inside ? pass->walls[kiln_gas_brick_index(gas, c.x, c.y, c.z)] : NULL;
    const float low = wall ? flow_through(wall, axis, cell, faces[0]) : faces[0];
    const float high = next_wall ? flow_through(next_wall, axis, above, faces[next]) : faces[next];
    return high - low;
}

/* Replaces the outflow of the cells of a brick's row that are beside solids. at: of the row in the
 * arrays of faces; b: of the brick. */
static void diverge_walled(const struct gas_pass *pass, gas_brick_place b, int32_t y, int32_t z,
                           ptrdiff_t at, float *outflow)
{
    const struct kiln_gas *gas = pass->gas;
    for (int32_t x = 0; x < GAS_BRICK; x++) {
        const int32_t place[3] = {x, y, z};
        const ptrdiff_t i = at + x;
        const float along_x = flow_along(pass, b, place, 0, gas->faces[0] + i, 1);
        const float along_y = flow_along(pass, b, place, 1, gas->faces[1] + i, gas->row);
        const float along_z = flow_along(pass, b, place, 2, gas->faces[2] + i, gas->plane);
        outflow[x] = (along_x + along_y) + along_z;
    }
}

static bool has_walls(const struct gas_pass *pass, gas_brick_place b)
{
    const struct kiln_gas *gas = pass->gas;
    const struct kiln_gas_place n = gas->bricks;
    for (int i = 0; i < 4; i++) {
        const gas_brick_place c = {b.x + (i == 1), b.y + (i == 2), b.z + (i == 3)};
        if (c.x < n.x && c.y < n.y && c.z < n.z &&
            pass->walls[kiln_gas_brick_index(gas, c.x, c.y, c.z)])
            return true;
    }
    return false;
}

/* Computes what a row of cells of the window lacks for its outflow to be as it should: the right
 * side of the equation of pressure. expansion: of the row's cells. */
SIMD void lacks_of_row(const struct gas_pass *pass, int32_t y, int32_t z, const float *expansion,
                       float *numbers)
{
    const struct kiln_gas *gas = pass->gas;
    const ptrdiff_t row = gas->row, plane = gas->plane, at = z * plane + y * row;
    const float cell = pass->step->cell, square = cell * cell;
    const float *u = gas->faces[0] + at, *v = gas->faces[1] + at, *w = gas->faces[2] + at;
    for (int32_t x = 0; x < gas->cells.x; x += GAS_BRICK) {
        const gas_brick_place b = {x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK};
        const bool active = gas->brick[kiln_gas_brick_index(gas, b.x, b.y, b.z)].chunk;
        EIGHT_EACH(k)
        {
            const int32_t i = x + k * LANES;
            const vf d =
                ((vf_load(u + i + 1) - vf_load(u + i)) + (vf_load(v + i + row) - vf_load(v + i))) +
                (vf_load(w + i + plane) - vf_load(w + i));
            vf_store(numbers + i, d);
        }
        if (pass->walls && has_walls(pass, b))
            diverge_walled(pass, b, y % GAS_BRICK, z % GAS_BRICK, at + x, numbers + x);
        EIGHT_EACH(k)
        {
            const int32_t i = x + k * LANES;
            vf d = vf_load(numbers + i) * cell;
            if (active)
                d = d - square * vf_load(expansion + i);
            vf_store(numbers + i, d);
        }
    }
}

static void diverge(const struct gas_pass *pass, const struct gas_level *level, int32_t begin,
                    int32_t end)
{
    const struct kiln_gas *gas = pass->gas;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < gas->cells.y; y++) {
            float *f = level->f + z * gas->plane + y * gas->row;
            float numbers[MOST_ROW];
            lacks_of_row(pass, y, z, f, numbers);
            for (int32_t x = 0; x < gas->cells.x && level->walled; x++)
                if (level->walled[z * gas->cells.y + y] && !gas_level_is_open(level, x, y, z))
                    numbers[x] = 0.0f;
            for (int32_t x = 0; x < gas->cells.x; x += 2 * LANES)
                store_apart(f + x / 2, f + level->odd + x / 2, numbers + x);
            memset(f + gas->cells.x / 2, 0, KILN_GAS_PAD * sizeof *f);
        }
}

/* Holds what pressure takes off the faces of a vector of cells of even x, and of the odd ones
 * behind them. */
struct gradients {
    vf even[3], odd[3];
};

/* Takes nothing off faces that are shut. */
SIMD void keep_shut(const struct gas_level *level, ptrdiff_t at, ptrdiff_t i, struct gradients *g)
{
    for (int axis = 0; axis < 3; axis++) {
        const float *open = level->open[axis] + at + i;
        g->even[axis] = vf_where(vf_load(open) > 0.0f, g->even[axis]);
        g->odd[axis] = vf_where(vf_load(open + level->odd) > 0.0f, g->odd[axis]);
    }
}

/* Takes the gradient off the upper faces of the last row of an axis. p beyond is that of the row
 * itself with the opposite sign. */
SIMD void project_last(float *faces, vf even, vf odd, const float *open,
                       const struct gas_level *level, ptrdiff_t i, float scale)
{
    vf pair[2];
    if (open) {
        even = vf_where(vf_load(open + i) > 0.0f, even);
        odd = vf_where(vf_load(open + level->odd + i) > 0.0f, odd);
    }
    joined_of(even, odd, pair);
    for (int k = 0; k < 2; k++) {
        float *to = faces + 2 * i + (ptrdiff_t)k * LANES;
        vf_store(to, vf_load(to) + pair[k] * (2.0f * scale));
    }
}

/* Holds a row of the window whose velocities are projected. */
struct projected {
    ptrdiff_t at; /* in arrays */
    float *faces[3];
    const float *even, *odd; /* p */
    ptrdiff_t by_y, by_z;    /* to p below the row on these axes */
    float sign_y, sign_z;    /* of that p */
    bool walled;
    bool last_y, last_z; /* whether the row's upper faces are on open sides of the window */
    float scale;
};

SIMD struct projected projected_row(const struct gas_pass *pass, const struct gas_level *level,
                                    int32_t y, int32_t z)
{
    const struct kiln_gas *gas = pass->gas;
    const struct kiln_gas_place n = gas->cells;
    const ptrdiff_t at = z * gas->plane + y * gas->row;
    const bool *closed = level->closed, side_y = y == 0, side_z = z == 0;
    return (struct projected){
        .at = at,
        .faces = {gas->faces[0] + at, gas->faces[1] + at, gas->faces[2] + at},
        .even = level->p + at,
        .odd = level->p + at + level->odd,
        /* beyond an open side p has the opposite sign, so that it is 0 on the side */
        .by_y = side_y ? 0 : -gas->row,
        .by_z = side_z ? 0 : -gas->plane,
        .sign_y = !side_y || closed[2] ? 1.0f : -1.0f,
        .sign_z = !side_z || closed[4] ? 1.0f : -1.0f,
        .walled = level->walled && level->walled[z * n.y + y],
        .last_y = y == n.y - 1 && !closed[3],
        .last_z = z == n.z - 1 && !closed[5],
        .scale = 1.0f / pass->step->cell,
    };
}

/* Holds what is known of projected velocities. */
struct speeds {
    vf most, wrong; /* wrong: 0, or NaN */
};

/* Takes gradients off the faces of 2 * LANES cells of a row, from the 2 * i-th on. */
SIMD void take_gradients(const struct projected *row, const struct gradients *g, ptrdiff_t i,
                         struct speeds *speeds)
{
    for (int axis = 0; axis < 3; axis++) {
        vf pair[2];
        joined_of(g->even[axis], g->odd[axis], pair);
        for (int k = 0; k < 2; k++) {
            float *face = row->faces[axis] + 2 * i + (ptrdiff_t)k * LANES;
            const vf u = vf_load(face) - pair[k] * row->scale;
            speeds->most = vf_max(speeds->most, vf_abs(u));
            speeds->wrong = speeds->wrong + u * 0.0f;
            vf_store(face, u);
        }
    }
}

/* Projects the faces of a row but those on the window's sides across x. */
SIMD void project_row(const struct kiln_gas *gas, const struct gas_level *level,
                      const struct projected *row, struct speeds *speeds)
{
    const float *even = row->even, *odd = row->odd;
    const ptrdiff_t by_y = row->by_y, by_z = row->by_z;
    const float sign_y = row->sign_y, sign_z = row->sign_z;
    const float *const open_y = row->walled ? level->open[1] + row->at + gas->row : NULL;
    const float *const open_z = row->walled ? level->open[2] + row->at + gas->plane : NULL;
    for (ptrdiff_t i = 0; 2 * i < gas->cells.x; i += LANES) {
        const vf e = vf_load(even + i), o = vf_load(odd + i);
        struct gradients g = {
            {e - vf_load(odd + i - 1), e - sign_y * vf_load(even + i + by_y),
             e - sign_z * vf_load(even + i + by_z)},
            {o - e, o - sign_y * vf_load(odd + i + by_y), o - sign_z * vf_load(odd + i + by_z)}};
        if (row->walled)
            keep_shut(level, row->at, i, &g);
        take_gradients(row, &g, i, speeds);
        if (row->last_y)
            project_last(row->faces[1] + gas->row, e, o, open_y, level, i, row->scale);
        if (row->last_z)
            project_last(row->faces[2] + gas->plane, e, o, open_z, level, i, row->scale);
    }
}

/* Projects the first and the last face of a row across x. first, last: their velocities before.
 * Returns the greater speed of the two. */
SIMD float project_ends(const struct gas_level *level, const struct projected *row, int32_t n,
                        float first, float last)
{
    float *faces = row->faces[0];
    const float *open = row->walled ? level->open[0] + row->at : NULL;
    const bool shut[2] = {level->closed[0] || (open && open[0] == 0.0f),
                          level->closed[1] || (open && open[n / 2] == 0.0f)};
    faces[0] = shut[0] ? first : first - 2.0f * row->even[0] * row->scale;
    faces[n] = shut[1] ? last : last + 2.0f * row->odd[n / 2 - 1] * row->scale;
    return fmaxf(fabsf(faces[0]), fabsf(faces[n]));
}

static float project(const struct gas_pass *pass, const struct gas_level *level, int32_t begin,
                     int32_t end)
{
    const struct kiln_gas_place n = pass->gas->cells;
    struct speeds speeds = {vf_all(0.0f), vf_all(0.0f)};
    float edge = 0.0f;
    for (int32_t z = begin; z < end; z++)
        for (int32_t y = 0; y < n.y; y++) {
            const struct projected row = projected_row(pass, level, y, z);
            const float first = row.faces[0][0], last = row.faces[0][n.x];
            project_row(pass->gas, level, &row, &speeds);
            edge = fmaxf(edge, project_ends(level, &row, n.x, first, last));
        }
    for (int k = 0; k < LANES; k++)
        edge = speeds.most[k] > edge ? speeds.most[k] : edge;
    return has_nan(speeds.wrong) ? NAN : edge;
}

const struct gas_faces KILN_SIMD_NAME(kiln_gas_faces) = {
    .push = push,
    .diverge = diverge,
    .project = project,
};
