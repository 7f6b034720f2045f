/* Estimates optical flow: the motion of each pixel from one picture to the next. */
#ifndef KILN_OUTPUT_FLOW_H
#define KILN_OUTPUT_FLOW_H

#include "kiln.h"

/* Estimates the flow between pictures of width x height pixels with `channels` (1 to 4) floats
 * each, about 0 to 1, rows from the top. Writes two floats a pixel, right and down in pixels: the
 * content at p in `from` is at p + flow in `to`. Where the pictures do not determine the flow, it
 * is continued smoothly from around. The result is the same on every machine. False when memory is
 * short. */
bool kiln_flow_estimate(const float *from, const float *to, uint32_t width, uint32_t height,
                        uint32_t channels, float *flow);

#endif
