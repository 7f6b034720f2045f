/* Declares the lists of fragments of the pixels in a part of the picture
 * (shared/fragment_layout.h). lib/draw/sprites/fragments_gl.c draws part by part, so that the lists
 * fit in memory. */
#include "shared/fragment_layout.h"

struct fragment {
    vec4 color; /* premultiplied */
    vec4 bloom; /* weights, rgb */
};

struct list_range {
    uint first;  /* index of the list's first fragment */
    uint written; /* number of fragments on the list so far */
};

layout(std430, binding = KILN_BIND_FRAGMENT_COUNTS) buffer list_count_block { uint counts[]; };
layout(std430, binding = KILN_BIND_FRAGMENT_RANGES) buffer list_range_block { list_range ranges[]; };
/* x: bits of the depth; y: twice the place in the drawing order, plus 1 for a front sheet; z: index
 * of the fragment in `fragments`. */
layout(std430, binding = KILN_BIND_FRAGMENT_KEYS) buffer list_key_block { uvec4 list_keys[]; };
layout(std430, binding = KILN_BIND_FRAGMENTS) buffer list_block { fragment fragments[]; };

/* Returns how many fragments are on a pixel's list. */
uint list_length(uint pixel)
{
    return min(counts[pixel], ranges[pixel].written);
}

bool is_behind(uvec4 a, uvec4 b)
{
    return a.x != b.x ? a.x > b.x : a.y < b.y;
}
