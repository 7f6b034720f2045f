/* Keeps the heading of particles that have stopped: the direction in which a particle flew before
 * the impact. Its record has it as one word, so that an arrow stays in the wall as it came. Only
 * pictures depend on it, but it is part of the state.
 *
 * The unit sphere is folded to a square: an octahedron, whose lower half is turned outwards. Each
 * of the two coordinates takes 16 bits, so directions are right to 1e-4 rad. */
#ifndef KILN_SHARED_HEADING_H
#define KILN_SHARED_HEADING_H

#include "shared/exact.h"
#include "shared/particle.h"

/* Returns a coordinate of the square, -1 to 1, as a number from 1 to 65535. */
FN uint heading_number(float x)
{
    EXACT float inside = exact_clamp(x, -1.0f, 1.0f);
    EXACT float number = inside * 32767.0f + 32768.5f;
    return UINT(number);
}

FN float heading_coordinate(uint number)
{
    EXACT float from_middle = FLOAT(number) - 32768.0f;
    EXACT float x = from_middle * 3.0518509e-5f; /* 1 / 32767 */
    return x;
}

/* Returns x with its sign turned if `sign` is below 0. */
FN float heading_signed(float x, float sign)
{
    EXACT float y = sign < 0.0f ? -x : x;
    return y;
}

/* Returns the word for the direction of a vector, or 0 for one without a length. */
FN uint heading_pack(float3 v)
{
    EXACT float3 unit = float3_normalize(v, FLOAT3(0.0f, 0.0f, 0.0f));
    EXACT float sum = exact_abs(unit.x) + exact_abs(unit.y);
    sum = sum + exact_abs(unit.z);
    if (sum < 0.5f)
        return 0u;
    EXACT float x = exact_div(unit.x, sum);
    EXACT float y = exact_div(unit.y, sum);
    if (unit.z < 0.0f) {
        EXACT float across = heading_signed(1.0f - exact_abs(y), x);
        EXACT float up = heading_signed(1.0f - exact_abs(x), y);
        x = across;
        y = up;
    }
    return heading_number(x) << 16u | heading_number(y);
}

/* Returns the unit vector of a word; no length for 0. */
FN float3 heading_unpack(uint word)
{
    EXACT float3 none = FLOAT3(0.0f, 0.0f, 0.0f);
    if (word == 0u)
        return none;
    EXACT float x = heading_coordinate(word >> 16u);
    EXACT float y = heading_coordinate(word & 65535u);
    EXACT float z = 1.0f - exact_abs(x);
    z = z - exact_abs(y);
    if (z < 0.0f) {
        EXACT float across = heading_signed(1.0f - exact_abs(y), x);
        EXACT float up = heading_signed(1.0f - exact_abs(x), y);
        x = across;
        y = up;
    }
    EXACT float3 direction = FLOAT3(x, y, z);
    EXACT float3 unit = float3_normalize(direction, none);
    return unit;
}

/* Returns a vector along the heading: the velocity, m/s, or a unit vector for a particle that has
 * stopped. It has no length if the particle never moved. */
FN float3 particle_heading(S(kiln_particle) p)
{
    if (particle_has_stopped(p))
        return heading_unpack(p.velocity_birth.z);
    return particle_velocity(p);
}

#endif
