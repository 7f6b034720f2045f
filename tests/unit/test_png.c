/* PNG files read back by libpng: pixels, alpha, depth, colour space and metadata. */
#include <png.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

struct decoded {
    png_structp png;
    png_infop info;
};

static struct decoded read_png(const char *path)
{
    struct decoded decoded = {.png =
                                  png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL)};
    decoded.info = png_create_info_struct(decoded.png);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    png_init_io(decoded.png, file);
    png_read_png(decoded.png, decoded.info, PNG_TRANSFORM_IDENTITY, NULL);
    fclose(file);
    return decoded;
}

static const char *find_text(const struct decoded *decoded, const char *key)
{
    png_textp texts = NULL;
    int count = 0;
    png_get_text(decoded->png, decoded->info, &texts, &count);
    for (int i = 0; i < count; i++) {
        if (strcmp(texts[i].key, key) == 0)
            return texts[i].text;
    }
    return "";
}

static void check_pixels(const struct decoded *decoded, const struct kiln_output_params *params,
                         uint32_t frame)
{
    png_bytepp rows = png_get_rows(decoded->png, decoded->info);
    int channels = params->alpha ? 4 : 3;
    for (uint32_t y = 0; y < params->height; y++) {
        for (uint32_t x = 0; x < params->width; x++) {
            for (int c = 0; c < channels; c++) {
                size_t i = (size_t)x * (size_t)channels + (size_t)c;
                uint32_t level = test_level(frame, params->width, x, y, c);
                if (params->png_bits == 8)
                    assert_int_equal(rows[y][i], level);
                else
                    assert_int_equal(rows[y][i * 2] * 256 + rows[y][i * 2 + 1], level * 256 + x);
            }
        }
    }
}

static void pixels_and_metadata_come_back(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.png", folder);
    const struct kiln_frame_range range = {12, 12};
    for (int variant = 0; variant < 4; variant++) {
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = 61;
        params.height = 7;
        params.alpha = variant & 1;
        params.png_bits = variant & 2 ? 16 : 8;
        params.overwrite = true;
        struct kiln_error error = {0};
        bool good = test_write_all(&params, &error);
        assert_string_equal(error.message, "");
        assert_true(good);

        struct decoded decoded = read_png(path);
        assert_int_equal(png_get_image_width(decoded.png, decoded.info), params.width);
        assert_int_equal(png_get_image_height(decoded.png, decoded.info), params.height);
        assert_int_equal(png_get_bit_depth(decoded.png, decoded.info), params.png_bits);
        assert_int_equal(png_get_color_type(decoded.png, decoded.info),
                         params.alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB);
        check_pixels(&decoded, &params, 12);
        int intent = -1;
        assert_true(png_get_sRGB(decoded.png, decoded.info, &intent) != 0);
        assert_true(png_get_valid(decoded.png, decoded.info, PNG_INFO_gAMA | PNG_INFO_cHRM) ==
                    (PNG_INFO_gAMA | PNG_INFO_cHRM));
        assert_string_equal(find_text(&decoded, "kiln:scene"), test_scene_hash);
        assert_string_equal(find_text(&decoded, "kiln:seed"), "4000000007");
        assert_string_equal(find_text(&decoded, "kiln:frame"), "12");
        assert_string_equal(find_text(&decoded, "kiln:version"), KILN_VERSION);
        png_destroy_read_struct(&decoded.png, &decoded.info, NULL);
    }
    test_remove_folder(folder);
}

static void other_depths_are_refused(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {0, 0};
    struct kiln_output_params params = test_output_params("x.png", &range);
    params.png_bits = 12;
    struct kiln_error error = {0};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE, "found 12 bits a channel for a PNG; allowed are 8 or 16");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_and_metadata_come_back),
        cmocka_unit_test(other_depths_are_refused),
    };
    return cmocka_run_group_tests_name("png", tests, NULL, NULL);
}
