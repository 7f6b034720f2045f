/* Blends fragments of particles with the gas before them, by the profiles of the gas
 * (lib/draw/volume/volume_profile.h): the gas dims a fragment, which does not hide the light of
 * that gas. lib/draw/sprites/tile_gas.h does the same on the host; lib/draw/sprites/gas_before.c
 * sends the profiles.
 *
 * The fragment shaders of particles and particles_tiled.comp include this file. The host defines
 * GAS for a scene with gas that is drawn, and GAS_BETWEEN if some pixels of the gas may have no ray
 * (look.resolution: half); other scenes get a shader without this code. No loop but that over
 * domains is in this file, since software GL limits loops (round_iterations of
 * lib/draw/sprites/particles_tiled.c counts it). */
#ifdef GAS
#include "shared/gas_profile.h"

layout(std140, binding = KILN_BIND_GAS) uniform gas_uniforms { kiln_gas_before_block gas; };
layout(binding = KILN_UNIT_PROFILES) uniform usamplerBuffer profiles;

/* Holds what the gas before a fragment does to it. */
struct gas_before {
    float clear; /* the part of the light that comes through */
    vec3 light;  /* of the gas itself */
    vec3 glow;
};

/* Holds the numbers of a profile at a place. */
struct gas_node {
    float depth;
    vec3 smoke, flame;
};

/* Returns word i of those from a texel on. */
uint profile_word(uint texel, uint i)
{
    return texelFetch(profiles, int(texel + i / 4u))[i % 4u];
}

float profile_float(uint texel, uint i)
{
    return uintBitsToFloat(profile_word(texel, i));
}

/* Reads the numbers of a place. Light is the upper half of a float. */
gas_node read_node(uint texel)
{
    uvec4 words = texelFetch(profiles, int(texel));
    uvec4 low = words << 16, high = words & 0xffff0000u;
    return gas_node(float(words.x & 0xffffu) * VOLUME_DEPTH_UNIT,
                    uintBitsToFloat(uvec3(high.x, low.y, high.y)),
                    uintBitsToFloat(uvec3(low.z, high.z, low.w)));
}

/* Moves the place `low` on by `jump` if the place there is not beyond `place`. */
#define PROFILE_JUMP(jump)                                                                         \
    low += low + jump < last && profile_float(places, low + jump) <= place ? jump : 0u;

/* Adds a part of the numbers of a pixel's gas before a depth. number: of the pixel's profile in the
 * memory that begins at a texel. */
void add_profile(uint memory, uint number, float depth, float weight, inout gas_node sum)
{
    uint head = memory + number / uint(VOLUME_PACKET) * 4u, pixel = number % uint(VOLUME_PACKET);
    uint count = texelFetch(profiles, int(head) + 2).x, last = count - 1u, low = 0u;
    uint places = head + 4u, nodes = places + (count + 15u) / 16u * 4u + pixel;
    float place = depth * profile_float(head, pixel);
    PROFILE_JUMP(16u) /* VOLUME_NODES <= 32 */
    PROFILE_JUMP(8u)
    PROFILE_JUMP(4u)
    PROFILE_JUMP(2u)
    PROFILE_JUMP(1u)
    float part = profile_part(place, profile_float(places, low), profile_float(places, low + 1u));
    gas_node from = read_node(nodes + low * uint(VOLUME_PACKET));
    gas_node next = read_node(nodes + (low + 1u) * uint(VOLUME_PACKET));
    sum.depth += weight * mix(from.depth, next.depth, part);
    sum.smoke += weight * mix(from.smoke, next.smoke, part);
    sum.flame += weight * mix(from.flame, next.flame, part);
}

uint profile_of(uint texel, uvec2 pixel)
{
    return profile_word(texel, pixel.y * gas.picture.x + pixel.x);
}

#ifdef GAS_BETWEEN

void add_neighbour(uvec4 domain, uvec2 pixel, float depth, float weight, inout gas_node sum)
{
    uint number = profile_of(domain.y, pixel);
    if (number != uint(VOLUME_NO_PROFILE))
        add_profile(domain.z, number, depth, weight, sum);
}

/* Adds the gas of the neighbours of a pixel that has no ray: both of its column or its row, or all
 * four of its corners. */
void add_neighbours(uvec4 domain, uvec2 pixel, float depth, inout gas_node sum)
{
    uvec2 odd = pixel % 2u;
    bool corner = all(equal(odd, uvec2(1u)));
    float weight = corner ? 0.25 : 0.5;
    add_neighbour(domain, pixel - odd, depth, weight, sum);
    add_neighbour(domain, pixel + odd, depth, weight, sum);
    if (corner) {
        add_neighbour(domain, uvec2(pixel.x - 1u, pixel.y + 1u), depth, weight, sum);
        add_neighbour(domain, uvec2(pixel.x + 1u, pixel.y - 1u), depth, weight, sum);
    }
}

#endif

/* Adds the gas of domain i, which lies behind what is in `before`. */
void add_domain(uint i, uvec2 pixel, float depth, inout gas_before before)
{
    uvec4 domain = gas.domains[i];
    uvec2 tile = pixel / uint(VOLUME_TILE);
    if (profile_float(domain.x, tile.y * gas.picture.z + tile.x) >= depth)
        return;
    uint number = profile_of(domain.y, pixel);
    if (number == uint(VOLUME_NO_PROFILE))
        return;
    gas_node here = gas_node(0.0, vec3(0.0), vec3(0.0));
#ifdef GAS_BETWEEN
    if (number == uint(VOLUME_BETWEEN))
        add_neighbours(domain, pixel, depth, here);
    else
#endif
        add_profile(domain.z, number, depth, 1.0, here);
    vec3 flame = before.clear * here.flame;
    before.light += gas.covered.x * before.clear * here.smoke + gas.covered.y * flame;
    before.glow += gas.blooms[i] * flame;
    float clear = exp(-here.depth);
    before.clear *= clear < VOLUME_OPAQUE_BELOW ? 0.0 : clear;
}

/* Finds the gas before a depth, m. place: of the fragment in its picture, px. */
gas_before find_gas(vec2 place, float depth)
{
    vec2 at = place * gas.place.x - gas.place.yz;
    uvec2 pixel = uvec2(profile_pixel(at.x, gas.picture.x), profile_pixel(at.y, gas.picture.y));
    gas_before before = gas_before(1.0, vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < gas.picture.w; i++)
        add_domain(i, pixel, depth, before);
    return before;
}

/* Blends the colour of a fragment, and its glow, with the gas before it. */
void blend_with_gas(vec2 place, float depth, inout vec4 color, inout vec4 glow)
{
    gas_before before = find_gas(place, depth);
    color.rgb = before.clear * color.rgb + color.a * before.light;
    glow.rgb = before.clear * glow.rgb + color.a * gas.covered.z * before.glow;
}

#endif
