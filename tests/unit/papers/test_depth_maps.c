/* Depth maps of meshes: what they say, how far they are from distance fields, and particles that
 * meet them.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "asset/geometry/field.h"
#include "asset/geometry/papers/depth_maps.h"
#include "shared/collide.h"
#include "support/bodies.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/thrown.h"

static const float ALONG[3][3] = {{1, 0, 0}, {0, 2, 0}, {0, 0, 0.5f}};
static const float ACROSS[3][3] = {{1, 1, 0}, {-1, 1, 0.5f}, {0.3f, -0.2f, -1}};

static struct kiln_depth_maps *create(const struct kiln_mesh *mesh, const float (*directions)[3],
                                      uint32_t count, uint32_t resolution, uint32_t workers)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(workers);
    struct kiln_depth_maps *maps =
        kiln_depth_maps_create(mesh, "m.obj", directions, count, resolution, threads, &error);
    if (!maps)
        fail_msg("%s", error.message);
    kiln_threads_destroy(&threads);
    return maps;
}

/* The same large triangle over and over. */
static void what_would_take_long_is_refused(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    static float vertices[3][6] = {{0, 0, 0, 0, 0, 1}, {1, 0, 0.1f, 0, 0, 1}, {0, 1, 0, 0, 0, 1}};
    static uint32_t triangles[MANY][3];
    struct kiln_mesh mesh = {.vertex_count = 3,
                             .triangle_count = MANY,
                             .vertices = vertices,
                             .triangles = triangles,
                             .max = {1, 1, 0.1f}};
    struct kiln_error error = {0};
    for (int i = 0; i < MANY; i++)
        for (uint32_t k = 0; k < 3; k++)
            triangles[i][k] = k;
    assert_false(kiln_depth_maps_check(&mesh, "m.obj", ALONG, 3, 256, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "m.obj: the 10000 triangles of the mesh lie in 615040000 samples of a depth map "
                 "altogether; at most 268435456 are allowed: lower the resolution");
    assert_true(kiln_depth_maps_check(&mesh, "m.obj", ALONG, 3, 64, &error));
    mesh.triangle_count = 100;
    assert_true(kiln_depth_maps_check(&mesh, "m.obj", ALONG, 3, 256, &error));
}

/* ---- maps ------------------------------------------------------------------------------------ */

static double along(const float row[4], const double p[3])
{
    return (double)row[0] * p[0] + (double)row[1] * p[1] + (double)row[2] * p[2] + (double)row[3];
}

/* The place of a sample at height 0, and the front at `side` 0 or the back at 1 of a map. */
static const float *sample_of(const struct kiln_depth_maps *maps, uint32_t map, uint32_t i,
                              uint32_t side)
{
    const uint32_t samples = maps->resolution * maps->resolution;
    return (const float *)(maps->words + 3 * maps->count + 2 * (map * samples + i) + side);
}

/* Directions of a map, from its rows. */
static void place_of(const struct kiln_depth_maps *maps, uint32_t map, uint32_t i, double p[3])
{
    const double at[2] = {i % maps->resolution, (double)(i / maps->resolution)};
    p[0] = p[1] = p[2] = 0;
    for (int a = 0; a < 2; a++) {
        const float *row = (const float *)(maps->words + 3 * map + a);
        double square = 0;
        for (int c = 0; c < 3; c++)
            square += (double)row[c] * (double)row[c];
        for (int c = 0; c < 3; c++)
            p[c] += (at[a] - (double)row[3]) * (double)row[c] / square;
    }
}

static void of_a_ball_they_are_its_fronts_and_backs(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = body_load_ball();
    for (int k = 0; k < 2; k++) {
        struct kiln_depth_maps *maps = create(mesh, k ? ACROSS : ALONG, 3, 64, 1);
        uint32_t covered = 0;
        for (uint32_t i = 0; i < 3 * 64 * 64; i++) {
            double p[3];
            place_of(maps, i / 4096, i % 4096, p);
            const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
            const float *front = sample_of(maps, i / 4096, i % 4096, 0);
            const float *back = sample_of(maps, i / 4096, i % 4096, 1);
            const float *up = (const float *)(maps->words + i / 4096 * 3 + 2);
            assert_near(along(up, p), 0, 1e-6);
            if (square > 1.2)
                assert_near((double)front[3], (double)back[3], 0);
            if (square > 0.94)
                continue;
            const double height = sqrt(1 - square);
            covered++;
            assert_near((double)front[3], height, 0.004 / height);
            assert_near((double)back[3], -height, 0.004 / height);
            for (int c = 0; c < 3; c++) {
                assert_near((double)front[c], p[c] + height * (double)up[c], 0.05);
                assert_near((double)back[c], p[c] - height * (double)up[c], 0.05);
            }
        }
        assert_true(covered > 5000);
        kiln_depth_maps_destroy(&maps);
        assert_null(maps);
    }
    kiln_mesh_destroy(&mesh);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = body_load_ball();
    struct kiln_depth_maps *one = create(mesh, ACROSS, 3, 100, 1);
    struct kiln_depth_maps *many = create(mesh, ACROSS, 3, 100, 5);
    assert_int_equal(one->word_count, many->word_count);
    assert_memory_equal(one->words, many->words, one->word_count * sizeof *one->words);
    kiln_depth_maps_destroy(&one);
    kiln_depth_maps_destroy(&many);
    kiln_mesh_destroy(&mesh);
}

/* What a step would look up, of the maps alone. */
static struct kiln_grid grid_of(const struct kiln_depth_maps *maps)
{
    return (struct kiln_grid){.origin = FLOAT4(maps->min[0], maps->min[1], maps->min[2], 0),
                              .per_metre = FLOAT4(maps->max[0], maps->max[1], maps->max[2], 0),
                              .size = {maps->resolution, maps->resolution, maps->count, 0}};
}

static bool is_inside(const struct kiln_depth_maps *maps, float3 p)
{
    const struct kiln_sim sim = {.grid_words = (const float4 *)(const void *)maps->words};
    return depth_is_within(&sim, grid_of(maps), p);
}

static float3 random_place(uint32_t i, float reach)
{
    return FLOAT3(reach * (2.0f * random_unit(i, 0) - 1.0f),
                  reach * (2.0f * random_unit(i, 1) - 1.0f),
                  reach * (2.0f * random_unit(i, 2) - 1.0f));
}

/* Along its faces exactly; from one side alone, two samples wider. */
static void a_box_is_itself(void **state)
{
    (void)state;
    body_write_box("box.obj", 2, 1, 0.5);
    struct kiln_mesh *mesh = body_load("box.obj");
    struct kiln_depth_maps *three = create(mesh, ALONG, 3, 32, 1);
    struct kiln_depth_maps *one = create(mesh, ALONG + 2, 1, 32, 1);
    uint32_t inside = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        const float3 p = random_place(i, 1.2f);
        const float x = fabsf(p.x) - 1.0f, y = fabsf(p.y) - 0.5f, z = fabsf(p.z) - 0.25f;
        const float out = fmaxf(fmaxf(x, y), z);
        if (fabsf(out) > 1e-5f)
            assert_int_equal(is_inside(three, p), out < 0.0f);
        if (fabsf(out) > 1e-5f && (out < 0.0f || z > 0.0f))
            assert_int_equal(is_inside(one, p), out < 0.0f);
        if (x > 0.2f || y > 0.1f)
            assert_false(is_inside(one, p));
        inside += out < 0.0f;
    }
    assert_true(inside > 500);
    kiln_depth_maps_destroy(&three);
    kiln_depth_maps_destroy(&one);
    kiln_mesh_destroy(&mesh);
}

/* A tube along y, of four walls: no direction but y looks through it. How much of what is not
 * inside by the distance field is so by the maps. */
static void hollows_that_no_direction_sees_are_filled(void **state)
{
    (void)state;
    struct body body = begin("tube.obj");
    add_box(&body, -0.8, 0, 0, 0.4, 2, 2);
    add_box(&body, 0.8, 0, 0, 0.4, 2, 2);
    add_box(&body, 0, 0, -0.8, 1.8, 2, 0.4);
    add_box(&body, 0, 0, 0.8, 1.8, 2, 0.4);
    fclose(body.out);
    struct kiln_mesh *mesh = body_load("tube.obj");
    struct kiln_depth_maps *blind = create(mesh, ACROSS + 2, 1, 64, 1);
    struct kiln_depth_maps *seeing = create(mesh, ALONG, 3, 64, 1);
    uint32_t filled = 0, hollow = 0, wrong = 0, solid = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        const float3 p = random_place(i, 0.95f);
        const float aside = fmaxf(fabsf(p.x), fabsf(p.z));
        if (fabsf(aside - 0.6f) < 0.08f) /* two samples */
            continue;
        const bool is_hollow = aside < 0.6f;
        hollow += is_hollow;
        solid += !is_hollow;
        filled += is_hollow && is_inside(blind, p);
        wrong += is_inside(seeing, p) == is_hollow;
        assert_true(is_hollow || is_inside(blind, p));
    }
    assert_true(filled > hollow / 2 && hollow > 5000 && solid > 5000);
    assert_int_equal(wrong, 0);
    kiln_depth_maps_destroy(&blind);
    kiln_depth_maps_destroy(&seeing);
    kiln_mesh_destroy(&mesh);
}

/* How far from the surface of a ball paths are said to end. */
struct miss {
    double worst, sum;
};

static void add_miss(struct miss *miss, const double from[3], const double to[3], double part)
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        const double p = from[c] + part * (to[c] - from[c]);
        square += p * p;
    }
    miss->worst = fmax(miss->worst, fabs(sqrt(square) - 1));
    miss->sum += fabs(sqrt(square) - 1);
}

/* The part of a path at which it meets the unit ball; 2: it does not; -1: who knows. */
static double meets_ball(const double from[3], const double to[3])
{
    double a = 0, b = 0, c = -1;
    for (int k = 0; k < 3; k++) {
        a += (to[k] - from[k]) * (to[k] - from[k]);
        b += 2 * from[k] * (to[k] - from[k]);
        c += from[k] * from[k];
    }
    const double square = b * b - 4 * a * c, part = (-b - sqrt(fmax(square, 0))) / (2 * a);
    if (c < 0.02 || fabs(part - 1) < 0.01 || fabs(square) < 0.05 * a)
        return -1;
    return square > 0 && part > 0 && part < 1 ? part : 2;
}

/* Where paths first meet a ball, by maps and by the distance field that is the default: both are
 * about as far from the closed form as the triangles are, which lie up to 0.0015 inside. */
static void paths_end_where_the_ball_is(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = body_load_ball();
    struct kiln_depth_maps *maps = create(mesh, ALONG, 3, 128, 2);
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_field *field = kiln_field_create(mesh, "ball", 48, 0.0f, NULL, threads, &error);
    assert_non_null(field);
    const struct kiln_sim by_maps = {.grid_words = (const float4 *)(const void *)maps->words};
    const struct kiln_sim by_field = {.grid_words = (const float4 *)(const void *)field->samples};
    const float per_unit = 1.0f / field->spacing;
    const struct kiln_grid grid = {
        .origin = FLOAT4(field->origin[0], field->origin[1], field->origin[2], 0),
        .per_metre = FLOAT4(per_unit, per_unit, per_unit, 0),
        .size = {field->size[0], field->size[1], field->size[2], 0}};
    const struct sdf_reach points = {0.0f, 0.0f};
    struct miss of_maps = {0, 0}, of_field = {0, 0};
    uint32_t hits = 0, misses = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        const float3 a = float3_scale(random_place(i, 1.0f), 3.0f);
        const float3 b = random_place(i + 5000, i % 2 ? 3.0f : 1.0f);
        const double from[3] = {(double)a.x, (double)a.y, (double)a.z};
        const double to[3] = {(double)b.x, (double)b.y, (double)b.z};
        const double part = meets_ball(from, to);
        const float hit = depth_first_inside(&by_maps, grid_of(maps), a, b, 0.0f, 1.0f);
        misses += part > 1;
        assert_true(part < 0 || (part > 1) == (hit > 1.0f));
        if (part < 0 || part > 1)
            continue;
        hits++;
        add_miss(&of_maps, from, to, (double)hit);
        const struct collide_span span = sdf_box_segment(grid, a, b);
        add_miss(&of_field, from, to,
                 (double)sdf_march(&by_field, grid, a, b, points, span.enter, 1.0f));
    }
    assert_true(hits > 800 && misses > 500);
    print_message("off the ball on average and at worst: maps %.2g, %.2g; field %.2g, %.2g\n",
                  of_maps.sum / hits, of_maps.worst, of_field.sum / hits, of_field.worst);
    assert_true(of_maps.worst < 0.006 && of_maps.sum < 1.5 * of_field.sum);
    kiln_field_destroy(&field);
    kiln_depth_maps_destroy(&maps);
    kiln_threads_destroy(&threads);
    kiln_mesh_destroy(&mesh);
}

/* ---- particles ------------------------------------------------------------------------------- */

static struct kiln_object *add_ball_object(float x, float y, float z)
{
    struct kiln_mesh *mesh = body_load_ball();
    kiln_mesh_destroy(&mesh);
    struct kiln_object *ball = fixture_add_mesh(&fixture, "ball.obj", x, y, z);
    fixture_map_depths(ball, 128);
    return ball;
}

/* Against a ball of radius 2 at (1, 2, 3), turned somehow: the exact point, normal and time. */
static void a_ball_mirrors_where_it_is_hit(void **state)
{
    (void)state;
    static const double asides[] = {0, 0.3, -0.6, 0.8}, speeds[] = {8, 80, 800};
    for (int i = 0; i < 12; i++) {
        const double y = asides[i % 4], x = sqrt(1 - y * y), speed = speeds[i / 4];
        const double normal[3] = {x, y, 0}, v[3] = {-speed, 0, 0}, time_s = 0.4;
        const double from[3] = {1 + 2 * x + speed * time_s, 2 + 2 * y, 3};
        shoot(from, v);
        struct kiln_object *ball = add_ball_object(1, 2, 3);
        ball->scale = fixture_constant(2.0f);
        ball->rotation = fixture_constant3(0.5f, -1.0f, 2.0f);
        struct kiln_particle p = after(30);
        const float3 at = particle_position(p), u = particle_velocity(p);
        const double found_x[3] = {(double)at.x, (double)at.y, (double)at.z};
        const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        for (int c = 0; c < 3; c++) {
            const double mirrored = 0.5 * (v[c] + 2 * speed * x * normal[c]);
            assert_near(found_v[c], mirrored, 0.05 * speed);
            assert_near(found_x[c], from[c] + v[c] * time_s + mirrored * 0.1, 0.01 + 0.005 * speed);
        }
    }
}

/* Each face of a box, with restitution, friction and slowdown, of the system and of the mesh. */
static void a_box_gives_back_and_rubs(void **state)
{
    (void)state;
    body_write_box("box.obj", 2, 2, 2);
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, next = (axis + 1) % 3, last = (axis + 2) % 3;
        const double sign = face % 2 ? 1 : -1;
        double from[3] = {0.1, 0.2, 0.3}, v[3] = {0.5, 0.25, -0.5};
        from[axis] = sign * 3;
        v[axis] = -sign * 8;
        struct kiln_system *system = shoot(from, v);
        system->collide.restitution = fixture_constant(0.8f);
        system->collide.friction = fixture_constant(0.1f);
        struct kiln_object *box = fixture_add_mesh(&fixture, "box.obj", 0, 0, 0);
        fixture_map_depths(box, 50);
        box->restitution = fixture_constant(0.5f);
        box->friction = fixture_constant(0.25f);
        const float3 u = particle_velocity(after(30));
        const double found[3] = {(double)u.x, (double)u.y, (double)u.z};
        const double beside = sqrt(v[next] * v[next] + v[last] * v[last]);
        const double kept = (beside - 0.025 * 8 * 1.4) / beside;
        assert_near(found[axis], 0.5 * 0.4 * 8 * sign, 1e-4);
        assert_near(found[next], 0.5 * kept * v[next], 1e-4);
        assert_near(found[last], 0.5 * kept * v[last], 1e-4);
    }
}

/* What comes at 10 m/s, or grows by that, throws a resting particle at twice that speed; what turns
 * at w throws by its speed there. */
static void moving_surfaces_push(void **state)
{
    (void)state;
    const uint32_t time = KILN_CLOCK_TIME;
    const double from[3] = {2, 0, 0};
    rest_at(from);
    add_ball_object(0, 0, 0)->center.x = fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.1);

    rest_at(from);
    add_ball_object(0, 0, 0)->scale = fixture_ramp(&fixture, time, 0, 1, 1, 11);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.3);

    body_write_box("bar.obj", 4, 0.5, 0.5);
    rest_at((double[]){1.5, 1, 0});
    struct kiln_object *bar = fixture_add_mesh(&fixture, "bar.obj", 0, 0, 0);
    fixture_map_depths(bar, 64);
    bar->rotation.z = fixture_ramp(&fixture, time, 0, 0, 1, 5);
    const float3 u = particle_velocity(after(20));
    const double reach = sqrt(3.25 - 1.0 / 16); /* along the face, as in test_field.c */
    assert_near((double)float3_length(u), 2 * 5 * reach, 0.1);
}

/* Plates of a millimetre and of nothing at all, level and tilted, at up to 600 m/s. */
static void nothing_tunnels(void **state)
{
    (void)state;
    body_write_box("plate.obj", 20, 0.001, 20);
    test_write_file("sheet.obj", "v -10 0 -10\nv 10 0 -10\nv 10 0 10\nv -10 0 10\nf 1 4 3 2\n");
    for (int i = 0; i < 8; i++) {
        const float tilt = i & 2 ? 0.4f : 0.0f, slope = tanf(tilt);
        a_crowd_around(500, i & 1 ? 600.0f : 20.0f, 9.81f);
        struct kiln_object *plate =
            fixture_add_mesh(&fixture, i & 4 ? "sheet.obj" : "plate.obj", 0, 0, 0);
        fixture_map_depths(plate, 64);
        plate->rotation.z = fixture_constant(tilt);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        uint32_t near = 0;
        for (int step = 0; step < 40; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t k = 0; k < run.pool.slot_count; k++) {
                const float3 p = particle_position(records[k]);
                if (exact_abs(p.x) > 8.9f || exact_abs(p.z) > 9.9f)
                    continue;
                near++;
                if (p.y < slope * p.x)
                    fail_msg("%d, step %d: %g %g %g", i, step, (double)p.x, (double)p.y,
                             (double)p.z);
            }
        }
        assert_true(near > 500);
        simulation_end(&run);
    }
}

/* Among shapes at rest no bounce adds speed, and nobody gets in. */
static void without_gravity_no_impact_makes_faster(void **state)
{
    (void)state;
    a_crowd_around(1000, 60.0f, 0.0f);
    add_ball_object(0, 0, 0);
    no_bounce_makes_faster(0.995f);
}

/* Born inside: out along the direction in which that is nearest. */
static void what_is_born_inside_comes_out(void **state)
{
    (void)state;
    rest_at((double[]){0.5, 0, 0});
    add_ball_object(0, 0, 0);
    float3 p = particle_position(after(1));
    assert_near((double)p.x, 1, 5e-3);
    assert_near((double)p.y, 0, 5e-3);

    rest_at((double[]){0.5, 0, 0})->collide.mode = KILN_COLLIDE_CLAMP;
    add_ball_object(0, 0, 0);
    p = particle_position(after(1));
    assert_near((double)p.x, 1, 5e-3);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_ball_they_are_its_fronts_and_backs),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(a_box_is_itself),
        cmocka_unit_test(hollows_that_no_direction_sees_are_filled),
        cmocka_unit_test(paths_end_where_the_ball_is),
        cmocka_unit_test(a_ball_mirrors_where_it_is_hit),
        cmocka_unit_test(a_box_gives_back_and_rubs),
        cmocka_unit_test(moving_surfaces_push),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(without_gravity_no_impact_makes_faster),
        cmocka_unit_test(what_is_born_inside_comes_out),
        cmocka_unit_test(what_would_take_long_is_refused),
    };
    return cmocka_run_group_tests_name("depth_maps", tests, test_enter_folder, test_leave_folder);
}
