/* Traces gas beside solids: its way ends at a face that is shut, and a value is mixed from the cells
 * on its own side alone (Guendelman et al., "Coupling Water and Smoke to Thin Deformable and Rigid
 * Shells", 2005). It replaces what gas_trace.comp and gas_extras.comp found there. */
// variant:
// variant: GAS_EXTRAS=1
#define GAS_USES_CENTRES readonly
#define GAS_USES_NOW     readonly
#define GAS_USES_TRACED  writeonly
#define GAS_USES_WALLS   1
#ifdef GAS_EXTRAS
#define GAS_USES_EXTRAS 1
#define GAS_USES_NEXT   1
#endif
#include "sim/gas/gas.glsl"

#include "sim/gas/walls.glsl"

/* Cells around one that its gas may come from. */
const int AROUND = 2 * GAS_MOST_CELLS + 2;

/* Returns whether gas of a cell may come from or go to cells whose faces are shut. */
bool is_near_wall(ivec3 cell)
{
    uint bits = 0u;
    for (int i = 0; i < AROUND * AROUND * AROUND; i++)
        bits |= wall_bits(cell - GAS_MOST_CELLS +
                          ivec3(i % AROUND, i / AROUND % AROUND, i / (AROUND * AROUND)));
    return bits != 0u;
}

/* Returns whether the face between a cell and the next one on an axis is shut. step: 1 or -1. */
bool is_shut(ivec3 cell, int axis, int way)
{
    ivec3 above = cell;
    above[axis] += way > 0 ? 1 : 0;
    return (wall_bits(above) & (GAS_WALL_SHUT << uint(axis))) != 0u;
}

/* Returns whether gas can go from a cell to one beside it: by its sides in the order of the axes,
 * or in the opposite order. way: -1, 0 or 1 on each axis. */
bool is_seen(ivec3 cell, ivec3 way)
{
    bool there = true;
    bool back = true;
    ivec3 at = cell;
    ivec3 from = cell;
    for (int axis = 0; axis < 3; axis++) {
        int last = 2 - axis;
        there = there && !(way[axis] != 0 && is_shut(at, axis, way[axis]));
        back = back && !(way[last] != 0 && is_shut(from, last, way[last]));
        at[axis] += way[axis];
        from[last] += way[last];
    }
    return there || back;
}

/* A place that gas came from: its cell, and where it is from the cell's centre, in cells. */
struct wall_place {
    ivec3 cell;
    vec3 off;
};

/* Follows a way back from a cell in steps of half a cell, or less, along one axis after another. It
 * does not go through faces that are shut, but slides along them. Gas in a solid may leave it. */
wall_place wall_trace(ivec3 cell, vec3 way)
{
    const int steps = 2 * GAS_MOST_CELLS;
    wall_place p = wall_place(cell, vec3(0.0f));
    for (int i = 0; i < 3 * steps; i++) {
        int axis = i % 3;
        precise float off = p.off[axis] - way[axis] * (1.0f / float(steps));
        int to = off > 0.5f ? 1 : off < -0.5f ? -1 : 0;
        if (to != 0 && is_shut(p.cell, axis, to) && (wall_bits(p.cell) & GAS_WALL_SOLID) == 0u)
            continue;
        p.cell[axis] += to;
        precise float rest = off - float(to);
        p.off[axis] = rest;
    }
    return p;
}

#ifdef GAS_EXTRAS
vec4 extra_at(ivec3 cell, uint group)
{
    ivec3 own = nearest(cell);
    uint at = (brick_of(own) * gas.groups + group) * uint(GAS_BRICK_CELLS) + cell_in_brick(own);
    return is_open_air(cell) ? vec4(0.0f) : extras[at];
}
#endif

/* A corner of the cells around a place: its cell, which is the place's own where a wall lies
 * between, and its weight. */
struct wall_corner {
    ivec3 cell;
    float weight;
};

wall_corner wall_corner_of(wall_place p, int corner)
{
    wall_corner c;
    ivec3 taken = ivec3(0);
    precise float weight = 1.0f;
    for (int axis = 0; axis < 3; axis++) {
        precise float part = p.off[axis] < 0.0f ? -p.off[axis] : p.off[axis];
        bool is_far = (corner >> axis & 1) != 0;
        precise float less = 1.0f - part;
        weight = weight * (is_far ? part : less);
        taken[axis] = is_far ? (p.off[axis] < 0.0f ? -1 : 1) : 0;
    }
    c.weight = weight;
    c.cell = weight > 0.0f && is_seen(p.cell, taken) ? p.cell + taken : p.cell;
    return c;
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint brick = listed_at(i / uint(GAS_BRICK_CELLS)).brick;
    uint number = i % uint(GAS_BRICK_CELLS);
    ivec3 cell = corner_of(brick) + place_in_brick(number);
    if (!is_near_wall(cell))
        return;
    vec3 way = way_of(flow_at(cell));
    wall_place from = wall_trace(cell, way);
    precise vec4 velocity = vec4(0.0f);
    precise vec4 carried = vec4(0.0f);
#ifdef GAS_EXTRAS
    precise vec4 sums[3] = vec4[3](vec4(0.0f), vec4(0.0f), vec4(0.0f));
#endif
    for (int corner = 0; corner < 8; corner++) {
        wall_corner c = wall_corner_of(from, corner);
        joined j = joined_at(c.cell);
        velocity = velocity + c.weight * j.velocity;
        carried = carried + c.weight * j.carried;
#ifdef GAS_EXTRAS
        sums[0] = sums[0] + c.weight * extra_at(c.cell, 0u);
        if (gas.groups > 1u)
            sums[1] = sums[1] + c.weight * extra_at(c.cell, 1u);
        if (gas.groups > 2u)
            sums[2] = sums[2] + c.weight * extra_at(c.cell, 2u);
#endif
    }
    bool solid = (wall_bits(cell) & GAS_WALL_SOLID) != 0u;
    uint to = 2u * (brick * uint(GAS_BRICK_CELLS) + number);
    traced_words[to] = vec4(velocity.xyz, solid ? GAS_IN_WALL : GAS_NEAR_WALL);
    traced_words[to + 1u] = carried;
#ifdef GAS_EXTRAS
    precise vec3 metres = way * gas.step.cell;
    for (uint group = 0u; group < gas.groups; group++) {
        precise vec4 y = group == 0u ? sums[0] : group == 1u ? sums[1] : sums[2];
        if (group >= gas.first_way)
            y.xyz = y.xyz + metres;
        next_extras[(brick * gas.groups + group) * uint(GAS_BRICK_CELLS) + number] = y;
    }
#endif
}
