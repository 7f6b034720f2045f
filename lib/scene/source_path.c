/* This file samples a path at equal distances. Births lie on the chords between the samples: around
 * a closed path through 8 points there are 512 chords, which leave a round curve by 2e-5 of its
 * radius. */
#include "scene/source_path.h"

#include "shared/exact.h"

enum { CHORDS_OF_POINT = 64, MOST_CHORDS = 16384 };

bool kiln_source_fill_path(struct kiln_arena *arena, struct kiln_path *path,
                           struct kiln_source *source)
{
    const uint32_t wanted = path->points.count * CHORDS_OF_POINT;
    const uint32_t chords = wanted < MOST_CHORDS ? wanted : MOST_CHORDS;
    path->over = (struct kiln_range){.min = {.constant = 0.0f}, .max = {.constant = 1.0f}};
    path->table = kiln_path_table_create(arena, path);
    source->cells = chords;
    source->word_count = chords + 1;
    source->words = kiln_arena_alloc(arena, source->word_count, sizeof *source->words);
    if (!path->table || !source->words)
        return false;
    for (uint32_t i = 0; i <= chords; i++) {
        const float part = (float)i / (float)chords;
        const struct kiln_path_place place = kiln_path_at(path, part, part);
        source->words[i] = FLOAT4(exact_canon((float)place.at[0]), exact_canon((float)place.at[1]),
                                  exact_canon((float)place.at[2]), 0.0f);
    }
    return true;
}
