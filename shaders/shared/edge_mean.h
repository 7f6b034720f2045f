/* Computes the colour of a pixel at an edge from its samples. A display clips light. So with a mean
 * of light, a pixel is white of which only a quarter shows something four times as bright as
 * white, and a bright edge is a stair. Here a sample counts the less the brighter it is, so that
 * such pixels lie between the two sides on the display, too (Karis, High Quality Temporal
 * Supersampling, SIGGRAPH 2014, who weighs so for another purpose). */
#ifndef KILN_SHARED_EDGE_MEAN_H
#define KILN_SHARED_EDGE_MEAN_H

#include "shared/real.h"

/* Returns the weight of a sample, above 0 to 1. exposure: what the composite multiplies light by.
 */
REAL_FN real edge_weight(real3 light, float exposure)
{
    real brightest = real_max(real_max(light.x, light.y), real_max(light.z, real_all(0.0f)));
    return 1.0f / (1.0f + brightest * exposure);
}

/* Sums of samples. Alpha is not weighted, so that it stays the part of the pixel that is covered.
 */
struct edge_sum {
    real3 light, weighted; /* premultiplied */
    real alpha, weighted_alpha;
};

REAL_FN S(edge_sum) edge_sum_none(void)
{
    S(edge_sum) sum;
    sum.light = REAL3(real_all(0.0f), real_all(0.0f), real_all(0.0f));
    sum.weighted = sum.light;
    sum.alpha = real_all(0.0f);
    sum.weighted_alpha = real_all(0.0f);
    return sum;
}

/* Adds a sample of premultiplied light. part: of the pixel. */
REAL_FN S(edge_sum) edge_add(S(edge_sum) sum, real3 light, real alpha, real part, float exposure)
{
    real weight = part * edge_weight(light, exposure);
    sum.light = real3_add_scaled(sum.light, light, part);
    sum.weighted = real3_add_scaled(sum.weighted, light, weight);
    sum.alpha = sum.alpha + alpha * part;
    sum.weighted_alpha = sum.weighted_alpha + alpha * weight;
    return sum;
}

/* Returns the pixel's premultiplied light; its alpha is sum.alpha. Light without alpha is the mean.
 */
REAL_FN real3 edge_mean(S(edge_sum) sum)
{
    truth some = sum.weighted_alpha > 0.0f;
    real scale = sum.alpha / real_select(some, sum.weighted_alpha, real_all(1.0f));
    return real3_select(some, real3_scale(sum.weighted, scale), sum.light);
}

#endif
