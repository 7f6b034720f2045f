/* Computes the colours of magma, the colour map of error maps: black, purple, orange, pale yellow.
 */
#ifndef KILN_COMPARE_MAGMA_H
#define KILN_COMPARE_MAGMA_H

#include <stdint.h>

/* Computes the sRGB colour of an error, which is clamped to 0 to 1. The colour is entry int(255
 * error + 0.5) of the map's 256; each channel is within 1 of the published table. */
void kiln_magma_color(float error, uint8_t rgb[3]);

#endif
