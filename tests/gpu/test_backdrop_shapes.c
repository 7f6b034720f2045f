/* Checks the backdrop's spheres, cylinders and meshes, with their shadows, against a ray caster in
 * double precision, and its floors and skies made of images, each drawn by GL and by the CPU. If
 * this fails, shapes and shadows have the wrong place, size or brightness, images are mirrored or
 * rotated, or floors alias. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "asset/image/texture.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/folders.h"
#include "support/pictures.h"
#include "support/ray_caster.h"

/* ---- shapes and their shadows ---------------------------------------------------------------- */

#define ROUND_OBJECTS                                                                              \
    "  objects:\n"                                                                                 \
    "    - box: {center: [-1.3, 0.4, 0.4], size: [0.5, 0.8, 0.5], color: 0.9}\n"                   \
    "    - sphere: {center: [0.2, 0.7, 0.3], radius: 0.5 m, color: 0.8}\n"                         \
    "    - cylinder: {center: [1.5, 0.6, 0], axis: [0, 2, 0], radius: 0.3 m, height: 1.2 m, "      \
    "color: 0.7}\n"                                                                                \
    "    - cylinder: {center: [-0.6, 0.5, -0.8], axis: [1, 0.4, 0.2], radius: 0.2 m, "             \
    "height: 1.4 m, color: 0.6}\n"

static int round_shapes(struct shape shapes[8])
{
    const struct vec grey = {{0.9, 0.9, 0.9}};
    const struct shape list[] = {
        {.kind = FLOOR, .albedo = {{0.6, 0.5, 0.4}}},
        {.kind = BOX,
         .center = {{-1.3, 0.4, 0.4}},
         .half_size = {{0.25, 0.4, 0.25}},
         .albedo = grey},
        {.kind = SPHERE, .center = {{0.2, 0.7, 0.3}}, .radius = 0.5, .albedo = {{0.8}}},
        {.kind = CYLINDER,
         .center = {{1.5, 0.6, 0}},
         .axis = {{0, 1, 0}},
         .radius = 0.3,
         .half_height = 0.6,
         .albedo = {{0.7}}},
        {.kind = CYLINDER,
         .center = {{-0.6, 0.5, -0.8}},
         .axis = unit((struct vec){{1, 0.4, 0.2}}),
         .radius = 0.2,
         .half_height = 0.7,
         .albedo = {{0.6}}},
    };
    memcpy(shapes, list, sizeof list);
    return sizeof list / sizeof *list;
}

static void round_shapes_match_c(void **state)
{
    struct shape shapes[8];
    struct expected e = {.shapes = shapes,
                         .count = round_shapes(shapes),
                         .sun = unit((struct vec){{-0.6, 1, 0.5}}),
                         .tolerance = 0.03};
    struct picture p =
        draw(*state, HEAD "  sun: {direction: [-0.6, 1, 0.5], color: 3.14159265}\n" ROUND_OBJECTS);
    compare(&p, &e, 1);
    finish(&p);
}

static void soft_shadows_match_c(void **state)
{
    struct shape shapes[8];
    struct expected e = {.shapes = shapes,
                         .count = round_shapes(shapes),
                         .sun = unit((struct vec){{-0.6, 1, 0.5}}),
                         .sun_radius = 10 * acos(-1.0) / 180,
                         .tolerance = 0.09};
    struct picture p =
        draw(*state, HEAD
             "  sun: {direction: [-0.6, 1, 0.5], color: 3.14159265, size: 20 deg}\n" ROUND_OBJECTS);
    compare(&p, &e, 3);
    finish(&p);
}

/* Compares the picture of `text`, a scene with MESH_OBJECTS, with the ray caster: the depth and
 * shading of the mesh, and its shadows on itself, the floor and the box. sun_radius: angle of the
 * sun's disc, rad; tolerance: the largest allowed absolute difference of red light; step: only
 * every step-th pixel of every step-th row is compared. */
static void check_mesh(void *device, const char *text, double sun_radius, double tolerance,
                       int step)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load(NULL, KILN_SOURCE_DIR "/scenes/meshes/pot.obj", &error);
    if (!mesh)
        fail_msg("%s", error.message);
    const struct shape shapes[] = {
        {.kind = FLOOR, .albedo = {{0.6, 0.5, 0.4}}},
        {.kind = BOX,
         .center = {{1.2, 0.5, -0.5}},
         .half_size = {{0.3, 0.5, 0.3}},
         .albedo = {{0.9}}},
        {.kind = MESH,
         .center = {{-0.2, 0.2, 0.1}},
         .mesh = mesh,
         .angle = 30 * acos(-1.0) / 180,
         .scale = 6,
         .albedo = {{0.8}}},
    };
    struct expected e = {.shapes = shapes,
                         .count = 3,
                         .sun = unit((struct vec){{-0.7, 0.8, 0.6}}),
                         .sun_radius = sun_radius,
                         .tolerance = tolerance};
    struct picture p = draw(device, text);
    compare(&p, &e, step);
    finish(&p);
    kiln_mesh_destroy(&mesh);
}

#define MESH_OBJECTS                                                                               \
    "  objects:\n"                                                                                 \
    "    - box: {center: [1.2, 0.5, -0.5], size: [0.6, 1, 0.6], color: 0.9}\n"                     \
    "    - mesh: {file: meshes/pot.obj, position: [-0.2, 0.2, 0.1], "                              \
    "rotation: [0 deg, 30 deg, 0 deg], scale: 6, color: 0.8}\n"

static void meshes_match_c(void **state)
{
    check_mesh(*state,
               HEAD "  sun: {direction: [-0.7, 0.8, 0.6], color: 3.14159265}\n" MESH_OBJECTS, 0,
               0.08, 3);
}

/* Returns the mean of a colour channel over the rectangle of pixels from (x0, y0), inclusive, to
 * (x1, y1), exclusive. */
static double mean_of(const struct picture *p, int x0, int y0, int x1, int y1, int channel)
{
    double sum = 0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++)
            sum += (double)p->colors[4 * (y * WIDTH + x) + channel];
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/* A sun whose disc has a diameter of 10 degrees gives a mesh's shadow a penumbra: compared with a
 * sun without a disc, 1 to 20 % of the pixels change, and the picture's mean light changes by less
 * than 2 %. */
static void mesh_shadows_soften(void **state)
{
    struct picture hard =
        draw(*state, HEAD "  sun: {direction: [-0.7, 0.8, 0.6], color: 3.14159265}\n" MESH_OBJECTS);
    struct picture soft = draw(
        *state, HEAD
        "  sun: {direction: [-0.7, 0.8, 0.6], color: 3.14159265, size: 10 deg}\n" MESH_OBJECTS);
    int changed = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        changed += fabsf(hard.colors[4 * i] - soft.colors[4 * i]) > 0.03f;
    assert_true(changed > WIDTH * HEIGHT / 100 && changed < WIDTH * HEIGHT / 5);
    double before = mean_of(&hard, 0, 0, WIDTH, HEIGHT, 0);
    double after = mean_of(&soft, 0, 0, WIDTH, HEIGHT, 0);
    assert_true(fabs(after - before) < 0.02 * before);
    finish(&hard);
    finish(&soft);
}

/* ---- images as floor and sky ----------------------------------------------------------------- */

#define PICTURE "kiln: 1\noutput: {size: [128, 72], frames: 1}\n"
#define DOWN    "camera: {position: [0, 2.5, 5], target: [0, 0.5, 0], fov: 40 deg}\nbackdrop:\n"
#define LEVEL   "camera: {position: [0, 2.5, 5], target: [0, 2.5, 0], fov: 40 deg}\nbackdrop:\n"

enum { SKY_WIDTH = 64, SKY_HEIGHT = 32 };

/* Writes a BMP file with four quarters of one colour each: from left to right, red and green above,
 * blue and white below. */
static void write_quarters(const char *path)
{
    enum { ROW = SKY_WIDTH * 3, SIZE = 54 + ROW * SKY_HEIGHT };
    static unsigned char file[SIZE];
    static const unsigned char quarters[4][3] = {
        {0, 0, 255}, {0, 255, 0}, {255, 0, 0}, {255, 255, 255}}; /* in the order blue, green, red */
    memset(file, 0, sizeof file);
    file[0] = 'B';
    file[1] = 'M';
    file[2] = SIZE & 255;
    file[3] = SIZE >> 8;
    file[10] = 54; /* offset of the pixels, bytes */
    file[14] = 40; /* size of the second header, bytes */
    file[18] = SKY_WIDTH;
    file[22] = SKY_HEIGHT;
    file[26] = 1;
    file[28] = 24;
    for (int y = 0; y < SKY_HEIGHT; y++) { /* rows from the bottom */
        for (int x = 0; x < SKY_WIDTH; x++) {
            int quarter = (y < SKY_HEIGHT / 2 ? 2 : 0) + (x < SKY_WIDTH / 2 ? 0 : 1);
            memcpy(file + 54 + y * ROW + x * 3, quarters[quarter], 3);
        }
    }
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(file, sizeof file, 1, out), 1);
    assert_int_equal(fclose(out), 0);
}

static struct picture draw_in(void *device, const char *folder, const char *backdrop)
{
    char text[1024];
    snprintf(text, sizeof text, "%s%s", PICTURE, backdrop);
    return draw_below(device, text, folder);
}

static void assert_color(const float *pixel, double red, double green, double blue)
{
    const double expected[3] = {red, green, blue};
    for (int c = 0; c < 3; c++) {
        if (fabs((double)pixel[c] - expected[c]) > 0.02)
            fail_msg("channel %d is %g, expected %g", c, (double)pixel[c], expected[c]);
    }
}

/* A viewer who looks along -z sees the middle of the sky's image ahead, and its left half on the
 * left. The key `rotation` turns the image about the vertical axis, and `intensity` multiplies its
 * light. */
static void skies_lie_where_they_should(void **state)
{
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/sky.bmp", folder);
    write_quarters(path);
    struct picture p = draw_in(*state, folder, LEVEL "  floor: none\n  sky: {image: sky.bmp}\n");
    assert_color(p.colors + 4 * (1 * WIDTH + 2), 1, 0, 0);
    assert_color(p.colors + 4 * (1 * WIDTH + WIDTH - 3), 0, 1, 0);
    assert_color(p.colors + 4 * ((HEIGHT - 2) * WIDTH + 2), 0, 0, 1);
    assert_color(p.colors + 4 * ((HEIGHT - 2) * WIDTH + WIDTH - 3), 1, 1, 1);
    finish(&p);
    p = draw_in(*state, folder,
                LEVEL "  floor: none\n  sky: {image: sky.bmp, rotation: 90 deg, intensity: 0.5}\n");
    /* Turned by 90 degrees, the upper left corner shows green at half intensity, not red. */
    assert_color(p.colors + 4 * (1 * WIDTH + 2), 0, 0.5, 0);
    finish(&p);

    /* The image's upper half, red and green, alone lights a surface that faces up. The light of the
     * band at the horizon also has blue from the lower half. */
    struct kiln_error error = {0};
    struct kiln_sky_light light;
    assert_true(kiln_sky_light_measure(&light, NULL, path, &error));
    assert_true(fabsf(light.up[0] - 0.5f) < 1e-3f && fabsf(light.up[1] - 0.5f) < 1e-3f);
    assert_true(light.up[2] == 0.0f && light.horizon[2] > 0.05f);
    test_remove_folder(folder);
}

/* The sun's disc and the glow around it follow the formula below in each pixel of a black sky;
 * pixels at the disc's edge are skipped. third: the distance between two unit vectors at an angle
 * of glow_size, 8 degrees, at which 2^-1.5, about a third, of the glow is left. */
static void sun_has_a_disc_and_a_glow(void **state)
{
    const double degree = acos(-1.0) / 180, radius = 5 * degree, third = 2 * sin(4 * degree);
    const struct vec sun = unit((struct vec){{0.1, -0.3, -1}});
    struct picture p =
        draw(*state, PICTURE DOWN "  floor: none\n  sky: {top: 0, horizon: 0}\n"
                                  "  sun: {direction: [0.1, -0.3, -1], color: [1, 0.5, 0.2], "
                                  "size: 10 deg, disc: 2, glow: 0.6, glow_size: 8 deg}\n");
    int inside = 0, outside = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const struct vec d = unit(pixel_ray(x + 0.5, y + 0.5));
            const double away = acos(fmin(dot(d, sun), 1)), far = 2 * sin(away / 2) / third;
            if (fabs(away - radius) < 0.6 * degree)
                continue;
            *(away < radius ? &inside : &outside) += 1;
            const double glow = (away < radius ? 2 : 0) + 0.6 * pow(1 / (1 + far * far), 1.5);
            assert_color(p.colors + 4 * (y * WIDTH + x), glow, 0.5 * glow, 0.2 * glow);
        }
    }
    assert_true(inside > 150 && outside > 5000);
    finish(&p);
}

/* A floor repeats its image in tiles of the width that the scene asks for, 8 m. With tiles of 2 mm,
 * of which about a thousand or more lie in each pixel, every pixel shows the mean colour of the
 * image, without a moire pattern. */
static void floors_repeat_without_aliasing(void **state)
{
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/tile.bmp", folder);
    write_quarters(path);
    const char *light = DOWN "  haze: 0\n  sky: {top: 0, horizon: 0}\n"
                             "  sun: {direction: [0, 1, 0], color: 3.14159265}\n";
    char text[512];
    snprintf(text, sizeof text, "%s  floor: {image: tile.bmp, tile: 8 m}\n", light);
    struct picture p = draw_in(*state, folder, text);
    int compared = 0;
    for (int y = HEIGHT / 2; y < HEIGHT; y += 2) {
        for (int x = 0; x < WIDTH; x += 3) {
            struct vec d = pixel_ray(x + 0.5, y + 0.5);
            struct vec at = along(eye, d, -eye.v[1] / d.v[1]);
            double u = at.v[0] / 8 - floor(at.v[0] / 8), v = at.v[2] / 4 - floor(at.v[2] / 4);
            double edge =
                fmin(fmin(fabs(u - 0.5), fmin(u, 1 - u)), fmin(fabs(v - 0.5), fmin(v, 1 - v)));
            if (edge < 0.05)
                continue;
            static const double colors[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
            const double *c = colors[(v < 0.5 ? 0 : 2) + (u < 0.5 ? 0 : 1)];
            assert_color(p.colors + 4 * (y * WIDTH + x), c[0], c[1], c[2]);
            compared++;
        }
    }
    assert_true(compared > 300);
    finish(&p);

    snprintf(text, sizeof text, "%s  floor: {image: tile.bmp, tile: 2 mm}\n", light);
    p = draw_in(*state, folder, text);
    for (int y = HEIGHT / 2; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_color(p.colors + 4 * (y * WIDTH + x), 0.5, 0.5, 0.5);
    }
    finish(&p);
    test_remove_folder(folder);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(round_shapes_match_c),
        test_on_device(soft_shadows_match_c),
        test_on_device(meshes_match_c),
        test_on_device(mesh_shadows_soften),
        test_on_device(skies_lie_where_they_should),
        test_on_device(sun_has_a_disc_and_a_glow),
        test_on_device(floors_repeat_without_aliasing),
    };
    return backdrops_run("backdrop_shapes", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
