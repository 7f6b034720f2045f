/* lib/draw/sun_cover and sun_mesh: what shapes hide of the sun from a ball, against rays that are
 * counted. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/sun_box.h"
#include "draw/light/sun_cylinder.h"
#include "draw/light/sun_mesh.h"
#include "shared/exact.h"
#include "support/cmocka.h"

#ifdef __SANITIZE_ADDRESS__ /* slow, and sees as much in fewer */
enum { RAYS = 400, BALLS = 60 };
#else
enum { RAYS = 400, BALLS = 300 };
#endif

enum kind { BOX, SPHERE, CYLINDER, CAPSULE };

static const float3 CENTER = {0.3f, 1.0f, -0.2f}, HALF = {0.8f, 0.4f, 0.6f};
static const float RADIUS = 0.7f, HALF_HEIGHT = 0.9f;

static struct kiln_sun_frame sun_at(float3 towards, float spread)
{
    struct kiln_sun_frame sun = {.spread = spread};
    const float3 aside = {0.2f, -0.5f, 0.8f}, otherwise = {0.0f, 1.0f, 0.0f};
    sun.towards = float3_normalize(towards, otherwise);
    sun.right = float3_normalize(float3_cross(aside, sun.towards), otherwise);
    sun.up = float3_cross(sun.towards, sun.right);
    return sun;
}

static float3 axis(void)
{
    return float3_normalize((float3){1.0f, 2.0f, 0.5f}, (float3){0.0f, 1.0f, 0.0f});
}

/* By steps of a centimetre along the ray: slow, and not the way it is computed. */
static bool hides(enum kind kind, float3 from, float3 direction)
{
    for (int i = 0; i < 800; i++) {
        float3 at = float3_sub(float3_add_scaled(from, direction, 0.01f * (float)i), CENTER);
        float height = float3_dot(at, axis());
        float3 aside = float3_add_scaled(at, axis(), -height);
        bool in_box = fabsf(at.x) < HALF.x && fabsf(at.y) < HALF.y && fabsf(at.z) < HALF.z;
        bool in_sphere = float3_dot(at, at) < RADIUS * RADIUS;
        bool in_cylinder =
            fabsf(height) < HALF_HEIGHT && float3_dot(aside, aside) < RADIUS * RADIUS;
        float beyond = height - fmaxf(fminf(height, HALF_HEIGHT), -HALF_HEIGHT);
        bool in_capsule = float3_dot(aside, aside) + beyond * beyond < RADIUS * RADIUS;
        const bool inside[] = {in_box, in_sphere, in_cylinder, in_capsule};
        if (inside[kind])
            return true;
    }
    return false;
}

static float cover_of_box(struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    const struct kiln_sun_box box = kiln_sun_box_at(CENTER, HALF, sun);
    return kiln_sun_box_cover(&box, ball, sun);
}

static float cylinder_cover_at(float3 along, float half_height, struct kiln_ball ball,
                               const struct kiln_sun_frame *sun)
{
    const struct kiln_sun_cylinder cylinder =
        kiln_sun_cylinder_at(CENTER, RADIUS, along, half_height, sun);
    return kiln_sun_cylinder_cover(&cylinder, ball, sun);
}

static float cover(enum kind kind, struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    if (kind == BOX)
        return cover_of_box(ball, sun);
    if (kind == SPHERE)
        return kiln_sphere_sun_cover(CENTER, RADIUS, ball, sun);
    if (kind == CAPSULE)
        return kiln_capsule_sun_cover(CENTER, RADIUS, axis(), HALF_HEIGHT, ball, sun);
    return cylinder_cover_at(axis(), HALF_HEIGHT, ball, sun);
}

/* The disc of a ball across the sun's direction, and the sun's disc seen from its middle. */
static float counted(enum kind kind, struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    int hidden = 0;
    for (int i = 0; i < RAYS; i++) {
        float r = sqrtf(((float)i + 0.5f) / RAYS), turn = 2.39996323f * (float)i;
        float3 aside = float3_scale(sun->right, r * cosf(turn));
        aside = float3_add_scaled(aside, sun->up, r * sinf(turn));
        hidden += hides(kind, float3_add_scaled(ball.center, aside, ball.radius),
                        float3_add_scaled(sun->towards, aside, sun->spread));
    }
    return (float)hidden / RAYS;
}

static float within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

/* Balls behind the shape, beside it and before it: but not those that it would cut, which have both
 * of its sides. */
static void check(enum kind kind, float radius, float spread, float tolerance)
{
    const struct kiln_sun_frame sun = sun_at((float3){-0.5f, 0.8f, 0.4f}, spread);
    int dark = 0, partly = 0, lit = 0;
    srand(5);
    for (int i = 0; i < BALLS; i++) {
        float way = i % 4 ? within(1.5f, 3.0f) : within(-3.0f, -1.5f);
        float3 at = float3_add_scaled(CENTER, sun.right, within(-1.5f, 1.5f));
        at = float3_add_scaled(at, sun.up, within(-1.5f, 1.5f));
        const struct kiln_ball ball = {float3_add_scaled(at, sun.towards, -way), radius};
        float expected = counted(kind, ball, &sun), found = cover(kind, ball, &sun);
        if (fabsf(found - expected) > tolerance)
            fail_msg("kind %d, ball %d: %g instead of %g", kind, i, (double)found,
                     (double)expected);
        dark += expected > 0.95f;
        lit += expected < 0.05f;
        partly += expected >= 0.05f && expected <= 0.95f;
    }
    assert_true(dark > BALLS / 60 && partly > BALLS / 20 && lit > BALLS / 6);
}

static void points_see_a_part_of_the_sun(void **state)
{
    (void)state;
    for (enum kind kind = BOX; kind <= CAPSULE; kind++)
        check(kind, 0.0f, 0.1f, 0.16f);
}

static void balls_are_shaded_in_part(void **state)
{
    (void)state;
    for (enum kind kind = BOX; kind <= CAPSULE; kind++)
        check(kind, 0.3f, 0.0f, 0.16f);
}

/* A sun that stands above an upright cylinder shades a disc. */
static void a_cylinder_is_round_from_above(void **state)
{
    (void)state;
    const float3 up = {0.0f, 1.0f, 0.0f};
    const struct kiln_sun_frame sun = sun_at(up, 0.001f);
    for (int i = 0; i < 16; i++) {
        float turn = 0.4f * (float)i, out = i % 2 ? 0.9f : 1.1f;
        const struct kiln_ball ball = {
            {CENTER.x + out * RADIUS * cosf(turn), 0.0f, CENTER.z + out * RADIUS * sinf(turn)},
            0.01f};
        float found = cylinder_cover_at(up, 0.5f, ball, &sun);
        assert_true(out < 1.0f ? found > 0.99f : found < 0.01f);
    }
}

/* From behind a shape, through it and out at the sun's side: from dark to light, without a jump. */
static void shade_ends_softly(void **state)
{
    (void)state;
    const struct kiln_sun_frame sun = sun_at((float3){-0.5f, 0.8f, 0.4f}, 0.01f);
    for (enum kind kind = BOX; kind <= CAPSULE; kind++) {
        float before = 1.0f;
        for (int i = 0; i <= 300; i++) {
            float3 at = float3_add_scaled(CENTER, sun.towards, -1.5f + 0.01f * (float)i);
            float found = cover(kind, (struct kiln_ball){at, 0.2f}, &sun);
            assert_true(i > 0 || found > 0.99f);
            assert_true(found <= before + 1e-3f && found >= before - 0.06f);
            before = found;
        }
        assert_true(before < 1e-3f);
    }
}

/* A sun that sets behind a plane: by halves when its middle is at the horizon. */
static void a_plane_hides_all_or_nothing(void **state)
{
    (void)state;
    const struct kiln_sun_frame sun = sun_at((float3){0.0f, 1.0f, 0.0f}, 0.1f);
    assert_true(kiln_plane_sun_cover((float3){0.0f, 1.0f, 0.0f}, &sun) == 0.0f);
    assert_true(kiln_plane_sun_cover((float3){0.98f, 0.2f, 0.0f}, &sun) == 0.0f);
    assert_true(fabsf(kiln_plane_sun_cover((float3){1.0f, 0.0f, 0.0f}, &sun) - 0.5f) < 1e-6f);
    assert_true(kiln_plane_sun_cover((float3){0.98f, -0.2f, 0.0f}, &sun) == 1.0f);
}

/* A box, as a mesh turned by a quarter about y. */
static void a_mesh_shades_as_the_box_that_it_is(void **state)
{
    (void)state;
    static const char box[] = "v -0.6 -0.4 -0.8\nv 0.6 -0.4 -0.8\nv 0.6 0.4 -0.8\nv -0.6 0.4 -0.8\n"
                              "v -0.6 -0.4 0.8\nv 0.6 -0.4 0.8\nv 0.6 0.4 0.8\nv -0.6 0.4 0.8\n"
                              "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
                              "f 4 7 3\nf 4 8 7\nf 1 5 8\nf 1 8 4\nf 2 3 7\nf 2 7 6\n";
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_parse(box, strlen(box), "box.obj", &error);
    if (!mesh)
        fail_msg("%s", error.message);
    const struct kiln_draw_mesh placed = {
        .to_world = {{0, 0, 1, CENTER.x}, {0, 1, 0, CENTER.y}, {-1, 0, 0, CENTER.z}},
        .center = {CENTER.x, CENTER.y, CENTER.z, sqrtf(0.36f + 0.16f + 0.64f)},
        .half_size = {HALF.x, HALF.y, HALF.z, 0.0f},
    };
    struct kiln_sun_mesh *map = calloc(1, sizeof *map);
    assert_non_null(map);
    float darkest = 0.0f, sum = 0.0f;
    for (int turn = 0; turn < 2; turn++) { /* the map follows the sun */
        const float3 towards = {turn ? 0.4f : -0.5f, 0.8f, 0.4f};
        const struct kiln_sun_frame sun = sun_at(towards, 0.02f);
        kiln_sun_mesh_update(map, mesh, &placed, &sun);
        srand(7);
        for (int i = 0; i < BALLS; i++) {
            float3 at = float3_add_scaled(CENTER, sun.right, within(-1.5f, 1.5f));
            at = float3_add_scaled(at, sun.up, within(-1.5f, 1.5f));
            at = float3_add_scaled(at, sun.towards, i % 4 ? -2.0f : 2.0f);
            const struct kiln_ball ball = {at, within(0.05f, 0.4f)};
            float expected = cover_of_box(ball, &sun);
            float found = kiln_sun_mesh_cover(map, ball);
            sum += fabsf(found - expected);
            if (fabsf(found - expected) > 0.3f) /* at corners */
                fail_msg("ball %d: %g instead of %g", i, (double)found, (double)expected);
            darkest = fmaxf(darkest, found);
        }
    }
    assert_true(darkest > 0.97f && sum < 0.04f * 2 * BALLS);
    free(map);
    kiln_mesh_destroy(&mesh);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_see_a_part_of_the_sun),
        cmocka_unit_test(balls_are_shaded_in_part),
        cmocka_unit_test(a_cylinder_is_round_from_above),
        cmocka_unit_test(shade_ends_softly),
        cmocka_unit_test(a_plane_hides_all_or_nothing),
        cmocka_unit_test(a_mesh_shades_as_the_box_that_it_is),
    };
    return cmocka_run_group_tests_name("sun_cover", tests, NULL, NULL);
}
