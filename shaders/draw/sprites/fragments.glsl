/* The lists of a band of rows (shared/fragment_layout.h). */
#include "shared/fragment_layout.h"

struct fragment {
    vec4 color; /* premultiplied */
    vec4 bloom; /* weights, rgb */
};

struct list_place {
    uint first;  /* of the list */
    uint filled; /* of it */
};

layout(std430, binding = KILN_BIND_FRAGMENT_COUNTS) buffer list_count_block { uint counts[]; };
layout(std430, binding = KILN_BIND_FRAGMENT_PLACES) buffer list_place_block { list_place places[]; };
/* Bits of the depth; place in the drawing order, twice, and 1 more of a front half; its fragment. */
layout(std430, binding = KILN_BIND_FRAGMENT_KEYS) buffer list_key_block { uvec4 list_keys[]; };
layout(std430, binding = KILN_BIND_FRAGMENTS) buffer list_block { fragment fragments[]; };

/* What is there of a pixel's list. */
uint list_length(uint pixel)
{
    return min(counts[pixel], places[pixel].filled);
}

bool is_behind(uvec4 a, uvec4 b)
{
    return a.x != b.x ? a.x > b.x : a.y < b.y;
}
