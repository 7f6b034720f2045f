/* Divides the parts of a clip among the shards that draw it together. */
#ifndef KILN_JOB_SHARD_H
#define KILN_JOB_SHARD_H

#include "kiln.h"

/* Names one shard among `count`. */
struct kiln_shard {
    uint32_t index, count; /* index is below count */
};

/* Finds the parts of a shard, *first to *end - 1. The parts of a shard are consecutive, and the
 * numbers of parts of two shards differ by at most one. Where there are more shards than parts, the
 * last shards have none. */
static inline void kiln_shard_parts(struct kiln_shard shard, uint32_t parts, uint32_t *first,
                                    uint32_t *end)
{
    const uint64_t before = (uint64_t)parts * shard.index, last = shard.count - 1;
    *first = (uint32_t)((before + last) / shard.count);
    *end = (uint32_t)((before + parts + last) / shard.count);
}

/* Returns the frames of parts first to end - 1, of which there is at least one. */
static inline struct kiln_frame_range kiln_parts_frames(uint32_t first, uint32_t end,
                                                        uint32_t part_frames, uint32_t frames)
{
    const uint64_t behind = (uint64_t)end * part_frames;
    return (struct kiln_frame_range){first * part_frames,
                                     (uint32_t)(behind < frames ? behind : frames) - 1};
}

#endif
