/* Blends the fragments in a pixel's list, farthest first, and sorts the list before that if it is
 * short. fragments_merge.comp has sorted long lists already.
 *
 * resolve of lib/draw/sprites/fragments_gl.c draws a triangle over the picture with it, after the
 * lists are written (post.compose: oit). Software GL limits the iterations of a shader's loops, so
 * there it draws once for each span of the lists; an assertion in fragments_gl.c counts the
 * iterations of the loops in this file. is_behind must tell any two fragments of a list apart, so
 * that the picture does not depend on the order in which fragments arrived. */
#include "draw/sprites/fragments.glsl"
#include "draw/sprites/fragments_pixel.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

/* The fragments of each list to blend: from the first number until before the second. GL blends the
 * next span over this one. */
uniform uvec2 span;

/* Sorts a list by Shell's sort, which is short code, and quick for a list that is almost in order.
 * The gaps are 121, 40, 13, 4 and 1: the next one of that sequence, 364, exceeds
 * KILN_FRAGMENT_SHORT. */
void sort_list(uint first, uint count)
{
    for (uint gap = 121u; gap > 0u; gap /= 3u) {
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
    uint pixel = pixel_number(), first = ranges[pixel].first, count = list_length(pixel);
    /* An earlier span has sorted a short list, and fragments_merge.comp a long one. */
    bool sorted = span.x > 0u || counts[pixel] > KILN_FRAGMENT_SHORT;
    sort_list(first, sorted ? 0u : count);
    vec4 color = vec4(0.0);
    vec3 glow = vec3(0.0);
    for (uint i = span.x, end = min(count, span.y); i < end; i++) {
        fragment f = fragments[list_keys[first + i].z];
        color = f.color + color * (1.0 - f.color.a);
        glow = f.color.rgb * f.bloom.rgb + glow * (1.0 - f.color.a);
    }
    out_color = color;
    out_bloom = vec4(glow, color.a);
}
