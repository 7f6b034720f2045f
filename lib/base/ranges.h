/* Counts and finds the frames of ascending ranges. */
#ifndef KILN_BASE_RANGES_H
#define KILN_BASE_RANGES_H

#include "kiln.h"

/* Returns the number of frames of all ranges. */
uint64_t kiln_ranges_count(const struct kiln_frame_range *ranges, size_t range_count);

/* Returns the frame at a position below kiln_ranges_count. */
uint32_t kiln_ranges_at(const struct kiln_frame_range *ranges, size_t range_count,
                        uint64_t position);

/* Finds the position of a frame; false when it is in none of the ranges. */
bool kiln_ranges_find(const struct kiln_frame_range *ranges, size_t range_count, uint32_t frame,
                      uint32_t *position);

#endif
