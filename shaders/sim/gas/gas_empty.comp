/* Takes the gas away from the cells that solids take at the end of a substep. */
#define GAS_USES_NOW writeonly
#include "sim/gas/gas.glsl"

layout(std430, binding = GAS_BIND_SENT) readonly buffer sent_block
{
    uint sent[]; /* a bit for each cell of a brick */
};

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    listed l = listed_at(i / uint(GAS_BRICK_CELLS));
    uint number = i % uint(GAS_BRICK_CELLS);
    if ((sent[l.number + number / 32u] >> (number & 31u) & 1u) != 0u)
        now_words[l.brick * uint(GAS_BRICK_CELLS) + number] = vec4(0.0f);
}
