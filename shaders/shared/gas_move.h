/* Computes how gas moves and what pushes it, number by number, for C and GLSL, so that it gives the
 * same bits on every device (shared/exact.h). A file that includes this one defines before what
 * shared/gas_cell.h asks for, and REAL_ABS(x), REAL_RSQRT(x) and REAL_BOTH(a, b), which holds where
 * both truths do. */
#ifndef KILN_SHARED_GAS_MOVE_H
#define KILN_SHARED_GAS_MOVE_H

#include "shared/gas_layout.h"

/* Interpolates from a to b. */
REAL_FN REAL gas_mix(REAL a, REAL b, REAL part)
{
    EXACT REAL y = a + (b - a) * part;
    return y;
}

/* Sums up what six cells around one have, axis by axis. */
REAL_FN REAL gas_around(REAL left, REAL right, REAL below, REAL above, REAL behind, REAL before)
{
    EXACT REAL y = ((left + right) + (below + above)) + (behind + before);
    return y;
}

REAL_FN REAL gas_way_within(REAL way)
{
    EXACT REAL least = REAL_ALL(-FLOAT(GAS_MOST_CELLS));
    EXACT REAL most = REAL_ALL(FLOAT(GAS_MOST_CELLS));
    EXACT REAL raised = REAL_MAX(way, least);
    EXACT REAL y = REAL_MIN(raised, most);
    return y;
}

/* Returns the way of a cell in a step along an axis, in cells: along the velocity half a step ago,
 * by Taylor's series. own: velocity along that axis, m/s; u, v, w: along all; by_x...: how that
 * along the axis changes over two cells; scale: of velocities to cells a step. */
REAL_FN REAL gas_way(REAL own, REAL u, REAL v, REAL w, REAL by_x, REAL by_y, REAL by_z, float scale)
{
    EXACT REAL bent = (u * by_x + v * by_y) + w * by_z;
    EXACT float quarter = 0.25f * scale;
    EXACT REAL way = (own - quarter * bent) * scale;
    return gas_way_within(way);
}

/* Returns the way of a cell in the step to come from that in the last one, back: its bend has the
 * opposite sign. scaled: velocity in cells a step. */
REAL_FN REAL gas_way_forth(REAL scaled, REAL back)
{
    EXACT REAL way = (scaled + scaled) - back;
    return gas_way_within(way);
}

/* Returns half of what the way back and forth changed: the error of a traced value. */
REAL_FN REAL gas_error(REAL own, REAL forth)
{
    EXACT REAL y = (own - forth) * 0.5f;
    return y;
}

/* The following correct a traced value. low, high: of the cells that it came from. The first gives
 * it less of its correction the less room it has. */
REAL_FN REAL gas_softly(REAL traced, REAL error, REAL low, REAL high)
{
    EXACT REAL none = REAL_ALL(0.0f);
    EXACT REAL above = high - traced;
    EXACT REAL below = traced - low;
    EXACT REAL least = REAL_MIN(above, below);
    EXACT REAL room = REAL_MAX(least, none);
    EXACT REAL size = REAL_ABS(error);
    EXACT REAL whole = (room + size) + 1e-20f;
    EXACT REAL inverse = REAL_RCP(whole);
    EXACT REAL y = traced + error * (room * inverse);
    return y;
}

/* Holds the corrected value between the two. */
REAL_FN REAL gas_clamped(REAL traced, REAL error, REAL low, REAL high)
{
    EXACT REAL full = traced + error;
    EXACT REAL raised = REAL_MAX(full, low);
    EXACT REAL y = REAL_MIN(raised, high);
    return y;
}

/* Takes the corrected value if it lies between the two. */
REAL_FN REAL gas_kept(REAL traced, REAL error, REAL low, REAL high)
{
    EXACT REAL full = traced + error;
    EXACT REAL y = REAL_SELECT(REAL_BOTH(full >= low, full <= high), full, traced);
    return y;
}

/* Adds a part of the velocity's Laplacian, which damps waves of two cells. */
REAL_FN REAL gas_smoothed(REAL u, REAL own, REAL around, float part)
{
    EXACT REAL y = u + part * (around - 6.0f * own);
    return y;
}

/* Returns the length of the vorticity. */
REAL_FN REAL gas_spin(REAL x, REAL y, REAL z)
{
    EXACT REAL square = (x * x + y * y) + z * z;
    EXACT REAL least = REAL_ALL(1e-20f);
    EXACT REAL held = REAL_MAX(square, least);
    EXACT REAL inverse = REAL_RSQRT(held);
    EXACT REAL size = square * inverse;
    return size;
}

/* Returns the strength of vorticity confinement over the length of the gradient of the vorticity's
 * length (Fedkiw et al., "Visual Simulation of Smoke", 2001). */
REAL_FN REAL gas_confinement(REAL x, REAL y, REAL z, float push)
{
    EXACT REAL square = (x * x + y * y) + z * z;
    EXACT REAL least = REAL_ALL(1e-8f);
    EXACT REAL held = REAL_MAX(square, least);
    EXACT REAL inverse = REAL_RSQRT(held);
    EXACT REAL scale = push * inverse;
    return scale;
}

/* Adds a component of the push: scale times a b' - b a'. */
REAL_FN REAL gas_confined(REAL u, REAL scale, REAL a, REAL spin_b, REAL b, REAL spin_a)
{
    EXACT REAL y = u + scale * (a * spin_b - b * spin_a);
    return y;
}

/* Lets heat rise and smoke sink. */
REAL_FN REAL gas_buoyant(REAL u, REAL hot, REAL smoke, float rise, float sink)
{
    EXACT REAL y = u + (hot * rise - smoke * sink);
    return y;
}

/* Returns how much noise stirs a cell, m/s. */
REAL_FN REAL gas_stirred(REAL smoke, REAL hot, REAL flame, float strength)
{
    EXACT REAL one = REAL_ALL(1.0f);
    EXACT REAL sum = (smoke + hot) + flame;
    EXACT REAL part = REAL_MIN(sum, one);
    EXACT REAL y = part * strength;
    return y;
}

/* Returns the factor that the pull of forces, 1/s, has on velocities in a step, without
 * overshooting. */
REAL_FN REAL gas_slowed(REAL pull, float dt)
{
    EXACT REAL more = 1.0f + dt * pull;
    EXACT REAL y = REAL_RCP(more);
    return y;
}

/* Applies forces over a step along an axis: the acceleration, and that of Coriolis in a domain that
 * turns, a turn_b - b turn_a. */
REAL_FN REAL gas_forced(REAL u, REAL force, REAL a, float turn_b, REAL b, float turn_a, float dt,
                        REAL slower)
{
    EXACT REAL across = a * turn_b - b * turn_a;
    EXACT REAL y = (u + dt * (force + across)) * slower;
    return y;
}

#endif
