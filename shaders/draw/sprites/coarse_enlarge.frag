/* Enlarges the coarse picture of particles to the frame's size. Where the scene's depth is smooth,
 * a pixel is interpolated by a spline from the sixteen coarse pixels around it. Near edges of the
 * depth it is a mean of the nine nearest coarse pixels. Their weight is the product of their
 * nearness in the picture and the similarity of their depth to that of the pixel. If has_fine is
 * set, a picture of the particles at full resolution is blended in near these edges. */
#include "draw/sprites/coarse.glsl"

layout(binding = 0) uniform sampler2D depth;        /* view-space depth, m */
layout(binding = 1) uniform sampler2D coarse_depth; /* written by coarse_depth.frag */
layout(binding = 2) uniform sampler2D edges;        /* written by coarse_edges.frag */
layout(binding = 3) uniform sampler2D coarse_color;
layout(binding = 4) uniform sampler2D coarse_bloom;
layout(binding = 5) uniform sampler2D fine_color;
layout(binding = 6) uniform sampler2D fine_bloom;

uniform bool has_fine;

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

/* Interpolates between the middle two of four pixels by a spline. The result is clamped between
 * these two in each component, since the spline may overshoot. */
vec4 interpolate(vec4 from[4], vec4 weights)
{
    vec4 sum = from[0] * weights.x + from[1] * weights.y + from[2] * weights.z + from[3] * weights.w;
    return clamp(sum, min(from[1], from[2]), max(from[1], from[2]));
}

/* Writes the interpolated colour and bloom at a place, in coarse pixels. */
void write_interpolated(vec2 place)
{
    ivec2 first = ivec2(floor(place)) - 1, last = textureSize(coarse_depth, 0) - 1;
    vec4 across = coarse_spline(place.x - floor(place.x));
    vec4 down = coarse_spline(place.y - floor(place.y));
    vec4 colors[4], blooms[4];
    for (int x = 0; x < 4; x++) {
        vec4 color[4], bloom[4];
        for (int y = 0; y < 4; y++) {
            ivec2 at = clamp(first + ivec2(x, y), ivec2(0), last);
            color[y] = texelFetch(coarse_color, at, 0);
            bloom[y] = texelFetch(coarse_bloom, at, 0);
        }
        colors[x] = interpolate(color, down);
        blooms[x] = interpolate(bloom, down);
    }
    out_color = interpolate(colors, across);
    out_bloom = interpolate(blooms, across);
}

/* Writes the mean colour and bloom of the coarse pixel `nearest` and the eight around it.
 * pixel_depth: the scene's depth at the frame's pixel, m. */
void write_mean(vec2 place, ivec2 nearest, float pixel_depth)
{
    ivec2 size = textureSize(coarse_depth, 0);
    float weight_sum = 0.0;
    out_color = out_bloom = vec4(0.0);
    for (int i = 0; i < 9; i++) {
        ivec2 at = nearest + ivec2(i % 3, i / 3) - 1;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size)))
            continue;
        vec2 away = place - vec2(at);
        float weight = coarse_near(away.x) * coarse_near(away.y) *
                       coarse_similarity(pixel_depth, texelFetch(coarse_depth, at, 0).r);
        out_color += texelFetch(coarse_color, at, 0) * weight;
        out_bloom += texelFetch(coarse_bloom, at, 0) * weight;
        weight_sum += weight;
    }
    out_color /= weight_sum;
    out_bloom /= weight_sum;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = coarse_place(gl_FragCoord.xy);
    ivec2 nearest = clamp(ivec2(floor(place + 0.5)), ivec2(0), textureSize(coarse_depth, 0) - 1);
    if (texelFetch(edges, nearest, 0).r > 0.0)
        write_mean(place, nearest, texelFetch(depth, pixel, 0).r);
    else
        write_interpolated(place);
    if (has_fine) {
        float fine = fine_weight(edges, place);
        out_color = mix(out_color, texelFetch(fine_color, pixel, 0), fine);
        out_bloom = mix(out_bloom, texelFetch(fine_bloom, pixel, 0), fine);
    }
}
