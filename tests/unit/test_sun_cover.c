/* shared/shapes.h and lib/draw/light/sun_mesh: what shapes hide of the sun from a ball, against
 * rays that are counted. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/sun_mesh.h"
#include "shared/exact.h"
#include "shared/shapes.h"
#include "support/cmocka.h"

#ifdef __SANITIZE_ADDRESS__ /* slow, and sees as much in fewer */
enum { RAYS = 400, BALLS = 60 };
#else
enum { RAYS = 400, BALLS = 300 };
#endif

enum kind { BOX, SPHERE, CYLINDER, CAPSULE, CONE };

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

static bool is_in(enum kind kind, float3 at, float3 up)
{
    if (kind == BOX)
        return fabsf(at.x) < HALF.x && fabsf(at.y) < HALF.y && fabsf(at.z) < HALF.z;
    if (kind == SPHERE)
        return float3_dot(at, at) < RADIUS * RADIUS;
    const float height = float3_dot(at, up);
    const float3 aside = float3_add_scaled(at, up, -height);
    const float square = float3_dot(aside, aside);
    if (kind == CYLINDER)
        return fabsf(height) < HALF_HEIGHT && square < RADIUS * RADIUS;
    if (kind == CONE) {
        const float width = RADIUS * (HALF_HEIGHT - height) / (2.0f * HALF_HEIGHT);
        return height > -HALF_HEIGHT && width > 0.0f && square < width * width;
    }
    const float beyond = height - fmaxf(fminf(height, HALF_HEIGHT), -HALF_HEIGHT);
    return square + beyond * beyond < RADIUS * RADIUS;
}

/* By steps of a centimetre along the ray: slow, and not the way it is computed. */
static bool hides(enum kind kind, float3 from, float3 direction)
{
    const float3 up = axis(), start = float3_sub(from, CENTER);
    for (int i = 0; i < 800; i++) {
        if (is_in(kind, float3_add_scaled(start, direction, 0.01f * (float)i), up))
            return true;
    }
    return false;
}

/* Returns what a shape hides of the sun. The tests before it must not leave out a shape that hides
 * some. */
static float hidden_by(const struct kiln_draw_shape *s, struct kiln_ball ball,
                       const struct kiln_sun_frame *sun)
{
    const float4 direction = {sun->towards.x, sun->towards.y, sun->towards.z, 0.0f};
    const struct light_way way = sun_way_of(direction, sun->spread, ball.radius);
    const float3 towards = real3_towards(s->center, ball.center);
    float hidden = 0.0f;
    bool may = light_meets_sphere(way, towards, s->center.w);
#define HIDE(KIND, name)                                                                           \
    if (s->kind.x == SHAPE_##KIND) {                                                               \
        const struct name##_seen seen = name##_seen_along(*s, way.direction);                      \
        may = may && name##_may_hide(*s, seen, towards, way);                                      \
        hidden = light_hidden(way, name##_cover(*s, seen, towards, way, true));                    \
    }
    KILN_SHAPES(HIDE)
#undef HIDE
    if (!may && hidden > 1e-4f)
        fail_msg("a shape of kind %u that hides %g is left out", s->kind.x, (double)hidden);
    return hidden;
}

static struct kiln_draw_shape shape_of(enum kind kind)
{
    static const uint32_t kinds[] = {SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CAPSULE,
                                     SHAPE_CONE};
    const float3 up = axis();
    struct kiln_draw_shape s = {.kind = {kinds[kind], kind != BOX, 0, 0},
                                .center = {CENTER.x, CENTER.y, CENTER.z, 0.0f},
                                .extent = {HALF.x, HALF.y, HALF.z, 0.0f},
                                .rows = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    if (kind != BOX) {
        s.extent = (float4){RADIUS, kind == SPHERE ? 0.0f : HALF_HEIGHT, RADIUS, RADIUS};
        s.rows[1] = (float4){up.x, up.y, up.z, 0.0f};
    }
    s.center.w = s.kind.x == SHAPE_BOX        ? box_size(s)
                 : s.kind.x == SHAPE_CYLINDER ? cylinder_size(s)
                 : s.kind.x == SHAPE_CONE     ? cone_size(s)
                                              : capsule_size(s);
    return s;
}

static float cover(enum kind kind, struct kiln_ball ball, const struct kiln_sun_frame *sun)
{
    const struct kiln_draw_shape shape = shape_of(kind);
    return hidden_by(&shape, ball, sun);
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
    for (enum kind kind = BOX; kind <= CONE; kind++)
        check(kind, 0.0f, 0.1f, 0.16f);
}

static void balls_are_shaded_in_part(void **state)
{
    (void)state;
    for (enum kind kind = BOX; kind <= CONE; kind++)
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
        struct kiln_draw_shape upright = shape_of(CYLINDER);
        upright.extent.y = 0.5f;
        upright.rows[0] = (float4){1.0f, 0.0f, 0.0f, 0.0f};
        upright.rows[1] = (float4){0.0f, 1.0f, 0.0f, 0.0f};
        float found = hidden_by(&upright, ball, &sun);
        assert_true(out < 1.0f ? found > 0.99f : found < 0.01f);
    }
}

/* From behind a shape, through it and out at the sun's side: from dark to light, without a jump. */
static void shade_ends_softly(void **state)
{
    (void)state;
    const struct kiln_sun_frame sun = sun_at((float3){-0.5f, 0.8f, 0.4f}, 0.01f);
    for (enum kind kind = BOX; kind <= CONE; kind++) {
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
    assert_true(plane_hides(1.0f, 0.1f) == 0.0f);
    assert_true(plane_hides(0.2f, 0.1f) == 0.0f);
    assert_true(fabsf(plane_hides(0.0f, 0.1f) - 0.5f) < 1e-6f);
    assert_true(plane_hides(-0.2f, 0.1f) == 1.0f);
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
            float expected = cover(BOX, ball, &sun);
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
