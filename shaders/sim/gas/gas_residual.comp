/* Writes the residuals of the finest level of pressure, in the order of p. */
// variant:
// variant: GAS_WALLED=1
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

#define GAS_USES_P readonly
#define GAS_USES_F readonly
#include "sim/gas/pressure.glsl"

layout(local_size_x = GAS_GROUP_SIZE) in;

layout(std430, binding = GAS_BIND_FOUND) writeonly buffer found_block
{
    float residuals[];
};

layout(location = GAS_AT_COUNT) uniform uint count;

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint n = group * uint(GAS_GROUP_SIZE) + gl_LocalInvocationID.x;
    if (n >= count)
        return;
    level l = own_level();
    uint x = n % l.cells.x;
    uint y = n / l.cells.x % l.cells.y;
    uint z = n / (l.cells.x * l.cells.y);
    residuals[l.first + row_of(l, y, z) + (x & 1u) * l.odd + x / 2u] =
        residual_of(l, y, z, x & 1u, x / 2u);
}
