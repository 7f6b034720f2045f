/* lib/draw/sprites/particles_cpu.c: the pixels are the same bytes for every width of vectors and
 * any number of threads. That they are right is tested against C in tests/gpu/test_particles.c. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "draw/sprites/tile.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/raster.h"
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

static void place_particles(struct raster *r)
{
    struct kiln_particle *records;
    uint32_t *entries;
    raster_add_particles(r, COUNT / SYSTEMS, COUNT, &records, &entries);
    srand(7);
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = raster_random(-2.0f, 2.0f), y = raster_random(0.0f, 2.0f);
        records[i] = raster_random_particle(x, y, raster_random(-3.0f, 3.2f), i, STEP);
        entries[i] = KILN_ENTRY(i / (COUNT / SYSTEMS), i);
    }
    for (uint32_t i = 0; i < COUNT; i++) { /* systems between one another */
        uint32_t other = (uint32_t)rand() % COUNT, entry = entries[i];
        entries[i] = entries[other];
        entries[other] = entry;
    }
}

static int set_up_with(void **state, const char *const *overrides)
{
    struct raster *r = calloc(1, sizeof *r);
    assert_non_null(r);
    raster_open(r, load_scene(SCENE, overrides), 4, 2, STEP);
    raster_add_lamps(r, 9);
    float *depth = raster_add_targets(r);
    for (int i = 0; i < PIXELS; i++) /* a slope before the sky */
        depth[i] = i % WIDTH < 200 ? 1.0f + 0.03f * (float)(i / WIDTH) : depth[i];
    place_particles(r);
    *state = r;
    return 0;
}

static int set_up(void **state)
{
    return set_up_with(state, NULL);
}

static int set_up_with_opaque_discs(void **state)
{
    static const char *const overrides[] = {"systems.dots.look.point.size=40 px", NULL};
    return set_up_with(state, overrides);
}

static int tear_down(void **state)
{
    raster_close(*state);
    free(*state);
    return 0;
}

static void draw_job(struct raster *r, const struct kiln_particles_draw *job, const char *simd,
                     uint32_t thread_count)
{
    assert_int_equal(setenv("KILN_SIMD", simd, 1), 0);
    raster_draw(r, job, thread_count);
    unsetenv("KILN_SIMD");
}

/* Draws by vectors of a name, and keeps the bloom if asked to. */
static void draw(struct raster *r, const char *simd, uint32_t thread_count, uint32_t count,
                 bool keep_bloom)
{
    struct kiln_particles_draw job = raster_job(r);
    job.count = count;
    job.keep_bloom = keep_bloom;
    draw_job(r, &job, simd, thread_count);
}

static void every_width_and_thread_count_gives_the_same_bytes(void **state)
{
    struct raster *r = *state;
    const size_t bytes = PIXELS * 4 * sizeof(float);
    float *color = malloc(bytes), *bloom = malloc(bytes);
    assert_true(color && bloom);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 1, COUNT, false);
    memcpy(color, r->color.host, bytes);
    memcpy(bloom, r->bloom.host, bytes);
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
            draw(r, kiln_simd_name(simd), threads, COUNT, false);
            assert_memory_equal(color, r->color.host, bytes);
            assert_memory_equal(bloom, r->bloom.host, bytes);
        }
    }
    free(color);
    free(bloom);
}

/* Draws the additive particles alone, and returns the copied picture. */
static float *draw_additive(struct raster *r)
{
    struct kiln_particles_draw job = raster_job(r);
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&r->entries, KILN_READ_WRITE, &error), all[COUNT];
    float *color = malloc(PIXELS * 4 * sizeof *color);
    assert_true(entries && color);
    memcpy(all, entries, sizeof all);
    job.count = 0;
    for (size_t i = 0; i < COUNT; i++) {
        const uint32_t system = KILN_ENTRY_SYSTEM(all[i]);
        if (r->scene->systems[system].look.blend == KILN_BLEND_ADD)
            entries[job.count++] = all[i];
    }
    draw_job(r, &job, kiln_simd_name(kiln_simd_narrowest()), 1);
    memcpy(color, r->color.host, PIXELS * 4 * sizeof *color);
    memcpy(entries, all, sizeof all);
    return color;
}

/* Additive particles are added apart as if nothing hid them, and change nothing else. */
static void additive_particles_are_added_apart(void **state)
{
    struct raster *r = *state;
    const size_t floats = PIXELS * 4;
    float *alone = draw_additive(r), *color = malloc(floats * sizeof *color),
          *bloom = malloc(floats * sizeof *bloom);
    assert_true(color && bloom);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, COUNT, false);
    memcpy(color, r->color.host, floats * sizeof *color);
    memcpy(bloom, r->bloom.host, floats * sizeof *bloom);
    size_t opaque = 0, hidden = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        opaque += color[4 * i + 3] == 1.0f;
        hidden += alone[4 * i] > 10.0f * bloom[4 * i];
    }
    assert_true(opaque > PIXELS / 4 && hidden > PIXELS / 5);
    struct kiln_particles_draw job = raster_job(r);
    job.added = &r->added;
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        for (uint32_t threads = 1; threads <= 5 && kiln_simd_has(simd); threads += 2) {
            draw_job(r, &job, kiln_simd_name(simd), threads);
            assert_memory_equal(color, r->color.host, floats * sizeof *color);
            assert_memory_equal(bloom, r->bloom.host, floats * sizeof *bloom);
            for (size_t i = 0; i < floats; i++) /* sums in another order */
                assert_true(fabsf(alone[i] - r->added.host[i]) <= 4e-6f * alone[i]);
            if (simd == kiln_simd_narrowest() && threads == 1)
                memcpy(alone, r->added.host, floats * sizeof *alone);
            assert_memory_equal(alone, r->added.host, floats * sizeof *alone);
        }
    }
    free(alone);
    free(color);
    free(bloom);
}

static void an_unknown_width_is_refused(void **state)
{
    struct raster *r = *state;
    struct kiln_error error = {0};
    assert_int_equal(setenv("KILN_SIMD", "mmx", 1), 0);
    assert_null(
        kiln_particles_create(NULL, r->scene, &r->atlas, KILN_RASTER_CPU, r->threads, &error));
    unsetenv("KILN_SIMD");
    expect_error_simd(&error, "mmx");
}

static void no_particles_leave_a_clear_picture(void **state)
{
    struct raster *r = *state;
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, COUNT, false);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, 0, false);
    for (int i = 0; i < PIXELS * 4; i++)
        assert_true(r->color.host[i] == 0.0f && r->bloom.host[i] == 0.0f);
}

/* A pass over the glow of an earlier one is one pass over both, but for the colour. */
static void kept_bloom_is_dimmed_and_added_to(void **state)
{
    struct raster *r = *state;
    struct kiln_error error = {0};
    const size_t floats = PIXELS * 4;
    float *both = malloc(floats * sizeof *both);
    uint32_t *entries = kiln_buffer_host(&r->entries, KILN_READ_WRITE, &error);
    assert_true(both && entries);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, COUNT, false);
    memcpy(both, r->bloom.host, floats * sizeof *both);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, COUNT / 2, false);
    memmove(entries, entries + COUNT / 2, COUNT / 2 * sizeof *entries);
    draw(r, kiln_simd_name(kiln_simd_narrowest()), 2, COUNT / 2, true);
    for (size_t i = 0; i < floats; i++)
        assert_true(fabsf(both[i] - r->bloom.host[i]) <= 1e-5f * (1.0f + both[i]));
    free(both);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_width_and_thread_count_gives_the_same_bytes, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(additive_particles_are_added_apart,
                                        set_up_with_opaque_discs, tear_down),
        cmocka_unit_test_setup_teardown(an_unknown_width_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_particles_leave_a_clear_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(kept_bloom_is_dimmed_and_added_to, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
