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

/* Holds numbers of gas (volume_profile.h) of the pixels of lanes. */
struct gas_lanes {
    _Alignas(64) float numbers[VOLUME_NODE][LANES];
};

/* Holds the numbers of a place of a profile, of one pixel. */
typedef float node_numbers __attribute__((vector_size(4 * VOLUME_NODE)));

/* Reads the numbers of a place of a profile. */
SIMD void read_node(const uint16_t *from, node_numbers *to)
{
    typedef uint16_t halves __attribute__((vector_size(2 * VOLUME_NODE)));
    typedef uint32_t words __attribute__((vector_size(4 * VOLUME_NODE)));
    halves bits;
    memcpy(&bits, from, sizeof bits);
    *to = (node_numbers)(__builtin_convertvector(bits, words) << 16);
    (*to)[VOLUME_NODE_DEPTH] = (float)from[VOLUME_NODE_DEPTH] * VOLUME_DEPTH_UNIT;
}

/* Adds a part of the numbers of a pixel's gas before a depth. number: of the pixel's profile, in a
 * domain. */
SIMD void add_profile(const struct kiln_volume_domain *domain, uint32_t number, float depth,
                      float weight, node_numbers *sum)
{
    const size_t bytes = (size_t)(number / VOLUME_PACKET) * VOLUME_PROFILE_UNIT;
    const struct kiln_volume_profile *p =
        (const struct kiln_volume_profile *)(const void *)(domain->memory + bytes);
    const float *at = kiln_volume_places(p);
    const uint32_t pixel = number % VOLUME_PACKET, last = p->count - 1;
    const float place = depth * p->a_metre[pixel];
    uint32_t low = 0;
    for (uint32_t jump = 16; jump > 0; jump /= 2) /* VOLUME_NODES <= 32 */
        low += low + jump < last && at[low + jump] <= place ? jump : 0;
    const float part = profile_part(place, at[low], at[low + 1]);
    node_numbers from, next;
    read_node(kiln_volume_node(p, low) + (size_t)pixel * VOLUME_NODE, &from);
    read_node(kiln_volume_node(p, low + 1) + (size_t)pixel * VOLUME_NODE, &next);
    *sum += weight * (from + (next - from) * part);
}

/* Adds the gas of the neighbours of a pixel that has no ray. */
SIMD void add_neighbours(const struct kiln_volume_profiles *profiles,
                         const struct kiln_volume_domain *domain, uint32_t x, uint32_t y,
                         float depth, node_numbers *sum)
{
    const uint32_t across = x % 2, down = y % 2;
    const float weight = across && down ? 0.25f : 0.5f;
    for (uint32_t row = y - down; row <= y + down; row += 2)
        for (uint32_t column = x - across; column <= x + across; column += 2) {
            const uint32_t number = domain->profile_of[(size_t)row * profiles->width + column];
            if (number != VOLUME_NO_PROFILE)
                add_profile(domain, number, depth, weight, sum);
        }
}

/* Adds the gas of a domain before a pixel of its picture to an empty lane. */
SIMD void put_gas(const struct kiln_volume_profiles *profiles,
                  const struct kiln_volume_domain *domain, uint32_t x, uint32_t y, float depth,
                  int lane, struct gas_lanes *to)
{
    const uint32_t tile = y / VOLUME_TILE * profiles->across + x / VOLUME_TILE;
    if (domain->near_m[tile] >= depth)
        return;
    const uint32_t number = domain->profile_of[(size_t)y * profiles->width + x];
    node_numbers sum = {0};
    if (number == VOLUME_NO_PROFILE)
        return;
    if (number == VOLUME_BETWEEN)
        add_neighbours(profiles, domain, x, y, depth, &sum);
    else
        add_profile(domain, number, depth, 1.0f, &sum);
    for (int i = 0; i < VOLUME_NODE_FLAME + 3; i++)
        to->numbers[i][lane] = sum[i];
}

/* Adds the gas of a domain, which lies behind what is in `before`. */
SIMD void add_gas(const struct kiln_tile_gas *gas, const struct kiln_volume_domain *domain,
                  const struct gas_lanes *lanes, struct gas_before *before)
{
    vf here[VOLUME_NODE];
    for (int i = 0; i < VOLUME_NODE_FLAME + 3; i++)
        here[i] = vf_load(lanes->numbers[i]);
    for (int c = 0; c < 3; c++) {
        const vf smoke = before->clear * here[VOLUME_NODE_SMOKE + c];
        const vf flame = before->clear * here[VOLUME_NODE_FLAME + c];
        before->light[c] += gas->smoke * smoke + gas->flame * flame;
        before->glow[c] += domain->bloom * flame;
    }
    const vf clear = vf_exp(-here[VOLUME_NODE_DEPTH]);
    before->clear *= vf_where(clear >= VOLUME_OPAQUE_BELOW, clear);
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
            put_gas(profiles, &profiles->domains[i], profile_pixel(x, gas->width),
                    profile_pixel(y, gas->height), depths[lane], lane, &lanes);
        }
        add_gas(gas, &profiles->domains[i], &lanes, before);
    }
}

#endif
