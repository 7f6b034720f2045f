/* Collision with capsules, planes and what turns, and how surfaces rub: closed forms, and what must
 * never happen. */
#include <stddef.h>
#include <stdint.h>

#include "shared/collide.h"
#include "sim/world/oriented.h"
#include "support/cmocka.h"
#include "support/simulation.h"
#include "support/thrown.h"

/* ---- in doubles ------------------------------------------------------------------------------ */

struct vec {
    double x, y, z;
};

static struct vec vec_of(float3 v)
{
    return (struct vec){(double)v.x, (double)v.y, (double)v.z};
}

static struct vec sub(struct vec a, struct vec b)
{
    return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vec along(struct vec a, struct vec b, double t)
{
    return (struct vec){a.x + b.x * t, a.y + b.y * t, a.z + b.z * t};
}

static double dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Back from the rotation about x, then y, then z. */
static struct vec unrotated(struct vec v, struct vec angles)
{
    double c = cos(angles.z), s = sin(angles.z);
    v = (struct vec){c * v.x + s * v.y, c * v.y - s * v.x, v.z};
    c = cos(angles.y), s = sin(angles.y);
    v = (struct vec){c * v.x - s * v.z, v.y, c * v.z + s * v.x};
    c = cos(angles.x), s = sin(angles.x);
    return (struct vec){v.x, c * v.y + s * v.z, c * v.z - s * v.y};
}

/* How far outside of an object a point is; below 0: inside. */
static double outside_of(const struct kiln_scene *scene, const struct kiln_object *object,
                         struct vec p, float time_s)
{
    struct vec q = sub(p, vec_of(kiln_scene_value3(scene, &object->center, time_s)));
    if (object->kind == KILN_OBJECT_BOX) {
        struct vec half = vec_of(kiln_scene_value3(scene, &object->size, time_s));
        q = unrotated(q, vec_of(kiln_scene_value3(scene, &object->rotation, time_s)));
        return fmax(fmax(fabs(q.x) - half.x / 2, fabs(q.y) - half.y / 2), fabs(q.z) - half.z / 2);
    }
    struct vec axis = vec_of(kiln_scene_value3(scene, &object->axis, time_s));
    axis = along((struct vec){0, 0, 0}, axis, 1 / sqrt(dot(axis, axis)));
    double height = dot(q, axis);
    if (object->kind == KILN_OBJECT_PLANE)
        return height;
    double half = 0.5 * (double)kiln_scene_value(scene, &object->height, time_s);
    double radius = (double)kiln_scene_value(scene, &object->radius, time_s);
    double foot = object->kind == KILN_OBJECT_CAPSULE ? fmin(fmax(height, -half), half) : height;
    struct vec aside = along(q, axis, -foot);
    double away = sqrt(dot(aside, aside)) - radius;
    if (object->kind == KILN_OBJECT_CONE) /* which is narrower above its base */
        away += radius * (height + half) / (2 * half);
    return object->kind == KILN_OBJECT_CAPSULE ? away : fmax(away, fabs(height) - half);
}

/* ---- closed forms ---------------------------------------------------------------------------- */

static void a_capsule_mirrors_at_side_and_ends(void **state)
{
    (void)state;
    const double to_side[3] = {-8, 0, 0}, down[3] = {0, -8, 0};
    const double from_side[3] = {3, 0.4, 0.3}, side[3] = {0.8, 0, 0.6};
    shoot(from_side, to_side);
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 1);
    expect_mirror(from_side, to_side, side, (3 - 0.4) / 8);

    const double from_top[3] = {0.3, 3, 0}, top[3] = {0.6, 0.8, 0};
    shoot(from_top, down);
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 1);
    expect_mirror(from_top, down, top, (3 - 0.9) / 8);

    /* Its axis at 45 degrees: from above, beside the upper ball, then on the side. */
    const double c = sqrt(0.5), from_ball[3] = {c + 0.3, 3, 0};
    shoot(from_ball, down);
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 2)->axis = fixture_constant3(2, 2, 0);
    expect_mirror(from_ball, down, top, (3 - (c + 0.4)) / 8);
    const double from_back[3] = {0, 3, 0}, back[3] = {-c, c, 0};
    shoot(from_back, down);
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 2)->axis = fixture_constant3(2, 2, 0);
    expect_mirror(from_back, down, back, (3 - sqrt(0.5)) / 8);

    const double from_past[3] = {0.51, 3, 0};
    shoot(from_past, down);
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 1);
    assert_near((double)particle_velocity(after(30)).y, -8.0, 1e-6);
}

/* From both sides of every axis, where the turn from y comes by another way. */
static void a_plane_of_any_direction_mirrors(void **state)
{
    (void)state;
    static const double normals[][3] = {{0, 1, 0},       {0, -1, 0},       {1, 0, 0},
                                        {0, 0, -1},      {0.6, 0.8, 0},    {0.6, -0.64, 0.48},
                                        {0, -0.8, -0.6}, {0.48, 0.6, 0.64}};
    for (size_t i = 0; i < sizeof normals / sizeof *normals; i++) {
        const double *n = normals[i];
        const double from[3] = {2 * n[0] + 1, 2 * n[1] + 2, 2 * n[2] + 3};
        const double v[3] = {-8 * n[0] + n[1], -8 * n[1] + n[2], -8 * n[2] + n[0]};
        const double fall = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
        shoot(from, v);
        fixture_add_plane(&fixture, 1, 2, 3)->axis =
            fixture_constant3((float)(3 * n[0]), (float)(3 * n[1]), (float)(3 * n[2]));
        expect_mirror(from, v, n, -2 / fall);
    }
}

/* About z by 30 degrees: its upper face, and its right one. */
static void a_turned_box_mirrors(void **state)
{
    (void)state;
    const double s = 0.5, c = sqrt(0.75), down[3] = {0, -8, 0}, left[3] = {-8, 0, 0};
    const double from_top[3] = {0.1, 3, 0.2}, top[3] = {-s, c, 0}, right[3] = {c, s, 0};
    shoot(from_top, down);
    struct kiln_object *box = fixture_add_box(&fixture, 0, 0, 0, 4, 1, 1);
    box->rotation.z = fixture_constant(0.523598776f);
    expect_mirror(from_top, down, top, (3 - (0.5 + s * 0.1) / c) / 8);

    const double from_right[3] = {4, 0.9, -0.3};
    shoot(from_right, left);
    box = fixture_add_box(&fixture, 0, 0, 0, 4, 1, 1);
    box->rotation.z = fixture_constant(0.523598776f);
    expect_mirror(from_right, left, right, (4 - (2 - s * 0.9) / c) / 8);
}

/* Straight lines against shapes at rest: what is met, and where, is what doubles say of many places
 * on the way. */
static void paths_meet_what_they_should(void **state)
{
    (void)state;
    uint32_t met = 0, missed = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        const uint32_t stream = random_stream(11, i);
        fixture_init(&fixture);
        struct kiln_object *object = i % 3 == 0   ? fixture_add_box(&fixture, 0, 0, 0, 1, 0.2f, 2)
                                     : i % 3 == 1 ? fixture_add_capsule(&fixture, 0, 0, 0, 0.3f, 1)
                                                  : fixture_add_plane(&fixture, 0, 0, 0);
        float3 way = random_in_ball(stream, 20u, true);
        object->axis = fixture_constant3(way.x, way.y, way.z);
        object->rotation = fixture_constant3(way.x * 6.0f, way.y * 3.0f, way.z * 6.0f);
        struct kiln_collider c = kiln_oriented_collider(&fixture.scene, object, 0.0f, 1.0f);
        c.kind = kiln_oriented_kind(object);
        float3 from = float3_scale(random_in_ball(stream, 30u, false), 2.0f);
        float3 to = float3_scale(random_in_ball(stream, 40u, false), 2.0f);
        const struct kiln_surroundings around = {.collider_count = 1, .colliders = {c}};
        const struct kiln_sim sim = {.surroundings = &around};
        const struct collide_span span =
            collide_oriented_through(&sim, 0, 0.0f, 0.0f, 1.0f, from, to);
        double nearest = 1e9, first = 2;
        for (int k = 0; k <= 1000; k++) {
            struct vec at = along(vec_of(from), sub(vec_of(to), vec_of(from)), k / 1000.0);
            double d = outside_of(&fixture.scene, object, at, 0.0f);
            nearest = fmin(nearest, d);
            if (d < 0)
                first = fmin(first, k / 1000.0);
        }
        if (nearest < -1e-5)
            assert_true(collide_span_meets(span) && (double)span.enter <= first + 1e-4 &&
                        (double)span.enter >= first - 1.1e-3);
        if (nearest > 0.003)
            assert_false(collide_span_meets(span));
        met += nearest < -1e-5;
        missed += nearest > 0.003;
    }
    assert_true(met > 500 && missed > 500);
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* What comes at 10 m/s, or grows by that, throws a resting particle at twice that speed. */
static void moving_and_growing_shapes_push(void **state)
{
    (void)state;
    const uint32_t time = KILN_CLOCK_TIME;
    one_particle(FLOAT3(1, 0, 0), FLOAT3(0.0001f, 0, 0));
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 1)->center.x =
        fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).x, 20.0, 1e-2);

    one_particle(FLOAT3(0, 2, 0), FLOAT3(0, 0.0001f, 0));
    fixture_add_capsule(&fixture, 0, 0, 0, 0.5f, 0)->height =
        fixture_ramp(&fixture, time, 0, 1, 1, 21);
    assert_near((double)particle_velocity(after(30)).y, 20.0, 1e-2);

    one_particle(FLOAT3(0, 1, 0), FLOAT3(0, 0.0001f, 0));
    fixture_add_plane(&fixture, 0, 0, 0)->center.y = fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).y, 20.0, 1e-2);

    one_particle(FLOAT3(0, 2, 0), FLOAT3(0, 0.0001f, 0));
    struct kiln_object *box = fixture_add_box(&fixture, 0, 0, 0, 1, 1, 4);
    box->rotation.x = fixture_constant(0.4f);
    box->size.y = fixture_ramp(&fixture, time, 0, 1, 1, 21);
    float3 v = particle_velocity(after(30)); /* along the turned normal */
    assert_near((double)v.y, 20 * cos(0.4), 2e-2);
    assert_near((double)v.z, 20 * sin(0.4), 2e-2);
}

/* A paddle about y at 5 rad/s throws a resting particle at twice the speed of the place it hits. */
static void a_turning_paddle_throws(void **state)
{
    (void)state;
    const double rate = 5, x = 0.8, z = -0.4, half = 0.05;
    const double reach = sqrt(x * x + z * z), arm = sqrt(reach * reach - half * half);
    const double turn = atan2(-z, x) - asin(half / reach), time = turn / rate;
    const double speed = 2 * rate * arm, n[3] = {-sin(turn), 0, -cos(turn)};
    one_particle(FLOAT3((float)x, 0, (float)z), FLOAT3(0, 0.0001f, 0));
    struct kiln_object *paddle = fixture_add_box(&fixture, 0, 0, 0, 2.4f, 1, (float)(2 * half));
    paddle->rotation.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 2, 10);
    struct kiln_particle p = after(12);
    assert_near((double)particle_velocity(p).x, speed * n[0], 1e-2);
    assert_near((double)particle_velocity(p).z, speed * n[2], 1e-2);
    assert_near((double)particle_position(p).x, x + speed * n[0] * (0.2 - time), 3e-3);
    assert_near((double)particle_position(p).z, z + speed * n[2] * (0.2 - time), 3e-3);

    /* As do a capsule and a cylinder whose axes turn by a quarter about z. */
    for (int kind = 0; kind < 2; kind++) {
        one_particle(FLOAT3(0.7f, 0.7f, 0), FLOAT3(0, 0, 0.0001f));
        struct kiln_object *rod = kind ? fixture_add_capsule(&fixture, 0, 0, 0, 0.1f, 3)
                                       : fixture_add_cylinder(&fixture, 0, 0, 0, 0.1f, 3);
        rod->axis.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 1);
        rod->axis.x = fixture_constant(1.0f);
        float3 v = particle_velocity(after(60));
        double slope = tan(atan2(1, 1) - asin(0.1 / (0.7 * sqrt(2)))); /* of the axis at impact */
        double swift = 2 * sqrt(0.98 - 0.01) / (1 + slope * slope);
        assert_near((double)float3_length(v), swift, 2e-2);
        assert_near((double)v.y / swift, 1 / sqrt(1 + slope * slope), 2e-2);
    }
}

/* ---- restitution and friction ---------------------------------------------------------------- */

/* A block on an incline of 30 degrees, with and without enough friction to hold it. */
static void friction_holds_or_brakes(void **state)
{
    (void)state;
    const double g = 9.8, s = 0.5, c = sqrt(0.75);
    static const double frictions[] = {0.0, 0.2, 0.4, 0.7};
    for (int i = 0; i < 4; i++) {
        struct kiln_system *system = one_particle(FLOAT3(0, 1e-3f, 0), FLOAT3(0, -1e-4f, 0));
        system->collide.restitution = fixture_constant(0.0f);
        system->collide.friction = fixture_constant((float)frictions[i]);
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0, -9.8f, 0);
        fixture_add_plane(&fixture, 0, 0, 0)->axis = fixture_constant3(0.5f, sqrtf(0.75f), 0);
        float3 v = particle_velocity(after(60));
        double slides = fmax(g * (s - frictions[i] * c), 0);
        assert_near((double)float3_length(v), slides, 0.02 * g);
        assert_near((double)v.x, slides * c, 0.02 * g);
    }
}

/* A belt: what falls onto a box that moves takes on its speed, as does what falls onto one that
 * turns. */
static void friction_drags(void **state)
{
    (void)state;
    struct kiln_system *system = one_particle(FLOAT3(0, 0.1f, 0), FLOAT3(0, -1, 0));
    system->collide.restitution = fixture_constant(0.0f);
    system->collide.friction = fixture_constant(9.0f);
    struct kiln_object *belt = fixture_add_box(&fixture, 0, -1, 0, 90, 2, 2);
    belt->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 10, 20);
    assert_near((double)particle_velocity(after(30)).x, 2.0, 1e-3);

    system = one_particle(FLOAT3(1.5f, 0.01f, 0), FLOAT3(0, -1, 0));
    system->collide.restitution = fixture_constant(0.0f);
    system->collide.friction = fixture_constant(9.0f);
    fixture_add_box(&fixture, 0, -1, 0, 4, 2, 4)->rotation.y =
        fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 10, 20);
    assert_near((double)particle_velocity(after(1)).z, -2.0 * 1.5, 1e-2);
}

/* Among shapes at rest no bounce adds speed, however they rub and scatter. */
static void energy_never_grows(void **state)
{
    (void)state;
    enum { STEPS = 90 };
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "gas", 1000.0f);
    system->emit.angle = fixture_constant(3.14159274f);
    system->emit.speed = fixture_range(1.0f, 20.0f);
    system->emit.life = fixture_range(9.0f, 9.0f);
    system->collide.enabled = true;
    system->collide.randomness = fixture_ramp(&fixture, KILN_CLOCK_LIFE, 0, 0, 0.1f, 1);
    system->collide.restitution = fixture_constant(0.9f);
    system->collide.friction = fixture_constant(0.1f);
    fixture_add_plane(&fixture, 0, -1, 0)->axis = fixture_constant3(0.1f, 1, 0.2f);
    fixture_add_plane(&fixture, 0, 2, 0)->axis = fixture_constant3(0.1f, -1, -0.2f);
    fixture_add_capsule(&fixture, 1, 0, 0, 0.3f, 1)->axis = fixture_constant3(1, 1, 0);
    fixture_add_box(&fixture, -1, 0, 0, 0.2f, 3, 3)->rotation = fixture_constant3(0.2f, 0.5f, 0.3f);
    fixture_finish(&fixture, STEPS);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    static double before[1000 * STEPS / 60 + 10];
    uint32_t slowed = 0;
    for (uint32_t step = 1; step <= STEPS; step++) {
        simulation_run(&run, 1);
        for (uint32_t i = 0; i < run.pool.systems[0].next_serial; i++) {
            struct kiln_particle p = simulation_records(&run)[i];
            double speed = (double)float3_length(particle_velocity(p));
            if (particle_birth_step(p) != step) {
                assert_true(speed <= before[i] * (1 + 2e-6));
                slowed += speed < before[i] * 0.99;
            }
            before[i] = speed;
        }
    }
    assert_true(slowed > 500);
    simulation_end(&run);
}

/* ---- what must never happen ------------------------------------------------------------------ */

/* A plate of a millimetre that turns at up to 30 rad/s and flies, in a cloud of particles of up to
 * 400 m/s: who is on one side stays there. */
static void nothing_passes_a_turning_plate(void **state)
{
    (void)state;
    static const float restitutions[] = {1.0f, 0.5f, 0.0f};
    uint32_t bounced = 0;
    for (int k = 0; k < 3; k++) {
        fixture_init(&fixture);
        struct kiln_system *system = fixture_add_system(&fixture, "fast", 3000.0f);
        system->emit.shape = KILN_EMITTER_BOX;
        system->emit.size = fixture_constant3(6, 6, 6);
        system->emit.angle = fixture_constant(3.14159274f);
        system->emit.speed = fixture_range(0.0f, 400.0f);
        system->collide.enabled = true;
        system->collide.restitution = fixture_constant(restitutions[k]);
        struct kiln_object *plate = fixture_add_box(&fixture, 0, 0, 0, 60, 0.001f, 60);
        plate->rotation.z =
            fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 10.0f * (float)(k + 1));
        plate->rotation.x = fixture_constant(0.4f);
        plate->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 10);
        fixture_finish(&fixture, 60);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 2);
        static signed char sides[3000];
        memset(sides, 0, sizeof sides);
        for (uint32_t step = 1; step <= 60; step++) {
            simulation_run(&run, 1);
            const struct kiln_scene *scene = &fixture.scene;
            float end_s = kiln_scene_time(scene, step);
            struct vec angles = vec_of(kiln_scene_value3(scene, &plate->rotation, end_s));
            struct vec center = vec_of(kiln_scene_value3(scene, &plate->center, end_s));
            for (uint32_t i = 0; i < run.pool.systems[0].next_serial && i < 3000; i++) {
                struct kiln_particle p = simulation_records(&run)[i];
                struct vec q = unrotated(sub(vec_of(particle_position(p)), center), angles);
                if (!particle_is_alive(p) || sqrt(q.x * q.x + q.z * q.z) > 20 || sides[i] == 2) {
                    sides[i] = 2;
                    continue;
                }
                assert_true(fabs(q.y) > 0.0005);
                signed char side = q.y > 0 ? 1 : -1;
                if (sides[i] != 0 && sides[i] != side)
                    fail_msg("particle %u passed in step %u", i, step);
                bounced += sides[i] != 0;
                sides[i] = side;
            }
        }
        simulation_end(&run);
    }
    assert_true(bounced > 10000);
}

static bool is_in_oriented(const struct kiln_scene *scene, const struct kiln_object *object,
                           float3 p, float time_s)
{
    return object->collide && kiln_object_is_oriented(object) &&
           outside_of(scene, object, vec_of(p), time_s) < 0;
}

static void nobody_ends_a_step_inside(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 200);
    fixture_add_oriented(&fixture);
    nobody_ends_inside(200, is_in_oriented);
}

/* Born inside: out by the nearest part of the surface; the clamp mode, onto it. */
static void the_trapped_are_freed(void **state)
{
    (void)state;
    one_particle(FLOAT3(0.3f, 1.4f, 0), FLOAT3(-0.0001f, 0, 0));
    fixture_add_capsule(&fixture, 0, 0, 0, 1, 2);
    float3 x = particle_position(after(1));
    assert_near((double)x.x, 0.6, 2e-4);
    assert_near((double)x.y, 1.8, 2e-4);

    one_particle(FLOAT3(0, -7, 0), FLOAT3(0.0001f, 0, 0))->collide.mode = KILN_COLLIDE_CLAMP;
    fixture_add_plane(&fixture, 0, 0, 0)->axis = fixture_constant3(3, 4, 0);
    x = particle_position(after(1));
    assert_near((double)x.x, 7 * 0.8 * 0.6, 1e-4);
    assert_near((double)x.y, -7 + 7 * 0.8 * 0.8, 1e-4);

    one_particle(FLOAT3(0.1f, 0.9f, 0), FLOAT3(0, -0.0001f, 0))->collide.mode = KILN_COLLIDE_CLAMP;
    fixture_add_box(&fixture, 0, 0, 0, 2, 2, 2)->rotation.y = fixture_constant(0.3f);
    x = particle_position(after(1));
    assert_near((double)x.y, 1.0, 1e-5);
    assert_near((double)x.x, 0.1, 1e-5);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_capsule_mirrors_at_side_and_ends),
        cmocka_unit_test(a_plane_of_any_direction_mirrors),
        cmocka_unit_test(a_turned_box_mirrors),
        cmocka_unit_test(paths_meet_what_they_should),
        cmocka_unit_test(moving_and_growing_shapes_push),
        cmocka_unit_test(a_turning_paddle_throws),
        cmocka_unit_test(friction_holds_or_brakes),
        cmocka_unit_test(friction_drags),
        cmocka_unit_test(energy_never_grows),
        cmocka_unit_test(nothing_passes_a_turning_plate),
        cmocka_unit_test(nobody_ends_a_step_inside),
        cmocka_unit_test(the_trapped_are_freed),
    };
    return cmocka_run_group_tests_name("collide_turned", tests, NULL, NULL);
}
