/* lib/base/simd.c: levels are chosen by name. lib/post/{bloom,composite}_cpu.c: their pixels are
 * the same bytes at every level and for any number of threads. That they are right is tested
 * against GL in tests/gpu/test_post_techniques.c. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/simd.h"
#include "post/bloom.h"
#include "post/composite.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"

enum { WIDTH = 211, HEIGHT = 93, FLOATS = 4 * WIDTH * HEIGHT }; /* no multiples of anything */

/* ---- the chooser ----------------------------------------------------------------------------- */

static void the_widest_is_the_default(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    enum kiln_simd simd;
    unsetenv("KILN_SIMD");
    assert_true(kiln_simd_choose(&simd, &error));
    assert_true(kiln_simd_has(simd) && kiln_simd_has(kiln_simd_narrowest()));
    for (enum kiln_simd wider = simd + 1; wider < KILN_SIMD_COUNT; wider++)
        assert_false(kiln_simd_has(wider));
}

static void each_level_has_a_name(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    for (enum kiln_simd wanted = 0; wanted < KILN_SIMD_COUNT; wanted++) {
        enum kiln_simd simd = KILN_SIMD_COUNT;
        setenv("KILN_SIMD", kiln_simd_name(wanted), 1);
        assert_int_equal(kiln_simd_choose(&simd, &error), kiln_simd_has(wanted));
        assert_int_equal(simd, kiln_simd_has(wanted) ? wanted : KILN_SIMD_COUNT);
    }
    unsetenv("KILN_SIMD");
}

static void other_names_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"mmx", "sse4.1", "AVX2", "plain "};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct kiln_error error = {0};
        enum kiln_simd simd;
        setenv("KILN_SIMD", names[i], 1);
        assert_false(kiln_simd_choose(&simd, &error));
        expect_error_simd(&error, names[i]);
    }
    unsetenv("KILN_SIMD");
}

/* ---- the stages ------------------------------------------------------------------------------ */

/* Light from none to beyond all ranges, and what is no number. */
static void fill(struct kiln_image *image, uint32_t width, uint32_t height, float most_alpha)
{
    static const float odd[] = {0.0f, -1.0f, 1e30f, 1e-40f, INFINITY, NAN, 65504.0f, 0.0031308f};
    struct kiln_error error = {0};
    kiln_image_init(image, NULL, width, height, GL_RGBA32F, "input");
    float *p = kiln_image_host(image, KILN_OVERWRITE, &error);
    assert_non_null(p);
    for (size_t i = 0; i < (size_t)width * height; i++, p += 4) {
        p[3] = most_alpha * (float)(rand() % 1001) / 1000.0f;
        float light = ldexpf((float)(rand() % 1000) / 1000.0f, rand() % 20 - 12);
        for (int c = 0; c < 3; c++)
            p[c] = rand() % 50 ? light * (float)(rand() % 1001) / 1000.0f : odd[rand() % 8];
    }
}

struct fixture {
    struct kiln_image scene, particles, fire, glow;
};

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    srand(5);
    fill(&f->scene, WIDTH, HEIGHT, 1.0f);
    fill(&f->particles, WIDTH, HEIGHT, 1.0f);
    fill(&f->fire, WIDTH, HEIGHT, 3.0f);
    fill(&f->glow, (WIDTH + 5) / 6, (HEIGHT + 5) / 6, 1.0f);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    kiln_image_finish(&f->scene);
    kiln_image_finish(&f->particles);
    kiln_image_finish(&f->fire);
    kiln_image_finish(&f->glow);
    free(f);
    return 0;
}

/* A picture of bytes that belongs to the caller; its size. */
typedef void *make_picture(struct fixture *f, const struct kiln_scene *scene, uint32_t bits,
                           struct kiln_threads *threads, size_t *size);

static void *compose(struct fixture *f, const struct kiln_scene *scene, uint32_t bits,
                     struct kiln_threads *threads, size_t *size)
{
    struct kiln_error error = {0};
    struct kiln_composite_stage *stage = kiln_composite_create(
        NULL, scene,
        &(struct kiln_composite_params){
            .technique = KILN_COMPOSITE_CPU, .threads = threads, .bits = bits, .beauty = true},
        &error);
    if (!stage)
        fail_msg("%s", error.message);
    const struct kiln_composite_inputs inputs = {.scene = &f->scene,
                                                 .particles = &f->particles,
                                                 .fire = &f->fire,
                                                 .bloom = &f->glow,
                                                 .bloom_scale = 1.0f / 6.0f,
                                                 .frame = 3};
    assert_true(kiln_composite_run(stage, &inputs, &error));
    size_t display = (size_t)FLOATS * bits / 8;
    *size = display + FLOATS * sizeof(float);
    char *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_true(kiln_composite_read_display(stage, bytes, &error));
    float *beauty = malloc(FLOATS * sizeof(float));
    assert_non_null(beauty);
    assert_true(kiln_composite_take_beauty(stage, &beauty, &error));
    for (size_t i = 0; i < FLOATS; i++)
        beauty[i] = isnan(beauty[i]) ? NAN : beauty[i]; /* which of two it comes from is open */
    memcpy(bytes + display, beauty, FLOATS * sizeof(float));
    free(beauty);
    kiln_composite_destroy(&stage);
    return bytes;
}

static void *spread(struct fixture *f, const struct kiln_scene *scene, uint32_t bits,
                    struct kiln_threads *threads, size_t *size)
{
    (void)bits;
    struct kiln_error error = {0};
    struct kiln_image source; /* which the bright pass would overwrite */
    kiln_image_init(&source, NULL, WIDTH, HEIGHT, GL_RGBA32F, "source");
    float *pixels = kiln_image_host(&source, KILN_OVERWRITE, &error);
    assert_non_null(pixels);
    memcpy(pixels, f->particles.host, FLOATS * sizeof(float));
    struct kiln_bloom_stage *stage =
        kiln_bloom_create(NULL, scene,
                          &(struct kiln_bloom_params){.technique = KILN_BLOOM_CPU,
                                                      .threads = threads,
                                                      .source = &source,
                                                      .format = GL_RGBA32F},
                          &error);
    if (!stage)
        fail_msg("%s", error.message);
    const struct kiln_bloom_inputs inputs = {&f->scene, &f->particles, &f->fire, 0.0f};
    float scale;
    struct kiln_image *glow = kiln_bloom_run(stage, &inputs, &scale, &error);
    assert_non_null(glow);
    *size = (size_t)glow->width * glow->height * 4 * sizeof(float);
    void *bytes = malloc(*size);
    assert_non_null(bytes);
    memcpy(bytes, glow->host, *size);
    kiln_bloom_destroy(&stage);
    kiln_image_finish(&source);
    return bytes;
}

static void *make_by(enum kiln_simd simd, uint32_t thread_count, make_picture *make,
                     struct fixture *f, const struct kiln_scene *scene, uint32_t bits, size_t *size)
{
    struct kiln_threads *threads = kiln_threads_create(thread_count);
    assert_non_null(threads);
    setenv("KILN_SIMD", kiln_simd_name(simd), 1);
    void *bytes = make(f, scene, bits, threads, size);
    unsetenv("KILN_SIMD");
    kiln_threads_destroy(&threads);
    return bytes;
}

/* post: of a scene file. */
static void check_all_levels(struct fixture *f, const char *post, uint32_t bits, make_picture *make)
{
    char text[512];
    snprintf(text, sizeof text, "kiln: 1\noutput: {size: [%d, %d]}\npost: {%s}\n", WIDTH, HEIGHT,
             post);
    struct kiln_scene *scene = load_scene(text, NULL);
    size_t size, other_size;
    char *expected = make_by(kiln_simd_narrowest(), 1, make, f, scene, bits, &size);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd)) {
            print_message("no %s here\n", kiln_simd_name(simd));
            continue;
        }
        for (uint32_t threads = 2; threads <= 5; threads += 3) {
            char *found = make_by(simd, threads, make, f, scene, bits, &other_size);
            assert_int_equal(other_size, size);
            if (memcmp(found, expected, size) != 0)
                fail_msg("%s: other pixels by %s, %u threads", post, kiln_simd_name(simd), threads);
            free(found);
        }
    }
    free(expected);
    kiln_scene_destroy(&scene);
}

static void the_composite_is_the_same_bytes(void **state)
{
    check_all_levels(*state, "tonemap: agx, exposure: 1", 8, compose);
    check_all_levels(*state, "tonemap: aces", 16, compose);
    check_all_levels(*state, "tonemap: none, dither: false", 16, compose);
}

static void the_bloom_is_the_same_bytes(void **state)
{
    check_all_levels(*state, "bloom: {kind: gaussian}", 8, spread);
    check_all_levels(*state, "bloom: {kind: thesis}", 8, spread);
    check_all_levels(*state, "bloom: {kind: pyramid, radius: 0.7}", 8, spread);
    check_all_levels(*state, "bloom: {kind: gaussian, source: bright}", 8, spread);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_widest_is_the_default),
        cmocka_unit_test(each_level_has_a_name),
        cmocka_unit_test(other_names_are_refused),
        cmocka_unit_test_setup_teardown(the_composite_is_the_same_bytes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_bloom_is_the_same_bytes, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
