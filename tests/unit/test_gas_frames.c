/* Frames with gas: with some composition it would be missing, or be drawn twice, layers would lack
 * it, its flames would not glow, or a scene without gas would change. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/gas_frame.h"

enum { WIDTH = 48, HEIGHT = 36, MIDDLE = (HEIGHT / 2 * WIDTH + WIDTH / 2) * 4 };

/* A camera that looks at the middle of the gas, which is 2 m deep there. */
static const char EMPTY[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, floor: none, sky: {top: [0.5, 0.5, 0.5], horizon: [0.5, 0.5, 0.5]}}\n"
    "post: {bloom: {kind: none}}\n";

static const char WITH_PARTICLES[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, floor: none, sky: {top: [0.5, 0.5, 0.5], horizon: [0.5, 0.5, 0.5]}}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 600, life: 1 s, from: {point: {origin: [0, 1, 2]}}}\n"
    "    look: {size: 3 m, opacity: 1, shape: point, blend: alpha, color: [0, 0, 0]}\n"
    "  fire:\n"
    "    emit: {rate: 60, life: 1 s, from: {point: {origin: [0, 1, -3]}}}\n"
    "    look: {blend: add, size: 0.4 m, shape: point, color: [3, 2, 1]}\n"
    "  balls:\n"
    "    emit: {rate: 2, life: 1 s, from: {point: {origin: [0.6, 1, 0]}}}\n"
    "    look: {shape: sphere, size: 0.6 m, lit: 0, color: [0.1, 0.2, 0.3], bloom: 1}\n"
    "post: {bloom: {kind: none}}\n";

static const char *const COMPOSE[] = {"post.compose=merged", "post.compose=separate",
                                      "post.compose=alpha", "post.compose=oit"};

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most))
        fail_msg("found %.6f, expected %.6f within %g", found, expected, most);
}

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static const double HIDDEN = 1.0 - 0.36787944117144233; /* extinction 0.5 over 2 m */

static void all_compositions_show_gas(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct gas_frame frame = {.text = EMPTY,
                                        .overrides = {COMPOSE[i]},
                                        .count = 1,
                                        .domain = true,
                                        .smoke = 1.0f,
                                        .flame = 0.1f,
                                        .techniques = FRAME_CPU};
        struct kiln_picture *picture = gas_frame_draw(NULL, &frame);
        const double flames = 0.2 / 0.5 * HIDDEN; /* emission / extinction */
        assert_near(luminance(picture->layers[FRAME_BEAUTY].pixels + MIDDLE),
                    0.5 * (1.0 - HIDDEN) + flames, 2e-3);
        const float *smoke = picture->layers[FRAME_SMOKE].pixels + MIDDLE;
        const float *fire = picture->layers[FRAME_FIRE].pixels + MIDDLE;
        assert_near((double)smoke[3], HIDDEN, 1e-4);
        assert_near(luminance(smoke), 0.0, 1e-6);
        assert_near(luminance(fire), flames, 2e-3);
        assert_near(luminance(picture->layers[FRAME_BLOOM].pixels + MIDDLE), 0.25 * flames, 1e-3);
        kiln_picture_destroy(&picture);
    }
}

static void gas_covers_a_transparent_backdrop(void **state)
{
    (void)state;
    const struct gas_frame frame = {.text = EMPTY,
                                    .overrides = {"backdrop.transparent=true"},
                                    .count = 1,
                                    .domain = true,
                                    .smoke = 1.0f,
                                    .techniques = FRAME_CPU};
    struct kiln_picture *picture = gas_frame_draw(NULL, &frame);
    const float *pixel = picture->layers[FRAME_BEAUTY].pixels + MIDDLE;
    assert_near((double)pixel[3], HIDDEN, 1e-4);
    assert_near(luminance(pixel), 0.0, 1e-6);
    assert_true(picture->layers[FRAME_BEAUTY].pixels[3] == 0.0f);
    kiln_picture_destroy(&picture);
}

/* All moments of a frame have the gas of one step, so their mean is that of one. */
static void moments_show_the_same_gas(void **state)
{
    (void)state;
    struct gas_frame frame = {
        .text = EMPTY, .domain = true, .smoke = 1.0f, .flame = 0.1f, .techniques = FRAME_CPU};
    struct kiln_picture *one = gas_frame_draw(NULL, &frame);
    frame.overrides[0] = "camera.shutter.samples=3";
    frame.count = 1;
    struct kiln_picture *three = gas_frame_draw(NULL, &frame);
    for (int layer = 0; layer < FRAME_LAYERS; layer++)
        assert_near(frame_difference(one, three, layer), 0.0, 1e-5);
    kiln_picture_destroy(&one);
    kiln_picture_destroy(&three);
}

/* Holds pictures of a scene without gas, and with it. */
struct both {
    struct kiln_picture *without, *with;
};

static struct both draw_both(struct gas_frame frame, float smoke, float flame)
{
    struct both both = {.without = gas_frame_draw(NULL, &frame)};
    frame.domain = true;
    frame.smoke = smoke;
    frame.flame = flame;
    both.with = gas_frame_draw(NULL, &frame);
    return both;
}

static void finish_both(struct both *both)
{
    kiln_picture_destroy(&both->without);
    kiln_picture_destroy(&both->with);
}

static void particles_lie_over_gas(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        struct gas_frame frame = {
            .text = WITH_PARTICLES,
            .overrides = {COMPOSE[i % 4], i < 4 ? "post.particles.resolution=full"
                                                : "post.particles.resolution=half"},
            .count = 2,
            .steps = 20,
            .techniques = FRAME_CPU};
        struct both both = draw_both(frame, 0.0f, 0.5f);
        /* The black squares hide the gas in the middle; with `separate`, flames shine through. */
        const float *beauty = both.with->layers[FRAME_BEAUTY].pixels;
        const double before = luminance(both.without->layers[FRAME_BEAUTY].pixels + MIDDLE);
        const double flames = i % 4 == 1 ? 2.0 : 0.0;
        assert_near(luminance(beauty + MIDDLE), before + flames, 5e-3);
        assert_near(luminance(both.with->layers[FRAME_BLOOM].pixels + MIDDLE), 0.25 * flames, 5e-3);
        finish_both(&both);
    }
}

/* A ball that glows behind the gas, in the middle of the picture. */
static const char GLOWING[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, floor: none}\n"
    "systems:\n"
    "  ball:\n"
    "    emit: {rate: 60, life: 1 s, speed: 0, from: {point: {origin: [0, 1, -4]}}}\n"
    "    look: {shape: sphere, size: 1 m, lit: 0, color: [2, 2, 2], bloom: 1}\n"
    "post: {bloom: {kind: none}}\n";

static void gas_dims_the_glow_behind_it(void **state)
{
    (void)state;
    struct gas_frame frame = {.text = GLOWING, .steps = 20, .techniques = FRAME_CPU};
    struct both both = draw_both(frame, 1.0f, 0.0f);
    const double before = luminance(both.without->layers[FRAME_BLOOM].pixels + MIDDLE);
    assert_true(before > 0.5);
    assert_near(luminance(both.with->layers[FRAME_BLOOM].pixels + MIDDLE), before * (1.0 - HIDDEN),
                2e-3);
    finish_both(&both);
}

/* A square of fire behind the gas, in the middle of the picture, which does not glow. */
static const char BEHIND[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, floor: none}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {rate: 60, life: 1 s, speed: 0, from: {point: {origin: [0, 1, -3]}}}\n"
    "    look: {blend: add, size: 1 m, shape: point, color: [0.3, 0.2, 0.1]}\n"
    "post: {bloom: {kind: none}}\n";

/* Flames would be seen twice where fire is behind them. */
static void fire_behind_flames_adds_to_them(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct gas_frame frame = {.text = BEHIND,
                                  .overrides = {COMPOSE[i]},
                                  .count = 1,
                                  .steps = 20,
                                  .techniques = FRAME_CPU};
        struct both both = draw_both(frame, 1.0f, 0.1f);
        const double flames = 0.2 / 0.5 * HIDDEN;
        const double before = luminance(both.without->layers[FRAME_FIRE].pixels + MIDDLE);
        assert_true(before > 0.1);
        assert_near(luminance(both.with->layers[FRAME_FIRE].pixels + MIDDLE),
                    before * (1.0 - HIDDEN) + flames, 3e-3);
        assert_near(luminance(both.with->layers[FRAME_BLOOM].pixels + MIDDLE), 0.25 * flames, 1e-3);
        finish_both(&both);
    }
}

static void a_domain_without_gas_changes_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct gas_frame frame = {.text = WITH_PARTICLES,
                                  .overrides = {COMPOSE[i]},
                                  .count = 1,
                                  .steps = 20,
                                  .techniques = FRAME_CPU};
        struct both both = draw_both(frame, 0.0f, 0.0f);
        assert_memory_equal(both.without->display, both.with->display, WIDTH * HEIGHT * 4);
        for (int layer = 0; layer < FRAME_LAYERS; layer++)
            assert_near(frame_difference(both.without, both.with, layer), 0.0, 1e-6);
        finish_both(&both);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_compositions_show_gas),
        cmocka_unit_test(gas_covers_a_transparent_backdrop),
        cmocka_unit_test(moments_show_the_same_gas),
        cmocka_unit_test(particles_lie_over_gas),
        cmocka_unit_test(gas_dims_the_glow_behind_it),
        cmocka_unit_test(fire_behind_flames_adds_to_them),
        cmocka_unit_test(a_domain_without_gas_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
