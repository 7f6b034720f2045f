/* Fills the changes of idle bricks: what forces do to their air. */
#define GAS_USES_CENTRES readonly
#define GAS_USES_CHANGES writeonly
#define GAS_USES_LATTICE 1
#include "sim/gas/gas.glsl"

#include "sim/gas/forces.glsl"

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint brick = listed_at(i / uint(GAS_BRICK_CELLS)).brick;
    uint number = i % uint(GAS_BRICK_CELLS);
    uint at = brick * uint(GAS_BRICK_CELLS) + number;
    vec3 before = centres[at].xyz;
    vec3 after = under_forces(before, forces_at(corner_of(brick) + place_in_brick(number)));
    precise vec3 change = after - before;
    changes[at] = vec4(change, 0.0f);
}
