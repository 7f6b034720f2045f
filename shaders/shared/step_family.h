/* Runs one step of one slot for systems whose particles have children, are children, paint meshes,
 * or die or stop at an impact. A family is a parent system and the systems of its children
 * (family.h). This header does more than step.h: it computes births from the parents' traces, makes
 * traces (trace.h), and lets a particle's motion end when its life ends within the step. For other
 * systems it gives the bits of step.h.
 *
 * The kernels of all GPU techniques call step_family_slot through shaders/sim/step/slot.glsl, for
 * families alone, since it would slow other systems down. The host steps blocks of slots
 * (lib/sim/step/slots_simd.c), and calls it for births, impacts and ends of lives that leave a
 * trace. Both run the slots of a parent system before those of
 * its children. Host and GPU must get the same bits (docs/determinism.md). So every local that
 * holds floats is EXACT (platform.h); a kiln_particle holds their bits as integers. The order of
 * operations must stay as it is. SIM, SIM_PARAM, STEP and AROUND give access to the parameters of
 * the step and to the surroundings (layout.h). */
#ifndef KILN_SHARED_STEP_FAMILY_H
#define KILN_SHARED_STEP_FAMILY_H

#include "shared/ride.h"
#include "shared/step.h"

#define STEP_SIXTY_FOURTH 0.015625f

/* Holds the content of a slot after a step, and its trace. */
struct step_result {
    S(kiln_particle) particle;
    S(kiln_trace) trace;
};

FN S(step_result) step_result_dead(void)
{
    EXACT S(step_result) r;
    r.particle = step_dead();
    r.trace = trace_nothing();
    return r;
}

/* Returns when in this step a particle's life ends, as a fraction of the step; the life must end in
 * this step. The fraction is a whole number of 64ths, as the times of births are, so that a child
 * that is born of this event begins where its parent ended. If the particle is born in this step,
 * its life does not end before its birth. */
FN float step_end_of_life(SIM_PARAM S(kiln_particle) p, float age_s, float life_s)
{
    EXACT float after_s = age_s - life_s;
    EXACT float after = after_s * AROUND(steps_per_s);
    EXACT float until = 1.0f - after;
    bool born = particle_birth_step(p) == STEP(step);
    EXACT float born_at = particle_birth_fraction(p) * 64.0f;
    uint least = born ? UINT(born_at) : 0u;
    EXACT float y = FLOAT(family_sixty_fourths(until, least)) * STEP_SIXTY_FOURTH;
    return y;
}

/* Returns the progress of life at the start of the step; 0 for a particle that is born in it. */
FN float step_progress_before(SIM_PARAM S(kiln_particle) p, float life_s)
{
    if (particle_birth_step(p) == STEP(step))
        return 0.0f;
    EXACT float age_s = particle_age(p, STEP(step) - 1u, STEP(derived.dt_s));
    EXACT float y = particle_progress(age_s, life_s);
    return y;
}

/* Packs a particle's way through the step and its events (TRACE_*) into a trace. */
FN S(kiln_trace) step_trace(SIM_PARAM S(kiln_particle) p, S(step_way) way, uint events,
                            float life_s, float progress_after)
{
    EXACT S(kiln_trace) t;
    EXACT float progress = step_progress_before(SIM p, life_s);
    t.start = trace_pack(way.start.position, way.start.since);
    t.turn = trace_pack(way.first.position, way.first.since);
    t.end = trace_pack(way.end.position, way.end.since);
    t.start_velocity = trace_pack(way.start.velocity, progress);
    t.turn_velocity = trace_pack(way.first.velocity, way.first.reach);
    t.end_velocity = trace_pack(way.end.velocity, progress_after);
    t.serial_event = UINT4(p.position_serial.w, events, way.first.face, FLOAT_BITS(life_s));
    return t;
}

/* Whether impacts of the system stop particles, and whether these then ride what they hit. Where
 * records keep normals, particles may rest from their birth. */
#define STEP_STOPS (STEP(family.then) >= THEN_STOP)
#define STEP_LIES  ((STEP(family.keeps) & FAMILY_KEEPS_NORMALS) != 0u)
#define STEP_RESTS (STEP_STOPS || STEP_LIES)
#define STEP_RIDES (USES(USES_THEN, THEN_STICK) && STEP(family.then) == THEN_STICK)

/* Returns whether the first impact of this step ends a particle, or stops it. */
FN bool step_is_chosen(SIM_PARAM S(kiln_particle) p, S(step_way) way, float age_s, float life_s)
{
    if (STEP(family.then) == THEN_BOUNCE || !way.first.happened)
        return false;
    EXACT S(value_clocks) clocks = step_clocks(SIM p, age_s, life_s);
    EXACT float chance = VALUE_OF(KEYED_CHANCE, SIM_KEYS STEP(family.chance), clocks);
    EXACT float drawn = random_unit(clocks.stream, RANDOM_CHANCE + STEP(step));
    return drawn < chance;
}

/* Returns the way of a particle that an impact has stopped in an earlier step. Its velocity is that
 * of the collider that it rides. */
FN S(step_way) step_rest(SIM_PARAM S(kiln_particle) p, float until)
{
    EXACT S(step_way) way;
    way.start.position = particle_position(p);
    way.start.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
    way.start.since = 0.0f;
    way.start.spin = FLOAT3(0.0f, 0.0f, 0.0f);
    way.end = way.start;
    way.end.since = until;
    if (STEP_RIDES && p.velocity_birth.y != 0u) {
        EXACT S(ride_motion) motion = ride_motion_of(SIM p.velocity_birth.y - 1u);
        way.start.velocity = ride_velocity(SIM motion, way.start.position);
        way.end.velocity = way.start.velocity;
        way.end.position = ride(motion, 0.0f, until, way.start.position);
    }
    way.first = collide_no_touch();
    way.lost = !step_is_sane(way.end.position) || !step_is_sane(way.end.velocity) ||
               step_is_removed(SIM way.end.position);
    way.stops = false;
    return way;
}

/* Returns a particle's way through this step, to the part `until` of it. If an impact stops the
 * particle, the way ends there, at rest. */
FN S(step_way) step_move_or_stop(SIM_PARAM S(kiln_particle) p, S(step_push) push, float age_s,
                                 float life_s, float until)
{
    EXACT S(step_way) way;
    if (STEP_RESTS && particle_has_stopped(p)) {
        way = step_rest(SIM p, until);
        return way;
    }
    way = step_move(SIM p, push, age_s, life_s, until);
    if (STEP_STOPS && step_is_chosen(SIM p, way, age_s, life_s)) {
        way.end.position = way.first.position;
        way.end.velocity = FLOAT3(0.0f, 0.0f, 0.0f);
        way.stops = true;
        if (STEP_RIDES) {
            EXACT S(ride_motion) motion = ride_motion_of(SIM way.first.number);
            way.end.velocity = ride_velocity(SIM motion, way.first.position);
            way.end.position = ride(motion, way.first.since, until, way.first.position);
        }
        way.lost = !step_is_sane(way.end.position) || step_is_removed(SIM way.end.position);
    }
    return way;
}

/* Returns a particle that has stopped, in this step or before. */
FN S(kiln_particle) step_at_rest(SIM_PARAM S(kiln_particle) p, S(step_way) way)
{
    S(kiln_particle) y = step_with_motion(p, way.end.position, way.end.velocity);
    y.velocity_birth = p.velocity_birth;
    if (way.stops) {
        uint sixty_fourths = family_sixty_fourths(way.first.since, 0u);
        y.velocity_birth.x = (STEP(step) << KILN_REST_STEP_SHIFT) | sixty_fourths;
        y.velocity_birth.y = STEP_RIDES ? way.first.number + 1u : 0u;
        EXACT float3 heading = particle_velocity(p);
        if (STEP_LIES)
            heading = collide_normal_of(way.first.face);
        y.velocity_birth.z = heading_pack(heading);
        y.velocity_birth.w |= KILN_PARTICLE_STOPPED;
    }
    if (STEP_RIDES && y.velocity_birth.y != 0u) {
        EXACT S(ride_motion) motion = ride_motion_of(SIM y.velocity_birth.y - 1u);
        EXACT float since = way.stops ? way.first.since : 0.0f;
        y.velocity_birth.z = ride_heading(motion, since, 1.0f, y.velocity_birth.z);
    }
    return y;
}

/* Returns a particle at the end of this step, and its trace. The particle may have been born in
 * this step. It is dead afterwards if its life ends in this step or if it is lost (step.h). A
 * particle that is lost leaves no trace. */
FN S(step_result) step_family_particle(SIM_PARAM S(kiln_particle) p, S(step_push) push)
{
    EXACT S(step_result) r = step_result_dead();
    EXACT float life_s = particle_life_s(SIM_KEYS STEP(derived), p);
    EXACT float age_s = particle_age(p, STEP(step), STEP(derived.dt_s));
    bool ends = age_s >= life_s;
    bool traced = STEP(family.traced) != 0u;
    if (ends && !traced)
        return r;
    EXACT float until = 1.0f;
    if (ends)
        until = step_end_of_life(SIM p, age_s, life_s);
    EXACT S(step_way) way = step_move_or_stop(SIM p, push, age_s, life_s, until);
    if (way.lost)
        return r;
    way.end.since = until;
    bool dies = STEP(family.then) == THEN_DIE && step_is_chosen(SIM p, way, age_s, life_s);
    EXACT float progress = ends ? 1.0f : particle_progress(age_s, life_s);
    if (dies) {
        EXACT float skipped = 1.0f - way.first.since;
        EXACT float reached_s = age_s - skipped * STEP(derived.dt_s);
        progress = particle_progress(reached_s, life_s);
        way.end.position = way.first.position;
        way.end.velocity = way.first.velocity;
        way.end.since = way.first.since;
    }
    if (!ends && !dies) {
        r.particle = step_with_motion(p, way.end.position, way.end.velocity);
        if (STEP_RESTS && (way.stops || particle_has_stopped(p)))
            r.particle = step_at_rest(SIM p, way);
    }
    if (!traced)
        return r;
    uint events = TRACE_ALIVE;
    if (way.first.happened) {
        uint hits = family_hits(SIM push.slot, p);
        events |= TRACE_TURN | hits << TRACE_HITS_SHIFT;
        if (!ends && !dies && hits < STEP(family.counted) && hits < KILN_PARTICLE_MOST_HITS)
            r.particle.velocity_birth.w =
                particle_birth_with_hits(r.particle.velocity_birth.w, hits + 1u);
    }
    if (ends && !dies)
        events |= TRACE_DEATH;
    if (dies)
        events |= TRACE_FATAL;
    r.trace = step_trace(SIM p, way, events, life_s, progress);
    return r;
}

/* Returns a child that rests from its birth where its parent met a surface, if it is drawn there
 * and has no speed; any other child as it is. sixty_fourths: of this step before the birth. */
FN S(kiln_particle) step_child_at_rest(SIM_PARAM S(kiln_particle) p, S(kiln_trace) parent,
                                       uint sixty_fourths)
{
    bool of_impact =
        STEP(family.born_of) == BORN_OF_BOUNCE || (parent.serial_event.y & TRACE_FATAL) != 0u;
    EXACT float3 velocity = particle_velocity(p);
    bool moves = velocity.x != 0.0f || velocity.y != 0.0f || velocity.z != 0.0f;
    if (!STEP_LIES || FAMILY_TRAILS || !of_impact || moves)
        return p;
    S(kiln_particle) y = p;
    y.velocity_birth.x = (STEP(step) << KILN_REST_STEP_SHIFT) | sixty_fourths;
    y.velocity_birth.y = 0u;
    y.velocity_birth.z = heading_pack(trace_normal(parent));
    y.velocity_birth.w |= KILN_PARTICLE_STOPPED;
    return y;
}

/* If the event from which this slot's child is born happens in the parent's step, returns the new
 * child. Otherwise returns `old`, the slot's content before the step. */
FN S(kiln_particle) step_child(SIM_PARAM uint slot, S(kiln_particle) old, S(kiln_trace) parent)
{
    uint j = slot % STEP(family.slots);
    EXACT S(family_event) event = family_event_of(SIM parent, slot);
    if (!event.happens)
        return old;
    EXACT float start_at = parent.start.w * 64.0f;
    uint sixty_fourths = family_sixty_fourths(event.since, UINT(start_at));
    EXACT float since = FLOAT(sixty_fourths) * STEP_SIXTY_FOURTH;
    S(kiln_particle) p = step_dead();
    p.position_serial.w = parent.serial_event.x * STEP(family.slots) + j;
    p.velocity_birth.w = (STEP(step) << KILN_BIRTH_STEP_SHIFT) |
                         (sixty_fourths << KILN_BIRTH_FRACTION_SHIFT) | KILN_PARTICLE_ALIVE;
    uint stream = particle_stream(STEP(derived), p);
    EXACT float born_s = particle_birth_time(STEP(derived), p);
    if (USES(USES_BIRTHS, BORN_OF_WAY) && STEP(family.born_of) == BORN_OF_WAY)
        since = event.since; /* the time is one of 64, but the place is that of the way */
    EXACT S(emit_state) at = family_parent_at(SIM parent, since);
    EXACT float3 axis = family_axis(SIM parent, at.velocity);
    EXACT S(emit_state) born = emit_child(SIM stream, p.position_serial.w, born_s, at, axis);
    p = step_with_motion(p, born.position, born.velocity);
    return step_child_at_rest(SIM p, parent, sixty_fourths);
}

/* Returns the content of a slot after this step, and the slot's trace, which the caller stores if
 * the system has children or paint (family.traced). `old` is the content before the step. `parent`
 * is the trace of the parent's slot, at the index family_parent_trace; a system without a parent
 * ignores it. */
FN S(step_result) step_family_slot(SIM_PARAM uint slot, S(kiln_particle) old, S(kiln_trace) parent)
{
    S(kiln_particle) p = old;
    if (STEP(family.born_of) != BORN_OF_CLOCK) {
        p = step_child(SIM slot, old, parent);
    } else {
        uint index = step_birth_index(SIM slot);
        if (index < STEP(birth_count))
            p = step_birth(SIM index);
    }
    EXACT S(step_result) r = step_result_dead();
    if (particle_is_alive(p)) {
        EXACT S(step_push) push = push_of(SIM slot);
        r = step_family_particle(SIM p, push);
    }
    if ((STEP(family.keeps) & FAMILY_KEEPS_REMAINS) != 0u && !particle_is_alive(r.particle))
        r.particle = particle_remains(p);
#if FAMILY_HAS_WAYS
    if (STEP(family.travels) != 0u && (r.trace.serial_event.y & TRACE_ALIVE) != 0u)
        family_travel(SIM slot, particle_birth_step(p) == STEP(step), r.trace);
#endif
    return r;
}

#endif
