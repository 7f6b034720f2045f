/* Checks the stage `backdrop`, which draws sky, floor, objects and solid particles. Its techniques
 * in GL and in C must draw the same picture of every scene in scenes/ and of fixtures with every
 * feature, and the technique in C must give the same bytes for any number of threads and any SIMD
 * level. If this fails, a clip looks different on another machine. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/simd.h"
#include "frame/stages.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/pools.h"
#include "support/scenes.h"
#include "support/stages.h"

enum { WIDTH = 384, HEIGHT = 216, PIXELS = WIDTH * HEIGHT, COLORS = 4 * PIXELS };

/* Holds the picture before billboards are drawn: the backdrop and the solid particles. color and
 * bloom are RGBA; depth is the view depth, m. */
struct picture {
    float color[COLORS], bloom[COLORS], depth[PIXELS];
};

/* ---- a moment of a scene --------------------------------------------------------------------- */

/* Holds a scene and its particles at one instant, after `step` steps. */
struct moment {
    struct kiln_device *device;
    struct kiln_scene *scene;
    struct kiln_pool pool;
    uint32_t step;
    uint32_t before; /* a step that the stages draw before `step`, to leave traces; 0: none */
};

static void step_to(struct moment *m, uint32_t step)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    struct kiln_simulate *simulate =
        kiln_simulate_create(m->device, m->scene, KILN_SIMULATE_CPU, KILN_GAS_CPU, threads, &error);
    assert_non_null(simulate);
    for (m->step = 0; m->step < step;) {
        if (!kiln_simulate_step(simulate, &m->pool, ++m->step, &error))
            fail_msg("%s", error.message);
    }
    kiln_simulate_destroy(&simulate);
    kiln_threads_destroy(&threads);
}

/* Limits the simulated steps of a scene, and so the duration of the test. */
enum { MOST_STEPS = 200 };

static void open_moment(struct moment *m, struct kiln_device *device, struct kiln_scene *scene,
                        uint32_t frame)
{
    *m = (struct moment){.device = device, .scene = scene};
    pool_init_of(&m->pool, device, scene);
    const uint32_t step = kiln_scene_frame_step(scene, frame);
    step_to(m, step < MOST_STEPS ? step : MOST_STEPS);
}

static void close_moment(struct moment *m)
{
    kiln_pool_finish(&m->pool);
    kiln_scene_destroy(&m->scene);
}

static const char *const SMALL[] = {"output.size=[384, 216]", "post.bloom.kind=none", NULL};

static struct kiln_scene *load(const char *path)
{
    return load_coarse_scene(path, SMALL);
}

static struct kiln_scene *parse(const char *text)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = SMALL;
    params.override_count = 2;
    params.asset_root = KILN_SOURCE_DIR "/scenes";
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static void take(struct kiln_image *image, float *pixels, size_t floats)
{
    struct kiln_error error = {0};
    const float *from = kiln_image_host(image, KILN_READ, &error);
    assert_non_null(from);
    memcpy(pixels, from, floats * sizeof *pixels);
}

static struct picture *draw(struct moment *m, enum kiln_backdrop_technique technique,
                            uint32_t threads)
{
    struct kiln_error error = {0};
    struct kiln_threads *workers = kiln_threads_create(threads);
    struct picture *picture = calloc(1, sizeof *picture);
    struct kiln_stages stages;
    const struct kiln_techniques techniques = {.simulate = KILN_SIMULATE_CPU,
                                               .sort = KILN_SORT_CPU,
                                               .backdrop = technique,
                                               .raster = KILN_RASTER_CPU,
                                               .composite = KILN_COMPOSITE_CPU};
    uint32_t drawn = 0;
    assert_non_null(picture);
    stages_open(&stages, NULL, m->device, m->scene, &techniques, false, workers, &m->pool);
    if ((m->before && !kiln_stages_draw(&stages, NULL, &m->pool, kiln_instant_at_step(m->before), 0,
                                        &drawn, &error)) ||
        !kiln_stages_draw(&stages, NULL, &m->pool, kiln_instant_at_step(m->step), 0, &drawn,
                          &error))
        fail_msg("%s", error.message);
    take(&stages.scene_color, picture->color, COLORS);
    take(&stages.scene_depth, picture->depth, PIXELS);
    if (stages.solids)
        take(&stages.bloom_color, picture->bloom, COLORS);
    stages_close(&stages, NULL);
    kiln_threads_destroy(&workers);
    return picture;
}

/* ---- comparison ------------------------------------------------------------------------------ */

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Holds two measures of how images a and b differ. mean: the sum of |a - b| divided by the sum of
 * |a|; most: the relative error that only one value in a thousand exceeds. */
struct difference {
    double mean, most;
};

/* Compares the first `used` of the `channels` values of each pixel of two images. The relative
 * error of a value is |a - b| divided by |a| plus a hundredth of the mean of |a|, so that dark
 * pixels do not count too much. */
static struct difference compare(const float *a, const float *b, int channels, int used)
{
    double sum = 0, light = 1e-12;
    int count = 0;
    static float errors[COLORS];
    for (int i = 0; i < PIXELS * channels; i++)
        light += i % channels < used ? fabs((double)a[i]) : 0;
    double least = 0.01 * light / (PIXELS * used) + 1e-9;
    for (int i = 0; i < PIXELS * channels; i++) {
        if (i % channels >= used)
            continue;
        double error = fabs((double)a[i] - (double)b[i]);
        sum += error;
        errors[count++] = (float)(error / (fabs((double)a[i]) + least));
    }
    qsort(errors, (size_t)count, sizeof *errors, ascending);
    return (struct difference){sum / light, (double)errors[count - 1 - count / 1000]};
}

/* Replaces a picture's view depth, m, in place by its reciprocal, 1/m, which is 0 for the sky, and
 * returns the result. */
static const float *nearness(struct picture *picture)
{
    for (int p = 0; p < PIXELS; p++)
        picture->depth[p] = picture->depth[p] > 1e8f ? 0.0f : 1.0f / picture->depth[p];
    return picture->depth;
}

/* Fails unless the pictures of both techniques agree within the limits of docs/determinism.md: a
 * mean relative error of at most 1e-3, and at most one value in a thousand that is off by more than
 * 1 %. Pixels at edges count, too. */
static void check_agreement(struct moment *m, const char *name)
{
    struct picture *gl = draw(m, KILN_BACKDROP_GL, 2), *cpu = draw(m, KILN_BACKDROP_CPU, 2);
    const struct difference of[] = {
        compare(gl->color, cpu->color, 4, 3), compare(gl->color + 3, cpu->color + 3, 4, 1),
        compare(gl->bloom, cpu->bloom, 4, 4), compare(nearness(gl), nearness(cpu), 1, 1)};
    static const char *const what[] = {"light", "alpha", "bloom", "nearness"};
    for (int i = 0; i < 4; i++) {
        print_message("%-28s %-8s %.1e %.1e\n", name, what[i], of[i].mean, of[i].most);
        assert_true(of[i].mean <= 1e-3 && of[i].most <= 1e-2);
    }
    free(gl);
    free(cpu);
}

/* ---- fixtures -------------------------------------------------------------------------------- */

#define HEAD "kiln: 1\noutput: {fps: 30, frames: 60}\n"
#define CAMERA                                                                                     \
    "camera: {position: [0.6, 1.7, 4.5], target: [0, 0.6, 0], fov: 45 deg, roll: 4 deg}\n"
#define SHAPES                                                                                     \
    "  objects:\n"                                                                                 \
    "    - box: {center: [-1.3, 0.4, 0.4], size: [0.5, 0.8, 0.5], color: [0.9, 0.3, 0.2]}\n"       \
    "    - box: {center: [1.9, 0.3, 1.1], size: [0.3, 0.6, 0.9]}\n"                                \
    "    - sphere: {center: [0.2, 0.7, 0.3], radius: 0.5 m, color: 0.8}\n"                         \
    "    - cylinder: {center: [1.2, 0.5, -0.4], radius: 0.3 m, height: 1 m, color: 0.7}\n"         \
    "    - cylinder: {center: [-0.6, 0.5, -0.8], axis: [1, 0.4, 0.2], radius: 0.2 m,\n"            \
    "                 height: 1.4 m, color: 0.6}\n"
#define TURNED                                                                                     \
    "  objects:\n"                                                                                 \
    "    - box: {center: [-1.2, 0.6, 0.3], size: [0.5, 0.8, 0.4], color: [0.9, 0.3, 0.2],\n"       \
    "            rotation: [20 deg, 50 deg, -35 deg]}\n"                                           \
    "    - box: {center: [1.5, 0.4, 0.4], size: [0.9, 0.1, 0.5], rotation: [0, 0, 25 deg]}\n"      \
    "    - capsule: {center: [0.3, 0.6, 0.2], axis: [0.4, 2, 0.3], radius: 0.25 m, height: 0.6 "   \
    "m}\n"                                                                                         \
    "    - capsule: {center: [-0.4, 0.3, -0.9], axis: [1, 0, 0.2], radius: 0.2 m, color: 0.6}\n"   \
    "    - cone: {center: [1.0, 0.5, -0.4], axis: [0.2, 1, 0.3], radius: 0.3 m, height: 0.7 m}\n"  \
    "    - plane: {center: [0, 0, -3], normal: [0.2, 1, 2], color: [0.3, 0.5, 0.2]}\n"
#define MESHES                                                                                     \
    "  objects:\n"                                                                                 \
    "    - mesh: {file: meshes/pot.obj, position: [-0.6, 0.2, 0.5], scale: 1.5,\n"                 \
    "             rotation: [20 deg, 40 deg, 0], color: [0.6, 0.4, 0.3]}\n"                        \
    "    - mesh: {file: meshes/logs.obj, position: [0.4, 0, 0], color: 0.5}\n"                     \
    "    - box: {center: [1.4, 0.4, 0], size: [0.4, 0.8, 0.4]}\n"
#define MOVING                                                                                     \
    "  objects:\n"                                                                                 \
    "    - mesh: {file: meshes/walker.gltf, rotation: [0, 30 deg, 0], animation: {}}\n"            \
    "    - box: {center: [0.9, 0.4, 0], size: [0.4, 0.8, 0.4]}\n"
#define LAMPS                                                                                      \
    "  lights:\n"                                                                                  \
    "    - point: {position: [-1, 1.5, 1.5], color: [3, 1.5, 0.5], radius: 0.3 m}\n"               \
    "    - point: {position: [1.5, 0.4, 1], color: [0.2, 0.6, 2]}\n"
#define SYSTEMS                                                                                    \
    "systems:\n"                                                                                   \
    "  balls:\n"                                                                                   \
    "    emit: {rate: 60, life: 2 s, speed: 2, from: {cone: {origin: [0.5, 0.3, 0.5],\n"           \
    "           direction: [0, 1, 0], angle: 50 deg}}}\n"                                          \
    "    look: {shape: sphere, size: 0.2 m, scale: [0.2, 1], lit: 0.9, color: [0.7, 0.8, 0.3],\n"  \
    "           temperature: {life: [1500, 800]}, intensity: 0.5, bloom: [1, 0.5, 0.2]}\n"         \
    "  smoke:\n"                                                                                   \
    "    emit: {rate: 60, life: 2 s, speed: 1, from: {sphere: {origin: [-0.8, 0.8, 0]}}}\n"        \
    "    look: {size: 0.7 m, opacity: 0.5, color: 0.2, lit: 1}\n"                                  \
    "  fire:\n"                                                                                    \
    "    emit: {rate: 100, life: 1 s, speed: 1, from: {sphere: {origin: [0.8, 0.5, 1]}}}\n"        \
    "    look: {blend: add, size: 0.4 m, temperature: 1800, light: 1, lights: 5}\n"

static struct fixture {
    const char *name, *text;
} FIXTURES[] = {
    {"checkers, haze", HEAD CAMERA
     "backdrop:\n  haze: 0.15\n  floor: {checker: 0.4 m, height: -0.2 m}\n" SHAPES LAMPS},
    {"soft sun", HEAD CAMERA "backdrop:\n  sun: {direction: [-1, 1.2, 0.7], size: 8 deg}\n" SHAPES},
    {"the sun's disc, water", HEAD CAMERA
     "backdrop:\n  haze: 0.1\n  floor: {gloss: 1}\n  sun: {direction: [0.2, 0.1, -1], size: 5 deg, "
     "disc: 4, glow: 1, glow_size: 12 deg}\n" SHAPES},
    {"the sun's disc in a picture", HEAD CAMERA
     "backdrop:\n  haze: 0.1\n  sky: {image: textures/concrete.jpg}\n  sun: {direction: "
     "[0.2, 0.1, -1], size: 5 deg, disc: 4, glow: 1, glow_size: 12 deg}\n" SHAPES},
    {"low sun, transparent", HEAD CAMERA
     "backdrop:\n  transparent: true\n  sun: {direction: [1, 0.1, 0], color: 3}\n" SHAPES},
    {"pictures", HEAD CAMERA
     "backdrop:\n  floor: {image: textures/paving.jpg, tile: 0.9 m}\n"
     "  sky: {image: textures/concrete.jpg, rotation: 50 deg, intensity: 1.5}\n" SHAPES},
    {"water",
     HEAD CAMERA "backdrop:\n  floor: {gloss: 1.2, wave_height: 4 cm, wave_length: 0.7 m}\n"
                 "  sun: {size: 1 deg}\n" SHAPES LAMPS},
    {"wet paving",
     HEAD CAMERA "backdrop:\n  floor: {gloss: 2, roughness: 0.1, image: textures/paving.jpg}\n"
                 "  sky: {image: textures/soil.jpg}\n" SHAPES LAMPS},
    {"turned", HEAD CAMERA "backdrop:\n  floor: {checker: 0.4 m}\n" TURNED LAMPS},
    {"turned, soft sun, particles", HEAD CAMERA
     "backdrop:\n  floor: {gloss: 1}\n  sun: {direction: [-1, 1.2, 0.7], size: 8 deg}\n" TURNED
         SYSTEMS},
    {"meshes", HEAD CAMERA "backdrop:\n" MESHES LAMPS},
    {"meshes, soft sun",
     HEAD CAMERA "backdrop:\n  sun: {direction: [-1, 1, 1.5], size: 12 deg}\n" MESHES},
    {"a mesh that moves",
     HEAD CAMERA "backdrop:\n  sun: {direction: [-1, 1, 1.5], size: 2 deg}\n" MOVING LAMPS},
    {"close to a mesh",
     HEAD "camera: {position: [0.1, 0.9, 0.5], target: [-0.6, 0.5, 0.5], fov: 90 deg}\n"
          "backdrop:\n  haze: 0\n" MESHES},
    {"inside of a box", HEAD
     "camera: {position: [0.5, 0.3, 0.3], target: [0.4, 0.5, -1], fov: 80 deg}\n"
     "backdrop:\n  floor: none\n  objects:\n    - box: {center: [0, 0, 0], size: [2, 2, 2]}\n"
     "    - sphere: {center: [0.5, 0.3, 0.3], radius: 0.3 m}\n"
     "    - cylinder: {center: [0.6, 0.4, -3], axis: [0.2, 0, 1], radius: 0.8 m, height: 3 m}\n"},
    {"particles", HEAD CAMERA "backdrop:\n" SHAPES SYSTEMS},
    {"particles, soft sun", HEAD CAMERA
     "backdrop:\n  haze: 0.1\n  floor: {gloss: 1}\n  sun: {size: 6 deg}\n" MESHES SYSTEMS},
};

enum { FIXTURE_COUNT = sizeof FIXTURES / sizeof *FIXTURES };

/* ---- tests ----------------------------------------------------------------------------------- */

static void techniques_agree_on_a_scene(void **state)
{
    const struct test_scene *given = *state;
    struct moment m;
    struct kiln_scene *scene = load(given->path);
    open_moment(&m, test_device(), scene, scene->frames / 2);
    check_agreement(&m, strrchr(given->path, '/') + 1);
    close_moment(&m);
}

static void techniques_agree_on_a_fixture(void **state)
{
    const struct fixture *given = *state;
    struct moment m;
    open_moment(&m, test_device(), parse(given->text), 40);
    check_agreement(&m, given->name);
    close_moment(&m);
}

/* A moving mesh at step 40 or 60 must be drawn with the same bytes whether or not the stages drew
 * the other step before. If this fails, the stages keep something of the earlier pose. */
static void an_earlier_pose_of_a_mesh_leaves_no_trace(void **state)
{
    (void)state;
    struct moment m;
    open_moment(&m, test_device(), parse(HEAD CAMERA "backdrop:\n" MOVING), 40);
    for (int i = 0; i < 2; i++) {
        const enum kiln_backdrop_technique technique = i ? KILN_BACKDROP_GL : KILN_BACKDROP_CPU;
        struct picture *pictures[4];
        for (int k = 0; k < 4; k++) {
            m.step = k < 2 ? 40 : 60;
            m.before = k % 2 ? 100 - m.step : 0;
            pictures[k] = draw(&m, technique, 2);
        }
        assert_memory_equal(pictures[0], pictures[1], sizeof *pictures[0]);
        assert_memory_equal(pictures[2], pictures[3], sizeof *pictures[0]);
        assert_true(memcmp(pictures[0]->color, pictures[2]->color, sizeof pictures[0]->color) != 0);
        for (int k = 0; k < 4; k++)
            free(pictures[k]);
    }
    close_moment(&m);
}

/* Fails unless the technique in C draws the expected bytes at a SIMD level and with a number of
 * threads. simd: the level's name, or NULL for the level that kiln chooses itself. */
static void check_bytes(struct moment *m, const struct picture *expected, const char *simd,
                        uint32_t threads)
{
    if (simd)
        setenv("KILN_SIMD", simd, 1);
    struct picture *picture = draw(m, KILN_BACKDROP_CPU, threads);
    assert_memory_equal(picture, expected, sizeof *picture);
    free(picture);
    unsetenv("KILN_SIMD");
}

static void threads_and_vectors_change_no_byte(void **state)
{
    const struct fixture *given = *state;
    struct moment m;
    open_moment(&m, test_device(), parse(given->text), 40);
    struct picture *expected = draw(&m, KILN_BACKDROP_CPU, 1);
    for (uint32_t threads = 3; threads <= 5; threads += 2)
        check_bytes(&m, expected, NULL, threads);
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (kiln_simd_has(simd))
            check_bytes(&m, expected, kiln_simd_name(simd), 2);
    }
    free(expected);
    close_moment(&m);
}

static void add_fixtures(struct test_list *list, struct CMUnitTest test)
{
    for (size_t i = 0; i < FIXTURE_COUNT; i++) {
        test.name = FIXTURES[i].name;
        test.initial_state = &FIXTURES[i];
        test_list_add(list, &test, 1);
    }
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest moves =
        test_on_device(an_earlier_pose_of_a_mesh_leaves_no_trace);
    static const struct CMUnitTest same = test_on_device(threads_and_vectors_change_no_byte);
    static const struct CMUnitTest agree = test_on_device(techniques_agree_on_a_fixture);
    static const struct CMUnitTest scene = test_on_device(techniques_agree_on_a_scene);
    struct test_list list = {.count = 0};
    test_list_add(&list, &moves, 1);
    add_fixtures(&list, same);
    add_fixtures(&list, agree);
    test_list_add_scenes(&list, scene, 7);
    return test_list_run(&list, "backdrops", argc, argv, test_device_open_alone, test_device_close);
}
