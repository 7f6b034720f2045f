/* Sets of shapes of the backdrop: a bit for each, in the order of struct kiln_draw_shapes. A set
 * has only as many words as the shapes of its scene need, so that small scenes pay for one. */
#ifndef KILN_DRAW_MOMENT_SHAPE_SET_H
#define KILN_DRAW_MOMENT_SHAPE_SET_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "shared/draw_layout.h"

enum { KILN_SHAPE_WORDS = KILN_MAX_OBJECTS / 32 };
static_assert(KILN_SHAPE_WORDS * 32 == KILN_MAX_OBJECTS, "whole words");

struct kiln_shape_set {
    uint32_t count; /* words in use */
    uint32_t words[KILN_SHAPE_WORDS];
};

/* Returns an empty set of some of `count` shapes. */
static inline struct kiln_shape_set kiln_shape_set_empty(uint32_t count)
{
    return (struct kiln_shape_set){.count = (count + 31) / 32};
}

/* Returns the set of all of `count` shapes. */
static inline struct kiln_shape_set kiln_shape_set_all(uint32_t count)
{
    struct kiln_shape_set set = kiln_shape_set_empty(count);
    for (uint32_t i = 0; i < set.count; i++)
        set.words[i] = count - 32 * i < 32 ? (1u << (count - 32 * i)) - 1 : ~0u;
    return set;
}

static inline void kiln_shape_set_add(struct kiln_shape_set *set, uint32_t shape)
{
    set->words[shape / 32] |= 1u << shape % 32;
}

static inline void kiln_shape_set_remove(struct kiln_shape_set *set, uint32_t shape)
{
    set->words[shape / 32] &= ~(1u << shape % 32);
}

/* Drops empty words at the end of a set that is complete, so that an empty set has none. */
static inline void kiln_shape_set_trim(struct kiln_shape_set *set)
{
    while (set->count > 0 && set->words[set->count - 1] == 0)
        set->count--;
}

/* Returns whether a trimmed set has shapes. */
static inline bool kiln_shape_set_any(const struct kiln_shape_set *set)
{
    return set->count > 0;
}

/* Goes through the shapes of a set: kiln_shape_walk_next moves to the next `shape`, and returns
 * false after the last one. */
struct kiln_shape_walk {
    const uint32_t *word, *end;
    uint32_t bits; /* those of *word that are left */
    uint32_t first, shape;
};

static inline struct kiln_shape_walk kiln_shape_walk_begin(const struct kiln_shape_set *set)
{
    return (struct kiln_shape_walk){
        .word = set->words, .end = set->words + set->count, .bits = set->count ? set->words[0] : 0};
}

static inline bool kiln_shape_walk_next(struct kiln_shape_walk *walk)
{
    while (!walk->bits) {
        if (walk->end - walk->word <= 1)
            return false;
        walk->bits = *++walk->word;
        walk->first += 32;
    }
    walk->shape = walk->first + (uint32_t)__builtin_ctz(walk->bits);
    walk->bits &= walk->bits - 1;
    return true;
}

/* Returns the trimmed set of the shapes that may hide a lamp, of a scene with `count` shapes. */
static inline struct kiln_shape_set kiln_shape_set_of_lamp(const struct kiln_draw_light *lamp,
                                                           uint32_t count)
{
    struct kiln_shape_set set = {.count = (count + 31) / 32};
    static_assert(sizeof set.words == sizeof lamp->hiders, "a bit for each shape");
    memcpy(set.words, lamp->hiders, sizeof set.words);
    kiln_shape_set_trim(&set);
    return set;
}

#endif
