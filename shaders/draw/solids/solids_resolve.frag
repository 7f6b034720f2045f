/* Puts the opaque particles over the backdrop: their colour is the mean of a pixel's four samples.
 * A mean of depths would lie on no surface, so a pixel takes the second nearest depth of its
 * samples: that of a particle if at least two samples show one. */
#include "shared/draw_layout.h"

layout(binding = 0) uniform sampler2DMS sphere_color;
layout(binding = 1) uniform sampler2DMS sphere_bloom;
layout(binding = 2) uniform sampler2DMS sphere_depth;
layout(binding = 3) uniform sampler2D scene_color;
layout(binding = 4) uniform sampler2D scene_depth;

layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out vec4 out_bloom;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = vec4(0.0), bloom = vec4(0.0), depth;
    for (int i = 0; i < 4; i++) {
        color += 0.25 * texelFetch(sphere_color, pixel, i);
        bloom += 0.25 * texelFetch(sphere_bloom, pixel, i);
        depth[i] = texelFetch(sphere_depth, pixel, i).r;
    }
    vec2 nearer = max(depth.xz, depth.yw), farther = min(depth.xz, depth.yw);
    float second = max(min(nearer.x, nearer.y), max(farther.x, farther.y));
    float scene = texelFetch(scene_depth, pixel, 0).r;
    out_color = color + texelFetch(scene_color, pixel, 0) * (1.0 - color.a);
    out_depth = second > 0.0 ? 1.0 / second - 1.0 : scene;
    out_bloom = bloom;
}
