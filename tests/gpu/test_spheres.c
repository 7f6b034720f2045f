/* Checks that each technique of the backdrop draws opaque spheres (lib/draw/solids/solids.c) as
 * rays that are intersected with spheres in double precision show them: depth, silhouettes, light
 * and patterns. If this fails, spheres have wrong shapes or colours, jagged edges, or cover each
 * other in the order of the list. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/opaque.h"
#include "support/pools.h"

enum { STEP = 30, COUNT = 24 };

/* A scene in which a box hides some of the spheres and the floor cuts others. The radius of the
 * spheres is 0.2 m. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [320, 240], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0.5, 1.5, 3], target: [0, 0.8, 0], fov: 75 deg, roll: 20 deg, near: 0.1}\n"
    "backdrop:\n"
    "  haze: 0\n"
    "  objects:\n"
    "    - box: {center: [-0.5, 0.7, 0.4], size: [0.6, 0.6, 0.6]}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1, life: 10 s}\n"
    "    look: {shape: sphere, lit: 0, size: 0.8 m, scale: 0.5, fade: {in: 0, out: 0},\n"
    "           color: [0.8, 0.4, 0.2], bloom: [1, 0.5, 0]}\n";

static const double ALBEDO[3] = {0.8, 0.4, 0.2};

static void init(struct fixture *f, struct kiln_device *device, const char *const *overrides,
                 size_t count)
{
    opaque_init(f, device, SCENE, overrides, count);
}

static float within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

static void place_cloud(struct fixture *f, struct kiln_particle particles[COUNT])
{
    srand(11);
    for (uint32_t i = 0; i < COUNT; i++) {
        float3 position = {within(-2.0f, 2.0f), within(0.0f, 2.0f), within(-1.0f, 1.5f)};
        particles[i] = drawing_particle(i, position, (float3){0.0f, 0.0f, 0.0f});
    }
    drawing_place(&f->drawing, particles, COUNT, STEP);
}

struct meeting {
    double depth;   /* view depth of the nearest sphere or of the backdrop, m */
    vec normal;     /* unit normal of the sphere; zero for the backdrop */
    double edge_px; /* distance to the nearest silhouette of a sphere, px */
};

/* Returns what the ray through the place (x, y) of the picture, px, meets first: one of the
 * spheres, whose radius is in m, or the backdrop. */
static struct meeting meet(const struct fixture *f, const struct kiln_particle *particles,
                           uint32_t count, double radius, double x, double y)
{
    const struct drawing *d = &f->drawing;
    vec ray = drawing_ray(d, x, y);
    double pixel = 2 * (double)d->moment.view.frustum.y / HEIGHT;
    size_t p = (size_t)y * WIDTH + (size_t)x;
    struct meeting first = {.depth = (double)d->backdrop_depth.host[p], .edge_px = 1e9};
    for (uint32_t i = 0; i < count; i++) {
        vec center = vec_add(vec_of(particle_position(particles[i])), drawing_eye(d), -1);
        double t = vec_dot(ray, center) / vec_dot(ray, ray);
        vec away = vec_add(vec_add((vec){0}, ray, t), center, -1);
        double inside = radius * radius - vec_dot(away, away);
        double edge = fabs(sqrt(vec_dot(away, away)) - radius) / (t * pixel);
        first.edge_px = fmin(first.edge_px, edge);
        double hit = t - sqrt(fmax(inside, 0) / vec_dot(ray, ray));
        if (inside >= 0 && hit < first.depth) {
            first.depth = hit;
            first.normal = vec_unit(vec_add(vec_add((vec){0}, ray, hit), center, -1));
        }
    }
    return first;
}

static void depth_is_where_the_ray_meets_a_sphere(void **state)
{
    struct fixture f;
    init(&f, *state, NULL, 0);
    struct kiln_particle particles[COUNT];
    place_cloud(&f, particles);
    opaque_draw(&f, COUNT);
    int spheres = 0, kept = 0;
    for (int p = 0; p < PIXELS; p++) {
        struct meeting m = meet(&f, particles, COUNT, 0.2, p % WIDTH + 0.5, p / WIDTH + 0.5);
        if (m.edge_px < 1)
            continue;
        assert_true(fabs((double)f.depth.host[p] - m.depth) < 1e-4 * m.depth);
        bool is_sphere = vec_dot(m.normal, m.normal) > 0;
        for (int c = 0; c < 3; c++) {
            double color = is_sphere ? ALBEDO[c] : (double)f.drawing.backdrop_color.host[4 * p + c];
            double glow = is_sphere ? ALBEDO[c] * (double[]){1, 0.5, 0}[c] : 0;
            assert_true(fabs((double)f.color.host[4 * p + c] - color) < 1e-3);
            assert_true(fabs((double)f.bloom.host[4 * p + c] - glow) < 1e-3);
        }
        spheres += is_sphere;
        kept += !is_sphere;
    }
    assert_true(spheres > 3000 && kept > 20000);
    opaque_finish(&f);
}

/* A sphere at the side of the picture, where perspective makes it an ellipse, covers as much of
 * each pixel as 256 rays through the pixel show, and its total area is right. With an opacity of
 * 0.5 a sphere has half of its diameter. */
static void silhouettes_are_smooth(void **state)
{
    static const char *const half[] = {"systems.a.look.opacity=0.5"};
    for (size_t count = 0; count < 2; count++) {
        struct fixture f;
        init(&f, *state, half, count);
        struct kiln_particle particle =
            drawing_particle(0, (float3){1.4f, 1.9f, 0.8f}, (float3){0.0f, 0.0f, 0.0f});
        drawing_place(&f.drawing, &particle, 1, STEP);
        opaque_draw(&f, 1);
        double drawn = 0, expected = 0, partly = 0;
        for (int p = 0; p < PIXELS; p++) {
            double part = 0;
            for (int k = 0; k < 256; k++) {
                double x = p % WIDTH + (k % 16 + 0.5) / 16, y = p / WIDTH + (k / 16 + 0.5) / 16;
                struct meeting m = meet(&f, &particle, 1, count ? 0.1 : 0.2, x, y);
                part += vec_dot(m.normal, m.normal) > 0 ? 1.0 / 256 : 0;
            }
            double seen = (double)f.bloom.host[4 * p] / ALBEDO[0];
            assert_true(fabs(seen - part) < 0.3);
            bool is_sphere = f.depth.host[p] < f.drawing.backdrop_depth.host[p];
            assert_true(is_sphere == (seen > 0.4)); /* at least two of a pixel's four samples hit */
            drawn += seen;
            expected += part;
            partly += seen > 0.1 && seen < 0.9;
        }
        assert_true(expected > 200 && partly > 20);
        assert_true(fabs(drawn - expected) < 0.01 * expected);
        opaque_finish(&f);
    }
}

/* A sphere with a diameter of a fifth of a pixel adds light in proportion to its area, on average
 * over its positions in the pixel. It hides no particles behind it: the depth is that of the
 * backdrop. */
static void spheres_below_a_pixel_are_fainter(void **state)
{
    enum { PLACES = 8 };
    const double distance = 4, diameter_px = 0.2;
    const double pixel_m = 2 * distance * tan(37.5 * acos(-1) / 180) / HEIGHT;
    char size[64];
    snprintf(size, sizeof size, "systems.a.look.size=%.9g m", diameter_px * pixel_m / 0.5);
    const char *const overrides[] = {
        size, "backdrop.objects=[]",
        "camera={position: [0, 4, 4], target: [0, 4, 0], fov: 75 deg}"};
    struct fixture f;
    init(&f, *state, overrides, 3);
    double sum = 0;
    for (int i = 0; i < PLACES * PLACES; i++) {
        const double x = (i % PLACES + 0.31) / PLACES, y = (i / PLACES + 0.17) / PLACES;
        const float3 at = {(float)(x * pixel_m), (float)(4 + y * pixel_m), 0.0f};
        const struct kiln_particle particle = drawing_particle(0, at, (float3){0.0f, 0.0f, 0.0f});
        drawing_place(&f.drawing, &particle, 1, STEP);
        opaque_draw(&f, 1);
        double shed = 0;
        for (int p = 0; p < PIXELS; p++)
            shed += (double)f.bloom.host[4 * p] / ALBEDO[0];
        const double area = acos(-1) * diameter_px * diameter_px / 4;
        assert_true(shed > 0.5 * area && shed < 1.5 * area);
        assert_memory_equal(f.depth.host, f.drawing.backdrop_depth.host, PIXELS * sizeof(float));
        sum += shed / area / (PLACES * PLACES);
    }
    assert_true(fabs(sum - 1) < 0.06);
    opaque_finish(&f);
}

/* Returns the value, 0 to 1, that a display shows of a pixel at an edge, from samples that are
 * weighted with 1 / (1 + their light). light, dark: light of the two sides of the edge; bright:
 * part of the pixel, 0 to 1, on the side of `light`. */
static double shown_mean(double light, double dark, double bright)
{
    const double weight = bright / (1 + light), other = (1 - bright) / (1 + dark);
    return fmin((light * weight + dark * other) / (weight + other), 1);
}

/* The edge of a very bright sphere is antialiased: with four samples a pixel it shows all five
 * steps from dark to bright. With two stops of exposure the sphere is eight times as bright as
 * white. */
static void bright_edges_have_all_steps(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.color=[2, 1, 0.5]",
        "systems.a.look.size=3 m",
        "systems.a.look.bloom=0.5",
        "backdrop.objects=[]",
        "backdrop.floor=none",
        "post.exposure=2",
        "backdrop.sky={top: [0.02, 0.02, 0.02], horizon: [0.02, 0.02, 0.02]}"};
    struct fixture f;
    init(&f, *state, overrides, 7);
    const struct kiln_particle particle =
        drawing_particle(0, (float3){0.0f, 1.2f, -1.0f}, (float3){0.0f, 0.0f, 0.0f});
    drawing_place(&f.drawing, &particle, 1, STEP);
    opaque_draw(&f, 1);
    int steps[5] = {0};
    for (int p = 0; p < PIXELS; p++) {
        const double part = (double)f.bloom.host[4 * p + 3];
        const double shown = fmin(4 * (double)f.color.host[4 * p], 1);
        assert_true(fabs(shown - shown_mean(8, 0.08, part)) < 2e-3);
        steps[(int)lround(4 * part)]++;
    }
    for (int k = 0; k < 5; k++)
        assert_true(steps[k] > 10);
    opaque_finish(&f);
}

static void order_is_no_matter(void **state)
{
    struct fixture f;
    init(&f, *state, NULL, 0);
    struct kiln_particle particles[COUNT];
    place_cloud(&f, particles);
    opaque_draw(&f, COUNT);
    float *before = malloc(PIXELS * 5 * sizeof(float));
    assert_non_null(before);
    memcpy(before, f.color.host, PIXELS * 4 * sizeof(float));
    memcpy(before + PIXELS * 4, f.depth.host, PIXELS * sizeof(float));
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&f.drawing.entries, KILN_READ_WRITE, &error);
    assert_non_null(entries);
    for (uint32_t i = 0; i < COUNT; i++)
        entries[i] = KILN_ENTRY(0, COUNT - 1 - i);
    opaque_draw(&f, COUNT);
    assert_memory_equal(before, f.color.host, PIXELS * 4 * sizeof(float));
    assert_memory_equal(before + PIXELS * 4, f.depth.host, PIXELS * sizeof(float));
    free(before);
    opaque_finish(&f);
}

/* A lit sphere reflects the light of the sky, the sun and a lamp by Lambert's law. */
static void spheres_are_lit_by_the_backdrop(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.lit=1",
        "systems.a.look.bloom=0",
        "backdrop.objects=[]",
        "backdrop.sun={direction: [3, 4, 0], color: [2, 1.5, 1]}",
        "backdrop.sky={top: [0.1, 0.2, 0.4], horizon: [0.3, 0.2, 0.1]}",
        "backdrop.lights=[{point: {position: [-1, 2, 2], color: [3, 1, 2], radius: 0.5 m}}]"};
    static const double sun[3] = {2, 1.5, 1}, top[3] = {0.1, 0.2, 0.4},
                        horizon[3] = {0.3, 0.2, 0.1};
    static const double lamp[3] = {3, 1, 2}, pi = 3.14159265;
    struct fixture f;
    init(&f, *state, overrides, 6);
    struct kiln_particle particles[COUNT];
    place_cloud(&f, particles);
    opaque_draw(&f, COUNT);
    int checked = 0;
    for (int p = 0; p < PIXELS; p++) {
        double x = p % WIDTH + 0.5, y = p / WIDTH + 0.5;
        struct meeting m = meet(&f, particles, COUNT, 0.2, x, y);
        if (m.edge_px < 1 || vec_dot(m.normal, m.normal) == 0)
            continue;
        vec point = vec_add(drawing_eye(&f.drawing), drawing_ray(&f.drawing, x, y), m.depth);
        vec towards = vec_add((vec){-1, 2, 2}, point, -1);
        double d2 = vec_dot(towards, towards);
        double lamp_cos = fmax(vec_dot(m.normal, vec_unit(towards)), 0) / (d2 + 0.25);
        double sun_cos = fmax(vec_dot(m.normal, (vec){0.6, 0.8, 0}), 0);
        for (int c = 0; c < 3; c++) {
            double sky = horizon[c] + (top[c] - horizon[c]) * (0.5 + 0.5 * m.normal.y);
            double color = ALBEDO[c] * (sky + lamp[c] * lamp_cos + sun[c] * sun_cos / pi);
            assert_true(fabs((double)f.color.host[4 * p + c] - color) < 2e-3 * (1 + color));
        }
        checked++;
    }
    assert_true(checked > 3000);
    opaque_finish(&f);
}

/* The light that a hot sphere emits is added to its colour and, in the same amount, to the image
 * that feeds the bloom. */
static void hot_spheres_shine(void **state)
{
    static const char *const overrides[] = {"systems.a.look.temperature=1500 K",
                                            "systems.a.look.intensity=5"};
    struct fixture f[2];
    double red[2] = {0}, bloom[2] = {0};
    for (size_t i = 0; i < 2; i++) {
        init(&f[i], *state, overrides, i * 2);
        struct kiln_particle particles[COUNT];
        place_cloud(&f[i], particles);
        opaque_draw(&f[i], COUNT);
        for (int p = 0; p < PIXELS; p++) {
            if (f[i].bloom.host[4 * p + 3] < 1.0f)
                continue; /* edges, where bright samples weigh less, are left out */
            red[i] += (double)f[i].color.host[4 * p];
            bloom[i] += (double)f[i].bloom.host[4 * p];
        }
        opaque_finish(&f[i]);
    }
    assert_true(red[1] > 1.2 * red[0] && bloom[1] > 2 * bloom[0]);
    assert_true(fabs((red[1] - red[0]) - (bloom[1] - bloom[0])) < 0.01 * red[1]);
}

/* A sphere that contains the camera is not drawn. A sphere with an opacity of 0 is not drawn, since
 * opacity scales its size. */
static void no_sphere_fills_the_picture(void **state)
{
    static const char *const gone[] = {"systems.a.look.opacity=0"};
    for (size_t i = 0; i < 2; i++) {
        struct fixture f;
        init(&f, *state, gone, i);
        const float3 near = {0.5f, 1.45f, 2.85f}, far = {0.0f, 0.8f, 0.0f};
        struct kiln_particle particle =
            drawing_particle(0, i ? far : near, (float3){0.0f, 0.0f, 0.0f});
        drawing_place(&f.drawing, &particle, 1, STEP);
        opaque_draw(&f, 1);
        assert_memory_equal(f.color.host, f.drawing.backdrop_color.host,
                            PIXELS * 4 * sizeof(float));
        assert_memory_equal(f.depth.host, f.drawing.backdrop_depth.host, PIXELS * sizeof(float));
        opaque_finish(&f);
    }
}

/* Returns the vector v of the world in the axes of a ball. pose: the ball's rotation, a unit
 * quaternion. */
static vec into_ball(float4 pose, vec v)
{
    const vec u = {-(double)pose.x, -(double)pose.y, -(double)pose.z};
    const vec twice = vec_add((vec){0}, vec_cross(u, v), 2);
    return vec_add(vec_add(v, twice, (double)pose.w), vec_cross(u, twice), 1);
}

/* Returns 1 where a ball shows the second colour of its pattern, 0 where it shows its own colour,
 * and 0.5 near the edge between the two. n: unit vector from the ball's centre, in the ball's axes;
 * stripe: the pattern is `stripe`, otherwise `segments` with three segments of each colour. */
static double other_part(vec n, bool stripe)
{
    const double high = fabs(n.y), lune = sin(3 * atan2(n.z, n.x)) * hypot(n.x, n.z) / 3;
    const double distance = stripe ? high - 0.42 : fmax(lune, (high - 0.94) * 2);
    return distance > 0.06 ? 1 : distance < -0.06 ? 0 : 0.5;
}

/* Sets the rotation of the particle in slot 5 to a unit quaternion. */
static void place_turned(struct fixture *f, float4 pose)
{
    struct kiln_error error = {0};
    struct kiln_spin *spins = pool_give_spins(&f->drawing.pool);
    spins[5].pose =
        (uint4){FLOAT_BITS(pose.x), FLOAT_BITS(pose.y), FLOAT_BITS(pose.z), FLOAT_BITS(pose.w)};
    assert_true(kiln_moment_fill(&f->drawing.moment, &f->drawing.pool, kiln_instant_at_step(STEP),
                                 true, &error));
}

/* The pattern of a ball that collisions have rotated is drawn with that rotation. */
static void patterns_turn_with_the_ball(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.sphere={pattern: segments, color: [0.1, 0.9, 0.7]}",
        "systems.a.interact=[{collide: {radius: 20 cm, spin: true}}]", "backdrop.objects=[]",
        "systems.a.look.sphere.pattern=stripe"};
    static const double other[3] = {0.1, 0.9, 0.7};
    const float4 pose = {0.48f, -0.6f, 0.0f, 0.64f};
    for (size_t stripe = 0; stripe < 2; stripe++) {
        struct fixture f;
        init(&f, *state, overrides, 3 + stripe);
        struct kiln_particle particles[6] = {0};
        particles[5] = drawing_particle(5, (float3){0.1f, 0.9f, 1.5f}, (float3){0.0f, 0.0f, 0.0f});
        drawing_place(&f.drawing, particles, 6, STEP);
        place_turned(&f, pose);
        opaque_draw(&f, 6);
        int shown[2] = {0, 0};
        for (int p = 0; p < PIXELS; p++) {
            const struct meeting m =
                meet(&f, particles + 5, 1, 0.2, p % WIDTH + 0.5, p / WIDTH + 0.5);
            if (m.edge_px < 2 || vec_dot(m.normal, m.normal) == 0)
                continue;
            const double part = other_part(into_ball(pose, m.normal), stripe);
            for (int c = 0; c < 3 && part != 0.5; c++) {
                const double color = part > 0 ? other[c] : ALBEDO[c];
                assert_true(fabs((double)f.color.host[4 * p + c] - color) < 1e-3);
            }
            shown[part > 0] += part != 0.5;
        }
        assert_true(shown[0] > 100 && shown[1] > 100);
        opaque_finish(&f);
    }
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(depth_is_where_the_ray_meets_a_sphere),
        test_on_device(silhouettes_are_smooth),
        test_on_device(spheres_below_a_pixel_are_fainter),
        test_on_device(bright_edges_have_all_steps),
        test_on_device(order_is_no_matter),
        test_on_device(spheres_are_lit_by_the_backdrop),
        test_on_device(hot_spheres_shine),
        test_on_device(no_sphere_fills_the_picture),
        test_on_device(patterns_turn_with_the_ball),
    };
    return backdrops_run("spheres", tests, sizeof tests / sizeof *tests, true, argc, argv);
}
