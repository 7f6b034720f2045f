/* Averages blocks of pixels. It skips no pixel, so that sparks do not flicker in the bloom. A sum
 * in 16 bits that overflowed to infinity counts as the largest half float, so that it does not
 * spread. */
layout(binding = 0) uniform sampler2D source;
uniform float ratio; /* whole: edge of a block */

layout(location = 0) out vec4 out_color;

void main()
{
    int factor = int(ratio);
    ivec2 first = ivec2(gl_FragCoord.xy) * factor;
    ivec2 last = textureSize(source, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < factor; y++) {
        for (int x = 0; x < factor; x++)
            sum += min(texelFetch(source, min(first + ivec2(x, y), last), 0), vec4(65504.0));
    }
    out_color = sum / float(factor * factor);
}
