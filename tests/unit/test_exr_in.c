/* lib/asset/exr_in: the layers that kiln writes come back, and what is broken is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "asset/exr_in.h"
#include "asset/file_in.h"
#include "support/pictures.h"

/* Writes frame 5 of the test picture and returns the file's bytes. */
static unsigned char *write_exr(uint32_t bits, size_t *size)
{
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.exr", folder);
    const struct kiln_frame_range range = {5, 5};
    struct kiln_output_params params = test_output_params(path, &range);
    params.exr_bits = bits;
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    unsigned char *bytes = kiln_file_read(path, "image", "EXR", 1 << 20, size, &error);
    assert_non_null(bytes);
    test_remove_folder(folder);
    return bytes;
}

static void layers_come_back(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t layer, channels;
    } layers[] = {{"beauty", 0, 4}, {"depth", 1, 1}, {"fire", 2, 4}};
    for (uint32_t bits = 16; bits <= 32; bits += 16) {
        size_t size = 0;
        unsigned char *bytes = write_exr(bits, &size);
        for (size_t i = 0; i < 3; i++) {
            struct kiln_error error = {0};
            struct kiln_asset_image *image =
                kiln_exr_parse(bytes, size, "x.exr", layers[i].name, &error);
            assert_string_equal(error.message, "");
            assert_int_equal(image->width, 64);
            assert_int_equal(image->height, 36);
            assert_int_equal(image->channels, layers[i].channels);
            assert_int_equal(image->type, KILN_IMAGE_F32);
            assert_true(image->premultiplied && !image->srgb);
            const float *pixel = image->pixels;
            for (uint32_t p = 0; p < 64 * 36; p++, pixel += 4) {
                for (uint32_t c = 0; c < 4; c++) {
                    float expected = test_layer_value(5, p % 64, p / 64, layers[i].layer,
                                                      layers[i].channels == 1 ? 0 : c);
                    if (layers[i].channels == 1 && c == 3)
                        expected = 1.0f;
                    assert_true(pixel[c] == expected);
                }
            }
            kiln_asset_image_destroy(&image);
        }
        free(bytes);
    }
}

static void assert_refused(const unsigned char *bytes, size_t size, const char *layer,
                           const char *words)
{
    struct kiln_error error = {0};
    assert_null(kiln_exr_parse(bytes, size, "x.exr", layer, &error));
    assert_int_equal(error.code, KILN_INVALID_INPUT);
    if (!strstr(error.message, words))
        fail_msg("'%s' does not say '%s'", error.message, words);
}

static void an_unknown_layer_is_refused(void **state)
{
    (void)state;
    size_t size = 0;
    unsigned char *bytes = write_exr(16, &size);
    assert_refused(bytes, size, "smoke",
                   "x.exr: no layer 'smoke' in lines of full size; the file has the channels A, B, "
                   "G, R, Z, fire.A, fire.B, fire.G, fire.R");
    assert_refused(bytes, size, "fir", "no layer 'fir'");
    assert_refused(bytes, size, "", "no layer ''");
    free(bytes);
}

/* At any length, and also for a layer whose pixels would all be there. */
static void a_file_that_was_cut_short_is_refused(void **state)
{
    (void)state;
    size_t size = 0;
    unsigned char *bytes = write_exr(16, &size);
    for (size_t length = 0; length < size; length += 1 + length / 16)
        assert_refused(bytes, length, "beauty", "x.exr: ");
    assert_refused(bytes, size - 1, "beauty", "broken or cut short");
    free(bytes);
}

static void other_bytes_are_refused(void **state)
{
    (void)state;
    unsigned char zeros[256] = {0};
    assert_refused(zeros, sizeof zeros, "beauty", "broken or cut short");
    assert_false(kiln_exr_is_tiled(zeros, sizeof zeros));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_come_back),
        cmocka_unit_test(an_unknown_layer_is_refused),
        cmocka_unit_test(a_file_that_was_cut_short_is_refused),
        cmocka_unit_test(other_bytes_are_refused),
    };
    return cmocka_run_group_tests_name("exr_in", tests, NULL, NULL);
}
