/* Noise for the procedural flipbooks: gradient noise and sums of it. The same on every machine. */
#ifndef KILN_ASSET_TURBULENCE_H
#define KILN_ASSET_TURBULENCE_H

#include <stdint.h>

/* Gradient noise with lattice points one unit apart, within about -1 and 1, 0 on average. Points up
 * to 2^24 away are good. */
float kiln_noise(float x, float y, float z, uint32_t seed);

/* The mean of `count` octaves of noise, each half as large and half as strong as the one before; z
 * grows more slowly than x and y, so that small detail does not boil when z is time. */
float kiln_noise_octaves(float x, float y, float z, int count, uint32_t seed);

/* Octaves of ridges, 0 to 1: bright sheets where the noise crosses zero. */
float kiln_noise_ridges(float x, float y, float z, int count, uint32_t seed);

#endif
