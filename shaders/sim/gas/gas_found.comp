/* Sums up what the columns of a brick's cells of one x have, in the order in which the host does:
 * an invocation for each. */
#define GAS_USES_NOW      readonly
#define GAS_USES_CHANGES  readonly
#define GAS_USES_EXPANDED readonly
#include "sim/gas/gas.glsl"

layout(std430, binding = GAS_BIND_FOUND) writeonly buffer found_block
{
    uvec4 found[];
};

layout(location = GAS_AT_FOUND) uniform uint found_first;

bool is_wrong(float x)
{
    return (floatBitsToUint(x) & EXACT_SIZE_BITS) >= 0x7f800000u;
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint at = listed_at(i / uint(GAS_BRICK)).brick * uint(GAS_BRICK_CELLS) + i % uint(GAS_BRICK);
    precise float moved = 0.0f;
    precise float left = 0.0f;
    precise float growth = 0.0f;
    uint flags = 0u;
    for (uint k = 0u; k < uint(GAS_BRICK_CELLS / GAS_BRICK); k++, at += uint(GAS_BRICK)) {
        vec4 q = now_words[at];
        vec4 change = changes[at];
        moved = moved + change.w;
        left = left + q.x;
        growth = growth + q.x * expanded[at];
        bool some = q.x > GAS_LEAST_SMOKE || q.z > GAS_LEAST_SMOKE || q.y > GAS_LEAST_HEAT ||
                    q.w > GAS_LEAST_HEAT;
        bool wrong = is_wrong(change.x) || is_wrong(change.y) || is_wrong(change.z) ||
                     is_wrong(q.x) || is_wrong(q.y) || is_wrong(q.z) || is_wrong(q.w);
        flags |= (some ? GAS_FOUND_GAS : 0u) | (wrong ? GAS_FOUND_WRONG : 0u);
    }
    found[found_first + i] = uvec4(flags, floatBitsToUint(moved), floatBitsToUint(left), floatBitsToUint(growth));
}
