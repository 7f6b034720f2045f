/* This header holds the constants and weights of the blooms, which all techniques share. */
#ifndef KILN_POST_BLOOM_KERNELS_H
#define KILN_POST_BLOOM_KERNELS_H

#include "shared/exact.h"

enum {
    KILN_BLOOM_TAPS = 6,        /* of one side of the Gaussian with its centre: 11 in all */
    KILN_BLOOM_MAX_LEVELS = 12, /* of the pyramid */
    KILN_BLOOM_LEAST_EDGE = 8   /* pixels of the shorter side of its last level */
};

/* Fills in the weights of a Gaussian of sigma 2, from the centre outwards; all eleven sum to 1. */
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
