/* Computes births of particles from other particles (docs/determinism.md, 3). A parent's children
 * have n reserved slots. Child j of a parent in slot p lives in slot p * n + j and has the serial n
 * * (parent's serial) + j. Therefore no counter assigns slots, and the result depends on no
 * order. */
#ifndef KILN_SHARED_FAMILY_H
#define KILN_SHARED_FAMILY_H

#include "shared/family_way.h"

/* Returns the 64ths of the step that have passed at the part `since` of it, at least `least`: the
 * form in which a birth word has a time. */
FN uint family_sixty_fourths(float since, uint least)
{
    EXACT float whole = FLOOR(since * 64.0f);
    EXACT float inside = exact_clamp(whole, 0.0f, 63.0f);
    uint y = UINT(inside);
    return y > least ? y : least;
}

/* The event of a parent's step at which one of its children is born. */
struct family_event {
    float since; /* part of the step before the event */
    bool happens;
};

FN S(family_event) family_no_event(void)
{
    EXACT S(family_event) e;
    e.since = 0.0f;
    e.happens = false;
    return e;
}

/* Does family_number_at for a rate that varies. */
FN_APART float family_number_of_keys(SIM_PARAM S(kiln_trace) t, float part, float progress)
{
    EXACT float life_s = BITS_FLOAT(t.serial_event.w);
    uint stream = random_stream(STEP(derived.random_key), t.serial_event.x);
    EXACT float time_s = STEP(time_s) + part * STEP(derived.dt_s);
    EXACT S(value_clocks) clocks =
        value_clocks_of_birth(time_s, STEP(derived.random_key), STEP(derived.scene_key), stream);
    return value_number_at(SIM_KEYS STEP(family.rate), clocks, progress, life_s);
}

/* Returns how many children a trail has had at a part of the step, when the parent had some
 * progress through its life. */
FN float family_number_at(SIM_PARAM S(kiln_trace) t, float part, float progress)
{
    if (STEP(family.rate.count) != 0u)
        return family_number_of_keys(SIM t, part, progress);
    EXACT float life_s = BITS_FLOAT(t.serial_event.w);
    EXACT float sum = STEP(family.rate.constant) * progress;
    EXACT float number = sum * life_s;
    return number;
}

/* Finds the birth of child j of a trail. It is born when the integral of the rate over the parent's
 * life passes j: in the step in which this happens, at a linearly interpolated time. */
FN S(family_event) family_trail(SIM_PARAM S(kiln_trace) t, uint j)
{
    EXACT float before = family_number_at(SIM t, t.start.w, t.start_velocity.w);
    EXACT float after = family_number_at(SIM t, t.end.w, t.end_velocity.w);
    EXACT float count = FLOAT(j);
    EXACT float passed = count - before;
    EXACT float whole = after - before;
    EXACT float part = exact_div(passed, whole);
    EXACT float step_part = t.end.w - t.start.w;
    EXACT S(family_event) e;
    e.since = t.start.w + step_part * part;
    e.happens = count >= before && count < after;
    return e;
}

#if FAMILY_HAS_WAYS

/* Finds the birth of child j of the parent in a slot. It is born when the parent has travelled j +
 * 1 of the distances between two children: where this happens on the two straight pieces of its
 * way, each of which it goes along evenly. */
FN_APART S(family_event) family_by_way(SIM_PARAM S(kiln_trace) t, uint parent, uint j)
{
    EXACT S(family_event) e = family_no_event();
    EXACT float target = FLOAT(j + 1u);
    EXACT float per_metre = STEP(family.per_metre);
    S(family_way) way = family_way_at(SIM STEP(family.parent_ways) + parent);
    EXACT float after = family_way_count(way, per_metre);
    if (target > after)
        return e;
    EXACT S(family_pieces) pieces = family_pieces_of(t);
    EXACT float length = pieces.first + pieces.second;
    way = family_way_sub(way, family_way_of(length));
    EXACT float before = family_way_count(way, per_metre);
    EXACT float part = exact_div(target - before, after - before);
    EXACT float gone = length * exact_clamp(part, 0.0f, 1.0f);
    EXACT float from = t.start.w;
    EXACT float to = (t.serial_event.y & TRACE_TURN) != 0u ? t.turn.w : t.end.w;
    EXACT float along = exact_div(gone, pieces.first);
    if (gone > pieces.first) {
        from = to;
        to = t.end.w;
        along = exact_div(gone - pieces.first, pieces.second);
    }
    e.since = from + (to - from) * exact_clamp(along, 0.0f, 1.0f);
    e.happens = before < target;
    return e;
}

#endif

/* Returns how many children are born of an event of a parent. The parent's serial, the system of
 * the children and the number of the event decide: each impact draws its own. */
FN uint family_count(SIM_PARAM S(kiln_trace) t, uint number)
{
    uint fewest = STEP(family.fewest);
    uint most = STEP(family.most);
    if (fewest == most)
        return most;
    uint stream = random_stream(STEP(derived.random_key), t.serial_event.x);
    EXACT float choices = FLOAT(most - fewest + 1u);
    EXACT float drawn = random_unit(stream, RANDOM_CHILDREN + number) * choices;
    uint more = UINT(drawn);
    uint count = fewest + more;
    return count < most ? count : most;
}

/* Returns whether child j is born of the impact in this step. Each impact has slots for the most
 * children. */
FN bool family_is_of_hit(SIM_PARAM S(kiln_trace) t, uint j)
{
    uint hit = t.serial_event.y >> TRACE_HITS_SHIFT;
    uint most = STEP(family.most);
    return j / most == hit && j % most < family_count(SIM t, hit);
}

/* Returns whether a child may be born in the step. what: serial_event.y of its parent's trace. */
FN bool family_may_happen(SIM_PARAM uint what)
{
    uint event = STEP(family.impacts) != 0u ? TRACE_DEATH | TRACE_FATAL : TRACE_DEATH;
    if (STEP(family.born_of) == BORN_OF_BOUNCE)
        event = TRACE_TURN;
    else if (STEP(family.born_of) >= BORN_OF_TRAIL)
        event = TRACE_ALIVE;
    return (what & event) != 0u;
}

/* Returns the event at which the child of a slot is born. t: the trace of its parent. */
FN S(family_event) family_event_of(SIM_PARAM S(kiln_trace) t, uint slot)
{
    EXACT S(family_event) e = family_no_event();
    uint j = slot % STEP(family.slots);
    if (!family_may_happen(SIM t.serial_event.y))
        return e;
#if FAMILY_HAS_WAYS
    if (USES(USES_BIRTHS, BORN_OF_WAY) && STEP(family.born_of) == BORN_OF_WAY) {
        e = family_by_way(SIM t, slot / STEP(family.slots), j);
        return e;
    }
#endif
    if (USES(USES_BIRTHS, BORN_OF_TRAIL) && STEP(family.born_of) == BORN_OF_TRAIL) {
        e = family_trail(SIM t, j);
    } else if (STEP(family.born_of) == BORN_OF_BOUNCE) {
        e.since = t.turn.w;
        e.happens = family_is_of_hit(SIM t, j);
    } else {
        e.since = t.end.w;
        e.happens = j < family_count(SIM t, 0u);
    }
    return e;
}

/* Whether children are born along the way of their parents. */
#define FAMILY_TRAILS                                                                              \
    ((USES(USES_BIRTHS, BORN_OF_TRAIL) || USES(USES_BIRTHS, BORN_OF_WAY)) &&                       \
     STEP(family.born_of) >= BORN_OF_TRAIL)

/* Returns the parent's place and velocity at the event. */
FN S(emit_state) family_parent_at(SIM_PARAM S(kiln_trace) t, float since)
{
    EXACT S(emit_state) s;
    if (FAMILY_TRAILS) {
        s = trace_at(t, since);
    } else if (STEP(family.born_of) == BORN_OF_BOUNCE) {
        s.position = trace_vector(t.turn);
        s.velocity = trace_vector(t.turn_velocity);
    } else {
        s.position = trace_vector(t.end);
        s.velocity = trace_vector(t.end_velocity);
    }
    return s;
}

FN float3 family_axis(SIM_PARAM S(kiln_trace) t, float3 velocity)
{
    EXACT float3 axis = FLOAT3(0.0f, 1.0f, 0.0f);
    if (STEP(family.align) == ALIGN_NORMAL)
        axis = trace_normal(t);
    else if (STEP(family.align) == ALIGN_VELOCITY)
        axis = float3_normalize(velocity, axis);
    return axis;
}

/* Returns the index of the parent slot's trace among all traces. */
FN uint family_parent_trace(SIM_PARAM uint slot)
{
    return STEP(family.parent_traces) + slot / STEP(family.slots);
}

#endif
