/* EXR files read back by OpenEXR's C core: channels, values, kinds of numbers and metadata. */
#include <math.h>
#include <openexr.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

/* Reads one channel whole, as float. */
static float *read_channel(exr_context_t file, const char *name, int width, int height)
{
    float *values = malloc((size_t)width * (size_t)height * sizeof *values);
    assert_non_null(values);
    int32_t lines = 0;
    bool found = false;
    assert_int_equal(exr_get_scanlines_per_chunk(file, 0, &lines), EXR_ERR_SUCCESS);
    for (int y = 0; y < height; y += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(file, 0, y, &chunk), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_initialize(file, 0, &chunk, &pipeline), EXR_ERR_SUCCESS);
        for (int i = 0; i < pipeline.channel_count; i++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[i];
            if (strcmp(channel->channel_name, name) != 0)
                continue;
            found = true;
            channel->decode_to_ptr = (uint8_t *)(values + (size_t)y * (size_t)width);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = 4;
            channel->user_pixel_stride = 4;
            channel->user_line_stride = width * 4;
        }
        assert_int_equal(exr_decoding_choose_default_routines(file, 0, &pipeline), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(file, 0, &pipeline), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_destroy(file, &pipeline), EXR_ERR_SUCCESS);
    }
    assert_true(found);
    return values;
}

/* Integers up to 2048 and eighths below 256 are exact as halves. */
static void check_channel(exr_context_t file, const struct kiln_output_params *params,
                          const char *name, uint32_t layer, uint32_t component)
{
    float *values = read_channel(file, name, (int)params->width, (int)params->height);
    for (uint32_t y = 0; y < params->height; y++) {
        for (uint32_t x = 0; x < params->width; x++)
            assert_true(values[y * params->width + x] ==
                        test_layer_value(params->ranges[0].first, x, y, layer, component));
    }
    free(values);
}

static void check_text(exr_context_t file, const char *name, const char *expected)
{
    const char *text = NULL;
    int32_t length = 0;
    assert_int_equal(exr_attr_get_string(file, 0, name, &length, &text), EXR_ERR_SUCCESS);
    assert_string_equal(text, expected);
}

static void check_header(exr_context_t file, const struct kiln_output_params *params)
{
    static const char *const names[] = {"A",      "B",      "G",      "R",     "Z",
                                        "fire.A", "fire.B", "fire.G", "fire.R"};
    const exr_attr_chlist_t *list = NULL;
    assert_int_equal(exr_get_channels(file, 0, &list), EXR_ERR_SUCCESS);
    assert_int_equal(list->num_channels, 9);
    for (int i = 0; i < 9; i++) {
        bool wide = params->exr_bits == 32 || strcmp(names[i], "Z") == 0;
        assert_string_equal(list->entries[i].name.str, names[i]);
        assert_int_equal(list->entries[i].pixel_type, wide ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF);
    }
    exr_attr_box2i_t window;
    assert_int_equal(exr_get_data_window(file, 0, &window), EXR_ERR_SUCCESS);
    assert_int_equal(window.max.x, params->width - 1);
    assert_int_equal(window.max.y, params->height - 1);
    exr_attr_chromaticities_t colours;
    assert_int_equal(exr_attr_get_chromaticities(file, 0, "chromaticities", &colours),
                     EXR_ERR_SUCCESS);
    assert_true(colours.red_x == 0.64f && colours.white_y == 0.329f);
    exr_attr_rational_t rate;
    assert_int_equal(exr_attr_get_rational(file, 0, "framesPerSecond", &rate), EXR_ERR_SUCCESS);
    assert_int_equal(rate.num, 30);
    check_text(file, "kiln:scene", test_scene_hash);
    check_text(file, "kiln:seed", "4000000007");
    check_text(file, "kiln:frame", "5");
    check_text(file, "kiln:version", KILN_VERSION);
}

static void values_and_metadata_come_back(void **state)
{
    (void)state;
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.exr", folder);
    const struct kiln_frame_range range = {5, 5};
    for (uint32_t bits = 16; bits <= 32; bits += 16) {
        struct kiln_output_params params = test_output_params(path, &range);
        params.width = 53;
        params.height = 37; /* the last chunk is a short one */
        params.exr_bits = bits;
        params.overwrite = true;
        struct kiln_error error = {0};
        bool good = test_write_all(&params, &error);
        assert_string_equal(error.message, "");
        assert_true(good);

        exr_context_t file = NULL;
        assert_int_equal(exr_start_read(&file, path, NULL), EXR_ERR_SUCCESS);
        check_header(file, &params);
        check_channel(file, &params, "R", 0, 0);
        check_channel(file, &params, "A", 0, 3);
        check_channel(file, &params, "Z", 1, 0);
        check_channel(file, &params, "fire.G", 2, 1);
        check_channel(file, &params, "fire.B", 2, 2);
        exr_finish(&file);
    }
    test_remove_folder(folder);
}

/* Holds an EXR file of one frame, before and after it is written. */
struct written {
    char folder[32], path[64];
    struct kiln_frame_range range;
    struct kiln_output_params params;
    struct kiln_output *output;
    struct kiln_picture *picture; /* the test may change it; the output takes it */
    exr_context_t file;
};

static void begin_file(struct written *w, uint32_t bits)
{
    struct kiln_error error = {0};
    *w = (struct written){.range = {0, 0}};
    test_make_folder(w->folder);
    snprintf(w->path, sizeof w->path, "%s/x.exr", w->folder);
    w->params = test_output_params(w->path, &w->range);
    w->params.exr_bits = bits;
    w->output = kiln_output_open(&w->params, &error);
    assert_non_null(w->output);
    w->picture = test_picture(w->output, &w->params, 0);
}

static void write_file(struct written *w)
{
    struct kiln_error error = {0};
    assert_true(kiln_output_write(w->output, w->picture, &error));
    assert_true(kiln_output_finish(w->output, &error));
    kiln_output_close(&w->output);
    assert_int_equal(exr_start_read(&w->file, w->path, NULL), EXR_ERR_SUCCESS);
}

static void remove_file(struct written *w)
{
    exr_finish(&w->file);
    test_remove_folder(w->folder);
}

/* Brighter than a half can say stays finite; depth keeps every bit, infinity too. */
static void extremes_survive(void **state)
{
    (void)state;
    struct written w;
    begin_file(&w, 16);
    w.picture->layers[0].pixels[0] = 1e9f;
    w.picture->layers[0].pixels[1] = -1e9f;
    w.picture->layers[1].pixels[0] = 1e9f + 64.0f;
    w.picture->layers[1].pixels[1] = INFINITY;
    write_file(&w);
    float *red = read_channel(w.file, "R", 64, 36), *green = read_channel(w.file, "G", 64, 36);
    float *depth = read_channel(w.file, "Z", 64, 36);
    assert_true(red[0] == 65504.0f && green[0] == -65504.0f);
    assert_true(depth[0] == 1e9f + 64.0f && isinf(depth[1]));
    free(red);
    free(green);
    free(depth);
    remove_file(&w);
}

static void fill_with_noise(struct kiln_layer *layer, size_t pixels, uint32_t seed)
{
    for (size_t i = 0; i < pixels * layer->channels; i++) {
        seed = seed * 1664525u + 1013904223u;
        const uint32_t bits = seed & 0xbfffffffu; /* no infinity */
        memcpy(&layer->pixels[i], &bits, sizeof bits);
    }
}

/* A chunk that compression would not make smaller is stored as it is. */
static void noise_survives(void **state)
{
    (void)state;
    struct written w;
    begin_file(&w, 32);
    const size_t pixels = (size_t)w.params.width * w.params.height;
    for (uint32_t i = 0; i < w.picture->layer_count; i++)
        fill_with_noise(&w.picture->layers[i], pixels, i);
    float *expected = malloc(pixels * sizeof *expected);
    assert_non_null(expected);
    memcpy(expected, w.picture->layers[1].pixels, pixels * sizeof *expected);
    write_file(&w);
    float *depth = read_channel(w.file, "Z", (int)w.params.width, (int)w.params.height);
    assert_memory_equal(depth, expected, pixels * sizeof *expected);
    free(depth);
    free(expected);
    remove_file(&w);
}

static void other_depths_are_refused(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {0, 0};
    struct kiln_output_params params = test_output_params("x.exr", &range);
    params.exr_bits = 24;
    struct kiln_error error = {0};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE,
                 "found 24 bits a channel for an EXR; allowed are 16 (half) or 32 (float)");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_and_metadata_come_back),
        cmocka_unit_test(extremes_survive),
        cmocka_unit_test(noise_survives),
        cmocka_unit_test(other_depths_are_refused),
    };
    return cmocka_run_group_tests_name("exr", tests, NULL, NULL);
}
