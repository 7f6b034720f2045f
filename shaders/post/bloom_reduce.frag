/* Reduces a picture by any ratio with a tent filter. Infinities count as the largest half float, as
 * in bloom_shrink.frag. */
#include "shared/tent.h"

layout(binding = 0) uniform sampler2D source;
uniform float ratio; /* pixels of the source for one pixel of the result along an axis */

layout(location = 0) out vec4 out_color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 center = vec2(tent_center(float(pixel.x), ratio), tent_center(float(pixel.y), ratio));
    ivec2 first = ivec2(floor(center - ratio - 0.5)) + 1;
    ivec2 end = ivec2(ceil(center + ratio + 0.5));
    ivec2 last = textureSize(source, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int y = first.y; y < end.y; y++) {
        vec4 row = vec4(0.0);
        for (int x = first.x; x < end.x; x++) {
            vec4 texel = texelFetch(source, clamp(ivec2(x, y), ivec2(0), last), 0);
            row += tent_weight(float(x) - center.x, ratio) * min(texel, vec4(65504.0));
        }
        sum += tent_weight(float(y) - center.y, ratio) * row;
    }
    out_color = sum;
}
