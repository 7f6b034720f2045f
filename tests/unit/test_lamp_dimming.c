/* lib/draw/light/lamp_smoke and lamp_shade: the optical depth of smoke around a lamp against an
 * integral along each ray, and the part of a lamp that particles see against many rays. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/lamps.h"
#include "draw/light/ray_smoke.h"
#include "draw/light/shade_blocks.h"
#include "support/cmocka.h"
#include "support/placed.h"

static double between(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

/* ---- smoke around a lamp --------------------------------------------------------------------- */

enum { PUFFS = 1600, PLACES = 60 };

static struct kiln_puff puffs[PUFFS];
static const double PUFF_RADIUS = 0.25, EXTINCTION = 0.25; /* m; in the middle of a puff, 1/m */

/* Places the puffs in three clouds, which become thinner outwards. */
static void place_puffs(void)
{
    static const double clouds[3][3] = {{0, 1, 0}, {1.5, 1.4, -0.3}, {-1, 2.6, 0.5}};
    const double volume = PUFF_RADIUS * PUFF_RADIUS * PUFF_RADIUS * 32 * acos(-1.0) / 105;
    srand(4);
    for (int i = 0; i < PUFFS; i++) {
        double at[3];
        for (int c = 0; c < 3; c++)
            at[c] = clouds[i % 3][c] + between(-0.5, 0.5) + between(-0.5, 0.5);
        puffs[i] = (struct kiln_puff){{(float)at[0], (float)at[1], (float)at[2]},
                                      (float)PUFF_RADIUS,
                                      (float)(EXTINCTION * volume)};
    }
}

/* Returns the extinction at a place: for each puff (1 - d^2)^2 of that in its middle, at d radii.
 */
static double extinction_at(const double place[3])
{
    double sum = 0;
    for (int i = 0; i < PUFFS; i++) {
        const double from[3] = {place[0] - (double)puffs[i].position.x,
                                place[1] - (double)puffs[i].position.y,
                                place[2] - (double)puffs[i].position.z};
        const double inside = 1 - (from[0] * from[0] + from[1] * from[1] + from[2] * from[2]) /
                                      (PUFF_RADIUS * PUFF_RADIUS);
        sum += inside > 0 ? EXTINCTION * inside * inside : 0;
    }
    return sum;
}

/* Returns the optical depth from the surface of a lamp to a place. */
static double true_depth(const double lamp[3], double radius, const double place[3])
{
    enum { STEPS = 150 };
    double way[3], length = 0, sum = 0;
    for (int i = 0; i < 3; i++) {
        way[i] = place[i] - lamp[i];
        length += way[i] * way[i];
    }
    length = sqrt(length);
    if (length <= radius)
        return 0;
    for (int k = 0; k < STEPS; k++) {
        const double t = (radius + (length - radius) * (k + 0.5) / STEPS) / length;
        sum += extinction_at(
            (double[]){lamp[0] + t * way[0], lamp[1] + t * way[1], lamp[2] + t * way[2]});
    }
    return sum * (length - radius) / STEPS;
}

/* Holds the grid of the puffs, and memory for what is made of it. */
struct smoke_fixture {
    struct kiln_threads *threads;
    struct kiln_smoke_shadow *shadow;
    struct kiln_smoke_grid grid;
    float depth[KILN_SMOKE_GRID * KILN_SMOKE_GRID * KILN_SMOKE_GRID];
    float extinction[KILN_SMOKE_COARSE * KILN_SMOKE_COARSE * KILN_SMOKE_COARSE];
};

static struct smoke_fixture *fill_grid(uint32_t threads)
{
    struct smoke_fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    uint32_t count = PUFFS;
    const struct kiln_smoke smoke = {.puffs = puffs, .counts = &count, .chunk_count = 1};
    place_puffs();
    f->threads = kiln_threads_create(threads);
    f->shadow = kiln_smoke_shadow_create();
    assert_true(f->threads && f->shadow);
    f->grid = (struct kiln_smoke_grid){
        .direction = {0, 1, 0}, .depth = f->depth, .extinction = f->extinction};
    assert_true(kiln_smoke_shadow_fill(f->shadow, &smoke, f->threads, &f->grid, 1));
    return f;
}

static void free_grid(struct smoke_fixture *f)
{
    kiln_smoke_shadow_destroy(&f->shadow);
    kiln_threads_destroy(&f->threads);
    free(f);
}

/* Lamps inside of smoke, beside it and far from it; a wide one; one that smoke does not dim. */
static const struct kiln_draw_light LAMPS[] = {
    {.position_radius2 = {0.2f, 1.1f, 0.1f, 0.0025f}, .color = {1, 1, 1, 0.05f}, .casters.w = 1},
    {.position_radius2 = {-2.0f, 0.4f, 1.0f, 0.01f}, .color = {1, 1, 1, 0.1f}, .casters.w = 1},
    {.position_radius2 = {9.0f, 7.0f, 5.0f, 0.01f}, .color = {1, 1, 1, 0.1f}, .casters.w = 1},
    {.position_radius2 = {0.0f, 1.5f, 0.0f, 0.36f}, .color = {1, 1, 1, 0.6f}, .casters.w = 1},
    {.position_radius2 = {0.0f, 1.0f, 0.0f, 0.01f}, .color = {1, 1, 1, 0.1f}, .casters.w = 0},
};
enum { LAMP_COUNT = sizeof LAMPS / sizeof *LAMPS };

static const float *run(const struct smoke_fixture *f, struct kiln_lamp_smoke *smoke,
                        struct kiln_draw_light *lights, uint32_t *count)
{
    struct kiln_error error = {0};
    memcpy(lights, LAMPS, sizeof LAMPS);
    const float *maps =
        kiln_lamp_smoke_run(smoke, &f->grid, f->threads, lights, LAMP_COUNT, count, &error);
    assert_non_null(maps);
    return maps;
}

static void smoke_dims_a_lamp_by_its_optical_depth(void **state)
{
    (void)state;
    struct smoke_fixture *f = fill_grid(2);
    struct kiln_lamp_smoke *smoke = kiln_lamp_smoke_create(kiln_simd_narrowest());
    struct kiln_draw_light lights[LAMP_COUNT];
    uint32_t count;
    const float *maps = run(f, smoke, lights, &count);
    assert_int_equal(count, LAMP_COUNT - 1);
    srand(5);
    double sums[LAMP_COUNT] = {0}, most = 0;
    for (int k = 0; k < PLACES; k++) {
        const double place[3] = {between(-4, 4), between(-1, 5), between(-3, 3)};
        const struct ray_point point = {
            .at = {vf_all((float)place[0]), vf_all((float)place[1]), vf_all((float)place[2])},
            .active = vi_all(-1)};
        for (int i = 0; i < LAMP_COUNT; i++) {
            const float4 at = LAMPS[i].position_radius2;
            const double lamp[3] = {(double)at.x, (double)at.y, (double)at.z};
            const double expected =
                LAMPS[i].casters.w ? true_depth(lamp, (double)LAMPS[i].color.w, place) : 0;
            const double found = (double)lamp_smoke_depth(maps, &lights[i], &point)[0];
            const double difference = fabs(exp(-found) - exp(-expected));
            if (difference > 0.25) /* at the edge of a cloud, whose texel is wide there */
                fail_msg("lamp %d, place %g %g %g: depth %g, expected %g", i, place[0], place[1],
                         place[2], found, expected);
            sums[i] += difference / PLACES;
            most = fmax(most, expected);
        }
    }
    for (int i = 0; i < LAMP_COUNT; i++) {
        print_message("lamp %d: the part of its light is wrong by %.4f on average\n", i, sums[i]);
        assert_true(sums[i] < 0.04);
    }
    assert_true(most > 1.5); /* the places are in the shade, too */
    kiln_lamp_smoke_destroy(&smoke);
    free_grid(f);
}

/* Makes maps where other numbers, which are none, were before. */
static const float *run_again(const struct smoke_fixture *f, struct kiln_lamp_smoke *smoke,
                              struct kiln_draw_light *lights, uint32_t *count)
{
    const float *before = run(f, smoke, lights, count);
    memset((void *)before, 0xff, *count * KILN_LAMP_SMOKE_MAP * sizeof *before);
    return run(f, smoke, lights, count);
}

static void maps_are_the_same_for_all_widths_and_threads(void **state)
{
    (void)state;
    struct smoke_fixture *f = fill_grid(1), *threaded = fill_grid(3);
    struct kiln_lamp_smoke *plain = kiln_lamp_smoke_create(kiln_simd_narrowest());
    struct kiln_draw_light lights[LAMP_COUNT];
    uint32_t count;
    const float *expected = run_again(f, plain, lights, &count);
    for (size_t i = 0; i < count * KILN_LAMP_SMOKE_MAP; i++)
        assert_true(isfinite(expected[i]));
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        struct kiln_lamp_smoke *smoke = kiln_lamp_smoke_create(simd);
        const float *maps = run(threaded, smoke, lights, &count);
        assert_memory_equal(maps, expected, count * KILN_LAMP_SMOKE_MAP * sizeof *maps);
        kiln_lamp_smoke_destroy(&smoke);
    }
    kiln_lamp_smoke_destroy(&plain);
    free_grid(f);
    free_grid(threaded);
}

/* ---- particles behind objects ---------------------------------------------------------------- */

/* One object of each kind, apart from each other. The lamp is at AT. */
static const char SHAPES[] =
    "kiln: 1\n"
    "output: {fps: 60}\n"
    "backdrop:\n"
    "  floor: none\n"
    "  lights:\n"
    "    - point: {position: [0, 2, 0], color: 1, radius: 0.15 m}\n"
    "  objects:\n"
    "    - box: {center: [2, 2, 0], size: [0.5, 1, 0.8]}\n"
    "    - sphere: {center: [-2, 2, 0], radius: 0.5 m}\n"
    "    - cylinder: {center: [0, 2, 2], axis: [1, 1, 0], radius: 0.3 m, height: 1.2 m}\n"
    "    - capsule: {center: [0, 2, -2], axis: [1, -0.5, 0], radius: 0.3 m, height: 1.4 m}\n"
    "    - box: {center: [0, 4, 0], size: [0.9, 0.4, 0.6], rotation: [20 deg, 30 deg, 0 deg]}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {life: 1 s}\n"
    "    look: {size: 0.5 m, opacity: 0.5, lit: 1, fade: {in: 0, out: 0}}\n";
static const double AT[3] = {0, 2, 0}, LAMP_RADIUS = 0.15, BALL_RADIUS = 0.25;

static const double CENTERS[5][3] = {{2, 2, 0}, {-2, 2, 0}, {0, 2, 2}, {0, 2, -2}, {0, 4, 0}};

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the distance of a place from an axis through a centre, with the height along it. */
static double from_axis(const double place[3], const double center[3], const double axis[3],
                        double *height)
{
    const double length = sqrt(dot3(axis, axis));
    const double from[3] = {place[0] - center[0], place[1] - center[1], place[2] - center[2]};
    *height = dot3(from, axis) / length;
    return sqrt(fmax(dot3(from, from) - *height * *height, 0));
}

/* Returns whether a place is inside of an object of SHAPES, all of which are larger by `more`. */
static bool is_inside(const double p[3], double more)
{
    const double degree = acos(-1.0) / 180;
    if (fabs(p[0] - 2) < 0.25 + more && fabs(p[1] - 2) < 0.5 + more && fabs(p[2]) < 0.4 + more)
        return true;
    const double ball[3] = {p[0] + 2, p[1] - 2, p[2]};
    if (dot3(ball, ball) < (0.5 + more) * (0.5 + more))
        return true;
    double height;
    double away = from_axis(p, (double[]){0, 2, 2}, (double[]){1, 1, 0}, &height);
    if (away < 0.3 + more && fabs(height) < 0.6 + more)
        return true;
    away = from_axis(p, (double[]){0, 2, -2}, (double[]){1, -0.5, 0}, &height);
    if (hypot(away, fmax(fabs(height) - 0.7, 0)) < 0.3 + more)
        return true;
    /* The box is rotated about x, then about y. */
    const double c = cos(30 * degree), s = sin(30 * degree);
    const double u[3] = {c * p[0] - s * p[2], p[1] - 4, s * p[0] + c * p[2]};
    const double b = cos(20 * degree), t = sin(20 * degree);
    const double v[3] = {u[0], b * u[1] + t * u[2], b * u[2] - t * u[1]};
    return fabs(v[0]) < 0.45 + more && fabs(v[1]) < 0.2 + more && fabs(v[2]) < 0.3 + more;
}

/* Returns the part of the lamp that a ball sees: of the rays between two discs across the way, from
 * the same place of both. */
static double true_part(const double ball[3])
{
    enum { RINGS = 8, SPOKES = 24, STEPS = 240 };
    double way[3], right[3], up[3];
    for (int i = 0; i < 3; i++)
        way[i] = AT[i] - ball[i];
    const double length = sqrt(dot3(way, way));
    const double aside[3] = {fabs(way[1]) < 0.9 * length ? 0 : 1, fabs(way[1]) < 0.9 * length, 0};
    for (int i = 0; i < 3; i++)
        right[i] = aside[(i + 1) % 3] * way[(i + 2) % 3] - aside[(i + 2) % 3] * way[(i + 1) % 3];
    const double across = sqrt(dot3(right, right));
    for (int i = 0; i < 3; i++)
        right[i] /= across;
    for (int i = 0; i < 3; i++)
        up[i] = (way[(i + 1) % 3] * right[(i + 2) % 3] - way[(i + 2) % 3] * right[(i + 1) % 3]) /
                length;
    int free = 0;
    for (int k = 0; k < RINGS * SPOKES; k++) {
        const double radius = sqrt((k / SPOKES + 0.5) / RINGS);
        const double angle = 2 * acos(-1.0) * (k % SPOKES + 0.5 * (k / SPOKES % 2)) / SPOKES;
        bool hidden = false;
        for (int step = 0; step < STEPS && !hidden; step++) {
            const double t = (step + 0.5) / STEPS;
            const double wide = radius * (BALL_RADIUS + t * (LAMP_RADIUS - BALL_RADIUS));
            double place[3];
            for (int i = 0; i < 3; i++)
                place[i] =
                    ball[i] + t * way[i] + wide * (cos(angle) * right[i] + sin(angle) * up[i]);
            hidden = is_inside(place, 0);
        }
        free += !hidden;
    }
    return free / (double)(RINGS * SPOKES);
}

/* Runs the shade of all particles that the fixture has. Returns the words of one light. */
static const uint32_t *shade(struct placed *f, struct kiln_lamp_shade **shade)
{
    struct kiln_error error = {0};
    struct kiln_draw_light lights[KILN_MAX_LIGHTS];
    const uint32_t count = kiln_lamps_fill(&f->moment, lights);
    assert_int_equal(count, 1);
    kiln_lamps_find_casters(&f->moment, lights, count);
    *shade = kiln_lamp_shade_create(f->scene, &error);
    assert_non_null(*shade);
    const uint32_t *words =
        kiln_lamp_shade_run(*shade, &f->moment, f->threads, lights, count, NULL, NULL, &error);
    assert_non_null(words);
    return words + f->pool.systems[0].base;
}

static void objects_hide_a_lamp_from_particles(void **state)
{
    (void)state;
    enum { BALLS = 300 };
    static double places[BALLS][3];
    struct placed f = {0};
    placed_set_up(&f, SHAPES, NULL);
    assert_true(kiln_lamp_shade_exists(f.scene));
    srand(11);
    for (int i = 0; i < BALLS; i++) {
        do { /* behind an object, or beside its shadow */
            const double far = between(1.2, 2.2);
            for (int c = 0; c < 3; c++)
                places[i][c] = AT[c] + far * (CENTERS[i % 5][c] - AT[c]) + between(-1, 1);
        } while (is_inside(places[i], 1.1 * BALL_RADIUS));
        placed_add(&f, 0, (float3){(float)places[i][0], (float)places[i][1], (float)places[i][2]},
                   1);
    }
    struct kiln_lamp_shade *lamp_shade;
    const uint32_t *words = shade(&f, &lamp_shade);
    int partly = 0, hidden = 0;
    double sum = 0;
    for (int i = 0; i < BALLS; i++) {
        const double expected = true_part(places[i]);
        const double found = (double)(words[i] & 255) / KILN_LAMP_SHADE_ONE;
        if (fabs(found - expected) > 0.2)
            fail_msg("ball at %g %g %g: %g, expected %g", places[i][0], places[i][1], places[i][2],
                     found, expected);
        sum += fabs(found - expected);
        hidden += expected < 0.02;
        partly += expected >= 0.02 && expected <= 0.98;
    }
    print_message("%d of %d hidden, %d partly; the part is wrong by %.4f on average\n", hidden,
                  BALLS, partly, sum / BALLS);
    assert_true(hidden > 20 && partly > 40);
    assert_true(sum / BALLS < 0.03);
    kiln_lamp_shade_destroy(&lamp_shade);
    placed_tear_down(&f);
}

/* A particle that drifts through the objects never flashes. */
static void shade_changes_without_jumps(void **state)
{
    (void)state;
    enum { STEPS = 2000 };
    static const double ways[][2][3] = {
        {{2.5, 0.8, -1.2}, {2.3, 3.4, 1.2}}, {{-2.5, 0.8, -1}, {-2.2, 3.6, 1}},
        {{1.5, 1, 2.4}, {-1.5, 3, 2.3}},     {{-1.6, 1.2, -2.6}, {1.6, 2.6, -2.3}},
        {{-1, 4.5, -1}, {1.2, 4.2, 0.9}},    {{2, 2, -1.5}, {2.1, 2.1, 1.5}},
        {{0.9, 2, -0.1}, {3.5, 2, 0.2}},     {{0.2, 1, 3}, {-0.4, 2.8, 1}},
    };
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
        struct placed f = {0};
        placed_set_up(&f, SHAPES, NULL);
        for (int i = 0; i < STEPS; i++) {
            float at[3];
            for (int c = 0; c < 3; c++)
                at[c] = (float)(ways[way][0][c] +
                                (ways[way][1][c] - ways[way][0][c]) * i / (STEPS - 1));
            placed_add(&f, 0, (float3){at[0], at[1], at[2]}, 1);
        }
        struct kiln_lamp_shade *lamp_shade;
        const uint32_t *words = shade(&f, &lamp_shade);
        int darkest = 255;
        for (int i = 1; i < STEPS; i++) {
            const int before = (int)(words[i - 1] & 255), now = (int)(words[i] & 255);
            if (abs(now - before) > 8) /* in a step of 1.5 mm, 1/160 of the particle */
                fail_msg("way %zu: from %d to %d of 255 at step %d", way, before, now, i);
            darkest = now < darkest ? now : darkest;
        }
        assert_true(darkest < 100);
        kiln_lamp_shade_destroy(&lamp_shade);
        placed_tear_down(&f);
    }
}

static void words_are_the_same_for_all_widths(void **state)
{
    (void)state;
    struct placed f = {0};
    placed_set_up(&f, SHAPES, NULL);
    srand(12);
    for (int i = 0; i < 700; i++)
        placed_add(&f, 0,
                   (float3){(float)between(-4, 4), (float)between(0, 6), (float)between(-4, 4)}, 1);
    static uint32_t expected[700];
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        struct kiln_lamp_shade *lamp_shade;
        f.moment.simd = simd;
        const uint32_t *words = shade(&f, &lamp_shade);
        if (simd == kiln_simd_narrowest())
            memcpy(expected, words, sizeof expected);
        assert_memory_equal(words, expected, sizeof expected);
        kiln_lamp_shade_destroy(&lamp_shade);
    }
    placed_tear_down(&f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(smoke_dims_a_lamp_by_its_optical_depth),
        cmocka_unit_test(maps_are_the_same_for_all_widths_and_threads),
        cmocka_unit_test(objects_hide_a_lamp_from_particles),
        cmocka_unit_test(shade_changes_without_jumps),
        cmocka_unit_test(words_are_the_same_for_all_widths),
    };
    return cmocka_run_group_tests_name("lamp_dimming", tests, NULL, NULL);
}
