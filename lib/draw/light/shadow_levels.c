/* This file finds where shadow maps changed, makes their coarser levels there, and copies levels
 * for GL. */
#include "draw/light/shadow_levels.h"

#include <string.h>

/* Returns the mean of one word of four texels that lie one after another, each half for itself.
 * words: of a texel. */
static uint32_t mean_word(const uint32_t *four, size_t words)
{
    uint32_t low = 2, high = 2; /* so that the quotients are rounded */
    for (size_t i = 0; i < 4; i++) {
        low += four[i * words] & 0xffffu;
        high += four[i * words] >> 16;
    }
    return high / 4 << 16 | low / 4;
}

/* Makes the texels from `first` to one before `end` of row y. `words` is a constant, so that loops
 * over words are unrolled. */
static inline void shrink_row(uint32_t *entries, size_t edge, size_t words, uint32_t level,
                              size_t y, size_t first, size_t end)
{
    const size_t pitch = KILN_SHADOW_PITCH(edge), entry = KILN_SHADOW_PAIR * words;
    const uint32_t *from =
        entries + entry * (kiln_shadow_level_start(edge, level - 1) + 2 * y * pitch);
    uint32_t *to = entries + entry * (kiln_shadow_level_start(edge, level) + y * pitch);
    for (size_t x = first; x < end; x++) {
        const uint32_t *four = from + 2 * entry * x; /* two entries */
        uint32_t means[2];
        for (size_t i = 0; i < words; i++)
            means[i] = mean_word(four + i, words);
        kiln_shadow_store(to + entry * x, pitch, means, words);
    }
}

void kiln_shadow_shrink_row(uint32_t *entries, size_t edge, uint32_t level, size_t y)
{
    shrink_row(entries, edge, 2, level, y, 0, edge >> level);
}

/* Makes a span of columns cover another one; spans with from >= to are empty. */
static void cover_span(uint16_t *from, uint16_t *to, uint16_t other_from, uint16_t other_to)
{
    if (other_from >= other_to)
        return;
    const bool empty = *from >= *to;
    *from = empty || other_from < *from ? other_from : *from;
    *to = empty || other_to > *to ? other_to : *to;
}

void kiln_shadow_update_span(struct kiln_shadow_span *span, const float *nearness, size_t edge)
{
    size_t from = 0, to = edge;
    while (from < to && !(nearness[from] > 0.0f))
        from++;
    while (to > from && !(nearness[to - 1] > 0.0f))
        to--;
    span->changed_from = span->from;
    span->changed_to = span->to;
    span->from = (uint16_t)from;
    span->to = (uint16_t)to;
    cover_span(&span->changed_from, &span->changed_to, span->from, span->to);
}

void kiln_shadow_shrink(uint32_t *entries, struct kiln_shadow_span *spans, size_t edge,
                        uint32_t level, size_t begin, size_t end)
{
    const struct kiln_shadow_span *finer = spans + kiln_shadow_spans_start(edge, level - 1);
    spans += kiln_shadow_spans_start(edge, level);
    for (size_t y = begin; y < end; y++) {
        const struct kiln_shadow_span *lower = &finer[2 * y + 1];
        struct kiln_shadow_span span = finer[2 * y];
        cover_span(&span.from, &span.to, lower->from, lower->to);
        cover_span(&span.changed_from, &span.changed_to, lower->changed_from, lower->changed_to);
        spans[y] = (struct kiln_shadow_span){
            (uint16_t)(span.from / 2), (uint16_t)((span.to + 1) / 2),
            (uint16_t)(span.changed_from / 2), (uint16_t)((span.changed_to + 1) / 2)};
        shrink_row(entries, edge, 1, level, y, spans[y].changed_from, spans[y].changed_to);
    }
}

void kiln_shadow_unpair(const uint32_t *entries, size_t edge, size_t words, uint32_t level,
                        uint32_t *texels)
{
    const size_t width = edge >> level, entry = KILN_SHADOW_PAIR * words;
    entries += entry * kiln_shadow_level_start(edge, level);
    for (size_t y = 0; y < width; y++) {
        for (size_t x = 0; x < width; x++)
            memcpy(texels + words * (y * width + x), entries + entry * x, words * sizeof *texels);
        entries += entry * KILN_SHADOW_PITCH(edge);
    }
}
