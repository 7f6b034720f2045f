/* decode/exr*.c: EXR files of other programs are read as those programs read them. If this fails,
 * kiln misreads strangers' pictures. tests/exr has the files, and beside each the numbers that
 * another reader finds in it: oiiotool 2.4.7, for yca.exr OpenEXR's RgbaInputFile, and for the
 * files "wide", whose primaries are those of ACES, RgbaInputFile and Bradford's matrix by NumPy. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "base/file_in.h"
#include "decode.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/exr_file.h"

#define FOLDER KILN_SOURCE_DIR "/tests/exr/"

/* Compares a picture with the numbers of a text. tolerance: allowed difference, for numbers above 1
 * relative to them. */
static void compare(const char *name, const struct kiln_asset_image *image, double tolerance)
{
    char path[512];
    struct kiln_error error = {0};
    size_t size = 0;
    snprintf(path, sizeof path, FOLDER "%s.txt", name);
    char *text = (char *)kiln_file_read(path, "text", "text", 1 << 20, &size, &error);
    assert_non_null(text);
    text[size - 1] = '\0';
    char *rest = text;
    const unsigned long width = strtoul(rest, &rest, 10), height = strtoul(rest, &rest, 10);
    const unsigned long channels = strtoul(rest, &rest, 10);
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    assert_int_equal(image->channels, channels);
    const float *pixel = image->pixels;
    for (size_t i = 0; i < (size_t)(width * height); i++, pixel += 4) {
        for (unsigned c = 0; c < channels; c++) {
            assert_true(*rest);
            const double expected = strtod(rest, &rest);
            const double most = tolerance * fmax(1.0, fabs(expected));
            if (!(fabs((double)pixel[c] - expected) <= most))
                fail_msg("%s: pixel %zu, channel %u is %.9g, expected %.9g", name, i, c,
                         (double)pixel[c], expected);
        }
        if (channels == 3)
            assert_true(pixel[3] == 1.0f);
    }
    free(text);
}

static struct kiln_asset_image *load(const char *name, const char *layer)
{
    char path[512];
    struct kiln_error error = {0};
    snprintf(path, sizeof path, FOLDER "%s.exr", name);
    struct kiln_asset_image *image = kiln_asset_image_load_layer(NULL, path, layer, &error);
    assert_string_equal(error.message, "");
    return image;
}

static void files_are_read_as_others_read_them(void **state)
{
    (void)state;
    /* Text has nine digits. RgbaInputFile rounds to half floats, DWA is computed in floats. */
    static const double text = 1e-8, half = 2.5e-3, dwa = 2e-3;
    const struct {
        const char *name;
        double tolerance;
    } files[] = {{"piz_tiles", text}, {"pxr24", text},     {"b44a", text}, {"mip", text},
                 {"b44_float", text}, {"window", text},    {"crop", text}, {"deep", 1e-6},
                 {"dwaa", dwa},       {"dwab_tiles", dwa}, {"yca", half},  {"wide", 1e-6},
                 {"wide_yc", half}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct kiln_asset_image *image = load(files[i].name, "beauty");
        compare(files[i].name, image, files[i].tolerance);
        kiln_asset_image_destroy(&image);
    }
}

/* Each channel of the file holds one number everywhere: ten times the part's, and its place in the
 * part. */
static void layers_of_all_parts_are_found(void **state)
{
    (void)state;
    static const struct {
        const char *layer;
        uint32_t channels;
        float pixel[4];
    } layers[] = {
        {"beauty", 4, {1, 2, 3, 4}},           {"rgba", 4, {1, 2, 3, 4}},
        {"diffuse", 3, {11, 12, 13, 1}},       {"N", 3, {21, 22, 23, 1}},
        {"N.X", 1, {21, 21, 21, 1}},           {"depth", 1, {31, 31, 31, 1}},
        {"depth.Z", 1, {31, 31, 31, 1}},       {"spec", 3, {41, 42, 43, 1}},
        {"left.eye.spec", 3, {41, 42, 43, 1}}, {"id", 1, {44, 44, 44, 1}},
        {"left.eye.id", 1, {44, 44, 44, 1}},
    };
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct kiln_asset_image *image = load("parts", layers[i].layer);
        assert_int_equal(image->channels, layers[i].channels);
        for (size_t p = 0; p < (size_t)image->width * image->height; p++)
            assert_memory_equal((float *)image->pixels + 4 * p, layers[i].pixel, 16);
        kiln_asset_image_destroy(&image);
    }
    struct kiln_error error = {0};
    assert_null(kiln_asset_image_load_layer(NULL, FOLDER "parts.exr", "foo", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FOLDER "parts.exr: no layer 'foo'; the file has the channels rgba.A, rgba.B, "
                        "rgba.G, rgba.R, diffuse.B, diffuse.G, diffuse.R, N.X, N.Y, N.Z, depth.Z, "
                        "left.eye.id, left.eye.spec.B, left.eye.spec.G, left.eye.spec.R");
}

/* oiiotool --dumpdata lists the samples of each pixel: none, one at 10, two at 1 and 2, three at
 * 10, 9 and 8, and so on along each diagonal. */
static void data_of_deep_layers_are_those_of_the_nearest_sample(void **state)
{
    (void)state;
    static const float expected[] = {0, 10, 1, 8};
    struct kiln_asset_image *image = load("deep", "depth");
    const float *pixel = image->pixels;
    for (uint32_t i = 0; i < image->width * image->height; i++, pixel += 4)
        assert_true(*pixel == expected[(i % image->width + i / image->width) % 4]);
    kiln_asset_image_destroy(&image);
}

/* Data have no primaries. */
static void data_stay_raw(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load_data(NULL, FOLDER "wide.exr", &error);
    assert_string_equal(error.message, "");
    assert_true(((const float *)image->pixels)[0] == 2.0f);
    kiln_asset_image_destroy(&image);
}

static void a_cube_map_is_no_sky(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_asset_image *image = load("cube", "beauty");
    assert_int_equal(image->height, 48);
    kiln_asset_image_destroy(&image);
    assert_null(kiln_asset_image_load_sky(NULL, FOLDER "cube.exr", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FOLDER
                 "cube.exr: the EXR image is a cube map; a sky is a picture by longitude and "
                 "latitude");
}

/* ---- files of the test's own ----------------------------------------------------------------- */

static struct kiln_asset_image *parse(const struct exr_bytes *bytes, const char *layer,
                                      struct kiln_error *error)
{
    struct decode_picture picture = {.bytes = bytes->data,
                                     .size = bytes->size,
                                     .format = KILN_PICTURE_EXR,
                                     .layer = layer,
                                     .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                     .error = error};
    return decode_exr(&picture);
}

static void expect_pixel(const struct exr_bytes *bytes, const char *layer, uint32_t channels,
                         const float expected[4])
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = parse(bytes, layer, &error);
    assert_string_equal(error.message, "");
    assert_int_equal(image->channels, channels);
    const size_t last = (size_t)image->width * image->height - 1;
    assert_memory_equal(image->pixels, expected, 16);
    assert_memory_equal((float *)image->pixels + 4 * last, expected, 16);
    kiln_asset_image_destroy(&image);
}

static const int32_t small[4] = {0, 0, 3, 1};

/* OpenEXR's core writes to address 0 for three of four half floats. */
static void channels_of_all_types_are_taken(void **state)
{
    (void)state;
    enum { ONE = 0x3c00, TWO = 0x4000, THREE = 0x4200, LEAST = 0x8001, HALF = 1, FLOAT = 2 };
    struct exr_bytes bytes;
    static const struct exr_channel depth[] = {
        {"B", HALF, THREE, 1}, {"G", HALF, TWO, 1}, {"R", HALF, ONE, 1}, {"Z", HALF, LEAST, 1}};
    exr_file_write(&bytes, depth, 4, small, small);
    expect_pixel(&bytes, "beauty", 3, (float[]){1, 2, 3, 1});
    expect_pixel(&bytes, "depth", 1, (float[]){-0x1p-24f, -0x1p-24f, -0x1p-24f, 1});
    static const struct exr_channel mixed[] = {{"A", 0, 16777216, 1}, {"B", FLOAT, 0x40400000, 1},
                                               {"G", 0, 2, 1},        {"R", HALF, ONE, 1},
                                               {"id", 0, 7, 1},       {"x.R", HALF, TWO, 1}};
    exr_file_write(&bytes, mixed, 6, small, small);
    expect_pixel(&bytes, "beauty", 4, (float[]){1, 2, 3, 16777216});
    expect_pixel(&bytes, "id", 1, (float[]){7, 7, 7, 1});
    expect_pixel(&bytes, "x", 1, (float[]){2, 2, 2, 1});
}

static void expect_refusal(const struct exr_bytes *bytes, const char *layer, const char *message)
{
    struct kiln_error error = {0};
    assert_null(parse(bytes, layer, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

static void what_kiln_cannot_show_is_refused(void **state)
{
    (void)state;
    struct exr_bytes bytes;
    static const struct exr_channel large[] = {{"id", 0, 16777217, 1}};
    exr_file_write(&bytes, large, 1, small, small);
    expect_refusal(
        &bytes, "id",
        "the layer 'id' has the whole number 16777217, which no float equals; kiln reads "
        "whole numbers up to 16777216");
    static const struct exr_channel sparse[] = {{"B", 1, 0, 1}, {"G", 1, 0, 2}, {"R", 1, 0, 1}};
    exr_file_write(&bytes, sparse, 3, small, small);
    expect_refusal(
        &bytes, "beauty",
        "the channel 'G' has one sample for 2 x 2 pixels; kiln reads this only of RY and "
        "BY, with 2 x 2 pixels for both");
    static const struct exr_channel grey[] = {{"Y", 1, 0, 1}};
    static const int32_t wide[4] = {0, 0, 16384, 0}, high[4] = {0, -5, 0, 16379};
    static const char *const too_large =
        "EXR image of 16385 x 1 pixels; allowed are 1 to 16384 a side and at most 67108864 in all";
    exr_file_write(&bytes, grey, 1, small, wide);
    expect_refusal(&bytes, "beauty", too_large);
    exr_file_write(&bytes, grey, 1, high, small);
    expect_refusal(&bytes, "beauty",
                   "EXR image of 1 x 16385 pixels; allowed are 1 to 16384 a side and at most "
                   "67108864 in all");
}

/* d1 and d2 of the same numbers differ by the place of their data window alone. */
static void the_display_window_is_the_picture(void **state)
{
    (void)state;
    static const struct exr_channel grey[] = {{"Y", 2, 0x3f800000, 1}};
    static const int32_t data[2][4] = {{0, 0, 3, 1}, {5, 2, 8, 3}}, display[4] = {0, 0, 6, 4};
    struct exr_bytes bytes;
    for (int i = 0; i < 2; i++) {
        struct kiln_error error = {0};
        exr_file_write(&bytes, grey, 1, data[i], display);
        struct kiln_asset_image *image = parse(&bytes, "beauty", &error);
        assert_string_equal(error.message, "");
        assert_int_equal(image->width, 7);
        assert_int_equal(image->height, 5);
        for (int p = 0; p < 35; p++) {
            const int x = p % 7, y = p / 7;
            const bool inside =
                x >= data[i][0] && x <= data[i][2] && y >= data[i][1] && y <= data[i][3];
            const float *pixel = (const float *)image->pixels + (size_t)4 * (size_t)p;
            assert_true(pixel[0] == (inside ? 1.0f : 0.0f) && pixel[3] == 1.0f);
        }
        kiln_asset_image_destroy(&image);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_read_as_others_read_them),
        cmocka_unit_test(layers_of_all_parts_are_found),
        cmocka_unit_test(data_of_deep_layers_are_those_of_the_nearest_sample),
        cmocka_unit_test(data_stay_raw),
        cmocka_unit_test(a_cube_map_is_no_sky),
        cmocka_unit_test(channels_of_all_types_are_taken),
        cmocka_unit_test(what_kiln_cannot_show_is_refused),
        cmocka_unit_test(the_display_window_is_the_picture),
    };
    return cmocka_run_group_tests_name("exr_files", tests, NULL, NULL);
}
