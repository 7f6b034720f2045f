/* Checks the shadows that solid particles, which are balls or meshes, cast in the light of a lamp
 * on the floor and on each other, against rays to all parts of the lamp. If this fails, these
 * shadows lie in wrong places or are too hard, or solids shade themselves. Each technique of the
 * backdrop runs all tests. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "draw/light/lighting.h"
#include "draw/solids/solids.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"

enum { WIDTH = 160, HEIGHT = 90, STEP = 30 };

/* The camera looks down at a white floor in the light of one lamp. */
#define SCENE(lamp, look)                                                                          \
    "kiln: 1\n"                                                                                    \
    "output: {size: [160, 90], fps: 60}\n"                                                         \
    "camera: {position: [0, 8, 0.1], target: [0, 0, 0], fov: 40 deg}\n"                            \
    "backdrop:\n"                                                                                  \
    "  haze: 0\n"                                                                                  \
    "  sky: {top: 0, horizon: 0}\n"                                                                \
    "  floor: {color: 1}\n"                                                                        \
    "  sun: {color: 0}\n"                                                                          \
    "  lights:\n"                                                                                  \
    "    - point: {position: [-1.5, 4, 0.3], color: 16, radius: " lamp "}\n"                       \
    "systems:\n"                                                                                   \
    "  a:\n"                                                                                       \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {" look ", lit: 1, color: 1, fade: {in: 0, out: 0}}\n"

#define BALL  "shape: sphere, size: 0.6 m"
#define SPECK "shape: sphere, size: 6 mm"
#define MESH                                                                                       \
    "shape: mesh, mesh: {file: tetrahedron.obj, orient: upright}, size: 0.9 m, rotation: [40 deg," \
    " 40 deg]"

static const vec LAMP = {-1.5, 4, 0.3};
/* The radius of balls, m; the edge of meshes, m; the red light of the lamp. */
static const double RADIUS = 0.3, EDGE = 0.9, COLOR = 16;

struct fixture {
    struct drawing drawing;
    struct kiln_lighting_stage *lighting;
    struct kiln_solids_stage *solids;
    struct kiln_image color, depth, bloom;
};

static void init(struct fixture *f, struct kiln_device *device, const char *text,
                 const char *override)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    *f = (struct fixture){.solids = NULL};
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    drawing_init(d, device, text, &override, override ? 1 : 0);
    drawing_asset_root = NULL;
    kiln_image_init(&f->color, device, WIDTH, HEIGHT, GL_RGBA32F, "scene");
    kiln_image_init(&f->depth, device, WIDTH, HEIGHT, GL_R32F, "scene depth");
    kiln_image_init(&f->bloom, device, WIDTH, HEIGHT, GL_RGBA32F, "sphere bloom");
    const struct kiln_solids_params params = {
        .backdrop = d->backdrop,
        .threads = d->threads,
        .targets = {&d->backdrop_color, &d->backdrop_depth, &f->color, &f->depth, &f->bloom},
    };
    f->lighting = kiln_lighting_create(device, &d->moment, d->threads, &error);
    f->solids = kiln_solids_create(device, &d->moment, &params, &error);
    if (!f->lighting || !f->solids)
        fail_msg("%s", error.message);
}

static void finish(struct fixture *f)
{
    kiln_solids_destroy(&f->solids);
    kiln_lighting_destroy(&f->lighting);
    kiln_image_finish(&f->color);
    kiln_image_finish(&f->depth);
    kiln_image_finish(&f->bloom);
    drawing_finish(&f->drawing);
}

/* Draws the backdrop and particles at `places`, m. The floor is in drawing.backdrop_color, and the
 * floor with the particles in color. */
static void draw(struct fixture *f, const vec *places, uint32_t count)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    struct kiln_particle *particles = calloc(count, sizeof *particles);
    assert_non_null(particles);
    for (uint32_t i = 0; i < count; i++) {
        const float3 at = {(float)places[i].x, (float)places[i].y, (float)places[i].z};
        particles[i] = drawing_particle(i, at, (float3){0.0f, 0.0f, 0.0f});
    }
    drawing_place(d, particles, count, STEP);
    free(particles);
    d->pool.systems[0].next_serial = count;
    if (!kiln_lighting_run(f->lighting, &d->moment, NULL, &d->lighting, &error) ||
        !kiln_backdrop_draw(d->backdrop, &d->moment, &d->lighting, &error) ||
        !kiln_solids_draw(f->solids, &d->moment, &d->entries, count, &error))
        fail_msg("%s", error.message);
    assert_non_null(kiln_image_host(&d->backdrop_color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->depth, KILN_READ, &error));
    assert_non_null(kiln_image_host(&d->backdrop_depth, KILN_READ, &error));
}

/* ---- rays ------------------------------------------------------------------------------------ */

/* Finds the corners of the mesh at a place, m; its axes are turned about y by 40 degrees. */
static void corners_of(vec place, vec corners[4])
{
    static const vec axes[3] = {
        {0.766044443, 0, -0.642787610}, {0, 1, 0}, {0.642787610, 0, 0.766044443}};
    for (int k = 0; k < 4; k++) {
        corners[k] = place;
        for (int axis = 0; axis < 3; axis++)
            corners[k] = vec_add(corners[k], axes[axis], k == axis + 1 ? EDGE / 2 : -EDGE / 2);
    }
}

/* Returns whether the segment from `from` to from + ray meets the triangle a, b, c. */
static bool meets_triangle(vec from, vec ray, vec a, vec b, vec c)
{
    const vec u = vec_add(b, a, -1), v = vec_add(c, a, -1), to = vec_add(from, a, -1);
    const vec across = vec_cross(ray, v), along = vec_cross(to, u);
    const double volume = vec_dot(u, across), s = vec_dot(to, across) / volume;
    const double t = vec_dot(ray, along) / volume, reach = vec_dot(v, along) / volume;
    return s >= 0 && t >= 0 && s + t <= 1 && reach > 1e-6 && reach < 1;
}

/* Returns whether a particle at `place` blocks the segment from a point to a part of the lamp.
 * from: the point, m; ray: from the point to the lamp, m; mesh: the particle is a mesh, else a
 * ball. */
static bool is_blocked(vec from, vec ray, vec place, bool mesh)
{
    if (!mesh) {
        const vec to = vec_add(place, from, -1);
        const double t = vec_dot(to, ray) / vec_dot(ray, ray);
        const vec away = vec_add(to, ray, -t);
        return t > 0 && t < 1 && vec_dot(away, away) < RADIUS * RADIUS;
    }
    vec p[4];
    corners_of(place, p);
    return meets_triangle(from, ray, p[0], p[1], p[2]) ||
           meets_triangle(from, ray, p[0], p[1], p[3]) ||
           meets_triangle(from, ray, p[0], p[2], p[3]) ||
           meets_triangle(from, ray, p[1], p[2], p[3]);
}

/* Returns the fraction, 0 to 1, of the lamp's disc that a point sees past all particles, except for
 * the particle with the index `own`. */
static double lamp_seen(vec point, double lamp_radius, const vec *places, uint32_t count,
                        uint32_t own, bool mesh)
{
    enum { RAYS = 150 };
    const vec way = vec_add(LAMP, point, -1);
    const vec right = vec_unit(vec_cross((vec){0, 0, 1}, way));
    const vec up = vec_unit(vec_cross(way, right));
    int seen = 0;
    for (int i = 0; i < RAYS; i++) {
        const double r = lamp_radius * sqrt((i + 0.5) / RAYS), turn = 2.39996323 * i;
        const vec ray = vec_add(vec_add(way, right, r * cos(turn)), up, r * sin(turn));
        bool blocked = false;
        for (uint32_t k = 0; k < count && !blocked; k++)
            blocked = k != own && is_blocked(point, ray, places[k], mesh);
        seen += !blocked;
    }
    return (double)seen / RAYS;
}

/* Returns the red light that a white surface reflects if nothing hides the lamp. normal: unit. */
static double whole_light(vec point, vec normal, double lamp_radius)
{
    const vec way = vec_add(LAMP, point, -1);
    const double square = vec_dot(way, way);
    return COLOR * fmax(vec_dot(way, normal), 0) / sqrt(square) /
           (square + lamp_radius * lamp_radius);
}

/* ---- the floor ------------------------------------------------------------------------------- */

static vec floor_at(const struct drawing *d, double x, double y)
{
    vec eye = drawing_eye(d), ray = drawing_ray(d, x, y);
    return vec_add(eye, ray, -eye.y / ray.y);
}

/* Compares the fraction of the lamp's light that reaches the floor with rays, except in pixels next
 * to hard edges. tolerance: the largest absolute difference of this fraction. Returns how many
 * pixels are in penumbra. */
static int check_floor(const struct fixture *f, double lamp_radius, const vec *places,
                       uint32_t count, bool mesh, double tolerance)
{
    static double seen[WIDTH * HEIGHT];
    int partly = 0, compared = 0, wrong = 0;
    double worst = 0;
    for (int p = 0; p < WIDTH * HEIGHT; p++)
        seen[p] = lamp_seen(floor_at(&f->drawing, p % WIDTH + 0.5, p / WIDTH + 0.5), lamp_radius,
                            places, count, count, mesh);
    for (int p = WIDTH + 1; p < WIDTH * (HEIGHT - 1) - 1; p++) {
        const vec at = floor_at(&f->drawing, p % WIDTH + 0.5, p / WIDTH + 0.5);
        const double found = (double)f->drawing.backdrop_color.host[4 * p] /
                             whole_light(at, (vec){0, 1, 0}, lamp_radius);
        bool even = true;
        for (int k = 0; k < 9; k++)
            even = even && fabs(seen[p + (k / 3 - 1) * WIDTH + k % 3 - 1] - seen[p]) < 0.3;
        if (!even)
            continue;
        compared++;
        partly += seen[p] > 0.05 && seen[p] < 0.95;
        wrong += fabs(found - seen[p]) > tolerance;
        worst = fmax(worst, fabs(found - seen[p]));
    }
    print_message("radius %g: %d pixels in penumbra, %d wrong, worst %.3f\n", lamp_radius, partly,
                  wrong, worst);
    if (wrong > WIDTH * HEIGHT / 2000)
        fail_msg("%d of %d pixels are wrong, by up to %g", wrong, compared, worst);
    assert_true(compared > WIDTH * HEIGHT * 9 / 10);
    return partly;
}

/* Balls must shade the floor as rays say. A wider lamp must make a wider penumbra; a lamp of 1 cm
 * has nearly none. */
static void a_ball_hides_a_lamp(void **state)
{
    static const char *const texts[] = {SCENE("0.01 m", BALL), SCENE("0.2 m", BALL),
                                        SCENE("0.5 m", BALL)};
    static const double radii[] = {0.01, 0.2, 0.5};
    /* Kiln makes a shadow as soft as if it began at the ball's middle. Where a ball lies on the
     * floor this is wrong, so wide lamps need more tolerance. */
    static const double tolerances[] = {0.05, 0.13, 0.25};
    const vec places[] = {{-0.5, 1.5, 0.2}, {1, 0.3, -0.8}, {-2.2, 2.2, 1.2}};
    int partly[3];
    for (int i = 0; i < 3; i++) {
        struct fixture f;
        init(&f, *state, texts[i], NULL);
        draw(&f, places, 3);
        partly[i] = check_floor(&f, radii[i], places, 3, false, tolerances[i]);
        finish(&f);
    }
    assert_true(partly[1] > partly[0] + 50 && partly[2] > partly[1] + 100);
}

static void a_mesh_hides_a_lamp(void **state)
{
    static const char *const texts[] = {SCENE("0.01 m", MESH), SCENE("0.2 m", MESH)};
    static const double radii[] = {0.01, 0.2};
    const vec places[] = {{-0.5, 1.5, 0.2}, {1.2, 0.6, -0.8}};
    for (int i = 0; i < 2; i++) {
        struct fixture f;
        init(&f, *state, texts[i], NULL);
        draw(&f, places, 2);
        check_floor(&f, radii[i], places, 2, true, 0.1);
        finish(&f);
    }
}

/* A lamp that is wider than a ball must shine past the ball, however near the ball is to the lamp.
 * In the middle of the shadow, the fraction of light must match rays to within 0.1. */
static void a_wide_lamp_shines_past_a_ball(void **state)
{
    static const char *const texts[] = {SCENE("0.5 m", BALL), SCENE("0.8 m", BALL)};
    static const double radii[] = {0.5, 0.8}, heights[] = {3.4, 3.2, 2.4};
    for (int i = 0; i < 2; i++) {
        struct fixture f;
        init(&f, *state, texts[i], NULL);
        for (int k = 0; k < 3; k++) {
            const vec place = {LAMP.x, heights[k], LAMP.z};
            draw(&f, &place, 1);
            const vec pixel = drawing_project(&f.drawing, (vec){LAMP.x, 0, LAMP.z});
            const vec at = floor_at(&f.drawing, floor(pixel.x) + 0.5, floor(pixel.y) + 0.5);
            const size_t p = (size_t)pixel.y * WIDTH + (size_t)pixel.x;
            const double expected = lamp_seen(at, radii[i], &place, 1, 1, false);
            const double found = (double)f.drawing.backdrop_color.host[4 * p] /
                                 whole_light(at, (vec){0, 1, 0}, radii[i]);
            print_message("height %g: %g of the lamp, expected %g\n", heights[k], found, expected);
            assert_true(fabs(found - expected) < 0.1);
        }
        finish(&f);
    }
}

/* Specks must darken the floor by as much light as they hide, although each has only about a tenth
 * of the area of a texel of the lamp's shadow maps. */
static void specks_hide_their_share(void **state)
{
    enum { COUNT = 3000 };
    struct fixture f;
    vec *places = calloc(COUNT, sizeof *places);
    assert_non_null(places);
    srand(5);
    double expected = 0, found = 0;
    for (int i = 0; i < COUNT; i++)
        places[i] =
            (vec){rand() % 1000 * 1e-3 - 1.2, 2 + rand() % 500 * 1e-3, rand() % 1000 * 1e-3 - 0.3};
    drawing_most = COUNT;
    init(&f, *state, SCENE("0.01 m", SPECK), NULL);
    draw(&f, places, COUNT);
    drawing_most = 32;
    /* A speck takes the light that falls on its disc: color / distance^2 times its area. The floor
     * lacks as much: the lost light of each pixel times the area of floor that it shows. */
    for (int i = 0; i < COUNT; i++) {
        const vec way = vec_add(LAMP, places[i], -1);
        expected += COLOR / vec_dot(way, way) * acos(-1.0) * 0.003 * 0.003;
    }
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const double x = p % WIDTH, y = p / WIDTH;
        const vec at = floor_at(&f.drawing, x + 0.5, y + 0.5);
        const vec a = floor_at(&f.drawing, x, y), b = floor_at(&f.drawing, x + 1, y + 1);
        const double lost =
            whole_light(at, (vec){0, 1, 0}, 0.01) - (double)f.drawing.backdrop_color.host[4 * p];
        found += lost * fabs((b.x - a.x) * (b.z - a.z));
    }
    print_message("specks take %g of the light, expected %g\n", found, expected);
    assert_true(fabs(found - expected) < 0.1 * expected);
    finish(&f);
    free(places);
}

/* ---- solids ---------------------------------------------------------------------------------- */

/* Returns whether solid particles cover a pixel and its eight neighbours. */
static bool is_filled(const struct fixture *f, int p)
{
    const int x = p % WIDTH, y = p / WIDTH;
    bool filled = x > 0 && y > 0 && x < WIDTH - 1 && y < HEIGHT - 1;
    for (int k = 0; filled && k < 9; k++) {
        const int at = p + (k / 3 - 1) * WIDTH + k % 3 - 1;
        filled = f->depth.host[at] < 0.99f * f->drawing.backdrop_depth.host[at];
    }
    return filled;
}

/* Finds the ball that a pixel shows. *which becomes its index, and *point the point where the
 * pixel's ray meets the ball. Returns false if the pixel shows no ball. */
static bool ball_at(const struct fixture *f, int x, int y, const vec *places, uint32_t count,
                    uint32_t *which, vec *point)
{
    const vec eye = drawing_eye(&f->drawing), ray = drawing_ray(&f->drawing, x + 0.5, y + 0.5);
    double nearest = 1e9;
    for (uint32_t i = 0; i < count; i++) {
        const vec to = vec_add(places[i], eye, -1);
        const double t = vec_dot(to, ray) / vec_dot(ray, ray);
        const vec away = vec_add(to, ray, -t);
        if (vec_dot(away, away) >= RADIUS * RADIUS)
            continue;
        const double depth = t - sqrt((RADIUS * RADIUS - vec_dot(away, away)) / vec_dot(ray, ray));
        if (depth >= nearest)
            continue;
        nearest = depth;
        *which = i;
        *point = vec_add(eye, ray, depth);
    }
    return nearest < 1e9;
}

/* Compares the light of balls with rays, in pixels that balls fill. tolerance: the largest
 * difference divided by the unhidden light, or by 0.5 if it is less. Returns how many pixels are in
 * penumbra. */
static int check_balls(const struct fixture *f, double lamp_radius, const vec *places,
                       uint32_t count, double tolerance)
{
    int partly = 0, compared = 0, wrong = 0;
    double worst = 0;
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        uint32_t own = 0;
        vec at;
        if (!is_filled(f, p) || !ball_at(f, p % WIDTH, p / WIDTH, places, count, &own, &at))
            continue;
        const vec normal = vec_unit(vec_add(at, places[own], -1));
        const double whole = whole_light(at, normal, lamp_radius);
        const double seen = lamp_seen(at, lamp_radius, places, count, own, false);
        const double error = fabs((double)f->color.host[4 * p] - whole * seen) / fmax(whole, 0.5);
        compared++;
        partly += whole > 0 && seen > 0.05 && seen < 0.95;
        wrong += error > tolerance;
        worst = fmax(worst, error);
    }
    print_message("radius %g: %d of %d pixels in penumbra, %d wrong, worst %.3f\n", lamp_radius,
                  partly, compared, wrong, worst);
    if (wrong > compared / 50)
        fail_msg("%d of %d pixels are wrong, by up to %g", wrong, compared, worst);
    assert_true(compared > 25);
    return partly;
}

/* A ball alone must be lit as if nothing hid the lamp, wherever it is in the lamp's shadow maps. */
static void a_ball_does_not_shade_itself(void **state)
{
    const vec places[] = {{0, 0.3, 0}, {-1.5, 3, 0.3}, {1.6, 3.4, 0.3}, {-2.4, 2.9, 1.2}};
    for (int i = 0; i < 4; i++) {
        struct fixture f;
        init(&f, *state, SCENE("0.2 m", BALL), NULL);
        draw(&f, &places[i], 1);
        check_balls(&f, 0.2, &places[i], 1, 0.01);
        finish(&f);
    }
}

/* A mesh alone must look as it does under a lamp without shadows. */
static void a_mesh_does_not_shade_itself(void **state)
{
    static const char *const overrides[] = {"backdrop.lights.0.point.shadow=true",
                                            "backdrop.lights.0.point.shadow=false"};
    const vec place = {-0.2, 2.4, 0.1};
    struct fixture f[2];
    double most = 0;
    int drawn = 0;
    for (int i = 0; i < 2; i++) {
        init(&f[i], *state, SCENE("0.2 m", MESH), overrides[i]);
        draw(&f[i], &place, 1);
    }
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        if (!is_filled(&f[0], p))
            continue;
        drawn++;
        const double whole = (double)f[1].color.host[4 * p];
        most = fmax(most, fabs((double)f[0].color.host[4 * p] - whole) / fmax(whole, 0.5));
    }
    print_message("%d pixels, worst %g\n", drawn, most);
    assert_true(drawn > 50 && most < 0.01);
    finish(&f[0]);
    finish(&f[1]);
}

/* The upper balls must hide as much of the lamp from the lower balls as rays say. */
static void balls_shade_each_other(void **state)
{
    static const char *const texts[] = {SCENE("0.01 m", BALL), SCENE("0.15 m", BALL),
                                        SCENE("0.4 m", BALL)};
    static const double radii[] = {0.01, 0.15, 0.4};
    const vec places[] = {{-0.9, 2.6, 0.4}, {-0.2, 0.3, 0.2}, {0.4, 0.4, 0.4},
                          {-1.4, 2.9, 0.8}, {-1.1, 0.3, 2},   {-2.3, 0.5, -0.6}};
    int partly[3];
    for (int i = 0; i < 3; i++) {
        struct fixture f;
        init(&f, *state, texts[i], NULL);
        draw(&f, places, 6);
        partly[i] = check_balls(&f, radii[i], places, 6, 0.1);
        finish(&f);
    }
    assert_true(partly[1] > partly[0] && partly[2] > partly[1]);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_ball_hides_a_lamp),
        test_on_device(a_mesh_hides_a_lamp),
        test_on_device(a_wide_lamp_shines_past_a_ball),
        test_on_device(specks_hide_their_share),
        test_on_device(a_ball_does_not_shade_itself),
        test_on_device(a_mesh_does_not_shade_itself),
        test_on_device(balls_shade_each_other),
    };
    return backdrops_run("solid lamps", tests, sizeof tests / sizeof *tests, true, argc, argv);
}
