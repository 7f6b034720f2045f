/* Traces the cells of active bricks back over a step: what was where each cell's gas came from. */
#define GAS_USES_CENTRES readonly
#define GAS_USES_NOW     readonly
#define GAS_USES_TRACED  writeonly
#include "sim/gas/gas.glsl"

joined mixed_pair(ivec3 low, float part)
{
    joined a = joined_at(low);
    joined b = joined_at(low + ivec3(1, 0, 0));
    return joined(mixed(a.velocity, b.velocity, part), mixed(a.carried, b.carried, part));
}

joined mixed_plane(ivec3 low, vec3 part)
{
    joined a = mixed_pair(low, part.x);
    joined b = mixed_pair(low + ivec3(0, 1, 0), part.x);
    return joined(mixed(a.velocity, b.velocity, part.y), mixed(a.carried, b.carried, part.y));
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint brick = listed_at(i / uint(GAS_BRICK_CELLS)).brick;
    uint cell = i % uint(GAS_BRICK_CELLS);
    ivec3 corner = corner_of(brick);
    ivec3 place = place_in_brick(cell);
    precise vec3 from = vec3(place) - way_of(flow_at(corner + place));
    between b = between_at(corner, from);
    joined near = mixed_plane(b.low, b.part);
    joined far = mixed_plane(b.low + ivec3(0, 0, 1), b.part);
    uint to = 2u * (brick * uint(GAS_BRICK_CELLS) + cell);
    traced_words[to] = vec4(mixed(near.velocity, far.velocity, b.part.z).xyz, 0.0f);
    traced_words[to + 1u] = mixed(near.carried, far.carried, b.part.z);
}
