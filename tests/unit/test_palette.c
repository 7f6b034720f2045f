/* Palettes: few colours come back as they are, many are covered well, mixes keep the average. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "output/palette.h"
#include "support/cmocka.h"

static struct kiln_palette make(const uint8_t *rgb, size_t pixels, uint32_t most)
{
    struct kiln_histogram *histogram = kiln_histogram_create();
    struct kiln_palette palette;
    kiln_histogram_add(histogram, rgb, pixels);
    struct kiln_error error = {0};
    assert_true(kiln_palette_make(&palette, histogram, most, NULL, &error));
    kiln_histogram_destroy(&histogram);
    assert_null(histogram);
    return palette;
}

static void few_colors_stay_exact(void **state)
{
    (void)state;
    /* One of them once among many others. */
    uint8_t rgb[3 * 1000];
    static const uint8_t colors[4][3] = {{0, 0, 0}, {255, 255, 255}, {255, 96, 16}, {12, 14, 30}};
    for (size_t i = 0; i < 1000; i++)
        memcpy(rgb + 3 * i, colors[i == 0 ? 2 : i % 2 ? 0 : 3 * (i % 4 / 2)], 3);
    memcpy(rgb + 3 * 999, colors[1], 3);
    struct kiln_palette palette = make(rgb, 1000, 255);
    assert_int_equal(palette.count, 4);
    struct kiln_dither *dither = kiln_dither_create(&palette);
    uint8_t indices[1000];
    for (uint32_t y = 0; y < 4; y++) {
        kiln_dither_row(dither, y, rgb, 1000, indices);
        for (size_t i = 0; i < 1000; i++)
            assert_memory_equal(palette.colors[indices[i]], rgb + 3 * i, 3);
    }
    kiln_dither_destroy(&dither);
    assert_null(dither);
}

static void no_more_colors_than_asked_for(void **state)
{
    (void)state;
    enum { PIXELS = 16 * 16 * 16 };
    uint8_t *rgb = malloc(3 * PIXELS);
    for (uint32_t i = 0; i < PIXELS; i++) {
        rgb[3 * i] = (uint8_t)(i % 16 * 17);
        rgb[3 * i + 1] = (uint8_t)(i / 16 % 16 * 17);
        rgb[3 * i + 2] = (uint8_t)(i / 256 * 17);
    }
    static const uint32_t most[] = {1, 2, 17, 255};
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(make(rgb, PIXELS, most[i]).count, most[i]);
    struct kiln_palette one = make(rgb, PIXELS, 1);
    for (int c = 0; c < 3; c++)
        assert_in_range(one.colors[0][c], 127, 128);
    assert_int_equal(make(rgb, 0, 255).count, 1);
    free(rgb);
}

/* A sky of many pixels leaves enough colours to a small flame. */
static void a_small_flame_gets_its_colors(void **state)
{
    (void)state;
    enum { SKY = 100000, FLAME = 500 };
    uint8_t *rgb = malloc(3 * (SKY + FLAME));
    for (uint32_t i = 0; i < SKY; i++) {
        const uint8_t sky[3] = {(uint8_t)(10 + i % 7), (uint8_t)(12 + i % 11),
                                (uint8_t)(20 + i % 29)};
        memcpy(rgb + (size_t)3 * i, sky, 3);
    }
    for (uint32_t i = 0; i < FLAME; i++) {
        const uint8_t flame[3] = {255, (uint8_t)(i * 200 / FLAME), (uint8_t)(i * 40 / FLAME)};
        memcpy(rgb + 3 * (size_t)(SKY + i), flame, 3);
    }
    struct kiln_palette palette = make(rgb, SKY + FLAME, 64);
    uint32_t bright = 0;
    for (uint32_t i = 0; i < palette.count; i++)
        bright += palette.colors[i][0] > 200;
    assert_in_range(bright, 16, 60);
    free(rgb);
}

/* What a palette lacks is mixed: over a square of the pattern, the average is the colour. */
static void mixes_keep_the_average(void **state)
{
    (void)state;
    uint8_t rgb[3 * 64];
    const uint8_t corners[3 * 8] = {0, 0, 0,   255, 0, 0,   0, 255, 0,   255, 255, 0,
                                    0, 0, 255, 255, 0, 255, 0, 255, 255, 255, 255, 255};
    struct kiln_palette palette = make(corners, 8, 255);
    assert_int_equal(palette.count, 8);
    struct kiln_dither *dither = kiln_dither_create(&palette);
    for (uint32_t level = 0; level < 256; level += 5) {
        const uint8_t color[3] = {(uint8_t)level, (uint8_t)(255 - level), (uint8_t)(level / 2)};
        for (size_t i = 0; i < 64; i++)
            memcpy(rgb + 3 * i, color, 3);
        double sum[3] = {0};
        uint8_t indices[64], again[64];
        for (uint32_t y = 0; y < 64; y++) {
            kiln_dither_row(dither, y, rgb, 64, indices);
            kiln_dither_row(dither, y, rgb, 64, again);
            assert_memory_equal(indices, again, sizeof indices);
            for (size_t i = 0; i < 64; i++) {
                for (int c = 0; c < 3; c++)
                    sum[c] += palette.colors[indices[i]][c];
            }
        }
        for (int c = 0; c < 3; c++)
            assert_true(fabs(sum[c] / 4096 - color[c]) < 9); /* a mix has 16 parts */
    }
    kiln_dither_destroy(&dither);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_colors_stay_exact),
        cmocka_unit_test(no_more_colors_than_asked_for),
        cmocka_unit_test(a_small_flame_gets_its_colors),
        cmocka_unit_test(mixes_keep_the_average),
    };
    return cmocka_run_group_tests_name("palette", tests, NULL, NULL);
}
