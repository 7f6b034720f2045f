/* Takes the pressure's gradient off the faces of the window's cells, and finds the fastest face. */
// variant:
// variant: GAS_WALLED=1
#define GAS_USES_FACES
#include "sim/gas/gas.glsl"

layout(std430, binding = GAS_BIND_P) readonly buffer p_block
{
    float p[];
};

layout(std430, binding = GAS_BIND_FOUND) buffer found_block
{
    /* The bits of the largest speed, m/s. Those of NaN and infinities are greater than those of all
     * other numbers. */
    uint fastest;
};

#ifdef GAS_WALLED
layout(std430, binding = GAS_BIND_OPEN) readonly buffer open_block
{
    float open[];
};

layout(std430, binding = GAS_BIND_WALLED) readonly buffer walled_block
{
    uint walled[];
};
#endif

bool is_walled(ivec3 cell)
{
#ifdef GAS_WALLED
    return walled[uint(cell.z) * uint(cells_of_window().y) + uint(cell.y)] != 0u;
#else
    return false;
#endif
}

/* Returns whether nothing flows through a face. at: of the face's upper cell in p. */
bool is_shut(bool beside, uint axis, uint at)
{
#ifdef GAS_WALLED
    return beside && !(open[axis * gas.faces + at] > 0.0f);
#else
    return false;
#endif
}

uint place_in_p(int x, uint row)
{
    return row + (uint(x) & 1u) * (gas.row / 2u) + uint(x) / 2u;
}

float less(float face, float gradient, float scale)
{
    precise float y = face - gradient * scale;
    return y;
}

void note(float speed)
{
    uint bits = floatBitsToUint(speed) & EXACT_SIZE_BITS;
    if (bits > fastest)
        atomicMax(fastest, bits);
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    ivec3 cell = corner_of(i / uint(GAS_BRICK_CELLS)) + place_in_brick(i % uint(GAS_BRICK_CELLS));
    ivec3 last = cells_of_window() - 1;
    float scale = gas.stir.z;
    uint row = gas.face + uint(cell.z) * gas.plane + uint(cell.y) * gas.row;
    uint at = place_in_p(cell.x, row);
    bool beside = is_walled(cell);
    float own = p[at];
    /* beyond an open side p has the opposite sign, so that it is 0 on the side */
    float left = cell.x == 0 ? 0.0f : p[place_in_p(cell.x - 1, row)];
    float below = p[cell.y == 0 ? at : at - gas.row];
    float behind = p[cell.z == 0 ? at : at - gas.plane];
    float sign_y = cell.y > 0 || is_closed(2u) ? 1.0f : -1.0f;
    float sign_z = cell.z > 0 || is_closed(4u) ? 1.0f : -1.0f;
    precise vec3 g = vec3(own - left, own - sign_y * below, own - sign_z * behind);
    g.x = is_shut(beside, 0u, at) ? 0.0f : g.x;
    g.y = is_shut(beside, 1u, at) ? 0.0f : g.y;
    g.z = is_shut(beside, 2u, at) ? 0.0f : g.z;
    uint u = row + uint(cell.x);
    uint v = u + gas.faces;
    uint w = v + gas.faces;
    float first = faces[u];
    vec3 y = vec3(less(first, g.x, scale), less(faces[v], g.y, scale), less(faces[w], g.z, scale));
    note(y.x);
    note(y.y);
    note(y.z);
    precise float twice = 2.0f * own;
    if (cell.x == 0) { /* p is 0 on an open side */
        precise float changed = first - twice * scale;
        bool shut = is_closed(0u) || is_shut(beside, 0u, at);
        y.x = shut ? first : changed;
        note(y.x);
    }
    faces[u] = y.x;
    faces[v] = y.y;
    faces[w] = y.z;
    precise float twice_scale = 2.0f * scale;
    if (cell.x == last.x) {
        float end = faces[u + 1u];
        precise float changed = end + twice * scale;
        bool shut = is_closed(1u) || is_shut(beside, 0u, place_in_p(cell.x + 1, row));
        float kept = shut ? end : changed;
        faces[u + 1u] = kept;
        note(kept);
    }
    float above = is_shut(beside, 1u, at + gas.row) ? 0.0f : own;
    float before = is_shut(beside, 2u, at + gas.plane) ? 0.0f : own;
    precise float top = faces[v + gas.row] + above * twice_scale;
    precise float end_z = faces[w + gas.plane] + before * twice_scale;
    if (cell.y == last.y && !is_closed(3u))
        faces[v + gas.row] = top;
    if (cell.z == last.z && !is_closed(5u))
        faces[w + gas.plane] = end_z;
}
