/* Blurs in one direction of a separable Gaussian (Heinz 2019, 3.2.5). */
layout(binding = 0) uniform sampler2D source;
uniform ivec2 direction;
uniform int taps; /* on one side, centre included; at most KILN_BLOOM_MAX_TAPS of bloom_plan.h */
uniform float weights[11]; /* from the centre outwards; those of both sides sum to 1 */

layout(location = 0) out vec4 out_color;

void main()
{
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(source, 0) - 1;
    vec4 sum = weights[0] * texelFetch(source, here, 0);
    for (int i = 1; i < taps; i++) {
        sum += weights[i] * texelFetch(source, min(here + direction * i, last), 0);
        sum += weights[i] * texelFetch(source, max(here - direction * i, ivec2(0)), 0);
    }
    out_color = sum;
}
