/* Computes the length of the vorticity, in m/s over two cells, of stirred bricks and one cell around
 * each. */
#define GAS_USES_CENTRES readonly
#define GAS_USES_STIRS   writeonly
#include "sim/gas/gas.glsl"

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    listed l = listed_at(i / uint(GAS_SPINS));
    int k = int(i % uint(GAS_SPINS));
    ivec3 place = ivec3(k % GAS_SPIN_EDGE, k / GAS_SPIN_EDGE % GAS_SPIN_EDGE,
                        k / (GAS_SPIN_EDGE * GAS_SPIN_EDGE));
    flow f = flow_at(corner_of(l.brick) + place - 1);
    vec3 spin = spin_of(f);
    stirs[(l.number - 1u) * uint(GAS_STIR_FLOATS) + uint(k)] = gas_spin(spin.x, spin.y, spin.z);
}
