/* lib/draw/light/shadow_levels: levels have the means of the level before, each entry has the texel
 * below, and a map that is drawn again is the same as one that is drawn once. */
#include <stdlib.h>
#include <string.h>

#include "draw/light/shadow_levels.h"
#include "support/cmocka.h"

enum { EDGE = 16, LEVELS = 5, ENTRIES = KILN_SHADOW_MAP_ENTRIES(EDGE, LEVELS), MOST_WORDS = 2 };

static const size_t PITCH = KILN_SHADOW_PITCH(EDGE);

static float part(void)
{
    return (float)rand() / (float)RAND_MAX;
}

struct map {
    uint32_t entries[ENTRIES * KILN_SHADOW_PAIR * MOST_WORDS];
    struct kiln_shadow_span spans[2 * EDGE];
};

/* Fills a rectangle of the finest level with random distances, leaves holes in it, and makes the
 * other levels. */
static void draw(struct map *map, size_t left, size_t top, size_t right, size_t bottom,
                 unsigned seed)
{
    srand(seed);
    for (size_t y = 0; y < EDGE; y++) {
        float nearness[EDGE] = {0};
        for (size_t x = left; x < right && y >= top && y < bottom; x++)
            nearness[x] = part() < 0.8f ? part() : 0.0f;
        struct kiln_shadow_span *span = &map->spans[y];
        kiln_shadow_update_span(span, nearness, EDGE);
        for (size_t x = span->changed_from; x < span->changed_to; x++) {
            const uint32_t texel = nearness[x] > 0.0f ? kiln_shadow_texel(nearness[x]) : 0;
            const size_t at = kiln_shadow_level_start(EDGE, 0) + y * PITCH + x;
            kiln_shadow_store(map->entries + KILN_SHADOW_PAIR * at, PITCH, &texel, 1);
        }
    }
    for (uint32_t level = 1; level < LEVELS; level++)
        kiln_shadow_shrink(map->entries, map->spans, EDGE, level, 0, EDGE >> level);
}

/* Every entry's second texel is the first one of the entry below. */
static void check_pairs(const uint32_t *entries, size_t words)
{
    const size_t entry = KILN_SHADOW_PAIR * words;
    for (size_t i = 0; i + PITCH < ENTRIES; i++)
        assert_memory_equal(entries + entry * i + words, entries + entry * (i + PITCH),
                            words * sizeof *entries);
}

/* Each texel has the means of four of the level before. */
static void check_means(const uint32_t *entries, size_t words)
{
    for (uint32_t level = 1; level < LEVELS; level++) {
        uint32_t fine[EDGE * EDGE * MOST_WORDS], coarse[EDGE * EDGE * MOST_WORDS];
        const size_t width = EDGE >> level;
        kiln_shadow_unpair(entries, EDGE, words, level - 1, fine);
        kiln_shadow_unpair(entries, EDGE, words, level, coarse);
        for (size_t i = 0; i < width * width * words; i++) {
            const size_t x = i / words % width, y = i / words / width, word = i % words;
            uint32_t low = 2, high = 2;
            for (size_t k = 0; k < 4; k++) {
                const size_t at = (2 * y + k / 2) * 2 * width + 2 * x + k % 2;
                low += fine[at * words + word] & 0xffffu;
                high += fine[at * words + word] >> 16;
            }
            assert_int_equal(coarse[i], high / 4 << 16 | low / 4);
        }
    }
}

static void a_map_drawn_again_is_as_if_drawn_once(void **state)
{
    static const size_t places[][4] = {{2, 3, 9, 11},  {7, 0, 16, 5}, {0, 14, 1, 16},
                                       {0, 0, 16, 16}, {5, 5, 5, 5},  {3, 8, 14, 9}};
    (void)state;
    struct map *kept = calloc(1, sizeof *kept);
    assert_non_null(kept);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const size_t *at = places[i];
        struct map *once = calloc(1, sizeof *once);
        assert_non_null(once);
        draw(kept, at[0], at[1], at[2], at[3], (unsigned)i);
        draw(once, at[0], at[1], at[2], at[3], (unsigned)i);
        assert_memory_equal(kept->entries, once->entries, sizeof once->entries);
        check_pairs(once->entries, 1);
        check_means(once->entries, 1);
        free(once);
    }
    free(kept);
}

static void texels_of_two_words_have_levels_too(void **state)
{
    (void)state;
    enum { ENTRY = KILN_SHADOW_PAIR * 2 };
    srand(5);
    struct map *map = calloc(1, sizeof *map);
    assert_non_null(map);
    for (size_t y = 0; y < EDGE; y++) {
        for (size_t x = 0; x < EDGE; x++) {
            const uint32_t texel[2] = {(uint32_t)(part() * 4e9f), (uint32_t)(part() * 4e9f)};
            const size_t at = kiln_shadow_level_start(EDGE, 0) + y * PITCH + x;
            kiln_shadow_store(map->entries + ENTRY * at, PITCH, texel, 2);
        }
    }
    for (uint32_t level = 1; level < LEVELS; level++) {
        for (size_t y = 0; y < (size_t)EDGE >> level; y++)
            kiln_shadow_shrink_row(map->entries, EDGE, level, y);
    }
    check_pairs(map->entries, 2);
    check_means(map->entries, 2);
    free(map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_drawn_again_is_as_if_drawn_once),
        cmocka_unit_test(texels_of_two_words_have_levels_too),
    };
    return cmocka_run_group_tests_name("shadow_levels", tests, NULL, NULL);
}
