/* Declares functions that count and find the frames of a list of ranges, such as 0-9, 20-29. The
 * ranges must ascend and must not overlap. The position of a frame is its index among the frames of
 * all ranges: frame 20 of the example has position 10.
 *
 * The job (lib/job), the outputs (lib/output) and figures (lib/figure) call them for the frames of
 * a clip. Records of jobs and parts of clips go by position, so positions must not change. */
#ifndef KILN_BASE_RANGES_H
#define KILN_BASE_RANGES_H

#include "kiln.h"

/* Returns the number of frames of all ranges. */
uint64_t kiln_ranges_count(const struct kiln_frame_range *ranges, size_t range_count);

/* Returns the frame at a position, which must be less than kiln_ranges_count. */
uint32_t kiln_ranges_at(const struct kiln_frame_range *ranges, size_t range_count,
                        uint64_t position);

/* Finds the position of a frame. False when it is in none of the ranges; *position has no meaning
 * then. */
bool kiln_ranges_find(const struct kiln_frame_range *ranges, size_t range_count, uint32_t frame,
                      uint32_t *position);

#endif
