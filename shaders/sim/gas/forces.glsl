/* Finds the forces of a domain at a cell, and applies them. The points of their lattice lie two
 * cells apart, so that two cells lie between points, a quarter of the way from one and from the
 * other. */
#ifndef KILN_SIM_GAS_FORCES_GLSL
#define KILN_SIM_GAS_FORCES_GLSL

/* Returns the weight of the upper point on an axis. */
float upper_weight(int place)
{
    return (place & 1) != 0 ? 0.75f : 0.25f;
}

/* Mixes four points of a lattice along y and z. up, on: weights of the upper ones. */
vec4 mixed_points(vec4 a, vec4 b, vec4 c, vec4 d, float up, float on)
{
    precise vec4 low = (1.0f - up) * a + up * b;
    precise vec4 high = (1.0f - up) * c + up * d;
    precise vec4 y = (1.0f - on) * low + on * high;
    return y;
}

vec4 mixed_along(vec4 a, vec4 b, float right)
{
    precise vec4 y = (1.0f - right) * a + right * b;
    return y;
}

vec4 force_points(uint at, float up, float on)
{
    uint above = at + gas.lattice_row;
    return mixed_points(lattice[at], lattice[above], lattice[at + gas.lattice_plane],
                        lattice[above + gas.lattice_plane], up, on);
}

/* Returns the acceleration and the pull of forces at a cell of the window. */
vec4 forces_at(ivec3 cell)
{
    uvec3 half_cell = uvec3(cell) / 2u;
    uint at = half_cell.z * gas.lattice_plane + half_cell.y * gas.lattice_row + half_cell.x;
    float up = upper_weight(cell.y);
    float on = upper_weight(cell.z);
    return mixed_along(force_points(at, up, on), force_points(at + 1u, up, on),
                       upper_weight(cell.x));
}

/* Applies forces over a step. */
vec3 under_forces(vec3 u, vec4 force)
{
    float dt = gas.step.dt;
    vec3 turn = gas.turn.xyz;
    float slower = gas_slowed(force.w, dt);
    return vec3(gas_forced(u.x, force.x, u.y, turn.z, u.z, turn.y, dt, slower),
                gas_forced(u.y, force.y, u.z, turn.x, u.x, turn.z, dt, slower),
                gas_forced(u.z, force.z, u.x, turn.y, u.y, turn.x, dt, slower));
}

#endif
