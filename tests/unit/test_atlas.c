/* lib/asset: blackbody colours and procedural flipbooks. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "asset/atlas/atlas.h"
#include "asset/atlas/blackbody.h"
#include "asset/atlas/builtin.h"
#include "support/cmocka.h"

enum { EDGE = 128, CELL_FLOATS = EDGE * EDGE * 4 };

static float luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* Planck's locus passes close to D65 near 6500 K, and a candle (1850 K) is about (1, 0.3, 0). */
static void hot_things_have_the_right_hue(void **state)
{
    (void)state;
    float rgb[3];
    struct kiln_observer observer;
    kiln_observer_fill(&observer);
    kiln_blackbody_color(&observer, 6500.0f, rgb);
    assert_true(fabsf(rgb[1] / rgb[0] - 0.95f) < 0.06f);
    assert_true(fabsf(rgb[2] / rgb[0] - 0.97f) < 0.10f);

    kiln_blackbody_color(&observer, 1850.0f, rgb);
    assert_true(rgb[1] / rgb[0] > 0.22f && rgb[1] / rgb[0] < 0.36f);
    assert_true(rgb[2] / rgb[0] < 0.01f);

    float before = 0.0f;
    for (float kelvin = 800.0f; kelvin < 10000.0f; kelvin += 100.0f) {
        kiln_blackbody_color(&observer, kelvin, rgb);
        float green = rgb[1] / rgb[0];
        assert_true(green >= before);
        before = green;
    }
}

static void hot_things_shine_with_the_fourth_power(void **state)
{
    (void)state;
    float low[3], high[3], none[3];
    struct kiln_observer observer;
    kiln_observer_fill(&observer);
    kiln_blackbody_color(&observer, 1900.0f, low);
    assert_true(fabsf(luminance(low) - 1.0f) < 0.02f);
    kiln_blackbody_color(&observer, 3800.0f, high);
    assert_true(fabsf(luminance(high) / luminance(low) - 16.0f) < 0.4f);
    kiln_blackbody_color(&observer, 399.0f, none);
    assert_true(none[0] == 0.0f && none[1] == 0.0f && none[2] == 0.0f);
    kiln_blackbody_color(&observer, NAN, none);
    assert_true(none[0] == 0.0f);
}

/* A flipbook of cells of EDGE x EDGE texels, with its motion. */
struct book {
    uint32_t count;
    float *cells, *motion;
};

static struct book make_book_at(const char *name, uint32_t count, enum kiln_simd simd)
{
    struct book book = {count, calloc(count, CELL_FLOATS * sizeof(float)),
                        calloc(count, EDGE * EDGE * 2 * sizeof(float))};
    struct kiln_builtin_scratch *scratch = kiln_builtin_scratch_create();
    struct kiln_builtin builtin;
    assert_true(scratch && book.cells && book.motion);
    assert_true(kiln_builtin_open(&builtin, name, count, simd));
    for (uint32_t i = 0; i < count; i++) {
        kiln_builtin_cell(&builtin, i, EDGE, scratch, book.cells + (size_t)i * CELL_FLOATS);
        if (builtin.film)
            kiln_builtin_motion(&builtin, i, EDGE, scratch,
                                book.motion + (size_t)i * EDGE * EDGE * 2);
    }
    kiln_builtin_close(&builtin);
    free(scratch);
    return book;
}

static struct book make_book(const char *name, uint32_t count)
{
    struct kiln_error error = {0};
    enum kiln_simd simd;
    assert_true(kiln_simd_choose(&simd, &error));
    return make_book_at(name, count, simd);
}

static void free_book(struct book *book)
{
    free(book->cells);
    free(book->motion);
}

static float mean_density(const struct book *book, uint32_t cell)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < EDGE * EDGE; i++)
        sum += book->cells[cell * CELL_FLOATS + 4 * i + 3];
    return sum / (EDGE * EDGE);
}

/* Returns whether a flipbook is for ribbons, which go on where their cells end. */
static bool is_for_ribbons(const char *name)
{
    return strcmp(name, "trail") == 0 || strcmp(name, "band") == 0;
}

/* Each value is in its range, nothing touches the cell's border (a quad's edge must not show), and
 * some cell is well covered. */
static void cells_are_sound(void **state)
{
    (void)state;
    for (size_t n = 0; kiln_builtin_name_at(n); n++) {
        struct book book = make_book(kiln_builtin_name_at(n), 16);
        float densest = 0.0f;
        for (size_t i = 0; i < (size_t)book.count * EDGE * EDGE; i++) {
            const float *p = book.cells + 4 * i;
            assert_true(p[0] * p[0] + p[1] * p[1] < 1.0f);
            assert_true(p[2] >= 0.0f && p[2] <= 1.0f && p[3] >= 0.0f && p[3] <= 1.0f);
            size_t x = i % EDGE, y = i / EDGE % EDGE;
            const bool beside = !is_for_ribbons(kiln_builtin_name_at(n));
            if (y == 0 || y == EDGE - 1 || (beside && (x == 0 || x == EDGE - 1)))
                assert_true(p[3] < 0.01f);
            densest = fmaxf(densest, p[3]);
        }
        assert_true(densest > 0.5f);
        free_book(&book);
    }
}

static void fire_erodes_and_smoke_stays(void **state)
{
    (void)state;
    struct book fire = make_book("fire", 32), smoke = make_book("smoke", 32);
    assert_true(mean_density(&fire, 0) > 0.15f);
    assert_true(mean_density(&fire, 31) < 0.1f * mean_density(&fire, 0));
    for (uint32_t cell = 1; cell < 32; cell++) {
        assert_true(mean_density(&fire, cell) < mean_density(&fire, cell - 1) + 0.01f);
        float here = mean_density(&smoke, cell);
        assert_true(here > 0.2f);
        assert_true(fabsf(here - mean_density(&smoke, cell - 1)) < 0.03f); /* no jump */
    }
    free_book(&fire);
    free_book(&smoke);
}

/* The height of the middle of what shines: -1 at the foot of the cell, 1 at its top. */
static float middle_height(const struct book *book, uint32_t cell)
{
    float sum = 0.0f, weights = 0.0f;
    for (uint32_t i = 0; i < EDGE * EDGE; i++) {
        float density = book->cells[cell * CELL_FLOATS + 4 * i + 3];
        sum += density * (1.0f - 2.0f * ((float)(i / EDGE) + 0.5f) / EDGE);
        weights += density;
    }
    return sum / weights;
}

/* A flame starts low, climbs, parts from its foot and is gone at the end. */
static void flames_climb(void **state)
{
    (void)state;
    static const char *const names[] = {"flame", "tongue"};
    for (size_t n = 0; n < 2; n++) {
        struct book book = make_book(names[n], 16);
        assert_true(middle_height(&book, 3) < -0.4f);
        assert_true(middle_height(&book, 10) > middle_height(&book, 3) + 0.3f);
        assert_true(mean_density(&book, 8) > 4.0f * mean_density(&book, 15));
        free_book(&book);
    }
}

static void cells_are_the_same_bytes_at_every_level(void **state)
{
    (void)state;
    for (size_t n = 0; kiln_builtin_name_at(n); n++) {
        const char *name = kiln_builtin_name_at(n);
        struct book plain = make_book_at(name, 3, kiln_simd_narrowest());
        for (enum kiln_simd simd = kiln_simd_narrowest() + 1; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            struct book book = make_book_at(name, 3, simd);
            assert_memory_equal(book.cells, plain.cells, 3 * CELL_FLOATS * sizeof(float));
            assert_memory_equal(book.motion, plain.motion, 3 * EDGE * EDGE * 2 * sizeof(float));
            free_book(&book);
        }
        free_book(&plain);
    }
}

/* ---- whole atlases --------------------------------------------------------------------------- */

static struct kiln_atlas make_atlas(uint32_t threads)
{
    static const char *const sources[] = {"builtin:puff", "builtin:spark", "builtin:tongue",
                                          "builtin:puff"};
    const struct kiln_atlas_request requests[] = {
        {sources, 2, 3, 2, "auto", {1.0f, 1.0f}, NULL},
        {sources + 2, 2, 3, 2, "auto", {1.0f, 1.0f}, NULL},
        {sources + 1, 1, 1, 1, "none", {1.0f, 1.0f}, NULL}};
    struct kiln_threads *pool = kiln_threads_create(threads);
    struct kiln_error error = {0};
    struct kiln_atlas atlas = {0};
    assert_non_null(pool);
    assert_true(kiln_atlas_init(&atlas, NULL, requests, 3, NULL, pool, &error));
    kiln_threads_destroy(&pool);
    return atlas;
}

/* Each flipbook has its layers, whoever made them, and equal ones share them. */
static void atlases_do_not_depend_on_threads(void **state)
{
    (void)state;
    struct kiln_atlas one = make_atlas(1), many = make_atlas(8);
    assert_int_equal(one.layers, 6 + 6 + 6 + 1);
    assert_int_equal(one.systems[1].textures[1].first_layer, 0);
    assert_int_equal(one.systems[1].textures[0].first_layer, 12);
    assert_true(one.systems[0].textures[0].motion > 0.0f);
    assert_true(one.systems[0].textures[1].motion == 0.0f);
    assert_int_equal(many.layers, one.layers);
    assert_memory_equal(many.texels, one.texels, (size_t)one.layers * KILN_ATLAS_LAYER_BYTES);
    assert_memory_equal(many.moves, one.moves, (size_t)one.layers * KILN_ATLAS_MOVES_BYTES);
    assert_memory_equal(many.systems, one.systems, sizeof one.systems);
    kiln_atlas_finish(&one);
    kiln_atlas_finish(&many);
}

/* Levels are means, of normals and heat by density, to within a step of their 8 bits. */
static void levels_are_means(void **state)
{
    (void)state;
    struct kiln_atlas atlas = make_atlas(2);
    const uint8_t *whole = kiln_atlas_level(&atlas, 14, 0), *half = kiln_atlas_level(&atlas, 14, 1);
    for (uint32_t i = 0; i < EDGE / 2 * EDGE / 2; i++) {
        uint32_t x = 2 * (i % (EDGE / 2)), y = 2 * (i / (EDGE / 2)), sum = 0;
        double heat = 0.0;
        for (uint32_t k = 0; k < 4; k++) {
            const uint8_t *p = whole + 4 * ((size_t)(y + k / 2) * EDGE + x + k % 2);
            sum += p[3];
            heat += (double)p[3] * p[2];
        }
        assert_true(fabs(half[4 * i + 3] - sum / 4.0) <= 1.0);
        if (sum > 400) /* else what 8 bits lose is too much */
            assert_true(fabs(half[4 * i + 2] - heat / sum) <= 2.0);
    }
    kiln_atlas_finish(&atlas);
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* A channel of a grid of EDGE x EDGE, x and y in texels. */
static float sample(const float *grid, uint32_t channels, uint32_t channel, float x, float y)
{
    float x0 = floorf(x), y0 = floorf(y), sum = 0.0f;
    for (int k = 0; k < 4; k++) {
        float px = x0 + (float)(k % 2), py = y0 + (float)(k / 2);
        float weight = (1.0f - fabsf(x - px)) * (1.0f - fabsf(y - py));
        size_t column = (size_t)fminf(fmaxf(px, 0.0f), EDGE - 1);
        size_t row = (size_t)fminf(fmaxf(py, 0.0f), EDGE - 1);
        sum += weight * grid[(row * EDGE + column) * channels + channel];
    }
    return sum;
}

/* Density as the fragment shader finds it (draw/sprites/shade.glsl), at a progress through life. */
static float played(const struct book *book, bool moving, float life, uint32_t x, uint32_t y)
{
    float position = life * (float)(book->count - 1), first = floorf(position);
    first = fminf(first, (float)(book->count - 2));
    float part = position - first, way_x = 0.0f, way_y = 0.0f;
    const float *cell = book->cells + (size_t)first * CELL_FLOATS;
    if (moving) {
        const float *motion = book->motion + (size_t)first * EDGE * EDGE * 2;
        way_x = EDGE * motion[(y * EDGE + x) * 2];
        way_y = -EDGE * motion[(y * EDGE + x) * 2 + 1];
    }
    float from = sample(cell, 4, 3, (float)x - part * way_x, (float)y - part * way_y);
    float to = sample(cell + CELL_FLOATS, 4, 3, (float)x + (1.0f - part) * way_x,
                      (float)y + (1.0f - part) * way_y);
    return from + (to - from) * part;
}

/* Mean square difference of a book's densities from a film with as many cells as it takes. */
static double difference(const struct book *book, bool moving, const struct book *film)
{
    double sum = 0.0;
    for (uint32_t cell = 0; cell < film->count; cell++) {
        float life = (float)cell / (float)(film->count - 1);
        for (uint32_t i = 0; i < EDGE * EDGE; i++) {
            double off = (double)(played(book, moving, life, i % EDGE, i / EDGE) -
                                  film->cells[cell * CELL_FLOATS + 4 * i + 3]);
            sum += off * off;
        }
    }
    return sum / ((double)film->count * EDGE * EDGE);
}

/* 16 cells that move are nearer to the film of 64 than 16 cells that mix, in decibels (of what
 * turns as slowly as smoke, 16 cells are within 50 dB either way). */
static void motion_makes_up_for_cells(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double least_db;
    } gains[] = {{"flame", 6.0}, {"tongue", 6.0}, {"fire", 2.5}, {"puff", 3.0}};
    for (size_t i = 0; i < sizeof gains / sizeof *gains; i++) {
        struct book film = make_book(gains[i].name, 64), few = make_book(gains[i].name, 16);
        double mixed = difference(&few, false, &film), moved = difference(&few, true, &film);
        double gain_db = 10.0 * log10(mixed / moved);
        print_message("%s: 16 cells are %.1f dB nearer to 64 with motion (%.1f to %.1f dB)\n",
                      gains[i].name, gain_db, -10.0 * log10(mixed), -10.0 * log10(moved));
        assert_true(gain_db > gains[i].least_db);
        free_book(&film);
        free_book(&few);
    }
}

/* Flames move up, by about as much as their middle climbs; what swells moves outwards. */
static void motion_points_the_right_way(void **state)
{
    (void)state;
    struct book flame = make_book("tongue", 16), puff = make_book("puff", 16);
    float up = 0.0f, weights = 0.0f, outwards = 0.0f;
    for (uint32_t i = 0; i < EDGE * EDGE; i++) {
        float density = flame.cells[6 * CELL_FLOATS + 4 * i + 3];
        up += density * flame.motion[(6 * EDGE * EDGE + i) * 2 + 1];
        weights += density;
        float x = ((float)(i % EDGE) + 0.5f) * 2.0f / EDGE - 1.0f;
        float y = 1.0f - ((float)(i / EDGE) + 0.5f) * 2.0f / EDGE;
        outwards += x * puff.motion[(2 * EDGE * EDGE + i) * 2] +
                    y * puff.motion[(2 * EDGE * EDGE + i) * 2 + 1];
    }
    assert_true(up / weights > 0.02f && up / weights < 0.2f);
    assert_true(outwards > 0.0f);
    free_book(&flame);
    free_book(&puff);
}

static void names_are_known(void **state)
{
    (void)state;
    assert_true(kiln_builtin_exists("fire"));
    assert_true(kiln_builtin_exists("spark"));
    assert_false(kiln_builtin_exists("water"));
    assert_false(kiln_builtin_exists(""));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(hot_things_have_the_right_hue),
        cmocka_unit_test(hot_things_shine_with_the_fourth_power),
        cmocka_unit_test(cells_are_sound),
        cmocka_unit_test(fire_erodes_and_smoke_stays),
        cmocka_unit_test(flames_climb),
        cmocka_unit_test(cells_are_the_same_bytes_at_every_level),
        cmocka_unit_test(atlases_do_not_depend_on_threads),
        cmocka_unit_test(levels_are_means),
        cmocka_unit_test(motion_makes_up_for_cells),
        cmocka_unit_test(motion_points_the_right_way),
        cmocka_unit_test(names_are_known),
    };
    return cmocka_run_group_tests_name("atlas", tests, NULL, NULL);
}
