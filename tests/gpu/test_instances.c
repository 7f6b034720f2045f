/* Checks particles that are drawn as meshes (lib/draw/solids/solids.c) against rays that are
 * intersected with the mesh's triangles in double precision: orientation, depth, silhouettes and
 * light. Also checks that the techniques in GL and in C agree, and that order, threads and SIMD
 * level change nothing. If this fails, meshes fly sideways, have holes or wrong shading, or depend
 * on the machine. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "base/simd.h"
#include "shared/derived.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/opaque.h"
#include "support/pools.h"

enum { STEP = 30, COUNT = 24 };

/* The mesh, tests/mutation/tetrahedron.obj, has the corners (0 0 0), (1 0 0), (0 1 0), (0 0 1). */
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
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj}, size: 1.6 m, scale: 0.5,\n"
    "           lit: 0, fade: {in: 0, out: 0}, color: [0.8, 0.4, 0.2], bloom: [1, 0.5, 0]}\n";

/* The mesh's scale, m per unit of the file (size * scale), and its colour. */
static const double SIZE = 0.8, ALBEDO[3] = {0.8, 0.4, 0.2};

static void init(struct fixture *f, struct kiln_device *device, const char *const *overrides,
                 size_t count)
{
    drawing_asset_root = KILN_SOURCE_DIR "/tests/mutation";
    opaque_init(f, device, SCENE, overrides, count);
}

static float within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

static void place_cloud(struct fixture *f, struct kiln_particle *particles, uint32_t count)
{
    srand(11);
    for (uint32_t i = 0; i < count; i++) {
        float3 position = {within(-2.0f, 2.0f), within(0.0f, 2.0f), within(-1.0f, 1.5f)};
        float3 velocity = {within(-1.0f, 1.0f), within(-1.0f, 1.0f), within(-1.0f, 1.0f)};
        particles[i] = drawing_particle(i, position, velocity);
    }
    drawing_place(&f->drawing, particles, count, STEP);
}

/* ---- the reference in doubles ---------------------------------------------------------------- */

/* Holds a tetrahedron in the world, m. middle: the position of its particle. */
struct solid {
    vec corners[4], middle;
};

/* Returns the tetrahedron of a particle. axes: the unit directions of the mesh's x, y and z. The
 * middle of the mesh's bounding box, (0.5, 0.5, 0.5), lies at the particle. */
static struct solid solid_of(vec at, const vec axes[3])
{
    struct solid s = {.middle = at};
    for (int k = 0; k < 4; k++) {
        s.corners[k] = at;
        for (int i = 0; i < 3; i++)
            s.corners[k] = vec_add(s.corners[k], axes[i], SIZE * ((k == i + 1 ? 1.0 : 0.0) - 0.5));
    }
    return s;
}

/* Returns the view depth, m, at which a ray from the eye enters a tetrahedron beyond the near
 * plane, or 1e9 for a miss. *side becomes the index of the face, unless the ray misses. */
static double enter(const struct solid *s, vec eye, vec ray, int *side)
{
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    double nearest = 1e9;
    for (int i = 0; i < 4; i++) {
        vec p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vec_add(s->corners[faces[i][k]], eye, -1);
        vec normal = vec_cross(vec_add(p[1], p[0], -1), vec_add(p[2], p[0], -1));
        double t = vec_dot(p[0], normal) / vec_dot(ray, normal);
        bool inside = t > 0.1 && t < nearest;
        for (int k = 0; k < 3; k++) {
            vec hit = vec_add((vec){0}, ray, t), edge = vec_add(p[(k + 1) % 3], p[k], -1);
            inside &= vec_dot(vec_cross(edge, vec_add(hit, p[k], -1)), normal) >= 0;
        }
        if (inside) {
            nearest = t;
            *side = i;
        }
    }
    return nearest;
}

/* Draws one particle and fails unless it matches its tetrahedron, whose unit axes are given. Depth
 * and colour are compared in pixels in which all of 17 rays meet the same face or all miss. The
 * area that the particle covers in the picture is compared, too. */
static void check_solid(struct fixture *f, const struct kiln_particle *particle, const vec axes[3])
{
    const struct drawing *d = &f->drawing;
    drawing_place(&f->drawing, particle, 1, STEP);
    opaque_draw(f, 1);
    const struct solid solid = solid_of(vec_of(particle_position(*particle)), axes);
    double drawn = 0, expected = 0;
    int faces = 0;
    for (int p = 0; p < PIXELS; p++) {
        int sides[17], same = 0;
        double t = 1e9, behind = (double)d->backdrop_depth.host[p];
        for (int k = 0; k < 17; k++) {
            double x = k ? (k % 4 + 0.5) / 4 : 0.5, y = k ? ((k - 1) / 4 + 0.5) / 4 : 0.5;
            vec ray = drawing_ray(d, p % WIDTH + x, p / WIDTH + y);
            sides[k] = -1;
            double at = enter(&solid, drawing_eye(d), ray, &sides[k]);
            sides[k] = at < behind ? sides[k] : -1;
            t = k == 0 ? at : t;
            same += sides[k] == sides[0];
            expected += k > 0 && sides[k] >= 0 ? 1.0 / 16 : 0;
        }
        drawn += (double)f->bloom.host[4 * p] / ALBEDO[0];
        if (same < 17)
            continue;
        double depth = sides[0] >= 0 ? t : behind;
        assert_true(fabs((double)f->depth.host[p] - depth) < 1e-4 * depth);
        for (int c = 0; c < 3 && sides[0] >= 0; c++)
            assert_true(fabs((double)f->color.host[4 * p + c] - ALBEDO[c]) < 1e-3);
        faces |= sides[0] >= 0 ? 1 << sides[0] : 0;
    }
    assert_true(faces != 0 && expected > 300);
    assert_true(fabs(drawn - expected) < 0.02 * expected);
}

static const float3 PLACE = {0.7f, 1.1f, 0.9f};

/* ---- orientation ----------------------------------------------------------------------------- */

/* A mesh's z axis must point along the particle's velocity, and its x axis must be level. A mesh
 * that moves straight up must keep the world's x axis, and a mesh at rest the world's z axis. */
static void meshes_point_along_the_velocity(void **state)
{
    static const float3 velocities[] = {{0.0f, 0.0f, 3.0f},
                                        {1.0f, 0.3f, -0.5f},
                                        {-2.0f, -1.0f, 0.1f},
                                        {0.0f, 2.0f, 0.0f},
                                        {0.0f, 0.0f, 0.0f}};
    struct fixture f;
    init(&f, *state, NULL, 0);
    for (size_t i = 0; i < sizeof velocities / sizeof *velocities; i++) {
        const struct kiln_particle particle = drawing_particle(0, PLACE, velocities[i]);
        vec ahead = i == 4 ? (vec){0, 0, 1} : vec_unit(vec_of(velocities[i]));
        vec right = i == 3 ? (vec){1, 0, 0} : vec_unit(vec_cross((vec){0, 1, 0}, ahead));
        const vec axes[3] = {right, vec_cross(ahead, right), ahead};
        check_solid(&f, &particle, axes);
    }
    opaque_finish(&f);
}

/* Returns a vector rotated about a unit axis by an angle, rad (Rodrigues' formula). */
static vec turned(vec v, vec axis, double angle)
{
    vec y = vec_add((vec){0}, v, cos(angle));
    y = vec_add(y, vec_cross(axis, v), sin(angle));
    return vec_add(y, axis, vec_dot(v, axis) * (1 - cos(angle)));
}

/* A mesh must rotate by its initial rotation and by its spin since birth: about y with the
 * orientation `upright`, about a random axis with `spin`. */
static void meshes_rotate_about_their_axis(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.rotation=[40 deg, 40 deg]", "systems.a.look.spin=[90 deg/s, 90 deg/s]",
        "systems.a.look.mesh.orient=upright", "systems.a.look.mesh.orient=spin"};
    static const vec units[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (size_t spin = 0; spin < 2; spin++) {
        struct fixture f;
        init(&f, *state, overrides, 3 + spin);
        for (uint32_t serial = 0; serial < 3; serial++) {
            const struct kiln_particle particle =
                drawing_particle(serial, PLACE, (float3){1.0f, 0.0f, 0.0f});
            const struct kiln_derived_params derived = kiln_scene_derived(f.drawing.scene, 0);
            uint32_t stream = particle_stream(derived, particle);
            vec axis = {0, 1, 0};
            if (spin)
                axis = vec_of(random_direction(stream, RANDOM_AXIS, (float3){0, 1, 0}, -1.0f));
            assert_true(fabs(vec_dot(axis, axis) - 1) < 1e-5);
            double age = (double)particle_age(particle, STEP, f.drawing.scene->dt_s);
            double side = random_unit(stream, RANDOM_SPIN + 1) < 0.5f ? -1 : 1;
            double angle = 3.14159265358979 * (40 + side * 90 * age) / 180;
            vec axes[3];
            for (int i = 0; i < 3; i++)
                axes[i] = turned(units[i], axis, angle);
            check_solid(&f, &particle, axes);
        }
        opaque_finish(&f);
    }
}

/* A mesh that spins by its collisions must have the orientation of the quaternion in the pool. */
static void meshes_have_the_pose_of_their_collisions(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.mesh.orient=spin",
        "systems.a.interact=[{collide: {radius: 20 cm, spin: true}}]"};
    const double q[4] = {0.48, -0.6, 0.0, 0.64};
    struct fixture f;
    init(&f, *state, overrides, 2);
    struct kiln_spin *spins = pool_give_spins(&f.drawing.pool);
    spins[0].pose = (uint4){FLOAT_BITS((float)q[0]), FLOAT_BITS((float)q[1]),
                            FLOAT_BITS((float)q[2]), FLOAT_BITS((float)q[3])};
    const vec axes[3] = {{1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[2] * q[3]),
                          2 * (q[0] * q[2] - q[1] * q[3])},
                         {2 * (q[0] * q[1] - q[2] * q[3]), 1 - 2 * (q[0] * q[0] + q[2] * q[2]),
                          2 * (q[1] * q[2] + q[0] * q[3])},
                         {2 * (q[0] * q[2] + q[1] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
                          1 - 2 * (q[0] * q[0] + q[1] * q[1])}};
    const struct kiln_particle particle =
        drawing_particle(0, (float3){0.2f, 0.9f, 1.2f}, (float3){1.0f, 0.0f, 0.0f});
    check_solid(&f, &particle, axes);
    opaque_finish(&f);
}

/* ---- light ----------------------------------------------------------------------------------- */

/* A mesh must cast no shadow on its own sunlit face: the brightest pixel must be as bright as
 * Lambert's law makes the face with the normal (1, 1, 1). */
static void the_sun_lights_meshes(void **state)
{
    static const char *const overrides[] = {
        "systems.a.look.lit=1",
        "backdrop.objects=[]",
        "backdrop.sun={direction: [0.5, 1.5, 3], color: [3, 3, 3]}",
        "backdrop.sky={top: [0, 0, 0], horizon: [0, 0, 0]}",
        "systems.a.look.mesh.orient=upright",
        "systems.a.look.rotation=[0 deg, 0 deg]"};
    struct fixture f;
    init(&f, *state, overrides, sizeof overrides / sizeof *overrides);
    const struct kiln_particle particle = drawing_particle(0, PLACE, (float3){0.0f, 0.0f, 0.0f});
    drawing_place(&f.drawing, &particle, 1, STEP);
    opaque_draw(&f, 1);
    double brightest = 0;
    for (int p = 0; p < PIXELS; p++) {
        bool covered = f.bloom.host[4 * p + 3] == 1.0f;
        brightest = fmax(brightest, covered ? (double)f.color.host[4 * p] : 0);
    }
    vec sun = vec_unit((vec){0.5, 1.5, 3}), slope = vec_unit((vec){1, 1, 1});
    double lambert = ALBEDO[0] * 3 * vec_dot(sun, slope) / 3.14159265358979;
    assert_true(fabs(brightest - lambert) < 0.01 * lambert);
    opaque_finish(&f);
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Returns copies of colour (RGBA), bloom (RGBA) and 1 / (1 + depth), which is finite for the sky,
 * in one array in this order. The caller frees the array. */
static float *copy_of(const struct fixture *f)
{
    float *copy = malloc((size_t)PIXELS * 9 * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, f->color.host, (size_t)PIXELS * 4 * sizeof *copy);
    memcpy(copy + (size_t)PIXELS * 4, f->bloom.host, (size_t)PIXELS * 4 * sizeof *copy);
    for (size_t p = 0; p < PIXELS; p++)
        copy[(size_t)PIXELS * 8 + p] = 1.0f / (1.0f + f->depth.host[p]);
    return copy;
}

/* Meshes drawn in the reverse order must give the same picture, except for the rounding of sums. */
static void order_is_no_matter(void **state)
{
    struct fixture f;
    init(&f, *state, NULL, 0);
    struct kiln_particle particles[COUNT];
    place_cloud(&f, particles, COUNT);
    opaque_draw(&f, COUNT);
    float *before = copy_of(&f);
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&f.drawing.entries, KILN_READ_WRITE, &error);
    assert_non_null(entries);
    for (uint32_t i = 0; i < COUNT; i++)
        entries[i] = KILN_ENTRY(0, COUNT - 1 - i);
    opaque_draw(&f, COUNT);
    float *after = copy_of(&f);
    for (size_t i = 0; i < (size_t)PIXELS * 9; i++)
        assert_true(fabsf(after[i] - before[i]) <= 1e-6f * (1.0f + fabsf(after[i])));
    free(after);
    free(before);
    opaque_finish(&f);
}

/* A mesh behind the camera, a mesh of opacity 0, which has no size, and no mesh at all must leave
 * the backdrop as it is. A mesh around the eye must be cut at the near plane, 0.1 m. */
static void the_near_plane_cuts(void **state)
{
    static const char *const gone[] = {"systems.a.look.opacity=0"};
    static const float3 behind = {0.7f, 1.7f, 4.2f}, around = {0.5f, 1.45f, 2.85f};
    for (size_t i = 0; i < 3; i++) {
        struct fixture f;
        init(&f, *state, gone, i == 1);
        const struct kiln_particle particle =
            drawing_particle(0, i == 0 ? behind : PLACE, (float3){1.0f, 0.0f, 0.0f});
        drawing_place(&f.drawing, &particle, 1, STEP);
        opaque_draw(&f, i == 2 ? 0 : 1);
        assert_memory_equal(f.color.host, f.drawing.backdrop_color.host, PIXELS * 16);
        assert_memory_equal(f.depth.host, f.drawing.backdrop_depth.host, PIXELS * 4);
        opaque_finish(&f);
    }
    struct fixture f;
    init(&f, *state, NULL, 0);
    const struct kiln_particle particle = drawing_particle(0, around, (float3){1.0f, 0.0f, 0.0f});
    drawing_place(&f.drawing, &particle, 1, STEP);
    opaque_draw(&f, 1);
    int seen = 0;
    for (int p = 0; p < PIXELS; p++) {
        assert_true(isfinite(f.color.host[4 * p]) && f.depth.host[p] >= 0.0999f);
        seen += f.depth.host[p] < f.drawing.backdrop_depth.host[p];
    }
    assert_true(seen > 0);
    opaque_finish(&f);
}

/* ---- techniques, threads and memory ---------------------------------------------------------- */

enum { CROWD = 400 };

/* Draws CROWD lit meshes by a technique. Returns a copy of the images, which the caller frees. */
static float *draw_crowd(void *device, enum kiln_backdrop_technique technique)
{
    static const char *const overrides[] = {"systems.a.look.lit=1", "systems.a.look.size=0.3 m"};
    backdrop_technique = technique;
    drawing_most = CROWD;
    struct fixture f;
    init(&f, device, overrides, 2);
    static struct kiln_particle particles[CROWD];
    place_cloud(&f, particles, CROWD);
    opaque_draw(&f, CROWD);
    float *copy = copy_of(&f);
    opaque_finish(&f);
    drawing_most = 32;
    return copy;
}

static void techniques_agree(void **state)
{
    float *gl = draw_crowd(*state, KILN_BACKDROP_GL), *cpu = draw_crowd(*state, KILN_BACKDROP_CPU);
    double sum = 0;
    int off = 0;
    for (int i = 0; i < PIXELS * 9; i++) {
        double error = fabs((double)gl[i] - (double)cpu[i]) / (1e-2 + fabs((double)cpu[i]));
        sum += error;
        off += error > 1e-2;
    }
    assert_true(sum / (PIXELS * 9) < 1e-3 && off < PIXELS * 9 / 1000);
    free(gl);
    free(cpu);
}

static void threads_and_vectors_change_no_byte(void **state)
{
    float *first = draw_crowd(*state, KILN_BACKDROP_CPU);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        setenv("KILN_SIMD", kiln_simd_name(simd), 1);
        drawing_threads = 1 + (uint32_t)simd;
        float *other = draw_crowd(*state, KILN_BACKDROP_CPU);
        assert_memory_equal(first, other, (size_t)PIXELS * 9 * sizeof *first);
        free(other);
    }
    unsetenv("KILN_SIMD");
    drawing_threads = 2;
    free(first);
}

/* The technique `cpu` must take memory in proportion to the particles, not to their triangles or
 * pixels: less than 64 MiB for 100000 meshes. */
static void many_take_little_memory(void **state)
{
    enum { MANY = 100000 };
    static struct kiln_particle particles[MANY];
    struct rusage before, after;
    backdrop_technique = KILN_BACKDROP_CPU;
    drawing_most = MANY;
    static const char *const small[] = {"systems.a.look.size=0.05 m"};
    struct fixture f;
    init(&f, *state, small, 1);
    place_cloud(&f, particles, MANY);
    assert_int_equal(getrusage(RUSAGE_SELF, &before), 0);
    opaque_draw(&f, MANY);
    assert_int_equal(getrusage(RUSAGE_SELF, &after), 0);
    assert_true(after.ru_maxrss - before.ru_maxrss < 64 * 1024);
    double covered = 0;
    for (int p = 0; p < PIXELS; p++)
        covered += (double)f.bloom.host[4 * p + 3];
    assert_true(covered > PIXELS / 4);
    opaque_finish(&f);
    drawing_most = 32;
}

int main(int argc, char **argv)
{
    (void)argc;
    static const struct CMUnitTest each[] = {
        test_on_device(meshes_point_along_the_velocity),
        test_on_device(meshes_rotate_about_their_axis),
        test_on_device(meshes_have_the_pose_of_their_collisions),
        test_on_device(the_sun_lights_meshes),
        test_on_device(order_is_no_matter),
        test_on_device(the_near_plane_cuts),
    };
    static const struct CMUnitTest both[] = {
        test_on_device(techniques_agree),
        test_on_device(threads_and_vectors_change_no_byte),
        test_on_device(many_take_little_memory),
    };
    return backdrops_run("instances", each, sizeof each / sizeof *each, true, 1, argv) +
           cmocka_run_group_tests_name("instances", both, test_device_open, test_device_close);
}
