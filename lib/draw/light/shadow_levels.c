/* This file makes the coarser levels of shadow maps, which are means of four texels. */
#include "draw/light/shadow_levels.h"

void kiln_shadow_shrink(uint32_t *texels, size_t edge, uint32_t level, size_t begin, size_t end)
{
    const size_t width = edge >> level, pitch = KILN_SHADOW_PITCH(edge);
    const uint32_t *from = texels + kiln_shadow_level_start(edge, level - 1);
    uint32_t *to = texels + kiln_shadow_level_start(edge, level);
    for (size_t y = begin; y < end; y++) {
        for (size_t x = 0; x < width; x++) {
            const uint32_t *four = from + 2 * y * pitch + 2 * x;
            const uint32_t parts[4] = {four[0], four[1], four[pitch], four[pitch + 1]};
            uint32_t cover = 2, distance = 2; /* so that the quotient is rounded */
            for (int i = 0; i < 4; i++) {
                cover += parts[i] & 0xffffu;
                distance += parts[i] >> 16;
            }
            to[y * pitch + x] = distance / 4 << 16 | cover / 4;
        }
    }
}
