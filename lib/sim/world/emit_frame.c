/* This file makes the frame from which an attached emitter gives birth in a step, and with which
 * particles in the space of a node move. The host knows the node's frame at any time; kernels get
 * the coefficients of a cubic instead, which they evaluate at each birth (shaders/shared/emit.h).
 * On a circle at 60 steps a second, the cubic is within a millionth of the radius. */
#include "sim/world/emit_frame.h"

#include <math.h>

#include "shared/exact.h"
#include "sim/world/oriented.h"

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Returns whether a node jumps between two frames: it is farther from where the mean of its
 * velocities would bring it than both of them together explain. */
static bool jumps(const struct kiln_node_frame *start, const struct kiln_node_frame *end,
                  double dt_s)
{
    double off[3];
    for (int c = 0; c < 3; c++)
        off[c] = end->at[c] - start->at[c] - 0.5 * dt_s * (start->velocity[c] + end->velocity[c]);
    const double explained = dt_s * (length_of(start->velocity) + length_of(end->velocity));
    return length_of(off) > explained + 1e-6 * (1 + length_of(start->at));
}

static float4 to_float4(const double v[3], double w)
{
    return FLOAT4(exact_canon((float)v[0]), exact_canon((float)v[1]), exact_canon((float)v[2]),
                  exact_canon((float)w));
}

/* Returns the frame of the node or of the object that an emitter lies in. */
static struct kiln_node_frame frame_at(const struct kiln_scene *scene,
                                       const struct kiln_emitter *emit, float time_s, float rate_s)
{
    if (emit->source.of_object)
        return kiln_object_frame_at(scene, &scene->backdrop.objects[emit->source.number], time_s,
                                    rate_s);
    return kiln_node_frame_at(scene, emit->attach.node, time_s, rate_s);
}

/* The frames of a node at both ends of a step. */
struct ends {
    struct kiln_node_frame start, end; /* the end of a node that does not jump */
    struct kiln_node_frame real_end;
    bool jumps;
    double steps_per_s;
};

/* Finds what a jump changes; `start` and `real_end` are known. */
static void find_end(const struct kiln_scene *scene, struct ends *ends)
{
    ends->steps_per_s = (double)scene->rate.num / (double)scene->rate.den;
    const double dt_s = 1 / ends->steps_per_s;
    ends->end = ends->real_end;
    ends->jumps = jumps(&ends->start, &ends->real_end, dt_s);
    if (ends->jumps) {
        ends->end = ends->start;
        for (int c = 0; c < 3; c++)
            ends->end.at[c] += dt_s * ends->start.velocity[c];
    }
}

static struct kiln_emit_frame frame_between(const struct ends *ends)
{
    const struct kiln_node_frame start = ends->start, end = ends->end;
    const double steps_per_s = ends->steps_per_s, dt_s = 1 / steps_per_s;
    double linear[3], square[3], cube[3];
    for (int c = 0; c < 3; c++) {
        const double way = end.at[c] - start.at[c], to = dt_s * end.velocity[c];
        linear[c] = dt_s * start.velocity[c];
        square[c] = 3 * way - 2 * linear[c] - to;
        cube[c] = linear[c] + to - 2 * way;
    }
    return (struct kiln_emit_frame){
        .start = to_float4(start.at, start.scale),
        .linear = to_float4(linear, end.scale - start.scale),
        .square = to_float4(square, steps_per_s),
        .cube = to_float4(cube, 0),
        .pose = FLOAT4(exact_canon((float)start.turn[0]), exact_canon((float)start.turn[1]),
                       exact_canon((float)start.turn[2]), exact_canon((float)start.turn[3])),
        .spin = kiln_spin_between_turns(start.turn, end.turn),
    };
}

struct kiln_emit_frame kiln_emit_frame(const struct kiln_scene *scene,
                                       const struct kiln_emitter *emit, uint32_t step)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    struct ends ends = {
        .start = frame_at(scene, emit, start_s, start_s),
        .real_end = frame_at(scene, emit, end_s, nextafterf(end_s, -INFINITY)),
    };
    find_end(scene, &ends);
    return frame_between(&ends);
}

/* Returns the rotation from one to another, both as unit quaternions of doubles. */
static float4 turn_between(const double from[4], const double to[4])
{
    const double vector[3] = {
        to[0] * from[3] - to[3] * from[0] - to[1] * from[2] + to[2] * from[1],
        to[1] * from[3] - to[3] * from[1] - to[2] * from[0] + to[0] * from[2],
        to[2] * from[3] - to[3] * from[2] - to[0] * from[1] + to[1] * from[0],
    };
    return to_float4(vector, to[3] * from[3] + to[0] * from[0] + to[1] * from[1] + to[2] * from[2]);
}

struct kiln_carry kiln_carry_frame(const struct kiln_scene *scene, uint32_t node, uint32_t step)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    struct ends ends = {
        .start = kiln_node_frame_at(scene, node, start_s, start_s),
        .real_end = kiln_node_frame_at(scene, node, end_s, nextafterf(end_s, -INFINITY)),
    };
    find_end(scene, &ends);
    return (struct kiln_carry){
        .frame = frame_between(&ends),
        .end = to_float4(ends.real_end.at, ends.jumps ? 1 : 0),
        .whole = turn_between(ends.start.turn, ends.real_end.turn),
        .jump = turn_between(ends.end.turn, ends.real_end.turn),
    };
}
