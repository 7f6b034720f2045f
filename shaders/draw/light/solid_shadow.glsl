/* The sun's light that particles let through which are opaque spheres (lib/draw/light/solid_shadow.h). */
layout(binding = KILN_UNIT_SOLID_BINS) uniform usampler2D solid_bins;
layout(binding = KILN_UNIT_SOLID_LIST) uniform sampler2D solid_list;

#ifdef INSTANCES
layout(binding = KILN_UNIT_SOLID_TILES) uniform sampler2D solid_tiles;
layout(binding = KILN_UNIT_SILHOUETTES) uniform sampler2D silhouettes;

float silhouette_texel(ivec2 first, int edge, ivec2 at, int level, float weight)
{
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(edge)));
    return inside ? weight * texelFetch(silhouettes, first + at, level).x : 0.0;
}

/* Linear between four texels of a level; nothing is beside the tile. */
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

/* A mesh's, blurred as widely as the sun is, by levels whose texels are as large as its radius; one
 * that is blurred more than it is large is as round as a sphere. */
float silhouette_cover(vec4 sphere, vec4 tile, vec3 origin, vec4 sun, float spread)
{
    vec3 towards = sphere.xyz - origin;
    float t = dot(towards, sun.xyz);
    vec2 aside = vec2(dot(towards, shapes.sun_right.xyz), dot(towards, shapes.sun_up.xyz));
    vec2 at = 0.5 - aside * (0.5 / tile.z);
    float radius = max(t * spread, 1e-5);
    float level = log2(max(radius * tile.w * 0.5 / tile.z, 1.0));
    float most = floor(log2(tile.w) + 0.5);
    level = min(level, most);
    float fine = floor(level), coarse = min(fine + 1.0, most);
    float cover = mix(silhouette_level(tile, at, int(fine)), silhouette_level(tile, at, int(coarse)),
                      level - fine);
    float wide = clamp((radius / tile.z - KILN_INSTANCE_SHARP) /
                           (KILN_INSTANCE_ROUND - KILN_INSTANCE_SHARP), 0.0, 1.0);
    return mix(t > 0.0 ? cover : 0.0, speck_cover(towards, sphere.w, sun, spread, KILN_SOLID_FADE), wide);
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
        cover = silhouette_cover(sphere, tile, origin, sun, spread);
#endif
    return entry < end ? cover : 0.0;
}

/* Past KILN_SOLIDS_AT_A_TIME of a list: llvmpipe bounds how often loops run, not what they do. */
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
