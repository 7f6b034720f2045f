/* Finds frames in ascending ranges of frames. A walk over the ranges is enough, since they are few.
 */
#include "base/ranges.h"

uint64_t kiln_ranges_count(const struct kiln_frame_range *ranges, size_t range_count)
{
    uint64_t count = 0;
    for (size_t i = 0; i < range_count; i++)
        count += (uint64_t)ranges[i].last - ranges[i].first + 1;
    return count;
}

uint32_t kiln_ranges_at(const struct kiln_frame_range *ranges, size_t range_count,
                        uint64_t position)
{
    size_t i = 0;
    for (; i + 1 < range_count && position > ranges[i].last - ranges[i].first; i++)
        position -= (uint64_t)ranges[i].last - ranges[i].first + 1;
    return ranges[i].first + (uint32_t)position;
}

bool kiln_ranges_find(const struct kiln_frame_range *ranges, size_t range_count, uint32_t frame,
                      uint32_t *position)
{
    uint32_t before = 0;
    for (size_t i = 0; i < range_count; i++) {
        *position = before + frame - ranges[i].first;
        if (frame >= ranges[i].first && frame <= ranges[i].last)
            return true;
        before += ranges[i].last - ranges[i].first + 1;
    }
    return false;
}
