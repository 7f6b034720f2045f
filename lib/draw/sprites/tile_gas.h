/* This header tells how gas dims the pixels of a sprite, and how it shines before them, by the
 * profiles of the gas (draw/volume/volume_profile.h). */
#ifndef KILN_DRAW_SPRITES_TILE_GAS_H
#define KILN_DRAW_SPRITES_TILE_GAS_H

#include "base/lane_math.h"
#include "draw/sprites/tile.h"

/* Holds what gas before pixels does to a sprite. */
struct gas_before {
    vf clear;             /* the part of the sprite's light that comes through */
    vf light[3], glow[3]; /* of the gas before it */
};

/* The numbers of two places of a profile, and where a pixel lies between them. */
struct gas_lanes {
    _Alignas(64) float part[LANES];
    _Alignas(64) float numbers[2][VOLUME_NODE][LANES];
};

/* Sets a lane to the places of a domain's gas before a pixel of its picture. */
SIMD void put_gas(const struct kiln_volume_domain *domain, uint32_t across, uint32_t x, uint32_t y,
                  float depth, int lane, struct gas_lanes *to)
{
    if (domain->near_m[(size_t)(y / VOLUME_TILE) * across + x / VOLUME_TILE] >= depth)
        return;
    struct kiln_volume_profile *p = domain->packets[(size_t)y * across + x / VOLUME_PACKET];
    if (!p)
        return;
    const float *at = kiln_volume_places(p);
    const uint32_t pixel = x % VOLUME_PACKET, last = p->count - 1;
    const float place = depth * p->a_metre[pixel];
    uint32_t low = 0;
    for (uint32_t jump = 16; jump > 0; jump /= 2) /* VOLUME_NODES <= 32 */
        low += low + jump < last && at[low + jump] <= place ? jump : 0;
    const float part = (place - at[low]) / (at[low + 1] - at[low]);
    to->part[lane] = part < 0.0f ? 0.0f : part < 1.0f ? part : 1.0f;
    for (uint32_t k = 0; k < 2; k++) {
        const uint16_t *node = kiln_volume_node(p, low + k) + (size_t)pixel * VOLUME_NODE;
        to->numbers[k][VOLUME_NODE_DEPTH][lane] =
            (float)node[VOLUME_NODE_DEPTH] * VOLUME_DEPTH_UNIT;
        for (int i = VOLUME_NODE_SMOKE; i < VOLUME_NODE_FLAME + 3; i++) {
            const uint32_t bits = (uint32_t)node[i] << 16;
            memcpy(&to->numbers[k][i][lane], &bits, sizeof bits);
        }
    }
}

/* Adds the gas of a domain, which lies behind what is in `before`. */
SIMD void add_gas(const struct kiln_tile_gas *gas, const struct kiln_volume_domain *domain,
                  const struct gas_lanes *lanes, struct gas_before *before)
{
    const vf part = vf_load(lanes->part);
    vf here[VOLUME_NODE];
    for (int i = 0; i < VOLUME_NODE_FLAME + 3; i++) {
        const vf low = vf_load(lanes->numbers[0][i]);
        here[i] = low + (vf_load(lanes->numbers[1][i]) - low) * part;
    }
    for (int c = 0; c < 3; c++) {
        const vf smoke = before->clear * here[VOLUME_NODE_SMOKE + c];
        const vf flame = before->clear * here[VOLUME_NODE_FLAME + c];
        before->light[c] += gas->smoke * smoke + gas->flame * flame;
        before->glow[c] += domain->bloom * flame;
    }
    const vf clear = vf_exp(-here[VOLUME_NODE_DEPTH]);
    before->clear *= vf_where(clear >= VOLUME_OPAQUE_BELOW, clear);
}

/* Returns the number of a pixel of the gas's picture, of `count`, at a place. */
SIMD uint32_t gas_pixel(float place, uint32_t count)
{
    const float last = (float)(count - 1);
    return exact_uint(place < 0.0f ? 0.0f : place < last ? place : last);
}

/* Finds what gas before pixels of a tile does. at: offsets of their units in kiln_tile.pixels;
 * depth: of the pixels, m. */
SIMD_ONCE void find_gas(const struct kiln_tile *tile, const int32_t *at, vf depth,
                        struct gas_before *before)
{
    enum { ROW = KILN_TILE_PLANES * KILN_TILE_PITCH };
    const struct kiln_tile_gas *gas = tile->gas;
    const struct kiln_volume_profiles *profiles = gas->profiles;
    struct gas_lanes lanes;
    float depths[LANES];
    vf_store(depths, depth);
    *before = (struct gas_before){.clear = vf_all(1.0f)};
    for (uint32_t i = 0; i < profiles->count; i++) {
        memset(&lanes, 0, sizeof lanes);
        for (int lane = 0; lane < LANES; lane++) {
            const int32_t offset = at[lane / (LANES / UNITS)];
            const int32_t row = offset / ROW, column = offset % ROW + lane % (LANES / UNITS);
            if (row >= tile->height || column >= tile->width)
                continue;
            const float x = ((float)(tile->x + column) + 0.5f) * gas->scale - gas->margin_x;
            const float y = ((float)(tile->y + row) + 0.5f) * gas->scale - gas->margin_y;
            put_gas(&profiles->domains[i], profiles->across, gas_pixel(x, gas->width),
                    gas_pixel(y, gas->height), depths[lane], lane, &lanes);
        }
        add_gas(gas, &profiles->domains[i], &lanes, before);
    }
}

#endif
