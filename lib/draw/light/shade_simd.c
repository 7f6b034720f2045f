/* This file computes, for a block of particles, the part of the sun and of lamps that each sees as
 * a ball. */
#include <string.h>

#include "draw/light/ray_lamp.h"
#include "draw/light/shade_blocks.h"

static vf load(const float *from)
{
    vf x;
    memcpy(&x, from, sizeof x);
    return x;
}

/* Describes LANES particles of a block. */
struct balls {
    struct vf3 at;
    vf radius;
    vi alive; /* mask */
};

static struct balls load_balls(const struct kiln_appearance_block *block, uint32_t first)
{
    struct balls balls = {.at = {load(block->position.x + first), load(block->position.y + first),
                                 load(block->position.z + first)},
                          .radius = load(block->radius + first)};
    memcpy(&balls.alive, block->alive + first, sizeof balls.alive);
    balls.alive = -balls.alive;
    return balls;
}

void KILN_SIMD_NAME(kiln_sun_shade_block)(const struct kiln_draw_shapes *shapes,
                                          const struct kiln_shape_set *casters,
                                          const struct kiln_shape_seen *from_sun,
                                          const struct kiln_sun_frame *sun,
                                          const struct kiln_appearance_block *block,
                                          float visible[KILN_LANES])
{
    const float4 towards = {sun->towards.x, sun->towards.y, sun->towards.z, 0.0f};
    for (uint32_t first = 0; first < KILN_LANES; first += LANES) {
        const struct balls balls = load_balls(block, first);
        struct light_receiver r = {.origin = balls.at,
                                   .way = sun_way_of(towards, sun->spread, balls.radius),
                                   .seen = from_sun,
                                   .active = balls.alive,
                                   .visible = vf_all(1.0f)};
        hide_by_shapes(shapes, casters, &r);
        memcpy(visible + first, &r.visible, sizeof r.visible);
    }
}

void KILN_SIMD_NAME(kiln_lamp_shade_block)(const struct kiln_lamp_objects *objects,
                                           const struct kiln_draw_light *lights,
                                           const struct kiln_shape_set *casters, uint32_t count,
                                           const struct kiln_appearance_block *block,
                                           uint32_t words[KILN_LANES])
{
    for (uint32_t first = 0; first < KILN_LANES; first += LANES) {
        const struct balls balls = load_balls(block, first);
        vi word = vi_all(0);
        for (uint32_t i = 0; i < count; i++) {
            const struct kiln_draw_light *lamp = &lights[i];
            vf seen = vf_all(1.0f);
            if (lamp->casters.x | lamp->casters.y && any(balls.alive)) {
                const struct vf3 towards =
                    vf3_normalize(vf3_towards(lamp->position_radius2, balls.at));
                seen = lamp_visibility(objects, lamp, &casters[i], balls.at, towards, NULL,
                                       balls.radius, balls.alive);
            }
            word |= vi_of(seen * (float)KILN_LAMP_SHADE_ONE + 0.5f) << (int32_t)(8 * i);
        }
        memcpy(words + first, &word, sizeof word);
    }
}
