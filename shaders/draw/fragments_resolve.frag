/* Sorts the list of a pixel, farthest first, and blends it. */
#include "draw/fragments.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

bool is_behind(uvec4 a, uvec4 b)
{
    return a.x != b.x ? a.x > b.x : a.y < b.y;
}

/* Shell's sort: short, and quick on what is almost in order. */
void sort_list(uint first, uint count)
{
    uint gap = 1u;
    while (gap < count / 3u)
        gap = gap * 3u + 1u;
    for (; gap > 0u; gap /= 3u) {
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
    uint pixel = pixel_number(), first = places[pixel].first;
    uint count = min(counts[pixel], places[pixel].filled);
    sort_list(first, count);
    vec4 color = vec4(0.0);
    vec3 glow = vec3(0.0);
    for (uint i = 0u; i < count; i++) {
        fragment f = fragments[list_keys[first + i].z];
        color = f.color + color * (1.0 - f.color.a);
        glow = f.color.rgb * f.bloom.rgb + glow * (1.0 - f.color.a);
    }
    out_color = color;
    out_bloom = vec4(glow, color.a);
}
