/* lib/draw/sprites/tile_rows.h: at every level of vectors the listed units of a sprite are those
 * that a loop over rows and columns finds, each once, with the same bits. */
#include <stdlib.h>
#include <string.h>

#include "shared/random.h"
#include "support/cmocka.h"
#include "unit/units_simd.h"

enum { ROW_FLOATS = KILN_TILE_PLANES * KILN_TILE_PITCH, TRIALS = 2000 };

static uint32_t next_random(uint32_t *stream)
{
    return random_mix((*stream)++);
}

static float random_float(uint32_t *stream)
{
    return (float)(int32_t)next_random(stream) * 0x1p-20f;
}

/* Makes spans within columns of the tile. Some rows are empty. */
static void fill_spans(struct units_spans *s, uint32_t *stream)
{
    *s = (struct units_spans){.deep = next_random(stream) % 2 == 0};
    s->x_from = (int)(next_random(stream) % KILN_TILE_WIDTH);
    s->x_to = s->x_from + 1 + (int)(next_random(stream) % (uint32_t)(KILN_TILE_WIDTH - s->x_from));
    for (int c = 0; c < 3; c++)
        s->steps[c] = random_float(stream);
    s->top = (int)(next_random(stream) % KILN_TILE_HEIGHT);
    s->rows = 1 + (int)(next_random(stream) % (uint32_t)(KILN_TILE_HEIGHT - s->top));
    for (int y = 0; y < s->rows; y++) {
        const uint32_t width = (uint32_t)(s->x_to - s->x_from);
        const uint32_t offset = next_random(stream) % width;
        const uint32_t length = next_random(stream) % (width - offset + 1);
        s->from[y] = length == 0 ? 0 : s->x_from + (int32_t)offset;
        s->units[y] = ((int32_t)length + 7) / 8;
        s->u[y] = random_float(stream);
        s->v[y] = random_float(stream);
        s->q[y] = random_float(stream);
    }
}

/* Makes some pixels opaque: none, single ones, or runs of them. */
static void fill_tile(struct kiln_tile *tile, uint32_t *stream)
{
    tile->has_opaque = next_random(stream) % 3 > 0;
    for (int y = 0; y < KILN_TILE_HEIGHT; y++) {
        uint64_t bits = (uint64_t)next_random(stream) << 32 | next_random(stream);
        if (next_random(stream) % 2 == 0) /* few pixels are transparent */
            bits &= bits << 9 & bits >> 17 & ((uint64_t)next_random(stream) << 32 | 0x10001u);
        tile->transparent[y] = bits;
        uint64_t seen = 0;
        for (int x = 0; x < KILN_TILE_WIDTH; x++)
            seen |= (uint64_t)((bits >> x & 0xff) != 0) << x;
        tile->seen[0][y] = (int32_t)(uint32_t)seen;
        tile->seen[1][y] = (int32_t)(seen >> 32);
    }
}

/* Lists units by loops, and writes them into a table by row and by unit. */
static int list_plainly(const struct kiln_tile *tile, const struct units_spans *s,
                        struct units_listed *by_place)
{
    int count = 0;
    memset(by_place, 0, sizeof *by_place);
    for (int y = 0; y < s->rows; y++) {
        for (int k = 0; k < s->units[y]; k++) {
            const int row = s->top + y, column = s->from[y] + 8 * k, place = y * UNITS_A_ROW + k;
            if (tile->has_opaque && (tile->transparent[row] >> column & 0xff) == 0)
                continue;
            by_place->at[place] = 1 + row * ROW_FLOATS + column;
            by_place->u[place] = s->u[y] + (float)(8 * k) * s->steps[0];
            by_place->v[place] = s->v[y] + (float)(8 * k) * s->steps[1];
            by_place->q[place] = s->deep ? s->q[y] + (float)(8 * k) * s->steps[2] : 0.0f;
            count++;
        }
    }
    return count;
}

static void check_units(const struct units_spans *s, struct units_listed *expected,
                        const struct units_listed *found)
{
    for (int i = 0; i < found->count; i++) {
        const int y = found->at[i] / ROW_FLOATS - s->top, column = found->at[i] % ROW_FLOATS;
        assert_in_range(y, 0, s->rows - 1);
        const int place = y * UNITS_A_ROW + (column - s->from[y]) / 8;
        assert_int_equal(found->at[i] + 1, expected->at[place]);
        expected->at[place] = 0; /* no unit may be listed twice */
        assert_memory_equal(&found->u[i], &expected->u[place], sizeof found->u[i]);
        assert_memory_equal(&found->v[i], &expected->v[place], sizeof found->v[i]);
        if (s->deep)
            assert_memory_equal(&found->q[i], &expected->q[place], sizeof found->q[i]);
    }
}

static void every_level_lists_the_units_of_plain_loops(void **state)
{
    (void)state;
    struct kiln_tile *tile = aligned_alloc(64, sizeof *tile);
    struct units_listed *expected = malloc(sizeof *expected), *found = malloc(sizeof *found);
    assert_true(tile && expected && found);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        uint32_t stream = 1;
        for (int trial = 0; trial < TRIALS && kiln_simd_has(simd); trial++) {
            struct units_spans spans;
            fill_spans(&spans, &stream);
            fill_tile(tile, &stream);
            const int count = list_plainly(tile, &spans, expected);
            KILN_SIMD_PICK(units_list, simd)(tile, &spans, found);
            assert_int_equal(found->count, count);
            check_units(&spans, expected, found);
        }
    }
    free(tile);
    free(expected);
    free(found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_level_lists_the_units_of_plain_loops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
