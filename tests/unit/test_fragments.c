/* lib/draw/fragments.c and what particles_cpu.c does with it: more fragments than a thread has room
 * for, and more sprites than are made at a time, give the picture all the same, in bounded memory.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "draw/particles.h"
#include "shared/particle.h"
#include "support/scenes.h"

enum { STEP = 40, PLACES = 1024 };

/* Cards parallel to the picture, in which pixels sort as particles do. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [128, 32], fps: 60, frames: 100}\n"
    "camera: {position: [0, 1, 3], target: [0, 1, 0], fov: 60 deg, near: 0.05 m}\n"
    "systems:\n"
    "  cards:\n"
    "    emit: {rate: 1, life: 2 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:spark', fade: {in: 0, out: 0}, color: [0.5, 0.4, 0.3], lit: 1,\n"
    "           thickness: 0}\n"
    "post: {compose: oit}\n";

struct fixture {
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_atlas atlas;
    struct kiln_image depth, color, bloom;
    struct kiln_framebuffer framebuffer;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_view view;
    uint32_t width, height, count;
};

/* Particles at PLACES depths, over and over, farthest first, and in a picture of this size. */
static void set_up(struct fixture *f, const char *look, uint32_t width, uint32_t height,
                   uint32_t count)
{
    struct kiln_error error = {0};
    char size[64];
    snprintf(size, sizeof size, "output.size=[%u, %u]", width, height);
    const char *const overrides[] = {look, size, NULL};
    *f = (struct fixture){.width = width, .height = height, .count = count};
    f->scene = load_scene(SCENE, overrides);
    f->threads = kiln_threads_create(2);
    const struct kiln_look *cards = &f->scene->systems[0].look;
    const struct kiln_atlas_request request = {
        .sources = cards->atlas, .count = 1, .columns = 2, .rows = 1, .motion = "none"};
    assert_true(kiln_atlas_init(&f->atlas, NULL, &request, 1, f->threads, &error));
    kiln_image_init(&f->depth, NULL, width, height, GL_R32F, "depth");
    kiln_image_init(&f->color, NULL, width, height, GL_RGBA32F, "color");
    kiln_image_init(&f->bloom, NULL, width, height, GL_RGBA32F, "bloom");
    f->framebuffer = (struct kiln_framebuffer){.images = {&f->color, &f->bloom}, .count = 2};
    float *depth = kiln_image_host(&f->depth, KILN_OVERWRITE, &error);
    for (uint32_t i = 0; i < width * height; i++)
        depth[i] = 1e9f;
    const uint32_t capacity = PLACES;
    kiln_pool_init(&f->pool, NULL, &capacity, 1);
    kiln_buffer_init(&f->entries, NULL, count * sizeof(uint32_t), "entries");
    struct kiln_particle *records = kiln_buffer_host(&f->pool.records, KILN_OVERWRITE, &error);
    uint32_t *entries = kiln_buffer_host(&f->entries, KILN_OVERWRITE, &error);
    assert_true(depth && records && entries);
    for (uint32_t i = 0; i < PLACES; i++) {
        float away = (float)i / PLACES, side = (float)(i * 29 % PLACES) / PLACES - 0.5f;
        float up = (float)(i * 517 % PLACES) / PLACES - 0.5f;
        records[i] = (struct kiln_particle){
            {FLOAT_BITS(4.0f * side), FLOAT_BITS(1.0f + 1.2f * up), FLOAT_BITS(away), i},
            {0, 0, 0, 1u << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
    }
    for (uint32_t i = 0; i < count; i++)
        entries[i] = KILN_ENTRY(0, (uint32_t)((uint64_t)i * PLACES / count));
    f->view = kiln_view_compute(f->scene, STEP);
}

static void tear_down(struct fixture *f)
{
    kiln_buffer_finish(&f->entries);
    kiln_pool_finish(&f->pool);
    struct kiln_image *images[] = {&f->depth, &f->color, &f->bloom};
    for (int i = 0; i < 3; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&f->atlas);
    kiln_threads_destroy(&f->threads);
    kiln_scene_destroy(&f->scene);
}

static void draw(struct fixture *f, bool by_fragment)
{
    struct kiln_error error = {0};
    const struct kiln_lighting lighting = {.smoke = false};
    const struct kiln_draw_backdrop light = {.sky_top = {0.2f, 0.3f, 0.5f, 0.0f},
                                             .sky_horizon = {0.3f, 0.3f, 0.3f, 0.0f}};
    struct kiln_particles_stage *stage =
        kiln_particles_create(NULL, f->scene, &f->atlas, KILN_RASTER_CPU, f->threads, &error);
    assert_non_null(stage);
    const struct kiln_particles_draw job = {.pool = &f->pool,
                                            .entries = &f->entries,
                                            .count = f->count,
                                            .view = &f->view,
                                            .backdrop = &light,
                                            .lighting = &lighting,
                                            .depth = &f->depth,
                                            .framebuffer = &f->framebuffer,
                                            .by_fragment = by_fragment};
    if (!kiln_particles_run(stage, &job, &error))
        fail_msg("%s", error.message);
    kiln_particles_destroy(&stage);
}

static long peak_kib(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return usage.ru_maxrss;
}

/* The picture of lists is that of particles in order, and takes no more memory than this besides.
 */
static void expect_picture(struct fixture *f, long most_mib)
{
    const size_t floats = (size_t)f->width * f->height * 4;
    float *merged = malloc(floats * sizeof *merged);
    assert_non_null(merged);
    draw(f, false);
    memcpy(merged, f->color.host, floats * sizeof *merged);
    const long before = peak_kib();
    draw(f, true);
    const long grown_mib = (peak_kib() - before) / 1024;
    double covered = 0.0, off = 0.0;
    for (size_t i = 0; i < floats; i++) {
        off = fmax(off, (double)fabsf(merged[i] - f->color.host[i]));
        covered += i % 4 == 3 ? (double)merged[i] : 0.0;
    }
    print_message("%ld MiB more, %.2g off\n", grown_mib, off);
    assert_true(off < 4e-3); /* sums of thousands of faint layers */
    assert_true(covered > 0.05 * (double)f->width * f->height);
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was freed */
    assert_true(grown_mib < most_mib);
#else
    (void)most_mib;
#endif
    free(merged);
}

/* A row of 64 pixels gets a million fragments, of 48 bytes each. */
static void long_lists_are_drawn_in_turns(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, "systems.cards.look={size: 12 m, opacity: 0.0003}", 64, 16, 15000);
    expect_picture(&f, 40);
    tear_down(&f);
}

/* Of 192 bytes each; the lists of sprites take 4 more for each tile. */
static void many_sprites_are_made_for_some_tiles_at_a_time(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f, "systems.cards.look={size: 0.1 m, opacity: 0.001}", 256, 64, 1400000);
    expect_picture(&f, 180);
    tear_down(&f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_lists_are_drawn_in_turns),
        cmocka_unit_test(many_sprites_are_made_for_some_tiles_at_a_time),
    };
    return cmocka_run_group_tests_name("fragments", tests, NULL, NULL);
}
