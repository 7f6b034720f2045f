/* Finds the meshes that the rays of backdrop.frag hit, and how much of the sun and of the sky
 * meshes leave visible from a point. Meshes are rasterised beforehand (meshes.frag): one layer has
 * the hits at the centres of pixels, and each sample has a layer, too. Shadows are read from maps
 * that show each mesh as the sun sees it (meshes_shadow.frag), and all meshes as each lamp sees
 * them (lib/draw/light/lamp_map.c). */
#include "draw/backdrop/mesh_hit.glsl"
#include "shared/lamp_map.h"
#include "shared/shadow_map.h"

layout(binding = KILN_UNIT_MESH_HITS) uniform usampler2DArray mesh_hits;
layout(binding = KILN_UNIT_MESH_SHADOW) uniform sampler2DArray mesh_shadow;
layout(binding = KILN_UNIT_LAMP_MAPS) uniform sampler2DArray lamp_maps;
#ifdef PAINT
layout(binding = KILN_UNIT_MESH_PAINT) uniform sampler2DArray mesh_paint;
#endif

#ifdef PAINT

/* Returns the mesh's own colour with its paint over it. */
vec3 add_paint(int i, uvec4 found, vec3 albedo)
{
    float own_paint = shapes.meshes[i].color.w;
    int layer = KILN_PAINT_LAYER(own_paint);
    if (layer < 0)
        return albedo;
    float finest = log2(float(textureSize(mesh_paint, 0).x));
    float level = max(uintBitsToFloat(found.w) + finest, float(KILN_PAINT_LEVEL(own_paint)));
    vec4 paint = textureLod(mesh_paint, vec3(unpackUnorm2x16(found.z), float(layer)), level);
    return albedo * (1.0 - paint.a) + paint.rgb;
}

#endif

void trace_meshes(int layer, inout hit nearest)
{
    uvec4 found = texelFetch(mesh_hits, ivec3(gl_FragCoord.xy, layer), 0);
    int i = mesh_hit_index(found.xy);
    float t = mesh_hit_depth(found.xy);
    if (i >= 0 && t < nearest.t) {
        vec3 albedo = shapes.meshes[i].color.rgb;
#ifdef PAINT
        albedo = add_paint(i, found, albedo);
#endif
        nearest = hit(t, int(shapes.counts.y) + 4 * i, mesh_hit_normal(found.xy), albedo);
    }
}

/* Returns whether the pixel is at an edge inside a mesh, where that hides itself or bends. */
bool has_mesh_edge(int surface)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 center = texelFetch(mesh_hits, ivec3(pixel, 0), 0).xy;
    float depth = mesh_hit_depth(center);
    vec3 normal = mesh_hit_normal(center);
    bool edge = false;
    /* Software runs both sides of an `if`, but saves the iterations of a shorter loop. */
    int samples = surface >= int(shapes.counts.y) ? KILN_EDGE_SAMPLES : 1;
    for (int s = 1; s <= samples; s++) {
        uvec2 other = texelFetch(mesh_hits, ivec3(pixel, s), 0).xy;
        edge = edge || mesh_hit_index(other) != mesh_hit_index(center) ||
               abs(mesh_hit_depth(other) - depth) > 0.01 * depth ||
               dot(mesh_hit_normal(other), normal) < 0.95;
    }
    return edge && surface >= int(shapes.counts.y);
}

/* Returns the part of the sun that a mesh covers. A texel of its map has the coverage and, weighted
 * by that, the depth of the mesh as the sun sees it. The first fetch looks for anything between
 * that the others could find; where there is nothing, or the surface is turned away, it is the only
 * one. A branch would not save the others on a processor, where both sides of it run; a loop does.
 * */
float mesh_sun_cover(int i, vec3 point, vec3 normal)
{
    vec4 sun = backdrop.sun_direction;
    float spread = shapes.sun_right.w;
    shadow_receiver at = shadow_receiver_of(shapes.meshes[i].center, point, normal, sun,
                                            shapes.sun_right, shapes.sun_up);
    int taps = dot(normal, sun.xyz) > 0.0 ? 5 : 1;
    float level = shadow_level(shadow_widest(at, spread)) + 1.0;
    float stride = 0.0, cover = 0.0;
    for (int k = 0; k < taps; k++) {
        vec2 aside = vec2(k & 1, k >> 1 & 1) * 2.0 * stride - stride;
        vec2 shadow = textureLod(mesh_shadow, vec3(vec2(at.u, at.v) + aside, i), level).rg;
        if (k == 0) {
            taps = shadow.r > 0.0 ? taps : 1;
            float width = shadow_width(at, spread, shadow.r, shadow.g);
            level = shadow_level(width);
            stride = 0.5 * width;
        } else {
            cover += shadow_tap(at, aside.x, aside.y, shadow.r, shadow.g,
                                1.0 / (at.slack + stride));
        }
    }
    return cover;
}

float mesh_sun_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.z); i++)
        visible *= 1.0 - mesh_sun_cover(i, point, normal);
    return visible;
}

/* Returns the part of lamp i that meshes cover, by fetches as in mesh_sun_cover. way: from the
 * point to the lamp. */
float mesh_lamp_cover(int i, vec3 normal, light_way way)
{
    float radius = backdrop.lights[i].color.w, far = backdrop.lights[i].maps.x;
    lamp_place place = lamp_place_of(-way.direction * way.reach, normal, far);
    int number = int(backdrop.lights[i].casters.y) & (1 << KILN_LAMP_SOLID_SHIFT) - 1;
    float layer = place.face + 6.0 * float(number - 1);
    int taps = number != 0 ? 5 : 0;
    float level = lamp_level(lamp_widest(place, radius, 0.0)) + 1.0;
    float stride = 0.0, cover = 0.0;
    for (int k = 0; k < taps; k++) {
        vec2 aside = vec2(k & 1, k >> 1 & 1) * 2.0 * stride - stride;
        vec2 shadow = textureLod(lamp_maps, vec3(vec2(place.at.u, place.at.v) + aside, layer),
                                 level).rg;
        if (k == 0) {
            taps = shadow.r > 0.0 ? taps : 1;
            float width = lamp_width(place, radius, 0.0, far, shadow.r, shadow.g);
            level = lamp_level(width);
            stride = 0.5 * width;
        } else {
            float wide = stride * 2.0 * KILN_LAMP_RANGE * place.at.depth;
            cover += shadow_tap(place.at, aside.x, aside.y, shadow.r, shadow.g,
                                1.0 / (place.at.slack + wide));
        }
    }
    return cover;
}

float mesh_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.z); i++)
        visible *= sky_beside_mesh(shapes.meshes[i].center.xyz - point,
                                   shapes.meshes[i].half_size, normal);
    return visible;
}
