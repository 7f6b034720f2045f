/* shared/shape_cone.h: rays and particles that meet cones, against closed forms and small steps. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "shared/collide.h"
#include "shared/shapes.h"
#include "support/cmocka.h"
#include "support/simulation.h"
#include "support/thrown.h"

static double between(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

/* Adds an upright cone. */
static struct kiln_object *add_cone(float x, float y, float z, float radius, float height)
{
    struct kiln_object *cone = fixture_add_cylinder(&fixture, x, y, z, radius, height);
    cone->kind = KILN_OBJECT_CONE;
    return cone;
}

/* ---- collision ------------------------------------------------------------------------------- */

static void a_cone_mirrors_at_side_and_base(void **state)
{
    (void)state;
    const double to_side[3] = {-8, 0, 0}, from_side[3] = {3, 0, 0};
    const double length = sqrt(1.25), side[3] = {1 / length, 0.5 / length, 0};
    shoot(from_side, to_side);
    add_cone(0, 0, 0, 0.5f, 1);
    expect_mirror(from_side, to_side, side, (3 - 0.25) / 8);

    const double up[3] = {0, 8, 0}, from_base[3] = {0.3, -3, 0.2}, base[3] = {0, -1, 0};
    shoot(from_base, up);
    add_cone(0, 0, 0, 0.5f, 1);
    expect_mirror(from_base, up, base, (3 - 0.5) / 8);

    const double down[3] = {0, -8, 0}, from_tip[3] = {0.1, 3, 0};
    shoot(from_tip, down);
    add_cone(0, 0, 0, 0.5f, 1);
    expect_mirror(from_tip, down, side, (3 - 0.3) / 8);

    /* Its axis along x: the base is at the left. */
    const double to_base[3] = {8, 0, 0}, from_left[3] = {-3, 0.2, 0.1}, left[3] = {-1, 0, 0};
    shoot(from_left, to_base);
    add_cone(0, 0, 0, 0.5f, 1)->axis = fixture_constant3(2, 0, 0);
    expect_mirror(from_left, to_base, left, (3 - 0.5) / 8);
}

/* A cone ends at its tip: its mirror image beyond the tip is not solid. */
static void nothing_is_solid_beyond_the_tip(void **state)
{
    (void)state;
    for (int i = 0; i < 6; i++) {
        const double from[3] = {3, 0.51 + 0.2 * i, 0.01 * i}, to[3] = {-8, 0, 0};
        shoot(from, to);
        add_cone(0, 0, 0, 0.5f, 1);
        assert_near((double)particle_velocity(after(30)).x, -8.0, 1e-6);
    }
}

/* Returns how far outside of a growing cone a particle is, m. */
static double outside_of(const struct kiln_object *cone, float3 at, float time_s)
{
    const float3 center = kiln_scene_value3(&fixture.scene, &cone->center, time_s);
    const float3 along = kiln_scene_value3(&fixture.scene, &cone->axis, time_s);
    const double half = 0.5 * (double)kiln_scene_value(&fixture.scene, &cone->height, time_s);
    const double radius = (double)kiln_scene_value(&fixture.scene, &cone->radius, time_s);
    const double a[3] = {(double)along.x, (double)along.y, (double)along.z};
    const double q[3] = {(double)(at.x - center.x), (double)(at.y - center.y),
                         (double)(at.z - center.z)};
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    const double height = (q[0] * a[0] + q[1] * a[1] + q[2] * a[2]) / length;
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - height * height;
    const double slope = radius / (2 * half);
    const double beside = sqrt(fmax(square, 0)) - slope * (half - height);
    return fmax(beside / sqrt(1 + slope * slope), -half - height);
}

/* A cone that moves, grows and turns through a cloud of particles never holds one of them. */
static void no_particle_gets_inside(void **state)
{
    (void)state;
    srand(3);
    for (int trial = 0; trial < 24; trial++) {
        const double from[3] = {between(-2, 2), between(1, 2), between(-2, 2)};
        const double v[3] = {-2 * from[0], between(-6, -2), -2 * from[2]};
        shoot(from, v);
        struct kiln_object *cone = add_cone(0, 0, 0, 0.4f, 0.8f);
        cone->axis.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, -1, 1, (float)between(0, 3));
        cone->center.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, (float)between(-1, 1));
        cone->radius = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0.4f, 1, (float)between(0.2, 1));
        cone->height = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0.8f, 1, (float)between(0.3, 2));
        for (uint32_t steps = 1; steps <= 40; steps++) {
            const struct kiln_particle p = after(steps);
            const float time_s =
                (float)((double)steps * fixture.scene.rate.den / fixture.scene.rate.num);
            const double outside = outside_of(cone, particle_position(p), time_s);
            if (outside < -1e-4)
                fail_msg("trial %d, step %u: %g m inside", trial, steps, -outside);
        }
    }
}

/* ---- rays ------------------------------------------------------------------------------------ */

static const float RADIUS = 0.7f, HALF_HEIGHT = 0.6f;

static struct kiln_draw_shape cone_shape(void)
{
    const float3 axis = float3_normalize((float3){0.5f, 1.0f, -0.3f}, (float3){0, 1, 0});
    const float3 across = float3_normalize((float3){0.0f, axis.z, -axis.y}, (float3){0, 1, 0});
    return (struct kiln_draw_shape){
        .kind = {SHAPE_CONE, 1, 0, 0},
        .center = {0.2f, 0.1f, -0.3f, 1.0f},
        .extent = {RADIUS, HALF_HEIGHT, RADIUS, RADIUS},
        .rows = {{across.x, across.y, across.z, 0.0f}, {axis.x, axis.y, axis.z, 0.0f}}};
}

static bool is_inside(const struct kiln_draw_shape *s, float3 at)
{
    const float3 from = float3_sub(at, (float3){s->center.x, s->center.y, s->center.z});
    const float height = real3_dot_all(from, s->rows[1]);
    const float aside = sqrtf(fmaxf(float3_dot(from, from) - height * height, 0.0f));
    return height > -HALF_HEIGHT && aside < RADIUS * (HALF_HEIGHT - height) / (2 * HALF_HEIGHT);
}

/* Rays enter and leave where small steps along them do, and the surface there faces the ray. */
static void rays_enter_and_leave(void **state)
{
    (void)state;
    const struct kiln_draw_shape cone = cone_shape();
    const float step = 0.002f;
    int hits = 0, bases = 0;
    srand(9);
    for (int i = 0; i < 600; i++) {
        const float3 origin = {(float)between(-3, 3), (float)between(-3, 3), (float)between(-3, 3)};
        const float3 aim = {(float)between(-0.5, 0.9), (float)between(-0.6, 0.8),
                            (float)between(-1, 0.4)};
        const float3 way = float3_normalize(float3_sub(aim, origin), (float3){0, 1, 0});
        float first = -1.0f, last = -1.0f;
        for (float t = 0.0f; t < 8.0f; t += step) {
            if (!is_inside(&cone, float3_add_scaled(origin, way, t)))
                continue;
            first = first < 0.0f ? t : first;
            last = t;
        }
        const struct ray_interval at = cone_cross(cone, shape_ray_of(origin, way));
        if (last - first < 5 * step || is_inside(&cone, origin))
            continue; /* a ray that grazes an edge, or starts inside */
        hits++;
        assert_near((double)at.near, (double)first, 2 * (double)step);
        assert_near((double)at.far, (double)last, 2 * (double)step);
        const struct shape_face face = cone_face(cone, shape_ray_of(origin, way), at.near);
        bases += face.number == 1.0f;
        assert_near((double)float3_dot(face.normal, face.normal), 1.0, 1e-4);
        assert_true(float3_dot(face.normal, way) < 1e-3f);
        const float3 before =
            float3_add_scaled(float3_add_scaled(origin, way, at.near), face.normal, 0.01f);
        assert_false(is_inside(&cone, before));
    }
    assert_true(hits > 100 && bases > 10 && bases < hits - 10);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_mirrors_at_side_and_base),
        cmocka_unit_test(nothing_is_solid_beyond_the_tip),
        cmocka_unit_test(no_particle_gets_inside),
        cmocka_unit_test(rays_enter_and_leave),
    };
    return cmocka_run_group_tests_name("cone", tests, NULL, NULL);
}
