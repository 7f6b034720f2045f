/* Pages of TIFF files, and colours that a file has multiplied by alpha, in all that reads pictures.
 * If this fails, kiln reads another page than the one it is asked for, or such colours turn too
 * dark or too bright in textures, atlases and clips. The files are those of tests/pictures/tiff,
 * which pictures.tiff compares with what other programs read of them. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "asset/image/image.h"
#include "asset/image/linear.h"
#include "asset/image/video_in.h"
#include "kiln_job.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

#define FILES KILN_SOURCE_DIR "/tests/pictures/tiff/"

static struct kiln_asset_image *load(const char *name)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, name, &error);
    assert_string_equal(error.message, "");
    assert_non_null(image);
    return image;
}

/* The file has a page, a smaller version, a mask, and a page that is turned. */
static void pages_are_read_by_number(void **state)
{
    (void)state;
    static const uint32_t sizes[2][2] = {{13, 11}, {11, 13}};
    for (uint32_t page = 0; page < 2; page++) {
        struct kiln_error error = {0};
        struct kiln_asset_image *image =
            kiln_asset_image_load_page(NULL, FILES "pages.tif", page, &error);
        assert_string_equal(error.message, "");
        assert_int_equal(image->width, sizes[page][0]);
        assert_int_equal(image->height, sizes[page][1]);
        assert_int_equal(image->pages, 2);
        kiln_asset_image_destroy(&image);
    }
    struct kiln_error error = {0};
    assert_null(kiln_asset_image_load_page(NULL, FILES "pages.tif", 2, &error));
    expect_error(&error, KILN_INVALID_INPUT, FILES "pages.tif: no page 2: the TIFF file has 2");
    assert_null(kiln_asset_image_load_page(NULL, FILES "rgb.png", 1, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 FILES "rgb.png: no page 1: only TIFF images have pages");
}

/* Keeps the last warning and counts all. */
struct warnings {
    unsigned count;
    char text[256];
};

static void keep_warning(void *user, const char *path, const char *text)
{
    struct warnings *warnings = user;
    assert_string_equal(path, FILES "pages.tif");
    warnings->count++;
    snprintf(warnings->text, sizeof warnings->text, "%s", text);
}

static void pages_that_are_not_taken_are_told(void **state)
{
    (void)state;
    const struct kiln_loader_params anywhere = {.root = NULL};
    struct kiln_loader *loader = kiln_loader_create(&anywhere);
    struct warnings warnings = {.count = 0};
    struct kiln_error error = {0};
    assert_non_null(loader);
    kiln_loader_set_warn(loader, (struct kiln_loader_warn){keep_warning, &warnings});
    struct kiln_asset_image *image =
        kiln_asset_image_load_page(loader, FILES "pages.tif", 0, &error);
    assert_non_null(image);
    kiln_asset_image_destroy(&image);
    assert_int_equal(warnings.count, 0);
    image = kiln_asset_image_load_sky(loader, FILES "pages.tif", &error);
    assert_non_null(image);
    kiln_asset_image_destroy(&image);
    assert_int_equal(warnings.count, 1);
    assert_string_equal(warnings.text, "it has 2 pages; the first is taken");
    kiln_loader_destroy(&loader);
}

/* A smaller version is no page, and files of other formats have one. */
static void other_images_are_no_pages(void **state)
{
    (void)state;
    static const char *const names[] = {FILES "vips_rgba.tif", FILES "rgb.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct kiln_asset_image *image = load(names[i]);
        assert_int_equal(image->pages, 1);
        kiln_asset_image_destroy(&image);
    }
}

static void data_are_not_turned(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_asset_image *image = kiln_asset_image_load_data(NULL, FILES "orient6.tif", &error);
    assert_non_null(image);
    assert_int_equal(image->width, 13);
    assert_int_equal(image->height, 11);
    kiln_asset_image_destroy(&image);
}

/* Two files store one picture: the colours are multiplied by alpha in one, and straight in the
 * other. */
static void associated_light_is_that_of_straight_colours(void **state)
{
    (void)state;
    struct kiln_asset_image *associated = load(FILES "alpha_assoc16.tif");
    struct kiln_asset_image *straight = load(FILES "rgba16.png");
    assert_true(associated->premultiplied && associated->srgb);
    assert_false(straight->premultiplied);
    float rows[2][3 * 13];
    for (uint32_t y = 0; y < straight->height; y++) {
        kiln_linear_row(associated, y, rows[0]);
        kiln_linear_row(straight, y, rows[1]);
        for (uint32_t i = 0; i < 3 * straight->width; i++)
            assert_true(fabsf(rows[0][i] - rows[1][i]) < 1e-4f);
    }
    kiln_asset_image_destroy(&associated);
    kiln_asset_image_destroy(&straight);
}

static void light_without_cover_is_kept(void **state)
{
    (void)state;
    const struct kiln_asset_image image = {.srgb = true, .premultiplied = true};
    assert_true(kiln_light_of(&image, 0.5f, 0.0f) == kiln_decode_srgb(0.5f));
    assert_true(kiln_light_of(&image, 0.5f, 1.0f) == kiln_decode_srgb(0.5f));
    assert_true(fabsf(kiln_light_of(&image, 0.5f, 0.5f) - 0.5f) < 1e-6f);
    assert_true(fabsf(kiln_light_of(&image, 0.50001f, 0.5f) - 0.5f) < 1e-4f);
}

static void copy(const char *from, const char *to)
{
    static uint8_t bytes[1 << 16];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    assert_true(in && out);
    const size_t size = fread(bytes, 1, sizeof bytes, in);
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    assert_int_equal(fclose(in), 0);
    assert_int_equal(fclose(out), 0);
}

static struct kiln_asset_image *next_frame(struct kiln_video_in *video)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = NULL;
    assert_true(kiln_video_in_read(video, &image, &error));
    assert_non_null(image);
    assert_int_equal(image->type, KILN_IMAGE_U16);
    return image;
}

/* A clip has straight colours. Light without cover becomes as opaque as it is bright. */
static void clips_of_associated_colours_are_straight(void **state)
{
    (void)state;
    enum { GLOW = 10 * 13 + 5, RED = 30000 }; /* a pixel with alpha 0 */
    struct kiln_error error = {0};
    copy(FILES "alpha_assoc16.tif", "0.tif");
    copy(FILES "alpha_glow.tif", "1.tif");
    struct kiln_encode_params params = kiln_encode_defaults();
    params.frames = "%d.tif";
    params.output = "clip.apng";
    params.fps = "10";
    struct kiln_frame_range range;
    assert_true(kiln_encode(&params, &range, &error));
    struct kiln_video_in *video = kiln_video_in_open(NULL, "clip.apng", &error);
    assert_non_null(video);
    struct kiln_asset_image *frame = next_frame(video), *straight = load(FILES "rgba16.png");
    const uint16_t *found = frame->pixels, *wanted = straight->pixels;
    for (size_t i = 0; i < 4 * (size_t)13 * 11; i++) {
        const int alpha = wanted[i | 3]; /* a step of 1 in the product is 65535 / alpha in colour */
        if (alpha > 0)
            assert_true(abs(found[i] - wanted[i]) <= 2 + 65535 / alpha);
    }
    kiln_asset_image_destroy(&frame);
    kiln_asset_image_destroy(&straight);
    frame = next_frame(video);
    found = (const uint16_t *)frame->pixels + 4 * (size_t)GLOW;
    assert_int_equal(found[0], 65535);
    assert_int_equal(found[1], 0);
    assert_int_equal(found[3], RED);
    kiln_asset_image_destroy(&frame);
    kiln_video_in_close(&video);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_are_read_by_number),
        cmocka_unit_test(pages_that_are_not_taken_are_told),
        cmocka_unit_test(other_images_are_no_pages),
        cmocka_unit_test(data_are_not_turned),
        cmocka_unit_test(associated_light_is_that_of_straight_colours),
        cmocka_unit_test(light_without_cover_is_kept),
        cmocka_unit_test_setup_teardown(clips_of_associated_colours_are_straight, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
