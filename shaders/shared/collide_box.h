/* Intersects segments with moving boxes: the geometry of shared/collide.h. */
#ifndef KILN_SHARED_COLLIDE_BOX_H
#define KILN_SHARED_COLLIDE_BOX_H

#include "shared/exact.h"
#include "shared/layout.h"

/* These macros stand in place of FN. In C, FN_CLOSE functions are inlined into their callers, since
 * most impacts use them; FN_APART functions are not, since few impacts do. */
#ifdef GL_core_profile
#define FN_CLOSE
#define FN_APART
#else
#define FN_CLOSE static inline __attribute__((always_inline))
#define FN_APART static __attribute__((noinline, unused))
#endif

/* Faces: 0 is the lower and 1 the upper face in x, 2 and 3 are those in y, 4 and 5 those in z. */
#define COLLIDE_FACES 6u

FN float collide_component(float3 v, uint axis)
{
    EXACT float y = axis == 0u ? v.x : axis == 1u ? v.y : v.z;
    return y;
}

FN float3 collide_with_component(float3 v, uint axis, float value)
{
    EXACT float3 y =
        FLOAT3(axis == 0u ? value : v.x, axis == 1u ? value : v.y, axis == 2u ? value : v.z);
    return y;
}

/* Interpolates between a at the start and b at the end of the step; the result is exactly b at the
 * end. */
FN float collide_moving(float a, float b, float since)
{
    EXACT float y = a + (b - a) * since;
    EXACT float moved = since >= 1.0f ? b : y;
    return moved;
}

/* Interpolates the first three numbers likewise. */
FN float3 collide_moving3(float4 a, float4 b, float since)
{
    EXACT float3 moved = FLOAT3(collide_moving(a.x, b.x, since), collide_moving(a.y, b.y, since),
                                collide_moving(a.z, b.z, since));
    return moved;
}

struct collide_box {
    float3 min, max;
};

/* Returns the box after the part `since` of the step. */
FN S(collide_box) collide_box_at(S(kiln_collider) c, float since)
{
    EXACT S(collide_box) box;
    box.min = collide_moving3(c.min, c.min_end, since);
    box.max = collide_moving3(c.max, c.max_end, since);
    return box;
}

FN bool collide_inside(S(collide_box) box, float3 p)
{
    return p.x > box.min.x && p.x < box.max.x && p.y > box.min.y && p.y < box.max.y &&
           p.z > box.min.z && p.z < box.max.z;
}

/* The result of testing a segment against some faces of a box. */
struct collide_span {
    float enter; /* parts of the segment */
    float leave;
    uint face;    /* face of the entry */
    bool misses;  /* outside of one face all the way */
    bool outside; /* starts outside of some face */
};

/* Adds one face to a result. d0 and d1 are the distances from the face, positive inside, at the
 * segment's ends. */
FN_CLOSE S(collide_span) collide_face(S(collide_span) before, uint face, float d0, float d1)
{
    EXACT S(collide_span) span = before;
    bool in0 = d0 > 0.0f;
    bool in1 = d1 > 0.0f;
    span.misses = span.misses || (!in0 && !in1);
    span.outside = span.outside || !in0;
    if (in0 != in1) {
        EXACT float change = d0 - d1;
        EXACT float quotient = exact_div(d0, change);
        EXACT float part = exact_min(quotient, 1.0f);
        if (in1 && part >= span.enter) {
            span.enter = part;
            span.face = face;
        }
        if (in0)
            span.leave = exact_min(span.leave, part);
    }
    return span;
}

/* Intersects the segment from a, when the box is at `start`, to b, when it is at `end`. */
FN S(collide_span) collide_segment(S(collide_box) start, S(collide_box) end, float3 a, float3 b)
{
    EXACT S(collide_span) span;
    span.enter = 0.0f;
    span.leave = 2.0f;
    span.face = 0u;
    span.misses = false;
    span.outside = false;
    span = collide_face(span, 0u, a.x - start.min.x, b.x - end.min.x);
    span = collide_face(span, 1u, start.max.x - a.x, end.max.x - b.x);
    if (span.misses)
        return span;
    span = collide_face(span, 2u, a.y - start.min.y, b.y - end.min.y);
    span = collide_face(span, 3u, start.max.y - a.y, end.max.y - b.y);
    if (span.misses)
        return span;
    span = collide_face(span, 4u, a.z - start.min.z, b.z - end.min.z);
    span = collide_face(span, 5u, start.max.z - a.z, end.max.z - b.z);
    return span;
}

/* Returns the face that a point inside is nearest to. */
FN uint collide_nearest_face(S(collide_box) box, float3 p)
{
    uint face = 0u;
    EXACT float least = p.x - box.min.x;
    EXACT float d = box.max.x - p.x;
    face = d < least ? 1u : face;
    least = exact_min(d, least);
    d = p.y - box.min.y;
    face = d < least ? 2u : face;
    least = exact_min(d, least);
    d = box.max.y - p.y;
    face = d < least ? 3u : face;
    least = exact_min(d, least);
    d = p.z - box.min.z;
    face = d < least ? 4u : face;
    least = exact_min(d, least);
    d = box.max.z - p.z;
    face = d < least ? 5u : face;
    return face;
}

/* Returns how far outside of a surface a particle is put, without the rounding of its place:
 * 0.06 mm, or a sixteenth of the size of what has the surface, if that is less, m. */
FN float collide_least_gap(float size)
{
    EXACT float part = size * 0.0625f;
    EXACT float gap = exact_min(part, 6.103515625e-5f);
    return gap;
}

/* Returns the coordinate just outside of a face: by the least gap, or by two units in the last
 * place where these are larger. size: of the box from this face to the other one, m. */
FN float collide_beside(float at, bool upper, float size)
{
    EXACT float least = collide_least_gap(size);
    EXACT float gap = least + exact_abs(at) * 2.384185791015625e-7f;
    EXACT float y = upper ? at + gap : at - gap;
    return y;
}

FN float3 collide_put_beside(S(collide_box) box, uint face, float3 p)
{
    uint axis = face >> 1u;
    bool upper = (face & 1u) != 0u;
    EXACT float low = collide_component(box.min, axis);
    EXACT float high = collide_component(box.max, axis);
    EXACT float at = upper ? high : low;
    EXACT float size = high - low;
    EXACT float beside = collide_beside(at, upper, size);
    EXACT float3 y = collide_with_component(p, axis, beside);
    return y;
}

#endif
