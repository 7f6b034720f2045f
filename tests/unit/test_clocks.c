/* Values over every clock: a scene's value is compared with what the words of the scene mean, in
 * double precision. If this fails, an effect varies in another way than its author wrote. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "particles/lanes.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/scenes.h"

enum { DRAWS = 1000000 };

/* A scene with `text` as the size of a system's particles, which takes every clock. */
static struct kiln_scene *size_scene(const char *text)
{
    char scene[1024];
    snprintf(scene, sizeof scene,
             "kiln: 1\nseed: 5\nsystems: {a: {emit: {rate: 1}, look: {size: %s}}}\n", text);
    return load_scene(scene, NULL);
}

/* The clocks of particle `serial` of the scene's first system. */
static struct value_clocks clocks_of(const struct kiln_scene *scene, uint32_t serial)
{
    const uint32_t key = random_system_key(scene->seed, 0);
    struct value_clocks clocks = kiln_scene_clocks(scene, 0, 1.25f);
    clocks.life = 0.25f;
    clocks.age_s = 0.5f;
    clocks.height = 2.0f;
    clocks.distance = 10.0f;
    clocks.velocity = (float3){3.0f, 0.0f, 4.0f};
    clocks.stream = random_stream(key, serial);
    return clocks;
}

static double value_of(const char *text, const struct value_clocks *given)
{
    struct kiln_scene *scene = size_scene(text);
    const struct value_clocks clocks = given ? *given : clocks_of(scene, 0);
    const double y = (double)value_at(scene->keys, scene->systems[0].look.size, clocks);
    kiln_scene_destroy(&scene);
    return y;
}

static void every_clock_counts(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double y;
    } cases[] = {
        {"{keys: {0 s: 1, 2 s: 3}}", 2.25},
        {"{life: [1, 3]}", 1.5},
        {"{age: {0 s: 1, 1 s: 3}}", 2},
        {"{speed: {0: 1, 10 m/s: 3}}", 2},
        {"{height: {0 m: 1, 8 m: 3}}", 1.5},
        {"{distance: {2 m: 1, 18 m: 3}}", 2},
        {"{keys: {0 s: 1, 2 s: 3}, times: 2}", 4.5},
        {"{keys: {0 s: 1, 2 s: 3}, plus: -1}", 1.25},
        {"{keys: {0 s: 1, 2 s: 3}, times: {life: [0, 2]}, plus: {age: {0 s: 0, 1 s: 1}}}",
         2.25 * 0.5 + 0.5},
        {"{keys: {0 s: 1, 2 s: 3}, times: -2}", 0},      /* the least size */
        {"{keys: {0 s: 1, 2 s: 3}, times: 1000}", 1000}, /* the greatest */
        {"{keys: {0 s: 1, 2 s: 3}, ease: step}", 1},
        {"{keys: {0 s: 1, 1.25 s: 3}, ease: step}", 3}, /* at a key, its own value */
        {"{keys: {0 s: 1, 1 s: 3}, repeat: loop}", 1.5},
        {"{keys: {0 s: 1, 1 s: 3}, repeat: mirror}", 2.5},
        {"{keys: {2 s: 1, 3 s: 3}, repeat: loop}", 1.5}, /* before the first key, too */
        {"{keys: {2 s: 1, 3 s: 3}, repeat: mirror}", 2.5},
        {"{age: {0 s: 1, 0.4 s: 3}, repeat: loop}", 1.5},
        {"{keys: {3 s: 7}, repeat: loop}", 7},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double y = value_of(cases[i].text, NULL);
        if (!(fabs(y - cases[i].y) <= 1e-6 * fmax(1, fabs(cases[i].y))))
            fail_msg("%s is %.9g, not %.9g", cases[i].text, y, cases[i].y);
    }
}

/* An ease between 1 and 3, at a part of the way. */
static double eased(const char *ease, double t)
{
    t = fmin(fmax(t, 0), 1);
    const double way = strcmp(ease, "smooth") == 0 ? t * t * (3 - 2 * t)
                       : strcmp(ease, "in") == 0   ? t * t
                       : strcmp(ease, "out") == 0  ? 2 * t - t * t
                       : strcmp(ease, "step") == 0 ? floor(t)
                                                   : t;
    return 1 + 2 * way;
}

static void eases_are_their_polynomials(void **state)
{
    (void)state;
    static const char *const eases[] = {"linear", "step", "smooth", "in", "out"};
    for (size_t e = 0; e < sizeof eases / sizeof *eases; e++) {
        char text[96];
        snprintf(text, sizeof text, "{keys: {0.5 s: 1, 3 s: 3}, ease: %s}", eases[e]);
        struct kiln_scene *scene = size_scene(text);
        const struct kiln_value *size = &scene->systems[0].look.size;
        for (int i = -100; i <= 400; i++) {
            const float time_s = (float)i * 0.01f;
            const struct value_clocks now = kiln_scene_clocks(scene, 0, time_s);
            const double y = (double)value_at(scene->keys, *size, now);
            const double expected = eased(eases[e], ((double)time_s - 0.5) / 2.5);
            if (!(fabs(y - expected) < 1e-5) || y < 1 || y > 3)
                fail_msg("%s at %g s is %.9g, not %.9g", eases[e], (double)time_s, y, expected);
            /* the rate is the slope of the value */
            const double h = 1e-3;
            const double rate = (double)value_rate_at(scene->keys, *size, now);
            const double slope = (eased(eases[e], ((double)time_s - 0.5 + h) / 2.5) -
                                  eased(eases[e], ((double)time_s - 0.5 - h) / 2.5)) /
                                 (2 * h);
            const bool kink =
                fabs((double)time_s - 0.5) < 2 * h || fabs((double)time_s - 3) < 2 * h;
            if (!kink && !(fabs(rate - slope) < 2e-3))
                fail_msg("%s rises by %g at %g s, not %g", eases[e], rate, (double)time_s, slope);
        }
        kiln_scene_destroy(&scene);
    }
}

/* Counts how often draws of a value are near each of some numbers, or between them. */
static void count_draws(const char *text, const double *bounds, size_t bins, uint32_t *counts)
{
    struct kiln_scene *scene = size_scene(text);
    const struct kiln_value size = scene->systems[0].look.size;
    memset(counts, 0, bins * sizeof *counts);
    for (uint32_t serial = 0; serial < DRAWS; serial++) {
        const double y = (double)value_at(scene->keys, size, clocks_of(scene, serial));
        size_t bin = 0;
        while (bin < bins && !(y >= bounds[bin] && y < bounds[bin + 1]))
            bin++;
        if (bin == bins)
            fail_msg("%s draws %.9g", text, y);
        counts[bin]++;
    }
    kiln_scene_destroy(&scene);
}

/* Chi-square of counts against expected parts. */
static double chi_square(const uint32_t *counts, const double *parts, size_t bins)
{
    double sum = 0;
    for (size_t i = 0; i < bins; i++) {
        const double expected = parts[i] * DRAWS;
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
    return sum;
}

/* The limits are the quantiles of 1 - 1e-6 of chi-square. */
static void random_values_have_their_distribution(void **state)
{
    (void)state;
    uint32_t counts[20];
    double bounds[21], parts[20];
    for (int i = 0; i <= 20; i++)
        bounds[i] = 0.2 + 0.4 * i / 20;
    bounds[20] += 1e-6;
    for (int i = 0; i < 20; i++)
        parts[i] = 0.05;
    count_draws("{random: [0.2, 0.6]}", bounds, 20, counts);
    assert_true(chi_square(counts, parts, 20) < 60.0);

    /* quantiles: 90 % are in [0.6, 1.2], the others in [1.2, 3] */
    const double quantiles[] = {0.6, 0.9, 1.2, 2.1, 3.0 + 1e-6};
    const double shares[] = {0.45, 0.45, 0.05, 0.05};
    count_draws("{random: {0: 0.6, 0.9: 1.2, 1: 3}}", quantiles, 4, counts);
    assert_true(chi_square(counts, shares, 4) < 30.7);

    /* choices */
    const double about[] = {0.5, 1.5, 2.5, 3.5};
    const double weights[] = {0.6, 0.2, 0.2};
    count_draws("{choose: [1, 2, 3], weights: [3, 1, 1]}", about, 3, counts);
    assert_true(chi_square(counts, weights, 3) < 27.7);
    const double without[] = {0.75, 1e-9, 0.25};
    count_draws("{choose: [1, 2, 3], weights: [3, 0, 1]}", about, 3, counts);
    assert_true(chi_square(counts, without, 3) < 27.7);
    const double even[] = {1 / 3.0, 1 / 3.0, 1 / 3.0};
    count_draws("{choose: [1, 2, 3]}", about, 3, counts);
    assert_true(chi_square(counts, even, 3) < 27.7);
}

/* Correlation of two values of one system over many particles. */
static double correlation(const struct kiln_scene *scene, const struct kiln_value *a,
                          const struct kiln_value *b)
{
    double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
    const int n = 20000;
    for (int i = 0; i < n; i++) {
        const struct value_clocks clocks = clocks_of(scene, (uint32_t)i);
        const double x = (double)value_at(scene->keys, *a, clocks);
        const double y = (double)value_at(scene->keys, *b, clocks);
        sum_a += x;
        sum_b += y;
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    return (ab - sum_a * sum_b / n) / sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
}

/* Rows draw apart from each other, a vector draws once as a whole, and a seed is shared. */
static void draws_have_their_identity(void **state)
{
    (void)state;
    struct kiln_scene *scene =
        load_scene("kiln: 1\n"
                   "systems:\n"
                   "  a:\n"
                   "    emit: {rate: 1, life: {random: [1, 2]}, speed: {random: [1, 2]}}\n"
                   "    forces: [{drag: {random: [0, 1]}}, {drag: {random: [0, 1]}}]\n"
                   "    look:\n"
                   "      size: {random: [0, 1], times: {random: [0, 1]}, seed: 7}\n"
                   "      stretch: {random: [0, 1], seed: 7}\n"
                   "      opacity: {random: [0, 1]}\n"
                   "      color: {random: [[0, 0, 0], [1, 1, 1]]}\n"
                   "      bloom: [{random: [0, 1]}, {random: [0, 1]}, 0]\n",
                   NULL);
    const struct kiln_system *a = &scene->systems[0];
    const struct kiln_look *look = &a->look;
    const struct kiln_value *apart[][2] = {
        {&a->emit.life.min, &a->emit.speed.min},  {&a->emit.life.min, &look->opacity},
        {&a->forces[0].pull, &a->forces[1].pull}, {&look->opacity, &look->color.x},
        {&look->bloom.x, &look->bloom.y},         {&look->bloom.x, &look->opacity},
        {&look->stretch, &look->opacity},
    };
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++) {
        const double r = correlation(scene, apart[i][0], apart[i][1]);
        if (!(fabs(r) < 0.04))
            fail_msg("pair %zu of values is correlated by %g", i, r);
    }
    assert_true(correlation(scene, &look->color.x, &look->color.y) > 0.9999);
    assert_true(correlation(scene, &look->color.x, &look->color.z) > 0.9999);
    /* size is the draw of the seed times another one */
    assert_true(correlation(scene, &look->size, &look->stretch) > 0.5);
    kiln_scene_destroy(&scene);
}

/* A lamp whose noise has the seed of a flame's flickers with it. */
static void noises_of_one_seed_agree(void **state)
{
    (void)state;
    struct kiln_scene *scene = load_scene(
        "kiln: 1\n"
        "backdrop:\n"
        "  lights:\n"
        "    - point: {color: {noise: [[0, 0, 0], [1, 1, 1]], period: 0.2 s, octaves: 2, seed: "
        "3}}\n"
        "    - point: {color: {noise: [[0, 0, 0], [1, 1, 1]], period: 0.2 s, octaves: 2}}\n"
        "systems:\n"
        "  other: {}\n"
        "  flame: {look: {intensity: {noise: [0, 1], period: 0.2 s, octaves: 2, per: system,\n"
        "    seed: 3}}}\n",
        NULL);
    const struct kiln_light *lights = scene->backdrop.lights;
    double apart = 0;
    for (int i = 0; i < 200; i++) {
        const float time_s = (float)i * 0.03f;
        const float flame =
            kiln_scene_system_value(scene, 1, &scene->systems[1].look.intensity, time_s);
        const float same = kiln_scene_value(scene, &lights[0].color.x, time_s);
        const float other = kiln_scene_value(scene, &lights[1].color.x, time_s);
        assert_true(FLOAT_BITS(flame) == FLOAT_BITS(same));
        apart = fmax(apart, fabs((double)other - (double)same));
    }
    assert_true(apart > 0.2);
    kiln_scene_destroy(&scene);
}

static void noise_is_smooth_and_keeps_its_ends(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{noise: [2, 3], period: 0.3 s, per: particle}",
        "{noise: [2, 3], period: 0.3 s, octaves: 3, per: particle}",
        "{noise: [2, 3], period: 0.3 s, octaves: 2, per: system}",
    };
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        struct kiln_scene *scene = size_scene(texts[t]);
        const struct kiln_value size = scene->systems[0].look.size;
        struct value_clocks clocks = clocks_of(scene, 3), other = clocks_of(scene, 4);
        double least = 9, most = 0, before = -1, apart = 0, roughest = 0;
        for (int i = -3000; i < 30000; i++) {
            clocks.time_s = other.time_s = (float)i * 0.001f;
            const double y = (double)value_at(scene->keys, size, clocks);
            const double rate = (double)value_rate_at(scene->keys, size, clocks);
            least = fmin(least, y);
            most = fmax(most, y);
            apart = fmax(apart, fabs(y - (double)value_at(scene->keys, size, other)));
            if (before >= 0)
                roughest = fmax(roughest, fabs(y - before - 0.001 * rate));
            before = y;
        }
        assert_true(least >= 2 && most <= 3 && least < 2.2 && most > 2.8);
        assert_true(roughest < 1e-3); /* an octave bends by at most 6 / (0.3 s)^2 for a rise of 1 */
        assert_true(t == 2 ? apart == 0 : apart > 0.3);
        kiln_scene_destroy(&scene);
    }
}

/* At whole periods, noise has numbers that do not depend on each other, and between two of them it
 * goes from one to the other. */
static void noise_has_its_period(void **state)
{
    (void)state;
    struct kiln_scene *scene = size_scene("{noise: [0, 1], period: 0.5 s}");
    const struct kiln_value size = scene->systems[0].look.size;
    struct value_clocks clocks = clocks_of(scene, 1);
    double sum = 0, squares = 0, products = 0, before = 0;
    const int n = 4000;
    for (int i = 0; i < n; i++) {
        clocks.time_s = (float)i * 0.5f;
        const double here = (double)value_at(scene->keys, size, clocks);
        clocks.time_s += 0.25f;
        const double middle = (double)value_at(scene->keys, size, clocks);
        clocks.time_s += 0.25f;
        const double next = (double)value_at(scene->keys, size, clocks);
        assert_true(fabs(middle - 0.5 * (here + next)) < 1e-5);
        sum += here;
        squares += here * here;
        products += i > 0 ? here * before : 0;
        before = here;
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    assert_true(fabs(mean - 0.5) < 0.03 && fabs(variance - 1 / 12.0) < 0.006);
    assert_true(fabs(products / n - mean * mean) < 0.006);
    kiln_scene_destroy(&scene);
}

/* The loops over lanes give the bits of value_at. */
static void lanes_have_the_same_bits(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "1.5",
        "{keys: {0 s: 1, 2 s: 3}}",
        "{life: [1, 3, 2]}",
        "{age: {0 s: 1, 1 s: 3}}",
        "{speed: {0: 1, 10 m/s: 3}}",
        "{height: {0 m: 1, 8 m: 3}, ease: smooth}",
        "{random: {0: 0.6, 0.9: 1.2, 1: 3}}",
        "{choose: [1, 2, 3], weights: [1, 5, 2]}",
        "{noise: [1, 2], octaves: 3, period: 0.2 s}",
        "{life: [0, 1], times: {random: [0.5, 2]}, plus: {noise: [-1, 1]}}",
        "{age: {0 s: 1, 0.3 s: 2}, repeat: mirror, ease: in, times: {keys: {0 s: 1, 9 s: 2}}}",
        "{life: [0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1]}", /* longer than KILN_SHORT_CURVE */
    };
    static kiln_floats life, age_s, found;
    static struct kiln_floats3 position, velocity;
    static uint32_t stream[KILN_LANES];
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        struct kiln_scene *scene = size_scene(texts[t]);
        const struct kiln_value size = scene->systems[0].look.size;
        const uint32_t key = random_system_key(scene->seed, 0);
        for (uint32_t i = 0; i < KILN_LANES; i++) {
            life[i] = (float)i / KILN_LANES;
            age_s[i] = (float)i * 0.03f;
            kiln_set3(&position, i, (float3){0, (float)i * 0.1f - 2, 0});
            kiln_set3(&velocity, i, (float3){(float)i * 0.1f, 1, 0});
            stream[i] = random_stream(key, i);
        }
        const struct kiln_lane_clocks clocks = {.same_time_s = 1.7f,
                                                .life = life,
                                                .age_s = age_s,
                                                .position = &position,
                                                .velocity = &velocity,
                                                .stream = stream,
                                                .system = key};
        kiln_lanes_values(scene->keys, size, &clocks, found);
        for (uint32_t i = 0; i < KILN_LANES; i++) {
            const float y = value_at(scene->keys, size, kiln_lane_clocks_at(&clocks, i));
            if (FLOAT_BITS(y) != FLOAT_BITS(found[i]))
                fail_msg("%s: lane %u has %.9g, not %.9g", texts[t], i, (double)found[i],
                         (double)y);
        }
        kiln_scene_destroy(&scene);
    }
}

/* What is printed is read again as the same value, and prints the same. */
static void values_survive_printing(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{keys: {0 s: 1, 2 s: 3}, ease: smooth, repeat: mirror}",
        "{age: {0 s: 1, 2 s: 3}, times: {random: [1, 2], ease: out}, plus: {noise: [-1, 1]}}",
        "{random: [1, 2], seed: 77}",
        "{random: {0: 1, 0.3: 2, 1: 5}, ease: step}",
        "{choose: [1, 2, 3, 4, 5, 6, 7]}",
        "{choose: [1, 2, 3], weights: [0.1, 0.7, 3]}",
        "{noise: [0.1, 0.7], period: 0.123 s, octaves: 4, per: system, seed: 0}",
        "{distance: {2 m: 1, 40 m: 0}}",
        "{speed: {0: 1, 20 m/s: 2}, times: 0.3}",
    };
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        struct kiln_scene *scene = size_scene(texts[t]);
        char *printed = print_scene(scene);
        struct kiln_scene *again = load_scene(printed, NULL);
        char *twice = print_scene(again);
        assert_string_equal(printed, twice);
        for (uint32_t serial = 0; serial < 50; serial++) {
            struct value_clocks clocks = clocks_of(scene, serial);
            clocks.time_s = (float)serial * 0.07f;
            const float a = value_at(scene->keys, scene->systems[0].look.size, clocks);
            const float b = value_at(again->keys, again->systems[0].look.size, clocks);
            assert_int_equal(FLOAT_BITS(a), FLOAT_BITS(b));
        }
        free(printed);
        free(twice);
        kiln_scene_destroy(&scene);
        kiln_scene_destroy(&again);
    }
}

/* A limit of a value is never passed, whatever the clocks show. */
static void limits_hold(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{random: [0.2, 0.6], times: {life: [1, 3]}, plus: {noise: [-0.1, 0.4], octaves: 2}}",
        "{keys: {0 s: 1, 1 s: 0.1}, ease: smooth, repeat: loop, times: {random: [-1, 2]}}",
        "{choose: [3, 1, 2], plus: {random: [-0.5, 0.5]}}",
    };
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        struct kiln_scene *scene = size_scene(texts[t]);
        const struct kiln_value *size = &scene->systems[0].look.size;
        const float most = kiln_value_most(scene->keys, size);
        const float least = kiln_value_least(scene->keys, size);
        for (uint32_t serial = 0; serial < 20000; serial++) {
            struct value_clocks clocks = clocks_of(scene, serial);
            clocks.time_s = (float)serial * 0.013f - 50;
            clocks.life = (float)(serial % 101) / 100;
            const float y = value_at(scene->keys, *size, clocks);
            assert_true(y >= least && y <= most);
        }
        kiln_scene_destroy(&scene);
    }
}

/* A random life takes slots for its longest. */
static void capacity_follows_the_longest_life(void **state)
{
    (void)state;
    struct kiln_scene *fixed = load_scene(
        "kiln: 1\nsystems: {a: {emit: {rate: 100, life: 6 s}}}\noutput: {frames: 900}\n", NULL);
    struct kiln_scene *drawn = load_scene("kiln: 1\nsystems: {a: {emit: {rate: 100, life: {random: "
                                          "[1, 2], times: {choose: [1, 3]}}}}}"
                                          "\noutput: {frames: 900}\n",
                                          NULL);
    assert_int_equal(fixed->systems[0].capacity, drawn->systems[0].capacity);
    kiln_scene_destroy(&fixed);
    kiln_scene_destroy(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_clock_counts),
        cmocka_unit_test(eases_are_their_polynomials),
        cmocka_unit_test(random_values_have_their_distribution),
        cmocka_unit_test(draws_have_their_identity),
        cmocka_unit_test(noises_of_one_seed_agree),
        cmocka_unit_test(noise_is_smooth_and_keeps_its_ends),
        cmocka_unit_test(noise_has_its_period),
        cmocka_unit_test(lanes_have_the_same_bits),
        cmocka_unit_test(values_survive_printing),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(capacity_follows_the_longest_life),
    };
    return cmocka_run_group_tests_name("clocks", tests, NULL, NULL);
}
