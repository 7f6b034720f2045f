/* Adds a coarser level's p to the cells of a colour. */
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

#define GAS_USES_P
#include "sim/gas/pressure.glsl"

layout(local_size_x = GAS_GROUP_SIZE) in;

layout(location = GAS_AT_COUNT) uniform uint count;
layout(location = GAS_AT_COLOR) uniform uint colors; /* the colour, and a bit for each closed side */
layout(location = GAS_AT_OTHER) uniform uvec4 other_words[4];

bool is_closed(uint side)
{
    return (colors >> (1u + side) & 1u) != 0u;
}

/* Says which row of the coarser level is the second nearest to a row of the finer one: floats to
 * it, and the sign of its p: beyond an open side p goes on with the opposite sign, beyond a closed
 * one with the same. */
struct second {
    int to;
    float sign_of;
};

second second_of(uint fine, uint cells, uint stride, uint side)
{
    uint coarse = fine / 2u;
    if ((fine & 1u) != 0u)
        return coarse + 1u < cells ? second(int(stride), 1.0f)
                                   : second(0, is_closed(side + 1u) ? 1.0f : -1.0f);
    return coarse > 0u ? second(-int(stride), 1.0f) : second(0, is_closed(side) ? 1.0f : -1.0f);
}

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint n = group * uint(GAS_GROUP_SIZE) + gl_LocalInvocationID.x;
    if (n >= count)
        return;
    level fine = own_level();
    level coarse = level_from(other_words[0], other_words[1], other_words[2], other_words[3]);
    uint across = coarse.cells.x;
    uint i = n % across;
    uint y = n / across % fine.cells.y;
    uint z = n / (across * fine.cells.y);
    uint odd = ((colors & 1u) + y + z) & 1u;
    second sy = second_of(y, coarse.cells.y, coarse.row, 2u);
    second sz = second_of(z, coarse.cells.z, coarse.plane, 4u);
    precise float by_y = 0.1875f * sy.sign_of;
    precise float by_z = 0.1875f * sz.sign_of;
    precise float by_both = 0.0625f * (sy.sign_of * sz.sign_of);
    uint row = coarse.first + row_of(coarse, y / 2u, z / 2u);
    float values[2]; /* of the cell's own column, and of the second nearest */
    for (int k = 0; k < 2; k++) {
        int x = int(i) + (k == 0 ? 0 : odd != 0u ? 1 : -1);
        bool before = x < 0;
        bool behind = x >= int(across);
        bool mirrors = (before && !is_closed(0u)) || (behind && !is_closed(1u));
        uint c = before ? 0u : behind ? across - 1u : uint(x);
        uint q = row + (c & 1u) * coarse.odd + c / 2u;
        float own = p[q];
        float at_y = p[uint(int(q) + sy.to)];
        float at_z = p[uint(int(q) + sz.to)];
        float at_both = p[uint(int(q) + sy.to + sz.to)];
        precise float value = (0.5625f * own + (by_y * at_y + by_z * at_z)) + by_both * at_both;
        values[k] = mirrors ? -value : value;
    }
    uint to = fine.first + row_of(fine, y, z) + odd * fine.odd + i;
    precise float raised = p[to] + (0.75f * values[0] + 0.25f * values[1]);
    p[to] = raised;
}
