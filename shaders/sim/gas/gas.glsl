/* Declares the buffers and parameters of the kernels shaders/sim/gas/gas_*.comp, and finds cells in
 * them. A kernel says by macros GAS_USES_* which buffers it needs before it includes this file.
 * lib/sim/gas/passes_gl.c runs the kernels; what they compute is, bit for bit, what
 * lib/sim/gas/advect_simd.c and faces_simd.c do. */
#ifndef KILN_SIM_GAS_GLSL
#define KILN_SIM_GAS_GLSL

#include "shared/exact.h"
#include "shared/gas_kernel.h"
#include "sim/gas/numbers.glsl"

layout(local_size_x = GAS_GROUP_SIZE) in;

layout(std140, binding = GAS_BIND_PARAMS) uniform gas_block
{
    kiln_gas_kernel gas;
};

layout(std430, binding = GAS_BIND_BRICKS) readonly buffer brick_block
{
    uint brick_words[];
};

layout(location = GAS_AT_FIRST) uniform uint list_first;
layout(location = GAS_AT_COUNT) uniform uint list_count;

#ifdef GAS_USES_FACES
layout(std430, binding = GAS_BIND_FACES) GAS_USES_FACES buffer face_block
{
    float faces[];
};
#endif

#ifdef GAS_USES_CENTRES
layout(std430, binding = GAS_BIND_CENTRES) GAS_USES_CENTRES buffer centre_block
{
    vec4 centres[];
};
#endif

#ifdef GAS_USES_NOW
layout(std430, binding = GAS_BIND_NOW) GAS_USES_NOW buffer now_block
{
    vec4 now_words[];
};
#endif

#ifdef GAS_USES_TRACED
layout(std430, binding = GAS_BIND_TRACED) GAS_USES_TRACED buffer traced_block
{
    vec4 traced_words[];
};
#endif

#ifdef GAS_USES_CHANGES
layout(std430, binding = GAS_BIND_CHANGES) GAS_USES_CHANGES buffer change_block
{
    vec4 changes[];
};
#endif

#ifdef GAS_USES_EXTRAS
layout(std430, binding = GAS_BIND_EXTRAS) readonly buffer extra_block
{
    vec4 extras[];
};
#endif

#ifdef GAS_USES_NEXT
layout(std430, binding = GAS_BIND_NEXT) buffer next_block
{
    vec4 next_extras[];
};
#endif

#ifdef GAS_USES_WALLS
layout(std430, binding = GAS_BIND_WALLS) readonly buffer wall_block
{
    uint wall_words[];
};
#endif

#ifdef GAS_USES_STIRS
layout(std430, binding = GAS_BIND_STIRS) GAS_USES_STIRS buffer stir_block
{
    float stirs[];
};
#endif

#ifdef GAS_USES_LATTICE
layout(std430, binding = GAS_BIND_LATTICE) readonly buffer lattice_block
{
    vec4 lattice[];
};
#endif

#ifdef GAS_USES_EXPANDED
layout(std430, binding = GAS_BIND_EXPANDED) GAS_USES_EXPANDED buffer expanded_block
{
    float expanded[];
};
#endif

/* Returns the number of this invocation. Work groups are dispatched in rows, since GL limits how
 * many there may be in one direction. */
uint invocation()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return group * uint(GAS_GROUP_SIZE) + gl_LocalInvocationID.x;
}

/* ---- places ---------------------------------------------------------------------------------- */

/* A brick of a list, and the number beside it. */
struct listed {
    uint brick, number;
};

listed listed_at(uint entry)
{
    uint at = list_first + 2u * entry;
    return listed(brick_words[at], brick_words[at + 1u]);
}

ivec3 cells_of_window()
{
    return ivec3(int(gas.bricks_x), int(gas.bricks_y), int(gas.bricks_z)) * GAS_BRICK;
}

/* Returns the lowest cell of a brick in the window. */
ivec3 corner_of(uint brick)
{
    uint x = brick % gas.bricks_x;
    uint y = brick / gas.bricks_x % gas.bricks_y;
    uint z = brick / (gas.bricks_x * gas.bricks_y);
    return ivec3(int(x), int(y), int(z)) * GAS_BRICK;
}

/* Returns the place of a brick's cell in the brick. */
ivec3 place_in_brick(uint cell)
{
    return ivec3(int(cell & 7u), int((cell >> 3u) & 7u), int(cell >> 6u));
}

uint brick_of(ivec3 cell)
{
    uvec3 b = uvec3(cell) / uint(GAS_BRICK);
    return (b.z * gas.bricks_y + b.y) * gas.bricks_x + b.x;
}

/* Returns the number of a cell of the window in its brick. */
uint cell_in_brick(ivec3 cell)
{
    uvec3 c = uvec3(cell) & uint(GAS_BRICK - 1);
    return (c.z * uint(GAS_BRICK) + c.y) * uint(GAS_BRICK) + c.x;
}

/* Returns the place of a cell of the window in arrays over cells. */
uint place_of(ivec3 cell)
{
    return brick_of(cell) * uint(GAS_BRICK_CELLS) + cell_in_brick(cell);
}

/* Returns the place of a cell's lower x face in the arrays of faces. */
uint face_of(ivec3 cell)
{
    return gas.face + uint(cell.z) * gas.plane + uint(cell.y) * gas.row + uint(cell.x);
}

bool is_closed(uint side)
{
    return (gas.closed >> side & 1u) != 0u;
}

/* Returns the nearest cell of the window. */
ivec3 nearest(ivec3 cell)
{
    return clamp(cell, ivec3(0), cells_of_window() - 1);
}

/* Returns whether a cell lies beyond an open side of the window, from where no gas comes. */
bool is_open_air(ivec3 cell)
{
    ivec3 n = cells_of_window();
    return (cell.x < 0 && !is_closed(0u)) || (cell.x >= n.x && !is_closed(1u)) ||
           (cell.y < 0 && !is_closed(2u)) || (cell.y >= n.y && !is_closed(3u)) ||
           (cell.z < 0 && !is_closed(4u)) || (cell.z >= n.z && !is_closed(5u));
}

bool is_active(uint brick)
{
    return (brick_words[brick] & GAS_IS_ACTIVE) != 0u;
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* Holds the velocity of a cell, and what it carries. */
struct joined {
    vec4 velocity, carried;
};

/* Holds the velocity of a cell, and its differences over two cells along each axis. */
struct flow {
    vec3 u, by_x, by_y, by_z;
};

/* Makes a cell one of the air beyond an open side. It has the velocity of the nearest cell, as far
 * as the air there may have it. */
joined outer(joined cell)
{
    vec4 u = cell.velocity;
    return joined(vec4(exact_clamp(u.x, gas.least.x, gas.most.x),
                       exact_clamp(u.y, gas.least.y, gas.most.y),
                       exact_clamp(u.z, gas.least.z, gas.most.z), u.w),
                  vec4(0.0f));
}

#ifdef GAS_USES_CENTRES
vec3 velocity_at(ivec3 cell)
{
    return centres[place_of(nearest(cell))].xyz;
}

#ifdef GAS_USES_NOW
/* Returns a cell of the window, or the nearest one to a cell beyond it. Idle bricks carry zeros. */
joined joined_at(ivec3 cell)
{
    uint place = place_of(nearest(cell));
    joined j = joined(vec4(centres[place].xyz, 0.0f), now_words[place]);
    if (is_open_air(cell))
        return outer(j);
    return j;
}
#endif

flow flow_at(ivec3 cell)
{
    precise flow f;
    f.u = velocity_at(cell);
    f.by_x = velocity_at(cell + ivec3(1, 0, 0)) - velocity_at(cell - ivec3(1, 0, 0));
    f.by_y = velocity_at(cell + ivec3(0, 1, 0)) - velocity_at(cell - ivec3(0, 1, 0));
    f.by_z = velocity_at(cell + ivec3(0, 0, 1)) - velocity_at(cell - ivec3(0, 0, 1));
    return f;
}
#endif

/* Returns the differences that make up the vorticity. */
vec3 spin_of(flow f)
{
    precise vec3 spin = vec3(f.by_y.z - f.by_z.y, f.by_z.x - f.by_x.z, f.by_x.y - f.by_y.x);
    return spin;
}

/* min and max take the second operand where both are equal, as vf_min and vf_max do. */
vec4 least(vec4 a, vec4 b)
{
    return mix(b, a, lessThan(a, b));
}

vec4 greatest(vec4 a, vec4 b)
{
    return mix(b, a, greaterThan(a, b));
}

/* Returns the way of a cell in a step, in cells. */
vec3 way_of(flow f)
{
    float scale = gas.step.cells_a_velocity;
    vec3 u = f.u;
    return vec3(gas_way(u.x, u.x, u.y, u.z, f.by_x.x, f.by_y.x, f.by_z.x, scale),
                gas_way(u.y, u.x, u.y, u.z, f.by_x.y, f.by_y.y, f.by_z.y, scale),
                gas_way(u.z, u.x, u.y, u.z, f.by_x.z, f.by_y.z, f.by_z.z, scale));
}

/* Returns the way of a cell in the step to come. back: in the last one. */
vec3 way_forth(vec3 u, vec3 back)
{
    precise vec3 scaled = u * gas.step.cells_a_velocity;
    return vec3(gas_way_forth(scaled.x, back.x), gas_way_forth(scaled.y, back.y),
                gas_way_forth(scaled.z, back.z));
}

/* A point among cells: the lowest of the eight cells around it, and the parts of the way to the
 * highest. */
struct between {
    ivec3 low;
    vec3 part;
};

/* corner: the lowest cell of a brick; at: cells from its centre. */
between between_at(ivec3 corner, vec3 at)
{
    precise vec3 whole = floor(at);
    precise between b;
    b.part = at - whole;
    b.low = corner + ivec3(whole);
    return b;
}

vec4 mixed(vec4 a, vec4 b, float part)
{
    return vec4(gas_mix(a.x, b.x, part), gas_mix(a.y, b.y, part), gas_mix(a.z, b.z, part),
                gas_mix(a.w, b.w, part));
}

#endif
