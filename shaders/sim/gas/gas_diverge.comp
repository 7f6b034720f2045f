/* Fills f of the finest level of pressure, in m^2/s, with what the cells of the window lack for
 * their outflow to be as it should. */
// variant:
// variant: GAS_WALLED=1
#define GAS_USES_FACES    readonly
#define GAS_USES_EXPANDED readonly
#ifdef GAS_WALLED
#define GAS_USES_WALLS 1
#endif
#include "sim/gas/gas.glsl"

layout(std430, binding = GAS_BIND_F) writeonly buffer f_block
{
    float f[];
};

#ifdef GAS_WALLED
#include "sim/gas/walls.glsl"

layout(std430, binding = GAS_BIND_OPEN) readonly buffer open_block
{
    float open[]; /* of the finest level: the axes follow each other */
};

layout(std430, binding = GAS_BIND_WALLED) readonly buffer walled_block
{
    uint walled[];
};

/* Returns what flows through a face: gas through its open part, and the solid through the rest. */
float through(float velocity, ivec3 cell, uint axis)
{
    ivec3 own = nearest(cell);
    uint wall = wall_of(brick_of(own));
    if (wall == 0xffffffffu || own != cell)
        return velocity;
    uint number = cell_in_brick(cell);
    float part = wall_open(wall, axis, number);
    precise float y = part * velocity + (1.0f - part) * wall_speed(wall, axis, number);
    return y;
}

/* Returns whether anything flows through a face of a cell in a row beside walls. */
bool is_open(ivec3 cell, uint at)
{
    uint n = uint(cells_of_window().y);
    if (walled[uint(cell.z) * n + uint(cell.y)] == 0u)
        return true;
    uint odd = gas.row / 2u;
    uint next = at - (uint(cell.x) & 1u) * odd - uint(cell.x) / 2u + (uint(cell.x + 1) & 1u) * odd +
                uint(cell.x + 1) / 2u;
    uint y = gas.faces;
    uint z = 2u * gas.faces;
    return open[at] > 0.0f || open[next] > 0.0f || open[y + at] > 0.0f ||
           open[y + at + gas.row] > 0.0f || open[z + at] > 0.0f || open[z + at + gas.plane] > 0.0f;
}
#endif

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint brick = i / uint(GAS_BRICK_CELLS);
    ivec3 cell = corner_of(brick) + place_in_brick(i % uint(GAS_BRICK_CELLS));
    uint u = face_of(cell);
    uint v = u + gas.faces;
    uint w = v + gas.faces;
    vec3 low = vec3(faces[u], faces[v], faces[w]);
    vec3 high = vec3(faces[u + 1u], faces[v + gas.row], faces[w + gas.plane]);
#ifdef GAS_WALLED
    low = vec3(through(low.x, cell, 0u), through(low.y, cell, 1u), through(low.z, cell, 2u));
    high = vec3(through(high.x, cell + ivec3(1, 0, 0), 0u),
                through(high.y, cell + ivec3(0, 1, 0), 1u),
                through(high.z, cell + ivec3(0, 0, 1), 2u));
#endif
    precise vec3 out_of = high - low;
    precise float sum = (out_of.x + out_of.y) + out_of.z;
    precise float square = gas.step.cell * gas.step.cell;
    precise float flow = sum * gas.step.cell;
    precise float less = flow - square * expanded[i];
    float number = is_active(brick) ? less : flow;
    uint at = gas.face + uint(cell.z) * gas.plane + uint(cell.y) * gas.row +
              (uint(cell.x) & 1u) * (gas.row / 2u) + uint(cell.x) / 2u;
#ifdef GAS_WALLED
    number = is_open(cell, at) ? number : 0.0f;
#endif
    f[at] = number;
}
