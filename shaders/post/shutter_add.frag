/* Weights a moment's image; blending adds it to the image's sum over a frame
 * (lib/post/shutter_gl.c). */
layout(binding = 0) uniform sampler2D source;

uniform float weight;

layout(location = 0) out vec4 out_color;

void main()
{
    out_color = weight * texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
