/* lib/draw/particles_cpu.c: the pixels are the same bytes for every width of vectors and any number
 * of threads. That they are right is tested against C in tests/gpu/test_particles.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/particles.h"
#include "draw/tile.h"
#include "shared/particle.h"
#include "support/scenes.h"

enum { WIDTH = 301, HEIGHT = 173, PIXELS = WIDTH * HEIGHT, STEP = 40, COUNT = 600 };

static const char SCENE[] =
    "kiln: 1\n"
    "seed: 5\n"
    "output: {size: [301, 173], fps: 60, frames: 100}\n"
    "camera: {position: [0, 1, 3], target: [0, 1, 0], fov: 60 deg, near: 0.05 m}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 1, life: 2 s, from: {point: {}}}\n"
    "    look: {size: {life: [0.02, 1.4]}, scale: [0.5, 1.2], opacity: 0.6, color: [0.5, 0.4, "
    "0.3],\n"
    "           soft: 3, lit: 1, spin: [10 deg/s, 90 deg/s], bloom: [0.1, 0.1, 0.1]}\n"
    "  fire:\n"
    "    emit: {rate: 1, life: 1.5 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:fire', blend: add, size: {life: [1.1, 0.05]}, stretch: 0.05 s,\n"
    "           temperature: {life: [1900, 1200]}, bloom: [1, 0.5, 0.25], near_fade: 0.5 m}\n"
    "  upright:\n"
    "    emit: {rate: 1, life: 1.5 s, from: {point: {}}}\n"
    "    look: {facing: axial, size: 0.4 m, lit: 0.5, opacity: 1, soft: 0.1,\n"
    "           soft_formula: literal}\n"
    "  dots:\n"
    "    emit: {rate: 1, life: 1.5 s, from: {point: {}}}\n"
    "    look: {shape: point, point: {size: 5.5 px}}\n"
    "  dashes:\n"
    "    emit: {rate: 1, life: 1.5 s, from: {point: {}}}\n"
    "    look: {shape: line, stretch: 0.2 s, line: {width: 2.5 px}, blend: add}\n";

enum { SYSTEMS = 5 };

struct fixture {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_atlas atlas;
    struct kiln_image depth, color, bloom;
    struct kiln_framebuffer framebuffer;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_view view;
    struct kiln_draw_backdrop light;
};

static float random_within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

static void place_particles(struct fixture *f)
{
    struct kiln_error error = {0};
    uint32_t capacities[SYSTEMS];
    for (int i = 0; i < SYSTEMS; i++)
        capacities[i] = COUNT / SYSTEMS;
    kiln_pool_init(&f->pool, NULL, capacities, SYSTEMS);
    kiln_buffer_init(&f->entries, NULL, COUNT * sizeof(uint32_t), "entries");
    struct kiln_particle *records = kiln_buffer_host(&f->pool.records, KILN_OVERWRITE, &error);
    uint32_t *entries = kiln_buffer_host(&f->entries, KILN_OVERWRITE, &error);
    assert_true(records && entries);
    srand(7);
    for (uint32_t i = 0; i < COUNT; i++) {
        records[i] = (struct kiln_particle){
            {FLOAT_BITS(random_within(-2.0f, 2.0f)), FLOAT_BITS(random_within(0.0f, 2.0f)),
             FLOAT_BITS(random_within(-3.0f, 3.2f)), i},
            {FLOAT_BITS(random_within(-2.0f, 2.0f)), FLOAT_BITS(random_within(-2.0f, 2.0f)),
             FLOAT_BITS(random_within(-2.0f, 2.0f)),
             (1u + (uint32_t)rand() % STEP) << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
        entries[i] = KILN_ENTRY(i / (COUNT / SYSTEMS), i);
    }
    for (uint32_t i = 0; i < COUNT; i++) { /* systems between one another */
        uint32_t other = (uint32_t)rand() % COUNT, entry = entries[i];
        entries[i] = entries[other];
        entries[other] = entry;
    }
}

static int set_up(void **state)
{
    struct kiln_error error = {0};
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->scene = load_scene(SCENE, NULL);
    f->threads = kiln_threads_create(2);
    struct kiln_atlas_request requests[SYSTEMS];
    for (int i = 0; i < SYSTEMS; i++) {
        const struct kiln_look *look = &f->scene->systems[i].look;
        requests[i] = (struct kiln_atlas_request){.sources = look->atlas,
                                                  .count = look->atlas_count,
                                                  .columns = 4,
                                                  .rows = 2,
                                                  .motion = look->motion};
    }
    if (!kiln_atlas_init(&f->atlas, NULL, requests, SYSTEMS, f->threads, &error))
        fail_msg("%s", error.message);
    kiln_image_init(&f->depth, NULL, WIDTH, HEIGHT, GL_R32F, "depth");
    kiln_image_init(&f->color, NULL, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&f->bloom, NULL, WIDTH, HEIGHT, GL_RGBA32F, "bloom");
    f->framebuffer = (struct kiln_framebuffer){.images = {&f->color, &f->bloom}, .count = 2};
    float *depth = kiln_image_host(&f->depth, KILN_OVERWRITE, &error);
    for (int i = 0; i < PIXELS; i++) /* a slope, and sky */
        depth[i] = i % WIDTH < 200 ? 1.0f + 0.03f * (float)(i / WIDTH) : 1e9f;
    place_particles(f);
    f->view = kiln_view_compute(f->scene, STEP);
    f->light = (struct kiln_draw_backdrop){.sky_top = {0.2f, 0.3f, 0.5f, 0.0f},
                                           .sky_horizon = {0.3f, 0.3f, 0.3f, 0.0f},
                                           .sun_direction = {0.6f, 0.8f, 0.0f, 0.0f},
                                           .sun_color = {3.0f, 2.8f, 2.5f, 0.0f},
                                           .counts = {0, 9, 0, 0}};
    for (int i = 0; i < 9; i++)
        f->light.lights[i] = (struct kiln_draw_light){{(float)i - 4.0f, 1.0f, 0.5f, 0.01f},
                                                      {0.3f, 0.2f, 0.1f, 0.0f}};
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    kiln_buffer_finish(&f->entries);
    kiln_pool_finish(&f->pool);
    struct kiln_image *images[] = {&f->depth, &f->color, &f->bloom};
    for (int i = 0; i < 3; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&f->atlas);
    kiln_threads_destroy(&f->threads);
    kiln_scene_destroy(&f->scene);
    free(f);
    return 0;
}

/* Draws by vectors of a name, and keeps the bloom or the sum if asked to. */
static void draw(struct fixture *f, const char *simd, uint32_t thread_count, uint32_t count,
                 bool keep_bloom, bool sum)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(thread_count);
    assert_int_equal(setenv("KILN_SIMD", simd, 1), 0);
    struct kiln_particles_stage *stage =
        kiln_particles_create(NULL, f->scene, &f->atlas, KILN_RASTER_CPU, threads, &error);
    if (!stage)
        fail_msg("%s", error.message);
    unsetenv("KILN_SIMD");
    const struct kiln_lighting lighting = {.smoke = false};
    const struct kiln_particles_draw job = {.pool = &f->pool,
                                            .entries = &f->entries,
                                            .count = count,
                                            .view = &f->view,
                                            .backdrop = &f->light,
                                            .lighting = &lighting,
                                            .depth = &f->depth,
                                            .framebuffer = &f->framebuffer,
                                            .keep_bloom = keep_bloom,
                                            .sum_alpha = sum};
    if (!kiln_particles_run(stage, &job, &error))
        fail_msg("%s", error.message);
    kiln_particles_destroy(&stage);
    kiln_threads_destroy(&threads);
}

static void every_width_and_thread_count_gives_the_same_bytes(void **state)
{
    struct fixture *f = *state;
    const size_t bytes = PIXELS * 4 * sizeof(float);
    float *color = malloc(bytes), *bloom = malloc(bytes);
    assert_true(color && bloom);
    draw(f, "plain", 1, COUNT, false, false);
    memcpy(color, f->color.host, bytes);
    memcpy(bloom, f->bloom.host, bytes);
    double light = 0, alpha = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(isfinite(color[4 * i]) && color[4 * i + 3] <= 1.0f);
        light += (double)color[4 * i];
        alpha += (double)color[4 * i + 3];
    }
    assert_true(light > 0.2 * PIXELS && alpha > 0.1 * PIXELS); /* there is something to see */

    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd)) {
            print_message("no %s here\n", kiln_simd_name(simd));
            continue;
        }
        for (uint32_t threads = 1; threads <= 5; threads += 2) {
            draw(f, kiln_simd_name(simd), threads, COUNT, false, false);
            assert_memory_equal(color, f->color.host, bytes);
            assert_memory_equal(bloom, f->bloom.host, bytes);
        }
    }
    free(color);
    free(bloom);
}

static void an_unknown_width_is_refused(void **state)
{
    struct fixture *f = *state;
    struct kiln_error error = {0};
    assert_int_equal(setenv("KILN_SIMD", "mmx", 1), 0);
    assert_null(
        kiln_particles_create(NULL, f->scene, &f->atlas, KILN_RASTER_CPU, f->threads, &error));
    unsetenv("KILN_SIMD");
    assert_int_equal(error.code, KILN_USAGE);
    assert_non_null(strstr(error.message, "mmx"));
    assert_non_null(strstr(error.message, "sse4.1"));
}

static void no_particles_leave_a_clear_picture(void **state)
{
    struct fixture *f = *state;
    draw(f, "plain", 2, COUNT, false, false);
    draw(f, "plain", 2, 0, false, false);
    for (int i = 0; i < PIXELS * 4; i++)
        assert_true(f->color.host[i] == 0.0f && f->bloom.host[i] == 0.0f);
}

/* A pass over the glow of an earlier one is one pass over both, but for the colour. */
static void kept_bloom_is_dimmed_and_added_to(void **state)
{
    struct fixture *f = *state;
    struct kiln_error error = {0};
    const size_t floats = PIXELS * 4;
    float *both = malloc(floats * sizeof *both);
    uint32_t *entries = kiln_buffer_host(&f->entries, KILN_READ_WRITE, &error);
    assert_true(both && entries);
    draw(f, "plain", 2, COUNT, false, false);
    memcpy(both, f->bloom.host, floats * sizeof *both);
    draw(f, "plain", 2, COUNT / 2, false, false);
    memmove(entries, entries + COUNT / 2, COUNT / 2 * sizeof *entries);
    draw(f, "plain", 2, COUNT / 2, true, false);
    for (size_t i = 0; i < floats; i++)
        assert_true(fabsf(both[i] - f->bloom.host[i]) <= 1e-5f * (1.0f + both[i]));
    free(both);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_width_and_thread_count_gives_the_same_bytes, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(an_unknown_width_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_particles_leave_a_clear_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(kept_bloom_is_dimmed_and_added_to, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
