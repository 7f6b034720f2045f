/* Finds cells of the levels of pressure. A row of a level keeps its cells of even x apart from those
 * of odd x (lib/sim/gas/multigrid.h). */
#ifndef KILN_SIM_GAS_PRESSURE_GLSL
#define KILN_SIM_GAS_PRESSURE_GLSL

layout(std430, binding = GAS_BIND_P) GAS_USES_P buffer p_block
{
    float p[];
};

#ifdef GAS_USES_F
layout(std430, binding = GAS_BIND_F) GAS_USES_F buffer f_block
{
    float f[];
};
#endif

#ifdef GAS_WALLED
layout(std430, binding = GAS_BIND_OPEN) readonly buffer open_block
{
    float open[];
};

layout(std430, binding = GAS_BIND_WALLED) readonly buffer walled_block
{
    uint walled[];
};
#endif

/* A level: its cells, strides in floats, and where it begins in the buffers: words[0]: cells; the
 * level's part in p and f; [1]: row, plane, odd, the first cell in that part; [2]: first diagonal,
 * floats of an array of diagonals; [3]: first open face, floats from an axis to the next, first row
 * of cells beside walls. */
layout(location = GAS_AT_LEVEL) uniform uvec4 level_words[4];

struct level {
    uvec3 cells;
    uint row, plane, odd;
    uint first;              /* cell (0, 0, 0) in p and f */
    uint tables, table;      /* first diagonal; floats to the inverses */
    uint opens, open, walls; /* cell (0, 0, 0) of the first axis; floats to the next; rows */
};

level level_from(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    level l;
    l.cells = a.xyz;
    l.row = b.x;
    l.plane = b.y;
    l.odd = b.z;
    l.first = a.w + b.w;
    l.tables = c.x;
    l.table = c.y;
    l.opens = d.x + b.w;
    l.open = d.y;
    l.walls = d.z;
    return l;
}

level own_level()
{
    return level_from(level_words[0], level_words[1], level_words[2], level_words[3]);
}

uint row_of(level l, uint y, uint z)
{
    return z * l.plane + y * l.row;
}

/* Returns the place of a row's diagonals in their table. */
uint kind_of(level l, uint y, uint z)
{
    uint a = y == 0u ? 0u : y == l.cells.y - 1u ? 2u : 1u;
    uint b = z == 0u ? 0u : z == l.cells.z - 1u ? 2u : 1u;
    return (3u * b + a) * l.row;
}

bool is_walled(level l, uint y, uint z)
{
#ifdef GAS_WALLED
    return walled[l.walls + z * l.cells.y + y] != 0u;
#else
    return false;
#endif
}

/* The sum of p around a cell, and, beside walls, that of the open parts of its faces, by which p
 * then counts. */
struct around {
    float sum, open;
};

/* at: of a row; odd: 1 for cells of odd x; i: number of the cell among them. */
around around_of(level l, uint at, uint odd, uint i)
{
    uint own = l.first + at + odd * l.odd + i;
    uint other = l.first + at + (1u - odd) * l.odd + i + odd;
    float left = p[other - 1u];
    float right = p[other];
    float below = p[own - l.row];
    float above = p[own + l.row];
    float behind = p[own - l.plane];
    float before = p[own + l.plane];
    return around(gas_around(left, right, below, above, behind, before), 0.0f);
}

#ifdef GAS_WALLED
around weighed(level l, uint at, uint odd, uint i)
{
    uint own = at + odd * l.odd + i;
    uint other = at + (1u - odd) * l.odd + i + odd;
    uint x = l.opens;
    uint y = x + l.open;
    uint z = y + l.open;
    float a = open[x + own];
    float b = open[x + other];
    float c = open[y + own];
    float d = open[y + own + l.row];
    float e = open[z + own];
    float g = open[z + own + l.plane];
    own += l.first;
    other += l.first;
    precise float left = a * p[other - 1u];
    precise float right = b * p[other];
    precise float below = c * p[own - l.row];
    precise float above = d * p[own + l.row];
    precise float behind = e * p[own - l.plane];
    precise float before = g * p[own + l.plane];
    return around(gas_around(left, right, below, above, behind, before),
                  gas_around(a, b, c, d, e, g));
}
#endif

#ifdef GAS_USES_F
layout(std430, binding = GAS_BIND_TABLES) readonly buffer table_block
{
    float diagonals[];
};

/* Returns the residual of a cell. */
float residual_of(level l, uint y, uint z, uint odd, uint i)
{
    uint at = row_of(l, y, z);
    uint own = l.first + at + odd * l.odd + i;
#ifdef GAS_WALLED
    if (is_walled(l, y, z)) {
        around w = weighed(l, at, odd, i);
        precise float beside = f[own] - (w.sum - w.open * p[own]);
        return beside;
    }
#endif
    float d = diagonals[l.tables + kind_of(l, y, z) + odd * l.odd + i];
    precise float rest = f[own] - (around_of(l, at, odd, i).sum - d * p[own]);
    return rest;
}

/* Returns the relaxed p of a cell. fresh: p is zero everywhere, whatever it holds. */
float relaxed(level l, uint y, uint z, uint odd, uint i, bool fresh)
{
    uint at = row_of(l, y, z);
    uint own = l.first + at + odd * l.odd + i;
#ifdef GAS_WALLED
    if (is_walled(l, y, z)) {
        around w = weighed(l, at, odd, i);
        float sum = fresh ? 0.0f : w.sum;
        float inverse = exact_rcp_within(exact_max(w.open, 1e-6f));
        precise float beside = (sum - f[own]) * inverse;
        return w.open > 0.0f ? beside : 0.0f;
    }
#endif
    float inverse_of = diagonals[l.tables + l.table + kind_of(l, y, z) + odd * l.odd + i];
    float sum_of = fresh ? 0.0f : around_of(l, at, odd, i).sum;
    precise float value = (sum_of - f[own]) * inverse_of;
    return value;
}
#endif

#endif
