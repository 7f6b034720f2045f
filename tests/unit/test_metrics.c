/* lib/compare: levels, SSIM, PSNR, the densest window, the table of metrics and its limits; closed
 * forms, what must hold for any pair, and FFmpeg's filters as a second opinion. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compare/magma.h"
#include "compare/metric.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

struct level_picture {
    uint32_t width, height, channels;
    uint8_t *rgba;
};

static struct level_picture flat(uint32_t width, uint32_t height, uint32_t channels, uint8_t level)
{
    struct level_picture p = {width, height, channels, malloc((size_t)4 * width * height)};
    assert_non_null(p.rgba);
    memset(p.rgba, level, (size_t)4 * width * height);
    for (size_t i = 0; channels % 2 && i < (size_t)width * height; i++)
        p.rgba[4 * i + 3] = 255;
    return p;
}

static struct level_picture noise(uint32_t width, uint32_t height, unsigned seed)
{
    struct level_picture p = flat(width, height, 3, 0);
    srand(seed);
    for (size_t i = 0; i < (size_t)4 * width * height; i++)
        p.rgba[i] = (uint8_t)(i % 4 == 3 ? 255 : rand() % 256);
    return p;
}

static struct kiln_compare_picture *picture_of(const struct kiln_asset_image *image)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    assert_non_null(threads);
    struct kiln_compare_picture *picture =
        kiln_compare_picture_create(image, NULL, "picture", threads, &error);
    kiln_threads_destroy(&threads);
    assert_string_equal(error.message, "");
    return picture;
}

/* Frees the picture. */
static struct kiln_compare_picture *make_picture(struct level_picture p)
{
    const struct kiln_asset_image image = {p.width,       p.height,     p.channels,
                                           KILN_IMAGE_U8, .srgb = true, .pixels = p.rgba};
    struct kiln_compare_picture *made = picture_of(&image);
    free(p.rgba);
    return made;
}

struct judged {
    struct kiln_metric_set set;
    struct kiln_compare_layer layer;
    struct kiln_level_difference levels;
};

static struct judged judge_pictures(struct kiln_compare_picture *a, struct kiln_compare_picture *b,
                                    const char *limits, uint32_t window)
{
    struct judged judged = {0};
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_measurement m;
    const struct kiln_measure_params params = {a->hdr, 67.0206, 2, window};
    struct kiln_compare_picture *const both[2] = {a, b};
    if (!threads || !kiln_metric_set_make(&judged.set, &limits, 1, &error) ||
        !kiln_compare_pictures_agree(both, &error) ||
        !kiln_measurement_take(&m, a, b, &params, threads, &error) ||
        !kiln_metric_set_judge(&judged.set, &m, &judged.layer, &error))
        fail_msg("%s", error.message);
    judged.levels = m.levels;
    kiln_measurement_finish(&m);
    kiln_threads_destroy(&threads);
    kiln_compare_picture_destroy(&a);
    kiln_compare_picture_destroy(&b);
    return judged;
}

static struct judged judge(struct level_picture a, struct level_picture b)
{
    return judge_pictures(make_picture(a), make_picture(b), KILN_COMPARE_DEFAULT_LIMITS, 8);
}

static double value(const struct judged *judged, const char *name)
{
    for (size_t i = 0; i < judged->set.count; i++) {
        if (strcmp(judged->set.columns[i].name, name) == 0)
            return judged->layer.values[i];
    }
    fail_msg("no metric '%s'", name);
    return NAN;
}

#define assert_near(got, expected, tolerance) assert_true(fabs((got) - (expected)) <= (tolerance))

/* ---- Closed forms ------------------------------------------------------------------------- */

static void flat_pictures_have_closed_forms(void **state)
{
    (void)state;
    struct judged j = judge(flat(64, 40, 3, 100), flat(64, 40, 3, 110));
    assert_near(value(&j, "abs.max"), 10, 1e-6);
    assert_near(value(&j, "abs.mean"), 10, 1e-6);
    assert_near(value(&j, "psnr"), 10 * log10(255.0 * 255 / 100), 1e-9);
    double a = 100 / 255.0, b = 110 / 255.0, c1 = 1e-4;
    assert_near(value(&j, "ssim"), (2 * a * b + c1) / (a * a + b * b + c1), 1e-4);
    assert_near(value(&j, "differing.count"), 64 * 40, 0);
    assert_near(value(&j, "differing.share"), 1, 0);
    assert_near(value(&j, "window.share"), 1, 0);
    assert_int_equal(j.layer.verdict, KILN_COMPARE_DIFFERENT);
}

/* What a per-pixel comparator takes for equal. */
static void a_shift_of_eight_levels_is_seen(void **state)
{
    (void)state;
    struct judged j = judge(flat(64, 64, 3, 128), flat(64, 64, 3, 136));
    assert_near(value(&j, "flip.mean"), 0.1276, 1e-4);
    assert_int_equal(j.layer.verdict, KILN_COMPARE_DIFFERENT);
}

static void one_changed_channel_counts_as_such(void **state)
{
    (void)state;
    struct level_picture b = flat(20, 10, 3, 50);
    b.rgba[4 * (3 * 20 + 7) + 1] = 80;
    struct judged j = judge(flat(20, 10, 3, 50), b);
    assert_near(value(&j, "abs.max"), 30, 1e-6);
    assert_near(value(&j, "abs.mean"), 30 / 600.0, 1e-9);
    assert_near(value(&j, "psnr"), 10 * log10(255.0 * 255 / (900 / 600.0)), 1e-6);
    assert_near(value(&j, "differing.count"), 1, 0);
    assert_near(value(&j, "window.share"), 1 / 64.0, 1e-12);
    assert_int_equal(j.levels.x, 7);
    assert_int_equal(j.levels.y, 3);
}

/* The same by its definition: every window, every pixel. */
static double ssim_by_definition(const struct level_picture *p, const struct level_picture *q)
{
    double sum = 0;
    for (int y = 0; y < (int)p->height; y++) {
        for (int x = 0; x < (int)p->width; x++) {
            double w = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
            for (int v = y - 5; v <= y + 5; v++) {
                for (int u = x - 5; u <= x + 5; u++) {
                    if (u < 0 || v < 0 || u >= (int)p->width || v >= (int)p->height)
                        continue;
                    double g = exp(-((u - x) * (u - x) + (v - y) * (v - y)) / 4.5);
                    const uint8_t *s = p->rgba + 4 * (v * (int)p->width + u);
                    const uint8_t *t = q->rgba + 4 * (v * (int)p->width + u);
                    double i = (0.2126 * s[0] + 0.7152 * s[1] + 0.0722 * s[2]) / 255;
                    double k = (0.2126 * t[0] + 0.7152 * t[1] + 0.0722 * t[2]) / 255;
                    w += g;
                    a += g * i;
                    b += g * k;
                    aa += g * i * i;
                    bb += g * k * k;
                    ab += g * i * k;
                }
            }
            a /= w;
            b /= w;
            sum += (2 * a * b + 1e-4) * (2 * (ab / w - a * b) + 9e-4) /
                   ((a * a + b * b + 1e-4) * (aa / w - a * a + bb / w - b * b + 9e-4));
        }
    }
    return sum / ((double)p->width * p->height);
}

static void ssim_is_its_definition(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{40, 37}, {3, 50}, {70, 1}, {11, 11}, {1, 1}, {12, 80}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct level_picture a = noise(sizes[i][0], sizes[i][1], 1);
        struct level_picture b = noise(sizes[i][0], sizes[i][1], 1);
        for (size_t k = 0; k < (size_t)4 * a.width * a.height; k += 3)
            b.rgba[k] = (uint8_t)(k % 4 == 3 ? 255 : b.rgba[k] / 2);
        double expected = ssim_by_definition(&a, &b);
        struct judged j = judge(a, b);
        assert_near(value(&j, "ssim"), expected, 1e-4);
    }
}

static void the_densest_window_is_found(void **state)
{
    (void)state;
    struct level_picture b = flat(100, 60, 3, 0);
    b.rgba[4 * (5 * 100 + 5)] = 255; /* alone */
    for (uint32_t y = 40; y < 44; y++) {
        for (uint32_t x = 93; x < 97; x++)
            b.rgba[4 * (y * 100 + x)] = 3;
    }
    struct judged j = judge(flat(100, 60, 3, 0), b);
    assert_near(value(&j, "window.share"), 16 / 64.0, 1e-12);
    assert_int_equal(j.levels.window_differing, 16);
    assert_true(j.levels.window_x <= 93 && j.levels.window_x + 8 >= 97);
    assert_true(j.levels.window_y <= 40 && j.levels.window_y + 8 >= 44);
    /* A window larger than the picture is the picture. */
    struct judged all = judge_pictures(make_picture(flat(10, 6, 3, 0)),
                                       make_picture(flat(10, 6, 3, 9)), "abs.max=1", 32);
    assert_int_equal(all.levels.window_width, 10);
    assert_int_equal(all.levels.window_height, 6);
    assert_near(value(&all, "window.share"), 1, 0);
}

static void differences_at_the_threshold_do_not_count(void **state)
{
    (void)state;
    struct judged at = judge(flat(9, 9, 3, 50), flat(9, 9, 3, 52));
    struct judged beyond = judge(flat(9, 9, 3, 50), flat(9, 9, 3, 53));
    assert_near(value(&at, "differing.count"), 0, 0);
    assert_near(value(&beyond, "differing.count"), 81, 0);
}

/* ---- What holds for any pair -------------------------------------------------------------- */

static void equal_pictures_are_equal_by_all_metrics(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {33, 70}, {300, 5}};
    for (size_t i = 0; i < 3; i++) {
        uint32_t w = sizes[i][0], h = sizes[i][1];
        struct judged j = judge(noise(w, h, 4), noise(w, h, 4));
        assert_int_equal(j.layer.verdict, KILN_COMPARE_SAME);
        assert_true(j.layer.score == 0.0);
        for (size_t c = 0; c < j.set.count; c++) {
            const char *name = j.set.columns[c].name;
            double expected = strcmp(name, "ssim") == 0   ? 1.0
                              : strcmp(name, "psnr") == 0 ? INFINITY
                                                          : 0.0;
            assert_true(j.layer.values[c] == expected);
        }
    }
}

static void low_range_metrics_are_symmetric(void **state)
{
    (void)state;
    struct judged ab = judge(noise(90, 50, 1), noise(90, 50, 2));
    struct judged ba = judge(noise(90, 50, 2), noise(90, 50, 1));
    for (size_t i = 0; i < ab.set.count; i++)
        assert_near(ab.layer.values[i], ba.layer.values[i], 1e-6);
}

static void alpha_alone_is_a_difference(void **state)
{
    (void)state;
    /* Black and opaque, black and clear: the same on black. */
    struct level_picture a = flat(32, 32, 4, 0), b = flat(32, 32, 4, 0);
    for (size_t i = 0; i < 32 * 32; i++)
        a.rgba[4 * i + 3] = 255;
    struct judged j = judge(a, b);
    assert_near(value(&j, "abs.max"), 255, 1e-4);
    assert_near(value(&j, "flip.mean"), 0.96738, 1e-4);
    assert_true(value(&j, "ssim") < 0.1);
    /* What is clear has no colour. */
    struct level_picture c = flat(8, 8, 4, 0), d = flat(8, 8, 4, 0);
    for (size_t i = 0; i < 64; i++)
        c.rgba[4 * i] = 255;
    struct judged clear = judge(c, d);
    assert_true(value(&clear, "abs.max") == 0.0);
}

static void float_pictures_go_beyond_white(void **state)
{
    (void)state;
    float light[2][4 * 64];
    for (size_t i = 0; i < sizeof light[0] / sizeof *light[0]; i++) {
        light[0][i] = i % 4 == 3 ? 1.0f : 20.0f;
        light[1][i] = i % 4 == 3 ? 1.0f : 40.0f;
    }
    struct kiln_asset_image images[2];
    for (int i = 0; i < 2; i++)
        images[i] = (struct kiln_asset_image){
            8, 8, 3, KILN_IMAGE_F32, .premultiplied = true, .pixels = light[i]};
    struct judged j = judge_pictures(picture_of(&images[0]), picture_of(&images[1]), "psnr=30", 8);
    double level = 255 * 1.055 * (pow(40, 1 / 2.4) - pow(20, 1 / 2.4));
    assert_near(value(&j, "abs.max"), level, 1e-3);
    assert_true(value(&j, "flip.mean") > 0.01);
    assert_int_equal(j.layer.verdict, KILN_COMPARE_DIFFERENT);
}

/* Fire on black: the median of the reference is black, and an empty range of exposures would make
 * any two such pictures equal. */
static void fire_on_black_is_compared(void **state)
{
    (void)state;
    static const float lights[][2] = {{20, 5}, {5, 20}, {0, 5}, {5, 0}};
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
        struct kiln_compare_picture *pictures[2];
        for (int k = 0; k < 2; k++) {
            float pixels[4 * 64 * 64] = {0};
            for (size_t p = 0; p < sizeof pixels / sizeof *pixels; p++)
                pixels[p] = p % 4 == 3 ? 1.0f : p / 4 / 64 < 4 ? lights[i][k] : 0.0f;
            const struct kiln_asset_image image = {64, 64, 3, KILN_IMAGE_F32, .pixels = pixels};
            pictures[k] = picture_of(&image);
        }
        struct judged j = judge_pictures(pictures[0], pictures[1], KILN_COMPARE_DEFAULT_LIMITS, 8);
        assert_int_equal(j.layer.verdict, KILN_COMPARE_DIFFERENT);
        assert_true(value(&j, "flip.p99") > 0.1);
    }
}

static void deep_pictures_are_as_bright_as_others(void **state)
{
    (void)state;
    uint16_t deep[4 * 4];
    for (size_t i = 0; i < 16; i++)
        deep[i] = i % 4 == 3 ? 65535 : 100 * 257;
    const struct kiln_asset_image image = {2, 2, 3, KILN_IMAGE_U16, .srgb = true, .pixels = deep};
    struct judged j = judge_pictures(picture_of(&image), make_picture(flat(2, 2, 3, 100)),
                                     KILN_COMPARE_DEFAULT_LIMITS, 8);
    assert_true(value(&j, "abs.max") < 1e-3);
    assert_true(value(&j, "flip.max") < 1e-5);
}

/* ---- What is refused ---------------------------------------------------------------------- */

static void what_is_not_finite_is_refused(void **state)
{
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < 3; i++) {
        for (size_t at = 0; at < 4; at++) {
            float pixels[4 * 6] = {0};
            pixels[4 * 4 + at] = bad[i];
            const struct kiln_asset_image image = {3, 2, 4, KILN_IMAGE_F32, .pixels = pixels};
            struct kiln_error error = {0};
            struct kiln_threads *threads = kiln_threads_create(1);
            assert_null(kiln_compare_picture_create(&image, NULL, "x.exr", threads, &error));
            expect_error(&error, KILN_INVALID_INPUT,
                         "x.exr: pixel 1,1 has a value that is not finite");
            kiln_threads_destroy(&threads);
        }
    }
}

static void assert_mismatch(struct level_picture a, struct level_picture b, const char *message)
{
    struct kiln_error error = {0};
    struct kiln_compare_picture *p = make_picture(a), *q = make_picture(b);
    struct kiln_measurement m;
    struct kiln_threads *threads = kiln_threads_create(1);
    const struct kiln_measure_params params = {false, 67.0206, 2, 8};
    assert_false(kiln_measurement_take(&m, p, q, &params, threads, &error));
    expect_error(&error, KILN_FRAME_FAILED, "%s", message);
    kiln_measurement_finish(&m);
    kiln_threads_destroy(&threads);
    kiln_compare_picture_destroy(&p);
    kiln_compare_picture_destroy(&q);
}

static void what_does_not_match_is_no_pass(void **state)
{
    (void)state;
    assert_mismatch(flat(4, 3, 3, 0), flat(3, 4, 3, 0),
                    "the sizes differ: the reference has 4 x 3 pixels, the test 3 x 4");
}

/* Grey and colour of the same values are the same picture, and so are solid alpha and none. What
 * only one of two files can say is measured. */
static void channels_are_roles(void **state)
{
    (void)state;
    static const struct {
        uint32_t channels[2];
        uint8_t values[2];
        const char *note;
        double worst;
    } pairs[] = {
        {{1, 3}, {7, 7}, "", 0},
        {{3, 4},
         {255, 255},
         "the test has alpha, which is opaque everywhere; the reference has none",
         0},
        {{2, 1},
         {255, 255},
         "the reference has alpha, which is opaque everywhere; the test has none",
         0},
        {{4, 2}, {255, 255}, "", 0},
        {{3, 4}, {0, 0}, "the test has alpha, the reference has none", 255},
        {{4, 3}, {51, 0}, "the reference has alpha, the test has none", 204},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        struct kiln_compare_picture *pictures[2];
        for (int k = 0; k < 2; k++)
            pictures[k] = make_picture(flat(4, 3, pairs[i].channels[k], pairs[i].values[k]));
        assert_string_equal(kiln_compare_alpha_note(pictures[0], pictures[1]), pairs[i].note);
        struct judged j = judge_pictures(pictures[0], pictures[1], "flip.mean=1", 8);
        assert_near(value(&j, "abs.max"), pairs[i].worst, 1e-4);
    }
}

/* ---- Limits ------------------------------------------------------------------------------- */

static void limits_are_read_strictly(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        {"flip.maen=0.1", "limit 'flip.maen=0.1': unknown metric 'flip.maen' (did you mean "
                          "'flip.mean'?)"},
        {"colour=1", "limit 'colour=1': unknown metric 'colour'; 'kiln help metrics' lists them"},
        {"flip.mean", "limit 'flip.mean': expected METRIC=VALUE, such as flip.mean=0.01"},
        {"=1", "limit '=1': expected METRIC=VALUE, such as flip.mean=0.01"},
        {"", "limit '': expected METRIC=VALUE, such as flip.mean=0.01"},
        {"ssim=0.9,", "limit '': expected METRIC=VALUE, such as flip.mean=0.01"},
        {"flip.mean=", "limit 'flip.mean=': expected a number, 0 to 1"},
        {"flip.mean=1.5", "limit 'flip.mean=1.5': expected a number, 0 to 1"},
        {"flip.mean=0.1x", "limit 'flip.mean=0.1x': expected a number, 0 to 1"},
        {"flip.mean=nan", "limit 'flip.mean=nan': expected a number, 0 to 1"},
        {"abs.max=-1", "limit 'abs.max=-1': expected a number, 0 or more"},
        {"flip.p101=0.1", "limit 'flip.p101=0.1': found the percentile '101'; allowed are 0 to "
                          "100, as in flip.p99.9"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct kiln_metric_set set;
        struct kiln_error error = {0};
        assert_false(kiln_metric_set_make(&set, &bad[i][0], 1, &error));
        expect_error(&error, KILN_USAGE, "%s", bad[i][1]);
    }
}

static void limits_decide(void **state)
{
    (void)state;
    struct judged j =
        judge_pictures(make_picture(flat(8, 8, 3, 100)), make_picture(flat(8, 8, 3, 110)),
                       "abs.max=10,psnr=28.13,flip.p99.5=1,flip.mean=0,flip.mean=1", 8);
    assert_int_equal(j.layer.verdict, KILN_COMPARE_SAME);
    assert_true(j.layer.score > 0.999 && j.layer.score <= 1.0);
    assert_string_equal(j.set.columns[j.set.count - 1].name, "flip.p99.5");
    struct judged max = judge_pictures(make_picture(flat(8, 8, 3, 100)),
                                       make_picture(flat(8, 8, 3, 110)), "abs.max=9.9", 8);
    assert_int_equal(max.layer.verdict, KILN_COMPARE_DIFFERENT);
    assert_near(max.layer.score, 10 / 9.9, 1e-9);
    struct judged psnr = judge_pictures(make_picture(flat(8, 8, 3, 100)),
                                        make_picture(flat(8, 8, 3, 110)), "psnr=28.14", 8);
    assert_int_equal(psnr.layer.verdict, KILN_COMPARE_DIFFERENT);
    struct judged zero = judge_pictures(make_picture(flat(8, 8, 3, 100)),
                                        make_picture(flat(8, 8, 3, 101)), "abs.max=0", 8);
    assert_int_equal(zero.layer.verdict, KILN_COMPARE_DIFFERENT);
    assert_true(isinf(zero.layer.score));
}

/* ---- Second opinions ---------------------------------------------------------------------- */

static void write_pnm(const char *path, const struct level_picture *p)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "P6\n%u %u\n255\n", p->width, p->height);
    for (size_t i = 0; i < (size_t)p->width * p->height; i++)
        fwrite(p->rgba + 4 * i, 1, 3, file);
    assert_int_equal(fclose(file), 0);
}

/* What FFmpeg's filter says of the two files: the number behind key. */
static double ask_ffmpeg(const char *folder, const char *filter, const char *key)
{
    char command[512], line[1024];
    snprintf(command, sizeof command,
             "ffmpeg -nostdin -hide_banner -i %s/a.ppm -i %s/b.ppm -lavfi '%s' -f null - 2>&1",
             folder, folder, filter);
    FILE *output = popen(command, "r"); // NOLINT(cert-env33-c): the program is the point
    assert_non_null(output);
    double found = NAN;
    while (fgets(line, sizeof line, output)) {
        const char *at = strstr(line, key);
        if (at)
            found = strtod(at + strlen(key), NULL);
    }
    pclose(output);
    return found;
}

/* FFmpeg's SSIM has square windows of 8x8 pixels, every fourth one, which see more of the noise:
 * near, not equal. */
static void ffmpeg_agrees(void **state)
{
    (void)state;
    struct level_picture a = flat(160, 96, 3, 0), b = flat(160, 96, 3, 0);
    srand(9);
    for (uint32_t i = 0; i < 160 * 96; i++) {
        for (uint32_t c = 0; c < 3; c++) {
            double wave = 128 + 80 * sin(0.11 * (i % 160)) * cos(0.17 * (i / 160) + c);
            a.rgba[4 * i + c] = (uint8_t)wave;
            b.rgba[4 * i + c] = (uint8_t)(wave * 0.9 + rand() % 12);
        }
    }
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/a.ppm", folder);
    write_pnm(path, &a);
    snprintf(path, sizeof path, "%s/b.ppm", folder);
    write_pnm(path, &b);
    double psnr = ask_ffmpeg(folder, "[0][1]psnr", " average:");
    double ssim =
        ask_ffmpeg(folder,
                   "[0]format=gbrp,colorchannelmixer=.2126:.7152:.0722:0:.2126:.7152:.0722:0:"
                   ".2126:.7152:.0722:0,format=gbrp[x];[1]format=gbrp,colorchannelmixer="
                   ".2126:.7152:.0722:0:.2126:.7152:.0722:0:.2126:.7152:.0722:0,format=gbrp[y];"
                   "[x][y]ssim",
                   "All:");
    test_remove_folder(folder);
    struct judged j = judge(a, b);
    assert_near(value(&j, "psnr"), psnr, 0.001);
    assert_near(value(&j, "ssim"), ssim, 0.02);
}

/* Entries of the published table that are no control points. */
static void magma_is_near_the_published_table(void **state)
{
    (void)state;
    static const struct {
        int index;
        double rgb[3];
    } rows[] = {
        {0, {0.001462, 0.000466, 0.013866}},   {2, {0.003279, 0.002305, 0.023708}},
        {32, {0.113094, 0.065492, 0.276784}},  {48, {0.211718, 0.061992, 0.418647}},
        {53, {0.245543, 0.059352, 0.448436}},  {127, {0.709962, 0.212797, 0.477201}},
        {152, {0.863320, 0.283729, 0.412403}}, {173, {0.953099, 0.397563, 0.361438}},
        {213, {0.997077, 0.690088, 0.471811}}, {238, {0.993170, 0.870024, 0.626189}},
        {253, {0.987691, 0.977154, 0.734536}}, {255, {0.987053, 0.991438, 0.749504}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t rgb[3];
        kiln_magma_color((float)rows[i].index / 255.0f, rgb);
        for (int c = 0; c < 3; c++)
            assert_near(rgb[c], 255 * rows[i].rgb[c], 1.0);
    }
    uint8_t ends[4][3];
    kiln_magma_color(-1.0f, ends[0]);
    kiln_magma_color(0.0f, ends[1]);
    kiln_magma_color(1.0f, ends[2]);
    kiln_magma_color(9.0f, ends[3]);
    assert_memory_equal(ends[0], ends[1], 3);
    assert_memory_equal(ends[2], ends[3], 3);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_pictures_have_closed_forms),
        cmocka_unit_test(a_shift_of_eight_levels_is_seen),
        cmocka_unit_test(one_changed_channel_counts_as_such),
        cmocka_unit_test(ssim_is_its_definition),
        cmocka_unit_test(the_densest_window_is_found),
        cmocka_unit_test(differences_at_the_threshold_do_not_count),
        cmocka_unit_test(equal_pictures_are_equal_by_all_metrics),
        cmocka_unit_test(low_range_metrics_are_symmetric),
        cmocka_unit_test(alpha_alone_is_a_difference),
        cmocka_unit_test(float_pictures_go_beyond_white),
        cmocka_unit_test(fire_on_black_is_compared),
        cmocka_unit_test(deep_pictures_are_as_bright_as_others),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(what_does_not_match_is_no_pass),
        cmocka_unit_test(channels_are_roles),
        cmocka_unit_test(limits_are_read_strictly),
        cmocka_unit_test(limits_decide),
        cmocka_unit_test(ffmpeg_agrees),
        cmocka_unit_test(magma_is_near_the_published_table),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
