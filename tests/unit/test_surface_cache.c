/* The surface cache: when it is filled and read, and that pictures are the same bytes with it. */
#include <stdlib.h>
#include <string.h>

#include "draw/backdrop/surface_cache.h"
#include "kiln.h"
#include "support/cmocka.h"
#include "support/scene_fixture.h"

#define CAMERA                                                                                     \
    "camera: {position: [0.6, 1.7, 4.5], target: [0, 0.6, 0], fov: 45 deg, roll: 4 deg}\n"
#define HEAD "kiln: 1\noutput: {size: [150, 85], frames: 12, fps: 30}\n" CAMERA
#define OBJECTS                                                                                    \
    "  objects:\n"                                                                                 \
    "    - mesh: {file: meshes/pot.obj, position: [-0.6, 0.2, 0.5], scale: 1.5}\n"                 \
    "    - box: {center: [1.4, 0.4, 0], size: [0.4, 0.8, 0.4], rotation: [0, 20 deg, 10 deg]}\n"   \
    "    - sphere: {center: [0.4, 0.3, 0.9], radius: 0.3 m, color: 0.8}\n"                         \
    "    - cylinder: {center: [-1.5, 0.5, 0.9], radius: 0.2 m, height: 1 m, color: 0.7}\n"
#define FLICKERS "color: {keys: {0 s: [3, 1.5, 0.5], 0.1 s: [1, 0.4, 0.1], 0.4 s: [4, 2, 0.8]}}"
#define LAMPS                                                                                      \
    "  lights:\n"                                                                                  \
    "    - point: {position: [-1, 1.5, 1.5], " FLICKERS ", radius: 0.3 m}\n"                       \
    "    - point: {position: {keys: {0 s: [1.5, 0.9, 1], 0.15 s: [1, 1.2, 1]}},\n"                 \
    "              color: [0.2, 0.6, 2]}\n"                                                        \
    "    - spot: {position: [0, 2.5, 1], direction: [0.1, -1, -0.2], angle: 40 deg, " FLICKERS     \
    "}\n"
#define PARTICLES                                                                                  \
    "systems:\n"                                                                                   \
    "  balls:\n"                                                                                   \
    "    emit: {rate: 300, life: 2 s, speed: 2, from: {sphere: {origin: [0.5, 0.9, 0.5]}}}\n"      \
    "    look: {shape: sphere, size: 0.2 m, lit: 0.9, color: [0.7, 0.8, 0.3]}\n"                   \
    "  smoke:\n"                                                                                   \
    "    emit: {rate: 200, life: 2 s, speed: 1, from: {sphere: {origin: [-0.8, 0.8, 0]}}}\n"       \
    "    look: {size: 0.7 m, opacity: 0.5, color: 0.2, lit: 1}\n"                                  \
    "  fire:\n"                                                                                    \
    "    emit: {rate: 300, life: 1 s, speed: 1, from: {sphere: {origin: [0.8, 0.5, 1]}}}\n"        \
    "    look: {blend: add, size: 0.4 m, temperature: 1800, light: 1, lights: 2}\n"

static const struct {
    const char *name, *text, *override;
} CLIPS[] = {
    {"lamps", HEAD "backdrop:\n" OBJECTS LAMPS, NULL},
    {"haze before a picture of the sky",
     HEAD "backdrop:\n  haze: 0.1\n  floor: {image: textures/paving.jpg}\n"
          "  sky: {image: textures/concrete.jpg}\n  sun: {size: 4 deg}\n" OBJECTS LAMPS,
     NULL},
    {"a glossy floor", HEAD "backdrop:\n  floor: {gloss: 1}\n" OBJECTS LAMPS, NULL},
    {"particles", HEAD "backdrop:\n  floor: {gloss: 1}\n" OBJECTS PARTICLES, NULL},
    {"transparent", HEAD "backdrop:\n  transparent: true\n  floor: none\n" OBJECTS LAMPS, NULL},
    {"a box that stops",
     HEAD
     "backdrop:\n  objects:\n    - box: {center: {keys: {0 s: [0, 0.4, 0], 0.12 s: [0.5, 0.4, 0],\n"
     "            0.3 s: [0.5, 0.4, 0], 0.4 s: [0, 0.4, 0]}}, size: [1, 0.8, 0.4]}\n" LAMPS,
     NULL},
    {"smoke that comes over a floor later",
     HEAD "systems:\n  smoke:\n"
          "    emit: {rate: {keys: {0 s: 0, 0.12 s: 0, 0.14 s: 900}}, life: 2 s, speed: 1,\n"
          "           from: {sphere: {origin: [0, 0.5, 0]}}}\n"
          "    look: {size: 0.5 m, opacity: 0.9, color: 0.2, lit: 1, shadow: 1}\n",
     NULL},
    {"a sun that flickers",
     HEAD
     "backdrop:\n  sun: {color: {keys: {0 s: 1, 0.2 s: 0, 0.3 s: 0, 0.4 s: 2}}}\n" OBJECTS LAMPS,
     NULL},
    {"a shutter", HEAD "backdrop:\n" OBJECTS LAMPS, "camera.shutter.samples=3"},
};

enum { CLIP_COUNT = sizeof CLIPS / sizeof *CLIPS, FRAMES = 12, WIDTH = 150, HEIGHT = 85 };

/* ---- pictures -------------------------------------------------------------------------------- */

struct clip {
    size_t count;
    float *frames[FRAMES]; /* RGBA of layer beauty */
};

static void take_frame(void *user, const struct kiln_frame_layer *view)
{
    struct clip *clip = user;
    const size_t bytes = view->row_bytes * view->height;
    assert_true(clip->count < FRAMES && bytes == 4 * sizeof(float) * WIDTH * HEIGHT);
    float *copy = malloc(bytes);
    assert_non_null(copy);
    memcpy(copy, view->pixels, bytes);
    clip->frames[clip->count++] = copy;
}

/* Renders frames of a scene in one run. */
static void render(const struct kiln_scene *scene, struct kiln_frame_range range, uint32_t threads,
                   struct clip *clip)
{
    static const char *const layers[] = {"beauty"};
    struct kiln_error error = kiln_error_empty();
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&cpu, &error);
    struct kiln_render_params params = kiln_render_defaults();
    params.ranges = &range;
    params.range_count = 1;
    params.layers = layers;
    params.layer_count = 1;
    params.exr_bits = 32;
    params.threads = threads;
    params.picture = take_frame;
    params.user = clip;
    if (!device || !kiln_render(device, scene, &params, NULL, &error))
        fail_msg("%s", error.message);
    kiln_device_close(&device);
}

static struct kiln_scene *parse(size_t clip)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = KILN_SOURCE_DIR "/scenes";
    params.overrides = &CLIPS[clip].override;
    params.override_count = CLIPS[clip].override ? 1 : 0;
    struct kiln_scene *scene = kiln_scene_parse(CLIPS[clip].text, strlen(CLIPS[clip].text),
                                                CLIPS[clip].name, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    return scene;
}

static void free_clip(struct clip *clip)
{
    for (size_t i = 0; i < clip->count; i++)
        free(clip->frames[i]);
}

/* A run of one frame has no cache. */
static void frames_are_the_same_as_alone(void **state)
{
    (void)state;
    for (size_t i = 0; i < CLIP_COUNT; i++) {
        struct kiln_scene *scene = parse(i);
        struct clip together = {0}, alone = {0};
        render(scene, (struct kiln_frame_range){0, FRAMES - 1}, 3, &together);
        for (uint32_t k = 0; k < FRAMES; k++)
            render(scene, (struct kiln_frame_range){k, k}, 1, &alone);
        assert_true(together.count == FRAMES && alone.count == FRAMES);
        for (size_t k = 0; k < FRAMES; k++) {
            if (memcmp(together.frames[k], alone.frames[k], 4 * sizeof(float) * WIDTH * HEIGHT) !=
                0)
                fail_msg("%s: frame %zu differs from the frame alone", CLIPS[i].name, k);
        }
        free_clip(&together);
        free_clip(&alone);
        kiln_scene_destroy(&scene);
    }
}

/* ---- when it is used ------------------------------------------------------------------------- */

struct fixture {
    struct scene_fixture scene;
    struct kiln_surface_cache *cache;
    struct kiln_backdrop_inputs inputs; /* two lamps that boxes may hide */
};

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct kiln_error error = kiln_error_empty();
    assert_non_null(f);
    fixture_init(&f->scene);
    f->scene.scene.width = 70;
    f->scene.scene.height = 20;
    f->cache = kiln_surface_cache_create(&f->scene.scene, 4, &error);
    f->inputs.view.frustum = (float4){1.0f, 1.0f, 70.0f, 20.0f};
    f->inputs.block.counts.y = 2;
    for (int i = 0; i < 2; i++) {
        struct kiln_draw_light *light = &f->inputs.block.lights[i];
        light->position_radius2 = (float4){(float)i, 1.0f, 0.0f, 0.01f};
        light->color = (float4){1.0f, 1.0f, 1.0f, 0.1f};
        light->casters.x = 1;
    }
    *state = f;
    return f->cache ? 0 : 1;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    kiln_surface_cache_destroy(&f->cache);
    free(f);
    return 0;
}

/* Begins a picture; checks what it does with the cache, and whose shadows it takes from there. */
static void expect(struct fixture *f, enum kiln_cache_use use, uint32_t lamps)
{
    kiln_surface_cache_begin(f->cache, &f->inputs);
    assert_int_equal(f->cache->use, use);
    if (use != KILN_CACHE_UNUSED)
        assert_int_equal(f->cache->lamps.words[0], lamps);
}

static void the_second_picture_fills_it(void **state)
{
    struct fixture *f = *state;
    expect(f, KILN_CACHE_UNUSED, 0);
    expect(f, KILN_CACHE_TO_FILL, 3);
    expect(f, KILN_CACHE_FILLED, 3);
    f->inputs.view.eye.x = 1.0f;
    expect(f, KILN_CACHE_UNUSED, 0);
    expect(f, KILN_CACHE_TO_FILL, 3);
}

static void light_may_change(void **state)
{
    struct fixture *f = *state;
    expect(f, KILN_CACHE_UNUSED, 0);
    expect(f, KILN_CACHE_TO_FILL, 3);
    f->inputs.block.lights[0].color.x = 0.0f;
    f->inputs.view.clock.x = 1.0f;
    f->inputs.view.exposure.x = 2.0f;
    f->inputs.block.counts.w = 1;
    f->inputs.block.sun_to_grid[0].x = 1.0f;
    f->inputs.shapes.counts.w = 8;
    expect(f, KILN_CACHE_FILLED, 3);
    f->inputs.block.sun_color.x = 1.0f; /* the glow of the sky has it */
    expect(f, KILN_CACHE_UNUSED, 0);
}

static void lamps_that_move_lose_their_shadows(void **state)
{
    struct fixture *f = *state;
    float4 *at = &f->inputs.block.lights[1].position_radius2;
    expect(f, KILN_CACHE_UNUSED, 0);
    expect(f, KILN_CACHE_TO_FILL, 3);
    at->x = 2.0f;
    expect(f, KILN_CACHE_FILLED, 1);
    at->x = 3.0f;
    expect(f, KILN_CACHE_FILLED, 1);
    expect(f, KILN_CACHE_TO_FILL, 3); /* it stands: the next picture has all */
    expect(f, KILN_CACHE_FILLED, 3);
}

static void shadows_of_particles_are_not_kept(void **state)
{
    struct fixture *f = *state;
    f->inputs.block.lights[0].casters.y = 1u << KILN_LAMP_SOLID_SHIFT;
    f->inputs.block.lights[1].casters.x = 0; /* nothing hides it: there is nothing to keep */
    expect(f, KILN_CACHE_UNUSED, 0);
    expect(f, KILN_CACHE_TO_FILL, 0);
    expect(f, KILN_CACHE_FILLED, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_the_same_as_alone),
        cmocka_unit_test_setup_teardown(the_second_picture_fills_it, set_up, tear_down),
        cmocka_unit_test_setup_teardown(light_may_change, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lamps_that_move_lose_their_shadows, set_up, tear_down),
        cmocka_unit_test_setup_teardown(shadows_of_particles_are_not_kept, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("surface_cache", tests, NULL, NULL);
}
