/* Writes 1 for a coarse pixel if it or one of the eight around it has an edge of the depth, else
 * 0. */
layout(binding = 0) uniform sampler2D nonplanar; /* out_nonplanar of coarse_depth.frag */

layout(location = 0) out float out_edges;

void main()
{
    ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(nonplanar, 0) - 1;
    out_edges = 0.0;
    for (int y = -1; y <= 1; y++) {
        for (int x = -1; x <= 1; x++) {
            ivec2 at = clamp(here + ivec2(x, y), ivec2(0), last);
            out_edges = max(out_edges, texelFetch(nonplanar, at, 0).r);
        }
    }
}
