/* Computes the patterns of balls, as on toys: a stripe around the equator, or segments like those
 * of a beach ball with caps at the poles. Edges are as soft as a pixel is wide. */
#ifndef KILN_SHARED_BALL_PATTERN_H
#define KILN_SHARED_BALL_PATTERN_H

#include "shared/real.h"

#define BALL_STRIPE      0.42f /* half of a stripe's height, in radii */
#define BALL_STRIPE_TURN 1.1f  /* angle for each height there: 1 / cos(latitude) */
#define BALL_CAP         0.94f /* height at which caps begin, in radii */
#define BALL_CAP_TURN    2.9f  /* angle for each height there: 1 / cos(latitude) */
#define BALL_SEGMENTS    8     /* of each colour, at most */

/* Returns the part of a pixel beyond an edge. distance: from the edge to the pixel's middle, rad;
 * width: of the pixel, rad. */
REAL_FN real ball_beyond(real distance, real width)
{
    return real_clamp01(0.5f + distance / width);
}

/* Returns the sine of an angle times its number of segments, from the angle's sine and cosine. */
REAL_FN real ball_segment_sine(real sine, real cosine, real segments)
{
    real c = cosine, s = sine;
    for (int i = 1; i < BALL_SEGMENTS; i++) {
        truth more = segments > FLOAT(i);
        real next = c * cosine - s * sine;
        s = real_select(more, s * cosine + c * sine, s);
        c = real_select(more, next, c);
    }
    return s;
}

/* Returns the part of a pixel that has the second colour. n: the normal in the ball's own axes;
 * segments: number of segments of each colour (0: no pattern; below 0: a stripe); width: of the
 * pixel, rad. */
REAL_FN real ball_other_part(real3 n, real segments, real width)
{
    real high = real_abs(n.y);
    real rim = real_sqrt(real_max(n.x * n.x + n.z * n.z, real_all(1e-12f)));
    real sine = ball_segment_sine(n.z / rim, n.x / rim, segments);
    real lune = ball_beyond(sine * rim / real_max(segments, real_all(1.0f)), width);
    real cap = ball_beyond((high - BALL_CAP) * BALL_CAP_TURN, width);
    real beside = ball_beyond((high - BALL_STRIPE) * BALL_STRIPE_TURN, width);
    real part = real_select(segments < 0.0f, beside, real_max(lune, cap));
    return real_select(segments == 0.0f, real_all(0.0f), part);
}

#endif
