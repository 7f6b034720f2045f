/* This header holds the constants and weights of the blooms, which all techniques share. */
#ifndef KILN_POST_BLOOM_KERNELS_H
#define KILN_POST_BLOOM_KERNELS_H

#include "shared/exact.h"

enum {
    KILN_BLOOM_TAPS = 6,        /* of the Gaussian on one side, centre included; it has 11 in all */
    KILN_BLOOM_MAX_LEVELS = 12, /* of the pyramid */
    KILN_BLOOM_LEAST_EDGE = 8   /* pixels; the shorter side of the last level is not below it */
};

/* Fills in the weights of a Gaussian of sigma 2 pixels, from the centre outwards. The weights of
 * all eleven taps sum to 1. */
static inline void kiln_bloom_gaussian_weights(float weights[KILN_BLOOM_TAPS])
{
    const float sigma = 2.0f;
    float sum = 0.0f;
    for (int i = 0; i < KILN_BLOOM_TAPS; i++) {
        weights[i] = exact_exp(-0.5f * (float)(i * i) / (sigma * sigma));
        sum += i == 0 ? weights[i] : 2.0f * weights[i];
    }
    for (int i = 0; i < KILN_BLOOM_TAPS; i++)
        weights[i] /= sum;
}

#endif
