/* Distance fields of meshes: what they say, the cache that keeps them, and particles that meet
 * them.
 */
#include <dirent.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/geometry/field.h"
#include "shared/random.h"
#include "support/bodies.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/thrown.h"

static struct kiln_field *create(const struct kiln_mesh *mesh, uint32_t cells, const char *cache)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(1 + cells % 3);
    struct kiln_field *field =
        kiln_field_create(mesh, "m.obj", cells, 0.0f, cache, threads, &error);
    if (!field)
        fail_msg("%s", error.message);
    kiln_threads_destroy(&threads);
    return field;
}

static void place_of(const struct kiln_field *field, size_t i, double p[3])
{
    const size_t row = field->size[0], layer = row * field->size[1];
    const size_t at[3] = {i % row, i / row % field->size[1], i / layer};
    for (int c = 0; c < 3; c++)
        p[c] = (double)field->origin[c] + (double)at[c] * (double)field->spacing;
}

static size_t count_of(const struct kiln_field *field)
{
    return (size_t)field->size[0] * field->size[1] * field->size[2];
}

/* ---- fields ---------------------------------------------------------------------------------- */

static void of_a_ball_it_is_the_way_to_its_surface(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = body_load_ball();
    struct kiln_field *field = create(mesh, 24, NULL);
    assert_int_equal(field->size[0], 24 + 1 + 4);
    const double dent = 1.5 * (1 - cos(3.14159 / 2 / RINGS)) * 2;
    for (size_t i = 0; i < count_of(field); i++) {
        double p[3];
        place_of(field, i, p);
        const double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        const float *s = field->samples[i];
        assert_true((double)s[3] >= r - 1 - 1e-5 && (double)s[3] <= r - 1 + dent);
        if (r > 0.5 && r < 1.12)
            for (int c = 0; c < 3; c++)
                assert_near((double)s[c], p[c] / r, 0.03);
    }
    kiln_field_destroy(&field);
    assert_null(field);
    kiln_mesh_destroy(&mesh);
}

/* Two boxes through one another, in one file: what is in both is inside, too. */
static void overlapping_parts_are_one_body(void **state)
{
    (void)state;
    struct body body = begin("two.obj");
    add_box(&body, 0, 0, 0, 2, 1, 1);
    add_box(&body, 0.25, 0, 0, 0.5, 2, 0.5);
    fclose(body.out);
    struct kiln_mesh *mesh = body_load("two.obj");
    struct kiln_field *field = create(mesh, 31, NULL);
    uint32_t both = 0;
    for (size_t i = 0; i < count_of(field); i++) {
        double p[3];
        place_of(field, i, p);
        const double wide = fmax(fabs(p[0]) - 1, fmax(fabs(p[1]) - 0.5, fabs(p[2]) - 0.5));
        const double tall = fmax(fabs(p[0] - 0.25) - 0.25, fmax(fabs(p[1]) - 1, fabs(p[2]) - 0.25));
        if (fabs(wide) > 1e-6 && fabs(tall) > 1e-6)
            assert_true((field->samples[i][3] < 0.0f) == (wide < 0 || tall < 0));
        both += wide < 0 && tall < 0;
    }
    assert_true(both > 50);
    kiln_field_destroy(&field);
    kiln_mesh_destroy(&mesh);
}

static void expect_refusal(const char *obj, const char *message)
{
    struct kiln_error error = {0};
    test_write_file("bad.obj", obj);
    struct kiln_mesh *mesh = body_load("bad.obj");
    size_t samples = 0;
    assert_false(kiln_field_check(mesh, "bad.obj", 8, 0.0f, &samples, &error));
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
    kiln_mesh_destroy(&mesh);
}

#define CORNERS "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"

static void what_has_no_inside_is_refused(void **state)
{
    (void)state;
    expect_refusal(CORNERS "f 1 3 2\nf 1 2 4\nf 1 4 3\n",
                   "bad.obj: the mesh is not closed, so it has no inside: 1 triangle is at the "
                   "edge from 0 0 1 to 0 1 0, where there must be two");
    expect_refusal(CORNERS "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n",
                   "bad.obj: the mesh is not closed, so it has no inside: 2 triangles are at the "
                   "edge from 0 0 1 to 0 1 0, and do not face the same side");
    expect_refusal(
        "v 0 0 0\nv 1 0 0\nv 0.3 0.001 1\nv 0.3 0.0009 1.02\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf "
        "2 3 4\n",
        "bad.obj: the mesh is thinner than one of 8 cells everywhere, so particles would not "
        "collide with it; at most 128 cells are allowed");
}

/* ---- cache ----------------------------------------------------------------------------------- */

static size_t count_files(const char *folder, char path[KILN_PATH_SIZE])
{
    size_t count = 0;
    DIR *all = opendir(folder);
    assert_non_null(all);
    for (struct dirent *entry = readdir(all); entry; entry = readdir(all)) {
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, KILN_PATH_SIZE, "%s/%.200s", folder, entry->d_name);
        count++;
    }
    closedir(all);
    return count;
}

static void assert_same(const struct kiln_field *a, const struct kiln_field *b)
{
    assert_memory_equal(a->size, b->size, sizeof a->size);
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
    assert_memory_equal(a->samples, b->samples, count_of(a) * sizeof *a->samples);
}

/* A field out of the cache is the one that was made, and other cells are another field. */
static void the_cache_changes_nothing(void **state)
{
    (void)state;
    char path[KILN_PATH_SIZE];
    struct kiln_mesh *mesh = body_load_ball();
    struct kiln_field *fresh = create(mesh, 9, NULL);
    struct kiln_field *written = create(mesh, 9, "cache");
    assert_int_equal(count_files("cache", path), 1);
    struct stat before, after;
    assert_int_equal(stat(path, &before), 0);
    struct kiln_field *read = create(mesh, 9, "cache");
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_ino == after.st_ino); /* it was not written again */
    assert_same(fresh, written);
    assert_same(fresh, read);
    struct kiln_field *other = create(mesh, 10, "cache");
    assert_int_equal(count_files("cache", path), 2);
    kiln_field_destroy(&other);
    kiln_field_destroy(&read);
    kiln_field_destroy(&written);
    read = create(mesh, 9, "ball.obj/nowhere"); /* no folder can be there */
    assert_same(fresh, read);
    kiln_field_destroy(&read);
    kiln_field_destroy(&fresh);
    kiln_mesh_destroy(&mesh);
}

/* ---- particles ------------------------------------------------------------------------------- */

static struct kiln_object *add_ball_object(float x, float y, float z)
{
    struct kiln_mesh *mesh = body_load_ball();
    kiln_mesh_destroy(&mesh);
    struct kiln_object *ball = fixture_add_mesh(&fixture, "ball.obj", x, y, z);
    ball->cells = 40;
    return ball;
}

/* Against a ball of radius 2 at (1, 2, 3), turned somehow: the exact point, normal and time; by
 * points, and by balls, one of them larger than what is around the mesh in any case. */
static void a_ball_mirrors_where_it_is_hit(void **state)
{
    (void)state;
    static const double asides[] = {0, 0.3, -0.6, 0.8}, speeds[] = {8, 80, 800};
    for (int i = 0; i < 36; i += i < 12 ? 1 : 5) {
        const double radius = i / 12 * 0.7, far = 2 + radius;
        const double y = asides[i % 4], x = sqrt(1 - y * y), speed = speeds[i / 4 % 3];
        const double normal[3] = {x, y, 0}, v[3] = {-speed, 0, 0}, time_s = 0.4;
        const double from[3] = {1 + far * x + speed * time_s, 2 + far * y, 3};
        struct kiln_system *system = throw_one(from, v);
        system->collide.slowdown = fixture_constant(0.5f);
        if (radius > 0)
            fixture_add_collisions(system, (float)radius);
        struct kiln_object *ball = add_ball_object(1, 2, 3);
        ball->scale = fixture_constant(2.0f);
        ball->rotation = fixture_constant3(0.5f, -1.0f, 2.0f);
        struct kiln_particle p = after(30);
        const float3 at = particle_position(p), u = particle_velocity(p);
        const double found_x[3] = {(double)at.x, (double)at.y, (double)at.z};
        const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        for (int c = 0; c < 3; c++) {
            const double mirrored = 0.5 * (v[c] + 2 * speed * x * normal[c]);
            assert_near(found_v[c], mirrored, 0.02 * speed);
            assert_near(found_x[c], from[c] + v[c] * time_s + mirrored * 0.1, 0.01 + 0.002 * speed);
        }
    }
}

/* What comes at 10 m/s, or grows by that, throws a resting particle at twice that speed; what turns
 * at w throws by its speed there. */
static void moving_surfaces_push(void **state)
{
    (void)state;
    const uint32_t time = KILN_CLOCK_TIME;
    const double from[3] = {2, 0, 0}, still[3] = {0.0001, 0, 0};
    throw_one(from, still);
    add_ball_object(0, 0, 0)->center.x = fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.05);

    throw_one(from, still);
    add_ball_object(0, 0, 0)->scale = fixture_ramp(&fixture, time, 0, 1, 1, 11);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.2);

    struct body body = begin("bar.obj");
    add_box(&body, 0, 0, 0, 4, 0.5, 0.5);
    fclose(body.out);
    throw_one(from, still);
    fixture.scene.systems[0].emit.origin = fixture_constant3(1.5f, 1, 0);
    struct kiln_object *bar = fixture_add_mesh(&fixture, "bar.obj", 0, 0, 0);
    bar->cells = 32;
    bar->rotation.z = fixture_ramp(&fixture, time, 0, 0, 1, 5);
    const float3 u = particle_velocity(after(20));
    /* Its face, which turns at 5 rad/s, gets to (1.5, 1): distance along it is the root of 3.25
     * less a sixteenth. */
    const double along = sqrt(3.25 - 1.0 / 16);
    assert_near((double)float3_length(u), 2 * 5 * along, 0.25);
}

/* Through a plate two cells thick, at up to 600 m/s. */
static void nothing_tunnels(void **state)
{
    (void)state;
    struct body body = begin("plate.obj");
    add_box(&body, 0, 0, 0, 8, 0.4, 8);
    fclose(body.out);
    for (int fast = 0; fast < 2; fast++) {
        a_crowd_around(1000, fast ? 600.0f : 20.0f, 9.81f);
        fixture_add_mesh(&fixture, "plate.obj", 0, 0, 0)->cells = 40;
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        for (int step = 0; step < 40; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t i = 0; i < run.pool.slot_count; i++) {
                const float3 p = particle_position(records[i]);
                if (exact_abs(p.x) < 3.9f && exact_abs(p.z) < 3.9f && p.y < 0.2f)
                    fail_msg("step %d: %g %g %g", step, (double)p.x, (double)p.y, (double)p.z);
            }
        }
        simulation_end(&run);
    }
}

/* What turns carries a ball's skin along, where it touches. */
static void a_ball_is_thrown_by_what_its_skin_meets(void **state)
{
    (void)state;
    const double from[3] = {0, 1.5, 0}, still[3] = {0, -0.0001, 0};
    struct body body = begin("bar.obj");
    add_box(&body, 0, 0, 0, 4, 0.5, 0.5);
    fclose(body.out);
    fixture_add_collisions(throw_one(from, still), 0.5f);
    fixture.scene.systems[0].collide.slowdown = fixture_constant(1.0f);
    struct kiln_object *bar = fixture_add_mesh(&fixture, "bar.obj", 0, 0, 0);
    bar->cells = 32;
    bar->center.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 6);
    const float3 u = particle_velocity(after(20));
    assert_near((double)u.y, 12, 0.05);
    assert_near((double)u.x, 0, 0.05);
}

/* Larger than the field may be. */
static void balls_too_large_for_a_mesh_are_refused(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_mesh *mesh = body_load_ball();
    size_t samples = 0;
    assert_true(kiln_field_check(mesh, "m.obj", 16, 1.0f, &samples, &error));
    struct kiln_field *field = kiln_field_create(mesh, "m.obj", 16, 1.0f, NULL, threads, &error);
    assert_non_null(field);
    assert_int_equal(field->size[0], 16 + 1 + 2 * (2 + 8));
    assert_int_equal(samples, (size_t)field->size[0] * field->size[1] * field->size[2]);
    kiln_field_destroy(&field);
    assert_false(kiln_field_check(mesh, "m.obj", 16, 100.0f, &samples, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "m.obj: balls with a radius of 100 units of the file reach 800 cells beyond the "
                 "mesh, which has 16 along its longest side; at most 128 are allowed");
    assert_false(kiln_field_check(mesh, "m.obj", 100, 1.5f, &samples, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "m.obj: 100 cells and balls with a radius of 1.5 units of the file need 16581375 "
                 "samples in and around the mesh; at most 4194304 are allowed");
    kiln_mesh_destroy(&mesh);
    kiln_threads_destroy(&threads);
}

static void without_gravity_no_impact_makes_faster(void **state)
{
    (void)state;
    a_crowd_around(1000, 60.0f, 0.0f);
    add_ball_object(0, 0, 0);
    no_bounce_makes_faster(0.995f);
}

/* Born inside: out by the nearest way. */
static void what_is_born_inside_comes_out(void **state)
{
    (void)state;
    const double from[3] = {0.5, 0, 0}, still[3] = {0, 0.0001, 0};
    throw_one(from, still);
    add_ball_object(0, 0, 0);
    const float3 p = particle_position(after(1));
    assert_near((double)p.x, 1, 5e-3);
    assert_near((double)p.y, 0, 5e-3);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_ball_it_is_the_way_to_its_surface),
        cmocka_unit_test(overlapping_parts_are_one_body),
        cmocka_unit_test(what_has_no_inside_is_refused),
        cmocka_unit_test(the_cache_changes_nothing),
        cmocka_unit_test(a_ball_mirrors_where_it_is_hit),
        cmocka_unit_test(moving_surfaces_push),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(a_ball_is_thrown_by_what_its_skin_meets),
        cmocka_unit_test(balls_too_large_for_a_mesh_are_refused),
        cmocka_unit_test(without_gravity_no_impact_makes_faster),
        cmocka_unit_test(what_is_born_inside_comes_out),
    };
    return cmocka_run_group_tests_name("field", tests, test_enter_folder, test_leave_folder);
}
