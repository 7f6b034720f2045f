/* This file makes the frame from which an attached emitter gives birth in a step. The host knows
 * the node's frame at any time; kernels get the coefficients of a cubic instead, which they
 * evaluate at each birth (shaders/shared/emit.h). On a circle at 60 steps a second, the cubic is
 * within a millionth of the radius. */
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

struct kiln_emit_frame kiln_emit_frame(const struct kiln_scene *scene,
                                       const struct kiln_emitter *emit, uint32_t step)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    const double steps_per_s = (double)scene->rate.num / (double)scene->rate.den;
    const double dt_s = 1 / steps_per_s;
    const struct kiln_node_frame start = frame_at(scene, emit, start_s, start_s);
    struct kiln_node_frame end = frame_at(scene, emit, end_s, nextafterf(end_s, -INFINITY));
    double linear[3], square[3], cube[3];
    if (jumps(&start, &end, dt_s)) {
        end = start;
        for (int c = 0; c < 3; c++)
            end.at[c] += dt_s * start.velocity[c];
    }
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
