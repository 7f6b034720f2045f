/* Blends scene, particles, fire and blurred bloom into one picture (Heinz 2019, figure 3.1, last
 * step), then applies exposure, tone map, sRGB and dither. */
#include "post/compose.glsl"
#include "shared/tonemap.h"

layout(binding = 3) uniform sampler2D bloom; /* smaller than the picture */

const float HALF_MAX = 65504.0;

uniform float bloom_strength;
uniform float bloom_scale; /* the bloom's size as a part of the picture's */
uniform float exposure; /* factor */
uniform int tonemap;    /* 0 none, 1 AgX, 2 ACES: enum kiln_tonemap */
uniform float levels;   /* largest value of an output channel, 255 or 65535 */
uniform bool dither;
uniform bool is_texture; /* struct kiln_composite_params */
uniform uint frame;

layout(location = 0) out vec4 out_display; /* not premultiplied */
layout(location = 1) out vec4 out_beauty;  /* scene-linear, premultiplied */

uint hash(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/* Returns the noise of the dither (shared/tonemap.h). It differs for each pixel, channel and frame,
 * and is the same in each run. */
ivec3 dither_noise()
{
    uvec2 p = uvec2(gl_FragCoord.xy);
    uint h = hash(p.x + hash(p.y + hash(frame)));
    int sums = int((h & TONEMAP_NOISE_FIELDS) + (h >> 5 & TONEMAP_NOISE_FIELDS));
    return (ivec3(dither ? sums : TONEMAP_NOISE_NONE) >> ivec3(0, 10, 20)) & 0x3ff;
}

/* Describes the cubic B-spline of four neighbours along one axis as two linear fetches: where to
 * fetch (texels from the second neighbour's centre) and with which weights (Sigg and Hadwiger,
 * "Fast Third-Order Texture Filtering", GPU Gems 2, 2005). */
struct spline {
    vec2 offsets, weights;
};

spline spline_at(float t)
{
    float s = 1.0 - t;
    vec4 w = vec4(s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t,
                  4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t) / 6.0;
    vec2 pairs = vec2(w.x + w.y, w.z + w.w);
    return spline(vec2(w.y, w.w) / pairs + vec2(-1.0, 1.0), pairs);
}

/* Returns the bloom, magnified by a cubic B-spline. Bilinear magnification would show a bloom of a
 * sixth of the size as diamonds. */
vec3 magnified_bloom()
{
    vec2 texel = gl_FragCoord.xy * bloom_scale - 0.5;
    vec2 base = floor(texel) + 0.5;
    spline x = spline_at(fract(texel.x));
    spline y = spline_at(fract(texel.y));
    vec2 size = vec2(textureSize(bloom, 0));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < 2; j++) {
        for (int i = 0; i < 2; i++) {
            vec2 at = (base + vec2(x.offsets[i], y.offsets[j])) / size;
            sum += x.weights[i] * y.weights[j] * textureLod(bloom, at, 0.0).rgb;
        }
    }
    return sum;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = composed(pixel);
    if (bloom_strength > 0.0)
        color.rgb += bloom_strength * magnified_bloom();
    out_beauty = color;

    /* Light is shown as white long before this limit. Beyond it, the squares in a tone map
     * overflow. */
    vec3 display = clamp(color.rgb * exposure, 0.0, HALF_MAX);
    if (tonemap == 1)
        display = tonemap_agx_root(display);
    else if (tonemap == 2)
        display = tonemap_aces(display);
    float alpha = color.a;
    if (is_texture) {
        tonemap_straight straight = tonemap_straight_of(display, alpha, tonemap == 1 ? 2.2 : 1.0);
        display = straight.color;
        alpha = straight.alpha;
    }
    display = min(display, vec3(1.0));
    if (tonemap == 1)
        display = vec3(tonemap_encode_root(display.x), tonemap_encode_root(display.y),
                       tonemap_encode_root(display.z));
    else
        display = vec3(tonemap_encode(display.x), tonemap_encode(display.y),
                       tonemap_encode(display.z));

    /* The colours of a file are not premultiplied. Light without alpha (fire over nothing) cannot
     * be stored so, so its brightness becomes its alpha, and it still shows over black. */
    if (!is_texture && alpha < 1.0) {
        alpha = clamp(max(alpha, max(max(display.r, display.g), display.b)), 0.0, 1.0);
        display = alpha > 0.0 ? min(display / alpha, vec3(1.0)) : vec3(0.0);
    }
    alpha = min(alpha, 1.0);
    ivec3 steps = ivec3(display * (levels * TONEMAP_STEPS) + TONEMAP_NOISE_BIAS) + dither_noise();
    out_display = vec4(vec3(steps >> 6) / levels, floor(alpha * levels + 0.5) / levels);
}
