/* Declares bodies, which hold what other particles of a system need of a particle, and computes the
 * cell that a body is in.
 *
 * Space is divided into cubes a little wider than the largest distance at which two particles
 * touch, so that all particles that touch a particle are in the 27 cells around it. Cells are
 * hashed into a table, so particles may be anywhere. Neighbours along x are neighbours in the
 * table. */
#ifndef KILN_SHARED_INTERACT_BODY_H
#define KILN_SHARED_INTERACT_BODY_H

#include "shared/derived.h"
#include "shared/exact.h"
#include "shared/interact_layout.h"

FN float3 body_position(S(kiln_body) b)
{
    EXACT float3 v = FLOAT3(BITS_FLOAT(b.position_radius.x), BITS_FLOAT(b.position_radius.y),
                            BITS_FLOAT(b.position_radius.z));
    return v;
}

FN float3 body_velocity(S(kiln_body) b)
{
    EXACT float3 v = FLOAT3(BITS_FLOAT(b.velocity_slot.x), BITS_FLOAT(b.velocity_slot.y),
                            BITS_FLOAT(b.velocity_slot.z));
    return v;
}

/* Returns a body's radius, m: 0 if the body touches nothing, below 0 if it takes no further part in
 * the step. */
FN float body_radius(S(kiln_body) b)
{
    EXACT float y = BITS_FLOAT(b.position_radius.w);
    return y;
}

FN S(kiln_body) body_done(S(kiln_body) b)
{
    S(kiln_body) done = b;
    done.position_radius.w |= EXACT_SIGN_BIT;
    return done;
}

FN S(kiln_body) body_with_motion(S(kiln_body) b, float3 position, float3 velocity)
{
    EXACT float3 x = float3_canon(position);
    EXACT float3 v = float3_canon(velocity);
    S(kiln_body) moved;
    moved.position_radius =
        UINT4(FLOAT_BITS(x.x), FLOAT_BITS(x.y), FLOAT_BITS(x.z), b.position_radius.w);
    moved.velocity_slot =
        UINT4(FLOAT_BITS(v.x), FLOAT_BITS(v.y), FLOAT_BITS(v.z), b.velocity_slot.w);
    return moved;
}

/* Returns the clocks of a particle at the start of the step. */
FN S(value_clocks) body_clocks(CROWD_PARAM S(kiln_particle) p)
{
    EXACT float life_s = particle_life_s(CROWD_KEYS INTERACT(derived), p);
    EXACT float age_s = particle_age(p, INTERACT(step), INTERACT(derived.dt_s));
    EXACT float3 position = particle_position(p);
    EXACT float time_s = INTERACT(time_s);
    EXACT S(value_clocks) clocks =
        value_clocks_at(time_s, INTERACT(derived.random_key), INTERACT(derived.scene_key));
    clocks.life = particle_progress(age_s, life_s);
    clocks.age_s = age_s;
    clocks.height = position.y;
    clocks.velocity = particle_velocity(p);
    clocks.stream = particle_stream(INTERACT(derived), p);
    return clocks;
}

/* Returns the radius of a particle at the start of the step. */
FN float body_radius_of(CROWD_PARAM S(kiln_particle) p)
{
    EXACT S(value_clocks) clocks = body_clocks(CROWD p);
    EXACT float radius = value_at(CROWD_KEYS INTERACT(radius), clocks);
    if (INTERACT(as_drawn) != 0u) {
        EXACT float low = value_at(CROWD_KEYS INTERACT(scale.min), clocks);
        EXACT float high = value_at(CROWD_KEYS INTERACT(scale.max), clocks);
        EXACT float scale = random_between(clocks.stream, RANDOM_SCALE, low, high);
        EXACT float size = value_at(CROWD_KEYS INTERACT(size), clocks);
        radius = (size * 0.5f) * scale;
    }
    EXACT float positive = radius > 0.0f ? radius : 0.0f;
    EXACT float y = exact_canon(positive);
    return y;
}

FN S(kiln_body) body_of(CROWD_PARAM S(kiln_particle) p, uint slot)
{
    EXACT float radius = body_radius_of(CROWD p);
    S(kiln_body) b;
    b.position_radius =
        UINT4(p.position_serial.x, p.position_serial.y, p.position_serial.z, FLOAT_BITS(radius));
    b.velocity_slot = UINT4(p.velocity_birth.x, p.velocity_birth.y, p.velocity_birth.z, slot);
    return b;
}

/* The two words of a slot's push (shared/push.h). */
struct body_push {
    float4 velocity, position;
};

FN float4 body_difference(float3 after, float3 before)
{
    EXACT float3 difference = float3_sub(after, before);
    EXACT float3 c = float3_canon(difference);
    EXACT float4 y = FLOAT4(c.x, c.y, c.z, 0.0f);
    return y;
}

/* Returns the push that changes a particle as its body was changed. */
FN S(body_push) body_push_of(S(kiln_body) b, S(kiln_particle) p)
{
    EXACT float3 velocity = body_velocity(b);
    EXACT float3 velocity_before = particle_velocity(p);
    EXACT float3 position = body_position(b);
    EXACT float3 position_before = particle_position(p);
    EXACT S(body_push) push;
    push.velocity = body_difference(velocity, velocity_before);
    push.position = body_difference(position, position_before);
    push.velocity.w = exact_abs(body_radius(b));
    return push;
}

/* ---- cells ---------------------------------------------------------------------------------- */

/* Returns the number of a cell along an axis. Valid positions are never so far out; the limit gives
 * any other value a number, too. */
FN int cell_along(float metres, float cells_per_metre)
{
    EXACT float at = metres * cells_per_metre;
    EXACT float held = exact_clamp(at, -1073741824.0f, 1073741824.0f);
    return INT(FLOOR(held));
}

/* Returns where a row of cells along x begins in the table. The hash does not mix: while a row of
 * bodies is visited, the rows around it are read in order, too. That saves more time than cells
 * that share a place cost. */
FN uint cell_row(int y, int z)
{
    return UINT(y) * 311u + UINT(z) * 96557u;
}

FN uint cell_in_row(CROWD_PARAM uint row, int x)
{
    return (row + UINT(x)) & INTERACT(cell_mask);
}

FN uint cell_of(CROWD_PARAM float3 p)
{
    int x = cell_along(p.x, INTERACT(cells_per_metre));
    int y = cell_along(p.y, INTERACT(cells_per_metre));
    int z = cell_along(p.z, INTERACT(cells_per_metre));
    return cell_in_row(CROWD cell_row(y, z), x);
}

FN uint cell_begin(CROWD_PARAM uint cell)
{
    return cell == 0u ? 0u : CELL_END(cell - 1u);
}

#endif
