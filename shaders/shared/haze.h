/* Computes how haze veils what is far away: surfaces, solid particles, and billboards, points and
 * lines. What is left of a colour is its part of exp(-density * distance); the rest is the colour
 * of the haze, which is that of the sky at the horizon in the direction of the place. */
#ifndef KILN_SHARED_HAZE_H
#define KILN_SHARED_HAZE_H

#include "shared/draw_layout.h"
#include "shared/real.h"

/* Returns the part of a colour that haze leaves. density: 1/m; t, length: the way from the eye is t
 * times a direction of this length, m. */
REAL_FN real haze_clear(float density, real t, real length)
{
    return real_exp(-density * t * length);
}

/* Returns the level direction of a place that lies in some direction from the eye; north for a
 * place right above or below the eye. */
REAL_FN real3 haze_level(real3 direction)
{
    real square = direction.x * direction.x + direction.z * direction.z;
    real zero = real_all(0.0f);
    return REAL3(direction.x, zero, real_select(square < 1e-12f, real_all(-1.0f), direction.z));
}

/* Returns where a level direction lies among the colours `haze` of struct kiln_draw_backdrop:
 * entry i is at i, and the entry after the last one is the first. 0 to KILN_HAZE_PARTS. */
REAL_FN real haze_place(real3 level)
{
    const float parts = FLOAT(KILN_HAZE_PARTS);
    real turned = real_atan2(level.x, -level.z) * (parts * 0.5f / 3.14159265f);
    return real_clamp(turned + 0.5f * parts, 0.0f, parts);
}

#endif
