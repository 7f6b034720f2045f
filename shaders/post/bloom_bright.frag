/* Applies the bright-pass filter (Heinz 2019, 2.1.5): keeps the part of a pixel by which its
 * strongest channel exceeds the threshold. The ratio of the channels stays, so that a bright red
 * glows red. */
#include "post/compose.glsl"

uniform float exposure;  /* factor */
uniform float threshold; /* in units of exposed light */

layout(location = 0) out vec4 out_color;

void main()
{
    vec4 color = min(composed(ivec2(gl_FragCoord.xy)), vec4(65504.0));
    float strongest = max(max(color.r, color.g), color.b) * exposure;
    float excess_part = max(strongest - threshold, 0.0) / max(strongest, 1e-6);
    out_color = vec4(color.rgb * excess_part, 0.0);
}
