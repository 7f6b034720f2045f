/* Meshes as the rays of backdrop.frag find them: rasterised beforehand (mesh.frag), one layer for
 * the centres of pixels and one for each sample; their shadows from maps that the sun sees
 * (mesh_shadow.frag). */
#include "draw/mesh_hit.glsl"

layout(binding = KILN_UNIT_MESH_HITS) uniform usampler2DArray mesh_hits;
layout(binding = KILN_UNIT_MESH_SHADOW) uniform sampler2DArray mesh_shadow;

void trace_meshes(int layer, inout hit nearest)
{
    uvec2 found = texelFetch(mesh_hits, ivec3(gl_FragCoord.xy, layer), 0).xy;
    int i = mesh_hit_index(found);
    float t = mesh_hit_depth(found);
    if (i >= 0 && t < nearest.t)
        nearest = hit(t, SURFACE_MESHES + 4 * i, mesh_hit_normal(found), shapes.meshes[i].color.rgb);
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
    for (int s = 1; s <= KILN_EDGE_SAMPLES; s++) {
        uvec2 other = texelFetch(mesh_hits, ivec3(pixel, s), 0).xy;
        edge = edge || mesh_hit_index(other) != mesh_hit_index(center) ||
               abs(mesh_hit_depth(other) - depth) > 0.01 * depth ||
               dot(mesh_hit_normal(other), normal) < 0.95;
    }
    return edge ? surface + 1 + (pixel.x + pixel.y & 1) : surface;
}

/* Coverage and depth of a mesh as the sun sees it, averaged over texels of a level; the second is
 * 0 nearest to the sun and 1 farthest, and weighted by the first. Depth of the receiver in the same
 * measure: how much of the texels lies before it, by how many `slack`. */
float cover_before(vec3 at, float level, float depth, float slack)
{
    vec2 seen = textureLod(mesh_shadow, at, level).rg;
    float before = depth - seen.g / max(seen.r, 1e-4);
    return seen.r * clamp(before / slack - 0.5, 0.0, 1.0);
}

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
#ifdef SOFT_SUN
    /* How far the sun's disc spreads at the distance of what is between: its mean depth first, over
     * all that could be. */
    float spread = shapes.sun_right.w;
    float widest = spread * max(depth, 0.0) / texel;
    vec2 around = textureLod(mesh_shadow, vec3(uv, i), log2(max(widest, 1.0))).rg;
    float gap = depth - min(around.g / max(around.r, 1e-4), depth);
    float stride = max(0.7 * spread * gap, 0.5 * texel);
    float level = log2(max(stride / texel, 1.0));
#else
    float stride = 0.5 * texel, level = 0.0;
#endif
    float cover = 0.0;
    for (int k = 0; k < 9; k++) {
        vec2 at = vec2(k % 3 - 1, k / 3 - 1);
        vec2 aside = at * stride;
        float weight = (2.0 - abs(at.x)) * (2.0 - abs(at.y)) / 16.0;
        cover += weight * cover_before(vec3(uv + aside, i), level, depth + dot(slope, aside),
                                       slack + 0.5 * stride);
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

/* As the boxes do, by the ellipsoid in its bounds; inside of a hollow the middle is in front, and it
 * gets darker. */
float mesh_sky_visibility(vec3 point, vec3 normal)
{
    float visible = 1.0;
    for (int i = 0; i < int(shapes.counts.z); i++) {
        vec3 towards = shapes.meshes[i].center.xyz - point;
        float away = length(towards / max(shapes.meshes[i].half_size.xyz, vec3(1e-4)));
        float facing =
            clamp(dot(towards, normal) * inversesqrt(max(dot(towards, towards), 1e-9)) + 0.4, 0.0, 1.0);
        float fall = 1.0 / (1.0 + 2.0 * max(away - 1.0, 0.0));
        visible *= 1.0 - 0.7 * facing * fall * fall;
    }
    return visible;
}
