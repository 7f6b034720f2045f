/* Takes places from the world into the frame of a node at one time. Lengths stay metres of the
 * world: the host scales what lies in the node, and kernels scale what they evaluate themselves. */
#ifndef KILN_SHARED_STILL_FRAME_H
#define KILN_SHARED_STILL_FRAME_H

#include "shared/exact.h"
#include "shared/layout.h"

/* Returns whether there is a frame; what has none lies in the world. */
FN bool still_frame_is(S(kiln_still_frame) frame)
{
    return frame.at.w > 0.0f;
}

/* Returns a place of the world as seen from the frame, m. A vector leaves the frame by
 * float3_turn(frame.turn, vector). */
FN float3 still_frame_inside(S(kiln_still_frame) frame, float3 place)
{
    EXACT float3 from = FLOAT3(place.x - frame.at.x, place.y - frame.at.y, place.z - frame.at.z);
    EXACT float4 back = FLOAT4(-frame.turn.x, -frame.turn.y, -frame.turn.z, frame.turn.w);
    EXACT float3 y = float3_turn(back, from);
    return y;
}

#endif
