/* Collision with spheres and cylinders: closed forms, and what must never happen. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/collide.h"
#include "support/cmocka.h"
#include "support/simulation.h"
#include "support/thrown.h"

/* Beside the middle of a unit sphere: the exact point, normal and time of a chord's start. */
static void a_sphere_mirrors_where_it_is_hit(void **state)
{
    (void)state;
    static const double asides[] = {0.0, 0.3, -0.6, 0.8};
    for (int i = 0; i < 4; i++) {
        const double y = asides[i], x = sqrt(1 - y * y);
        const double from[3] = {3, y, 0}, v[3] = {-8, 0, 0}, normal[3] = {x, y, 0};
        shoot(from, v);
        fixture_add_sphere(&fixture, 0, 0, 0, 1);
        expect_mirror(from, v, normal, (3 - x) / 8);
    }
    const double from[3] = {3, 1.01, 0}, v[3] = {-8, 0, 0};
    shoot(from, v);
    fixture_add_sphere(&fixture, 0, 0, 0, 1);
    assert_near((double)particle_velocity(after(30)).x, -8.0, 1e-6);
}

static void a_cylinder_mirrors_at_side_and_ends(void **state)
{
    (void)state;
    const double c = sqrt(0.5);
    const double from_side[3] = {3, 0.4, 0.6}, v_side[3] = {-8, 0, 0}, side[3] = {0.8, 0, 0.6};
    shoot(from_side, v_side);
    fixture_add_cylinder(&fixture, 0, 0, 0, 1, 1);
    expect_mirror(from_side, v_side, side, (3 - 0.8) / 8);

    const double from_top[3] = {0.4, 3, 0.6}, v_top[3] = {0, -8, 0}, top[3] = {0, 1, 0};
    shoot(from_top, v_top);
    fixture_add_cylinder(&fixture, 0, 0, 0, 1, 1);
    expect_mirror(from_top, v_top, top, 2.5 / 8);

    /* Its axis at 45 degrees: from above, the upper end shows to one side, the side to the other.
     */
    const double from_end[3] = {0.9, 3, 0}, end[3] = {c, c, 0}, round[3] = {-c, c, 0};
    shoot(from_end, v_top);
    fixture_add_cylinder(&fixture, 0, 0, 0, 0.5f, 2)->axis = fixture_constant3(2, 2, 0);
    expect_mirror(from_end, v_top, end, (3 - (sqrt(2.0) - 0.9)) / 8);
    const double from_back[3] = {0, 3, 0};
    shoot(from_back, v_top);
    fixture_add_cylinder(&fixture, 0, 0, 0, 0.5f, 2)->axis = fixture_constant3(2, 2, 0);
    expect_mirror(from_back, v_top, round, (3 - sqrt(0.5)) / 8);

    const double from_past[3] = {3, 0.51, 0};
    shoot(from_past, v_side);
    fixture_add_cylinder(&fixture, 0, 0, 0, 1, 1);
    assert_near((double)particle_velocity(after(30)).x, -8.0, 1e-6);
}

/* What comes at 10 m/s, or grows by that, throws a resting particle at twice that speed. */
static void moving_and_growing_shapes_push(void **state)
{
    (void)state;
    const uint32_t time = KILN_CLOCK_TIME;
    one_particle(FLOAT3(1, 0, 0), FLOAT3(0.0001f, 0, 0));
    struct kiln_object *object = fixture_add_sphere(&fixture, 0, 0, 0, 0.5f);
    object->center.x = fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).x, 20.0, 1e-2);

    one_particle(FLOAT3(1, 0, 0), FLOAT3(0.0001f, 0, 0));
    object = fixture_add_sphere(&fixture, 0, 0, 0, 0);
    object->radius = fixture_ramp(&fixture, time, 0, 0.5f, 1, 10.5f);
    assert_near((double)particle_velocity(after(30)).x, 20.0, 1e-2);

    one_particle(FLOAT3(0, 1, 0), FLOAT3(0, 0.0001f, 0));
    object = fixture_add_cylinder(&fixture, 0, 0, 0, 0.5f, 0);
    object->height = fixture_ramp(&fixture, time, 0, 1, 1, 21);
    assert_near((double)particle_velocity(after(30)).y, 20.0, 1e-2);

    one_particle(FLOAT3(1, 0, 0.1f), FLOAT3(0.0001f, 0, 0));
    object = fixture_add_cylinder(&fixture, 0, 0, 0.1f, 0, 3);
    object->radius = fixture_ramp(&fixture, time, 0, 0.5f, 1, 10.5f);
    assert_near((double)particle_velocity(after(30)).x, 20.0, 1e-2);
}

/* In doubles, from the scene's values. */
static bool inside(const struct kiln_scene *scene, const struct kiln_object *object, float3 p,
                   float time_s)
{
    float3 c = kiln_scene_value3(scene, &object->center, time_s);
    float3 a = kiln_scene_value3(scene, &object->axis, time_s);
    double radius = (double)kiln_scene_value(scene, &object->radius, time_s);
    double half = 0.5 * (double)kiln_scene_value(scene, &object->height, time_s);
    double q[3] = {(double)p.x - (double)c.x, (double)p.y - (double)c.y, (double)p.z - (double)c.z};
    double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2], height = 0;
    if (object->kind == KILN_OBJECT_CYLINDER) {
        double x = (double)a.x, y = (double)a.y, z = (double)a.z;
        height = (q[0] * x + q[1] * y + q[2] * z) / sqrt(x * x + y * y + z * z);
        square -= height * height;
    }
    return square < radius * radius && (object->kind == KILN_OBJECT_SPHERE || fabs(height) < half);
}

static bool is_in_round(const struct kiln_scene *scene, const struct kiln_object *object, float3 p,
                        float time_s)
{
    return object->kind != KILN_OBJECT_BOX && inside(scene, object, p, time_s);
}

static void nobody_ends_a_step_inside(void **state)
{
    (void)state;
    fixture_zoo(&fixture, KILN_INTEGRATE_SEMI_IMPLICIT, 300);
    fixture_add_round(&fixture);
    nobody_ends_inside(300, is_in_round);
}

/* A plate of a millimetre against steps of metres: all come back. */
static void nothing_tunnels(void **state)
{
    (void)state;
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "fast", 3000.0f);
    system->emit.origin = fixture_constant3(0, 5, 0);
    system->emit.direction = fixture_constant3(0, -1, 0);
    system->emit.angle = fixture_constant(0.6f);
    system->emit.speed = fixture_range(50.0f, 400.0f);
    system->collide.enabled = true;
    fixture_add_cylinder(&fixture, 0, 0, 0, 20, 0.001f);
    fixture_add_sphere(&fixture, 0, 1, 0, 0.5f);
    fixture_finish(&fixture, 60);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, 60);
    uint32_t alive = 0, aside = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].next_serial; i++) {
        struct kiln_particle p = simulation_records(&run)[i];
        if (!particle_is_alive(p))
            continue;
        alive++;
        float3 x = particle_position(p);
        assert_true(x.y > 0 || x.x * x.x + x.z * x.z > 400);
        aside += particle_velocity(p).y > 0;
    }
    assert_true(alive > 2000 && aside > 2000);
    simulation_end(&run);
}

/* Born inside: out by the nearest part of the surface; the clamp mode, onto it. */
static void the_trapped_are_freed(void **state)
{
    (void)state;
    one_particle(FLOAT3(0.3f, 0.4f, 0), FLOAT3(-0.0001f, 0, 0));
    fixture_add_sphere(&fixture, 0, 0, 0, 1);
    float3 x = particle_position(after(1));
    assert_near((double)x.x, 0.6, 2e-4);
    assert_near((double)x.y, 0.8, 2e-4);

    one_particle(FLOAT3(0.1f, 0.9f, 0), FLOAT3(0, -0.0001f, 0))->collide.mode = KILN_COLLIDE_CLAMP;
    fixture_add_cylinder(&fixture, 0, 0, 0, 1, 2);
    x = particle_position(after(1));
    assert_near((double)x.y, 1.0, 1e-5);
    assert_near((double)x.x, 0.1, 1e-5);

    one_particle(FLOAT3(0, 0.5f, 0), FLOAT3(0.001f, 0, 0)); /* on the axis: somewhere outside */
    fixture_add_cylinder(&fixture, 0, 0, 0, 0.25f, 4);
    x = particle_position(after(1));
    assert_near((double)(x.x * x.x + x.z * x.z), 0.0625, 1e-3);
}

/* Splashes leave along the normal: exact on boxes, within a thousandth on round shapes. */
static void normals_of_impacts_are_kept(void **state)
{
    (void)state;
    for (uint32_t face = 0; face < COLLIDE_FACES; face++) {
        float3 n = collide_normal_of(face);
        const float part[3] = {n.x, n.y, n.z};
        for (uint32_t i = 0; i < 3; i++)
            assert_true(part[i] == (i == face / 2 ? (face % 2 ? 1.0f : -1.0f) : 0.0f));
    }
    for (int i = 0; i < 1000; i++) {
        float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
        float3 n = random_direction(random_stream(3, (uint)i), RANDOM_BOUNCE, up, -1.0f);
        float3 kept = collide_normal_of(collide_pack_normal(n));
        assert_near((double)float3_dot(n, kept), 1.0, 3e-6);
        assert_near((double)float3_length(kept), 1.0, 1e-6);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_mirrors_where_it_is_hit),
        cmocka_unit_test(a_cylinder_mirrors_at_side_and_ends),
        cmocka_unit_test(moving_and_growing_shapes_push),
        cmocka_unit_test(nobody_ends_a_step_inside),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(the_trapped_are_freed),
        cmocka_unit_test(normals_of_impacts_are_kept),
    };
    return cmocka_run_group_tests_name("collide_round", tests, NULL, NULL);
}
