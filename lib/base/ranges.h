/* Frames as ascending ranges: how many there are, and which one is where. */
#ifndef KILN_BASE_RANGES_H
#define KILN_BASE_RANGES_H

#include "kiln.h"

/* Frames of all ranges. */
uint64_t kiln_ranges_count(const struct kiln_frame_range *ranges, size_t range_count);

/* The frame at a position below kiln_ranges_count. */
uint32_t kiln_ranges_at(const struct kiln_frame_range *ranges, size_t range_count,
                        uint64_t position);

/* The position of a frame; false when it is in none of the ranges. */
bool kiln_ranges_find(const struct kiln_frame_range *ranges, size_t range_count, uint32_t frame,
                      uint32_t *position);

#endif
