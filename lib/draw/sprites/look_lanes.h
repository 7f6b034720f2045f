/* This header computes the values of looks that vary over other clocks than life, for a vector of
 * particles (draw/moment/look_values.h). sprite_lanes.h includes it. */
#ifndef KILN_DRAW_SPRITES_LOOK_LANES_H
#define KILN_DRAW_SPRITES_LOOK_LANES_H

#include "draw/moment/look_values.h"
#include "draw/vector/particle_math.h"

/* What the clocks show, of a vector of particles. */
struct clock_lanes {
    vf life, age_s, height, distance;
    struct vf3 velocity;
    vu stream;
    float time_s;
    vf parent_life, parent_age_s; /* as in struct value_clocks; 0 if the look inherits nothing */
    vu parent_stream;
};

/* Returns the clocks of one lane. */
SIMD struct value_clocks clocks_of_lane(const struct clock_lanes *c, int lane)
{
    struct value_clocks clocks = value_clocks_at(c->time_s, 0, 0);
    clocks.life = c->life[lane];
    clocks.age_s = c->age_s[lane];
    clocks.height = c->height[lane];
    clocks.distance = c->distance[lane];
    clocks.velocity = (float3){c->velocity.x[lane], c->velocity.y[lane], c->velocity.z[lane]};
    clocks.stream = c->stream[lane];
    clocks.parent_life = c->parent_life[lane];
    clocks.parent_age_s = c->parent_age_s[lane];
    clocks.parent_stream = c->parent_stream[lane];
    return clocks;
}

/* Returns a row of the table at the lanes' places, in samples. */
SIMD struct columns row_of_lanes(const float4 *table, uint32_t row, vf place)
{
    const vf last = vf_all((float)(KILN_LOOK_SAMPLES - 1));
    const vf held = vf_min(vf_max(place, vf_all(0.0f)), last);
    const vi number = vi_of(vf_min(held, last - 1.0f));
    const struct lane_offsets places = lane_offsets_of(number * 4);
    vf part[4];
    vf_spread_fours(held - vf_of(number), part);
    return columns_load_lerp(&table[(size_t)row * KILN_LOOK_SAMPLES].x, &places, part);
}

/* Returns a part of a value: random numbers and lives as vectors, all else lane by lane. */
SIMD struct columns part_of_lanes(const float4 *table, const struct kiln_look_part *part,
                                  const struct clock_lanes *c)
{
    const bool known = part->clock == KILN_CLOCK_RANDOM || part->clock == KILN_CLOCK_LIFE ||
                       part->clock == KILN_CLOCK_CONSTANT;
    if (known && (part->flags & ~LOOK_PART_PARENT) == 0) {
        const bool parent = part->flags != 0;
        vf x = vf_all(part->from);
        if (part->clock == KILN_CLOCK_RANDOM)
            x = vu_unit(parent ? c->parent_stream : c->stream, part->draw);
        else if (part->clock == KILN_CLOCK_LIFE)
            x = parent ? c->parent_life : c->life;
        return row_of_lanes(table, part->row, (x - part->from) * part->per_x);
    }
    struct columns y;
    for (int i = 0; i < LANES; i++) {
        const struct value_clocks clocks = clocks_of_lane(c, i);
        const float4 one = kiln_look_part_at(table, part, &clocks);
        y.c[0][i] = one.x;
        y.c[1][i] = one.y;
        y.c[2][i] = one.z;
        y.c[3][i] = one.x;
    }
    return y;
}

/* Multiplies a row of a look by its values, as kiln_look_multiply does. */
SIMD void multiply_lanes(const float4 *table, const struct kiln_look_program *program,
                         uint32_t target, const struct clock_lanes *c, struct columns *row)
{
    for (uint32_t i = 0; i < program->count; i++) {
        const struct kiln_look_value *value = &program->values[i];
        if (value->target != target)
            continue;
        struct columns y = part_of_lanes(table, &value->part[0], c);
        struct columns other = y;
        if (value->parts & 2u)
            other = part_of_lanes(table, &value->part[1], c);
        for (int k = 0; k < 3; k++)
            y.c[k] = value->parts & 2u ? y.c[k] * other.c[k] : y.c[k];
        if (value->parts & 4u)
            other = part_of_lanes(table, &value->part[2], c);
        for (int k = 0; k < 3; k++) {
            y.c[k] = value->parts & 4u ? y.c[k] + other.c[k] : y.c[k];
            y.c[k] = vf_min(vf_max(y.c[k], vf_all(value->low)), vf_all(value->high));
        }
        y.c[3] = y.c[0];
        if (value->light_row)
            y = row_of_lanes(table, value->light_row,
                             (y.c[0] - value->light_from) * value->light_per_x);
        for (int k = 0; k < 4; k++)
            row->c[k] = value->lanes & 1u << k ? row->c[k] * y.c[k] : row->c[k];
    }
}

#endif
