/* Particles are born on meshes, images and paths where they should be, as often as they should be,
 * with the velocity of what they are born on. If this fails, births are not uniform, or lie beside
 * their mesh, or drawing finds another colour than that of the place of the birth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/motion.h"
#include "scene/source.h"
#include "scene/source_alias.h"
#include "shared/emit.h"
#include "shared/particle.h"
#include "support/cmocka.h"
#include "support/folders.h"
#include "support/scenes.h"
#include "support/simulation.h"

enum { BIRTHS = 1000000 };

/* Loads a scene whose one system is born at once, at rest, and runs its first step. */
static struct kiln_scene *bear(struct simulation *run, const char *from, uint32_t births,
                               const char *more)
{
    char text[2048];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n%s"
             "systems: {a: {emit: {bursts: {0 s: %u}, life: 9 s, speed: 0, %s}}}\n",
             more, births, from);
    struct kiln_scene *scene = load_scene(text, NULL);
    simulation_start(run, scene, NULL, 2);
    simulation_run(run, 1);
    return scene;
}

static void end(struct simulation *run, struct kiln_scene **scene)
{
    simulation_end(run);
    kiln_scene_destroy(scene);
}

/* Fails if counts differ from what is expected by more than chance explains: five deviations of the
 * chi-square distribution. */
static void expect_counts(const uint32_t *counts, const double *expected, uint32_t cells)
{
    double sum = 0;
    uint32_t freedom = 0;
    for (uint32_t i = 0; i < cells; i++) {
        if (expected[i] <= 0) {
            assert_int_equal(counts[i], 0);
            continue;
        }
        const double off = counts[i] - expected[i];
        sum += off * off / expected[i];
        freedom++;
    }
    print_message("chi-square %.1f of %u cells\n", sum, freedom);
    assert_true(fabs(sum - (freedom - 1)) < 5 * sqrt(2.0 * (freedom - 1)));
}

/* ---- the table ------------------------------------------------------------------------------- */

static void shares_of_the_table_are_the_weights(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static double weights[COUNT], shares[COUNT];
    static struct kiln_alias table[COUNT];
    double sum = 0;
    for (int i = 0; i < COUNT; i++) {
        weights[i] = i % 7 == 0 ? 0 : i % 11 == 0 ? 1e6 : 1e-3 * i;
        sum += weights[i];
    }
    assert_true(kiln_alias_fill(weights, COUNT, table));
    for (int i = 0; i < COUNT; i++) {
        shares[i] += (double)table[i].share / COUNT;
        shares[table[i].other] += (1 - (double)table[i].share) / COUNT;
    }
    for (int i = 0; i < COUNT; i++) {
        assert_true(fabs(shares[i] - weights[i] / sum) < 1e-9);
        assert_true(weights[i] > 0 || shares[i] == 0);
    }
}

static void parts_of_counts_are_products(void **state)
{
    (void)state;
    uint32_t bits = 12345, count = 1;
    for (int i = 0; i < 100000; i++) {
        bits = random_mix(bits);
        count = random_mix(count + 1);
        assert_int_equal(source_part(bits, count), (uint64_t)bits * count >> 32);
        assert_true(source_part(bits, count) < count || count == 0);
    }
}

/* ---- meshes ---------------------------------------------------------------------------------- */

enum { TRIANGLES = 200 };

/* Triangle i lies at z = i; its two short edges are 1 m and length_of(i) long. */
static double length_of(int i)
{
    return i % 50 == 0 ? 0 : 0.01 * (1 + i % 37);
}

static void write_triangles(const char *path)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    for (int i = 0; i < TRIANGLES; i++)
        fprintf(out, "v 0 0 %d\nv 1 0 %d\nv 0 %.9g %d\nf %d %d %d\n", i, i, length_of(i), i,
                3 * i + 1, 3 * i + 2, 3 * i + 3);
    assert_int_equal(fclose(out), 0);
}

static void births_are_uniform_by_area(void **state)
{
    (void)state;
    static uint32_t counts[TRIANGLES], parts[4];
    double expected[TRIANGLES], sum = 0;
    struct simulation run;
    write_triangles("many.obj");
    struct kiln_scene *scene = bear(&run, "from: {mesh: {file: many.obj}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    memset(counts, 0, sizeof counts);
    memset(parts, 0, sizeof parts);
    for (uint32_t i = 0; i < BIRTHS; i++) {
        const float3 at = particle_position(records[i]);
        const int triangle = (int)at.z;
        assert_true(at.z == (float)triangle && triangle >= 0 && triangle < TRIANGLES);
        const double s = (double)at.x, t = (double)at.y / length_of(triangle);
        assert_true(s >= 0 && t >= 0 && s + t <= 1 + 1e-6);
        counts[triangle]++;
        /* four triangles of one area: three at the corners, and the one between them */
        parts[s > 0.5 ? 0 : t > 0.5 ? 1 : s + t < 0.5 ? 2 : 3]++;
    }
    for (int i = 0; i < TRIANGLES; i++)
        sum += length_of(i);
    for (int i = 0; i < TRIANGLES; i++)
        expected[i] = BIRTHS * length_of(i) / sum;
    expect_counts(counts, expected, TRIANGLES);
    expect_counts(parts, (const double[]){BIRTHS / 4.0, BIRTHS / 4.0, BIRTHS / 4.0, BIRTHS / 4.0},
                  4);
    end(&run, &scene);
}

static void vertices_are_as_likely(void **state)
{
    (void)state;
    static uint32_t counts[3 * TRIANGLES];
    static double expected[3 * TRIANGLES];
    struct simulation run;
    write_triangles("many.obj");
    struct kiln_scene *scene =
        bear(&run, "from: {mesh: {file: many.obj, on: vertices}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < BIRTHS; i++) {
        const float3 at = particle_position(records[i]);
        counts[3 * (int)at.z + (at.x > 0 ? 1 : at.y > 0 ? 2 : 0)]++;
    }
    for (int i = 0; i < TRIANGLES; i++) {
        /* A triangle without an area has two vertices at one place, or one. */
        const bool flat = length_of(i) <= 0;
        for (int k = 0; k < 3; k++) {
            expected[3 * i + k] = flat ? 0 : 1;
            counts[3 * i + k] = flat ? 0 : counts[3 * i + k];
        }
    }
    double sum = 0, births = 0;
    for (int i = 0; i < 3 * TRIANGLES; i++) {
        sum += expected[i];
        births += counts[i];
    }
    for (int i = 0; i < 3 * TRIANGLES; i++)
        expected[i] *= births / sum;
    expect_counts(counts, expected, 3 * TRIANGLES);
    end(&run, &scene);
}

/* A mesh of a file is placed as an object is: scaled, then turned about x, y and z. */
static void meshes_of_files_are_placed(void **state)
{
    (void)state;
    struct simulation run;
    write_triangles("many.obj");
    struct kiln_scene *scene =
        bear(&run,
             "from: {mesh: {file: many.obj, scale: 2, rotation: [90 deg, 0, 90 deg],"
             " origin: [0, 10, 0]}}",
             20000, "");
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < 20000; i++) {
        const float3 at = particle_position(records[i]);
        /* (x, y, z) of the file is at (x, -z, y) about x, and then at (z, x, y) about z */
        const double x = ((double)at.y - 10) / 2, y = (double)at.z / 2, z = (double)at.x / 2;
        const int triangle = (int)lrint(z);
        assert_true(fabs(z - triangle) < 1e-4 && triangle >= 0 && triangle < TRIANGLES);
        assert_true(x > -1e-5 && y > -1e-5 && y <= (1 - x) * length_of(triangle) + 1e-5);
    }
    end(&run, &scene);
}

/* Births in a tetrahedron are uniform: half of the edges hold an eighth of the volume. */
static void births_fill_volumes(void **state)
{
    (void)state;
    uint32_t counts[4] = {0}, outside = 0;
    struct simulation run;
    test_write_file("ball.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    struct kiln_scene *scene =
        bear(&run, "from: {mesh: {file: ball.obj, on: volume, scale: 2}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < BIRTHS; i++) {
        const float3 at = particle_position(records[i]);
        const double x = (double)at.x / 2, y = (double)at.y / 2, z = (double)at.z / 2;
        /* squares of 1 / 256, of which a place is at most half an edge off in x and in z */
        assert_true(x > -1e-6 && y > -1e-6 && z > -1e-6 && x + y + z < 1 + 1.0 / 256 + 1e-5);
        outside += x + y + z > 1;
        counts[x + y + z < 0.5 ? 0 : y > 0.5 ? 1 : x > 0.5 ? 2 : 3]++;
    }
    expect_counts(counts, (const double[]){BIRTHS / 8.0, BIRTHS / 8.0, BIRTHS / 8.0, BIRTHS / 1.6},
                  4);
    assert_true(outside < BIRTHS / 100);
    end(&run, &scene);
}

/* Particles start along the normal of the side that is outside. */
static void they_start_along_the_surface(void **state)
{
    (void)state;
    const char *file = "from: {mesh: {file: ball.obj, angle: 0 deg}}, inherit: 0";
    test_write_file("ball.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    char text[512];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 9, fps: 60}\n"
             "systems: {a: {emit: {bursts: {0 s: 4000}, life: 9 s, speed: 3, %s}}}\n",
             file);
    struct kiln_scene *scene = load_scene(text, NULL);
    struct simulation run;
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 1);
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < 4000; i++) {
        const float3 at = particle_position(records[i]), moves = particle_velocity(records[i]);
        const float3 born = float3_add_scaled(at, moves, -1.0f / 60.0f);
        const float corner = 1.73205081f;
        const bool slope = moves.x > 0;
        const float towards =
            slope ? (moves.x + moves.y + moves.z) / corner : -(moves.x + moves.y + moves.z);
        const float off =
            slope ? born.x + born.y + born.z - 1 : fminf(born.x, fminf(born.y, born.z));
        assert_true(fabsf(towards - 3.0f) < 1e-4f);
        assert_true(fabsf(off) < 1e-5f);
    }
    end(&run, &scene);
}

/* ---- paths, lines and rings ------------------------------------------------------------------ */

#define CIRCLE                                                                                     \
    "points: [[1, 0, 0], [0.70710678, 0, 0.70710678], [0, 0, 1], [-0.70710678, 0, 0.70710678],\n"  \
    "         [-1, 0, 0], [-0.70710678, 0, -0.70710678], [0, 0, -1], [0.70710678, 0, "             \
    "-0.70710678]], closed: true"

static double turn_of(float3 at)
{
    const double turn = atan2((double)at.z, (double)at.x) / 6.283185307179586;
    return turn < -1e-7 ? turn + 1 : fmax(turn, 0);
}

static void paths_are_uniform_by_length(void **state)
{
    (void)state;
    enum { PARTS = 64 };
    static uint32_t counts[PARTS];
    double expected[PARTS];
    struct simulation run;
    struct kiln_scene *scene = bear(&run, "from: {path: {" CIRCLE "}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < BIRTHS; i++) {
        const float3 at = particle_position(records[i]);
        const double radius = hypot((double)at.x, (double)at.z);
        assert_true(at.y == 0 && radius < 1 + 1e-6 && radius > 0.99);
        counts[(int)(turn_of(at) * 8) % 8]++;
    }
    for (int i = 0; i < 8; i++)
        expected[i] = BIRTHS / 8.0;
    expect_counts(counts, expected, 8);
    end(&run, &scene);
}

/* The births of a burst are at equal distances, in their order. */
static void bursts_are_in_order(void **state)
{
    (void)state;
    static const char *const from[] = {
        "from: {line: {span: [3, 0, 0], origin: [1.5, 0, 0], ordered: true}}",
        "from: {path: {points: [[0, 0, 0], [1, 0, 0], [3, 0, 0]], ordered: true}}",
        "from: {ring: {radius: 1, ordered: true}}",
        "from: {path: {" CIRCLE ", ordered: true}}",
    };
    for (int k = 0; k < 4; k++) {
        struct simulation run;
        struct kiln_scene *scene = bear(&run, from[k], 31, "");
        const struct kiln_particle *records = simulation_records(&run);
        const float3 first = particle_position(records[0]);
        for (uint32_t i = 0; i < 31; i++) {
            const float3 at = particle_position(records[i]);
            assert_int_equal(records[i].position_serial.w, i);
            if (k < 2) {
                assert_true(fabs((double)at.x - 3.0 * i / 30) < 2e-5);
            } else {
                const double cosine = cos(6.283185307179586 * i / 31);
                const double along = (double)(first.x * at.x + first.z * at.z);
                assert_true(fabs(along - cosine) < 0.02);
            }
        }
        end(&run, &scene);
    }
}

/* Births by the rate stay at random, and two bursts of a step are each in order. */
static void each_burst_has_its_order(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\noutput: {frames: 60, fps: 60}\n"
        "systems: {a: {emit: {rate: 600, bursts: [{at: 1 ms, count: 3}, {at: 2 ms, count: 5}],\n"
        "  life: 9 s, speed: 0, from: {line: {span: [3, 0, 0], ordered: true}}}}}\n";
    struct simulation run;
    struct kiln_scene *scene = load_scene(text, NULL);
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 1);
    const struct kiln_particle *records = simulation_records(&run);
    uint32_t in_order = 0;
    for (uint32_t i = 0; i < 18; i++) {
        const double at = (double)particle_position(records[i]).x + 1.5;
        if (i >= 10)
            assert_true(fabs(at - (i < 13 ? 1.5 * (i - 10) : 0.75 * (i - 13))) < 1e-6);
        in_order += i < 10 && fabs(at - 3.0 * i / 9) < 0.01;
    }
    assert_true(in_order < 3);
    end(&run, &scene);
}

/* ---- images ---------------------------------------------------------------------------------- */

static void births_are_on_pixels(void **state)
{
    (void)state;
    static uint32_t counts[32];
    double expected[32], sum = 0;
    struct simulation run;
    assert_int_equal(chdir(KILN_SOURCE_DIR "/tests/sources"), 0);
    struct kiln_scene *scene =
        bear(&run, "from: {image: {file: mark.png, width: 4 m, origin: [0, 0, 7]}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    memset(counts, 0, sizeof counts);
    for (uint32_t i = 0; i < BIRTHS; i++) {
        const float3 at = particle_position(records[i]);
        const int x = (int)floor(((double)at.x + 2) * 2), y = (int)floor((1 - (double)at.y) * 2);
        assert_true(at.z == 7 && x >= 0 && x < 8 && y >= 0 && y < 4);
        counts[8 * y + x]++;
    }
    for (int i = 0; i < 32; i++) { /* mark.png has the alpha i / 31 at pixel i */
        expected[i] = i >= 16 ? round(255.0 * i / 31) : 0;
        sum += expected[i];
    }
    for (int i = 0; i < 32; i++)
        expected[i] *= BIRTHS / sum;
    expect_counts(counts, expected, 32);
    end(&run, &scene);
}

/* An opaque image counts by its brightness. */
static void opaque_images_count_by_brightness(void **state)
{
    (void)state;
    uint32_t counts[4] = {0};
    double expected[4] = {0, 64, 192, 255};
    struct simulation run;
    assert_int_equal(chdir(KILN_SOURCE_DIR "/tests/sources"), 0);
    struct kiln_scene *scene =
        bear(&run, "from: {image: {file: steps.png, width: 4 m, threshold: 0.1}}", BIRTHS, "");
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < BIRTHS; i++)
        counts[(int)floorf(particle_position(records[i]).x + 2)]++;
    for (int i = 0; i < 4; i++)
        expected[i] *= BIRTHS / 511.0;
    expect_counts(counts, expected, 4);
    end(&run, &scene);
}

/* ---- colours --------------------------------------------------------------------------------- */

static double light_of(double number)
{
    const double x = number / 255;
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static void expect_color(float3 color, const double rgb[3])
{
    const float found[3] = {color.x, color.y, color.z};
    for (int c = 0; c < 3; c++)
        assert_true(fabs(sqrt((double)found[c]) - sqrt(rgb[c])) < 1e-3);
}

static struct kiln_scene *bear_colored(struct simulation *run, const char *from)
{
    char text[1024];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {frames: 60, fps: 60}\n"
             "systems: {a: {emit: {bursts: {0 s: 20000}, life: 9 s, speed: 0, from: {%s}},\n"
             "              look: {color: source}}}\n",
             from);
    assert_int_equal(chdir(KILN_SOURCE_DIR "/tests/sources"), 0);
    struct kiln_scene *scene = load_scene(text, NULL);
    simulation_start(run, scene, NULL, 1);
    simulation_run(run, 1);
    return scene;
}

static float3 color_of(const struct kiln_scene *scene, struct kiln_particle particle)
{
    return kiln_source_color(scene->systems[0].emit.source.made,
                             particle_stream(kiln_scene_derived(scene, 0), particle));
}

static void particles_have_the_colors_of_pixels(void **state)
{
    (void)state;
    struct simulation run;
    struct kiln_scene *scene = bear_colored(&run, "image: {file: mark.png, width: 8 m}");
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < 20000; i++) {
        const float3 at = particle_position(records[i]);
        const int x = (int)floorf(at.x + 4), y = (int)floorf(2 - at.y);
        const double rgb[3] = {light_of(32.0 * x), light_of(255 - 60.0 * y), light_of(128)};
        expect_color(color_of(scene, records[i]), rgb);
    }
    end(&run, &scene);
}

/* Returns how far a place is from a texel of quilt.png, in texels. */
static double off_texel(double x, double y, int column, int row)
{
    const double off_x = fmax(column - x, x - (column + 1));
    const double off_y = fmax(row - y, y - (row + 1));
    return fmax(fmax(off_x, off_y), 0);
}

static void particles_have_the_colors_of_textures(void **state)
{
    (void)state;
    struct simulation run;
    uint32_t exact = 0, behind = 0;
    struct kiln_scene *scene = bear_colored(&run, "mesh: {file: quilt.obj}");
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < 20000; i++) {
        const float3 at = particle_position(records[i]);
        const float3 color = color_of(scene, records[i]);
        const double plain[3] = {light_of(63.75), light_of(127.5), 1}; /* 0.25, 0.5, 1 */
        if (at.z < -0.5f) {
            expect_color(color, plain);
            behind++;
            continue;
        }
        double nearest = 9;
        for (int k = 0; k < 16; k++) {
            const int column = k % 4, row = k / 4;
            if (fabs((double)color.x - light_of(80 * column)) < 2e-3 &&
                fabs((double)color.y - light_of(80 * row)) < 2e-3)
                nearest = off_texel(4 * (double)at.x, 4 - 4 * (double)at.y, column, row);
        }
        assert_true(nearest < 0.6);
        exact += nearest <= 0;
    }
    print_message("%u of %u in their texel\n", exact, 20000 - behind);
    assert_true(behind > 6000 && exact > (20000 - behind) / 10 * 7);
    end(&run, &scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_of_the_table_are_the_weights),
        cmocka_unit_test(parts_of_counts_are_products),
        cmocka_unit_test_setup_teardown(births_are_uniform_by_area, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(vertices_are_as_likely, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(meshes_of_files_are_placed, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(births_fill_volumes, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(they_start_along_the_surface, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test(paths_are_uniform_by_length),
        cmocka_unit_test(bursts_are_in_order),
        cmocka_unit_test(each_burst_has_its_order),
        cmocka_unit_test(births_are_on_pixels),
        cmocka_unit_test(opaque_images_count_by_brightness),
        cmocka_unit_test(particles_have_the_colors_of_pixels),
        cmocka_unit_test(particles_have_the_colors_of_textures),
    };
    return cmocka_run_group_tests_name("sources", tests, NULL, NULL);
}
