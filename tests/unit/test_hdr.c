/* Radiance pictures as data and as skies. If this fails, heights of a terrain change with what a
 * program notes in a picture's header, or a sky of the most common format of skies is refused. The
 * files are those of tests/pictures/hdr, which pictures.hdr compares with what other programs read
 * of them. */
#include <stdint.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/errors.h"

#define FILES KILN_SOURCE_DIR "/tests/pictures/hdr/"

typedef struct kiln_asset_image *load_function(struct kiln_loader *loader, const char *path,
                                               struct kiln_error *error);

/* Loads a picture and returns its first pixel and its size. */
static void load(load_function *function, const char *path, float pixel[4], uint32_t size[2])
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = function(NULL, path, &error);
    assert_string_equal(error.message, "");
    assert_non_null(image);
    assert_int_equal(image->type, KILN_IMAGE_F32);
    assert_int_equal(image->channels, 3);
    assert_false(image->srgb);
    for (int i = 0; i < 4; i++)
        pixel[i] = ((const float *)image->pixels)[i];
    size[0] = image->width;
    size[1] = image->height;
    kiln_asset_image_destroy(&image);
}

static void expect_pixel(const float pixel[4], float red, float green, float blue)
{
    const float expected[4] = {red, green, blue, 1.0f};
    for (int i = 0; i < 4; i++)
        assert_float_equal(pixel[i], expected[i], 0.0f);
}

/* The first pixel of all files has the mantissas 200, 128 and 13, and the exponent 128. */
static void a_sky_is_light(void **state)
{
    (void)state;
    float pixel[4];
    uint32_t size[2];
    load(kiln_asset_image_load_sky, FILES "packed.hdr", pixel, size);
    expect_pixel(pixel, 0.78125f, 0.5f, 0.05078125f);
    load(kiln_asset_image_load_sky, FILES "exposure.hdr", pixel, size); /* 4 times 0.5 */
    expect_pixel(pixel, 0.390625f, 0.25f, 0.025390625f);
    load(kiln_asset_image_load_sky, FILES "turned_5.hdr", pixel, size);
    assert_int_equal(size[0], 24);
    assert_int_equal(size[1], 16);
}

static void data_are_as_stored(void **state)
{
    (void)state;
    static const char *const names[] = {FILES "exposure.hdr", FILES "colorcorr.hdr",
                                        FILES "turned_5.hdr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        float pixel[4];
        uint32_t size[2];
        load(kiln_asset_image_load_data, names[i], pixel, size);
        expect_pixel(pixel, 0.78125f, 0.5f, 0.05078125f);
        assert_int_equal(size[0], i < 2 ? 24 : 16);
        assert_int_equal(size[1], i < 2 ? 16 : 24);
    }
}

/* A line that starts like the signature of another file, "# A comment", is not one. */
static void other_texts_are_no_pictures(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    static const char text[] = "# A comment\n";
    assert_null(kiln_asset_image_parse(text, sizeof text - 1, "text", &error));
    expect_error(
        &error, KILN_INVALID_INPUT,
        "text: the file is not an image: it starts with the bytes 23 20 41 20; allowed are "
        "PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sky_is_light),
        cmocka_unit_test(data_are_as_stored),
        cmocka_unit_test(other_texts_are_no_pictures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
