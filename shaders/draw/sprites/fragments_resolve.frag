/* Sorts a pixel's list of fragments if it is short, and then blends it, farthest first.
 * fragments_merge.comp has sorted long lists already.
 *
 * The function resolve() of lib/draw/sprites/fragments_gl.c draws a triangle over the picture with
 * this shader after the lists are written, for the scene option `post.compose: oit`, which sorts
 * fragments pixel by pixel (order-independent transparency). Software GL limits the iterations of a
 * shader's loops, so there resolve() draws several times, and each draw blends one span of every
 * list. A static assertion in fragments_gl.c bounds the iterations of the loops in this file; who
 * changes a loop must change that bound. is_behind must tell any two fragments of a list apart, so
 * that the picture does not depend on the order in which fragments arrived. */
// variant:
// variant: GAS=1
#include "draw/sprites/fragments.glsl"
#include "draw/sprites/fragments_pixel.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out vec4 out_bloom;

/* The draw blends the fragments from span.x (included) to span.y (excluded) of each list. GL blends
 * its result over those of earlier spans. */
uniform uvec2 span;

/* Sorts a list by Shell's sort, which is short code, and quick for a list that is almost in order.
 * The gaps are 121, 40, 13, 4 and 1. The next gap of that sequence, 364, would be longer than a
 * short list (KILN_FRAGMENT_SHORT); a gap that is too small costs only time. */
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
    /* A short list is sorted by the draw of the first span, a long one by fragments_merge.comp. */
    bool sorted = span.x > 0u || counts[pixel] > KILN_FRAGMENT_SHORT;
    sort_list(first, sorted ? 0u : count);
    vec4 color = vec4(0.0);
    vec3 glow = vec3(0.0);
    for (uint i = span.x, end = min(count, span.y); i < end; i++) {
        fragment f = fragments[list_keys[first + i].z]; /* z: index of the fragment */
        color = f.color + color * (1.0 - f.color.a);
#ifdef GAS
        glow = f.bloom.rgb + glow * (1.0 - f.color.a);
#else
        glow = f.color.rgb * f.bloom.rgb + glow * (1.0 - f.color.a);
#endif
    }
    out_color = color;
    out_bloom = vec4(glow, color.a);
}
