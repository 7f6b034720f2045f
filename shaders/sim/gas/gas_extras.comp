/* Traces what cells carry beside: the colour of smoke, and ways from where gas was. Cells that
 * remember where their gas came from add their own way. */
#define GAS_USES_CENTRES readonly
#define GAS_USES_EXTRAS  1
#define GAS_USES_NEXT    1
#include "sim/gas/gas.glsl"

vec4 extra_at(ivec3 cell, uint group)
{
    ivec3 own = nearest(cell);
    uint at = (brick_of(own) * gas.groups + group) * uint(GAS_BRICK_CELLS) + cell_in_brick(own);
    return is_open_air(cell) ? vec4(0.0f) : extras[at];
}

vec4 mixed_plane(ivec3 low, vec3 part, uint group)
{
    vec4 a = mixed(extra_at(low, group), extra_at(low + ivec3(1, 0, 0), group), part.x);
    vec4 b = mixed(extra_at(low + ivec3(0, 1, 0), group), extra_at(low + ivec3(1, 1, 0), group),
                   part.x);
    return mixed(a, b, part.y);
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
    vec3 way = way_of(flow_at(corner + place));
    precise vec3 from = vec3(place) - way;
    precise vec3 metres = way * gas.step.cell;
    between b = between_at(corner, from);
    for (uint group = 0u; group < gas.groups; group++) {
        vec4 near = mixed_plane(b.low, b.part, group);
        vec4 far = mixed_plane(b.low + ivec3(0, 0, 1), b.part, group);
        precise vec4 y = mixed(near, far, b.part.z);
        if (group >= gas.first_way)
            y.xyz = y.xyz + metres;
        next_extras[(brick * gas.groups + group) * uint(GAS_BRICK_CELLS) + cell] = y;
    }
}
