/* Computes the samples of a baked wind: the sums of forces at the points of a grid. The forces are
 * those of the step's parameters, whose values are the same for all particles.
 *
 * A grid may lie in a node. Its samples are then vectors in the frame of the node, so the field
 * goes on with the node between two writings. */
#ifndef KILN_SHARED_BAKE_H
#define KILN_SHARED_BAKE_H

#include "shared/forces.h"

/* Returns where a sample of a grid lies in the world: number x, y and z along the axes. */
FN float3 bake_place(S(kiln_grid) g, S(kiln_still_frame) node, uint x, uint y, uint z)
{
    EXACT float3 place = FLOAT3(g.origin.x + FLOAT(x) * g.high.x, g.origin.y + FLOAT(y) * g.high.y,
                                g.origin.z + FLOAT(z) * g.high.z);
    if (still_frame_is(node)) {
        EXACT float3 scaled = float3_scale(place, node.at.w);
        EXACT float3 turned = float3_turn(node.turn, scaled);
        EXACT float3 at = FLOAT3(node.at.x, node.at.y, node.at.z);
        place = float3_add(at, turned);
    }
    return place;
}

/* Returns the sample for a sum of forces. */
FN float4 bake_word(S(kiln_still_frame) node, S(force_effect) sum)
{
    EXACT float3 acceleration = sum.acceleration;
    if (still_frame_is(node)) {
        EXACT float4 back = FLOAT4(-node.turn.x, -node.turn.y, -node.turn.z, node.turn.w);
        acceleration = float3_turn(back, acceleration);
    }
    EXACT float4 word = FLOAT4(exact_canon(acceleration.x), exact_canon(acceleration.y),
                               exact_canon(acceleration.z), exact_canon(sum.pull));
    return word;
}

/* Returns sample number `index`. */
FN float4 bake_sample(SIM_PARAM S(kiln_grid) g, S(kiln_still_frame) node, uint index)
{
    uint row = index / g.size.x;
    uint z = row / g.size.y;
    EXACT float3 place = bake_place(g, node, index - row * g.size.x, row - z * g.size.y, z);
    EXACT float3 still = FLOAT3(0.0f, 0.0f, 0.0f);
    EXACT float time_s = STEP(time_s);
    EXACT S(value_clocks) clocks =
        value_clocks_at(time_s, STEP(derived.random_key), STEP(derived.scene_key));
    EXACT S(force_effect) sum = forces_sum(SIM place, still, clocks);
    EXACT float4 word = bake_word(node, sum);
    return word;
}

#endif
