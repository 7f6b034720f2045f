/* This file computes, for a block of particles, the part of lamps that each sees as a ball. */
#include <string.h>

#include "draw/light/lamp_shade_blocks.h"
#include "draw/light/ray_lamp.h"

static vf load(const float *from)
{
    vf x;
    memcpy(&x, from, sizeof x);
    return x;
}

void KILN_SIMD_NAME(kiln_lamp_shade_block)(const struct kiln_lamp_objects *objects,
                                           const struct kiln_draw_light *lights, uint32_t count,
                                           const struct kiln_appearance_block *block,
                                           uint32_t words[KILN_LANES])
{
    for (uint32_t first = 0; first < KILN_LANES; first += LANES) {
        vi alive, word = vi_all(0);
        memcpy(&alive, block->alive + first, sizeof alive);
        alive = -alive;
        const struct vf3 at = {load(block->position.x + first), load(block->position.y + first),
                               load(block->position.z + first)};
        const vf radius = load(block->radius + first);
        for (uint32_t i = 0; i < count; i++) {
            const struct kiln_draw_light *lamp = &lights[i];
            vf seen = vf_all(1.0f);
            if (lamp->casters.x | lamp->casters.y && any(alive)) {
                const struct vf3 towards = vf3_normalize(vf3_towards(lamp->position_radius2, at));
                seen = lamp_visibility(objects, lamp, lamp->casters.x, at, towards, NULL, radius,
                                       alive);
            }
            word |= vi_of(seen * (float)KILN_LAMP_SHADE_ONE + 0.5f) << (int32_t)(8 * i);
        }
        memcpy(words + first, &word, sizeof word);
    }
}
