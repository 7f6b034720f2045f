/* Runs one pass of a bitonic sort over a field of pairs in rows, as fragment shaders did it
 * (UberFlow, 4.3.3 and table 1): each element becomes the lesser or the greater of itself and its
 * partner. The choice of the partner, and of the lesser or the greater, is
 *   - COMPUTED in this shader from the number of the pass (the paper's FP),
 *   - PASSED in: it is the same all along a column, or all along a row, so a table has a word for
 *     each column and row (in the paper's GP/FP, vertices of quads held these), or
 *   - PASSED in for elements that are PACKED of two pairs (GP/FP Packed). */
// variant: COMPUTED=1
// variant: PASSED=1
// variant: PASSED=1 PACKED=1
#include "shared/papers/bench_layout.h"
#include "sort/index.glsl"

layout(local_size_x = SORT_GROUP_SIZE) in;

#ifdef PACKED
#define ELEMENT uvec4
const uint per_element = 2u;
#else
#define ELEMENT uvec2
const uint per_element = 1u;
#endif

layout(std430, binding = SORT_BIND_PAIRS) readonly buffer pair_block
{
    ELEMENT elements[];
};

layout(std430, binding = SORT_BIND_PAIRS_OUT) writeonly buffer pair_out_block
{
    ELEMENT elements_out[];
};

layout(location = SORT_AT_COUNT) uniform uint count; /* pairs; a power of two */

#ifdef COMPUTED
layout(location = FIELD_AT_PASS) uniform uint pass;
/* pairs that are sorted together; a power of two */
layout(location = FIELD_AT_SORTED) uniform uint sorted;
#else
layout(location = SORT_AT_DISTANCE) uniform uint distance;
layout(location = FIELD_AT_WIDTH) uniform uint width; /* pairs of a row */
/* index in `words` of the pass's words: its columns, then its rows */
layout(location = FIELD_AT_FIRST_WORD) uniform uint first_word;

layout(std430, binding = SORT_BIND_COUNTS) readonly buffer table_block
{
    uint words[]; /* bit 0: the partner comes before; bit 1: take the greater */
};
#endif

struct comparator {
    uint distance;
    bool before, greater;
};

comparator comparator_of(uint i)
{
    comparator c;
#ifdef COMPUTED
    uint stage = 0u;
    while ((stage + 1u) * (stage + 2u) / 2u <= pass)
        stage++;
    uint step_of_stage = pass - stage * (stage + 1u) / 2u;
    c.distance = 1u << (stage - step_of_stage);
    c.before = (i & c.distance) != 0u;
    bool descending = (i & (2u << stage) & (sorted - 1u)) != 0u;
    c.greater = c.before != descending;
#else
    uint word = words[first_word + i % width] ^ words[first_word + width + i / width];
    c.distance = distance;
    c.before = (word & 1u) != 0u;
    c.greater = (word & 2u) != 0u;
#endif
    return c;
}

uvec2 choose(uvec2 own, uvec2 other, bool greater)
{
    bool after = own.x > other.x || (own.x == other.x && own.y > other.y);
    return after == greater ? own : other;
}

void main()
{
    uint i = group_index() * SORT_GROUP_SIZE + gl_LocalInvocationID.x;
    if (i >= count / per_element)
        return;
    comparator c = comparator_of(i * per_element);
    ELEMENT own = elements[i];
#ifdef PACKED
    if (c.distance == 1u) { /* the partners are in one element */
        elements_out[i] = uvec4(choose(own.xy, own.zw, c.greater), choose(own.zw, own.xy, !c.greater));
        return;
    }
#endif
    uint step = c.distance / per_element;
    ELEMENT other = elements[c.before ? i - step : i + step];
#ifdef PACKED
    elements_out[i] = uvec4(choose(own.xy, other.xy, c.greater), choose(own.zw, other.zw, c.greater));
#else
    elements_out[i] = choose(own, other, c.greater);
#endif
}
