/* Composes and weights a moment's picture of light; blending adds it to the sum of a frame
 * (lib/post/shutter_gl.c). */
#include "post/compose.glsl"

uniform float weight;

layout(location = 0) out vec4 out_color;

void main()
{
    out_color = weight * composed(ivec2(gl_FragCoord.xy));
}
