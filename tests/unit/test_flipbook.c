/* Flipbooks: which frames, where they are in the atlas, alpha, padding, layout and motion. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "asset/image/image.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

static char folder[32], path[64];

static int make_folder(void **state)
{
    (void)state;
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/book.png", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    test_remove_folder(folder);
    return 0;
}

static void frames_are_spread_evenly(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_frame_range cells[64];
    const struct kiln_flipbook eight = {
        .size = sizeof(struct kiln_flipbook), .columns = 8, .rows = 8};
    const struct kiln_frame_range whole = {0, 127}, parts[] = {{10, 11}, {20, 29}};
    assert_true(kiln_flipbook_sample(&eight, &whole, 1, cells, &error));
    for (uint32_t i = 0; i < 64; i++) {
        assert_int_equal(cells[i].first, 2 * i);
        assert_int_equal(cells[i].last, 2 * i);
    }
    const struct kiln_flipbook few = {
        .size = sizeof(struct kiln_flipbook), .columns = 3, .rows = 2};
    static const uint32_t expected[] = {10, 20, 22, 24, 26, 28};
    assert_true(kiln_flipbook_sample(&few, parts, 2, cells, &error));
    for (size_t i = 0; i < 6; i++)
        assert_int_equal(cells[i].first, expected[i]);
    assert_false(kiln_flipbook_sample(&eight, parts, 2, cells, &error));
    expect_error(&error, KILN_USAGE,
                 "the 8 x 8 cells of a flipbook need more than the 12 frames that there "
                 "are; at least 64 are needed: take fewer cells, or a higher rate");
    const struct kiln_flipbook none = {
        .size = sizeof(struct kiln_flipbook), .columns = 0, .rows = 3};
    assert_false(kiln_flipbook_sample(&none, &whole, 1, cells, &error));
}

/* Writes frames 0, 3, 6, ... as cells. */
static void write_book(struct kiln_output_params *params, bool alpha)
{
    static struct kiln_frame_range cells[64];
    params->ranges = cells;
    params->range_count = params->flipbook.columns * params->flipbook.rows;
    params->alpha = alpha;
    for (uint32_t i = 0; i < params->range_count; i++)
        cells[i] = (struct kiln_frame_range){3 * i, 3 * i};
    struct kiln_error error = {0};
    bool good = test_write_all(params, &error);
    assert_string_equal(error.message, "");
    assert_true(good);
}

static struct kiln_asset_image *load(const char *ending)
{
    char name[64];
    struct kiln_error error = {0};
    snprintf(name, sizeof name, "%s/book%s", folder, ending);
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, name, &error);
    assert_string_equal(error.message, "");
    return image;
}

static char *read_text(const char *ending)
{
    static char text[8192];
    char name[64];
    snprintf(name, sizeof name, "%s/book%s", folder, ending);
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

static uint32_t sample(const struct kiln_asset_image *image, uint32_t x, uint32_t y, int channel)
{
    size_t at = 4 * ((size_t)y * image->width + x) + (size_t)channel;
    return image->type == KILN_IMAGE_U16 ? ((const uint16_t *)image->pixels)[at]
                                         : ((const uint8_t *)image->pixels)[at];
}

static uint32_t inside(uint32_t at, uint32_t padding, uint32_t size)
{
    int64_t i = (int64_t)at - padding;
    return i < 0 ? 0 : i >= (int64_t)size ? size - 1 : (uint32_t)i;
}

static void check_atlas(const struct kiln_output_params *params)
{
    const struct kiln_flipbook *book = &params->flipbook;
    uint32_t width = params->width + 2 * book->padding, height = params->height + 2 * book->padding;
    const uint32_t full = params->png_bits == 8 ? 255 : 65535;
    struct kiln_asset_image *image = load(".png");
    assert_int_equal(image->width, width * book->columns);
    assert_int_equal(image->height, height * book->rows);
    assert_int_equal(image->channels, params->alpha ? 4 : 3);
    for (uint32_t i = 0; i < image->width * image->height; i++) {
        uint32_t x = i % image->width, y = i / image->width;
        uint32_t frame = 3 * (y / height * book->columns + x / width);
        uint32_t px = inside(x % width, book->padding, params->width);
        uint32_t py = inside(y % height, book->padding, params->height);
        bool padded = px + book->padding != x % width || py + book->padding != y % height;
        uint32_t level[4];
        for (int c = 0; c < 4; c++) {
            level[c] = test_level(frame, params->width, px, py, c);
            level[c] = full == 255 ? level[c] : level[c] * 256 + px;
        }
        level[3] = !params->alpha ? full : padded ? 0 : level[3];
        for (int c = 0; c < 4; c++) {
            double wanted = level[c];
            if (c < 3 && book->premultiplied && params->alpha)
                wanted *= (double)level[3] / full;
            assert_true(fabs(sample(image, x, y, c) - wanted) <= 0.5);
        }
    }
    kiln_asset_image_destroy(&image);
}

static void cells_are_the_frames(void **state)
{
    (void)state;
    for (int i = 0; i < 16; i++) {
        struct kiln_output_params params = test_output_params(path, NULL);
        params.flipbook = (struct kiln_flipbook){
            .columns = 4, .rows = 3, .padding = i & 1 ? 3 : 0, .premultiplied = i & 2};
        params.png_bits = i & 4 ? 16 : 8;
        params.overwrite = i > 0;
        write_book(&params, i & 8);
        assert_int_equal(test_count_files(folder), 2);
        check_atlas(&params);
    }
}

/* A frame that is opaque up to its border fades out over a tenth of its shorter side: it is
 * transparent at the border, whole further inside, and never grows inwards. */
static void cells_fade_out_at_their_borders(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 8; i++) {
        struct kiln_output_params params = test_output_params(path, NULL);
        const struct kiln_frame_range range = {0, 0};
        params.ranges = &range;
        params.width = 96;
        params.height = 60;
        params.alpha = true;
        params.png_bits = i & 1 ? 16 : 8;
        params.overwrite = i > 0;
        const uint32_t padding = i & 2 ? 2 : 0, margin = 6, full = i & 1 ? 65535 : 255;
        params.flipbook = (struct kiln_flipbook){
            .columns = 1, .rows = 1, .padding = padding, .premultiplied = i & 4, .fade = 10};
        struct kiln_error error = {0};
        struct kiln_output *output = kiln_output_open(&params, &error);
        assert_string_equal(error.message, "");
        struct kiln_picture *picture = test_picture(output, &params, 0);
        memset(picture->display, 0xff, (size_t)4 * params.width * params.height * (i & 1 ? 2 : 1));
        assert_true(kiln_output_write(output, picture, &error));
        assert_true(kiln_output_finish(output, &error));
        kiln_output_close(&output);
        struct kiln_asset_image *image = load(".png");
        for (uint32_t y = 0; y < params.height; y++) {
            for (uint32_t x = 0; x < params.width; x++) {
                uint32_t dx = x < 48 ? x : 95 - x, dy = y < 30 ? y : 59 - y;
                uint32_t alpha = sample(image, x + padding, y + padding, 3);
                assert_true(dx == 0 || dy == 0 ? alpha == 0 : alpha > 0);
                assert_true(dx >= margin && dy >= margin ? alpha == full : alpha < full);
                if (dy >= margin && dx == margin / 2)
                    assert_true(abs((int)alpha - (int)full / 2) <= 1);
                assert_int_equal(sample(image, x + padding, y + padding, 0),
                                 params.flipbook.premultiplied ? alpha : full);
            }
        }
        assert_non_null(strstr(read_text(".json"), "\"fade\": 6}"));
        kiln_asset_image_destroy(&image);
    }
}

/* A pixel that nobody sees gets the colour of those beside it, not black. */
static void hidden_pixels_take_colors(void **state)
{
    (void)state;
    struct kiln_output_params params = test_output_params(path, NULL);
    const struct kiln_frame_range range = {0, 0};
    params.ranges = &range;
    params.alpha = true;
    params.flipbook = (struct kiln_flipbook){.columns = 1, .rows = 1};
    struct kiln_error error = {0};
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_string_equal(error.message, "");
    struct kiln_picture *picture = test_picture(output, &params, 0);
    uint8_t *pixels = picture->display;
    memset(pixels, 0, (size_t)4 * params.width * params.height);
    const uint8_t red[4] = {200, 40, 10, 255}, green[4] = {10, 180, 20, 128};
    memcpy(pixels + (size_t)4 * (10 * params.width + 5), red, 4);
    memcpy(pixels + (size_t)4 * (30 * params.width + 60), green, 4);
    assert_true(kiln_output_write(output, picture, &error));
    assert_true(kiln_output_finish(output, &error));
    kiln_output_close(&output);
    struct kiln_asset_image *image = load(".png");
    for (int c = 0; c < 3; c++) {
        assert_int_equal(sample(image, 5, 10, c), red[c]);
        assert_int_equal(sample(image, 4, 11, c), red[c]);
        assert_int_equal(sample(image, 60, 30, c), green[c]);
        assert_int_equal(sample(image, 61, 31, c), green[c]);
    }
    assert_int_equal(sample(image, 5, 10, 3), 255);
    assert_int_equal(sample(image, 4, 11, 3), 0);
    assert_true(sample(image, 30, 2, 0) > 0);
    kiln_asset_image_destroy(&image);
}

/* A puff that moves by (3, -2) pixels a cell. */
static void draw_puff(const struct kiln_picture *picture, uint32_t cell)
{
    for (uint32_t i = 0; i < picture->width * picture->height; i++) {
        double x = i % picture->width - 20.0 - 3.0 * cell;
        double y = i / picture->width - 40.0 + 2.0 * cell;
        double cover = exp(-(x * x + y * y) / 90), shade = 0.6 + 0.4 * sin(0.5 * x + 0.8 * y);
        for (size_t c = 0; c < 4; c++)
            ((uint8_t *)picture->display)[4 * (size_t)i + c] =
                (uint8_t)(c < 3 ? 250 * shade : 255 * cover);
    }
}

static void motion_points_to_the_next_cell(void **state)
{
    (void)state;
    struct kiln_frame_range ranges[8];
    for (uint32_t i = 0; i < 8; i++)
        ranges[i] = (struct kiln_frame_range){5 + 2 * i, 5 + 2 * i};
    struct kiln_output_params params = test_output_params(path, ranges);
    params.range_count = 8;
    params.width = 80;
    params.height = 64;
    params.alpha = true;
    params.flipbook = (struct kiln_flipbook){.columns = 4, .rows = 2, .motion = true};
    struct kiln_error error = {0};
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_string_equal(error.message, "");
    const struct kiln_output_params complete = kiln_output_complete(&params, &error);
    assert_int_equal(kiln_output_file_count(&complete), 3);
    for (uint32_t i = 0; i < 8; i++) {
        struct kiln_picture *picture = test_picture(output, &params, ranges[i].first);
        draw_puff(picture, i);
        assert_true(kiln_output_write(output, picture, &error));
    }
    assert_true(kiln_output_finish(output, &error));
    kiln_output_close(&output);
    assert_int_equal(test_count_files(folder), 3);

    const char *layout = read_text(".json");
    assert_non_null(strstr(layout, "\"image\": \"book_motion.png\""));
    assert_non_null(strstr(layout, "\"frames\": [5, 7, 9, 11, 13, 15, 17, 19],\n"));
    assert_non_null(strstr(layout, "\"cells_per_second\": 15,\n"));
    assert_non_null(strstr(layout, "\"alpha\": \"straight\""));
    const char *scale_text = strstr(layout, "\"scale\": ");
    assert_non_null(scale_text);
    double scale = strtod(scale_text + 9, NULL);
    struct kiln_asset_image *image = load("_motion.png");
    assert_int_equal(image->width, 4 * 80);
    assert_int_equal(image->height, 2 * 64);
    assert_int_equal(image->channels, 3);
    for (uint32_t cell = 0; cell < 8; cell++) {
        uint32_t x = cell % 4 * 80 + 20 + 3 * cell, y = cell / 4 * 64 + 40 - 2 * cell;
        double right = (sample(image, x, y, 0) - 128.0) / 127 * scale * 80;
        double up = (sample(image, x, y, 1) - 128.0) / 127 * scale * 64;
        bool last = cell == 7;
        assert_true(last ? right == 0 : fabs(right - 3) < 0.3);
        assert_true(last ? up == 0 : fabs(up - 2) < 0.3);
    }
    kiln_asset_image_destroy(&image);
}

static void keep_lines(void *user, enum kiln_log_level level, const char *line)
{
    char *lines = user;
    if (level == KILN_LOG_WARNING)
        snprintf(lines + strlen(lines), 512 - strlen(lines), "%s\n", strrchr(line, '/') + 1);
}

static void doubtful_ones_are_warned_of(void **state)
{
    (void)state;
    char lines[512] = "";
    static const struct kiln_frame_range ranges[] = {{0, 0}, {2, 2}, {3, 3}, {5, 5}};
    struct kiln_output_params params = test_output_params(path, ranges);
    params.range_count = 4;
    params.flipbook = (struct kiln_flipbook){.columns = 2, .rows = 2};
    params.log = (struct kiln_log){keep_lines, lines};
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    assert_string_equal(lines,
                        "book.png: the cells are 1 to 2 frames apart, so motion will not be even; "
                        "choose a multiple of 4 frames\n"
                        "book.png: the backdrop is opaque, so the flipbook has no alpha "
                        "(backdrop.transparent: true)\n");
    assert_non_null(strstr(read_text(".json"), "\"alpha\": \"none\""));
    assert_non_null(strstr(read_text(".json"), "\"motion\": null"));
}

static void refuse(struct kiln_output_params params, enum kiln_code code, const char *message)
{
    struct kiln_error error = {0};
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, code, "%s: %s", params.path, message);
}

static void impossible_ones_are_refused(void **state)
{
    (void)state;
    char other[64];
    struct kiln_error error = {0};
    const struct kiln_frame_range four = {0, 3};
    struct kiln_output_params good = test_output_params(path, &four);
    good.flipbook = (struct kiln_flipbook){.columns = 2, .rows = 2, .motion = true};
    struct kiln_output_params params = good;
    params.flipbook.rows = 3;
    refuse(params, KILN_USAGE, "found 4 frames for 2 x 3 cells");
    params = good;
    params.flipbook.rows = 65;
    refuse(params, KILN_USAGE,
           "found a flipbook of 2 x 65 cells, padded by 0; allowed are 1 to 64 cells, and 0 to 256 "
           "pixels");
    params = good;
    params.flipbook.padding = 257;
    refuse(params, KILN_USAGE,
           "found a flipbook of 2 x 2 cells, padded by 257; allowed are 1 to 64 cells, and 0 to "
           "256 pixels");
    params = good;
    params.flipbook.fade = 51;
    refuse(params, KILN_USAGE,
           "found a flipbook whose cells fade out over 51 percent; allowed are 0 to 50");
    params = good;
    params.width = 8193;
    refuse(params, KILN_USAGE,
           "the flipbook would have 16386 x 72 pixels; allowed are 16384 a side: make the frames "
           "smaller (8193 x 36) or the cells fewer");
    params = good;
    snprintf(other, sizeof other, "%s/book.exr", folder);
    params.path = other;
    refuse(params, KILN_USAGE, "a flipbook is one .png file, not .exr");
    assert_int_equal(test_count_files(folder), 0);
    snprintf(other, sizeof other, "%s/book_motion.png", folder);
    fclose(fopen(other, "w"));
    assert_null(kiln_output_open(&good, &error));
    expect_error(&error, KILN_USAGE, "%s: the file exists (--force replaces it)", other);
    assert_int_equal(test_count_files(folder), 1);
}

static void what_is_not_finished_is_removed(void **state)
{
    (void)state;
    const struct kiln_frame_range four = {0, 3};
    struct kiln_output_params params = test_output_params(path, &four);
    params.flipbook = (struct kiln_flipbook){.columns = 2, .rows = 2, .motion = true};
    struct kiln_error error = {0};
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_non_null(output);
    assert_true(kiln_output_write(output, test_picture(output, &params, 0), &error));
    assert_int_equal(test_count_files(folder), 3);
    kiln_output_close(&output);
    assert_int_equal(test_count_files(folder), 0);
}

/* Something appears at a name of the set while frames are drawn: then none of its files comes, and
 * the one that was there stays. */
static void files_come_together(void **state)
{
    (void)state;
    static const char *const endings[] = {".png", "_motion.png", ".json"};
    const struct kiln_frame_range four = {0, 3};
    for (size_t i = 0; i < 6; i++) {
        struct kiln_output_params params = test_output_params(path, &four);
        params.flipbook = (struct kiln_flipbook){.columns = 2, .rows = 2, .motion = true};
        params.overwrite = i >= 3; /* files are replaced, but a folder is in the way */
        struct kiln_error error = {0};
        struct kiln_output *output = kiln_output_open(&params, &error);
        assert_non_null(output);
        for (uint32_t frame = 0; frame < 4; frame++)
            assert_true(kiln_output_write(output, test_picture(output, &params, frame), &error));
        char taken[64];
        snprintf(taken, sizeof taken, "%s/book%s", folder, endings[i % 3]);
        if (params.overwrite)
            assert_int_equal(mkdir(taken, 0777), 0);
        else
            fclose(fopen(taken, "w"));
        assert_false(kiln_output_finish(output, &error));
        expect_error(&error, KILN_USAGE, "%s: %s", taken,
                     params.overwrite ? "a folder has this name"
                                      : "the file exists (--force replaces it)");
        kiln_output_close(&output);
        assert_int_equal(test_count_files(folder), 1);
        assert_int_equal(remove(taken), 0);
    }
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_folder, remove_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_spread_evenly),
        TEST(cells_are_the_frames),
        TEST(hidden_pixels_take_colors),
        TEST(cells_fade_out_at_their_borders),
        TEST(motion_points_to_the_next_cell),
        TEST(doubtful_ones_are_warned_of),
        TEST(impossible_ones_are_refused),
        TEST(what_is_not_finished_is_removed),
        TEST(files_come_together),
    };
    return cmocka_run_group_tests_name("flipbook", tests, NULL, NULL);
}
