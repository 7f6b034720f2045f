/* Frames as JPEG: pixels near those that were given, files that say what they are, and only whole
 * ones counted as such. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "output/carried.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

static const struct kiln_frame_range one_frame = {7, 7};

/* Writes frame 7 into the folder. Returns its bytes, which the caller frees. */
static uint8_t *write_frame(const char *folder, uint32_t quality, char path[64], size_t *size)
{
    struct kiln_error error = {0};
    snprintf(path, 64, "%s/q%u.jpg", folder, quality);
    struct kiln_output_params params = test_output_params(path, &one_frame);
    params.quality = quality;
    assert_true(test_write_all(&params, &error));
    FILE *file = fopen(path, "rb");
    uint8_t *bytes = malloc(1 << 20);
    assert_non_null(file);
    assert_non_null(bytes);
    *size = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

static double mean_error(const uint8_t *bytes, size_t size)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, "x.jpg", &error);
    assert_non_null(image);
    assert_int_equal(image->width, 64);
    assert_int_equal(image->height, 36);
    const uint8_t *pixels = (const uint8_t *)image->pixels;
    double sum = 0;
    for (uint32_t y = 0; y < 36; y++)
        for (uint32_t x = 0; x < 64; x++)
            for (int c = 0; c < 3; c++)
                sum +=
                    abs((int)test_level(7, 64, x, y, c) - pixels[(y * 64 + x) * 4 + (uint32_t)c]);
    kiln_asset_image_destroy(&image);
    return sum / (64.0 * 36 * 3);
}

/* More quality is more bytes and less error; the same quality is the same bytes. */
static void quality_buys_pixels(void **state)
{
    (void)state;
    static const uint32_t qualities[] = {0, 25, 50, 80, 100};
    char folder[32], path[64];
    size_t size_before = 0;
    double error_before = 256;
    test_make_folder(folder);
    for (size_t i = 0; i < 5; i++) {
        size_t size, again_size;
        uint8_t *bytes = write_frame(folder, qualities[i], path, &size);
        unlink(path);
        uint8_t *again = write_frame(folder, qualities[i], path, &again_size);
        const double error = mean_error(bytes, size);
        print_message("quality %u: %zu bytes, mean error %.2f of 255\n", qualities[i], size, error);
        assert_int_equal(size, again_size);
        assert_memory_equal(bytes, again, size);
        assert_true(size > size_before);
        assert_true(error < error_before);
        size_before = size;
        error_before = error;
        free(bytes);
        free(again);
    }
    assert_true(error_before < 0.8);
    test_remove_folder(folder);
}

static void put(const char *path, const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* A file counts as the frame only when all of it is there, and of the same quality. */
static void whole_files_are_known(void **state)
{
    (void)state;
    char folder[32], path[64];
    size_t size;
    struct kiln_error error = {0};
    test_make_folder(folder);
    uint8_t *bytes = write_frame(folder, 80, path, &size);
    struct kiln_output_params params = test_output_params(path, &one_frame);
    params = kiln_output_complete(&params, &error);
    assert_true(kiln_output_carries(&params, path, 7, &error));
    assert_false(kiln_output_carries(&params, path, 8, &error));
    params.quality = 81;
    assert_false(kiln_output_carries(&params, path, 7, &error));
    params.quality = 80;

    struct kiln_carried carried;
    assert_true(kiln_carried_read(path, &carried, &error));
    assert_string_equal(carried.scene, test_scene_hash);
    assert_string_equal(carried.seed, "4000000007");
    assert_string_equal(carried.fps, "30/1");
    assert_int_equal(carried.bits, 8);

    for (size_t cut = 0; cut < size; cut++) {
        put(path, bytes, cut);
        assert_false(kiln_output_carries(&params, path, 7, &error));
    }
    bytes = realloc(bytes, size + 1);
    assert_non_null(bytes);
    bytes[size] = 0;
    put(path, bytes, size + 1);
    assert_false(kiln_output_carries(&params, path, 7, &error));
    free(bytes);
    test_remove_folder(folder);
}

static void what_it_cannot_hold_is_refused(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_output_params params = test_output_params("x.jpg", &one_frame);
    params.alpha = true;
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE,
                 "x.jpg: the backdrop is transparent, but a JPEG image has no alpha; write .png or "
                 ".exr, or make the backdrop opaque");
    params.alpha = false;
    params.quality = 101;
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE, "x.jpg: found quality 101; allowed are 0 to 100");
    params.quality = 80;
    params.flipbook = (struct kiln_flipbook){.columns = 1, .rows = 1};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE, "x.jpg: a flipbook is one .png file, not .jpg");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quality_buys_pixels),
        cmocka_unit_test(whole_files_are_known),
        cmocka_unit_test(what_it_cannot_hold_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
