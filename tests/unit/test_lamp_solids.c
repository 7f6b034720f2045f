/* lib/draw/light/lamp_solids: the maps in which lamps see solid particles, against closed forms;
 * when maps are drawn anew; and lamps that have none. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/lamp_shade.h"
#include "draw/light/lamp_solids.h"
#include "draw/light/lamps.h"
#include "support/cmocka.h"
#include "support/placed.h"

#define SCENE(lights)                                                                              \
    "kiln: 1\n"                                                                                    \
    "output: {fps: 60}\n"                                                                          \
    "backdrop:\n"                                                                                  \
    "  lights: [" lights "]\n"                                                                     \
    "systems:\n"                                                                                   \
    "  balls:\n"                                                                                   \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {shape: sphere, size: 0.4 m, lit: 1, fade: {in: 0, out: 0}}\n"                      \
    "  specks:\n"                                                                                  \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {shape: sphere, size: 4 mm, lit: 1, fade: {in: 0, out: 0}}\n"                       \
    "  dust:\n"                                                                                    \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {size: 2 cm, lit: 1, fade: {in: 0, out: 0}}\n"

static const char LAMP[] = SCENE("point: {position: [0, 0, 0], radius: 0.01 m}");

enum { ENTRY = KILN_SHADOW_PAIR * KILN_LAMP_SOLID_TEXEL };

struct fixture {
    struct placed placed;
    struct kiln_lamp_solids *solids;
    struct kiln_lamp_solid_maps maps;
    struct kiln_draw_light lights[KILN_MOST_LAMPS];
    uint32_t light_count;
};

static void set_up(struct fixture *f, const char *text, const char *override)
{
    struct kiln_error error = {0};
    *f = (struct fixture){.solids = NULL};
    placed_set_up(&f->placed, text, override);
    assert_true(kiln_lamp_solids_exist(f->placed.scene));
    f->solids = kiln_lamp_solids_create(&f->placed.moment, f->placed.threads, &error);
    assert_non_null(f->solids);
}

static void tear_down(struct fixture *f)
{
    kiln_lamp_solids_destroy(&f->solids);
    placed_tear_down(&f->placed);
}

static void run(struct fixture *f)
{
    struct kiln_error error = {0};
    f->light_count = kiln_lamps_fill(&f->placed.moment, f->lights);
    assert_true(kiln_lamp_solids_run(f->solids, &f->placed.moment, f->lights, f->light_count,
                                     &f->maps, &error));
}

static void add_ball(struct fixture *f, float x, float y, float z)
{
    placed_add(&f->placed, 0, (float3){x, y, z}, 1);
}

/* Returns the number of faces that were drawn so far. */
static uint64_t drawn(const struct fixture *f)
{
    uint64_t sum = 0;
    for (int i = 0; i < KILN_MOST_LAMPS * KILN_LAMP_FACES; i++)
        sum += f->maps.changes[i];
    return sum;
}

/* A level of a face of the first lamp. */
static const uint32_t *level_of(const struct fixture *f, size_t face, uint32_t level)
{
    return f->maps.texels +
           ENTRY * (face * KILN_LAMP_ENTRIES + kiln_shadow_level_start(KILN_LAMP_EDGE, level));
}

/* Returns texel i, row by row, of the finest level of a face. */
static const uint32_t *texel_of(const uint32_t *finest, int i)
{
    const int row = i / KILN_LAMP_EDGE, column = i % KILN_LAMP_EDGE;
    return finest + ENTRY * (row * KILN_SHADOW_PITCH(KILN_LAMP_EDGE) + column);
}

/* Returns the solid angle that solids cover in the direct part of all faces, sr. Each texel is
 * weighed by its own solid angle. */
static double covered_angle(const struct fixture *f)
{
    const double step = 2 * (double)KILN_LAMP_RANGE / KILN_LAMP_EDGE;
    double sum = 0;
    for (size_t face = 0; face < KILN_LAMP_FACES; face++) {
        const uint32_t *texels = level_of(f, face, 0);
        for (int i = 0; i < KILN_LAMP_EDGE * KILN_LAMP_EDGE; i++) {
            const double u = (i % KILN_LAMP_EDGE + 0.5) * step - (double)KILN_LAMP_RANGE;
            const double v = (i / KILN_LAMP_EDGE + 0.5) * step - (double)KILN_LAMP_RANGE;
            const double part = (texel_of(texels, i)[0] & 0xffff) / (double)KILN_SHADOW_ONE;
            const double wide = fmax(0, fmin(1, (1 - fabs(u)) / step + 0.5));
            const double high = fmax(0, fmin(1, (1 - fabs(v)) / step + 0.5));
            sum += part * wide * high * step * step / pow(1 + u * u + v * v, 1.5);
        }
    }
    return sum;
}

/* Returns the solid angle of a ball, sr. */
static double angle_of(double radius, double distance)
{
    return 2 * acos(-1.0) * (1 - sqrt(1 - radius * radius / (distance * distance)));
}

/* Balls in the middle of a face, at an edge and at a corner of the cube, and one whose outline is a
 * hyperbola on a face; then as specks, which are far smaller than a texel. */
static void a_ball_covers_its_solid_angle(void **state)
{
    static const float3 places[] = {{1.0f, 0.1f, 0.2f},  {0.0f, -2.0f, 0.3f}, {-1.0f, 0.2f, -0.9f},
                                    {1.3f, 1.2f, -1.1f}, {0.0f, 0.25f, 0.0f}, {-3.0f, 5.0f, 4.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        for (uint32_t system = 0; system < 2; system++) {
            struct fixture f;
            set_up(&f, LAMP, NULL);
            placed_add(&f.placed, system, places[i], 1);
            run(&f);
            assert_int_equal(f.maps.count, 1);
            const double x = (double)places[i].x, y = (double)places[i].y, z = (double)places[i].z;
            const double expected = angle_of(system ? 0.002 : 0.2, sqrt(x * x + y * y + z * z));
            const double found = covered_angle(&f);
            if (!(fabs(found - expected) < (system ? 0.05 : 0.01) * expected))
                fail_msg("place %zu, system %u: %g sr instead of %g", i, system, found, expected);
            tear_down(&f);
        }
    }
}

/* The second word of a texel is the mean square of what the first has the mean of. The coarsest
 * level has the means of the finest. */
static void levels_have_the_means(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, LAMP, NULL);
    add_ball(&f, 1, 0.1f, 0);
    add_ball(&f, 2, -0.4f, 0.4f);
    run(&f);
    double sums[3] = {0, 0, 0};
    const uint32_t *finest = level_of(&f, 0, 0), *last = level_of(&f, 0, KILN_LAMP_LEVELS - 1);
    const int count = KILN_LAMP_EDGE * KILN_LAMP_EDGE;
    for (int i = 0; i < count; i++) {
        const uint32_t *texel = texel_of(finest, i);
        const double cover = texel[0] & 0xffff, distance = texel[0] >> 16,
                     square = texel[1] & 0xffff;
        /* One ball fills a texel: there is one distance. */
        if (cover == KILN_SHADOW_ONE)
            assert_true(fabs(distance * distance / KILN_SHADOW_ONE - square) < 2);
        sums[0] += cover / count;
        sums[1] += distance / count;
        sums[2] += square / count;
    }
    assert_true(sums[0] > 500);
    assert_true(fabs(sums[0] - (last[0] & 0xffff)) < 3);
    assert_true(fabs(sums[1] - (last[0] >> 16)) < 3);
    assert_true(fabs(sums[2] - (last[1] & 0xffff)) < 3);
    tear_down(&f);
}

/* Nothing is drawn where nothing moved; what moved is drawn on the faces that show it. */
static void maps_are_kept_while_nothing_moves(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, LAMP, NULL);
    add_ball(&f, 1, 0, 0);
    run(&f);
    const uint64_t first = drawn(&f);
    const size_t bytes = (size_t)KILN_LAMP_FACES * KILN_LAMP_SOLID_WORDS * sizeof *f.maps.texels;
    uint32_t *texels = malloc(bytes);
    assert_non_null(texels);
    memcpy(texels, f.maps.texels, bytes);
    assert_int_equal(first, 1);
    run(&f);
    assert_int_equal(drawn(&f), first);
    assert_memory_equal(texels, f.maps.texels, bytes);

    f.placed.records[0].position_serial.y = FLOAT_BITS(0.1f);
    run(&f);
    assert_int_equal(drawn(&f), first + 1);
    assert_memory_not_equal(texels, f.maps.texels, bytes);
    f.placed.records[0].position_serial.y = FLOAT_BITS(0.0f);
    run(&f);
    assert_memory_equal(texels, f.maps.texels, bytes);
    /* Its death empties the face, once. */
    f.placed.records[0].velocity_birth.w &= ~KILN_PARTICLE_ALIVE;
    run(&f);
    assert_int_equal(f.maps.count, 0);
    free(texels);
    tear_down(&f);
}

static void a_lamp_that_moves_gets_a_new_map(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct fixture f;
    set_up(&f, SCENE("point: {position: {keys: {0 s: [0, 0, 0], 2 s: [0, 1, 0]}}}"), NULL);
    add_ball(&f, 3, 0, 0);
    run(&f);
    const uint64_t first = drawn(&f);
    assert_true(kiln_moment_fill(&f.placed.moment, &f.placed.pool,
                                 kiln_instant_at_step(PLACED_STEP + 1), true, &error));
    run(&f);
    assert_true(drawn(&f) > first);
    tear_down(&f);
}

/* Around the lamp's centre, behind a panel, beside a cone, in no light and under a lamp without
 * shadows: the lamp has no maps. */
static void lamps_without_solids_have_no_maps(void **state)
{
    static const struct {
        const char *text;
        float3 place;
        uint32_t maps;
    } cases[] = {
        {LAMP, {0.1f, 0, 0}, 0},
        {LAMP, {0.3f, 0, 0}, 1},
        {SCENE("point: {position: [0, 0, 0], shadow: false}, point: {position: [0, 3, 0]}"),
         {1, 0, 0},
         1},
        {SCENE("point: {position: [0, 0, 0], color: 0}"), {1, 0, 0}, 0},
        {SCENE("rectangle: {center: [0, 0, 0], direction: [1, 0, 0]}"), {-0.3f, 0, 0}, 0},
        {SCENE("rectangle: {center: [0, 0, 0], direction: [1, 0, 0]}"), {1, 0, 0}, 1},
        {SCENE("spot: {position: [0, 0, 0], direction: [1, 0, 0], angle: 20 deg}"), {1, 2, 0}, 0},
        {SCENE("spot: {position: [0, 0, 0], direction: [1, 0, 0], angle: 20 deg}"),
         {1, 0.5f, 0},
         1},
        {SCENE("spot: {position: [0, 0, 0], direction: [1, 0, 0], angle: 20 deg}"), {-1, 0, 0}, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct fixture f;
        set_up(&f, cases[i].text, NULL);
        placed_add(&f.placed, 0, cases[i].place, 1);
        run(&f);
        if (f.maps.count != cases[i].maps)
            fail_msg("case %zu: %u lamps have maps", i, f.maps.count);
        const uint32_t last = f.light_count - 1;
        assert_int_equal(f.lights[last].casters.y >> KILN_LAMP_SOLID_SHIFT, cases[i].maps);
        assert_true((f.lights[last].maps.w > 0) == (cases[i].maps > 0));
        tear_down(&f);
    }
}

/* Lit billboards behind a ball, before it and beside it: none of the lamp, all of it, all of it;
 * and at the edge of the shadow, a part. */
static void billboards_see_lamps_past_balls(void **state)
{
    static const float3 places[] = {{3, 0, 0}, {0.5f, 0, 0}, {3, 1.5f, 0}, {3, 0.612f, 0}};
    (void)state;
    struct kiln_error error = {0};
    struct fixture f;
    set_up(&f, LAMP, NULL);
    assert_true(kiln_lamp_shade_exists(f.placed.scene));
    struct kiln_lamp_shade *shade = kiln_lamp_shade_create(f.placed.scene, &error);
    assert_non_null(shade);
    add_ball(&f, 1, 0, 0);
    for (int i = 0; i < 4; i++)
        placed_add(&f.placed, 2, places[i], 1);
    run(&f);
    kiln_lamps_find_casters(&f.placed.moment, f.lights, f.light_count);
    const uint32_t *words = kiln_lamp_shade_run(shade, &f.placed.moment, f.placed.threads, f.lights,
                                                f.light_count, NULL, f.maps.texels, &error);
    assert_non_null(words);
    words += f.placed.pool.systems[2].base;
    assert_int_equal(words[0] & 255, 0);
    assert_int_equal(words[1] & 255, KILN_LAMP_SHADE_ONE);
    assert_int_equal(words[2] & 255, KILN_LAMP_SHADE_ONE);
    assert_in_range(words[3] & 255, 40, 215);
    kiln_lamp_shade_destroy(&shade);
    tear_down(&f);
}

/* One thread and four draw the same bytes. */
static void threads_do_not_change_maps(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct fixture f[2];
    const size_t bytes = (size_t)KILN_LAMP_FACES * KILN_LAMP_SOLID_WORDS * sizeof(uint32_t);
    for (int i = 0; i < 2; i++) {
        set_up(&f[i], LAMP, NULL);
        kiln_lamp_solids_destroy(&f[i].solids);
        kiln_threads_destroy(&f[i].placed.threads);
        f[i].placed.threads = kiln_threads_create(i ? 4 : 1);
        f[i].solids = kiln_lamp_solids_create(&f[i].placed.moment, f[i].placed.threads, &error);
        assert_non_null(f[i].solids);
        srand(7);
        for (uint32_t k = 0; k < 600; k++) {
            float at[3];
            for (int c = 0; c < 3; c++)
                at[c] = (float)(rand() % 4000 - 2000) * 1e-3f;
            placed_add(&f[i].placed, k % 2, (float3){at[0], at[1], at[2]}, 1);
        }
        run(&f[i]);
    }
    assert_memory_equal(f[0].maps.texels, f[1].maps.texels, bytes);
    tear_down(&f[0]);
    tear_down(&f[1]);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_covers_its_solid_angle),
        cmocka_unit_test(levels_have_the_means),
        cmocka_unit_test(maps_are_kept_while_nothing_moves),
        cmocka_unit_test(a_lamp_that_moves_gets_a_new_map),
        cmocka_unit_test(lamps_without_solids_have_no_maps),
        cmocka_unit_test(billboards_see_lamps_past_balls),
        cmocka_unit_test(threads_do_not_change_maps),
    };
    return cmocka_run_group_tests_name("lamp_solids", tests, NULL, NULL);
}
