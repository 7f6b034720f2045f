/* Spheres, cylinders, meshes, shadows and pictures of lib/draw/backdrop.c against a plain C ray
 * caster in doubles. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/mesh.h"
#include "asset/texture.h"
#include "draw/backdrop.h"
#include "support/backdrops.h"
#include "support/folders.h"

enum { WIDTH = 128, HEIGHT = 72 };

/* Without a sky, colours are those of the sun alone. */
#define HEAD                                                                                       \
    "kiln: 1\n"                                                                                    \
    "output: {size: [128, 72], frames: 1}\n"                                                       \
    "camera: {position: [0, 2.5, 5], target: [0, 0.5, 0], fov: 40 deg}\n"                          \
    "backdrop:\n"                                                                                  \
    "  haze: 0\n"                                                                                  \
    "  sky: {top: 0, horizon: 0}\n"                                                                \
    "  floor: {color: [0.6, 0.5, 0.4]}\n"

/* ---- the reference --------------------------------------------------------------------------- */

struct vec {
    double v[3];
};

static struct vec along(struct vec o, struct vec d, double t)
{
    return (struct vec){{o.v[0] + t * d.v[0], o.v[1] + t * d.v[1], o.v[2] + t * d.v[2]}};
}

static double dot(struct vec a, struct vec b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static struct vec cross(struct vec a, struct vec b)
{
    return (struct vec){{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                         a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}

static struct vec unit(struct vec a)
{
    double length = sqrt(dot(a, a));
    return (struct vec){{a.v[0] / length, a.v[1] / length, a.v[2] / length}};
}

enum kind { FLOOR, BOX, SPHERE, CYLINDER, MESH };

struct shape {
    enum kind kind;
    struct vec center, half_size, axis, albedo;
    double radius, half_height;
    const struct kiln_mesh *mesh; /* turned about y by `angle`, scaled */
    double angle, scale;
};

struct found {
    double t;
    struct vec normal, albedo;
    bool any;
};

static void keep(struct found *found, double t, struct vec normal, struct vec albedo)
{
    if (t > 1e-6 && (!found->any || t < found->t))
        *found = (struct found){t, normal, albedo, true};
}

static void hit_box(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    double in = -1e30, out = 1e30;
    struct vec normal = {{0}};
    for (int i = 0; i < 3; i++) {
        double a = (s->center.v[i] - s->half_size.v[i] - o.v[i]) / d.v[i];
        double b = (s->center.v[i] + s->half_size.v[i] - o.v[i]) / d.v[i];
        if (fmin(a, b) > in) {
            in = fmin(a, b);
            normal = (struct vec){{0}};
            normal.v[i] = a < b ? -1 : 1;
        }
        out = fmin(out, fmax(a, b));
    }
    if (in < out)
        keep(found, in, normal, s->albedo);
}

static void hit_sphere(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    struct vec q = along(o, s->center, -1);
    double a = dot(d, d), b = dot(q, d), c = dot(q, q) - s->radius * s->radius;
    if (b * b < a * c)
        return;
    double t = (-b - sqrt(b * b - a * c)) / a;
    keep(found, t, unit(along(q, d, t)), s->albedo);
}

static void hit_cylinder(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    struct vec q = along(o, s->center, -1);
    double h = dot(q, s->axis), climb = dot(d, s->axis);
    struct vec qf = along(q, s->axis, -h), df = along(d, s->axis, -climb);
    double a = dot(df, df), b = dot(qf, df), c = dot(qf, qf) - s->radius * s->radius;
    if (b * b >= a * c) {
        double t = (-b - sqrt(b * b - a * c)) / a;
        if (fabs(h + t * climb) <= s->half_height)
            keep(found, t, unit(along(qf, df, t)), s->albedo);
    }
    for (int end = -1; end <= 1; end += 2) {
        double t = (end * s->half_height - h) / climb;
        struct vec at = along(qf, df, t);
        if (dot(at, at) <= s->radius * s->radius && end * climb < 0)
            keep(found, t, along((struct vec){{0}}, s->axis, end), s->albedo);
    }
}

static struct vec turned(const struct shape *s, const float v[3], double scale)
{
    double c = cos(s->angle), n = sin(s->angle);
    return (struct vec){{scale * (c * (double)v[0] + n * (double)v[2]), scale * (double)v[1],
                         scale * (c * (double)v[2] - n * (double)v[0])}};
}

static void hit_mesh(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    const struct kiln_mesh *mesh = s->mesh;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct vec p[3];
        for (int k = 0; k < 3; k++)
            p[k] = along(turned(s, mesh->vertices[mesh->triangles[i][k]], s->scale), s->center, 1);
        struct vec e1 = along(p[1], p[0], -1), e2 = along(p[2], p[0], -1), q = along(o, p[0], -1);
        struct vec n = cross(d, e2), m = cross(q, e1);
        double det = dot(e1, n), u = dot(q, n) / det, v = dot(d, m) / det, t = dot(e2, m) / det;
        if (det == 0 || u < 0 || v < 0 || u + v > 1)
            continue;
        struct vec normal = {{0}};
        const double weights[3] = {1 - u - v, u, v};
        for (int k = 0; k < 3; k++) {
            const float *vertex = mesh->vertices[mesh->triangles[i][k]];
            normal = along(normal, turned(s, vertex + 3, 1), weights[k]);
        }
        struct vec face = cross(e1, e2);
        if (dot(normal, face) * dot(face, d) > 0)
            normal = along((struct vec){{0}}, normal, -1);
        keep(found, t, unit(normal), s->albedo);
    }
}

static struct found trace(const struct shape *shapes, int count, struct vec o, struct vec d)
{
    struct found found = {.any = false};
    for (int i = 0; i < count; i++) {
        const struct shape *s = &shapes[i];
        if (s->kind == FLOOR)
            keep(&found, -o.v[1] / d.v[1], (struct vec){{0, 1, 0}}, s->albedo);
        else if (s->kind == BOX)
            hit_box(s, o, d, &found);
        else if (s->kind == SPHERE)
            hit_sphere(s, o, d, &found);
        else if (s->kind == CYLINDER)
            hit_cylinder(s, o, d, &found);
        else
            hit_mesh(s, o, d, &found);
    }
    return found;
}

static const struct vec eye = {{0, 2.5, 5}};

static struct vec pixel_ray(double px, double py)
{
    struct vec forward = unit((struct vec){{0, -2, -5}}), right = {{1, 0, 0}};
    struct vec up = cross(right, forward);
    double tan_y = tan(20.0 * acos(-1.0) / 180.0);
    struct vec d = along(forward, right, (2 * px / WIDTH - 1) * tan_y * WIDTH / HEIGHT);
    return along(d, up, (1 - 2 * py / HEIGHT) * tan_y);
}

/* What of a sun of some angular radius a point sees: rings of its disc, counted. */
static double sun_seen(const struct shape *shapes, int count, struct vec point, struct vec sun,
                       double radius)
{
    struct vec right = unit(cross((struct vec){{0.3, 1, 0.2}}, sun)), up = cross(sun, right);
    int seen = 0, rays = 0;
    const int rings = radius > 0 ? 12 : 1;
    for (int ring = 0; ring < rings; ring++) {
        int around = radius > 0 ? 6 * ring + 3 : 1;
        double r = radius > 0 ? tan(radius) * (ring + 0.5) / rings : 0;
        for (int k = 0; k < around; k++, rays++) {
            double a = 2 * acos(-1.0) * k / around;
            struct vec d = along(along(sun, right, r * cos(a)), up, r * sin(a));
            seen += !trace(shapes, count, point, d).any;
        }
    }
    return (double)seen / rays;
}

/* ---- pictures -------------------------------------------------------------------------------- */

struct picture {
    struct kiln_scene *scene;
    struct kiln_image color, depth;
    struct kiln_backdrop_stage *stage;
    const float *colors, *depths;
};

static struct picture draw_below(void *device, const char *text, const char *asset_root)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = KILN_SCENE_DEFAULTS;
    params.asset_root = asset_root;
    struct picture p = {.scene = kiln_scene_parse(text, strlen(text), "test", &params, &error)};
    if (!p.scene)
        fail_msg("%s", error.message);
    kiln_image_init(&p.color, device, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&p.depth, device, WIDTH, HEIGHT, GL_R32F, "depth");
    p.stage = backdrop_create(device, p.scene, &p.color, &p.depth, &error);
    struct kiln_view view = kiln_view_compute(p.scene, 0);
    static const struct kiln_lighting lighting; /* none */
    if (!p.stage || !kiln_backdrop_draw(p.stage, &view, &lighting, &error))
        fail_msg("%s", error.message);
    p.colors = kiln_image_host(&p.color, KILN_READ, &error);
    p.depths = kiln_image_host(&p.depth, KILN_READ, &error);
    assert_true(p.colors && p.depths);
    return p;
}

static struct picture draw(void *device, const char *text)
{
    return draw_below(device, text, KILN_SOURCE_DIR "/scenes");
}

static void finish(struct picture *p)
{
    kiln_backdrop_destroy(&p->stage);
    kiln_image_finish(&p->color);
    kiln_image_finish(&p->depth);
    kiln_scene_destroy(&p->scene);
}

struct expected {
    const struct shape *shapes;
    int count;
    struct vec sun;
    double sun_radius;
    double tolerance; /* of the colour, in parts of full sun */
};

/* Red light of a ray, for an irradiance of pi. */
static double light(const struct expected *e, double px, double py, double *depth)
{
    struct vec d = pixel_ray(px, py);
    struct found found = trace(e->shapes, e->count, eye, d);
    *depth = found.any ? found.t : 1e9;
    if (!found.any)
        return 0;
    struct vec point = along(along(eye, d, found.t), found.normal, 1e-3);
    double facing = fmax(dot(found.normal, e->sun), 0);
    if (facing > 0)
        facing *= sun_seen(e->shapes, e->count, point, e->sun, e->sun_radius);
    return facing * found.albedo.v[0];
}

/* Compares where half a pixel aside is much the same; that must be most of the picture. */
static void compare(const struct picture *p, const struct expected *e, int step)
{
    int compared = 0, looked = 0;
    double worst = 0;
    for (int y = 0; y < HEIGHT; y += step) {
        for (int x = 0; x < WIDTH; x += step) {
            static const double corners[4][2] = {{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}, {0.9, 0.9}};
            double depth, expected = light(e, x + 0.5, y + 0.5, &depth);
            bool even = true;
            for (int k = 0; k < 4; k++) {
                double other, aside = light(e, x + corners[k][0], y + corners[k][1], &other);
                even = even && fabs(aside - expected) < fmax(e->tolerance, 0.04) &&
                       fabs(other - depth) < 0.03 * depth;
            }
            looked++;
            if (!even)
                continue;
            compared++;
            double found = (double)p->colors[4 * (y * WIDTH + x)];
            double found_depth = (double)p->depths[y * WIDTH + x];
            if (fabs(found_depth - depth) > 3e-4 * depth)
                fail_msg("pixel %d,%d: depth %g, expected %g", x, y, found_depth, depth);
            worst = fmax(worst, fabs(found - expected));
            if (fabs(found - expected) > e->tolerance)
                fail_msg("pixel %d,%d: light %g, expected %g", x, y, found, expected);
        }
    }
    print_message("%d of %d pixels compared, worst %.3f\n", compared, looked, worst);
    assert_true(compared > looked * 3 / 4);
}

/* ---- tests ----------------------------------------------------------------------------------- */

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

/* Depth, normals and shadows of a mesh, on itself, on the floor and on a box. */
static void check_mesh(void *device, const char *text, double sun_radius, double tolerance,
                       int step)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load(KILN_SOURCE_DIR "/scenes/meshes/pot.obj",
                                            KILN_SOURCE_DIR "/scenes", NULL, NULL, &error);
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

static double mean_of(const struct picture *p, int x0, int y0, int x1, int y1, int channel)
{
    double sum = 0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++)
            sum += (double)p->colors[4 * (y * WIDTH + x) + channel];
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

/* A mesh's penumbra is wider, and as dark in sum. */
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

/* ---- pictures as floor and sky --------------------------------------------------------------- */

#define PICTURE "kiln: 1\noutput: {size: [128, 72], frames: 1}\n"
#define DOWN    "camera: {position: [0, 2.5, 5], target: [0, 0.5, 0], fov: 40 deg}\nbackdrop:\n"
#define LEVEL   "camera: {position: [0, 2.5, 5], target: [0, 2.5, 0], fov: 40 deg}\nbackdrop:\n"

enum { SKY_WIDTH = 64, SKY_HEIGHT = 32 };

/* A BMP file of four colours: left and right, upper and lower half. */
static void write_quarters(const char *path)
{
    enum { ROW = SKY_WIDTH * 3, SIZE = 54 + ROW * SKY_HEIGHT };
    static unsigned char file[SIZE];
    static const unsigned char quarters[4][3] = {
        {0, 0, 255}, {0, 255, 0}, {255, 0, 0}, {255, 255, 255}}; /* blue, green, red */
    memset(file, 0, sizeof file);
    file[0] = 'B';
    file[1] = 'M';
    file[2] = SIZE & 255;
    file[3] = SIZE >> 8;
    file[10] = 54; /* of the pixels */
    file[14] = 40; /* bytes of the second header */
    file[18] = SKY_WIDTH;
    file[22] = SKY_HEIGHT;
    file[26] = 1;
    file[28] = 24;
    for (int y = 0; y < SKY_HEIGHT; y++) { /* from the bottom */
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

/* Left of the middle of the picture lies left of -z, and it turns with its rotation. */
static void skies_lie_where_they_should(void **state)
{
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/sky.bmp", folder);
    write_quarters(path);
    struct picture p = draw_in(*state, folder, LEVEL "  floor: none\n  sky: {image: sky.bmp}\n");
    assert_color(p.colors + 4 * (1 * WIDTH + 2), 1, 0, 0); /* blue, green, red in the file */
    assert_color(p.colors + 4 * (1 * WIDTH + WIDTH - 3), 0, 1, 0);
    assert_color(p.colors + 4 * ((HEIGHT - 2) * WIDTH + 2), 0, 0, 1);
    assert_color(p.colors + 4 * ((HEIGHT - 2) * WIDTH + WIDTH - 3), 1, 1, 1);
    finish(&p);
    p = draw_in(*state, folder,
                LEVEL "  floor: none\n  sky: {image: sky.bmp, rotation: 90 deg, intensity: 0.5}\n");
    assert_color(p.colors + 4 * (1 * WIDTH + 2), 0, 0.5, 0); /* what was to the right */
    finish(&p);

    /* What faces up gets the mean of the upper half, and the band at the horizon that of both. */
    struct kiln_error error = {0};
    struct kiln_sky_light light;
    assert_true(kiln_sky_light_measure(&light, path, &error));
    assert_true(fabsf(light.up[0] - 0.5f) < 1e-3f && fabsf(light.up[1] - 0.5f) < 1e-3f);
    assert_true(light.up[2] == 0.0f && light.horizon[2] > 0.05f);
    test_remove_folder(folder);
}

/* Near by, the picture itself, in its size; far away, where thousands of tiles share a pixel, its
 * mean without a pattern. */
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

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(round_shapes_match_c),
        test_on_device(soft_shadows_match_c),
        test_on_device(meshes_match_c),
        test_on_device(mesh_shadows_soften),
        test_on_device(skies_lie_where_they_should),
        test_on_device(floors_repeat_without_aliasing),
    };
    int failed = 0;
    for (int i = 0; i < 2; i++) {
        backdrop_technique = BACKDROPS[i];
        failed += cmocka_run_group_tests_name("backdrop_shapes", tests, test_device_open,
                                              test_device_close);
    }
    return failed;
}
