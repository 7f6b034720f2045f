/* Computes the velocity at the centre of each cell of the window: the mean of its faces. */
#define GAS_USES_FACES   readonly
#define GAS_USES_CENTRES
#include "sim/gas/gas.glsl"

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    ivec3 cell = corner_of(i / uint(GAS_BRICK_CELLS)) + place_in_brick(i % uint(GAS_BRICK_CELLS));
    uint at = face_of(cell);
    uint v = at + gas.faces;
    uint w = v + gas.faces;
    precise float x = 0.5f * (faces[at] + faces[at + 1u]);
    precise float y = 0.5f * (faces[v] + faces[v + gas.row]);
    precise float z = 0.5f * (faces[w] + faces[w + gas.plane]);
    centres[i] = vec4(x, y, z, 0.0f);
}
