/* Puts the opaque particles over the backdrop: a pixel's colour is the mean of its four samples, as
 * shared/edge_mean.h weighs them. A mean of depths would lie on no surface, so a pixel takes the
 * second nearest depth of its samples: that of a particle if at least two samples show one.
 * Particles that cover less than half of the pixels that they fill do not count for depth. */
#include "shared/draw_layout.h"
#include "shared/edge_mean.h"

layout(std140, binding = KILN_BIND_VIEW) uniform view_block { kiln_view view; };

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
    vec4 bloom = vec4(0.0), depth;
    edge_sum sum = edge_sum_none();
    for (int i = 0; i < 4; i++) {
        vec4 color = texelFetch(sphere_color, pixel, i);
        sum = edge_add(sum, color.rgb / max(color.a, 1e-6), 1.0, 0.25 * color.a, view.exposure.x);
        bloom += 0.25 * texelFetch(sphere_bloom, pixel, i);
        depth[i] = color.a >= 0.5 ? texelFetch(sphere_depth, pixel, i).r : 0.0;
    }
    vec2 nearer = max(depth.xz, depth.yw), farther = min(depth.xz, depth.yw);
    float second = max(min(nearer.x, nearer.y), max(farther.x, farther.y));
    float scene = texelFetch(scene_depth, pixel, 0).r;
    vec4 behind = texelFetch(scene_color, pixel, 0);
    bool covered = sum.alpha > 0.0;
    sum = edge_add(sum, behind.rgb, behind.a, 1.0 - sum.alpha, view.exposure.x);
    out_color = covered ? vec4(edge_mean(sum), sum.alpha) : behind;
    out_depth = second > 0.0 ? 1.0 / second - 1.0 : scene;
    out_bloom = bloom;
}
