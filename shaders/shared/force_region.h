/* Computes how much of a force is left at a place, for forces that act in a region alone. A force
 * acts in full deep inside of its region, fades over the last metres to the border, and does
 * nothing outside. Its acceleration, pull and quadratic drag fade alike, so air in a region takes
 * particles along less, and does not blow more slowly. */
#ifndef KILN_SHARED_FORCE_REGION_H
#define KILN_SHARED_FORCE_REGION_H

#include "shared/force.h"

/* Returns how far inside of a region a place is, m: the distance from the border. It is below 0
 * outside. center and size: as in struct kiln_force_params. */
FN float force_region_depth(float3 position, uint region, float4 center, float4 size)
{
    EXACT float3 away = FLOAT3(position.x - center.x, position.y - center.y, position.z - center.z);
    EXACT float distance = float3_length(away);
    EXACT float in_sphere = size.x - distance;
    EXACT float in_x = size.x - exact_abs(away.x);
    EXACT float in_y = size.y - exact_abs(away.y);
    EXACT float in_z = size.z - exact_abs(away.z);
    EXACT float in_xy = exact_min(in_x, in_y);
    EXACT float in_box = exact_min(in_xy, in_z);
    EXACT float depth = region == REGION_SPHERE ? in_sphere : in_box;
    return depth;
}

/* Returns the factor on a force at a place, from 0 to 1: 3 t^2 - 2 t^3, where t grows from 0 at the
 * border to 1 at the depth of the falloff. */
FN float force_region_weight(float3 position, uint region, float4 center, float4 size)
{
    EXACT float depth = force_region_depth(position, region, center, size);
    EXACT float falloff = center.w > 0.0f ? center.w : 1.0f;
    EXACT float quotient = exact_div(depth, falloff);
    EXACT float t = exact_clamp(quotient, 0.0f, 1.0f);
    EXACT float faded = t * t * (3.0f - 2.0f * t);
    EXACT float sharp = depth >= 0.0f ? 1.0f : 0.0f;
    EXACT float weight = center.w > 0.0f ? faded : sharp;
    return weight;
}

FN S(force_effect) force_region_fade(S(force_effect) effect, float weight)
{
    EXACT S(force_effect) y;
    y.acceleration = float3_scale(effect.acceleration, weight);
    y.pull = effect.pull * weight;
    y.quadratic = effect.quadratic * weight;
    return y;
}

#endif
