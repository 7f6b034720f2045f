/* Sorts the list of a pixel, farthest first, where that has not been done (fragments_merge.comp), and
 * blends it, or a stretch of it. */
#include "draw/sprites/fragments.glsl"
#include "draw/sprites/fragments_pixel.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

uniform uvec2 stretch; /* of each list: from, until; later ones are blended over this one */

/* Shell's sort: short, and quick on what is almost in order. */
void sort_list(uint first, uint count)
{
    for (uint gap = 121u; gap > 0u; gap /= 3u) { /* the largest below KILN_FRAGMENT_SHORT */
        for (uint i = gap; i < count; i++) {
            uvec4 key = list_keys[first + i];
            uint to = i;
            while (to >= gap && is_behind(key, list_keys[first + to - gap])) {
                list_keys[first + to] = list_keys[first + to - gap];
                to -= gap;
            }
            list_keys[first + to] = key;
        }
    }
}

void main()
{
    uint pixel = pixel_number(), first = places[pixel].first, count = list_length(pixel);
    bool sorted = stretch.x > 0u || counts[pixel] > KILN_FRAGMENT_SHORT;
    sort_list(first, sorted ? 0u : count);
    vec4 color = vec4(0.0);
    vec3 glow = vec3(0.0);
    for (uint i = stretch.x, end = min(count, stretch.y); i < end; i++) {
        fragment f = fragments[list_keys[first + i].z];
        color = f.color + color * (1.0 - f.color.a);
        glow = f.color.rgb * f.bloom.rgb + glow * (1.0 - f.color.a);
    }
    out_color = color;
    out_bloom = vec4(glow, color.a);
}
