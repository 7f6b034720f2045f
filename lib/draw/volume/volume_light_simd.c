/* This file computes rows of the slices of volume_light.c: how much smoke there is on the way to a
 * light. The depth in the slice before is interpolated between four cells. */
#include "base/eight.h"
#include "base/real.h"
#include "draw/volume/volume_lamps.h"
#include "shared/lamp.h"

/* Loads a row of cells of a brick. */
SIMD struct eight load_smoke(const float *from, ptrdiff_t stride)
{
    float smoke[8];
    for (int i = 0; i < 8; i++)
        smoke[i] = from[i * stride + GAS_SMOKE];
    return eight_load(smoke);
}

SIMD void store_lanes(float *to, ptrdiff_t stride, struct eight x)
{
    float lanes[8];
    eight_store(lanes, x);
    for (int i = 0; i < 8; i++)
        to[i * stride] = lanes[i];
}

SIMD vf between(vf a, vf b, float part)
{
    return a + (b - a) * part;
}

/* Writes the parts of the sun that are scattered. */
SIMD void write_sun(float *to, ptrdiff_t stride, struct eight depth)
{
    struct eight once, more;
    EIGHT_EACH(k)
    {
        const vf t = depth.part[k];
        once.part[k] = VOLUME_ONCE * vf_exp(-t);
        more.part[k] = VOLUME_TWICE * vf_exp(-VOLUME_TWICE_DIMS * t) +
                       VOLUME_THRICE * vf_exp(-VOLUME_THRICE_DIMS * t);
    }
    store_lanes(to + VOLUME_SUN, stride, once);
    store_lanes(to + VOLUME_SCATTERED, stride, more);
}

static void sweep(const struct kiln_volume_sweep *s, int32_t slice, int32_t row)
{
    const struct kiln_volume_field *field = s->field;
    const ptrdiff_t first_brick = slice / GAS_BRICK * s->brick[2] + row / GAS_BRICK * s->brick[1];
    const ptrdiff_t in = slice % GAS_BRICK * s->cell[2] + row % GAS_BRICK * s->cell[1];
    const ptrdiff_t drawn = slice % GAS_BRICK * s->drawn[2] + row % GAS_BRICK * s->drawn[1];
    for (int32_t x = 0; x < s->count[0]; x += 8) {
        const ptrdiff_t number = first_brick + x / GAS_BRICK * s->brick[0];
        const float *cells = field->gas->brick[number].now;
        const int32_t block = field->block_of[number];
        float *to = block >= 0 ? kiln_volume_block(field, (uint32_t)block) + drawn : NULL;
        struct eight smoke = {{{0}}}, sky = {{{0}}};
        if (cells)
            smoke = load_smoke(cells + in, s->cell[0]);
        for (uint32_t w = 0; w < s->way_count; w++) {
            const struct kiln_volume_way *way = &s->ways[w];
            const float *a = way->before + (row + way->rows) * s->pitch + x + way->lanes;
            const float *b = a + s->pitch;
            float *here = way->here + row * s->pitch + x;
            struct eight depth;
            EIGHT_EACH(k)
            {
                const ptrdiff_t at = (ptrdiff_t)k * LANES;
                const vf low = between(vf_load(a + at), vf_load(a + at + 1), way->lane_part);
                const vf high = between(vf_load(b + at), vf_load(b + at + 1), way->lane_part);
                const vf own = smoke.part[k] * way->half;
                depth.part[k] = between(low, high, way->row_part) + own;
                vf_store(here + at, depth.part[k] + own);
            }
            if (to && s->sun)
                write_sun(to, s->drawn[0], depth);
            EIGHT_EACH(k)
            if (to && !s->sun)
                sky.part[k] += (1.0f / VOLUME_SKY_WAYS) * vf_exp(-VOLUME_SKY_DIMS * depth.part[k]);
        }
        if (to && !s->sun)
            store_lanes(to + VOLUME_RED, s->drawn[0], sky);
    }
}

/* ---- lamps ----------------------------------------------------------------------------------- */

static void add_lamp(const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                     const struct kiln_draw_light *lamp, const float *parts, float *block)
{
    const int32_t first[3] = {brick.x * GAS_BRICK, brick.y * GAS_BRICK, brick.z * GAS_BRICK};
    float reach[GAS_BRICK];
    for (int i = 0; i < GAS_BRICK; i++)
        reach[i] = VOLUME_ONCE + VOLUME_TWICE + VOLUME_THRICE;
    for (int32_t i = 0; i < GAS_BRICK * GAS_BRICK; i++) {
        const int32_t y = i % GAS_BRICK, z = i / GAS_BRICK;
        float *row = kiln_volume_cell(block, 0, y, z) + VOLUME_RED;
        if (parts)
            kiln_volume_spread(parts, y, z, reach);
        struct eight part = eight_load(reach);
        EIGHT_EACH(k)
        {
            const vf x = vf_count() + ((float)(first[0] + k * LANES) + 0.5f);
            struct vf3 at;
            vf *const place[3] = {&at.x, &at.y, &at.z};
            for (int c = 0; c < 3; c++)
                *place[c] = frame->corner[c] + frame->edges[1][c] * ((float)(first[1] + y) + 0.5f) +
                            frame->edges[2][c] * ((float)(first[2] + z) + 0.5f) +
                            frame->edges[0][c] * x;
            const struct vf3 towards = vf3_towards(lamp->position_radius2, at);
            const vf square = vf3_dot(towards, towards);
            part.part[k] *=
                lamp_share(*lamp, towards) / (square + (lamp->position_radius2.w + 1e-12f));
        }
        float lit[8];
        eight_store(lit, part);
        for (ptrdiff_t x = 0; x < 8; x++) {
            row[x * VOLUME_CELL] += lamp->color.x * lit[x];
            row[x * VOLUME_CELL + 1] += lamp->color.y * lit[x];
            row[x * VOLUME_CELL + 2] += lamp->color.z * lit[x];
        }
    }
}

const struct kiln_volume_light_rows KILN_SIMD_NAME(kiln_volume_light_rows) = {.sweep = sweep,
                                                                              .add_lamp = add_lamp};
