/* Checks that all techniques of stage `raster` draw the same picture of extreme crowds of sprites:
 * sprites larger than the picture or around the camera, thousands in one place, or more than a
 * technique draws in one batch. If this fails, a technique loses sprites, draws them twice, or
 * draws them in the wrong order. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"
#include "support/parts.h"

enum { WIDTH = 600, HEIGHT = 400, VALUES = WIDTH * HEIGHT * 4, STEP = 30, MOST = 1100000 };

/* The camera looks along -z. System b is disabled and draws nothing; particles are placed in system
 * a. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [600, 400], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0, 0, 10], target: [0, 0, 0], fov: 60 deg, near: 0.1}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1, life: 10 s}\n"
    "    look: {fade: {in: 0, out: 0}, near_fade: 0.2 m, bloom: [1, 0.5, 0.2],\n"
    "           rotation: [0 deg, 360 deg]}\n"
    "  b: {enabled: false, emit: {rate: 1}, look: {shape: point}}\n";

static const struct {
    enum kiln_raster_technique technique;
    const char *name;
} TECHNIQUES[] = {
    {KILN_RASTER_GEOMETRY, "geometry"}, /* the reference of the other techniques */
    {KILN_RASTER_INSTANCED, "instanced"},
    {KILN_RASTER_TILED, "tiled"},
    {KILN_RASTER_CPU, "cpu"},
};
enum { TECHNIQUE_COUNT = sizeof TECHNIQUES / sizeof *TECHNIQUES, CPU = TECHNIQUE_COUNT - 1 };

/* Particles in front of a wall, listed from the farthest to the nearest. */
struct crowd {
    const char *overrides[8];
    size_t override_count;
    uint32_t count;
    struct kiln_particle *particles;
    float wall_m; /* view depth of the wall, m */
};

static float random_within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

/* Fills a crowd with particles at random places in a box about the z axis. Their z goes evenly from
 * z_from to z_to, m. half: half of the box's width (x) and height (y), m; its z is not used. */
static void scatter(struct crowd *crowd, uint32_t count, float3 half, float z_from, float z_to)
{
    srand(7);
    crowd->count = count;
    crowd->particles = calloc(count ? count : 1, sizeof *crowd->particles);
    assert_non_null(crowd->particles);
    for (uint32_t i = 0; i < count; i++) {
        float3 position = {random_within(-half.x, half.x), random_within(-half.y, half.y),
                           z_from + (z_to - z_from) * (float)i / (float)count};
        float3 velocity = {random_within(-3, 3), random_within(-3, 3), random_within(-3, 3)};
        crowd->particles[i] = drawing_particle(i, position, velocity);
    }
}

/* Draws a crowd with TECHNIQUES[technique]. Returns VALUES values of the colour image, then VALUES
 * of the image that feeds the bloom; the caller frees them. */
static float *render(struct kiln_device *device, const struct crowd *crowd, size_t technique)
{
    drawing_technique = TECHNIQUES[technique].technique;
    drawing_most = crowd->count ? crowd->count : 1;
    struct drawing d;
    drawing_init(&d, device, SCENE, crowd->overrides, crowd->override_count);
    drawing_place(&d, crowd->particles, crowd->count, STEP);
    drawing_run(&d, crowd->count, crowd->wall_m);
    float *values = malloc(2 * VALUES * sizeof *values);
    assert_non_null(values);
    memcpy(values, d.color.host, VALUES * sizeof *values);
    memcpy(values + VALUES, d.bloom.host, VALUES * sizeof *values);
    drawing_finish(&d);
    return values;
}

/* Fails unless two pictures agree within the limits of docs/determinism.md: the mean relative error
 * is at most 1e-3, and at most one value in a thousand is off by more than 1 % of (value + 0.1).
 * The 0.1 allows for drivers that filter textures with 8-bit weights. */
static void compare(const float *expected, const float *found, const char *name)
{
    double error_sum = 0, light_sum = 1e-9;
    size_t off = 0;
    for (size_t i = 0; i < 2 * VALUES; i++) {
        assert_true(isfinite(found[i]));
        double delta = fabs((double)found[i] - (double)expected[i]);
        double light = fabs((double)expected[i]);
        error_sum += delta;
        light_sum += light;
        off += delta > 1e-2 * (light + 0.1);
    }
    print_message("%-10s %.2g %.2g\n", name, error_sum / light_sum, (double)off / (2 * VALUES));
    assert_true(error_sum <= 1e-3 * light_sum);
    assert_true(off <= 2 * VALUES / 1000);
}

/* Fails unless all techniques draw the same picture of a crowd. Frees the crowd's particles.
 * Returns which part of the picture, 0 to 1, is covered. */
static double check(struct kiln_device *device, struct crowd *crowd)
{
    float *expected = render(device, crowd, 0);
    double covered = 0;
    for (size_t i = 0; i < VALUES; i += 4)
        covered += expected[i] > 0.0f ? 4.0 / VALUES : 0.0;
    for (size_t i = 1; i < TECHNIQUE_COUNT; i++) {
        float *found = render(device, crowd, i);
        compare(expected, found, TECHNIQUES[i].name);
        free(found);
    }
    free(expected);
    free(crowd->particles);
    return covered;
}

static void no_particles_leave_a_clear_picture(void **state)
{
    struct crowd crowd = {.wall_m = 20};
    scatter(&crowd, 0, (float3){1, 1, 1}, 0, 1);
    assert_true(check(*state, &crowd) == 0);
}

static void sprites_larger_than_the_picture(void **state)
{
    static const char *const facings[] = {"screen", "viewplane", "viewpoint", "axial", "velocity"};
    for (size_t i = 0; i < 5; i += test_is_full() ? 1 : 2) {
        char facing[64];
        snprintf(facing, sizeof facing, "systems.a.look.facing=%s", facings[i]);
        struct crowd crowd = {.overrides = {facing, "systems.a.look.size={life: [9 m, 60 m]}",
                                            "systems.a.look.opacity=0.2",
                                            "systems.a.look.axis=[1, 3, 0.5]"},
                              .override_count = 4,
                              .wall_m = 14};
        scatter(&crowd, 24, (float3){4, 4, 0}, -2, 9.8f);
        assert_true(check(*state, &crowd) > 0.9);
    }
}

/* Sprites behind the eye, at z = 10, or nearer to it than the near plane, 0.1 m, are not drawn by
 * any technique. Nearly all sprites of the first crowd lie there. All sprites of the second crowd
 * do, so its picture stays clear. */
static void sprites_about_the_eye(void **state)
{
    struct crowd crowd = {.overrides = {"systems.a.look.size=0.3 m", "systems.a.look.opacity=0.5",
                                        "systems.a.look.facing=viewpoint"},
                          .override_count = 3,
                          .wall_m = 20};
    scatter(&crowd, 400, (float3){0.4f, 0.4f, 0}, 9.7f, 13);
    assert_true(check(*state, &crowd) > 0.3);
    struct crowd unseen = {.wall_m = 20};
    scatter(&unseen, 400, (float3){1, 1, 0}, 9.95f, 13);
    assert_true(check(*state, &unseen) == 0);
}

static void thousands_in_one_place(void **state)
{
    struct crowd crowd = {.overrides = {"systems.a.look.size=0.2 m", "systems.a.look.opacity=0.02"},
                          .override_count = 2,
                          .wall_m = 9};
    scatter(&crowd, 20000, (float3){0.02f, 0.02f, 0}, -2, 2);
    double covered = check(*state, &crowd);
    assert_true(covered > 0 && covered < 0.01);
}

/* No sprite is lost if a pixel has more sprites than an invocation may run loop iterations on
 * llvmpipe (KILN_SOFTWARE_ITERATIONS). The sprites are so faint that none hides another, so each of
 * them must be drawn. */
static void tens_of_thousands_in_one_place(void **state)
{
    struct crowd crowd = {
        .overrides = {"systems.a.look.size=0.2 m", "systems.a.look.opacity=0.00005"},
        .override_count = 2,
        .wall_m = 20};
    scatter(&crowd, 70000, (float3){0.02f, 0.02f, 0}, -2, 2);
    double covered = check(*state, &crowd);
    assert_true(covered > 0 && covered < 0.01);
}

/* Techniques may skip opaque sprites that nearer ones hide, but must not skip additive sprites of
 * the same size, which hide nothing. */
static void opaque_sprites_in_one_place(void **state)
{
    struct crowd crowd = {.overrides = {"systems.a.look.size=2 m", "systems.a.look.soft=0"},
                          .override_count = 2,
                          .wall_m = 20};
    scatter(&crowd, 2000, (float3){0.5f, 0.5f, 0}, -2, 2);
    assert_true(check(*state, &crowd) > 0.02);
    struct crowd fire = {.overrides = {"systems.a.look.size=2 m", "systems.a.look.soft=0",
                                       "systems.a.look.blend=add", "systems.a.look.opacity=0.5"},
                         .override_count = 4,
                         .wall_m = 20};
    scatter(&fire, 2000, (float3){0.5f, 0.5f, 0}, -2, 2);
    assert_true(check(*state, &fire) > 0.02);
}

/* The picture is right if there are more sprites than the techniques `tiled` and `cpu` draw in one
 * batch. The sprites are so faint that rounding which adds or loses one sprite at a pixel does not
 * show. */
static void more_than_are_drawn_at_a_time(void **state)
{
    struct crowd crowd = {
        .overrides = {"systems.a.look.size=0.08 m", "systems.a.look.opacity=0.002"},
        .override_count = 2,
        .wall_m = 11};
    scatter(&crowd, MOST, (float3){6, 4, 0}, -2, 2);
    assert_true(check(*state, &crowd) > 0.5);
}

/* Thin lines are drawn right, although their bounding boxes touch many tiles that the lines
 * themselves do not touch. */
static void boxes_that_are_mostly_empty(void **state)
{
    struct crowd crowd = {.overrides = {"systems.a.look.shape=line", "systems.a.look.stretch=10 s",
                                        "systems.a.look.line.width=2 px",
                                        "systems.a.look.opacity=0.1"},
                          .override_count = 4,
                          .wall_m = 40};
    scatter(&crowd, 6000, (float3){9, 6, 0}, -9, 5);
    assert_true(check(*state, &crowd) > 0.9);
}

/* raster=cpu draws so many large sprites in several parts, since the lists of sprites of all tiles
 * would take too much memory, and the parts must be combined in the right order. The nearest
 * sprites are opaque, so the picture must be that of the nearest alone. */
static void lists_that_are_split(void **state)
{
    enum { COUNT = 70000, NEAREST = 200 };
    struct crowd crowd = {.overrides = {"systems.a.look.size=60 m", "systems.a.look.soft=0"},
                          .override_count = 2,
                          .wall_m = 40};
    scatter(&crowd, COUNT, (float3){1, 1, 0}, -9, 5);
    struct crowd nearest = crowd;
    nearest.count = NEAREST;
    nearest.particles += COUNT - NEAREST;
    float *expected = render(*state, &nearest, CPU), *found = render(*state, &crowd, CPU);
    compare(expected, found, "cpu");
    free(expected);
    free(found);
    free(crowd.particles);
}

/* Does what `render` does, with work groups of `size` invocations; 0 takes the usual size.
 * software: true to draw as on software GL, false to draw as on a GPU. */
static float *render_in_groups(struct kiln_device *device, const struct crowd *crowd,
                               size_t technique, uint32_t size, bool software)
{
    const bool is_software = device->info.software;
    device->info.software = software;
    device->work_group_size = size;
    float *values = render(device, crowd, technique);
    device->info.software = is_software;
    device->work_group_size = 0;
    return values;
}

/* The size of a work group, whose invocations share a tile, changes no bit of the picture. */
static void tiles_are_the_same_by_any_work_group(void **state)
{
    static const uint32_t sizes[] = {1, 48, 1024};
    enum { TILED = 2 };
    struct crowd crowd = {
        .overrides = {"systems.a.look.size={life: [0.1 m, 6 m]}", "systems.a.look.opacity=0.3"},
        .override_count = 2,
        .wall_m = 11};
    scatter(&crowd, 3000, (float3){6, 4, 0}, -2, 9.5f);
    assert_int_equal(TECHNIQUES[TILED].technique, KILN_RASTER_TILED);
    for (int software = 0; software < 2; software++) {
        float *expected = render_in_groups(*state, &crowd, TILED, 0, software);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            float *found = render_in_groups(*state, &crowd, TILED, sizes[i], software);
            assert_memory_equal(expected, found, 2 * VALUES * sizeof *found);
            free(found);
        }
        free(expected);
    }
    free(crowd.particles);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest full[] = {
        test_on_device(more_than_are_drawn_at_a_time),
        test_on_device(tiles_are_the_same_by_any_work_group),
    };
    static const struct CMUnitTest tests[] = {
        test_on_device(no_particles_leave_a_clear_picture),
        test_on_device(sprites_larger_than_the_picture),
        test_on_device(sprites_about_the_eye),
        test_on_device(thousands_in_one_place),
        test_on_device(tens_of_thousands_in_one_place),
        test_on_device(opaque_sprites_in_one_place),
        test_on_device(boxes_that_are_mostly_empty),
        test_on_device(lists_that_are_split),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    test_list_add_full(&list, full, sizeof full / sizeof *full);
    return test_list_run(&list, "crowds", argc, argv, test_device_open, test_device_close);
}
