/* The parts of a clip. */
#include "kiln.h"

enum { SECONDS = 2, MOST = 600 };

uint32_t kiln_part_frames(uint32_t fps_num, uint32_t fps_den)
{
    const uint64_t frames = (uint64_t)fps_num * SECONDS / fps_den;
    return frames < 1 ? 1 : frames > MOST ? MOST : (uint32_t)frames;
}
