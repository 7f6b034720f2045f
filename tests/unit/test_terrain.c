/* Terrain: heights out of pictures and noise, its mesh, and particles that fall on it. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "shared/collide.h"
#include "sim/world/params.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/simulation.h"
#include "support/thrown.h"

/* A BMP of grey pixels, row by row from the top. */
static void write_picture(const char *path, int width, int height, const uint8_t *grey)
{
    uint8_t file[512] = {'B', 'M'};
    const int pitch = (3 * width + 3) / 4 * 4, size = 54 + pitch * height;
    assert_true(size <= (int)sizeof file);
    const int words[][2] = {{2, size},   {10, 54},     {14, 40},
                            {18, width}, {22, height}, {34, size - 54}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        memcpy(file + words[i][0], &words[i][1], 4);
    file[26] = 1;
    file[28] = 24;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            memset(file + 54 + (height - 1 - y) * pitch + 3 * x, grey[y * width + x], 3);
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(file, (size_t)size, 1, out), 1);
    assert_int_equal(fclose(out), 0);
}

static struct kiln_terrain *create(const struct kiln_terrain_params *params)
{
    struct kiln_error error = {0};
    struct kiln_terrain *terrain = kiln_terrain_create(params, &error);
    if (!terrain)
        fail_msg("%s", error.message);
    return terrain;
}

static const struct kiln_terrain_params SLOPE = {
    .image = "slope.bmp", .samples = {5, 3}, .position = {1, -2, 3}, .size = {8, 4, 2}};

/* Black on the left and white on the right: a plane, whatever the number of points. */
static void write_slope(void)
{
    write_picture("slope.bmp", 2, 2, (const uint8_t[]){0, 255, 0, 255});
}

static void a_picture_is_heights(void **state)
{
    (void)state;
    write_slope();
    struct kiln_terrain *terrain = create(&SLOPE);
    assert_near((double)terrain->origin[0], -3, 0);
    assert_near((double)terrain->origin[1], -2, 0);
    assert_near((double)terrain->origin[2], 2, 0);
    assert_near((double)terrain->top, 2, 0);
    for (uint32_t i = 0; i < 15; i++) {
        const struct kiln_terrain_point *point = &terrain->points[i];
        assert_near((double)point->height, (i % 5) - 2.0, 1e-6);
        assert_near((double)point->slope_x, 0.5, 1e-6);
        assert_near((double)point->slope_z, 0, 0);
        assert_true(point->ceiling > point->height + (i % 5 < 3 ? 2.0f : 0.0f));
    }
    kiln_terrain_destroy(&terrain);
    write_picture("rows.bmp", 1, 3, (const uint8_t[]){255, 51, 0});
    struct kiln_terrain_params rows = SLOPE;
    rows.image = "rows.bmp";
    terrain = create(&rows);
    assert_near((double)terrain->points[0].height, 2, 1e-6); /* the top is at low z */
    assert_near((double)terrain->points[9].height, -1.2, 1e-6);
    assert_near((double)terrain->points[14].height, -2, 1e-6);
    kiln_terrain_destroy(&terrain);
    assert_null(terrain);
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_terrain_params params = SLOPE;
    params.image = "missing.bmp";
    assert_null(kiln_terrain_create(&params, &error));
    expect_error(&error, KILN_IO,
                 "missing.bmp: the image cannot be opened: No such file or directory");
}

static const struct kiln_terrain_params HILLS = {.samples = {33, 17},
                                                 .position = {0, 1, 0},
                                                 .size = {8, 2.5f, 4},
                                                 .hills = 2.1f,
                                                 .roughness = 0.5f,
                                                 .octaves = 4,
                                                 .seed = 9};

static double total(const struct kiln_terrain_params *params)
{
    struct kiln_terrain *terrain = create(params);
    double sum = 0, least = 1e9, most = -1e9;
    for (uint32_t i = 0; i < params->samples[0] * params->samples[1]; i++) {
        const double height = (double)terrain->points[i].height;
        sum += height * (1 + i % 7);
        least = fmin(least, height);
        most = fmax(most, height);
    }
    assert_near(least, 1, 1e-6);
    assert_near(most, 3.5, 1e-5);
    kiln_terrain_destroy(&terrain);
    return sum;
}

static void noise_fills_its_height_and_varies_with_each_parameter(void **state)
{
    (void)state;
    struct kiln_terrain_params others[5] = {HILLS, HILLS, HILLS, HILLS, HILLS};
    others[0].seed = 10;
    others[1].octaves = 3;
    others[2].roughness = 0.4f;
    others[3].ridges = 0.5f;
    others[4].hills = 1.5f;
    const double sum = total(&HILLS);
    assert_true(total(&HILLS) == sum);
    for (int i = 0; i < 5; i++)
        if (fabs(total(&others[i]) - sum) < 1e-3)
            fail_msg("parameter %d changes nothing", i);
}

/* Every edge of the mesh but those at the bottom of its walls has two triangles, and all that is
 * not a wall faces upwards. */
static void the_mesh_is_the_ground_and_its_walls(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_terrain *terrain = create(&HILLS);
    struct kiln_mesh *mesh = kiln_terrain_mesh(terrain, &error);
    assert_non_null(mesh);
    assert_int_equal(mesh->triangle_count, 2 * 32 * 16 + 2 * 2 * (32 + 16));
    assert_near((double)mesh->max[0], 8, 0);
    assert_near((double)mesh->max[1], 2.5, 1e-5);
    assert_near((double)mesh->max[2], 4, 0);
    assert_near((double)mesh->min[1], 0, 1e-6);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *n = mesh->vertices[i] + 3;
        assert_near((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1, 1e-5);
        assert_true(i < 33 * 17 ? n[1] > 0.0f : n[1] == 0.0f);
    }
    double area = 0; /* seen from above */
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *a = mesh->vertices[mesh->triangles[i][0]];
        const float *b = mesh->vertices[mesh->triangles[i][1]];
        const float *c = mesh->vertices[mesh->triangles[i][2]];
        const double up = (double)((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]));
        assert_true(i < 2 * 32 * 16 ? up > 0 : up == 0);
        area += 0.5 * up;
    }
    assert_near(area, 32, 1e-4);
    kiln_mesh_destroy(&mesh);
    kiln_terrain_destroy(&terrain);
}

/* ---- particles ------------------------------------------------------------------------------- */

static struct kiln_object *add_slope(void)
{
    write_slope();
    struct kiln_object *slope = fixture_add_terrain(&fixture, -2.0f, 8.0f, 4.0f, 7);
    slope->center = fixture_constant3(1.0f, -2.0f, 3.0f);
    slope->file = "slope.bmp";
    return slope;
}

/* The plane y = x / 2 - 0.5, from x = -3 to 5 and z = -1 to 7: the closed form of a mirror, for
 * points and for balls. */
static void a_plane_mirrors(void **state)
{
    (void)state;
    const double normal[3] = {-1 / sqrt(5), 2 / sqrt(5), 0};
    static const double speeds[] = {4, 20, 200, 900};
    for (int i = 0; i < 24; i++) {
        const double speed = speeds[i % 4], angle = 0.26 * i;
        double way[3] = {0.6 * cos(angle) * speed, -speed, 0.6 * sin(angle) * speed};
        const double radius = i % 8 < 4 ? 0 : 0.4;
        /* The start is so far back that it takes so long. Balls have no radius while the step of
         * their birth lasts. */
        const double reach = radius > 0 ? fmax(1.5 / speed, 0.05) : 1.5 / speed;
        double from[3] = {1 + radius * normal[0] - way[0] * reach,
                          radius * normal[1] - way[1] * reach, 3 - way[2] * reach};
        struct kiln_system *system =
            one_particle(FLOAT3((float)from[0], (float)from[1], (float)from[2]),
                         FLOAT3((float)way[0], (float)way[1], (float)way[2]));
        system->collide.slowdown = fixture_constant(0.5f);
        if (radius > 0)
            fixture_add_collisions(system, (float)radius);
        add_slope();
        struct kiln_particle p = after((uint32_t)ceil(reach * 60) + 6);
        const double end_s = (ceil(reach * 60) + 6) / 60;
        float3 x = particle_position(p), u = particle_velocity(p);
        const double found_x[3] = {(double)x.x, (double)x.y, (double)x.z};
        const double found_v[3] = {(double)u.x, (double)u.y, (double)u.z};
        const double across = way[0] * normal[0] + way[1] * normal[1];
        for (int c = 0; c < 3; c++) {
            const double mirrored = 0.5 * (way[c] - 2 * across * normal[c]);
            const double place = from[c] + way[c] * reach + mirrored * (end_s - reach);
            assert_near(found_v[c], mirrored, 1e-5 * speed);
            assert_near(found_x[c], place, 5e-4 + 1e-5 * speed);
        }
    }
}

/* From the side, below the ground's edge: a wall. From below its middle, or born there: up. */
static void sides_are_walls_and_what_is_born_below_comes_up(void **state)
{
    (void)state;
    one_particle(FLOAT3(6.0f, -1.0f, 3.0f), FLOAT3(-4.0f, 0.0f, 1.0f));
    add_slope();
    struct kiln_particle p = after(30);
    assert_near((double)particle_position(p).x, 6, 1e-3); /* there and back */
    assert_near((double)particle_velocity(p).x, 4, 1e-5);
    assert_near((double)particle_velocity(p).z, 1, 1e-5);
    one_particle(FLOAT3(2.0f, -30.0f, 3.0f), FLOAT3(0.0f, 1.0f, 0.0f));
    add_slope();
    p = after(1);
    const double y = (double)particle_position(p).y;
    assert_true(y >= 0.5 && y < 0.52);
}

/* Height above the triangles at a place, in double. */
static double above(const struct kiln_terrain *terrain, const double p[3])
{
    const double x = (p[0] - (double)terrain->origin[0]) / (double)terrain->spacing[0];
    const double z = (p[2] - (double)terrain->origin[2]) / (double)terrain->spacing[1];
    const double i = fmin(fmax(floor(x), 0), terrain->samples[0] - 2);
    const double k = fmin(fmax(floor(z), 0), terrain->samples[1] - 2);
    const struct kiln_terrain_point *cell =
        &terrain->points[(size_t)k * terrain->samples[0] + (size_t)i];
    const double h00 = (double)cell[0].height, h11 = (double)cell[terrain->samples[0] + 1].height;
    const double u = x - i, v = z - k;
    const double middle = (double)(u >= v ? cell[1] : cell[terrain->samples[0]]).height;
    const double near = fmax(u, v), far = fmin(u, v);
    return p[1] - (h00 + near * (middle - h00) + far * (h11 - middle));
}

/* Crowds at up to 600 m/s, 10 m a step, among spikes half a cell wide. */
static void rain_on_spikes(struct kiln_terrain_params *params, float speed, bool falls)
{
    fixture_init(&fixture);
    struct kiln_system *system = fixture_add_system(&fixture, "crowd", 0.0f);
    system->emit.bursts[0] = (struct kiln_burst){.time_s = 0.0, .count = {2000, 2000}};
    system->emit.burst_count = 1;
    system->emit.life = fixture_range(10.0f, 10.0f);
    system->emit.shape = KILN_EMITTER_BOX;
    system->emit.origin = fixture_constant3(0.0f, 4.0f, 0.0f);
    system->emit.size = fixture_constant3(5.0f, 1.0f, 5.0f);
    system->emit.angle = fixture_constant(3.14f);
    system->emit.speed = fixture_range(0.1f * speed, speed);
    system->collide.enabled = true;
    system->collide.randomness = fixture_constant(0.3f);
    system->collide.slowdown = fixture_constant(0.9f);
    if (falls)
        fixture_add_force(system, KILN_FORCE_GRAVITY)->vector =
            fixture_constant3(0.0f, -9.81f, 0.0f);
    struct kiln_object *terrain = fixture_add_terrain(&fixture, 0.0f, 6.0f, 3.0f, 30);
    terrain->hills = fixture_constant(0.3f);
    terrain->roughness = fixture_constant(1.0f);
    *params = kiln_scene_terrain(&fixture.scene, terrain);
    fixture_finish(&fixture, 60);
}

static void nothing_tunnels(void **state)
{
    (void)state;
    for (int fast = 0; fast < 2; fast++) {
        struct kiln_terrain_params params;
        rain_on_spikes(&params, fast ? 600.0f : 20.0f, true);
        struct kiln_terrain *ground = create(&params);
        struct simulation run;
        simulation_start(&run, &fixture.scene, NULL, 1);
        uint32_t over = 0;
        for (int step = 0; step < 60; step++) {
            simulation_run(&run, 1);
            const struct kiln_particle *records = simulation_records(&run);
            for (uint32_t i = 0; i < run.pool.slot_count; i++) {
                if (!particle_is_alive(records[i]))
                    continue;
                const float3 x = particle_position(records[i]);
                const double p[3] = {(double)x.x, (double)x.y, (double)x.z};
                if (fabs(p[0]) >= 3 || fabs(p[2]) >= 3)
                    continue;
                over++;
                if (above(ground, p) < 0)
                    fail_msg("step %d: %g %g %g is %g below", step, p[0], p[1], p[2],
                             -above(ground, p));
            }
        }
        assert_true(over > (fast ? 1500 : 40000));
        simulation_end(&run);
        kiln_terrain_destroy(&ground);
    }
}

static void without_gravity_no_impact_makes_faster(void **state)
{
    (void)state;
    struct kiln_terrain_params params;
    rain_on_spikes(&params, 60.0f, false);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 1);
    simulation_run(&run, 1);
    double *speeds = calloc(run.pool.slot_count, sizeof *speeds);
    assert_non_null(speeds);
    uint32_t impacts = 0;
    for (int step = 0; step < 30; step++) {
        const struct kiln_particle *records = simulation_records(&run);
        for (uint32_t i = 0; i < run.pool.slot_count; i++) {
            const double speed = (double)float3_length(particle_velocity(records[i]));
            assert_true(step == 0 || speed <= speeds[i] * (1 + 1e-6));
            impacts += step > 0 && speed < 0.95 * speeds[i];
            speeds[i] = speed;
        }
        simulation_run(&run, 1);
    }
    assert_true(impacts > 400);
    free(speeds);
    simulation_end(&run);
}

/* ---- the march ------------------------------------------------------------------------------- */

/* The first part of a segment at which it is below ground, found in small steps. */
static double first_below(const struct kiln_terrain *terrain, const double a[3], const double b[3])
{
    enum { PARTS = 4000 };
    double before = above(terrain, a);
    for (int i = 1; i <= PARTS; i++) {
        double p[3];
        for (int c = 0; c < 3; c++)
            p[c] = a[c] + (b[c] - a[c]) * i / PARTS;
        const double now = above(terrain, p);
        if (now <= 0)
            return (i - 1 + before / (before - now)) / PARTS;
        before = now;
    }
    return 2;
}

/* The surroundings of rain_on_spikes, as a step has them. */
static void paths_end_where_the_ground_is(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_terrain_params params;
    struct kiln_sim_grids grids;
    rain_on_spikes(&params, 20.0f, false);
    struct kiln_terrain *ground = create(&params);
    assert_true(kiln_sim_grids_init(&grids, NULL, &fixture.scene, NULL, &error));
    const float4 *words = kiln_buffer_host(&grids.words, KILN_READ, &error);
    assert_non_null(words);
    struct kiln_surroundings around = {.collider_count = 1};
    around.grids[0] = grids.table[0];
    const struct kiln_sim sim = {.surroundings = &around, .grid_words = words};
    const struct kiln_collider c = {.min = FLOAT4(-3, -1e6f, -3, 0),
                                    .max = FLOAT4(3, grids.top[0] + 0.01f, 3, 0),
                                    .min_end = FLOAT4(-3, -1e6f, -3, 0),
                                    .max_end = FLOAT4(3, grids.top[0] + 0.01f, 3, 0),
                                    .kind = COLLIDER_TERRAIN};
    uint32_t hits = 0, misses = 0;
    for (uint32_t i = 0; i < 1500; i++) {
        double ends[2][3];
        for (uint32_t k = 0; k < 6; k++)
            ends[k / 3][k % 3] =
                (double)random_unit(i, k) * (k % 3 == 1 ? 3 : 5.8) - (k % 3 == 1 ? 0 : 2.9);
        if (i % 5 == 0) /* along an axis */
            ends[1][i % 2 ? 0 : 2] = ends[0][i % 2 ? 0 : 2];
        float3 from = FLOAT3((float)ends[0][0], (float)ends[0][1], (float)ends[0][2]);
        float3 to = FLOAT3((float)ends[1][0], (float)ends[1][1], (float)ends[1][2]);
        if (above(ground, ends[0]) < 1e-3) {
            assert_true(above(ground, ends[0]) > -1e-3 ||
                        !terrain_segment(&sim, c, from, to).outside);
            continue;
        }
        const struct collide_span span = terrain_segment(&sim, c, from, to);
        const double expected = first_below(ground, ends[0], ends[1]);
        if (span.misses) {
            misses++;
            assert_near(expected, 2, 0);
        } else { /* the small steps miss what is grazed */
            hits++;
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = ends[0][k] + (ends[1][k] - ends[0][k]) * (double)span.enter;
            assert_true((double)span.enter < expected + 1e-4 && span.outside);
            assert_near(above(ground, p), 0, 2e-4);
        }
    }
    assert_true(hits > 300 && misses > 30);
    kiln_sim_grids_finish(&grids);
    kiln_terrain_destroy(&ground);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_is_heights),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(noise_fills_its_height_and_varies_with_each_parameter),
        cmocka_unit_test(the_mesh_is_the_ground_and_its_walls),
        cmocka_unit_test(a_plane_mirrors),
        cmocka_unit_test(sides_are_walls_and_what_is_born_below_comes_up),
        cmocka_unit_test(nothing_tunnels),
        cmocka_unit_test(without_gravity_no_impact_makes_faster),
        cmocka_unit_test(paths_end_where_the_ground_is),
    };
    return cmocka_run_group_tests_name("terrain", tests, test_enter_folder, test_leave_folder);
}
