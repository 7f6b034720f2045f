/* Marches rays through a domain of gas, one ray an invocation, for technique march=gl. A work group
 * has a tile of the picture that blocks of gas touch; eight invocations in a row are a packet, as
 * on the host, where lib/draw/volume/volume_march_simd.c does the same. A ray is sampled at the same
 * steps as there, so both pictures agree to rounding, and by what the host leaves out.
 *
 * lib/draw/volume/volume_gl.c runs it for each domain, from the farthest on. It defines PROFILES if
 * profiles of the rays are wanted. Software GL limits the iterations of loops to 65535
 * (KILN_SOFTWARE_ITERATIONS): a ray has at most 3600 steps (KILN_MAX_GAS_EDGE), with at most as many
 * records, and the loops of profiles run less than 1000 times. */
// variant:
// variant: PROFILES=1
#include "shared/draw_layout.h"
#include "shared/march_layout.h"

layout(local_size_x = 64) in;

layout(std140, binding = MARCH_BIND_UNIFORMS) uniform march_block { kiln_march march; };
layout(std140, binding = KILN_BIND_BACKDROP) uniform backdrop_block { kiln_draw_backdrop backdrop; };

layout(std430, binding = MARCH_BIND_BLOCKS) readonly buffer blocks_block { vec4 blocks[]; };
layout(std430, binding = MARCH_BIND_FINER) readonly buffer finer_block { vec4 finer[]; };
layout(std430, binding = MARCH_BIND_TINTS) readonly buffer tints_block { vec4 tints[]; };
layout(std430, binding = MARCH_BIND_PLACES) readonly buffer places_block { uint places[]; };
layout(std430, binding = MARCH_BIND_PLANES) buffer planes_block { vec4 planes[]; };
layout(std430, binding = MARCH_BIND_HALFWAY) buffer halfway_block { float halfway[]; };
layout(std430, binding = MARCH_BIND_TOTALS) buffer totals_block { march_totals totals; };
#ifdef PROFILES
layout(std430, binding = MARCH_BIND_PROFILES) writeonly buffer profiles_block { uint profiles[]; };
#endif

layout(binding = MARCH_UNIT_DEPTH) uniform sampler2D scene_depth;

layout(location = MARCH_AT_TILES) uniform uvec2 tile_range; /* first and end */

#include "draw/light/haze.glsl"
#include "draw/volume/volume_noise.glsl"
#include "draw/volume/volume_ray.glsl"
#include "draw/volume/volume_sample.glsl"
#ifdef PROFILES
#include "draw/volume/volume_record.glsl"
#endif

shared uint group_rays, group_samples;

/* Marches a ray between two depths, m. Returns the number of its samples. */
uint march_ray(inout ray r, float near_m, float far_m)
{
    float number = floor(max(r.from, r.metre * near_m) / march.up.w);
    uint samples = 0u;
#ifdef PROFILES
    uint drawn = 0u;
#endif
    while (number * march.up.w < min(r.to, r.metre * far_m)) {
        step_place s = find_place(r, number);
        if (!s.some) {
            number = max(floor(s.leaves / march.up.w - 0.5), number + 1.0);
            continue;
        }
        gas_cell g = sample_gas(s);
        samples++;
        if (g.smoke > 0.0 || g.flame > 0.0) {
#ifdef PROFILES
            record_until(r, uint(number));
            drawn = uint(number) + 1u;
#endif
            if (march.detail.z > 0.0)
                add_detail(r, s, g);
            add_step(r, s, g);
        }
        number += 1.0;
    }
#ifdef PROFILES
    if (drawn > 0u)
        record_end(r, drawn);
#endif
    return samples;
}

/* Holds the haze before the gas of a ray. */
struct veil {
    float clear; /* the part of the gas's light that comes through */
    vec3 color;
};

/* Returns the haze before the gas of a ray. All of it counts as far away as it is in the mean of
 * what is seen. */
veil find_veil(ray r)
{
    if ((march.cells.w & MARCH_HAZE) == 0u)
        return veil(1.0, vec3(0.0));
    float distance = r.far / max(r.weight, 1e-20) * march.right.w;
    vec3 way = vec3(dot(march.world[0].xyz, r.way), dot(march.world[1].xyz, r.way),
                    dot(march.world[2].xyz, r.way));
    return veil(haze_clear(backdrop.floor_params.z, 1.0, distance), haze_toward(haze_level(way)));
}

/* Veils light of gas that lets the part `through` of what is behind it through. */
void put_veil(veil v, float through, inout vec3 smoke, inout vec3 flame)
{
    smoke = smoke * v.clear + v.color * ((1.0 - through) * (1.0 - v.clear));
    flame *= v.clear;
}

/* Draws what a ray has seen over its pixel. */
void put_ray(ray r, veil v, uint pixel)
{
    uint plane = march.bricks.w * march.picture.x;
    put_veil(v, r.clear, r.smoke, r.flame);
    planes[pixel] = vec4(r.smoke, 1.0 - r.clear) + r.clear * planes[pixel];
    planes[plane + pixel] = vec4(r.flame, 0.0) + r.clear * planes[plane + pixel];
    if ((march.cells.w & MARCH_GLOW) != 0u)
        planes[2u * plane + pixel] =
            vec4(march.sun.w * r.flame, 0.0) + r.clear * planes[2u * plane + pixel];
}

#ifdef PROFILES

/* Writes the profile of a packet. */
void write_profile(uint packet, ray r, veil v, bool inside, uint pixel)
{
    packet_places p = join_records(packet);
    uvec2 chosen = choose_places(packet, p);
    uint lane = gl_LocalInvocationIndex % uint(VOLUME_PACKET);
    uint count = count_of(chosen);
    uint head = uint(VOLUME_PROFILE_WORDS), nodes = head + (count + 15u) / 16u * 16u;
    if (lane == 0u)
        packet_at[packet] =
            p.count > 0u ? atomicAdd(totals.used, nodes + count * 4u * uint(VOLUME_PACKET)) : 0u;
    barrier();
    if (p.count == 0u)
        return;
    uint at = packet_at[packet], base = march.picture.z + at, next = 0u;
    profiles[base + lane] = floatBitsToUint(r.metre / march.up.w);
    if (lane == 0u)
        profiles[base + uint(VOLUME_PACKET)] = count;
    if (inside && record_count > 0u)
        profiles[pixel] = at / head * uint(VOLUME_PACKET) + lane;
    for (uint i = 0u; i < p.count; i++) {
        if (!is_chosen(chosen, i))
            continue;
        float depth;
        vec3 smoke, flame;
        unpack_node(record_at(p, i), depth, smoke, flame);
        put_veil(v, exp(-depth), smoke, flame);
        uvec4 node = pack_node(depth, smoke, flame);
        uint to = base + nodes + (next * uint(VOLUME_PACKET) + lane) * 4u;
        profiles[to] = node.x;
        profiles[to + 1u] = node.y;
        profiles[to + 2u] = node.z;
        profiles[to + 3u] = node.w;
        if (lane == 0u)
            profiles[base + head + next] = floatBitsToUint(float(p.first + i * p.stride));
        next++;
    }
}

#endif

/* Adds what the work group has done to the totals. */
void count_work(uint samples)
{
    if (samples > 0u) {
        atomicAdd(group_rays, 1u);
        atomicAdd(group_samples, samples);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && group_rays > 0u) {
        atomicAdd(totals.rays, group_rays);
        atomicAdd(totals.samples, group_samples);
    }
}

void main()
{
    uint number = tile_range.x + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (number >= tile_range.y)
        return;
    uint tile = march.picture.y + number * 4u;
    uint i = gl_LocalInvocationIndex, packet = i / uint(VOLUME_PACKET);
    uvec2 at = uvec2(places[tile], places[tile + 1u]) +
               uvec2(packet % 2u * 4u + i % 4u, packet / 2u * 2u + i / 4u % 2u);
    uvec2 size = uvec2(march.bricks.w, march.picture.x);
    bool inside = all(lessThan(at, size));
    uint pixel = at.y * size.x + at.x;
    if (i == 0u)
        group_rays = group_samples = 0u;
    barrier();
    ray r = make_ray(vec2(at), inside ? texelFetch(scene_depth, ivec2(at), 0).r : 0.0);
    bool finds_half = inside && (march.cells.w & MARCH_HALFWAY) != 0u;
    uint passed = size.x * size.y + pixel;
    if (finds_half)
        r.half_depth = VOLUME_HALF_OPAQUE - halfway[passed];
    uint samples = march_ray(r, uintBitsToFloat(places[tile + 2u]), uintBitsToFloat(places[tile + 3u]));
    if (finds_half && samples > 0u) {
        if (r.half_place > 0.0)
            halfway[pixel] = r.half_place / r.metre;
        halfway[passed] += r.depth;
    }
    if ((march.cells.w & MARCH_LIGHT) != 0u) {
        veil v = find_veil(r);
        if (inside && samples > 0u)
            put_ray(r, v, pixel);
#ifdef PROFILES
        write_profile(packet, r, v, inside, pixel);
#endif
    }
    count_work(samples);
}
