/* Computes the light of lamps of each kind: points, spots and rectangles. A point of colour c gives
 * a surface the irradiance pi c cos / (d^2 + r^2). A spot is a point that shines into a cone. A
 * rectangle sends the same radiance from each point of its front into all directions. Its colour c
 * is radiance * area / pi, so that from afar it shines as a point of that colour does, times the
 * cosine of the angle to its front.
 *
 * The irradiance by a rectangle is exact: Lambert's sum over the edges of the part above the
 * surface's horizon. */
#ifndef KILN_SHARED_LAMP_H
#define KILN_SHARED_LAMP_H

#include "shared/draw_layout.h"
#include "shared/real.h"

#define LAMP_PI 3.14159265f

/* ---- directions ------------------------------------------------------------------------------ */

/* Returns the cosine of the angle between the direction in which a lamp shines and the way to a
 * point. towards: from the point to the lamp's centre. */
REAL_FN real lamp_cosine(S(kiln_draw_light) lamp, real3 towards)
{
    real square = real_max(real3_dot(towards, towards), real_all(1e-12f));
    return -real3_dot_all(towards, lamp.facing) * real_rsqrt(square);
}

/* Returns the part of a lamp's light that its cone lets out towards a point, 0 to 1. Between the
 * inner and the outer cone the light falls by Hermite's cubic of the cosine. */
REAL_FN real lamp_cone(S(kiln_draw_light) lamp, real3 towards)
{
    if (lamp.facing.w != KILN_LAMP_SPOT)
        return real_all(1.0f);
    real part = real_clamp01((lamp_cosine(lamp, towards) - lamp.right.w) * lamp.up.w);
    return part * part * (3.0f - 2.0f * part);
}

/* Returns the brightness of a lamp as seen from a point, as a part of its brightness from in front.
 * A rectangle seen at an angle looks smaller, by the cosine. */
REAL_FN real lamp_share(S(kiln_draw_light) lamp, real3 towards)
{
    if (LAMP_IS_RECTANGLE(lamp))
        return real_max(lamp_cosine(lamp, towards), real_all(0.0f));
    return lamp_cone(lamp, towards);
}

/* ---- rectangles ------------------------------------------------------------------------------ */

/* Returns an angle of 0 to pi, divided by its sine. The polynomial is that of Abramowitz and
 * Stegun, 4.4.46, for the arc cosine. */
REAL_FN real lamp_angle_by_sine(real cosine)
{
    real x = real_min(real_abs(cosine), real_all(1.0f));
    real y = 0.0066700901f - 0.0012624911f * x;
    y = 0.0308918810f + x * (x * y - 0.0170881256f);
    y = 0.0889789874f + x * (x * y - 0.0501743046f);
    y = 1.5707963050f + x * (x * y - 0.2145988016f);
    real acute = y * real_rsqrt(1.0f + x);
    real obtuse = LAMP_PI * real_rsqrt(real_max(1.0f - x * x, real_all(1e-7f))) - acute;
    return real_select(cosine > 0.0f, acute, obtuse);
}

/* Returns the angle under which an edge is seen, times the part along `normal` of the unit normal
 * of the plane through the edge and the surface's point. from: the way to the edge's start. */
REAL_FN real lamp_edge(real3 normal, real3 from, real3 edge)
{
    real3 to = real3_add(from, edge);
    real inverse = real_rsqrt(real_max(real3_dot(from, from), real_all(1e-12f))) *
                   real_rsqrt(real_max(real3_dot(to, to), real_all(1e-12f)));
    real sine = real3_dot(normal, real3_cross(from, edge)) * inverse;
    return sine * lamp_angle_by_sine(real3_dot(from, to) * inverse);
}

/* Holds the sum over the edges of an outline so far, and where the outline crosses the horizon. */
struct lamp_outline {
    real sum;
    real3 sets, rises; /* where it goes below the horizon, and where it comes back */
};

/* Adds the part of an edge that is above the horizon. height, next: of its ends above the horizon;
 * the next edge starts with the height at which this one ends. */
REAL_FN S(lamp_outline) lamp_add_edge(S(lamp_outline) outline, real3 normal, real3 from, real3 edge,
                                      real height, real next)
{
    truth starts = height >= 0.0f, ends = next >= 0.0f;
    truth rises = truth_and(truth_not(starts), ends), sets = truth_and(starts, truth_not(ends));
    real fall = real_select(truth_or(rises, sets), height - next, real_all(1.0f));
    real crossing = height / fall;
    real first = real_select(starts, real_all(0.0f), crossing);
    real last = real_select(ends, real_all(1.0f), crossing);
    real3 at = real3_add_scaled(from, edge, crossing);
    S(lamp_outline) added;
    added.sum = outline.sum + lamp_edge(normal, real3_add_scaled(from, edge, first),
                                        real3_scale(edge, last - first));
    added.sets = real3_select(sets, at, outline.sets);
    added.rises = real3_select(rises, at, outline.rises);
    return added;
}

/* Returns the irradiance by a rectangle of radiance 1, which has pi times the form factor. */
REAL_FN real rectangle_irradiance(S(kiln_draw_light) lamp, real3 towards, real3 normal)
{
    real3 right = real3_all(lamp.right), up = real3_all(lamp.up);
    real middle = real3_dot(towards, normal);
    real aside = real3_dot(right, normal), above = real3_dot(up, normal);
    real h0 = middle - aside - above, h1 = middle + aside - above;
    real h2 = middle + aside + above, h3 = middle - aside + above;
    real3 zero = REAL3(real_all(0.0f), real_all(0.0f), real_all(0.0f));
    real3 low = real3_sub(towards, up), high = real3_add(towards, up);
    real3 width = real3_scale(right, real_all(2.0f)), height = real3_scale(up, real_all(2.0f));

    S(lamp_outline) sum;
    sum.sum = real_all(0.0f);
    sum.sets = zero;
    sum.rises = zero;
    sum = lamp_add_edge(sum, normal, real3_sub(low, right), width, h0, h1);
    sum = lamp_add_edge(sum, normal, real3_add(low, right), height, h1, h2);
    sum = lamp_add_edge(sum, normal, real3_add(high, right), real3_sub(zero, width), h2, h3);
    sum = lamp_add_edge(sum, normal, real3_sub(high, right), real3_sub(zero, height), h3, h0);
    real whole = sum.sum + lamp_edge(normal, sum.sets, real3_sub(sum.rises, sum.sets));
    truth in_front = real3_dot_all(towards, lamp.facing) < 0.0f;
    return real_where(in_front, real_max(0.5f * whole, real_all(0.0f)));
}

/* ---- all kinds ------------------------------------------------------------------------------- */

/* Returns the irradiance for each unit of the colour of a lamp without a cone. */
REAL_FN real lamp_irradiance(S(kiln_draw_light) lamp, real3 towards, real3 normal)
{
    float radius2 = lamp.position_radius2.w;
    if (LAMP_IS_RECTANGLE(lamp))
        return rectangle_irradiance(lamp, towards, normal) * (1.0f / radius2);
    real along = real3_dot(normal, towards), d2 = real3_dot(towards, towards);
    real part = along * real_rsqrt(real_max(d2, real_all(1e-9f))) * LAMP_PI / (d2 + radius2);
    return real_where(along > 0.0f, part);
}

#endif
