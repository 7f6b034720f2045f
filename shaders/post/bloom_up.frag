/* Mixes a level of the pyramid with the levels below it, which have been joined at half the size
 * and are doubled by the quadratic B-spline. */
layout(binding = 0) uniform sampler2D level;
layout(binding = 1) uniform sampler2D coarser;
uniform float radius; /* 0: this level alone; 1: the levels below it alone */

layout(location = 0) out vec4 out_color;

/* Returns the spline's weights of three texels in a row, at a quarter of a texel to the left (odd
 * is 0) or to the right (1) of the middle one's centre. */
vec3 spline_weights(int odd)
{
    return odd == 0 ? vec3(0.28125, 0.6875, 0.03125) : vec3(0.03125, 0.6875, 0.28125);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(coarser, 0) - 1;
    vec3 wx = spline_weights(pixel.x & 1), wy = spline_weights(pixel.y & 1);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 3; y++) {
        for (int x = 0; x < 3; x++) {
            ivec2 at = clamp(pixel / 2 + ivec2(x, y) - 1, ivec2(0), last);
            sum += wx[x] * wy[y] * texelFetch(coarser, at, 0);
        }
    }
    out_color = mix(texelFetch(level, pixel, 0), sum, radius);
}
