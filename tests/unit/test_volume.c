/* Particles that meet volumes of planes (Drone 2007, 7.5.2): closed forms, what moves and pushes,
 * sheets, and that nothing gets through.
 */
#include <stddef.h>
#include <stdint.h>

#include "asset/geometry/skin.h"
#include "shared/exact.h"
#include "sim/world/volumes.h"
#include "support/bodies.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/thrown.h"

static struct kiln_object *add_volume(const char *file, float x, float y, float z, uint32_t cells)
{
    struct kiln_object *object = fixture_add_mesh(&fixture, file, x, y, z);
    object->collider = KILN_COLLIDER_VOLUME;
    object->heading = fixture_constant3(0.0f, -1.0f, 0.0f);
    object->cells = cells;
    return object;
}

static const struct kiln_skin *move_by_clips(struct kiln_object *object)
{
    struct kiln_error error = {0};
    object->skin = kiln_mesh_library_get_skin(fixture.scene.meshes, object->file, &error);
    if (!object->skin)
        fail_msg("%s", error.message);
    object->shown = object->collision_mesh = kiln_skin_mesh(object->skin);
    return object->skin;
}

static void write_meshes(void)
{
    struct body body = begin("cube.obj");
    add_box(&body, 0, 0, 0, 1, 1, 1);
    fclose(body.out);
    body = begin("inside_out.obj");
    add_box(&body, 0, 0, 0, -1, 1, 1);
    fclose(body.out);
    body = begin("ball.obj");
    add_ball(&body);
    fclose(body.out);
    body = begin("plate.obj");
    add_box(&body, 0, 0, 0, 8, 0.4, 8);
    fclose(body.out);
    body = begin("bar.obj");
    add_box(&body, 0, 0, 0, 4, 0.5, 0.5);
    fclose(body.out);
    body = begin("heap.obj");
    fputs("v 0 0 0\nv 1 1 0\nv 0 1 1\n", body.out);
    for (int i = 0; i < 100; i++)
        fputs("f 1 2 3\n", body.out);
    fclose(body.out);
    test_write_file("sheet.obj", "v -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nf 1 2 3 4\n");
}

/* Away from its edges the planes of a cube are exact: place, time and velocity. */
static void a_cube_mirrors_where_it_is_hit(void **state)
{
    (void)state;
    static const double speeds[] = {3, 30, 300}, turns[] = {0, 0.4};
    for (int i = 0; i < 6; i++) {
        const double speed = speeds[i % 3], turn = turns[i / 3], time_s = 0.4;
        /* Onto the middle of a side of 2 m, from above, a bit aslant. */
        const double n[3] = {-sin(turn), cos(turn), 0}, hit[3] = {1 + n[0], 2 + n[1], 3};
        const double v[3] = {0.2 * speed, -speed, 0.1 * speed};
        const double from[3] = {hit[0] - v[0] * time_s, hit[1] - v[1] * time_s,
                                hit[2] - v[2] * time_s};
        struct kiln_collide *collide = &throw_one(from, v)->collide;
        collide->restitution = fixture_constant(0.5f);
        collide->friction = fixture_constant(0.1f);
        struct kiln_object *cube = add_volume(i % 2 ? "inside_out.obj" : "cube.obj", 1, 2, 3, 20);
        cube->scale = fixture_constant(2.0f);
        cube->rotation.z = fixture_constant((float)turn);
        const struct kiln_particle p = after(30);
        const float3 at = particle_position(p), u = particle_velocity(p);
        const double found_x[3] = {(double)at.x, (double)at.y, (double)at.z};
        const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        double across = 0, aside[3], along = 0;
        for (int c = 0; c < 3; c++)
            across += v[c] * n[c];
        for (int c = 0; c < 3; c++) {
            aside[c] = v[c] - across * n[c];
            along += aside[c] * aside[c];
        }
        const double kept = 1 + 0.1 * across * 1.5 / sqrt(along);
        for (int c = 0; c < 3; c++) {
            const double bounced = kept * aside[c] - 0.5 * across * n[c];
            assert_near(found_v[c], bounced, 1e-4 * speed);
            assert_near(found_x[c], hit[c] + bounced * 0.1, 2e-4 + 1e-5 * speed);
        }
    }
}

/* Planes of a round mesh go on beyond their triangles to the ends of their cells, so that place and
 * normal are off by a cell: 0.1 m of 2 m. */
static void a_ball_mirrors_within_a_cell(void **state)
{
    (void)state;
    static const double asides[] = {0, 0.3, -0.6, 0.8}, speeds[] = {8, 80, 800};
    const double cell = 0.1;
    for (int i = 0; i < 12; i++) {
        const double y = asides[i % 4], x = sqrt(1 - y * y), speed = speeds[i / 4];
        const double normal[3] = {x, y, 0}, v[3] = {-speed, 0, 0}, time_s = 0.4;
        const double from[3] = {1 + 2 * x + speed * time_s, 2 + 2 * y, 3};
        throw_one(from, v);
        struct kiln_object *ball = add_volume("ball.obj", 1, 2, 3, 40);
        ball->scale = fixture_constant(2.0f);
        ball->heading = fixture_constant3(-1.0f, 0.0f, 0.0f);
        ball->rotation = fixture_constant3(0.5f, -1.0f, 2.0f);
        const struct kiln_particle p = after(30);
        const float3 at = particle_position(p), u = particle_velocity(p);
        const double found_x[3] = {(double)at.x, (double)at.y, (double)at.z};
        const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        for (int c = 0; c < 3; c++) {
            const double mirrored = v[c] + 2 * speed * x * normal[c];
            assert_near(found_v[c], mirrored, 4 * cell / 2 * speed);
            assert_near(found_x[c], from[c] + v[c] * time_s + found_v[c] * 0.1,
                        cell + 2e-5 * speed);
        }
    }
}

/* What comes at 10 m/s, or grows by that, throws a resting particle at twice that speed; what turns
 * at w throws by its speed there. A step is as long as three cells and more. */
static void moving_surfaces_push(void **state)
{
    (void)state;
    const uint32_t time = KILN_CLOCK_TIME;
    const double from[3] = {2, 0.1, 0}, still[3] = {0.0001, 0, 0};
    throw_one(from, still);
    add_volume("cube.obj", 0, 0, 0, 20)->center.x = fixture_ramp(&fixture, time, 0, 0, 1, 10);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.02);

    throw_one(from, still);
    add_volume("cube.obj", 0, 0, 0, 20)->scale = fixture_ramp(&fixture, time, 0, 1, 1, 21);
    assert_near((double)particle_velocity(after(30)).x, 20, 0.1);

    throw_one(from, still);
    fixture.scene.systems[0].emit.origin = fixture_constant3(1.5f, 1, 0);
    struct kiln_object *bar = add_volume("bar.obj", 0, 0, 0, 40);
    bar->rotation.z = fixture_ramp(&fixture, time, 0, 0, 1, 5);
    const float3 u = particle_velocity(after(20));
    /* Its face, which turns at 5 rad/s, gets to (1.5, 1): distance along it is the root of 3.25
     * less a sixteenth. A velocity is that at the middle of a cell of 0.1 m. */
    const double along = sqrt(3.25 - 1.0 / 16);
    assert_near((double)float3_length(u), 2 * 5 * along, 2 * 5 * 0.1);
}

/* A clip of the file takes the face x + y + z = 1 of a tetrahedron towards a resting particle, at
 * (0.4, 0.2, 0) m/s, or twice that. */
static void what_a_clip_moves_pushes(void **state)
{
    (void)state;
    const double from[3] = {0.36, 0.36, 0.36}, still[3] = {0.0001, 0, 0};
    for (int speed = 1; speed <= 2; speed++) {
        throw_one(from, still);
        struct kiln_object *mesh =
            add_volume(KILN_SOURCE_DIR "/tests/mutation/moving.gltf", 0, 0, 0, 20);
        move_by_clips(mesh);
        mesh->animation = (struct kiln_animation){.enabled = true,
                                                  .clip = "go",
                                                  .speed = fixture_constant((float)speed),
                                                  .number = 1,
                                                  .length = 1.0f};
        const float3 u = particle_velocity(after(14));
        assert_near((double)u.x, 0.4 * speed, 0.002);
        assert_near((double)u.y, 0.4 * speed, 0.002);
        assert_near((double)u.z, 0.4 * speed, 0.002);
    }
}

/* From its end, a clip goes on at its start, which is 0.3 m away: nobody is hit by that at 19 m/s,
 * only by the clip, at 0.8 m/s. */
static void the_jump_to_the_start_sweeps_nothing(void **state)
{
    (void)state;
    a_crowd_around(2000, 0.0001f, 0.0f);
    struct kiln_emitter *emit = &fixture.scene.systems[0].emit;
    emit->origin = fixture_constant3(0.4f, 0.4f, 0.4f);
    emit->size = fixture_constant3(1.2f, 1.2f, 1.2f);
    struct kiln_object *mesh =
        add_volume(KILN_SOURCE_DIR "/tests/mutation/moving.gltf", 0, 0, 0, 20);
    move_by_clips(mesh);
    mesh->animation = (struct kiln_animation){.enabled = true,
                                              .clip = "go",
                                              .start = fixture_constant(0.5f),
                                              .speed = fixture_constant(1.0f),
                                              .loop = true,
                                              .number = 1,
                                              .length = 1.0f};
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, 35);
    uint32_t pushed = 0;
    for (uint32_t i = 0; i < 2000; i++) {
        const float speed = float3_length(particle_velocity(simulation_records(&run)[i]));
        pushed += speed > 0.1f;
        assert_true(speed < 4.0f);
    }
    assert_true(pushed > 20);
    simulation_end(&run);
}

/* A hundred triangles in one place. */
static void what_would_take_long_is_named(void **state)
{
    (void)state;
    rest_at((const double[3]){0, 5, 0});
    add_volume("heap.obj", 0, 0, 0, 155);
    fixture_finish(&fixture, 1);
    struct kiln_volumes volumes;
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(1);
    assert_true(kiln_volumes_init(&volumes, NULL, &fixture.scene, &error));
    assert_false(kiln_volumes_step(&volumes, &fixture.scene, 1, threads, &error));
    expect_error(
        &error, KILN_INVALID_INPUT,
        "backdrop.objects.0.mesh: 'heap.obj': the 100 triangles of a volume lie in 386989300 cells "
        "altogether in a step; at most 268435456 are allowed: set fewer cells");
    kiln_volumes_finish(&volumes);
    kiln_threads_destroy(&threads);
}

/* A sheet at 60 m/s, which goes through 10 cells in a step and 10 m in all, takes all particles
 * with it that are in front of it and no other. */
static void a_sheet_sweeps_all_before_it(void **state)
{
    (void)state;
    a_crowd_around(500, 0.01f, 0.0f);
    fixture.scene.systems[0].collide.slowdown = fixture_constant(1.0f);
    struct kiln_object *sheet = add_volume("sheet.obj", 0, 2.95f, 0, 40);
    sheet->sides = KILN_SIDES_TWO;
    sheet->center.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.1f, 2.999f, 0.3f, 15);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, 5);
    static float heights[500];
    for (uint32_t i = 0; i < 500; i++)
        heights[i] = particle_position(simulation_records(&run)[i]).y;
    simulation_run(&run, 13);
    uint32_t swept = 0;
    for (uint32_t i = 0; i < 500; i++) {
        const float3 p = particle_position(simulation_records(&run)[i]);
        if (heights[i] > 3.0f) {
            assert_true(p.y > 14.9f);
            swept++;
        } else if (heights[i] < 2.998f) {
            assert_true(p.y < 3.01f);
        }
    }
    assert_true(swept > 100 && swept < 400);
    simulation_end(&run);
}

/* Steps a crowd; p and its speed of each at the end of each step, for `check`. */
static uint32_t watch(int steps, bool (*check)(float3 p))
{
    struct simulation run;
    static float speeds[1000];
    uint32_t impacts = 0;
    simulation_start(&run, &fixture.scene, NULL, 1);
    const bool drops = fixture.scene.systems[0].forces[0].vector.y.constant != 0.0f;
    for (int step = 0; step < steps; step++) {
        simulation_run(&run, 1);
        const struct kiln_particle *records = simulation_records(&run);
        assert_true(run.pool.slot_count <= 1000);
        for (uint32_t i = 0; i < run.pool.slot_count; i++) {
            const float3 p = particle_position(records[i]);
            const float speed = float3_length(particle_velocity(records[i]));
            if (!check(p))
                fail_msg("step %d: %g %g %g", step, (double)p.x, (double)p.y, (double)p.z);
            assert_true(step == 0 || drops || speed <= speeds[i] * 1.000001f);
            impacts += step > 0 && speed < 0.9f * speeds[i];
            speeds[i] = speed;
        }
    }
    simulation_end(&run);
    return impacts;
}

static bool above_the_plate(float3 p)
{
    return exact_abs(p.x) > 3.9f || exact_abs(p.z) > 3.9f || p.y > 0.2f;
}

static bool around_the_ball(float3 p)
{
    return float3_length(p) > 0.99f;
}

static bool around_the_cube(float3 p)
{
    return float3_length(p) > 0.499f;
}

/* At up to 20 and up to 600 m/s: a plate of two cells, a ball, and a cube that turns and that
 * moves. Of what is convex, nothing gets behind a plane. */
static void nothing_tunnels(void **state)
{
    (void)state;
    for (int fast = 0; fast < 2; fast++) {
        const float speed = fast ? 600.0f : 20.0f;
        a_crowd_around(1000, speed, 9.81f);
        add_volume("plate.obj", 0, 0, 0, 40);
        assert_true(watch(40, above_the_plate) > 200);

        a_crowd_around(1000, speed, 9.81f);
        fixture.scene.systems[0].emit.angle = fixture_constant(0.4f);
        add_volume("ball.obj", 0, 0, 0, 20);
        assert_true(watch(40, around_the_ball) > 40);

        a_crowd_around(1000, speed, 9.81f);
        fixture.scene.systems[0].emit.angle = fixture_constant(0.4f);
        struct kiln_object *cube = add_volume("cube.obj", 0, 0, 0, 12);
        cube->heading = fixture_constant3(1.0f, 0.3f, 0.0f); /* as few go */
        cube->rotation.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, fast ? 30 : 3);
        cube->rotation.y = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 7);
        assert_true(watch(40, around_the_cube) > 10);
    }
}

static void without_gravity_no_impact_makes_faster(void **state)
{
    (void)state;
    a_crowd_around(1000, 60.0f, 0.0f);
    add_volume("ball.obj", 0, 0, 0, 40);
    assert_true(watch(20, around_the_ball) > 100);
}

/* A sheet has two sides where it is told so; else what comes from behind is put in front. */
static void sheets_have_one_side_or_two(void **state)
{
    (void)state;
    const double below[3] = {0.1, -1, 0.2}, up[3] = {0.3, 6, 0};
    const double above[3] = {0.1, 1, 0.2}, down[3] = {0.3, -6, 0};
    for (int two = 0; two < 2; two++) {
        throw_one(above, down);
        add_volume("sheet.obj", 0, 0, 0, 20)->sides = two ? KILN_SIDES_TWO : KILN_SIDES_ONE;
        assert_near((double)particle_velocity(after(20)).y, 6, 1e-4);
        throw_one(below, up);
        add_volume("sheet.obj", 0, 0, 0, 20)->sides = two ? KILN_SIDES_TWO : KILN_SIDES_ONE;
        const struct kiln_particle p = after(20);
        assert_near((double)particle_velocity(p).y, two ? -6 : 6, 1e-4);
        assert_true((particle_position(p).y < 0.0f) == (two != 0));
    }
}

/* In corners more than one plane is behind: whoever is put from one to the other stays near. */
static void clamping_puts_in_front(void **state)
{
    (void)state;
    const double from[3] = {0.3, 1.2, -0.2}, down[3] = {0, -3, 0};
    throw_one(from, down)->collide.mode = KILN_COLLIDE_CLAMP;
    add_volume("cube.obj", 0, 0, 0, 10);
    const struct kiln_particle p = after(30);
    assert_near((double)particle_velocity(p).y, 3, 1e-4);
    assert_true(particle_position(p).y > 0.5f);
}

/* Threads voxelise and step: the same state. */
static void threads_are_of_no_account(void **state)
{
    (void)state;
    struct kiln_state_hash first = {{0, 0}};
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        a_crowd_around(1000, 20.0f, 9.81f);
        struct kiln_object *ball = add_volume("ball.obj", 0, 0, 0, 30);
        ball->rotation.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 1, 7);
        add_volume("sheet.obj", 0, -2, 0, 20)->rotation.x = fixture_constant(0.3f);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, threads);
        const struct kiln_state_hash hash = simulation_run_hashed(&run, 30);
        if (threads == 1)
            first = hash;
        assert_memory_equal(&hash, &first, sizeof hash);
        simulation_end(&run);
    }
}

/* A volume is the same whether the run has come that far or begins there. */
/* A step of volumes that have seen others is that of new ones. */
static void compare_with_new(struct kiln_volumes *going, uint32_t step,
                             struct kiln_threads *threads)
{
    struct kiln_error error = {0};
    struct kiln_volumes fresh;
    assert_true(kiln_volumes_init(&fresh, NULL, &fixture.scene, &error));
    assert_true(kiln_volumes_step(&fresh, &fixture.scene, step, threads, &error));
    struct kiln_grid a[KILN_MAX_GRIDS], b[KILN_MAX_GRIDS];
    const struct kiln_collider one = kiln_volumes_collider(going, 0, 3, a);
    const struct kiln_collider two = kiln_volumes_collider(&fresh, 0, 3, b);
    assert_memory_equal(&one, &two, sizeof one);
    assert_memory_equal(&a[3], &b[3], sizeof a[0]);
    uint32_t cells, cells_of_fresh;
    const uint32_t planes = kiln_volumes_planes(going, &cells);
    assert_int_equal(planes, kiln_volumes_planes(&fresh, &cells_of_fresh));
    assert_int_equal(cells, cells_of_fresh);
    assert_true(planes > 1000 && planes < cells);
    const float4 *words = kiln_buffer_host(&going->words, KILN_READ, &error);
    const float4 *others = kiln_buffer_host(&fresh.words, KILN_READ, &error);
    assert_memory_equal(words, others, ((cells + 3) / 4 + 3 * planes) * sizeof *words);
    kiln_volumes_finish(&fresh);
}

/* Also a step back: from one in which nothing moves, over those in which it does, to another. */
static void volumes_follow_from_the_step_alone(void **state)
{
    (void)state;
    a_crowd_around(10, 1.0f, 0.0f);
    struct kiln_object *ball = add_volume("ball.obj", 0, 0, 0, 20);
    ball->center.x = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0.2f, 0, 0.4f, 1);
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_volumes going = {.count = 0};
    assert_true(kiln_volumes_init(&going, NULL, &fixture.scene, &error));
    for (uint32_t step = 1; step <= 32; step++) {
        assert_true(kiln_volumes_step(&going, &fixture.scene, step, threads, &error));
        if (step % 8 == 0)
            compare_with_new(&going, step, threads);
    }
    assert_true(kiln_volumes_step(&going, &fixture.scene, 4, threads, &error));
    compare_with_new(&going, 4, threads);
    kiln_volumes_finish(&going);
    kiln_threads_destroy(&threads);
}

/* ---- a figure that walks --------------------------------------------------------------------- */

/* How often a mesh winds around a point (van Oosterom and Strackee 1983): 1 inside, 0 outside. */
static double winding(const struct kiln_mesh *mesh, const double at[3])
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double v[3][3], length[3];
        for (int k = 0; k < 3; k++) {
            const float *p = mesh->vertices[mesh->triangles[i][k]];
            for (int c = 0; c < 3; c++)
                v[k][c] = (double)p[c] - at[c];
            length[k] = sqrt(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
        }
        double volume = 0, dots[3];
        for (int c = 0; c < 3; c++) {
            const int u = (c + 1) % 3, w = (c + 2) % 3;
            volume += v[0][c] * (v[1][u] * v[2][w] - v[1][w] * v[2][u]);
            const double *a = v[u], *b = v[w];
            dots[c] = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * length[c];
        }
        sum += 2 * atan2(volume, length[0] * length[1] * length[2] + dots[0] + dots[1] + dots[2]);
    }
    return sum / (4 * 3.14159265358979);
}

/* It walks into a crowd that stands in the air, at 1.1 m/s: whoever is met is pushed, and hardly
 * anybody is in the body then. */
static void a_figure_pushes_whom_it_walks_into(void **state)
{
    (void)state;
    static const char FILE_NAME[] = KILN_SOURCE_DIR "/scenes/meshes/walker.gltf";
    a_crowd_around(600, 0.0001f, 0.0f);
    struct kiln_emitter *emit = &fixture.scene.systems[0].emit;
    emit->origin = fixture_constant3(0.0f, 0.95f, 0.9f);
    emit->size = fixture_constant3(0.7f, 1.6f, 0.6f);
    fixture.scene.systems[0].collide.randomness = fixture_constant(0.0f);
    struct kiln_object *walker = add_volume(FILE_NAME, 0, 0, 0, 40);
    const struct kiln_skin *skin = move_by_clips(walker);
    walker->heading = fixture_constant3(0.0f, 0.0f, -1.0f);
    walker->center.z = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 0, 2, 2.2f);
    walker->animation = (struct kiln_animation){.enabled = true,
                                                .speed = fixture_constant(1.0f),
                                                .loop = true,
                                                .length = kiln_skin_clip_length(skin, 0)};
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 2);
    simulation_run(&run, 50);
    const float time_s = kiln_scene_time(&fixture.scene, 50);
    struct kiln_mesh *mesh = kiln_mesh_copy(kiln_skin_mesh(skin));
    assert_non_null(mesh);
    kiln_skin_pose_mesh(skin, 0, kiln_scene_animation_s(&walker->animation, time_s), mesh);
    uint32_t pushed = 0, inside = 0;
    for (uint32_t i = 0; i < 600; i++) {
        const struct kiln_particle p = simulation_records(&run)[i];
        const float3 x = particle_position(p);
        const double at[3] = {(double)x.x, (double)x.y, (double)x.z - 1.1 * (double)time_s};
        pushed += float3_length(particle_velocity(p)) > 0.5f;
        inside += winding(mesh, at) > 0.5;
    }
    assert_true(pushed > 100 && inside <= pushed / 100);
    simulation_end(&run);
    kiln_mesh_destroy(&mesh);
}

static int set_up(void **state)
{
    const int result = test_enter_folder(state);
    write_meshes();
    return result;
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_mirrors_where_it_is_hit),
        cmocka_unit_test(a_ball_mirrors_within_a_cell),
        cmocka_unit_test(moving_surfaces_push),
        cmocka_unit_test(what_a_clip_moves_pushes),
        cmocka_unit_test(the_jump_to_the_start_sweeps_nothing),
        cmocka_unit_test(what_would_take_long_is_named),
        cmocka_unit_test(a_sheet_sweeps_all_before_it),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(without_gravity_no_impact_makes_faster),
        cmocka_unit_test(sheets_have_one_side_or_two),
        cmocka_unit_test(clamping_puts_in_front),
        cmocka_unit_test(threads_are_of_no_account),
        cmocka_unit_test(volumes_follow_from_the_step_alone),
        cmocka_unit_test(a_figure_pushes_whom_it_walks_into),
    };
    return cmocka_run_group_tests_name("volume", tests, set_up, test_leave_folder);
}
