/* Declares the lists of fragments: one list for each pixel (post.compose: oit). The memory holds
 * the lists of one part of the picture at a time, since those of all pixels may not fit:
 * lib/draw/sprites/fragments_gl.c draws the picture part by part. shared/fragment_layout.h has the
 * binding points.
 *
 * particles_list.frag counts fragments and writes them. fragments_merge.comp and
 * fragments_resolve.frag sort and blend them. All of them include this file. */
#include "shared/fragment_layout.h"

struct fragment {
    vec4 color; /* premultiplied */
    vec4 bloom; /* rgb: weights of the bloom, or with GAS the glow itself; a: unused */
};

struct list_range {
    uint first;   /* index of the list's first fragment */
    uint written; /* number of fragments that were offered to the list so far */
};

/* counts[pixel] is the number of fragments that the list has room for, counted before any is
 * written. A fragment offered beyond it is dropped. */
layout(std430, binding = KILN_BIND_FRAGMENT_COUNTS) buffer list_count_block { uint counts[]; };
layout(std430, binding = KILN_BIND_FRAGMENT_RANGES) buffer list_range_block { list_range ranges[]; };
/* x: bits of the depth; y: twice the particle's place in the drawing order, plus 1 for the front
 * one of the two sheets of a billboard with depth (shared/fragment_layout.h); z: index of the
 * fragment in `fragments`; w: unused. */
layout(std430, binding = KILN_BIND_FRAGMENT_KEYS) buffer list_key_block { uvec4 list_keys[]; };
layout(std430, binding = KILN_BIND_FRAGMENTS) buffer list_block { fragment fragments[]; };

/* Returns how many fragments are on a pixel's list. */
uint list_length(uint pixel)
{
    return min(counts[pixel], ranges[pixel].written);
}

/* Returns whether the fragment of key `a` lies behind that of `b`: it is farther away, or as far
 * and drawn earlier. */
bool is_behind(uvec4 a, uvec4 b)
{
    return a.x != b.x ? a.x > b.x : a.y < b.y;
}
