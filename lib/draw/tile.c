/* Which code draws tiles on this machine. */
#include "draw/tile.h"

#include <string.h>

struct level {
    const char *name;
    kiln_tile_draw *draw;
    bool (*runs)(void);
};

static bool always(void)
{
    return true;
}

#ifdef __x86_64__
static bool has_sse41(void)
{
    return __builtin_cpu_supports("sse4.1");
}

static bool has_avx2(void)
{
    return __builtin_cpu_supports("avx2");
}

static bool has_avx512(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

/* Narrowest first. */
static const struct level LEVELS[] = {
    {"plain", kiln_tile_draw_plain, always},
#ifdef __x86_64__
    {"sse4.1", kiln_tile_draw_sse41, has_sse41},
    {"avx2", kiln_tile_draw_avx2, has_avx2},
    {"avx512", kiln_tile_draw_avx512, has_avx512},
#endif
};

enum { LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS };

kiln_tile_draw *kiln_tile_drawing(const char *name)
{
    kiln_tile_draw *draw = NULL;
    for (size_t i = 0; i < LEVEL_COUNT; i++) {
        if (LEVELS[i].runs() && (!name || strcmp(LEVELS[i].name, name) == 0))
            draw = LEVELS[i].draw;
    }
    return draw;
}

/* Each level has those below it. */
const char *kiln_tile_drawings(void)
{
    static const char *const lists[LEVEL_COUNT] = {
        "plain",
#ifdef __x86_64__
        "plain, sse4.1",
        "plain, sse4.1, avx2",
        "plain, sse4.1, avx2, avx512",
#endif
    };
    size_t widest = 0;
    for (size_t i = 0; i < LEVEL_COUNT; i++)
        widest = LEVELS[i].runs() ? i : widest;
    return lists[widest];
}
