/* Declares traces: what a particle of a system with children or paint did in the present step. A
 * trace tells place and velocity at any time of the step. It is written when the parent is stepped,
 * and read in the same step when its children are stepped, or paint is applied, so it is not part
 * of the state. */
#ifndef KILN_SHARED_TRACE_H
#define KILN_SHARED_TRACE_H

#include "shared/collide.h"
#include "shared/derived.h"
#include "shared/emit.h"

/* Events of the step; 0 if the slot had no living particle. */
#define TRACE_ALIVE 1u
#define TRACE_TURN  2u  /* it hit a surface in this step */
#define TRACE_DEATH 8u  /* its life ended */
#define TRACE_FATAL 16u /* it died of its hit */

/* The bits above these have the number of impacts in earlier steps, as far as they are counted. */
#define TRACE_HITS_SHIFT 8u

struct kiln_trace {
    float4 start;          /* position, m; part of the step that had passed */
    float4 turn;           /* place of the first impact, just outside of the surface */
    float4 end;            /* end of the step or of the life */
    float4 start_velocity; /* m/s; progress through life */
    float4 turn_velocity;  /* velocity after the impact, m/s; w: distance from the surface, m */
    float4 end_velocity;   /* m/s; progress through life */
    uint4 serial_event;    /* serial; TRACE_* and hits; face of the impact; life in seconds as float
                              bits */
};

FN float4 trace_pack(float3 v, float w)
{
    EXACT float3 c = float3_canon(v);
    EXACT float d = exact_canon(w);
    EXACT float4 y = FLOAT4(c.x, c.y, c.z, d);
    return y;
}

FN float3 trace_vector(float4 v)
{
    EXACT float3 y = FLOAT3(v.x, v.y, v.z);
    return y;
}

FN S(kiln_trace) trace_nothing(void)
{
    EXACT S(kiln_trace) t;
    t.start = FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    t.turn = t.start;
    t.end = t.start;
    t.start_velocity = t.start;
    t.turn_velocity = t.start;
    t.end_velocity = t.start;
    t.serial_event = UINT4(0u, 0u, 0u, 0u);
    return t;
}

/* Returns place and velocity after the part `since` of the step. The place is on the straight lines
 * from the start over the first impact to the end. The velocity changes evenly from start to end,
 * or at the impact. */
FN S(emit_state) trace_at(S(kiln_trace) t, float since)
{
    bool has_turn = (t.serial_event.y & TRACE_TURN) != 0u;
    bool before = has_turn && since < t.turn.w;
    EXACT float4 from = t.start;
    EXACT float4 to = t.end;
    if (before)
        to = t.turn;
    if (has_turn && !before)
        from = t.turn;
    EXACT float passed = since - from.w;
    EXACT float whole = to.w - from.w;
    EXACT float quotient = exact_div(passed, whole);
    EXACT float part = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float3 a = trace_vector(from);
    EXACT float3 b = trace_vector(to);
    EXACT float3 way = float3_sub(b, a);
    EXACT float3 slow = trace_vector(t.start_velocity);
    EXACT float3 fast = trace_vector(t.end_velocity);
    EXACT float3 change = float3_sub(fast, slow);
    EXACT float changed = has_turn ? (before ? 0.0f : 1.0f) : part;
    EXACT S(emit_state) s;
    s.position = float3_add_scaled(a, way, part);
    s.velocity = float3_add_scaled(slow, change, changed);
    return s;
}

/* Returns the normal of the surface that the particle hit. */
FN float3 trace_normal(S(kiln_trace) t)
{
    EXACT float3 y = collide_normal_of(t.serial_event.z);
    return y;
}

#endif
