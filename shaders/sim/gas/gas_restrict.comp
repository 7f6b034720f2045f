/* Fills f of a coarser level of pressure with the residuals of the finer one, whose colour 1 was
 * relaxed last and has none. */
// variant:
// variant: GAS_WALLED=1
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

#define GAS_USES_P readonly
#define GAS_USES_F
#include "sim/gas/pressure.glsl"

layout(local_size_x = GAS_GROUP_SIZE) in;

layout(location = GAS_AT_COUNT) uniform uint count;
layout(location = GAS_AT_OTHER) uniform uvec4 other_words[4];

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint n = group * uint(GAS_GROUP_SIZE) + gl_LocalInvocationID.x;
    if (n >= count)
        return;
    level fine = own_level();
    level coarse = level_from(other_words[0], other_words[1], other_words[2], other_words[3]);
    uint x = n % coarse.cells.x;
    uint y = n / coarse.cells.x % coarse.cells.y;
    uint z = n / (coarse.cells.x * coarse.cells.y);
    precise float sum = (residual_of(fine, 2u * y, 2u * z, 0u, x) +
                         residual_of(fine, 2u * y + 1u, 2u * z, 1u, x)) +
                        (residual_of(fine, 2u * y, 2u * z + 1u, 1u, x) +
                         residual_of(fine, 2u * y + 1u, 2u * z + 1u, 0u, x));
    precise float mean = 0.5f * sum;
    f[coarse.first + row_of(coarse, y, z) + (x & 1u) * coarse.odd + x / 2u] = mean;
}
