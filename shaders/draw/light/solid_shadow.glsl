/* Finds the part of the sun's light, 0 to 1, that opaque particles let through to a point. They are
 * spheres and, with INSTANCES, meshes; lib/draw/light/solid_shadow.h lists them in bins across the
 * sun's direction. */
layout(binding = KILN_UNIT_SOLID_BINS) uniform usampler2D solid_bins;
layout(binding = KILN_UNIT_SOLID_LIST) uniform sampler2D solid_list;

#ifdef INSTANCES
layout(binding = KILN_UNIT_SOLID_TILES) uniform sampler2D solid_tiles;
layout(binding = KILN_UNIT_SILHOUETTES) uniform sampler2D silhouettes;

#include "shared/shadow_map.h"

float silhouette_texel(ivec2 first, int edge, ivec2 at, int level, float weight)
{
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(edge)));
    return inside ? weight * texelFetch(silhouettes, first + at, level).x : 0.0;
}

/* Interpolates linearly between four texels of a level. Texels beside the tile count as 0. */
float silhouette_level(vec4 tile, vec2 at, int level)
{
    int edge = int(tile.w) >> level;
    ivec2 first = ivec2(tile.xy) >> level;
    vec2 texel = clamp(at * float(edge) - 0.5, vec2(-2.0), vec2(float(edge) + 1.0));
    vec2 low = floor(texel), part = texel - low;
    ivec2 i = ivec2(low);
    return silhouette_texel(first, edge, i, level, (1.0 - part.x) * (1.0 - part.y)) +
           silhouette_texel(first, edge, i + ivec2(1, 0), level, part.x * (1.0 - part.y)) +
           silhouette_texel(first, edge, i + ivec2(0, 1), level, (1.0 - part.x) * part.y) +
           silhouette_texel(first, edge, i + ivec2(1, 1), level, part.x * part.y);
}

/* The part of the sun that a mesh covers. ball: the part that its bounding sphere covers. */
float silhouette_cover(vec4 sphere, vec4 tile, vec3 origin, vec4 sun, float spread, float ball)
{
    silhouette_place at = silhouette_place_of(sphere.xyz - origin, tile.w, tile.z, sun,
                                              shapes.sun_right, shapes.sun_up, spread);
    float fine = floor(at.level), coarse = min(fine + 1.0, at.last);
    float cover = mix(silhouette_level(tile, vec2(at.u, at.v), int(fine)),
                      silhouette_level(tile, vec2(at.u, at.v), int(coarse)), at.level - fine);
    return silhouette_covers(at, cover, ball);
}
#endif

float listed_cover(int entry, int end, vec3 origin, vec4 sun, float spread)
{
    int i = min(entry, end - 1);
    ivec2 place = ivec2(i % KILN_SOLID_ROW, i / KILN_SOLID_ROW);
    vec4 sphere = texelFetch(solid_list, place, 0);
    float cover = speck_cover(sphere.xyz - origin, sphere.w, sun, spread, KILN_SOLID_FADE);
#ifdef INSTANCES
    vec4 tile = texelFetch(solid_tiles, place, 0);
    if (tile.w > 0.0)
        cover = silhouette_cover(sphere, tile, origin, sun, spread, cover);
#endif
    return entry < end ? cover : 0.0;
}

/* Returns the part of the sun behind KILN_SOLIDS_AT_A_TIME entries of a list. llvmpipe limits how
 * often a loop runs, but not the work of an iteration. */
float listed_sun_visibility(int entry, int end, vec3 origin)
{
    float visible = 1.0;
    vec4 sun = backdrop.sun_direction;
    float spread = shapes.sun_right.w;
    visible *= 1.0 - listed_cover(entry, end, origin, sun, spread);
    visible *= 1.0 - listed_cover(entry + 1, end, origin, sun, spread);
    visible *= 1.0 - listed_cover(entry + 2, end, origin, sun, spread);
    visible *= 1.0 - listed_cover(entry + 3, end, origin, sun, spread);
    return visible;
}

float solid_sun_visibility(vec3 origin)
{
    vec4 p = vec4(origin, 1.0);
    vec2 at = vec2(dot(shapes.world_to_bin[0], p), dot(shapes.world_to_bin[1], p));
    float edge = float(shapes.counts.w);
    uvec2 bin = texelFetch(solid_bins, ivec2(clamp(at, 0.0, max(edge - 1.0, 0.0))), 0).xy;
    bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(edge)));
    int count = inside ? int(bin.y) : 0;
    int first = int(bin.x), end = first + count;
    float visible = 1.0;
    for (int entry = first; entry < end; entry += KILN_SOLIDS_AT_A_TIME)
        visible *= listed_sun_visibility(entry, end, origin);
    return visible;
}
