/* Gives colours to transparent pixels. */
#ifndef KILN_OUTPUT_BLEED_H
#define KILN_OUTPUT_BLEED_H

#include "output/output.h"

/* Gives pixels whose alpha is zero the colour of the visible pixels around them. It does not change
 * how the picture looks. But a texture filter or a lossy codec mixes neighbouring pixels, and would
 * mix black into the edges. KILN_DEVICE_FAILED when memory is short. */
bool kiln_bleed_colors(const struct kiln_picture *picture, struct kiln_error *error);

#endif
