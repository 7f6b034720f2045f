/* Halves a picture by a tent filter of weights 1 3 3 1 in each direction. The tents of neighbouring
 * pixels overlap, so a spark that crosses from one pixel to the next does not jump. Infinities
 * count as the largest half float, as in bloom_shrink.frag. */
layout(binding = 0) uniform sampler2D source;

layout(location = 0) out vec4 out_color;

void main()
{
    const float weights[4] = float[](0.125, 0.375, 0.375, 0.125);
    ivec2 first = ivec2(gl_FragCoord.xy) * 2 - 1;
    ivec2 last = textureSize(source, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++) {
            vec4 texel = texelFetch(source, clamp(first + ivec2(x, y), ivec2(0), last), 0);
            sum += weights[x] * weights[y] * min(texel, vec4(65504.0));
        }
    }
    out_color = sum;
}
