/* Solves the coarsest level of pressure in one work group, from zero. */
// variant:
// variant: GAS_WALLED=1
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

#define GAS_USES_P coherent
#define GAS_USES_F readonly
#include "sim/gas/pressure.glsl"

layout(local_size_x = GAS_COARSEST_GROUP) in;

layout(location = GAS_AT_SWEEPS) uniform uint sweeps;

/* color: 2: colour 0, where p is zero everywhere. */
void relax(level l, uint color)
{
    uint across = (l.cells.x + 1u) / 2u;
    uint count = across * l.cells.y * l.cells.z;
    for (uint n = gl_LocalInvocationID.x; n < count; n += uint(GAS_COARSEST_GROUP)) {
        uint i = n % across;
        uint y = n / across % l.cells.y;
        uint z = n / (across * l.cells.y);
        uint odd = (color + y + z) & 1u;
        if (2u * i + odd < l.cells.x)
            p[l.first + row_of(l, y, z) + odd * l.odd + i] = relaxed(l, y, z, odd, i, color == 2u);
    }
}

void main()
{
    level l = own_level();
    /* the first sweep begins anew; then colours 1 and 0 take turns */
    for (uint sweep = 0u; sweep <= 2u * sweeps; sweep++) {
        relax(l, sweep == 0u ? 2u : sweep & 1u);
        memoryBarrierBuffer();
        barrier();
    }
}
