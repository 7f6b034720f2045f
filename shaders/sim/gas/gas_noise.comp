/* Computes the noise that stirs gas at the points of a lattice over stirred bricks. */
#define GAS_USES_STIRS writeonly
#include "sim/gas/gas.glsl"

#include "shared/noise.h"

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    listed l = listed_at(i / uint(GAS_NOISE_POINTS));
    int k = int(i % uint(GAS_NOISE_POINTS));
    ivec3 place = ivec3(k % GAS_NOISE_EDGE, k / GAS_NOISE_EDGE % GAS_NOISE_EDGE,
                        k / (GAS_NOISE_EDGE * GAS_NOISE_EDGE));
    ivec3 at = ivec3(int(gas.at_x), int(gas.at_y), int(gas.at_z)) + corner_of(l.brick) + 2 * place;
    precise vec3 p = vec3(at) * gas.stir.x;
    p.y = p.y - gas.stir.y;
    precise vec3 noise = noise_curl(p, gas.seed, gas.octaves);
    uint to = (l.number - 1u) * uint(GAS_STIR_FLOATS) + uint(GAS_SPINS) + 3u * uint(k);
    stirs[to] = noise.x;
    stirs[to + 1u] = noise.y;
    stirs[to + 2u] = noise.z;
}
