/* Checks the shadows that spheres, meshes and objects cast in sunlight on the floor, on spheres and
 * on smoke, against rays or projected corners. If this fails, shadows lie in wrong places, or are
 * cut off, too dark or too hard. `tools/test --all` runs the tests with each technique of the
 * backdrop, `tools/test` with `cpu` alone. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include "draw/light/lighting.h"
#include "draw/solids/solids.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"
#include "support/errors.h"
#include "support/pools.h"

enum { WIDTH = 160, HEIGHT = 90, STEP = 30 };

/* The camera looks down at a white floor that only the sun lights, with an irradiance of pi. So
 * sunlit pixels have the value 0.8, the cosine between the sun and the floor's normal. */
#define HEAD                                                                                       \
    "kiln: 1\n"                                                                                    \
    "output: {size: [160, 90], fps: 60}\n"                                                         \
    "camera: {position: [0, 8, 0.1], target: [0, 0, 0], fov: 40 deg}\n"
#define SUN                                                                                        \
    "  haze: 0\n"                                                                                  \
    "  sky: {top: 0, horizon: 0}\n"                                                                \
    "  floor: {color: 1}\n"                                                                        \
    "  sun: {direction: [-3, 4, 0], color: 3.14159265}\n"
#define SPHERES                                                                                    \
    "systems:\n"                                                                                   \
    "  a:\n"                                                                                       \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {shape: sphere, size: 0.6 m, color: 1, lit: 1, fade: {in: 0, out: 0}}\n"

/* Tetrahedra with three edges of length EDGE at right angles, turned about y by 40 degrees. */
#define TETRAHEDRA                                                                                 \
    "systems:\n"                                                                                   \
    "  a:\n"                                                                                       \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj, orient: upright}, size: 0.9 m,\n"       \
    "           rotation: [40 deg, 40 deg], color: 1, lit: 1, fade: {in: 0, out: 0}}\n"

static const double RADIUS = 0.3, EDGE = 0.9; /* of spheres and of meshes, m */
static const vec TOWARDS = {-0.6, 0.8, 0};    /* unit direction to the sun */

struct fixture {
    struct drawing drawing;
    struct kiln_threads *threads;
    struct kiln_lighting_stage *lighting;
    struct kiln_solids_stage *solids; /* NULL: the particles are billboards */
    struct kiln_image color, depth, bloom;
};

static void init(struct fixture *f, struct kiln_device *device, const char *text,
                 const char *override)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    *f = (struct fixture){.solids = NULL};
    drawing_init(d, device, text, &override, override ? 1 : 0);
    kiln_image_init(&f->color, device, WIDTH, HEIGHT, GL_RGBA32F, "scene");
    kiln_image_init(&f->depth, device, WIDTH, HEIGHT, GL_R32F, "scene depth");
    kiln_image_init(&f->bloom, device, WIDTH, HEIGHT, GL_RGBA32F, "sphere bloom");
    const struct kiln_solids_params params = {
        .backdrop = d->backdrop,
        .threads = d->threads,
        .targets = {&d->backdrop_color, &d->backdrop_depth, &f->color, &f->depth, &f->bloom},
    };
    f->threads = kiln_threads_create(2);
    assert_non_null(f->threads);
    f->lighting = kiln_lighting_create(device, &d->moment, f->threads, &error);
    if (!f->lighting)
        fail_msg("%s", error.message);
    if (!kiln_look_is_opaque(&d->scene->systems[0].look))
        return;
    f->solids = kiln_solids_create(device, &d->moment, &params, &error);
    if (!f->solids)
        fail_msg("%s", error.message);
}

static void finish(struct fixture *f)
{
    kiln_solids_destroy(&f->solids);
    kiln_lighting_destroy(&f->lighting);
    kiln_threads_destroy(&f->threads);
    kiln_image_finish(&f->color);
    kiln_image_finish(&f->depth);
    kiln_image_finish(&f->bloom);
    drawing_finish(&f->drawing);
}

/* Draws the backdrop into drawing.backdrop_color, and particles at `places`, m: solids over the
 * backdrop into color and depth, billboards into drawing.color. */
static void draw(struct fixture *f, const vec *places, uint32_t count)
{
    struct kiln_error error = {0};
    struct drawing *d = &f->drawing;
    struct kiln_particle particles[32] = {0};
    for (uint32_t i = 0; i < count; i++) {
        const float3 at = {(float)places[i].x, (float)places[i].y, (float)places[i].z};
        particles[i] = drawing_particle(i, at, (float3){0.0f, 0.0f, 0.0f});
    }
    drawing_place(d, particles, count, STEP);
    d->pool.systems[0].next_serial = count;
    if (!kiln_lighting_run(f->lighting, &d->moment, NULL, &d->lighting, &error) ||
        !kiln_backdrop_draw(d->backdrop, &d->moment, &d->lighting, &error))
        fail_msg("%s", error.message);
    if (!f->solids)
        drawing_run(d, count, 100.0f);
    else if (!kiln_solids_draw(f->solids, &d->moment, &d->entries, count, &error))
        fail_msg("%s", error.message);
    assert_non_null(kiln_image_host(&d->backdrop_color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->depth, KILN_READ, &error));
}

/* Returns the point at which the ray through a pixel's middle meets the floor. */
static vec floor_at(const struct drawing *d, int x, int y)
{
    vec eye = drawing_eye(d), ray = drawing_ray(d, x + 0.5, y + 0.5);
    return vec_add(eye, ray, -eye.y / ray.y);
}

enum { SUN_RAYS = 300 };
static vec sun_rays[SUN_RAYS]; /* unit vectors to all parts of the sun's disc */

/* Spreads sun_rays evenly over the sun's disc. sun_radius: its angular radius, rad. */
static void aim_at_sun(double sun_radius)
{
    const vec right = {0.8, 0.6, 0}, up = {0, 0, 1};
    for (int i = 0; i < SUN_RAYS; i++) {
        double r = tan(sun_radius) * sqrt((i + 0.5) / SUN_RAYS), turn = 2.39996323 * i;
        sun_rays[i] = vec_unit(vec_add(vec_add(TOWARDS, right, r * cos(turn)), up, r * sin(turn)));
    }
}

/* Returns the fraction, 0 to 1, of the sun's disc that a point sees past spheres. */
static double sun_seen(vec point, const vec *places, uint32_t count)
{
    int seen = 0;
    for (int i = 0; i < SUN_RAYS; i++) {
        const vec ray = sun_rays[i];
        bool hidden = false;
        for (uint32_t k = 0; k < count && !hidden; k++) {
            vec to = vec_add(places[k], point, -1);
            double t = vec_dot(to, ray);
            vec away = vec_add(to, ray, -t);
            hidden = t > 0 && vec_dot(away, away) < RADIUS * RADIUS;
        }
        seen += !hidden;
    }
    return (double)seen / SUN_RAYS;
}

/* Compares the sunlight on the floor with rays. Returns the number of pixels in penumbra.
 * sun_radius: angular, rad; tolerance: the largest absolute difference; full sunlight is 1. */
static int check_floor(const struct fixture *f, const vec *places, uint32_t count,
                       double sun_radius, double tolerance)
{
    const struct drawing *d = &f->drawing;
    int dark = 0, partly = 0, compared = 0, wrong = 0;
    aim_at_sun(sun_radius);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            vec at = floor_at(d, x, y);
            double expected = sun_seen(at, places, count);
            double found = (double)d->backdrop_color.host[4 * (y * WIDTH + x)] / 0.8;
            partly += found > 0.05 && found < 0.95;
            dark += found < 0.05;
            bool even = true; /* false at sharp edges, where a pixel is the mean of 4 samples */
            for (int k = 0; k < 4; k++) {
                vec aside = {at.x + (k & 1 ? 0.05 : -0.05), 0, at.z + (k & 2 ? 0.05 : -0.05)};
                even = even && fabs(sun_seen(aside, places, count) - expected) < 0.5;
            }
            if (!even)
                continue;
            compared++;
            wrong += fabs(found - expected) > tolerance;
        }
    }
    if (wrong > WIDTH * HEIGHT / 1000) /* some gaps between shadows are finer than pixels */
        fail_msg("%d of %d pixels are wrong", wrong, compared);
    assert_true(compared > WIDTH * HEIGHT * 3 / 4);
    assert_true(dark > 20 || sun_radius > 0.1);
    return partly;
}

/* A sphere 2 m above the floor must cast its shadow 1.5 m aside, and a larger sun must widen the
 * shadow's penumbra. */
static void the_shadow_of_a_sphere_lies_where_geometry_says(void **state)
{
    static const char *const sizes[] = {NULL, "backdrop.sun.size=4 deg", "backdrop.sun.size=12 deg",
                                        "backdrop.sun.size=24 deg"};
    static const double degrees[] = {0, 4, 12, 24};
    const vec place = {0, 2, 0};
    int penumbra[4];
    for (int i = 0; i < 4; i++) {
        struct fixture f;
        init(&f, *state, HEAD "backdrop:\n" SUN SPHERES, sizes[i]);
        draw(&f, &place, 1);
        penumbra[i] = check_floor(&f, &place, 1, degrees[i] / 2 * acos(-1.0) / 180, 0.06);
        /* The middle of the shadow is black unless the sun looks larger than the sphere. */
        vec middle = drawing_project(&f.drawing, (vec){1.5, 0, 0});
        size_t pixel = (size_t)middle.y * WIDTH + (size_t)middle.x;
        assert_true(degrees[i] > 20 || f.drawing.backdrop_color.host[4 * pixel] < 0.01f);
        finish(&f);
    }
    assert_true(penumbra[1] > penumbra[0] && penumbra[2] > 2 * penumbra[1]);
    assert_true(penumbra[3] > penumbra[2]);
}

/* The axes of the mesh in the world: turned about y by 40 degrees (UPRIGHT), and turned by the
 * quaternion POSE (POSED). */
static const vec UPRIGHT[3] = {
    {0.766044443, 0, -0.642787610}, {0, 1, 0}, {0.642787610, 0, 0.766044443}};
static const double POSE[4] = {0.48, -0.6, 0.0, 0.64};
static const vec POSED[3] = {
    {0.28, -0.576, 0.768}, {-0.576, 0.5392, 0.6144}, {-0.768, -0.6144, -0.1808}};

/* Returns whether the tetrahedron about `middle` hides the sun's centre from `place`. */
static bool is_behind(vec place, vec middle, const vec axes[3])
{
    double x[5], y[5];
    for (int k = 0; k < 5; k++) {
        vec at = k == 4 ? place : middle;
        for (int axis = 0; axis < 3 && k < 4; axis++)
            at = vec_add(at, axes[axis], k == axis + 1 ? EDGE / 2 : -EDGE / 2);
        x[k] = 0.8 * at.x + 0.6 * at.y;
        y[k] = at.z;
    }
    for (int face = 0; face < 4; face++) {
        bool left = true, right = true;
        for (int k = 0; k < 3; k++) {
            const int a = (face + k) % 4, b = (face + (k + 1) % 3) % 4;
            const double side = (x[b] - x[a]) * (y[4] - y[a]) - (y[b] - y[a]) * (x[4] - x[a]);
            left = left && side >= 0;
            right = right && side <= 0;
        }
        if (left || right)
            return true;
    }
    return false;
}

/* Returns how much sunlight the floor lacks, summed over all pixels; 1 is a black pixel. */
static double darkness(const struct fixture *f)
{
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        sum += 1 - (double)f->drawing.backdrop_color.host[4 * i] / 0.8;
    return sum;
}

/* Fails unless the floor is dark exactly where the tetrahedron hides the sun. Skips edge pixels. */
static void check_shape(const struct fixture *f, vec place, const vec axes[3])
{
    int dark = 0;
    for (int p = 0; p < WIDTH * HEIGHT; p++) {
        const vec at = floor_at(&f->drawing, p % WIDTH, p / WIDTH);
        const bool behind = is_behind(at, place, axes);
        bool even = true;
        for (int n = 0; n < 4; n++) {
            const vec aside = {at.x + (n & 1 ? 0.05 : -0.05), 0, at.z + (n & 2 ? 0.05 : -0.05)};
            even = even && is_behind(aside, place, axes) == behind;
        }
        const double found = (double)f->drawing.backdrop_color.host[4 * p] / 0.8;
        assert_true(!even || fabs(found - (behind ? 0 : 1)) < 0.08); /* thin tips are blurred */
        dark += even && behind;
    }
    assert_true(dark > 30);
}

/* With a sun of no size the shadow must have the mesh's shape. A sun of 8 degrees must blur it and
 * keep its total darkness within 2 %. For 30 degrees, where a sphere stands for the mesh
 * (lib/draw/light/solid_shadow.h), the total must stay within 20 %. */
static void the_shadow_of_a_mesh_has_its_shape(void **state)
{
    static const char *const suns[] = {NULL, "backdrop.sun.size=8 deg", "backdrop.sun.size=30 deg"};
    const vec place = {0, 2, 0};
    double lost[3];
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    for (int k = 0; k < 3; k++) {
        struct fixture f;
        init(&f, *state, HEAD "backdrop:\n" SUN TETRAHEDRA, suns[k]);
        draw(&f, &place, 1);
        lost[k] = darkness(&f);
        if (k == 0)
            check_shape(&f, place, UPRIGHT);
        finish(&f);
        assert_true(fabs(lost[k] - lost[0]) < (k == 2 ? 0.2 : 0.02) * lost[0]);
    }
    drawing_asset_root = NULL;
}

/* A mesh that collisions have turned must cast the shadow of its turned shape. */
static void the_shadow_of_a_mesh_turns_with_it(void **state)
{
    const vec place = {0, 2, 0};
    struct fixture f;
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    init(&f, *state, HEAD "backdrop:\n" SUN TETRAHEDRA, "systems.a.look.mesh.orient=spin");
    struct kiln_spin *spins = pool_give_spins(&f.drawing.pool);
    spins[0].pose = (uint4){FLOAT_BITS((float)POSE[0]), FLOAT_BITS((float)POSE[1]),
                            FLOAT_BITS((float)POSE[2]), FLOAT_BITS((float)POSE[3])};
    draw(&f, &place, 1);
    check_shape(&f, place, POSED);
    finish(&f);
    drawing_asset_root = NULL;
}

/* The bins that list meshes must not cut shadows off. A second mesh, 900 m away, makes all bins
 * larger; it must change no pixel by more than 1e-4. */
static void the_soft_shadow_of_a_mesh_is_whole(void **state)
{
    static const char *const suns[] = {"backdrop.sun.size=4 deg", "backdrop.sun.size=16 deg"};
    const vec places[] = {{0, 2, 0}, {0, 2, 900}};
    const size_t values = (size_t)WIDTH * HEIGHT * 4;
    float *alone = malloc(values * sizeof *alone);
    assert_non_null(alone);
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    for (int k = 0; k < 2; k++) {
        struct fixture f;
        init(&f, *state, HEAD "backdrop:\n" SUN TETRAHEDRA, suns[k]);
        draw(&f, places, 1);
        memcpy(alone, f.drawing.backdrop_color.host, values * sizeof *alone);
        draw(&f, places, 2);
        double most = 0;
        for (size_t i = 0; i < values; i++)
            most = fmax(most, fabs((double)alone[i] - (double)f.drawing.backdrop_color.host[i]));
        if (most > 1e-4)
            fail_msg("%g of the light is cut off", most);
        finish(&f);
    }
    drawing_asset_root = NULL;
    free(alone);
}

/* Each of too many meshes for silhouettes must cast the shadow of a sphere whose cross
 * section is the mesh's mean projected area over all poses: a quarter of its surface. */
static void meshes_that_are_too_many_have_round_shadows(void **state)
{
    const vec place = {0, 2, 0};
    const double surface = (1.5 + 0.5 * sqrt(3)) * EDGE * EDGE, pixel = 16 * tan(acos(-1.0) / 9);
    const double expected = surface / 4 / 0.8 / (pixel * pixel) * HEIGHT * HEIGHT;
    struct fixture f;
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    init(&f, *state, HEAD "backdrop:\n" SUN TETRAHEDRA, "systems.a.emit.rate=20000");
    draw(&f, &place, 1);
    assert_true(fabs(darkness(&f) - expected) < 0.03 * expected);
    finish(&f);
    drawing_asset_root = NULL;
}

/* All of 24 spheres must cast shadows, several of them from one bin. Their visible fractions are
 * multiplied, which is exact outside of penumbras. */
static void spheres_of_a_cloud_all_throw_shadows(void **state)
{
    struct fixture f;
    init(&f, *state, HEAD "backdrop:\n" SUN SPHERES, "backdrop.sun.size=0.2 deg");
    vec places[24];
    srand(3);
    for (int i = 0; i < 24; i++)
        places[i] =
            (vec){rand() % 600 * 0.01 - 3.5, 0.4 + rand() % 200 * 0.01, rand() % 400 * 0.01 - 2};
    draw(&f, places, 24);
    check_floor(&f, places, 24, 0.1 * acos(-1.0) / 180, 0.25);
    float *before = malloc(WIDTH * HEIGHT * 4 * sizeof *before);
    assert_non_null(before);
    memcpy(before, f.drawing.backdrop_color.host, WIDTH * HEIGHT * 4 * sizeof *before);
    draw(&f, places, 1); /* the stage must not keep the picture with more shadows */
    check_floor(&f, places, 1, 0.1 * acos(-1.0) / 180, 0.25);
    draw(&f, places, 24);
    assert_memory_equal(before, f.drawing.backdrop_color.host, WIDTH * HEIGHT * 4 * sizeof *before);
    free(before);
    finish(&f);
}

/* Draws the backdrop with a sphere's shadow. `buried` more spheres below the floor, in line with
 * the shadow, come first in the bins' lists and shade nothing. Returns false with an error. */
static bool draw_buried(struct fixture *f, uint32_t buried, struct kiln_error *error)
{
    struct drawing *d = &f->drawing;
    struct kiln_particle *particles = malloc((buried + 1) * sizeof *particles);
    assert_non_null(particles);
    const float3 still = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < buried; i++)
        particles[i] = drawing_particle(i, (float3){3.0f, -2.0f, 0.0f}, still);
    particles[buried] = drawing_particle(buried, (float3){0.0f, 2.0f, 0.0f}, still);
    drawing_place(d, particles, buried + 1, STEP);
    free(particles);
    d->pool.systems[0].next_serial = buried + 1;
    bool ok = kiln_lighting_run(f->lighting, &d->moment, NULL, &d->lighting, error) &&
              kiln_backdrop_draw(d->backdrop, &d->moment, &d->lighting, error);
    return ok && kiln_image_host(&d->backdrop_color, KILN_READ, error);
}

/* A bin's list of 52001 spheres must be read to its end. A list of 60001 needs more loop iterations
 * than llvmpipe runs (KILN_SOFTWARE_ITERATIONS); there backdrop=gl must report an error. */
static void a_list_of_spheres_may_be_long(void **state)
{
    const struct kiln_device *device = *state;
    struct kiln_error error = {0};
    struct fixture f;
    const size_t bytes = (size_t)WIDTH * HEIGHT * 4 * sizeof(float);
    float *alone = malloc(bytes);
    assert_non_null(alone);
    drawing_most = 60001;
    init(&f, *state, HEAD "backdrop:\n" SUN SPHERES, NULL);
    assert_true(draw_buried(&f, 0, &error));
    memcpy(alone, f.drawing.backdrop_color.host, bytes);
    assert_true(draw_buried(&f, 52000, &error));
    double most = 0;
    for (size_t i = 0; i < bytes / sizeof(float); i++)
        most = fmax(most, fabs((double)alone[i] - (double)f.drawing.backdrop_color.host[i]));
    assert_true(most < 1e-3);
    bool drew = draw_buried(&f, 60000, &error);
    assert_int_equal(drew, !device->info.software || backdrop_technique == KILN_BACKDROP_CPU);
    if (!drew)
        expect_error(&error, KILN_DEVICE_FAILED,
                     "backdrop=gl: 60001 particles may shade one place; software GL draws at most "
                     "52288: use --technique backdrop=cpu, or fewer particles");
    finish(&f);
    drawing_most = 32;
    free(alone);
}

/* Returns the red light of the pixel at which the middle of the sphere at `place` is projected. */
static double light_of(const struct fixture *f, vec place)
{
    vec at = drawing_project(&f->drawing, place);
    size_t pixel = (size_t)at.y * WIDTH + (size_t)at.x;
    assert_true((double)f->depth.host[pixel] < at.z); /* the sphere is drawn */
    return (double)f->color.host[4 * pixel];
}

/* The second sphere must be dark in the first one's shadow, and the third bright beside it. */
static void spheres_shade_each_other(void **state)
{
    const vec places[] = {{-0.75, 2, 0}, {0.375, 0.5, 0}, {0.375, 0.5, 1.5}};
    struct fixture f;
    init(&f, *state, HEAD "backdrop:\n" SUN SPHERES, NULL);
    draw(&f, places, 3);
    assert_true(light_of(&f, places[0]) > 0.6 && light_of(&f, places[2]) > 0.6);
    assert_true(light_of(&f, places[1]) < 0.01);
    finish(&f);
}

/* For each kind of object, a sphere in its shadow must be dark, and a sphere beside it bright. */
static void the_backdrop_shades_spheres(void **state)
{
    static const char *const objects[] = {
        "backdrop.objects=[{box: {center: [-1, 1, 0], size: [0.4, 2, 1]}}]",
        "backdrop.objects=[{sphere: {center: [-1, 1.7, 0], radius: 0.8 m}}]",
        "backdrop.objects=[{cylinder: {center: [-1, 1, 0], radius: 0.5 m, height: 2 m}}]"};
    const vec places[] = {{-0.3, 0.5, 0}, {-0.3, 0.5, 2}};
    for (int i = 0; i < 3; i++) {
        struct fixture f;
        init(&f, *state, HEAD "backdrop:\n" SUN SPHERES, objects[i]);
        draw(&f, places, 2);
        assert_true(light_of(&f, places[0]) < 0.01);
        assert_true(light_of(&f, places[1]) > 0.6);
        finish(&f);
    }
}

/* Returns the fraction of the sun's disc, 6 degrees wide, that a point sees past the box below. */
static double sun_seen_past_box(vec point)
{
    enum { RAYS = 400 };
    const vec right = {0.8, 0.6, 0}, up = {0, 0, 1};
    const double low[3] = {-0.5, 2, -0.7}, high[3] = {0.5, 2.6, 0.7};
    int seen = 0;
    for (int i = 0; i < RAYS; i++) {
        double r = tan(3 * acos(-1.0) / 180) * sqrt((i + 0.5) / RAYS), turn = 2.39996323 * i;
        vec ray = vec_unit(vec_add(vec_add(TOWARDS, right, r * cos(turn)), up, r * sin(turn)));
        const double from[3] = {point.x, point.y, point.z}, way[3] = {ray.x, ray.y, ray.z};
        double in = 0, out = 1e9;
        for (int k = 0; k < 3; k++) {
            double a = (low[k] - from[k]) / way[k], b = (high[k] - from[k]) / way[k];
            in = fmax(in, fmin(a, b));
            out = fmin(out, fmax(a, b));
        }
        seen += in >= out;
    }
    return (double)seen / RAYS;
}

/* On all four sides of a box's shadow, the sunlight in the penumbra must match rays to within 0.13.
 * Corners are left out, since there the covers of two edges are multiplied. */
static void penumbras_of_a_box_match_rays(void **state)
{
    static const char text[] =
        HEAD "backdrop:\n"
             "  haze: 0\n"
             "  sky: {top: 0, horizon: 0}\n"
             "  floor: {color: 1}\n"
             "  sun: {direction: [-3, 4, 0], color: 3.14159265, size: 6 deg}\n"
             "  objects: [{box: {center: [0, 2.3, 0], size: [1, 0.6, 1.4]}}]\n" SPHERES;
    struct fixture f;
    init(&f, *state, text, NULL);
    draw(&f, NULL, 0);
    /* Crosses the shadow's edges, at z = +-0.7, x = 1 and x = 2.45, 15 cm to each side. */
    for (int i = 0; i < 44; i++) {
        double across = (i % 11 - 5) * 0.03;
        const vec sides[] = {{1.7, 0, 0.7 + across}, {1.7, 0, -0.7 - across}};
        const vec ends[] = {{1 + across, 0, 0}, {2.45 - across, 0, 0}};
        vec place = i < 22 ? sides[i / 11] : ends[i / 11 - 2];
        vec at = drawing_project(&f.drawing, place);
        place = floor_at(&f.drawing, (int)at.x, (int)at.y);
        size_t pixel = (size_t)at.y * WIDTH + (size_t)at.x;
        double found = (double)f.drawing.backdrop_color.host[4 * pixel] / 0.8;
        if (fabs(found - sun_seen_past_box(place)) > 0.13)
            fail_msg("at (%g, %g) %g of the sun is seen, not %g", place.x, place.z, found,
                     sun_seen_past_box(place));
    }
    finish(&f);
}

/* Under a zenith sun a cylinder's shadow must be round: the floor 1.1 m from the axis is bright. */
static void a_cylinder_is_round_from_above(void **state)
{
    static const char text[] =
        HEAD "backdrop:\n"
             "  haze: 0\n"
             "  sky: {top: 0, horizon: 0}\n"
             "  floor: {color: 1}\n"
             "  sun: {direction: [0, 1, 0], color: 3.14159265, size: 2 deg}\n"
             "  objects:\n"
             "    - cylinder: {center: [0, 0.5, 0], radius: 0.7 m, height: 0.4 m}\n" SPHERES;
    struct fixture f;
    init(&f, *state, text, NULL);
    draw(&f, NULL, 0);
    for (int i = 0; i < 8; i++) {
        double turn = 0.8 * i;
        vec at = drawing_project(&f.drawing, (vec){1.1 * cos(turn), 0, 1.1 * sin(turn)});
        size_t pixel = (size_t)at.y * WIDTH + (size_t)at.x;
        assert_true(f.drawing.backdrop_color.host[4 * pixel] > 0.99f);
    }
    finish(&f);
}

#define SMOKE                                                                                      \
    "systems:\n"                                                                                   \
    "  a:\n"                                                                                       \
    "    emit: {life: 1 s}\n"                                                                      \
    "    look: {size: 0.4 m, color: 1, lit: 1, soft: 0, fade: {in: 0, out: 0}}\n"

/* Smoke must be dark in an object's shadow, bright before and beside it, half lit at its edge. */
static void the_backdrop_shades_smoke(void **state)
{
    static const char *const objects[] = {
        NULL, "backdrop.objects=[{box: {center: [-1, 1, 0], size: [0.4, 2, 1]}}]",
        "backdrop.objects=[{mesh: {file: pot.obj, position: [-1, 1.2, 0], scale: 4}}]"};
    const vec places[] = {{-0.3, 0.6, 0}, {-2, 1, 0}, {-0.3, 0.6, 1.6}, {-0.3, 0.6, 0.5}};
    double light[3][4];
    for (int i = 0; i < 3; i++) {
        struct fixture f;
        init(&f, *state, HEAD "backdrop:\n" SUN SMOKE, objects[i]);
        draw(&f, places, 4);
        for (int k = 0; k < 4; k++) {
            vec at = drawing_project(&f.drawing, places[k]);
            size_t pixel = (size_t)at.y * WIDTH + (size_t)at.x;
            light[i][k] = (double)f.drawing.color.host[4 * pixel + 2]; /* the texture's blue is 1 */
        }
        finish(&f);
    }
    for (int i = 1; i < 3; i++) {
        assert_true(light[0][0] > 0.1 && light[i][0] < 0.1 * light[0][0]);
        assert_true(fabs(light[i][1] - light[0][1]) < 0.02 * light[0][1]);
        assert_true(fabs(light[i][2] - light[0][2]) < 0.02 * light[0][2]);
    }
    assert_true(light[1][3] > 0.3 * light[0][3] && light[1][3] < 0.7 * light[0][3]);
}

int main(int argc, char **argv)
{
    if (chdir(KILN_SOURCE_DIR "/scenes/meshes") != 0)
        return 1;
    static const struct CMUnitTest tests[] = {
        test_on_device(the_shadow_of_a_sphere_lies_where_geometry_says),
        test_on_device(the_shadow_of_a_mesh_has_its_shape),
        test_on_device(the_shadow_of_a_mesh_turns_with_it),
        test_on_device(the_soft_shadow_of_a_mesh_is_whole),
        test_on_device(meshes_that_are_too_many_have_round_shadows),
        test_on_device(spheres_of_a_cloud_all_throw_shadows),
        test_on_device(a_list_of_spheres_may_be_long),
        test_on_device(spheres_shade_each_other),
        test_on_device(the_backdrop_shades_spheres),
        test_on_device(a_cylinder_is_round_from_above),
        test_on_device(the_backdrop_shades_smoke),
        test_on_device(penumbras_of_a_box_match_rays),
    };
    return backdrops_run("shadows", tests, sizeof tests / sizeof *tests, true, argc, argv);
}
