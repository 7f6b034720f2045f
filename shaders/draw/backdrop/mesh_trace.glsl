/* Meshes as the rays of backdrop.frag find them: rasterised beforehand (meshes.frag), one layer for
 * the centres of pixels and one for each sample; their shadows from maps that the sun sees
 * (meshes_shadow.frag). */
#include "draw/backdrop/mesh_hit.glsl"

layout(binding = KILN_UNIT_MESH_HITS) uniform usampler2DArray mesh_hits;
layout(binding = KILN_UNIT_MESH_SHADOW) uniform sampler2DArray mesh_shadow;
#ifdef PAINT
layout(binding = KILN_UNIT_MESH_PAINT) uniform sampler2DArray mesh_paint;
#endif

#ifdef PAINT

/* What is painted, over the mesh's own colour. */
vec3 add_paint(int i, uvec4 found, vec3 albedo)
{
    int where = int(shapes.meshes[i].color.w);
    int layer = (where & 15) - 1;
    if (layer < 0)
        return albedo;
    float finest = log2(float(textureSize(mesh_paint, 0).x));
    float level = max(uintBitsToFloat(found.w) + finest, float(where >> 4));
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
        nearest = hit(t, KILN_SURFACE_MESHES + 4 * i, mesh_hit_normal(found.xy), albedo);
    }
}

/* A mesh has edges inside, where it hides itself or bends. The surface's number changes there, and
 * so that a whole tile of edges is seen, too, it changes from pixel to pixel. */
int mark_mesh_edge(int surface)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 center = texelFetch(mesh_hits, ivec3(pixel, 0), 0).xy;
    float depth = mesh_hit_depth(center);
    vec3 normal = mesh_hit_normal(center);
    bool edge = false;
    int samples = surface >= KILN_SURFACE_MESHES ? KILN_EDGE_SAMPLES : 1; /* a loop saves what `if` cannot */
    for (int s = 1; s <= samples; s++) {
        uvec2 other = texelFetch(mesh_hits, ivec3(pixel, s), 0).xy;
        edge = edge || mesh_hit_index(other) != mesh_hit_index(center) ||
               abs(mesh_hit_depth(other) - depth) > 0.01 * depth ||
               dot(mesh_hit_normal(other), normal) < 0.95;
    }
    return edge && surface >= KILN_SURFACE_MESHES ? surface + 1 + (pixel.x + pixel.y & 1) : surface;
}

/* The map has coverage and depth of a mesh as the sun sees it, averaged over texels of a level; the
 * second is 0 nearest to the sun and 1 farthest, and weighted by the first. How much of the sun the
 * mesh covers: the part of the texels around that lies before the receiver by more than `slack`. */
float mesh_sun_cover(int i, vec3 point, vec3 normal)
{
    vec3 from = point - shapes.meshes[i].center.xyz;
    float radius = shapes.meshes[i].center.w * (1.0 + KILN_SHADOW_MARGIN);
    vec3 sun = backdrop.sun_direction.xyz;
    vec2 uv = 0.5 + 0.5 * vec2(dot(from, shapes.sun_right.xyz), dot(from, shapes.sun_up.xyz)) / radius;
    float depth = 0.5 - 0.5 * dot(from, sun) / radius;

    /* The receiver's plane: what its depth is a step aside. */
    float facing = max(dot(normal, sun), 0.05);
    vec2 slope = vec2(dot(normal, shapes.sun_right.xyz), dot(normal, shapes.sun_up.xyz)) / facing;
    float texel = 1.0 / float(KILN_SHADOW_EDGE);
    float slack = 1.5 * texel * (1.0 + 0.5 * (abs(slope.x) + abs(slope.y)));
    /* The first fetch looks for anything between that the others could find, over more than they
     * reach; where there is nothing, or the surface is turned away, it is the only one. A branch
     * would not save them on a processor, where both sides of it run; a loop does. */
    int taps = dot(normal, sun) > 0.0 ? 5 : 1;
#ifdef SOFT_SUN
    float spread = shapes.sun_right.w;
    float level = log2(max(spread * max(depth, 0.0) / texel, 1.0)) + 1.0;
#else
    float level = 1.0;
#endif
    float stride = 0.0, cover = 0.0;
    for (int k = 0; k < taps; k++) {
        /* Four bilinear fetches half a step aside make a tent, as nine would. */
        vec2 aside = vec2(k & 1, k >> 1 & 1) * 2.0 * stride - stride;
        vec2 seen = textureLod(mesh_shadow, vec3(uv + aside, i), level).rg;
        float middle = seen.g / max(seen.r, 1e-4);
        if (k == 0) {
            taps = seen.r > 0.0 ? taps : 1;
            /* How far the sun's disc spreads at the distance of what is between. */
#ifdef SOFT_SUN
            float gap = depth - min(middle, depth);
            float width = max(0.75 * spread * gap, texel);
#else
            float width = texel;
#endif
            level = log2(width / texel);
            stride = 0.5 * width;
        } else {
            float before = depth + dot(slope, aside) - middle;
            cover += 0.25 * seen.r * clamp(before / (slack + stride) - 0.5, 0.0, 1.0);
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

float mesh_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.z); i++)
        visible *= sky_beside_mesh(shapes.meshes[i].center.xyz - point,
                                   shapes.meshes[i].half_size, normal);
    return visible;
}
