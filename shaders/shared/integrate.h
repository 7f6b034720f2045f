/* Moves a particle under the forces of its system, from one part of a step to another. */
#ifndef KILN_SHARED_INTEGRATE_H
#define KILN_SHARED_INTEGRATE_H

#include "shared/collide_answer.h"
#include "shared/forces.h"
#ifdef FORCES_ALL
#include "shared/stages.h"
#endif

#ifdef FORCES_PLAIN

/* Does integrate for integrators that evaluate forces once, without quadratic drag. */
FN S(collide_state) integrate_plain(SIM_PARAM S(collide_state) s, float until,
                                    S(value_clocks) clocks)
{
    EXACT float time_s = (until - s.since) * STEP(derived.dt_s);
    EXACT S(force_effect) forces = forces_sum(SIM s.position, s.velocity, clocks);
    EXACT S(collide_state) moved = s;
    moved.velocity = forces_apply(forces, s.velocity, time_s);
    if ((STEP(forces_do) & FORCES_LIMIT) != 0u)
        moved.velocity = force_limit_all(SIM s.position, moved.velocity, clocks);
    EXACT float3 carrying = moved.velocity;
    if (STEP_INTEGRATION == INTEGRATE_POSITION_FIRST)
        carrying = s.velocity;
    moved.position = float3_add_scaled(s.position, carrying, time_s);
    moved.since = until;
    return moved;
}

#endif
#ifdef FORCES_ALL

/* Does integrate for all integrators and forces. */
FN S(collide_state) integrate_stages(SIM_PARAM S(collide_state) start, float until,
                                     S(value_clocks) clocks)
{
    EXACT float time_s = (until - start.since) * STEP(derived.dt_s);
    uint count = stages_count(STEP_INTEGRATION);
    EXACT S(stages) s = stages_start(start.position, start.velocity);
    for (uint stage = 0u; stage < count; stage++) {
        EXACT float3 at = s.at;
        EXACT S(force_effect) forces = forces_sum(SIM at, s.moving, clocks);
        s = stages_take(s, forces, stage, count, time_s);
        if ((STEP(forces_do) & FORCES_LIMIT) != 0u)
            s.moving = force_limit_all(SIM at, s.moving, clocks);
    }
    EXACT S(collide_state) moved = start;
    moved.position = stages_arrive(s, STEP_INTEGRATION, time_s);
    moved.velocity = s.moving;
    moved.since = until;
    return moved;
}

#endif

/* Moves a particle from the part `since` of the step to the part `until`, without collision. */
FN S(collide_state) integrate(SIM_PARAM S(collide_state) s, float until, S(value_clocks) clocks)
{
#if defined(FORCES_ALL) && defined(FORCES_PLAIN)
    if (STEP_INTEGRATION < INTEGRATE_TRAPEZOID && (STEP(forces_do) & FORCES_SLOW) == 0u)
        return integrate_plain(SIM s, until, clocks);
    return integrate_stages(SIM s, until, clocks);
#elif defined(FORCES_ALL)
    return integrate_stages(SIM s, until, clocks);
#else
    return integrate_plain(SIM s, until, clocks);
#endif
}

#endif
