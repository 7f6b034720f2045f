/* Adds to the faces below the cells of bricks the mean change of the velocity on both sides. Faces
 * on solids get the velocity of the solid. */
// variant:
// variant: GAS_WALLED=1
#define GAS_USES_FACES
#define GAS_USES_CHANGES readonly
#ifdef GAS_WALLED
#define GAS_USES_WALLS 1
#endif
#include "sim/gas/gas.glsl"

#ifdef GAS_WALLED
#include "sim/gas/walls.glsl"
#endif

bool has_change(ivec3 cell)
{
    return (brick_words[brick_of(cell)] & GAS_HAS_CHANGE) != 0u;
}

/* Returns the change of a cell of the window: none where its brick has none. */
vec3 change_at(ivec3 cell)
{
    vec3 own = changes[place_of(cell)].xyz;
    return has_change(cell) ? own : vec3(0.0f);
}

float pushed(float face, float a, float b)
{
    precise float y = face + 0.5f * (a + b);
    return y;
}

/* Pushes a face along an axis, unless it is on a closed side or between bricks without changes. */
float pushed_along(float face, ivec3 cell, int axis, float own)
{
    ivec3 below = cell;
    below[axis] -= 1;
    bool beyond = below[axis] < 0;
    ivec3 other = beyond ? cell : below;
    float change = change_at(other)[axis];
    bool moves = has_change(cell) || has_change(other);
    bool closed = is_closed(2u * uint(axis));
    float y = pushed(face, change, own);
    /* faces across x are pushed in all bricks that are listed */
    bool holds = axis == 0 ? beyond && closed : closed && (beyond || !moves);
    return holds ? face : y;
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    uint brick = listed_at(i / uint(GAS_BRICK_CELLS)).brick;
    uint number = i % uint(GAS_BRICK_CELLS);
    ivec3 cell = corner_of(brick) + place_in_brick(number);
    ivec3 last = cells_of_window() - 1;
    vec3 own = change_at(cell);
    uvec3 at = uvec3(face_of(cell)) + uvec3(0u, gas.faces, 2u * gas.faces);
    vec3 y = vec3(pushed_along(faces[at.x], cell, 0, own.x),
                  pushed_along(faces[at.y], cell, 1, own.y),
                  pushed_along(faces[at.z], cell, 2, own.z));
#ifdef GAS_WALLED
    uint wall = wall_of(brick);
    if (wall != 0xffffffffu) {
        for (uint axis = 0u; axis < 3u; axis++)
            if (wall_open(wall, axis, number) == 0.0f)
                y[axis] = wall_speed(wall, axis, number);
    }
#endif
    faces[at.x] = y.x;
    faces[at.y] = y.y;
    faces[at.z] = y.z;
    precise float right = faces[at.x + 1u] + own.x;
    if (cell.x == last.x && !is_closed(1u))
        faces[at.x + 1u] = right;
    if (cell.y == last.y && !is_closed(3u))
        faces[at.y + gas.row] = pushed(faces[at.y + gas.row], own.y, own.y);
    if (cell.z == last.z && !is_closed(5u))
        faces[at.z + gas.plane] = pushed(faces[at.z + gas.plane], own.z, own.z);
}
