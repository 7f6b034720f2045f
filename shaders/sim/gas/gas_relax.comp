/* Relaxes the cells of a colour of a level of pressure. */
// variant:
// variant: GAS_WALLED=1
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

#define GAS_USES_P
#define GAS_USES_F readonly
#include "sim/gas/pressure.glsl"

layout(local_size_x = GAS_GROUP_SIZE) in;

layout(location = GAS_AT_COUNT) uniform uint count;
layout(location = GAS_AT_COLOR) uniform uint color; /* 2: colour 0, where p is zero everywhere */

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint n = group * uint(GAS_GROUP_SIZE) + gl_LocalInvocationID.x;
    level l = own_level();
    uint across = (l.cells.x + 1u) / 2u;
    uint i = n % across;
    uint y = n / across % l.cells.y;
    uint z = n / (across * l.cells.y);
    uint odd = (color + y + z) & 1u;
    if (n >= count || 2u * i + odd >= l.cells.x)
        return;
    p[l.first + row_of(l, y, z) + odd * l.odd + i] = relaxed(l, y, z, odd, i, color == 2u);
}
