/* kiln_compare judges every layer of EXR files: colours by the limits, data by their numbers. If
 * this fails, a difference outside of the beauty goes unnoticed, or equal files differ. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "asset/image/layers_in.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/exr_file.h"
#include "support/folders.h"

enum { UINT, HALF, FLOAT };

/* Numbers as half floats and as floats. */
enum { H0 = 0, H1 = 0x3c00, H2 = 0x4000, HNAN = 0x7e00, HINF = 0x7c00 };
enum { F1 = 0x3f800000, F2 = 0x40000000, FINF = 0x7f800000 };

static const int32_t window[4] = {0, 0, 7, 5};

static void write_exr(const char *name, const struct exr_channel *channels, size_t count)
{
    struct exr_bytes bytes;
    exr_file_write(&bytes, channels, count, window, window);
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes.data, 1, bytes.size, file), bytes.size);
    assert_int_equal(fclose(file), 0);
}
#define WRITE(name, ...)                                                                           \
    write_exr(name, (const struct exr_channel[]){__VA_ARGS__},                                     \
              sizeof((const struct exr_channel[]){__VA_ARGS__}) / sizeof(struct exr_channel))
#define GREY(bits)                                                                                 \
    {"B", HALF, bits, 1}, {"G", HALF, bits, 1},                                                    \
    {                                                                                              \
        "R", HALF, bits, 1                                                                         \
    }

/* What a comparison told of its frame: "NAME VERDICT, ..." of its layers. */
struct told {
    char layers[512], message[256];
    enum kiln_compare_verdict verdict;
    double difference, score;
    uint64_t differing;
};

static void take(void *user, const struct kiln_compare_result *result,
                 const struct kiln_compare_frame *frame)
{
    struct told *told = user;
    (void)result;
    told->verdict = frame->verdict;
    told->score = frame->score;
    snprintf(told->message, sizeof told->message, "%s", frame->message);
    for (size_t i = 0; i < frame->layer_count; i++) {
        const struct kiln_compare_layer *layer =
            (const void *)((const char *)frame->layers + i * frame->layer_stride);
        const size_t used = strlen(told->layers);
        snprintf(told->layers + used, sizeof told->layers - used, "%s%s %s%s", i ? ", " : "",
                 layer->name, layer->data ? "data " : "",
                 kiln_compare_verdict_name(layer->verdict));
        told->differing += layer->differing;
        told->difference = fmax(told->difference, layer->difference);
    }
}

static struct told compare(struct kiln_compare_params params)
{
    struct told told = {.verdict = KILN_COMPARE_SAME};
    struct kiln_error error = {0};
    struct kiln_compare_result result = kiln_compare_result_empty();
    params.reference = params.reference ? params.reference : "a.exr";
    params.test = params.test ? params.test : "b.exr";
    params.frame = take;
    params.user = &told;
    const bool ok = kiln_compare(&params, &result, &error);
    assert_int_equal(ok, told.verdict != KILN_COMPARE_UNREADABLE);
    assert_int_equal(result.same, told.verdict == KILN_COMPARE_SAME);
    return told;
}

static struct told compare_all(void)
{
    return compare(kiln_compare_defaults());
}

static void a_difference_in_any_layer_is_found(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"Z", FLOAT, F2, 1}, {"diffuse.B", HALF, H1, 1},
          {"diffuse.G", HALF, H1, 1}, {"diffuse.R", HALF, H1, 1});
    WRITE("b.exr", GREY(H1), {"Z", FLOAT, F2, 1}, {"diffuse.B", HALF, H0, 1},
          {"diffuse.G", HALF, H1, 1}, {"diffuse.R", HALF, H1, 1});
    struct told told = compare_all();
    assert_string_equal(told.layers, "beauty same, depth data same, diffuse different");
    assert_string_equal(told.message, "1 of 3 layers differ");
    struct kiln_compare_params params = kiln_compare_defaults();
    params.layer = "beauty";
    assert_string_equal(compare(params).layers, "beauty same");
    params.layer = "diffuse";
    assert_string_equal(compare(params).layers, "diffuse different");
    params.layer = "depth";
    assert_string_equal(compare(params).layers, "depth data same");
}

static void layers_of_one_side_are_differences(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"fire.R", HALF, H1, 1}, {"smoke.R", HALF, H1, 1});
    WRITE("b.exr", GREY(H1), {"Z", FLOAT, F1, 1}, {"smoke.R", HALF, H1, 1});
    const struct told told = compare_all();
    assert_string_equal(told.layers, "beauty same, depth data extra, fire missing, smoke same");
    assert_true(told.verdict == KILN_COMPARE_DIFFERENT && isinf(told.score));
}

/* No float has the number 16,777,217, so as floats these two were equal. */
static void whole_numbers_are_exact(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"id", UINT, 16777216, 1});
    WRITE("b.exr", GREY(H1), {"id", UINT, 16777217, 1});
    const struct told told = compare_all();
    assert_string_equal(told.layers, "beauty same, id data different");
    assert_true(told.difference == 1.0 && told.differing == 48);
    struct kiln_compare_params params = kiln_compare_defaults();
    params.data_limit = 1;
    assert_string_equal(compare(params).layers, "beauty same, id data same");
    params.data_limit = 0.5;
    assert_string_equal(compare(params).layers, "beauty same, id data different");
}

static void types_of_numbers_do_not_count(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"id", UINT, 2, 1}, {"mask.N", HALF, H2, 1});
    WRITE("b.exr", {"B", FLOAT, F1, 1}, {"G", HALF, H1, 1}, {"R", FLOAT, F1, 1},
          {"id", FLOAT, F2, 1}, {"mask.N", FLOAT, F2, 1});
    assert_string_equal(compare_all().layers, "beauty same, id data same, mask.N data same");
}

static void numbers_that_are_not_finite_are_data(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"N.X", HALF, HNAN, 1}, {"N.Y", HALF, H1, 1}, {"Z", FLOAT, FINF, 1});
    WRITE("b.exr", GREY(H1), {"N.X", HALF, HNAN, 1}, {"N.Y", HALF, H1, 1}, {"Z", HALF, HINF, 1});
    assert_string_equal(compare_all().layers, "beauty same, N data same, depth data same");
    WRITE("b.exr", GREY(H1), {"N.X", HALF, H1, 1}, {"N.Y", HALF, H1, 1}, {"Z", HALF, H1, 1});
    struct kiln_compare_params params = kiln_compare_defaults();
    params.data_limit = 1e30;
    const struct told told = compare(params);
    assert_string_equal(told.layers, "beauty same, N data different, depth data different");
    assert_true(isinf(told.difference) && told.differing == 96);
}

static void light_that_is_not_finite_is_unreadable(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"fire.B", HALF, H1, 1}, {"fire.G", HALF, HNAN, 1},
          {"fire.R", HALF, H1, 1});
    WRITE("b.exr", GREY(H1), {"fire.B", HALF, H1, 1}, {"fire.G", HALF, H1, 1},
          {"fire.R", HALF, H1, 1});
    const struct told told = compare_all();
    assert_int_equal(told.verdict, KILN_COMPARE_UNREADABLE);
    assert_string_equal(told.message,
                        "a.exr: layer fire: pixel 0,0 has a value that is not finite");
}

static void masks_hide_data_too(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"Z", FLOAT, F1, 1});
    WRITE("b.exr", GREY(H1), {"Z", FLOAT, F2, 1});
    struct kiln_compare_mask mask = kiln_compare_mask_empty();
    struct kiln_compare_params params = kiln_compare_defaults();
    mask.width = 8;
    mask.height = 5;
    params.masks = &mask;
    params.mask_stride = sizeof mask;
    params.mask_count = 1;
    const struct told told = compare(params);
    assert_string_equal(told.layers, "beauty same, depth data different");
    assert_int_equal(told.differing, 8);
}

/* The picture of the difference is that of the layer that differs, of colours before data. Of the
 * depths 1 and 2, the first is black and the second white. */
static void the_worst_layer_is_drawn(void **state)
{
    (void)state;
    WRITE("a.exr", GREY(H1), {"Z", FLOAT, F1, 1});
    WRITE("b.exr", GREY(H1), {"Z", FLOAT, F2, 1});
    struct kiln_error error = {0};
    struct kiln_compare_params params = kiln_compare_defaults();
    params.diff = "diff.png";
    params.overwrite = true;
    compare(params);
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, "diff.png", &error);
    assert_string_equal(error.message, "");
    assert_int_equal(image->width, 24);
    const unsigned char *pixels = image->pixels;
    assert_int_equal(pixels[0], 0);
    assert_int_equal(pixels[(size_t)4 * 8], 255);
    kiln_asset_image_destroy(&image);
    WRITE("b.exr", GREY(H0), {"Z", FLOAT, F2, 1});
    compare(params);
    image = kiln_asset_image_load(NULL, "diff.png", &error);
    assert_string_equal(error.message, "");
    pixels = image->pixels;
    assert_int_equal(pixels[0], 255);
    assert_int_equal(pixels[(size_t)4 * 8], 0);
    kiln_asset_image_destroy(&image);
}

/* Every layer that is listed is found by its name, with the same pixels. */
static void names_of_layers_find_them(void **state)
{
    (void)state;
    static const char *const files[] = {"parts", "deep", "mip", "wide_yc", "dwaa", "window"};
    size_t count = 0;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[512];
        struct kiln_error error = {0};
        struct kiln_image_layer layer;
        snprintf(path, sizeof path, KILN_SOURCE_DIR "/tests/exr/%s.exr", files[i]);
        struct kiln_layers_in *layers = kiln_layers_in_open(NULL, path, NULL, &error);
        while (layers && kiln_layers_in_read(layers, &layer, &error) && layer.image) {
            struct kiln_asset_image *same =
                kiln_asset_image_load_layer(NULL, path, layer.name, &error);
            assert_string_equal(error.message, "");
            assert_int_equal(same->channels, layer.image->channels);
            if (layer.image->type == same->type)
                assert_memory_equal(same->pixels, layer.image->pixels,
                                    kiln_asset_image_bytes(same));
            kiln_asset_image_destroy(&same);
            kiln_asset_image_destroy(&layer.image);
            count++;
        }
        assert_string_equal(error.message, "");
        kiln_layers_in_close(&layers);
    }
    assert_int_equal(count, 12);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_difference_in_any_layer_is_found),
        cmocka_unit_test(layers_of_one_side_are_differences),
        cmocka_unit_test(whole_numbers_are_exact),
        cmocka_unit_test(types_of_numbers_do_not_count),
        cmocka_unit_test(numbers_that_are_not_finite_are_data),
        cmocka_unit_test(light_that_is_not_finite_is_unreadable),
        cmocka_unit_test(masks_hide_data_too),
        cmocka_unit_test(the_worst_layer_is_drawn),
        cmocka_unit_test(names_of_layers_find_them),
    };
    return cmocka_run_group_tests_name("layers", tests, test_enter_folder, test_leave_folder);
}
