/* lib/asset/exr_in: the layers that kiln writes come back, and what is broken is refused. */
#include <openexr.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "base/file_in.h"
#include "decode.h"
#include "support/cmocka.h"
#include "support/errors.h"
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

static struct kiln_asset_image *parse(const unsigned char *bytes, size_t size, const char *layer,
                                      struct kiln_error *error)
{
    struct decode_picture picture = {.bytes = bytes,
                                     .size = size,
                                     .format = KILN_PICTURE_EXR,
                                     .layer = layer,
                                     .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                     .error = error};
    return decode_exr(&picture);
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
            struct kiln_asset_image *image = parse(bytes, size, layers[i].name, &error);
            assert_string_equal(error.message, "");
            assert_int_equal(image->width, 64);
            assert_int_equal(image->height, 36);
            assert_int_equal(image->channels, layers[i].channels);
            assert_int_equal(image->type, KILN_IMAGE_F32);
            assert_int_equal(image->premultiplied, layers[i].channels == 4);
            assert_false(image->srgb);
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

/* OpenEXR says in its own words what is wrong. */
static void assert_broken(const unsigned char *bytes, size_t size)
{
    struct kiln_error error = {0};
    assert_null(parse(bytes, size, "beauty", &error));
    expect_error_around(&error, KILN_INVALID_INPUT, ")", "the EXR image is broken or cut short (");
}

static void an_unknown_layer_is_refused(void **state)
{
    (void)state;
    static const char *const unknown[] = {"smoke", "fir", ""};
    size_t size = 0;
    unsigned char *bytes = write_exr(16, &size);
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        struct kiln_error error = {0};
        assert_null(parse(bytes, size, unknown[i], &error));
        expect_error(&error, KILN_INVALID_INPUT,
                     "no layer '%s'; the file has the channels A, B, G, "
                     "R, Z, fire.A, fire.B, fire.G, fire.R",
                     unknown[i]);
    }
    free(bytes);
}

/* At any length, and also for a layer whose pixels would all be there. */
static void a_file_that_was_cut_short_is_refused(void **state)
{
    (void)state;
    size_t size = 0;
    unsigned char *bytes = write_exr(16, &size);
    for (size_t length = 0; length < size; length += 1 + length / 16)
        assert_broken(bytes, length);
    assert_broken(bytes, size - 1);
    free(bytes);
}

static void other_bytes_are_refused(void **state)
{
    (void)state;
    unsigned char zeros[256] = {0};
    assert_broken(zeros, sizeof zeros);
}

enum { TILED_SIZE = 12, TILE = 8 };

static void write_tile(exr_context_t file, int x, int y, exr_encode_pipeline_t *pipeline)
{
    exr_chunk_info_t chunk;
    float values[TILE * TILE];
    for (int i = 0; i < TILE * TILE; i++)
        values[i] = (float)(100 * (y * TILE + i / TILE) + x * TILE + i % TILE);
    assert_int_equal(exr_write_tile_chunk_info(file, 0, x, y, 0, 0, &chunk), EXR_ERR_SUCCESS);
    bool first = x == 0 && y == 0;
    assert_int_equal(first ? exr_encoding_initialize(file, 0, &chunk, pipeline)
                           : exr_encoding_update(file, 0, &chunk, pipeline),
                     EXR_ERR_SUCCESS);
    for (int i = 0; i < pipeline->channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = 4;
        channel->user_pixel_stride = 4;
        channel->user_line_stride = TILE * 4;
        channel->encode_from_ptr = (const uint8_t *)values;
    }
    if (first)
        assert_int_equal(exr_encoding_choose_default_routines(file, 0, pipeline), EXR_ERR_SUCCESS);
    assert_int_equal(exr_encoding_run(file, 0, pipeline), EXR_ERR_SUCCESS);
}

static void write_tiled(const char *path)
{
    exr_context_t file;
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    int part = 0;
    assert_int_equal(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &initializer),
                     EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_part(file, "tiled", EXR_STORAGE_TILED, &part), EXR_ERR_SUCCESS);
    assert_int_equal(exr_initialize_required_attr_simple(file, part, TILED_SIZE, TILED_SIZE,
                                                         EXR_COMPRESSION_NONE),
                     EXR_ERR_SUCCESS);
    assert_int_equal(
        exr_set_tile_descriptor(file, part, TILE, TILE, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN),
        EXR_ERR_SUCCESS);
    static const char *const names[] = {"R", "G", "B"};
    for (int i = 0; i < 3; i++)
        assert_int_equal(exr_add_channel(file, part, names[i], EXR_PIXEL_FLOAT,
                                         EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1),
                         EXR_ERR_SUCCESS);
    assert_int_equal(exr_write_header(file), EXR_ERR_SUCCESS);
    for (int i = 0; i < 4; i++)
        write_tile(file, i % 2, i / 2, &pipeline);
    exr_encoding_destroy(file, &pipeline);
    assert_int_equal(exr_finish(&file), EXR_ERR_SUCCESS);
}

static void tiles_are_read(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/tiled.exr", folder);
    write_tiled(path);
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load_layer(NULL, path, "beauty", &error);
    assert_string_equal(error.message, "");
    assert_int_equal(image->channels, 3);
    for (int i = 0; i < TILED_SIZE * TILED_SIZE; i++) {
        float found = ((const float *)image->pixels)[4 * i];
        assert_true(found == (float)(100 * (i / TILED_SIZE) + i % TILED_SIZE));
    }
    kiln_asset_image_destroy(&image);
    assert_null(kiln_asset_image_load_layer(NULL, path, "fire", &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: no layer 'fire'; the file has the channels B, G, R", path);
    test_remove_folder(folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_come_back),
        cmocka_unit_test(an_unknown_layer_is_refused),
        cmocka_unit_test(a_file_that_was_cut_short_is_refused),
        cmocka_unit_test(other_bytes_are_refused),
        cmocka_unit_test(tiles_are_read),
    };
    return cmocka_run_group_tests_name("exr_in", tests, NULL, NULL);
}
