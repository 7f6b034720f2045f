/* Writes the depth against which particles are drawn at full resolution: that of the scene in the
 * neighbourhood of edges, and 0 elsewhere, so that no particle is before it. */
#include "draw/sprites/coarse.glsl"

layout(binding = 0) uniform sampler2D depth;
layout(binding = 1) uniform sampler2D edges; /* written by coarse_edges.frag */

layout(location = 0) out float out_depth;

void main()
{
    bool fine = fine_weight(edges, coarse_place(gl_FragCoord.xy)) > 0.0;
    out_depth = fine ? texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r : 0.0;
}
