/* This file makes the frame from which an attached emitter gives birth in a step, and with which
 * particles in the space of a node move. The host knows the node's frame at any time; kernels get
 * the coefficients of a cubic instead, which they evaluate at each birth (shaders/shared/emit.h).
 * On a circle at 60 steps a second, the cubic is within a millionth of the radius. */
#include "sim/world/emit_frame.h"

#include <math.h>

#include "scene/double3.h"
#include "shared/exact.h"
#include "sim/world/oriented.h"

static float4 to_float4(const double v[3], double w)
{
    return FLOAT4(exact_canon((float)v[0]), exact_canon((float)v[1]), exact_canon((float)v[2]),
                  exact_canon((float)w));
}

/* Returns the rotation from one frame to the other as an axis and an angle. Between two poses there
 * are many: this is the one nearest to the mean of the spins at both ends, which may be several
 * turns. */
static float4 find_spin(const struct kiln_node_frame *start, const struct kiln_node_frame *end,
                        double dt_s)
{
    const double turn = 6.283185307179586;
    float4 spin = kiln_spin_between_turns(start->turn, end->turn);
    double mean[3];
    for (int c = 0; c < 3; c++)
        mean[c] = 0.5 * dt_s * (start->spin[c] + end->spin[c]);
    const double angle = double3_length(mean);
    if (angle < 0.25 * turn)
        return spin; /* the shorter way */
    /* after whole turns, the poses alone do not tell the axis */
    if (fabsf(spin.w) < 1e-3f)
        spin = to_float4((const double[3]){mean[0] / angle, mean[1] / angle, mean[2] / angle}, 0);
    const double along =
        (double)spin.x * mean[0] + (double)spin.y * mean[1] + (double)spin.z * mean[2];
    const double turns = floor((along - (double)spin.w) / turn + 0.5);
    spin.w = (float)((double)spin.w + turns * turn);
    return spin;
}

static struct kiln_emit_frame frame_between(const struct kiln_scene *scene,
                                            const struct kiln_node_step *found)
{
    const struct kiln_node_frame start = found->start, end = found->on;
    const double steps_per_s = (double)scene->rate.num / (double)scene->rate.den;
    const double dt_s = 1 / steps_per_s;
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
        .spin = find_spin(&start, &end, dt_s),
    };
}

struct kiln_emit_frame kiln_emit_frame(const struct kiln_scene *scene,
                                       const struct kiln_emitter *emit, uint32_t step)
{
    const struct kiln_node_step found =
        emit->source.of_object
            ? kiln_object_step_at(scene, &scene->backdrop.objects[emit->source.number], step)
            : kiln_node_step_at(scene, emit->attach.node, step);
    return frame_between(scene, &found);
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
    const struct kiln_node_step found = kiln_node_step_at(scene, node, step);
    return (struct kiln_carry){
        .frame = frame_between(scene, &found),
        .end = to_float4(found.end.at, found.jumps ? 1 : 0),
        .whole = turn_between(found.start.turn, found.end.turn),
        .jump = turn_between(found.on.turn, found.end.turn),
    };
}
