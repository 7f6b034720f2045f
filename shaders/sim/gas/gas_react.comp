/* Corrects what gas_trace.comp found by MacCormack's scheme, burns it and pushes it: fills what
 * cells carry, their changes of velocity and their expansion. */
#define GAS_USES_CENTRES  readonly
#define GAS_USES_NOW      readonly
#define GAS_USES_TRACED   readonly
#define GAS_USES_CHANGES  writeonly
#define GAS_USES_STIRS    readonly
#define GAS_USES_LATTICE  1
#define GAS_USES_EXPANDED writeonly
#include "sim/gas/gas.glsl"

#include "sim/gas/forces.glsl"

#include "shared/gas_cell.h"

layout(std430, binding = GAS_BIND_NEXT) writeonly buffer after_block
{
    vec4 after_words[]; /* what cells carry at the end of the step */
};

/* Traced, an idle cell is as it was. */
joined traced_at(ivec3 cell)
{
    ivec3 own = nearest(cell);
    uint brick = brick_of(own);
    uint place = brick * uint(GAS_BRICK_CELLS) + cell_in_brick(own);
    bool awake = is_active(brick);
    joined j;
    j.velocity = awake ? traced_words[2u * place] : vec4(centres[place].xyz, 0.0f);
    j.carried = awake ? traced_words[2u * place + 1u] : vec4(0.0f);
    if (is_open_air(cell))
        return outer(j);
    return j;
}

joined traced_pair(ivec3 low, float part)
{
    joined a = traced_at(low);
    joined b = traced_at(low + ivec3(1, 0, 0));
    return joined(mixed(a.velocity, b.velocity, part), mixed(a.carried, b.carried, part));
}

joined traced_plane(ivec3 low, vec3 part)
{
    joined a = traced_pair(low, part.x);
    joined b = traced_pair(low + ivec3(0, 1, 0), part.x);
    return joined(mixed(a.velocity, b.velocity, part.y), mixed(a.carried, b.carried, part.y));
}

/* The least and the greatest of the eight cells that a value came from. */
struct extremes {
    joined low, high;
};

extremes extremes_of_pair(ivec3 low)
{
    joined a = joined_at(low);
    joined b = joined_at(low + ivec3(1, 0, 0));
    return extremes(joined(least(a.velocity, b.velocity), least(a.carried, b.carried)),
                    joined(greatest(a.velocity, b.velocity), greatest(a.carried, b.carried)));
}

extremes extremes_of(extremes a, extremes b)
{
    return extremes(
        joined(least(a.low.velocity, b.low.velocity), least(a.low.carried, b.low.carried)),
        joined(greatest(a.high.velocity, b.high.velocity),
               greatest(a.high.carried, b.high.carried)));
}

extremes extremes_of_plane(ivec3 low)
{
    return extremes_of(extremes_of_pair(low), extremes_of_pair(low + ivec3(0, 1, 0)));
}

/* Returns the corrected velocity along an axis. */
float corrected_velocity(float base, float error, float low, float high)
{
    return gas.step.keep_velocity != 0u ? gas_kept(base, error, low, high)
                                        : gas_clamped(base, error, low, high);
}

/* Returns the corrected value of a cell. */
joined corrected(joined own, joined base, joined forth, extremes e)
{
    vec4 o = own.velocity;
    vec4 v = base.velocity;
    vec4 f = forth.velocity;
    vec4 low = e.low.velocity;
    vec4 high = e.high.velocity;
    joined y;
    y.velocity = vec4(corrected_velocity(v.x, gas_error(o.x, f.x), low.x, high.x),
                      corrected_velocity(v.y, gas_error(o.y, f.y), low.y, high.y),
                      corrected_velocity(v.z, gas_error(o.z, f.z), low.z, high.z), 0.0f);
    o = own.carried;
    v = base.carried;
    f = forth.carried;
    low = e.low.carried;
    high = e.high.carried;
    y.carried = vec4(gas_clamped(v.x, gas_error(o.x, f.x), low.x, high.x),
                     gas_softly(v.y, gas_error(o.y, f.y), low.y, high.y),
                     gas_softly(v.z, gas_error(o.z, f.z), low.z, high.z),
                     gas_softly(v.w, gas_error(o.w, f.w), low.w, high.w));
    return y;
}

/* Adds a part of the velocity's Laplacian. own: of the cell. */
vec3 smoothed(vec3 u, vec3 own, ivec3 cell)
{
    vec3 a = velocity_at(cell - ivec3(1, 0, 0));
    vec3 b = velocity_at(cell + ivec3(1, 0, 0));
    vec3 c = velocity_at(cell - ivec3(0, 1, 0));
    vec3 d = velocity_at(cell + ivec3(0, 1, 0));
    vec3 e = velocity_at(cell - ivec3(0, 0, 1));
    vec3 g = velocity_at(cell + ivec3(0, 0, 1));
    float part = gas.step.smoothing;
    return vec3(gas_smoothed(u.x, own.x, gas_around(a.x, b.x, c.x, d.x, e.x, g.x), part),
                gas_smoothed(u.y, own.y, gas_around(a.y, b.y, c.y, d.y, e.y, g.y), part),
                gas_smoothed(u.z, own.z, gas_around(a.z, b.z, c.z, d.z, e.z, g.z), part));
}

/* Adds the push of vorticity confinement, towards where vorticity is greatest. at: of the cell's
 * length of vorticity. */
vec3 confined(vec3 u, flow f, uint at)
{
    const uint up = uint(GAS_SPIN_EDGE);
    const uint on = up * up;
    vec3 spin = spin_of(f);
    precise vec3 g = vec3(stirs[at + 1u] - stirs[at - 1u], stirs[at + up] - stirs[at - up],
                          stirs[at + on] - stirs[at - on]);
    float scale = gas_confinement(g.x, g.y, g.z, gas.step.confinement);
    return vec3(gas_confined(u.x, scale, g.y, spin.z, g.z, spin.y),
                gas_confined(u.y, scale, g.z, spin.x, g.x, spin.z),
                gas_confined(u.z, scale, g.x, spin.y, g.y, spin.x));
}

vec4 noise_point(uint at)
{
    return vec4(stirs[at], stirs[at + 1u], stirs[at + 2u], 0.0f);
}

vec4 noise_points(uint at, float up, float on)
{
    const uint row = 3u * uint(GAS_NOISE_EDGE);
    const uint plane = row * uint(GAS_NOISE_EDGE);
    return mixed_points(noise_point(at), noise_point(at + row), noise_point(at + plane),
                        noise_point(at + plane + row), up, on);
}

/* Returns the noise at a cell. first: of the brick's noise. */
vec3 noise_at(uint first, ivec3 place)
{
    uvec3 p = uvec3(place) / 2u;
    uint at = first + 3u * ((p.z * uint(GAS_NOISE_EDGE) + p.y) * uint(GAS_NOISE_EDGE) + p.x);
    float up = upper_weight(place.y);
    float on = upper_weight(place.z);
    return mixed_along(noise_points(at, up, on), noise_points(at + 3u, up, on),
                       upper_weight(place.x)).xyz;
}

/* stir: number of the brick's spins and noise, from 1; 0: it is not stirred. */
vec3 pushed(vec3 u, flow f, gas_carried q, ivec3 cell, ivec3 place, uint stir)
{
    if (gas.step.smoothing > 0.0f)
        u = smoothed(u, f.u, cell);
    vec4 rise = gas.step.rise;
    vec4 sink = gas.step.sink;
    precise vec3 v = vec3(gas_buoyant(u.x, q.temperature, q.smoke, rise.x, sink.x),
                          gas_buoyant(u.y, q.temperature, q.smoke, rise.y, sink.y),
                          gas_buoyant(u.z, q.temperature, q.smoke, rise.z, sink.z));
    uint first = (stir - 1u) * uint(GAS_STIR_FLOATS);
    if (stir != 0u && gas.step.confinement > 0.0f) {
        uvec3 p = uvec3(place) + 1u;
        v = confined(v, f, first + (p.z * uint(GAS_SPIN_EDGE) + p.y) * uint(GAS_SPIN_EDGE) + p.x);
    }
    if (stir != 0u && gas.turn.w > 0.0f) {
        float there = gas_stirred(q.smoke, q.temperature, q.flame, gas.turn.w);
        v = v + there * noise_at(first + uint(GAS_SPINS), place);
    }
    if (gas.has_forces != 0u)
        v = under_forces(v, forces_at(cell));
    v = v * gas.step.slow;
    return v;
}

void main()
{
    uint i = invocation();
    if (i >= list_count)
        return;
    listed l = listed_at(i / uint(GAS_BRICK_CELLS));
    uint number = i % uint(GAS_BRICK_CELLS);
    uint at = l.brick * uint(GAS_BRICK_CELLS) + number;
    ivec3 corner = corner_of(l.brick);
    ivec3 place = place_in_brick(number);
    ivec3 cell = corner + place;
    flow f = flow_at(cell);
    vec3 way = way_of(f);
    precise vec3 from = vec3(place) - way;
    precise vec3 to = vec3(place) + way_forth(f.u, way);
    between b = between_at(corner, from);
    extremes e = extremes_of(extremes_of_plane(b.low), extremes_of_plane(b.low + ivec3(0, 0, 1)));
    between there = between_at(corner, to);
    joined near = traced_plane(there.low, there.part);
    joined far = traced_plane(there.low + ivec3(0, 0, 1), there.part);
    joined forth = joined(mixed(near.velocity, far.velocity, there.part.z),
                          mixed(near.carried, far.carried, there.part.z));
    joined own = joined(vec4(f.u, 0.0f), now_words[at]);
    joined base = joined(traced_words[2u * at], traced_words[2u * at + 1u]);
    joined y = corrected(own, base, forth, e);
    /* beside walls the scheme is not corrected, and nothing is in a solid */
    if (base.velocity.w > 0.0f)
        y = base;
    if (base.velocity.w == GAS_IN_WALL)
        y.carried = vec4(0.0f);
    gas_carried before;
    before.smoke = y.carried.x;
    before.temperature = y.carried.y;
    before.fuel = y.carried.z;
    before.flame = y.carried.w;
    before.burnt = 0.0f;
    gas_carried q = gas_burn(before, gas.step);
    precise vec3 u = pushed(y.velocity.xyz, f, q, cell, place, l.number);
    precise vec3 change = u - f.u;
    precise float expansion = q.burnt * gas.step.expansion;
    if (base.velocity.w == GAS_IN_WALL)
        change = vec3(0.0f);
    after_words[at] = vec4(q.smoke, q.temperature, q.fuel, q.flame);
    changes[at] = vec4(change, before.smoke);
    expanded[at] = expansion;
}
